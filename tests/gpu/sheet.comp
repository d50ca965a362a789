#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
// Runs one formula of the renderer on many inputs; which one is in the first push constant.
#include "gpu_layout.h"
#include "film.glsl"
#include "fresnel.glsl"
#include "intersect.glsl"
#include "media.glsl"
#include "pattern.glsl"

layout(local_size_x = LR_GROUP_SIZE) in;

layout(std430, set = 0, binding = 0) readonly buffer InBlock { uvec4 given[]; };
layout(std430, set = 0, binding = 1) writeonly buffer OutBlock { uvec4 found[]; };

// The sheet's roots, word for word: what intersect_sphere does better far away.
vec2 textbook_sphere(vec3 o, vec3 d, vec3 center, float radius)
{
    vec3 from_center = o - center;
    float a = ex_dot(d, d);
    float b = 2.0 * ex_dot(d, from_center);
    float c = ex_dot(from_center, from_center) - radius * radius;
    float disc = b * b - 4.0 * a * c;
    float root = ex_sqrt(disc);
    float k = ex_rcp(2.0 * a);
    return disc >= 0.0 ? vec2((-b - root) * k, (-b + root) * k) : miss;
}

void main()
{
    work = work_block;
    uint i = gl_GlobalInvocationID.x, which = work.tile_x;
    uvec4 bits = given[3u * i];
    uint rank = given[3u * i + 1u].x;
    vec4 a = uintBitsToFloat(bits), b = uintBitsToFloat(given[3u * i + 1u]);
    vec4 c = uintBitsToFloat(given[3u * i + 2u]);
    vec4 result = vec4(0.0);
    if (which == 0u)
        result = vec4(reflect_direction(a.xyz, b.xyz), ex_dot(a.xyz, b.xyz));
    if (which == 1u) {
        float c1 = -ex_dot(a.xyz, b.xyz);
        float squared = refracted_cosine_squared(c1, a.w);
        result = vec4(refract_direction(a.xyz, b.xyz, c1, ex_sqrt(squared), a.w), squared);
    }
    if (which == 2u) {
        gpu_sphere s = gpu_sphere(c.xyz, a.w, c.w, 0u, 0u, 0u);
        result = vec4(intersect_sphere(a.xyz, b.xyz, ex_rcp(ex_dot(b.xyz, b.xyz)), s),
                      textbook_sphere(a.xyz, b.xyz, c.xyz, c.w));
    }
    if (which == 3u)
        result.xy = intersect_plane(a.xyz, b.xyz, c.xyz, c.w);
    if (which == 4u)
        result.x = fresnel_reflectance(a.x, a.y, a.z, a.w);
    uvec4 words = floatBitsToUint(result);
    if (which == 5u)
        words.xy = film_fixed(a.x);
    if (which == 6u)
        words.x = uint(cell_index(a.x, a.y));
    bool placed = false;
    uvec4 with = media_with(bits, rank, placed);
    if (which == 7u)
        words = with;
    if (which == 8u)
        words = media_without(bits, rank);
    if (which == 9u)
        words = uvec4(media_top(bits), media_contains(bits, rank) ? 1u : 0u, placed ? 1u : 0u, 0u);
    found[i] = words;
}
