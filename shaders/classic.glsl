// The classic material: what share of the light that arrives from wi leaves towards wo.
#ifndef CLASSIC_GLSL
#define CLASSIC_GLSL

#include "exact.glsl"
#include "fresnel.glsl"
#include "scene_data.glsl"

// (h . n)^shininess (Blinn, 1977) or (r . wi)^shininess (Phong, 1975), with r the mirrored view.
float highlight_at(gpu_material m, vec3 n, vec3 wo, vec3 wi)
{
    vec3 half_way = wo + wi;
    vec3 h = half_way * ex_rsqrt(max(ex_dot(half_way, half_way), 1.0e-20));
    bool phong = (m.flags & LR_GPU_PHONG) != 0u;
    float peak = phong ? ex_dot(reflect_direction(-wo, n), wi) : ex_dot(h, n);
    return peak > LR_COSINE_MIN ? ex_pow(min(peak, 1.0), m.shininess) : 0.0;
}

// The sheet's cos(theta) law plus a highlight. Nothing for light from behind.
vec3 classic_light(gpu_material m, vec3 color, vec3 n, vec3 wo, vec3 wi)
{
    float cosine = ex_dot(n, wi);
    vec3 share = color * m.diffuse * cosine;
    if (has_specular)
        share = share + m.specular * highlight_at(m, n, wo, wi);
    return cosine > LR_COSINE_MIN ? share : vec3(0.0);
}

#endif
