// Matt surfaces.
#ifndef BSDF_DIFFUSE_GLSL
#define BSDF_DIFFUSE_GLSL

#include "bsdf_ggx.glsl"

// Energy-preserving Oren-Nayar (Portsmouth, Kutz and Hill, "EON: A practical energy-preserving rough
// diffuse BRDF", JCGT 14-1, 2025); constants and formulas are theirs. The share of light that leaves
// after one reflection, for an albedo of 1.
float eon_albedo(float cosine, float roughness)
{
    float a = 1.0 - cosine;
    float g = a * (0.0571085289 + a * (0.491881867 + a * (-0.332181442 + a * 0.0714429953)));
    return (1.0 + roughness * g) * ex_rcp(1.0 + 0.287793409 * roughness);
}

// The BRDF times pi.
vec3 eon(vec3 albedo, float roughness, vec3 wo, vec3 wi)
{
    float inv_a = ex_rcp(1.0 + 0.287793409 * roughness);
    float s = ex_dot(wo, wi) - wo.z * wi.z;
    float over_t = s > 0.0 ? s * ex_rcp(max(max(wo.z, wi.z), 1.0e-9)) : s;
    float average = (1.0 + 0.072488212 * roughness) * inv_a;
    float lost = 1.0 - average;
    float eo = 1.0 - eon_albedo(wo.z, roughness), ei = 1.0 - eon_albedo(wi.z, roughness);
    float again = max(eo, 1.0e-7) * max(ei, 1.0e-7) * ex_rcp(max(lost, 1.0e-7));
    vec3 left = vec3(1.0) - albedo * lost;
    vec3 repeated = albedo * albedo * average * vec3(ex_rcp(left.x), ex_rcp(left.y), ex_rcp(left.z));
    return albedo * (inv_a * (1.0 + roughness * over_t)) + repeated * again;
}

// A direction by its cosine.
vec3 cosine_sample(vec2 u)
{
    return vec3(ex_cos_sin_turns(u.x) * ex_sqrt(u.y), ex_sqrt(max(1.0 - u.y, 0.0)));
}

#endif
