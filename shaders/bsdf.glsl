// What a surface does with light: evaluated, and sampled. Directions are in the frame of the normal,
// z along it on the side of wo; wo and wi point away from the surface.
#ifndef BSDF_GLSL
#define BSDF_GLSL

#include "boundary.glsl"
#include "exact.glsl"
#include "fresnel.glsl"
#include "scene_data.glsl"

#define LR_BSDF_REFLECTS 1u
#define LR_BSDF_TRANSMITS 2u
#define LR_BSDF_DELTA 4u

struct bsdf {
    vec3 diffuse;
    vec3 reflect;
    vec3 transmit;
    float gamma;
};

struct bsdf_value {
    vec3 f;    // times |cos|
    float pdf; // of sample_bsdf, per solid angle
};

struct bsdf_sample {
    vec3 wi;
    vec3 weight; // f |cos| / pdf
    float pdf;   // 0: a delta lobe
    uint kind;   // LR_BSDF_*; 0: absorbed
};

float brightest(vec3 v)
{
    return max(v.x, max(v.y, v.z));
}

bsdf load_bsdf(gpu_material m, vec3 color, boundary b, vec3 wo)
{
    bsdf s = bsdf(color * m.diffuse, vec3(0.0), vec3(0.0), b.gamma);
    if (has_scatter) {
        float cosine = clamp(wo.z, 0.0, 1.0);
        float f = 0.0;
        bool total = b.solid && refracted_cosine_squared(cosine, b.gamma) <= 0.0;
        f = total ? 1.0 : 0.0;
        if (has_fresnel && (m.flags & LR_GPU_FRESNEL) != 0u) {
            float inside = refracted_cosine_squared(cosine, ex_div(b.ior1, b.ior2));
            f = inside <= 0.0 ? 1.0 : fresnel_reflectance(cosine, ex_sqrt(inside), b.ior1, b.ior2);
            s.reflect = m.reflect * f;
        } else {
            s.reflect = m.reflect;
        }
        s.reflect = s.reflect + m.transmit * f;
        s.transmit = m.transmit * (1.0 - f);
    }
    return s;
}

float diffuse_share(bsdf b)
{
    float d = brightest(b.diffuse), r = brightest(b.reflect), t = brightest(b.transmit);
    return has_scatter ? d * ex_rcp(max(d + r + t, 1.0e-20)) : 1.0;
}

bsdf_value evaluate_bsdf(bsdf b, vec3 wo, vec3 wi)
{
    const float inv_pi = 0.318309873;
    float cosine = max(wi.z, 0.0) * inv_pi;
    return bsdf_value(b.diffuse * cosine, cosine * diffuse_share(b));
}

bsdf_sample sample_bsdf(bsdf b, vec3 wo, float lobe, vec2 u)
{
    const float inv_pi = 0.318309873;
    float share = diffuse_share(b);
    vec2 p = ex_cos_sin_turns(u.y) * ex_sqrt(u.x);
    float z = ex_sqrt(max(1.0 - (p.x * p.x + p.y * p.y), 0.0));
    bsdf_sample s = bsdf_sample(vec3(p, z), b.diffuse * ex_rcp(max(share, 1.0e-6)), z * inv_pi * share,
                                LR_BSDF_REFLECTS);
    if (has_scatter) {
        float r = brightest(b.reflect), t = brightest(b.transmit);
        float reflects = share + r * ex_rcp(max(brightest(b.diffuse) + r + t, 1.0e-20));
        float c2 = ex_sqrt(refracted_cosine_squared(clamp(wo.z, 0.0, 1.0), b.gamma));
        bool mirrored = lobe >= share && lobe < reflects, through = lobe >= reflects;
        s.wi = mix(s.wi, vec3(-wo.x, -wo.y, wo.z), bvec3(mirrored));
        s.wi = mix(s.wi, vec3(-wo.xy * b.gamma, -c2), bvec3(through));
        s.weight = mix(s.weight, b.reflect * ex_rcp(max(reflects - share, 1.0e-6)), bvec3(mirrored));
        s.weight = mix(s.weight, b.transmit * ex_rcp(max(1.0 - reflects, 1.0e-6)), bvec3(through));
        s.pdf = mirrored || through ? 0.0 : s.pdf;
        s.kind = mirrored ? LR_BSDF_REFLECTS | LR_BSDF_DELTA : s.kind;
        s.kind = through ? LR_BSDF_TRANSMITS | LR_BSDF_DELTA : s.kind;
    }
    return s;
}

#endif
