#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
// Light that falls on each hit: the ambient light, and each light source with its shadow ray.
#include "gpu_layout.h"
#include "bindings.glsl"
#include "classic.glsl"
#include "film.glsl"
#include "pattern.glsl"
#include "trace.glsl"

layout(local_size_x = LR_GROUP_SIZE) in;

// Light that arrives from one source at a point, before shadows.
struct arriving_light {
    vec3 color;
    vec3 wi;        // unit, towards the light
    float distance; // to it
};

arriving_light sample_light(gpu_light light, vec3 position)
{
    bool directional = (light.flags & LR_GPU_LIGHT_DIRECTIONAL) != 0u;
    vec3 to_light = light.position - position;
    float distance2 = ex_dot(to_light, to_light);
    bool apart = distance2 > 7.888609052210118e-31; // at the light itself there is no direction
    float safe2 = apart ? distance2 : 1.0;
    float inv_distance = ex_rsqrt(safe2);
    vec3 wi = directional ? -light.direction : to_light * inv_distance;
    float strength = ex_exp2(clamp(-light.half_falloff * ex_log2(safe2), LR_ATTENUATION_MIN,
                                   LR_ATTENUATION_MAX));
    strength = directional ? 1.0 : (apart ? strength : 0.0);
    if (has_spots) {
        // Smoothstep in the cosine from the edge to the inner angle.
        float cosine = -ex_dot(wi, light.direction);
        float s = clamp((cosine - light.cos_angle) * light.cos_scale, 0.0, 1.0);
        bool spot = (light.flags & LR_GPU_LIGHT_SPOT) != 0u;
        strength = strength * (spot ? s * s * (3.0 - 2.0 * s) : 1.0);
    }
    return arriving_light(light.color * strength, wi,
                          directional ? LR_T_MAX : safe2 * inv_distance);
}

// What is left of a light's colour behind all that stands before it; `counted` tells whether the ray
// is more than a companion to its subgroup's.
vec3 light_left(gpu_light light, arriving_light arriving, vec3 origin, bool counted)
{
    // From the offset origin the light lies in a slightly different direction.
    bool directional = (light.flags & LR_GPU_LIGHT_DIRECTIONAL) != 0u;
    vec3 to_light = light.position - origin;
    float distance2 = max(ex_dot(to_light, to_light), 7.888609052210118e-31);
    float inv_distance = ex_rsqrt(distance2);
    vec3 d = directional ? arriving.wi : to_light * inv_distance;
    float t_max = directional ? LR_T_MAX : distance2 * inv_distance * LR_SHORT_OF;
    uvec3 depth = trace_shadow(origin, d, t_max);
    bvec3 dark = greaterThanEqual(depth, uvec3(LR_SHADOW_OPAQUE));
    vec3 left = vec3(1.0);
    if (has_transparent) {
        vec3 bits = vec3(min(depth, uvec3(LR_SHADOW_OPAQUE))) * LR_SHADOW_BITS;
        left = vec3(ex_exp2(bits.x), ex_exp2(bits.y), ex_exp2(bits.z));
    }
    if (counted)
        atomicAdd(counters.shadow, 1u);
    if (counted && depth != uvec3(0u))
        atomicAdd(counters.shadow_hits, 1u);
    return vec3(dark.x ? 0.0 : left.x, dark.y ? 0.0 : left.y, dark.z ? 0.0 : left.z);
}

void main()
{
    uint index = queue_index();
    uint count = has_scatter ? counters.lit : counters.hits;
    bool wanted = index < count;
    index = wanted ? index : 0u;
    if (has_scatter)
        index = lit[index];
    gpu_hit hit = hits[index];
    gpu_material m = load_material(load_object_ids(hit.object).x);
    vec3 color = m.color0;
    if (has_patterns)
        color = pattern_color(m, hit.object, hit.position, hit.normal);
    vec3 n = ex_dot(hit.direction, hit.normal) < 0.0 ? hit.normal : -hit.normal;
    vec3 origin = hit.position + n * hit.offset;

    film_sum sum = film_zero();
    if (wanted && hidden(work.add_ambient) != 0u)
        film_accumulate(sum, hit.weight * (m.ambient * color));
    uint light_count = hidden(work.light_count);
    for (uint i = 0u; i < light_count; i++) {
        gpu_light light = load_light(work.light + i);
        arriving_light arriving = sample_light(light, hit.position);
        vec3 share = classic_light(m, color, n, -hit.direction, arriving.wi);
        vec3 value = hit.weight * (arriving.color * share);
        bool reaches = wanted && (value.x > 0.0 || value.y > 0.0 || value.z > 0.0);
        if ((light.flags & LR_GPU_LIGHT_SHADOWS) != 0u)
            value = value * light_left(light, arriving, origin, reaches);
        if (reaches)
            film_accumulate(sum, value);
    }
    if (!wanted)
        return;
    film_add(hit.pixel, sum);
    atomicAdd(counters.shaded, 1u);
}
