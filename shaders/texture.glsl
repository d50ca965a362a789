// Pictures as colours: the filter, and what it says of a material.
#ifndef TEXTURE_GLSL
#define TEXTURE_GLSL

#include "exact.glsl"
#include "scene_data.glsl"

// The two texels around a coordinate along one side, and the share of the second.
struct texel_pair {
    uint first;
    uint second;
    float share;
};

// Texels lie around the half integers of u * size. Not a number counts as 0, and what lies beyond
// 2^23, where all floats are whole, as 2^23. Where a picture ends in its mirror image or goes on with
// its last row, that row is its own neighbour.
texel_pair texels_around(float u, uint size, uint wrap)
{
    bool is_number = (floatBitsToUint(u) & 0x7FFFFFFFu) <= 0x7F800000u;
    float at = clamp(is_number ? u : 0.0, -8388608.0, 8388608.0);
    float half_at = 0.5 * at;
    float turn = (half_at - floor(half_at)) * 2.0;
    float mirrored = turn > 1.0 ? 2.0 - turn : turn;
    float repeated = at - floor(at);
    float within = wrap == LR_GPU_WRAP_CLAMP ? clamp(at, 0.0, 1.0) : repeated;
    within = wrap == LR_GPU_WRAP_MIRROR ? mirrored : within;

    float x = within * float(size) - 0.5;
    float whole = floor(x);
    int low = int(whole), last = int(size) - 1;
    bool repeats = wrap == LR_GPU_WRAP_REPEAT;
    int first = low < 0 ? (repeats ? last : 0) : low;
    int second = low >= last ? (repeats ? 0 : last) : low + 1;
    return texel_pair(uint(first), uint(second), x - whole);
}

// Linear red, green and blue, and alpha.
vec4 texel_at(gpu_texture t, uint x, uint y)
{
    uint i = y * (t.size & 0xFFFFu) + x;
    bool floats = (t.flags & LR_GPU_TEXTURE_FLOATS) != 0u;
    uvec4 row = scene_row(t.texels + (floats ? i : i >> 2));
    uint low = (i & 1u) != 0u ? row.y : row.x, high = (i & 1u) != 0u ? row.w : row.z;
    uint word = (i & 2u) != 0u ? high : low;
    vec4 bytes = vec4(scene_row_float(t.curve + (word & 255u)).x,
                      scene_row_float(t.curve + ((word >> 8) & 255u)).x,
                      scene_row_float(t.curve + ((word >> 16) & 255u)).x,
                      scene_row_float(t.curve + (word >> 24)).y);
    return mix(bytes, uintBitsToFloat(row), bvec4(floats));
}

// The colour at uv, where (0, 0) is the picture's upper left corner and (1, 1) its lower right one,
// blended between the centres of four texels: linear red, green and blue, and alpha. `texture` is the
// row of its record.
vec4 texture_at(uint texture, vec2 uv)
{
    gpu_texture t = load_texture(texture);
    texel_pair x = texels_around(uv.x, t.size & 0xFFFFu, t.flags & 3u);
    texel_pair y = texels_around(uv.y, t.size >> 16, (t.flags >> 2) & 3u);
    vec4 upper = ex_mix(texel_at(t, x.first, y.first), texel_at(t, x.second, y.first), x.share);
    vec4 lower = ex_mix(texel_at(t, x.first, y.second), texel_at(t, x.second, y.second), x.share);
    return ex_mix(upper, lower, y.share);
}

// By what a material's picture multiplies its colour, and the picture's alpha; ones without a picture.
vec4 material_texel(gpu_material m, vec2 uv)
{
    bool has_image = (m.pattern & LR_GPU_PATTERN_KIND) == LR_GPU_PATTERN_IMAGE;
    vec4 texel = texture_at(m.pattern >> LR_GPU_TEXTURE_SHIFT, uv);
    return mix(vec4(1.0), texel, bvec4(has_image));
}

// Whether a surface has a hole where its picture has this alpha.
bool is_hole(uint pattern, float cutoff, float alpha)
{
    return (pattern & LR_GPU_PATTERN_KIND) == LR_GPU_PATTERN_IMAGE && alpha < cutoff;
}

// Whether the material's picture has a hole at uv: there light passes as if there were no surface.
bool cut_out(uint material, vec2 uv)
{
    uint at = frame.materials + LR_MATERIAL_ROWS * material;
    uint pattern = scene_row(at).w;
    float alpha = texture_at(pattern >> LR_GPU_TEXTURE_SHIFT, uv).w;
    return is_hole(pattern, scene_row_float(at + 1u).w, alpha);
}

#endif
