#version 450
#extension GL_GOOGLE_include_directive : require
// The film as a window shows it: the very shades that picture files have, and the overlay over them.
#include "gpu_layout.h"

layout(local_size_x = LR_TILE_GROUP, local_size_y = LR_TILE_GROUP) in;

layout(std430, set = 0, binding = 0) readonly buffer FilmBlock { uint film[]; };
layout(std430, set = 0, binding = 1) readonly buffer ShadeBlock { gpu_shades shades[2]; };
layout(std430, set = 0, binding = 2) readonly buffer PaletteBlock { uint palette[]; };
layout(std430, set = 0, binding = 3) readonly buffer OverlayBlock { uint overlay[]; };
layout(std430, set = 0, binding = 4) writeonly buffer CanvasBlock { uint canvas[]; };
layout(push_constant) uniform DisplayBlock { gpu_display display; };

uint film_pixel(uvec2 pixel)
{
    return (pixel.y * display.width + pixel.x) * uint(LR_FILM_WORDS);
}

// Where the pixel's colour stands in the film: the nearest to the left and above that has one.
uint find_pixel(uvec2 pixel)
{
    uint at = film_pixel(pixel);
    for (uint coarse = 2u; coarse <= uint(LR_COARSE_MAX); coarse *= 2u) {
        uint coarser = film_pixel(pixel & ~uvec2(coarse - 1u));
        at = film[at + uint(LR_FILM_SAMPLES)] == 0u ? coarser : at;
    }
    return at;
}

uint shade(uint at, uint channel, uint table)
{
    uint low = film[at + 2u * channel], high = film[at + 2u * channel + 1u];
    uint reached = 0u;
    for (uint half_way = uint(LR_SHADES) / 2u; half_way > 0u; half_way /= 2u) {
        uint next = reached + half_way;
        uint step_low = shades[table].steps_low[next - 1u];
        uint step_high = shades[table].steps_high[next - 1u];
        bool reaches = high > step_high || (high == step_high && low >= step_low);
        reached = reaches ? next : reached;
    }
    bool over = (film[at + uint(LR_FILM_FLAGS)] & (1u << (channel & 31u))) != 0u;
    return over ? shades[table].overflow : reached;
}

uvec3 unpack_rgb(uint packed)
{
    return uvec3((packed >> 16) & 255u, (packed >> 8) & 255u, packed & 255u);
}

void main()
{
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= display.width || pixel.y >= display.height)
        return;
    uint at = find_pixel(pixel);
    uint table = film[at + uint(LR_FILM_SAMPLES)] == display.samples ? 0u : 1u;
    uvec3 color = uvec3(shade(at, 0u, table), shade(at, 1u, table), shade(at, 2u, table));
    if (display.palette != 0u)
        color = unpack_rgb(palette[color.x]);
    uint index = pixel.y * display.width + pixel.x;
    if (display.overlay != 0u) {
        uint over = overlay[index];
        color = unpack_rgb(over) + (color * (255u - (over >> 24)) + 127u) / 255u;
    }
    color = min(color, uvec3(255u));
    uint first = display.blue_first != 0u ? color.z : color.x;
    uint last = display.blue_first != 0u ? color.x : color.z;
    canvas[index] = first | (color.y << 8) | (last << 16) | 0xFF000000u;
}
