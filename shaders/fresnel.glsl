// Reflection and refraction at a smooth surface (the sheet's sections 3.3 and 3.4).
#ifndef FRESNEL_GLSL
#define FRESNEL_GLSL

#include "exact.glsl"

// The sheet's r = x - 2 n (x . n).
vec3 reflect_direction(vec3 x, vec3 n)
{
    return x - n * (2.0 * ex_dot(x, n));
}

// The sheet's c2^2 = 1 - gamma^2 (1 - c1^2), with c1 = -x . n and gamma = ior from / ior into:
// negative under total internal reflection.
float refracted_cosine_squared(float c1, float gamma)
{
    return 1.0 - gamma * gamma * (1.0 - c1 * c1);
}

// The sheet's r = gamma x + (gamma c1 - c2) n, n on the side that x comes from.
vec3 refract_direction(vec3 x, vec3 n, float c1, float c2, float gamma)
{
    return x * gamma + n * (gamma * c1 - c2);
}

// Share of unpolarised light that a boundary between dielectrics reflects (Fresnel's equations);
// c1 and c2 are the cosines on the side the light comes from and on the other, ior1 and ior2 theirs.
float fresnel_reflectance(float c1, float c2, float ior1, float ior2)
{
    float a = ior1 * c1, b = ior2 * c2, c = ior1 * c2, d = ior2 * c1;
    float rs = (a - b) * ex_rcp(a + b + 1.0e-20);
    float rp = (c - d) * ex_rcp(c + d + 1.0e-20);
    return min(0.5 * (rs * rs + rp * rp), 1.0);
}

#endif
