// Cloth: microfibres after Estevez and Kulla, "Production Friendly Microfacet Sheen BRDF" (2017), with
// the shadowing that glTF's KHR_materials_sheen takes from Neubelt and Pettineo (2013).
#ifndef BSDF_SHEEN_GLSL
#define BSDF_SHEEN_GLSL

#include "exact.glsl"

// The BRDF for a colour of 1; alpha within 1e-3 .. 1.
float charlie(float alpha, vec3 wo, vec3 wi, vec3 h)
{
    float power = ex_rcp(alpha);
    float sine2 = max(h.x * h.x + h.y * h.y, 1.0e-20);
    float d = (2.0 + power) * 0.159154943 * ex_pow(min(sine2, 1.0), 0.5 * power);
    return d * 0.25 * ex_rcp(max(wi.z + wo.z - wi.z * wo.z, 1.0e-7));
}

#endif
