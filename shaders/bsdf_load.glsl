// The lobes of a material, from its records.
#ifndef BSDF_LOAD_GLSL
#define BSDF_LOAD_GLSL

#include "boundary.glsl"
#include "bsdf.glsl"
#include "bsdf_table.glsl"

gpu_bsdf load_model(uint material)
{
    uint at = frame.bsdfs + LR_BSDF_ROWS * material;
    vec4 r0 = scene_row_float(at), r1 = scene_row_float(at + 1u), r2 = scene_row_float(at + 2u);
    vec4 r3 = scene_row_float(at + 3u), r4 = scene_row_float(at + 4u);
    return gpu_bsdf(r0.xyz, floatBitsToUint(r0.w), r1.xyz, r1.w, r2.xyz, r2.w, r3.x, r3.y, r3.z, r3.w,
                    r4.x, 0u, 0u, 0u);
}

// The classic material: what scatter.glsl makes of it, as lobes.
void load_classic(gpu_material m, vec3 color, boundary sides, float cosine, inout bsdf b)
{
    b.matte = color * m.diffuse;
    b.highlight = m.specular;
    b.shininess = m.shininess;
    b.phong = (m.flags & LR_GPU_PHONG) != 0u;
    if (has_delta) {
        float c2, f = glass_reflectance(cosine, ex_div(sides.ior1, sides.ior2), c2);
        bool fresnel = (m.flags & LR_GPU_FRESNEL) != 0u;
        bool total = sides.solid && refracted_cosine_squared(cosine, sides.gamma) <= 0.0;
        float joins = mix(mix(0.0, 1.0, total), f, fresnel);
        b.mirror = m.reflect * mix(1.0, f, fresnel) + m.transmit * joins;
        b.through = m.transmit * (1.0 - joins);
    }
}

// Where a ray goes that a smooth surface lets through.
vec3 onward_direction(boundary sides, vec3 wo)
{
    float c2 = ex_sqrt(refracted_cosine_squared(wo.z, sides.gamma));
    return mix(-wo, vec3(-wo.xy * sides.gamma, -c2), bvec3(sides.solid));
}

// Glass, rough or not. Radiance grows with the square of the index of refraction. Light that microfacets
// send on to others is made up for by more of what gets out at once.
void load_glass(gpu_bsdf p, vec3 back, vec3 through, boundary sides, float cosine, inout bsdf b)
{
    float ratio = ex_div(sides.ior1, sides.ior2), c2;
    float f = glass_reflectance(cosine, ratio, c2);
    f = sides.solid ? f : sheet_reflectance(f);
    through = through * (sides.gamma * sides.gamma);
    bool rough = p.alpha >= LR_ALPHA_MIN && abs(ratio - 1.0) > LR_RATIO_FLAT;
    b.glass_alpha = max(p.alpha, LR_ALPHA_MIN);
    b.glass_ratio = ratio;
    b.glass_thin = !sides.solid;
    if (has_rough_glass) {
        float once = sides.solid ? glass_albedo(cosine, b.glass_alpha, ratio)
                                 : ggx_albedo(cosine, b.glass_alpha);
        float more = ex_rcp(once);
        b.glass_back = mix(vec3(0.0), back * more, bvec3(rough));
        b.glass_through = mix(vec3(0.0), through * more, bvec3(rough));
    }
    b.mirror = mix(back * f, vec3(0.0), bvec3(rough));
    b.through = mix(through * (1.0 - f), vec3(0.0), bvec3(rough));
    b.glass_share = rough ? f * brightest(back) + (1.0 - f) * brightest(through) : 0.0;
}

// GGX reflection: of a metal of the given colour, as eta and k say if they do, mixed with a dielectric of
// reflectance f0 at normal incidence. Light that microfacets reflect several times is added as a multiple
// of what they reflect once (Turquin, "Practical multiple scattering compensation for microfacet models",
// 2019).
void load_gloss(gpu_bsdf p, vec3 color, float metallic, float f0, float cosine, inout bsdf b)
{
    bool rough = has_gloss && p.alpha >= LR_ALPHA_MIN;
    float alpha = max(p.alpha, LR_ALPHA_MIN), lost = 0.0;
    if (has_gloss) {
        float once = ggx_albedo(cosine, alpha);
        lost = rough ? (1.0 - once) * ex_rcp(once) : 0.0;
    }
    vec3 of_metal = (vec3(1.0) + color * lost) * metallic;
    float of_other = (1.0 + f0 * lost) * (1.0 - metallic);
    b.facing = of_metal * color + vec3(of_other * f0);
    b.grazing = of_metal + vec3(of_other);
    vec3 tint = vec3(1.0);
    b.metal = has_metals && p.model == LR_GPU_MODEL_METAL;
    if (b.metal) {
        b.facing = p.eta;
        b.grazing = p.k;
        tint = color * (vec3(1.0) + metal_reflectance(1.0, p.eta, p.k) * lost);
    }
    vec3 mirror = tint * gloss_reflectance(b, cosine);
    b.gloss = mix(vec3(0.0), tint, bvec3(rough));
    b.gloss_alpha = alpha;
    b.gloss_share = rough ? brightest(mirror) * ex_rcp(1.0 + lost) : 0.0;
    b.mirror = mix(mirror, vec3(0.0), bvec3(rough));
}

// What is left of light below the reflection of a dielectric with a reflectance of f0 at normal
// incidence.
float left_below(gpu_bsdf p, float f0, float cosine)
{
    float w = schlick_weight(cosine), share = f0 + (1.0 - f0) * w;
    if (has_gloss && p.alpha >= LR_ALPHA_MIN) {
        float once = ggx_albedo(cosine, p.alpha);
        w = ggx_schlick(cosine, p.alpha);
        share = (f0 + (1.0 - f0) * w) * (once + f0 * (1.0 - once));
    }
    return 1.0 - min(share, 1.0);
}

// glTF 2.0, appendix B, and the extensions KHR_materials_transmission and _volume. Of glass and what is
// not, one is chosen by `spare` within [0, 1).
void load_pbr(gpu_bsdf p, vec3 color, boundary sides, float cosine, float spare, inout bsdf b)
{
    float glass = (1.0 - p.metallic) * p.transmission;
    float ratio = ex_div(sides.ior1, sides.ior2);
    float root = (1.0 - ratio) * ex_rcp(1.0 + ratio);
    float metallic = p.metallic * ex_rcp(max(1.0 - glass, 1.0e-6));
    float f0 = root * root;
    load_gloss(p, color, metallic, f0, cosine, b);
    b.matte = color * ((1.0 - metallic) * left_below(p, f0, cosine));
    if (has_rough_glass || has_delta) {
        bsdf pane = bsdf_black();
        load_glass(p, vec3(1.0), color, sides, cosine, pane);
        if (spare < glass)
            b = pane;
    }
}

// KHR_materials_sheen and, above it, KHR_materials_clearcoat: each dims what lies below by what it
// reflects.
void load_layers(gpu_bsdf p, float cosine, inout bsdf b)
{
    float left = 1.0, coat_mirror = 0.0;
    if (has_coat) {
        bool rough = p.coat_alpha >= LR_ALPHA_MIN;
        float alpha = max(p.coat_alpha, LR_ALPHA_MIN);
        float smooth_share = coat_f0 + (1.0 - coat_f0) * schlick_weight(cosine);
        float rough_share = (coat_f0 + (1.0 - coat_f0) * ggx_schlick(cosine, alpha)) *
                            ggx_albedo(cosine, alpha);
        float share = p.coat * mix(smooth_share, rough_share, rough);
        left = 1.0 - share;
        b.coat = rough ? p.coat : 0.0;
        b.coat_alpha = alpha;
        b.coat_share = rough ? share : 0.0;
        coat_mirror = rough ? 0.0 : share;
    }
    if (has_sheen) {
        // At grazing angles the formula would reflect more than there is.
        float share = brightest(p.sheen) * sheen_albedo(cosine, p.sheen_alpha);
        b.sheen = p.sheen * (left * ex_rcp(max(share, 1.0)));
        b.sheen_alpha = p.sheen_alpha;
        b.sheen_share = min(share, 1.0) * left;
        left = left * (1.0 - min(share, 1.0));
    }
    b.mirror = b.mirror * left + vec3(coat_mirror);
    b.matte = b.matte * left;
    b.gloss = b.gloss * left;
    b.gloss_share = b.gloss_share * left;
    b.glass_back = b.glass_back * left;
    b.glass_through = b.glass_through * left;
    b.glass_share = b.glass_share * left;
    b.through = b.through * left;
}

// Shares the samples among the lobes by how bright these are.
void share_samples(inout bsdf b)
{
    float sum = b.matte_share = brightest(b.matte);
    if (has_gloss)
        sum += b.gloss_share;
    if (has_rough_glass)
        sum += b.glass_share;
    if (has_coat)
        sum += b.coat_share;
    if (has_sheen)
        sum += b.sheen_share;
    if (has_highlight)
        sum += b.highlight_share = brightest(b.highlight) * min(8.0 * ex_rcp(b.shininess + 2.0), 1.0);
    if (has_delta) {
        sum += b.mirror_share = brightest(b.mirror);
        sum += b.through_share = brightest(b.through);
    }
    float scale = sum > 1.0e-12 ? ex_rcp(max(sum, 1.0e-12)) : 0.0;
    b.matte_share *= scale;
    b.gloss_share *= scale;
    b.glass_share *= scale;
    b.coat_share *= scale;
    b.sheen_share *= scale;
    b.highlight_share *= scale;
    b.mirror_share *= scale;
    b.through_share *= scale;
}

// The lobes that a surface of the material number `material` has for wo, with its colour there and what
// multiplies its roughness and metal; `spare` within [0, 1) chooses between glass and what is not, where a
// material is both in part.
bsdf load_bsdf(uint material, gpu_material m, vec3 color, vec2 gloss, boundary sides, vec3 wo,
               float spare)
{
    bsdf b = bsdf_black();
    float cosine = clamp(wo.z, 1.0e-4, 1.0);
    gpu_bsdf p;
    p.model = LR_GPU_MODEL_CLASSIC;
    if (has_models)
        p = load_model(material);
    if (has_models && has_gloss_maps) {
        p.roughness = p.roughness * gloss.x;
        p.alpha = mix(p.alpha, p.roughness * p.roughness, gloss.x < 1.0);
        p.metallic = p.metallic * gloss.y;
    }
    if (p.model == LR_GPU_MODEL_CLASSIC)
        load_classic(m, color, sides, cosine, b);
    if (has_models) {
        if (p.model == LR_GPU_MODEL_DIFFUSE) {
            b.matte = color;
            b.matte_roughness = p.roughness;
        }
        if ((has_delta || has_rough_glass) && p.model == LR_GPU_MODEL_DIELECTRIC)
            load_glass(p, vec3(1.0), m.transmit, sides, cosine, b);
        if (has_metals) {
            // As seen from the medium that they stand in.
            float inv = sides.ior1 == 1.0 ? 1.0 : ex_rcp(sides.ior1);
            p.eta *= inv;
            p.k *= inv;
        }
        if ((has_delta || has_gloss) && (p.model == LR_GPU_MODEL_CONDUCTOR || p.model == LR_GPU_MODEL_METAL))
            load_gloss(p, color, 1.0, 0.0, cosine, b);
        if (p.model == LR_GPU_MODEL_PBR) {
            load_pbr(p, color, sides, cosine, spare, b);
            if (has_coat || has_sheen)
                load_layers(p, cosine, b);
        }
    }
    if (has_delta)
        b.onward = onward_direction(sides, wo);
    share_samples(b);
    return b;
}

#endif
