#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
// Asks one material, seen from one direction: row 0 of rays_in holds wo and the material, row 1 the
// indices of refraction on both sides, whether it is solid, and the seed, row 2 + i wi and a number.
#include "gpu_layout.h"
#include "bsdf_load.glsl"
#include "sampler.glsl"

layout(local_size_x = LR_GROUP_SIZE) in;

const uint how_evaluate = 0u, how_sample = 1u, how_sum = 2u;

vec3 wo;

bsdf_sample sample_at(gpu_material m, uint material, boundary sides, uint seed, uint number)
{
    path_key key = key_of(uvec2(0u), seed, number);
    vec2 choices = sample_pair(key, 0u), spare = sample_pair(key, 1u);
    bsdf b = load_bsdf(material, m, m.color0, sides, wo, spare.x);
    return sample_bsdf(b, wo, choices.x, sample_pair(key, 2u));
}

void main()
{
    load_uniforms();
    uint i = gl_GlobalInvocationID.x;
    uvec4 first = rays_in[0], second = rays_in[1], third = rays_in[2u + i];
    wo = uintBitsToFloat(first.xyz);
    gpu_material m = load_material(first.w);
    float ior1 = uintBitsToFloat(second.x), ior2 = uintBitsToFloat(second.y);
    bool solid = second.z != 0u;
    boundary sides = boundary(uvec4(0u), solid, false, true, ior1, ior2,
                              solid ? ex_div(ior1, ior2) : 1.0);
    uint how = work.tile_x;
    vec4 a = vec4(0.0), b = vec4(0.0);
    if (how == how_evaluate) {
        bsdf_value found = evaluate_bsdf(load_bsdf(first.w, m, m.color0, sides, wo,
                                                   uintBitsToFloat(third.w)),
                                         wo, uintBitsToFloat(third.xyz));
        a = vec4(found.f, found.pdf);
    } else if (how == how_sample) {
        bsdf_sample found = sample_at(m, first.w, sides, second.w, i);
        a = vec4(found.wi, found.pdf);
        b = vec4(found.weight, uintBitsToFloat(found.kind));
    } else {
        // What is let through is less bright or brighter by the square of the index of refraction.
        for (uint k = 0u; k < work.count; k++) {
            bsdf_sample found = sample_at(m, first.w, sides, second.w, i * work.count + k);
            if ((found.kind & LR_BSDF_TRANSMITS) != 0u)
                b += vec4(found.weight, 1.0);
            else
                a += vec4(found.weight, 1.0);
        }
    }
    for (uint k = 0u; k < 4u; k++) {
        film[8u * i + k] = floatBitsToUint(a[k]);
        film[8u * i + 4u + k] = floatBitsToUint(b[k]);
    }
}
