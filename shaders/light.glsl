// The light sources.
#ifndef LIGHT_GLSL
#define LIGHT_GLSL

#include "batch.glsl"
#include "exact.glsl"
#include "scene_data.glsl"

// The light number first + l, when all invocations of a batch ask for the same up to LR_BATCH lights:
// each loads one of them, `held`.
gpu_light share(gpu_light held, uint l)
{
    uint lane = batch_begin() + l;
    return gpu_light(share(held.position, lane), share(held.half_falloff, lane),
                     share(held.color, lane), share(held.flags, lane),
                     share(held.direction, lane), share(held.cos_angle, lane),
                     share(held.cos_scale, lane), 0.0, 0.0, 0u);
}

// Light that arrives from one source at a point, before shadows.
struct arriving_light {
    vec3 color;
    vec3 wi; // unit, towards the light
};

// 1 / distance^falloff of a light that fades.
float attenuation(gpu_light light, float distance2)
{
    return ex_exp2(clamp(-light.half_falloff * ex_log2(distance2), LR_ATTENUATION_MIN,
                         LR_ATTENUATION_MAX));
}

// The share of a spot light that goes into a direction: smoothstep in the cosine from the edge to the
// inner angle.
float spot_share(gpu_light light, vec3 wi)
{
    float cosine = -ex_dot(wi, light.direction);
    float s = clamp((cosine - light.cos_angle) * light.cos_scale, 0.0, 1.0);
    bool spot = (light.flags & LR_GPU_LIGHT_SPOT) != 0u;
    return spot ? s * s * (3.0 - 2.0 * s) : 1.0;
}

arriving_light sample_light(gpu_light light, vec3 position)
{
    bool directional = (light.flags & LR_GPU_LIGHT_DIRECTIONAL) != 0u;
    vec3 to_light = light.position - position;
    float distance2 = ex_dot(to_light, to_light);
    bool apart = distance2 > 7.888609052210118e-31; // at the light itself there is no direction
    float safe2 = apart ? distance2 : 1.0;
    vec3 wi = directional ? -light.direction : to_light * ex_rsqrt(safe2);
    float strength = 1.0;
    if (has_falloff)
        strength = attenuation(light, safe2);
    strength = directional ? 1.0 : (apart ? strength : 0.0);
    if (has_spots)
        strength = strength * spot_share(light, wi);
    return arriving_light(light.color * strength, wi);
}

// What a surface sends out by itself towards where a ray of direction d comes from.
vec3 emission_of(gpu_material m, vec3 d, vec3 normal)
{
    vec3 emission = vec3(m.emission_red, m.emission_green, m.emission_blue);
    bool dark = has_emits_front && (m.flags & LR_GPU_FRONT_ONLY) != 0u && ex_dot(d, normal) > 0.0;
    return dark ? vec3(0.0) : emission;
}

// The direction and length of the shadow ray from a point to a light; it ends a little before it.
vec4 shadow_ray(gpu_light light, vec3 origin)
{
    vec3 to_light = light.position - origin;
    float distance2 = max(ex_dot(to_light, to_light), 7.888609052210118e-31);
    float inv_distance = ex_rsqrt(distance2);
    bool directional = (light.flags & LR_GPU_LIGHT_DIRECTIONAL) != 0u;
    return directional ? vec4(-light.direction, LR_T_MAX)
                       : vec4(to_light * inv_distance, distance2 * inv_distance * LR_SHORT_OF);
}

#endif
