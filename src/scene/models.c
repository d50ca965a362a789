#include "scene/models.h"

#include "scene/color.h"

#include <math.h>
#include <string.h>

#define MOST_SHININESS 1e6

const char *const lr_model_names[] = {"classic", "diffuse",    "dielectric", "conductor",
                                      "pbr",     "thin_glass", "mix",        NULL};
const char *const lr_metal_names[] = {"none",     "gold",     "silver", "copper", "aluminium",
                                      "chromium", "tungsten", "iron",   "nickel", NULL};

enum {
    CLASSIC = 1 << LR_MODEL_CLASSIC,
    DIFFUSE = 1 << LR_MODEL_DIFFUSE,
    DIELECTRIC = 1 << LR_MODEL_DIELECTRIC,
    CONDUCTOR = 1 << LR_MODEL_CONDUCTOR,
    PBR = 1 << LR_MODEL_PBR,
    THIN_GLASS = 1 << LR_MODEL_THIN_GLASS,
    MIX = 1 << LR_MODEL_MIX,
};

/* Keys that are not every model's. */
static const struct {
    const char *key;
    unsigned models;
} keys[] = {
    {"color", CLASSIC | DIFFUSE | CONDUCTOR | PBR},
    {"ambient", CLASSIC},
    {"diffuse", CLASSIC},
    {"specular", CLASSIC},
    {"shininess", CLASSIC},
    {"highlight", CLASSIC},
    {"reflect", CLASSIC},
    {"transmit", CLASSIC | DIELECTRIC | THIN_GLASS},
    {"ior", CLASSIC | DIELECTRIC | PBR | THIN_GLASS},
    {"fresnel", CLASSIC},
    {"absorption", CLASSIC | DIELECTRIC | PBR},
    {"scattering", CLASSIC | DIELECTRIC | PBR},
    {"anisotropy", CLASSIC | DIELECTRIC | PBR},
    {"priority", CLASSIC | DIELECTRIC | PBR},
    {"roughness", DIFFUSE | DIELECTRIC | CONDUCTOR | PBR | THIN_GLASS},
    {"metal", CONDUCTOR},
    {"eta", CONDUCTOR},
    {"k", CONDUCTOR},
    {"metallic", PBR},
    {"transmission", PBR},
    {"clearcoat", PBR},
    {"clearcoat_roughness", PBR},
    {"sheen", PBR},
    {"sheen_roughness", PBR},
    {"roughness_map", DIFFUSE | DIELECTRIC | CONDUCTOR | PBR | THIN_GLASS},
    {"metallic_map", PBR},
    {"alpha_cutoff", CLASSIC | DIFFUSE | DIELECTRIC | CONDUCTOR | PBR | THIN_GLASS},
    {"normal_map", CLASSIC | DIFFUSE | DIELECTRIC | CONDUCTOR | PBR | THIN_GLASS},
    {"bump_map", CLASSIC | DIFFUSE | DIELECTRIC | CONDUCTOR | PBR | THIN_GLASS},
    {"first", MIX},
    {"second", MIX},
    {"weight", MIX},
};

bool lr_model_has_key(lr_model model, const char *key)
{
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        if (strcmp(keys[i].key, key) == 0)
            return keys[i].models >> model & 1;
    return true;
}

bool lr_model_is_glass(lr_model model)
{
    return model == LR_MODEL_DIELECTRIC || model == LR_MODEL_THIN_GLASS;
}

/* The measurements that luxpop.com collects (gold, silver, copper, aluminium, chromium, tungsten),
 * Palik's (nickel), integrated with the colour matching functions of linear sRGB; of iron those of
 * Johnson and Christy (1974) at 650, 550 and 450 nm. */
static const lr_color metals[][2] = {
    [LR_METAL_GOLD] = {{0.14304, 0.37531, 1.44205}, {3.983, 2.38556, 1.60336}},
    [LR_METAL_SILVER] = {{0.15528, 0.11673, 0.13839}, {4.82835, 3.12222, 2.1469}},
    [LR_METAL_COPPER] = {{0.20101, 0.92375, 1.10222}, {3.91326, 2.45305, 2.14209}},
    [LR_METAL_ALUMINIUM] = {{1.6575, 0.8804, 0.52124}, {9.22381, 6.2695, 4.837}},
    [LR_METAL_CHROMIUM] = {{4.36967, 2.91651, 1.6549}, {5.20655, 4.23131, 3.7547}},
    [LR_METAL_TUNGSTEN] = {{4.37082, 3.30025, 2.99841}, {3.50064, 2.60487, 2.27323}},
    [LR_METAL_IRON] = {{2.9114, 2.9497, 2.5845}, {3.0893, 2.9318, 2.767}},
    [LR_METAL_NICKEL] = {{2.3673, 1.66337, 1.46708}, {4.49881, 3.05015, 2.34544}},
};

void lr_metal_index(lr_metal metal, lr_color *eta, lr_color *k)
{
    *eta = metals[metal][0];
    *k = metals[metal][1];
}

static double facing(double eta, double k)
{
    double sum = (eta + 1) * (eta + 1) + k * k;
    return ((eta - 1) * (eta - 1) + k * k) / sum;
}

lr_color lr_metal_facing(lr_color eta, lr_color k)
{
    return (lr_color){facing(eta.x, k.x), facing(eta.y, k.y), facing(eta.z, k.z)};
}

static lr_color grey(double value)
{
    return (lr_color){value, value, value};
}

static lr_color multiply(lr_color a, lr_color b)
{
    return (lr_color){a.x * b.x, a.y * b.y, a.z * b.z};
}

static double greatest(lr_color c)
{
    return fmax(c.x, fmax(c.y, c.z));
}

/* The highlight and the mirror of a surface that reflects `f0` straight back; returns the share of
 * mirror-like reflection. It fades out at a roughness of 0.5: what a rougher one spreads is matt.
 */
static double set_reflection(lr_material *m, lr_color f0)
{
    double mirror = fmax(0, 1 - 2 * m->roughness), width = m->roughness * m->roughness;
    m->shininess = fmin(fmax(2 / fmax(width * width, 1e-12) - 2, 0), MOST_SHININESS);
    /* (n + 8) / 8 keeps the light of a Blinn-Phong highlight the same for all widths; held at 1.
     * The widest would be a second matt share. */
    double strength = fmin((m->shininess + 8) / 8, 1 / fmax(greatest(f0), 1e-6));
    m->specular = lr_vec3_scale(f0, strength * (1 - m->roughness));
    m->reflect = lr_vec3_scale(f0, mirror);
    return mirror;
}

static void approximate_conductor(lr_material *m)
{
    bool metal = greatest(m->eta) > 0 || greatest(m->k) > 0;
    lr_color f0 = m->color.colors[0];
    if (metal)
        f0 = multiply(f0, lr_metal_facing(m->eta, m->k));
    f0 = (lr_color){fmin(f0.x, 1), fmin(f0.y, 1), fmin(f0.z, 1)};
    double mirror = set_reflection(m, f0);
    m->diffuse = lr_vec3_scale(metal ? lr_metal_facing(m->eta, m->k) : grey(1), 1 - mirror);
}

static void approximate_pbr(lr_material *m)
{
    /* Where a picture tells what is metal, most is not. */
    double root = (m->ior - 1) / (m->ior + 1);
    double metallic = m->maps[LR_MAP_METALLIC].given ? 0 : m->metallic;
    double through = m->transmission * (1 - metallic);
    lr_color color = m->color.colors[0];
    color = (lr_color){fmin(color.x, 1), fmin(color.y, 1), fmin(color.z, 1)};
    lr_color f0 = lr_vec3_add(grey((1 - metallic) * root * root), lr_vec3_scale(color, metallic));
    double mirror = set_reflection(m, f0);
    m->diffuse = grey((1 - metallic) * (1 - m->transmission) + metallic * (1 - mirror));
    m->transmit = lr_vec3_scale(color, through);
    m->fresnel = through > 0;
}

void lr_approximate(lr_material *m)
{
    m->specular = m->reflect = m->diffuse = grey(0);
    m->fresnel = lr_model_is_glass(m->model);
    if (m->model == LR_MODEL_DIFFUSE)
        m->diffuse = grey(1);
    if (m->model == LR_MODEL_CONDUCTOR)
        approximate_conductor(m);
    if (m->model == LR_MODEL_PBR)
        approximate_pbr(m);
    m->ambient = m->diffuse;
}

/* ---- Mixes ---- */

static lr_color blend(lr_color a, lr_color b, double share)
{
    return lr_vec3_add(lr_vec3_scale(a, 1 - share), lr_vec3_scale(b, share));
}

/* The mean of about 2^16 texels. */
static lr_color texture_mean(const lr_texture *t)
{
    double linear[256];
    for (unsigned i = 0; i < 256; i++)
        linear[i] = lr_srgb_to_linear(i);
    size_t count = (size_t)t->width * t->height, step = 1 + count / 65536, used = 0;
    lr_color sum = {0, 0, 0};
    for (size_t i = 0; i < count; i += step, used++) {
        const uint8_t *b = t->bytes ? &t->bytes[4 * i] : NULL;
        const float *f = b ? NULL : &t->floats[3 * i];
        lr_color texel =
            b ? (lr_color){linear[b[0]], linear[b[1]], linear[b[2]]} : (lr_color){f[0], f[1], f[2]};
        sum = lr_vec3_add(sum, texel);
    }
    return lr_vec3_scale(sum, 1.0 / (double)used);
}

static lr_color pattern_mean(const lr_scene *scene, const lr_pattern *p)
{
    if (p->kind == LR_PATTERN_NONE)
        return p->colors[0];
    if (p->kind == LR_PATTERN_IMAGE && p->texture >= scene->texture_count)
        return p->colors[0]; /* it could not be read */
    if (p->kind == LR_PATTERN_IMAGE)
        return multiply(p->colors[0], texture_mean(&scene->textures[p->texture]));
    return blend(p->colors[0], p->colors[1], 0.5);
}

static double weight_of(lr_color weight)
{
    return fmin(lr_color_luminance(weight), 1);
}

static void take_inside(lr_material *m, const lr_material *from)
{
    m->ior = from->ior;
    m->absorption = from->absorption;
    m->scattering = from->scattering;
    m->anisotropy = from->anisotropy;
    m->priority = from->priority;
    m->pane = from->pane;
}

static double ratio(double a, double b)
{
    return b > 0 ? a / b : 0;
}

void lr_approximate_mix(const lr_scene *scene, lr_material *m)
{
    const lr_material *first = &scene->materials[m->mix.first];
    const lr_material *second = &scene->materials[m->mix.second];
    const lr_pattern *weight = &m->mix.weight;
    double share = weight_of(pattern_mean(scene, weight));
    lr_color first_color = pattern_mean(scene, &first->color);
    lr_color second_color = pattern_mean(scene, &second->color);
    lr_color matt[2] = {multiply(first->diffuse, first_color),
                        multiply(second->diffuse, second_color)};
    m->color = *weight;
    for (int i = 0; i < 2; i++)
        m->color.colors[i] = blend(matt[0], matt[1], weight_of(weight->colors[i]));
    if (weight->kind == LR_PATTERN_IMAGE) {
        m->color.kind = LR_PATTERN_NONE;
        m->color.colors[0] = m->color.colors[1] = blend(matt[0], matt[1], share);
    }
    lr_color mean = blend(matt[0], matt[1], share);
    lr_color ambient = blend(multiply(first->ambient, first_color),
                             multiply(second->ambient, second_color), share);
    m->diffuse = grey(1);
    m->ambient =
        (lr_color){ratio(ambient.x, mean.x), ratio(ambient.y, mean.y), ratio(ambient.z, mean.z)};
    m->specular = blend(first->specular, second->specular, share);
    m->reflect = blend(first->reflect, second->reflect, share);
    m->transmit = blend(first->transmit, second->transmit, share);
    bool second_shines =
        greatest(second->specular) * share > greatest(first->specular) * (1 - share);
    m->shininess = second_shines ? second->shininess : first->shininess;
    m->highlight = second_shines ? second->highlight : first->highlight;
    bool second_transmits = greatest(second->transmit) > greatest(first->transmit);
    take_inside(m, second_transmits ? second : first);
    double mirror_first = (1 - share) * greatest(lr_vec3_add(first->reflect, first->transmit));
    double mirror_second = share * greatest(lr_vec3_add(second->reflect, second->transmit));
    m->fresnel = mirror_second > mirror_first ? second->fresnel : first->fresnel;
}
