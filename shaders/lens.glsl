// Where a sample goes through the lens, and where filters put it.
#ifndef LENS_GLSL
#define LENS_GLSL

#include "exact.glsl"

// The unit disk from the unit square, uniform, neighbours staying neighbours (Shirley and Chiu, "A
// Low Distortion Map Between Disk and Square", JGT 2-3, 1997).
vec2 disk_point(vec2 u)
{
    vec2 s = 2.0 * u - 1.0;
    bool wide = abs(s.x) > abs(s.y);
    float radius = wide ? s.x : s.y;
    float share = 0.125 * ((wide ? s.y : s.x) * ex_rcp(away_from_zero(radius)));
    return radius * ex_cos_sin_turns(wide ? share : 0.25 - share);
}

// The regular polygon whose corners lie on the unit circle, the first at `turns`: one of the triangles
// around the middle, and a point of it.
vec2 polygon_point(vec2 u, float corners, float inv_corners, float turns)
{
    float along = u.x * corners;
    float corner = min(floor(along), corners - 1.0);
    float out_to = ex_sqrt(along - corner);
    vec2 a = ex_cos_sin_turns(turns + corner * inv_corners);
    vec2 b = ex_cos_sin_turns(turns + (corner + 1.0) * inv_corners);
    return out_to * (a * (1.0 - u.y) + b * u.y);
}

// Filters by importance: the offset from a pixel's centre that the share (1 + t) / 2 of the filter lies
// before, -1 <= t < 1, so that all samples weigh the same (Ernst, Stamminger and Greiner, "Filter
// Importance Sampling", RT 2006).

// Radius 1: 1 - sqrt(1 - |t|), with the sign of t.
float tent_offset(float t)
{
    return ex_div(t, 1.0 + ex_sqrt(1.0 - abs(t)));
}

// Blackman-Harris (Harris, 1978: four terms, -92 dB), radius 1.5, within 8e-4. The inverse of its
// integral has no formula: t times a polynomial in -log2(1 - t^2), fitted for |t| <= 1 - 2^-24.
float blackman_harris_offset(float t)
{
    float z = -ex_log2(max(1.0 - t * t, 1.1920929e-7));
    float p = 2.5644578e-8 * z - 2.11373469e-6;
    p = p * z + 6.82102941e-5;
    p = p * z - 1.02432763e-3;
    p = p * z + 4.03415175e-3;
    p = p * z + 0.0872652157;
    p = p * z + 0.540920868;
    return p * t;
}

#endif
