// What a surface does with light, as a sum of lobes. Directions are local: the normal is +z on the side
// that wo is on, and wo and wi both point away from the surface. bsdf_load.glsl makes the lobes of a
// material; what depends on wo alone is in them already.
#ifndef BSDF_GLSL
#define BSDF_GLSL

#include "bindings.glsl"
#include "bsdf_diffuse.glsl"
#include "bsdf_ggx.glsl"
#include "bsdf_sheen.glsl"

struct bsdf {
    vec3 matte; // albedo
    float matte_roughness;
    vec3 gloss;       // factor of the GGX reflection, beside Fresnel's
    float gloss_alpha;
    vec3 facing;      // reflectance at normal incidence, or eta of a metal
    bool metal;
    vec3 grazing;     // at grazing incidence, or k
    float glass_alpha;
    vec3 glass_back;    // factors of the rough dielectric, beside Fresnel's: reflected,
    float glass_ratio;  // index of refraction on wo's side over that beyond; above 0
    vec3 glass_through; // and transmitted light
    bool glass_thin;    // a sheet: light goes straight on
    float coat;         // factor of a GGX reflection with an index of refraction of 1.5
    float coat_alpha;
    vec3 sheen;
    float sheen_alpha;
    vec3 highlight; // Blinn's or Phong's lobe: times cos^shininess / pi
    float shininess;
    bool phong;
    vec3 mirror;  // weights of the mirrored ray,
    vec3 through; // and of the one that goes on
    vec3 onward;  // in this direction, unit
    // The shares of samples that the lobes get; they add up to 1, or are
    // all 0 where the surface is black.
    float matte_share;
    float gloss_share;
    float glass_share;
    float coat_share;
    float sheen_share;
    float highlight_share;
    float mirror_share;
    float through_share;
};

struct bsdf_value {
    vec3 f;    // times |cos|
    float pdf; // of sample_bsdf, per steradian, without its delta lobes
};

struct bsdf_sample {
    vec3 wi;     // unit
    vec3 weight; // f |cos| / pdf; 0 where nothing was found
    float pdf;   // 0 for delta lobes
    uint kind;   // LR_BSDF_REFLECTS or LR_BSDF_TRANSMITS, with LR_BSDF_DELTA; 0: absorbed
};

const float coat_f0 = 0.04;

// A black surface.
bsdf bsdf_black()
{
    vec3 none = vec3(0.0);
    return bsdf(none, 0.0, none, 1.0, none, false, none, 1.0, none, 1.0, none, false, 0.0, 1.0, none,
                1.0, none, 1.0, false, none, none, vec3(0.0, 0.0, -1.0), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0,
                0.0, 0.0);
}

float brightest(vec3 v)
{
    return max(v.x, max(v.y, v.z));
}

vec3 mirrored(vec3 wo)
{
    return vec3(-wo.xy, wo.z);
}

// Fresnel's factor of the GGX reflection.
vec3 gloss_reflectance(bsdf b, float cosine)
{
    float w = schlick_weight(cosine);
    vec3 f = b.facing * (1.0 - w) + b.grazing * w;
    if (has_metals && b.metal)
        f = metal_reflectance(cosine, b.facing, b.grazing);
    return f;
}

// The lobes below add themselves to a value; wi.z is above 0 for all but glass.
void add_matte(bsdf b, vec3 wo, vec3 wi, inout bsdf_value value)
{
    vec3 albedo = b.matte;
    if (has_oren_nayar)
        albedo = mix(albedo, eon(b.matte, b.matte_roughness, wo, wi),
                     bvec3(b.matte_roughness > 0.0));
    value.f += albedo * (bsdf_inv_pi * wi.z);
    value.pdf += b.matte_share * bsdf_inv_pi * wi.z;
}

void add_gloss(bsdf b, vec3 wo, vec3 wi, vec3 h, inout bsdf_value value)
{
    float cosine = max(ex_dot(wo, h), 0.0);
    float pdf = 0.5 * ggx_facets(b.gloss_alpha, h) *
                ex_rcp(wo.z + ggx_slant(b.gloss_alpha, wo.z));
    value.f += b.gloss * gloss_reflectance(b, cosine) *
               (pdf * ggx_escape(b.gloss_alpha, wo, wi.z));
    value.pdf += b.gloss_share * pdf;
}

void add_coat(bsdf b, vec3 wo, vec3 wi, vec3 h, inout bsdf_value value)
{
    float w = schlick_weight(max(ex_dot(wo, h), 0.0));
    float pdf =
        0.5 * ggx_facets(b.coat_alpha, h) * ex_rcp(wo.z + ggx_slant(b.coat_alpha, wo.z));
    value.f += vec3(b.coat * (coat_f0 + (1.0 - coat_f0) * w) * pdf *
                    ggx_escape(b.coat_alpha, wo, wi.z));
    value.pdf += b.coat_share * pdf;
}

void add_sheen(bsdf b, vec3 wo, vec3 wi, vec3 h, inout bsdf_value value)
{
    value.f += b.sheen * (charlie(b.sheen_alpha, wo, wi, h) * wi.z);
    value.pdf += b.sheen_share * 0.5 * bsdf_inv_pi;
}

// A point light of intensity 1 at distance 1, which brings pi, shows the highlight of classic.glsl.
void add_highlight(bsdf b, vec3 wo, vec3 wi, vec3 h, inout bsdf_value value)
{
    float peak = b.phong ? ex_dot(mirrored(wo), wi) : h.z;
    float lobe = peak > LR_COSINE_MIN ? ex_pow(min(peak, 1.0), b.shininess) * bsdf_inv_pi : 0.0;
    float per_wi = b.phong ? 1.0 : 0.25 * ex_rcp(max(ex_dot(wo, h), 1.0e-7));
    value.f += b.highlight * lobe;
    value.pdf += b.highlight_share * lobe * 0.5 * (b.shininess + 1.0) * per_wi;
}

// A thin sheet reflects at both of its faces: f + (1 - f)^2 f + (1 - f)^2 f^3 + ... = 2 f / (1 + f).
float sheet_reflectance(float f)
{
    return 2.0 * f * ex_rcp(1.0 + f);
}

float pane_reflectance(bsdf b, float f)
{
    return b.glass_thin ? sheet_reflectance(f) : f;
}

// Walter et al., equations 20 and 21, with their m as m and radiance as what is carried: what comes
// through scales with the square of the index of refraction. In a thin sheet it is the reflection, on
// the other side.
void add_glass(bsdf b, vec3 wo, vec3 wi, inout bsdf_value value)
{
    bool back = wi.z > 0.0, flat_wi = back || b.glass_thin;
    vec3 sum = flat_wi ? wo + vec3(wi.xy, abs(wi.z)) : wo * b.glass_ratio + wi;
    vec3 m = sum * ex_rsqrt(max(ex_dot(sum, sum), 1.0e-20));
    m = m.z < 0.0 ? -m : m;
    float co = ex_dot(wo, m), ci = abs(ex_dot(wi, m)), c2;
    float f = pane_reflectance(b, glass_reflectance(clamp(co, 0.0, 1.0), b.glass_ratio, c2));
    float bent = max(abs(b.glass_ratio * co - ci), 1.0e-7);
    float per_wi = flat_wi ? 0.25 * ex_rcp(max(co, 1.0e-7)) : ci * ex_rcp(bent * bent);
    bool possible = co > 0.0 && (flat_wi || ex_dot(wi, m) < 0.0);
    float seen = possible ? ggx_visible(b.glass_alpha, wo, m) * per_wi : 0.0;
    float share = back ? f : 1.0 - f;
    value.f += (back ? b.glass_back : b.glass_through) *
               (share * seen * ggx_escape(b.glass_alpha, wo, abs(wi.z)));
    value.pdf += b.glass_share * share * seen;
}

// The lobes but for delta lobes.
bsdf_value evaluate_bsdf(bsdf b, vec3 wo, vec3 wi)
{
    bsdf_value value = bsdf_value(vec3(0.0), 0.0);
    vec3 h = half_way(wo, wi);
    bool above = wi.z > LR_COSINE_MIN;
    if (above)
        add_matte(b, wo, wi, value);
    if (has_gloss && above && b.gloss_share > 0.0)
        add_gloss(b, wo, wi, h, value);
    if (has_rough_glass && abs(wi.z) > LR_COSINE_MIN && b.glass_share > 0.0)
        add_glass(b, wo, wi, value);
    if (has_coat && above && b.coat_share > 0.0)
        add_coat(b, wo, wi, h, value);
    if (has_sheen && above)
        add_sheen(b, wo, wi, h, value);
    if (has_highlight && above && b.highlight_share > 0.0)
        add_highlight(b, wo, wi, h, value);
    return value;
}

// The reflection about a microfacet of the given width.
vec3 gloss_sample(float alpha, vec3 wo, vec2 u)
{
    return -reflect_direction(wo, ggx_sample(alpha, wo, u));
}

// Which of reflection and refraction is for `choice` within [0, 1) to tell.
vec3 glass_sample(bsdf b, vec3 wo, vec2 u, float choice)
{
    vec3 m = ggx_sample(b.glass_alpha, wo, u);
    float co = clamp(ex_dot(wo, m), 0.0, 1.0), c2;
    float f = pane_reflectance(b, glass_reflectance(co, b.glass_ratio, c2));
    vec3 back = -reflect_direction(wo, m);
    vec3 bent = refract_direction(-wo, m, co, c2, b.glass_ratio);
    bool reflects = choice < f;
    vec3 through = mix(bent, vec3(back.xy, -back.z), bvec3(b.glass_thin));
    vec3 wi = mix(through, back, bvec3(reflects));
    // What leaves on the wrong side meets another microfacet, and is left to `compensation`.
    bool right = reflects == (wi.z > 0.0);
    return mix(vec3(0.0), wi, bvec3(right));
}

vec3 highlight_sample(bsdf b, vec3 wo, vec2 u)
{
    float cosine = ex_pow(max(1.0 - u.y, 1.0e-7), ex_rcp(b.shininess + 1.0));
    vec3 h = vec3(ex_cos_sin_turns(u.x) * ex_sqrt(max(1.0 - cosine * cosine, 0.0)), cosine);
    vec3 r = mirrored(wo);
    // Phong's lobe is around r: the pole is taken there along the shortest way.
    vec3 half_r = half_way(r, vec3(0.0, 0.0, 1.0));
    vec3 turned = -reflect_direction(vec3(-h.xy, h.z), half_r);
    return b.phong ? turned : -reflect_direction(wo, h);
}

vec3 sheen_sample(vec2 u)
{
    return vec3(ex_cos_sin_turns(u.x) * ex_sqrt(max(1.0 - u.y * u.y, 0.0)), u.y);
}

// Whether the lobe that begins at `start` is chosen; moves on to the next one.
bool chosen(float u, float share, inout float start)
{
    float from = start;
    start = start + share;
    return u >= from && u < start;
}

// A direction for light to come from, chosen by numbers within [0, 1).
bsdf_sample sample_bsdf(bsdf b, vec3 wo, float lobe, vec2 u)
{
    float start = b.matte_share;
    vec3 wi = cosine_sample(u), weight = vec3(0.0);
    bool delta = false;
    if (has_gloss && chosen(lobe, b.gloss_share, start))
        wi = gloss_sample(b.gloss_alpha, wo, u);
    float glass_start = start;
    if (has_rough_glass && chosen(lobe, b.glass_share, start))
        wi = glass_sample(b, wo, u, (lobe - glass_start) * ex_rcp(b.glass_share));
    if (has_coat && chosen(lobe, b.coat_share, start))
        wi = gloss_sample(b.coat_alpha, wo, u);
    if (has_sheen && chosen(lobe, b.sheen_share, start))
        wi = sheen_sample(u);
    if (has_highlight && chosen(lobe, b.highlight_share, start))
        wi = highlight_sample(b, wo, u);
    if (has_delta) {
        bool back = chosen(lobe, b.mirror_share, start);
        bool through = b.through_share > 0.0 && lobe >= start;
        delta = back || through;
        wi = mix(mix(wi, b.onward, bvec3(through)), mirrored(wo), bvec3(back));
        weight = mix(b.through * ex_rcp(max(b.through_share, 1.0e-20)),
                     b.mirror * ex_rcp(max(b.mirror_share, 1.0e-20)), bvec3(back));
    }
    bsdf_value value = evaluate_bsdf(b, wo, wi);
    bool found = value.pdf > 1.0e-20;
    vec3 spread = value.f * ex_rcp(found ? value.pdf : 1.0);
    weight = mix(mix(vec3(0.0), spread, bvec3(found)), weight, bvec3(delta));
    uint kind = (wi.z > 0.0 ? LR_BSDF_REFLECTS : LR_BSDF_TRANSMITS) | (delta ? LR_BSDF_DELTA : 0u);
    return bsdf_sample(wi, weight, delta || !found ? 0.0 : value.pdf, delta || found ? kind : 0u);
}

#endif
