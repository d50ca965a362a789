// Microfacets after Walter et al., "Microfacet Models for Refraction through Rough Surfaces" (EGSR
// 2007): the GGX distribution of width alpha, with the height-correlated shadowing of Heitz
// ("Understanding the Masking-Shadowing Function", JCGT 3-2, 2014). Directions are local: the normal is
// +z, and wo.z > 0.
#ifndef BSDF_GGX_GLSL
#define BSDF_GGX_GLSL

#include "exact.glsl"
#include "fresnel.glsl"

const float bsdf_inv_pi = 0.318309886;

// The share of microfacets that face m, per steradian.
float ggx_facets(float alpha, vec3 m)
{
    float a2 = alpha * alpha;
    float width = m.x * m.x + m.y * m.y + a2 * (m.z * m.z);
    return m.z > 0.0 ? a2 * bsdf_inv_pi * ex_rcp(max(width * width, 1.0e-24)) : 0.0;
}

// w.z (1 + 2 Lambda(w)), with Smith's Lambda.
float ggx_slant(float alpha, float z)
{
    float a2 = alpha * alpha;
    return ex_sqrt(a2 + (1.0 - a2) * (z * z));
}

// The share of visible microfacets that face m, per steradian: G1 D (wo . m) / wo.z.
float ggx_visible(float alpha, vec3 wo, vec3 m)
{
    return ggx_facets(alpha, m) * max(ex_dot(wo, m), 0.0) * 2.0 *
           ex_rcp(wo.z + ggx_slant(alpha, wo.z));
}

// How much of what a visible microfacet sends to a direction with cosine z > 0 gets out: G2 / G1.
float ggx_escape(float alpha, vec3 wo, float z)
{
    float slant = ggx_slant(alpha, wo.z);
    float both = z * slant + wo.z * ggx_slant(alpha, z);
    return z * (wo.z + slant) * ex_rcp(max(both, 1.0e-20));
}

// A visible microfacet's normal (Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical Caps",
// HPG 2023); u within [0, 1).
vec3 ggx_sample(float alpha, vec3 wo, vec2 u)
{
    vec3 o = ex_normalize(vec3(alpha * wo.xy, wo.z));
    float z = 1.0 - u.y * (1.0 + o.z);
    vec2 around = ex_cos_sin_turns(u.x) * ex_sqrt(max(1.0 - z * z, 0.0));
    vec3 h = vec3(around, z) + o;
    return ex_normalize(vec3(alpha * h.xy, max(h.z, 1.0e-9)));
}

// Both directions' half-way vector.
vec3 half_way(vec3 wo, vec3 wi)
{
    vec3 sum = wo + wi;
    return sum * ex_rsqrt(max(ex_dot(sum, sum), 1.0e-20));
}

// Schlick's (1 - cos)^5 ("An Inexpensive BRDF Model", EG 1994).
float schlick_weight(float cosine)
{
    float a = clamp(1.0 - cosine, 0.0, 1.0), a2 = a * a;
    return a2 * a2 * a;
}

// Share of unpolarised light that a metal of the refractive index eta + i k reflects (Fresnel's
// equations; in this form by Lagarde, "Memo on Fresnel equations", 2013).
float metal_reflectance(float cosine, float eta, float k)
{
    float c2 = cosine * cosine, s2 = 1.0 - c2;
    float eta2 = eta * eta, k2 = k * k, t0 = eta2 - k2 - s2;
    float sum = ex_sqrt(t0 * t0 + 4.0 * eta2 * k2);
    float t1 = sum + c2, t2 = 2.0 * cosine * ex_sqrt(max(0.5 * (sum + t0), 0.0));
    float rs = (t1 - t2) * ex_rcp(t1 + t2 + 1.0e-20);
    float t3 = c2 * sum + s2 * s2, t4 = t2 * s2;
    float rp = rs * (t3 - t4) * ex_rcp(t3 + t4 + 1.0e-20);
    return clamp(0.5 * (rs + rp), 0.0, 1.0);
}

vec3 metal_reflectance(float cosine, vec3 eta, vec3 k)
{
    return vec3(metal_reflectance(cosine, eta.x, k.x), metal_reflectance(cosine, eta.y, k.y),
                metal_reflectance(cosine, eta.z, k.z));
}

// Share that the boundary between dielectrics reflects; ratio is the index of refraction on the side of
// the cosine over that on the other, and c2 becomes the cosine there, 0 under total reflection.
float glass_reflectance(float cosine, float ratio, out float c2)
{
    float squared = refracted_cosine_squared(cosine, ratio);
    c2 = ex_sqrt(max(squared, 0.0));
    return squared <= 0.0 ? 1.0 : fresnel_reflectance(cosine, c2, ratio, 1.0);
}

#endif
