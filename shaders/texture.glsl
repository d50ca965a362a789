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

// By mix, since glslang makes branches of conditional expressions, and SwiftShader minutes of those.
// Texels lie around the half integers of u * size. Not a number counts as 0, and what lies beyond
// 2^23, where all floats are whole, as 2^23. Where a picture ends in its mirror image or goes on with
// its last row, that row is its own neighbour.
texel_pair texels_around(float u, uint size, uint wrap)
{
    bool is_number = (floatBitsToUint(u) & 0x7FFFFFFFu) <= 0x7F800000u;
    float at = clamp(is_number ? u : 0.0, -8388608.0, 8388608.0);
    float half_at = 0.5 * at;
    float turn = (half_at - floor(half_at)) * 2.0;
    float mirrored = min(turn, 2.0 - turn), clamped = clamp(at, 0.0, 1.0);
    float within = mix(at - floor(at), clamped, wrap == LR_GPU_WRAP_CLAMP);
    within = mix(within, mirrored, wrap == LR_GPU_WRAP_MIRROR);

    float x = within * float(size) - 0.5;
    float whole = floor(x);
    int low = int(whole), last = int(size) - 1;
    bool repeats = wrap == LR_GPU_WRAP_REPEAT;
    int first = mix(low, mix(0, last, repeats), low < 0);
    int second = mix(low + 1, mix(last, 0, repeats), low >= last);
    return texel_pair(uint(first), uint(second), x - whole);
}

bool has_floats(gpu_texture t)
{
    return (t.flags & LR_GPU_TEXTURE_FLOATS) != 0u;
}

// The row that holds texel i.
uvec4 texel_row(gpu_texture t, uint i)
{
    return scene_row(t.texels + mix(i >> 2, i, has_floats(t)));
}

// The word of texel i in its row of four.
uint texel_word(uvec4 row, uint i)
{
    uvec2 two = mix(row.xy, row.zw, bvec2((i & 2u) != 0u));
    return mix(two.x, two.y, (i & 1u) != 0u);
}

float byte_alpha(uint word)
{
    return float(word >> 24) * 0.0039215688593685627; // 1 / 255, by which 255 becomes 1
}

// Linear red, green and blue, and alpha.
vec4 texel_at(gpu_texture t, uint x, uint y)
{
    uint i = y * (t.size & 0xFFFFu) + x;
    uvec4 row = texel_row(t, i);
    uint word = texel_word(row, i);
    vec4 bytes = vec4(scene_row_float(t.curve + (word & 255u)).x,
                      scene_row_float(t.curve + ((word >> 8) & 255u)).x,
                      scene_row_float(t.curve + ((word >> 16) & 255u)).x, byte_alpha(word));
    return mix(bytes, uintBitsToFloat(row), bvec4(has_floats(t)));
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

// The alpha of texture_at, bit for bit. In a loop, because it stands in many places.
float texture_alpha(uint texture, vec2 uv)
{
    gpu_texture t = load_texture(texture);
    uint width = t.size & 0xFFFFu;
    texel_pair x = texels_around(uv.x, width, t.flags & 3u);
    texel_pair y = texels_around(uv.y, t.size >> 16, (t.flags >> 2) & 3u);
    vec4 alpha = vec4(1.0);
    for (uint k = 0u;;) {
        uint column = mix(x.first, x.second, (k & 1u) != 0u);
        uint i = mix(y.first, y.second, k >= 2u) * width + column;
        float found = byte_alpha(texel_word(texel_row(t, i), i));
        alpha = vec4(alpha.yzw, mix(found, 1.0, has_floats(t)));
        k++;
        if (k >= 4u)
            break;
    }
    float upper = alpha.x * (1.0 - x.share) + alpha.y * x.share;
    float lower = alpha.z * (1.0 - x.share) + alpha.w * x.share;
    return upper * (1.0 - y.share) + lower * y.share;
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
    bool has_image = (pattern & LR_GPU_PATTERN_KIND) == LR_GPU_PATTERN_IMAGE;
    return alpha < cutoff && has_image;
}

// Whether the material's picture has a hole at uv: there light passes as if there were no surface.
bool cut_out(uint material, vec2 uv)
{
    uint at = frame.materials + LR_MATERIAL_ROWS * material;
    uint pattern = scene_row(at).w;
    float alpha = texture_alpha(pattern >> LR_GPU_TEXTURE_SHIFT, uv);
    return is_hole(pattern, scene_row_float(at + 1u).w, alpha);
}

#endif
