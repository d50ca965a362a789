#version 450
#extension GL_GOOGLE_include_directive : require
// The film as a window shows it: the very shades that picture files have, and the overlay over them.
#include "gpu_layout.h"

layout(local_size_x = LR_GROUP_SIZE) in;

layout(std430, set = 0, binding = 0) readonly buffer FilmBlock { uint film[]; };
layout(std430, set = 0, binding = 1) readonly buffer ShadeBlock { gpu_shades shades[2]; };
layout(std430, set = 0, binding = 2) readonly buffer PaletteBlock { uint palette[]; };
layout(std430, set = 0, binding = 3) readonly buffer OverlayBlock { uint overlay[]; };
layout(std430, set = 0, binding = 4) writeonly buffer CanvasBlock { uint canvas[]; };
layout(push_constant) uniform DisplayBlock { gpu_display display; };

// See bindings.glsl: without it lavapipe compiles the kernel anew for every look.
uint hidden(uint uniform_value)
{
    return uniform_value + (gl_NumWorkGroups.z >> 31);
}

uint film_pixel(uvec2 pixel)
{
    return (pixel.y * display.width + pixel.x) * uint(LR_FILM_WORDS);
}

// Where the pixel's colour stands in the film: the nearest to the left and above that has one.
uint find_pixel(uvec2 pixel)
{
    uint at = film_pixel(pixel);
    for (uint coarse = 2u; coarse <= hidden(display.coarse); coarse *= 2u) {
        uint coarser = film_pixel(pixel & ~uvec2(coarse - 1u));
        at = film[at + uint(LR_FILM_SAMPLES)] == 0u ? coarser : at;
    }
    return at;
}

// Sums below 2^LR_BUCKET_BITS have buckets of their own; above, those that agree in the place of the
// leading one and in as many bits behind it share one.
uint sum_bucket(uint low, uint high)
{
    const uint bits = uint(LR_BUCKET_BITS);
    uint leading = high != 0u ? 32u + uint(findMSB(high)) : uint(findMSB(low | 1u));
    uint by = leading < bits ? 0u : leading - bits;
    uint shifted = by >= 32u ? high >> ((by - 32u) & 31u)
                             : (low >> (by & 31u)) | ((high << 1) << ((31u - by) & 31u));
    return (by << bits) + shifted;
}

uint shade(uint at, uint channel, uint table)
{
    uint low = film[at + 2u * channel], high = film[at + 2u * channel + 1u];
    uint reached = shades[table].starts[sum_bucket(low, high)];
    // No more than one step is in a bucket: its width is at most 1/256 of its sums, and a step 1/255
    // of the largest sum that matters (of sRGB's, 1/107 of any).
    uint step_low = shades[table].steps_low[reached], step_high = shades[table].steps_high[reached];
    bool reaches = high > step_high || (high == step_high && low >= step_low);
    bool over = (film[at + uint(LR_FILM_FLAGS)] & (1u << (channel & 31u))) != 0u;
    uint counted = min(reached + uint(reaches), uint(LR_SHADES) - 1u);
    return over ? shades[table].overflow : counted;
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
    uint table = film[at + uint(LR_FILM_SAMPLES)] == hidden(display.samples) ? 0u : 1u;
    uvec3 color = uvec3(shade(at, 0u, table), shade(at, 1u, table), shade(at, 2u, table));
    if (hidden(display.palette) != 0u)
        color = unpack_rgb(palette[color.x]);
    uint index = pixel.y * display.width + pixel.x;
    if (hidden(display.overlay) != 0u) {
        uint over = overlay[index];
        color = unpack_rgb(over) + (color * (255u - (over >> 24)) + 127u) / 255u;
    }
    color = min(color, uvec3(255u));
    uint first = hidden(display.blue_first) != 0u ? color.z : color.x;
    uint last = hidden(display.blue_first) != 0u ? color.x : color.z;
    canvas[index] = first | (color.y << 8) | (last << 16) | 0xFF000000u;
}
