/* The physical side of materials, for paths, and the tables of what rough surfaces reflect. */
#include <math.h>

#include "albedo.h"
#include "render/pack.h"

static lr_status no_memory(lr_error *error)
{
    return lr_fail(error, LR_ERROR_MEMORY, "out of memory for the scene's materials");
}

static float alpha_of(double roughness)
{
    return (float)(roughness * roughness);
}

static uint32_t gpu_model(const lr_material *m)
{
    bool metal = !lr_color_is_black(m->eta) || !lr_color_is_black(m->k);
    switch (m->model) {
    case LR_MODEL_CLASSIC:
        return LR_GPU_MODEL_CLASSIC;
    case LR_MODEL_DIFFUSE:
        return LR_GPU_MODEL_DIFFUSE;
    case LR_MODEL_DIELECTRIC:
    case LR_MODEL_THIN_GLASS:
        return LR_GPU_MODEL_DIELECTRIC;
    case LR_MODEL_CONDUCTOR:
        return metal ? LR_GPU_MODEL_METAL : LR_GPU_MODEL_CONDUCTOR;
    case LR_MODEL_PBR:
        return LR_GPU_MODEL_PBR;
    case LR_MODEL_MIX: /* of others */
        break;
    }
    return LR_GPU_MODEL_CLASSIC;
}

static void pack_bsdf(const lr_material *m, struct gpu_bsdf *out)
{
    *out = (struct gpu_bsdf){
        .eta = lr_pack_vec3(m->eta),
        .model = gpu_model(m),
        .k = lr_pack_vec3(m->k),
        .alpha = alpha_of(m->roughness),
        .sheen = lr_pack_vec3(m->sheen),
        .sheen_alpha = fmaxf(alpha_of(m->sheen_roughness), (float)LR_SHEEN_ALPHA_MIN),
        .coat = (float)m->clearcoat,
        .coat_alpha = alpha_of(m->clearcoat_roughness),
        .metallic = (float)m->metallic,
        .transmission = (float)m->transmission,
        .roughness = (float)m->roughness,
    };
}

/* The least value of a channel in the picture that multiplies a roughness; 1 without a picture. */
static double least_share(const lr_scene *scene, const lr_map *map)
{
    const lr_texture *t = map->given ? &scene->textures[map->texture] : NULL;
    double least = 1;
    for (size_t i = 0; t && i < (size_t)t->width * t->height; i++) {
        double alpha = t->floats ? 1 : t->bytes[4 * i + 3] / 255.0;
        double value = map->channel == LR_CHANNEL_ALPHA ? alpha
                       : t->floats                      ? t->floats[3 * i + map->channel]
                                                        : t->bytes[4 * i + map->channel] / 255.0;
        least = fmin(least, value);
    }
    return least;
}

/* Whether the material may be smooth somewhere, whatever is rounded. */
static bool may_be_smooth(const lr_scene *scene, const lr_material *m)
{
    double least = m->roughness * least_share(scene, &m->maps[LR_MAP_ROUGHNESS]);
    return least * least < LR_ALPHA_MIN * 1.001;
}

/* What the material needs of the kernel. */
static void note_use(const lr_scene *scene, const lr_material *m, const struct gpu_bsdf *p,
                     uint32_t *use)
{
    bool rough = p->alpha >= LR_ALPHA_MIN;
    bool glass = p->model == LR_GPU_MODEL_DIELECTRIC || p->transmission > 0;
    bool gloss = p->model == LR_GPU_MODEL_CONDUCTOR || p->model == LR_GPU_MODEL_METAL ||
                 p->model == LR_GPU_MODEL_PBR;
    use[LR_SPEC_MODELS] |= p->model != LR_GPU_MODEL_CLASSIC;
    use[LR_SPEC_METALS] |= p->model == LR_GPU_MODEL_METAL;
    use[LR_SPEC_OREN_NAYAR] |= p->model == LR_GPU_MODEL_DIFFUSE && p->roughness > 0;
    use[LR_SPEC_GLOSS] |= gloss && rough;
    use[LR_SPEC_ROUGH_GLASS] |= glass && rough;
    /* Glass may lie in a medium of the same index of refraction. */
    use[LR_SPEC_DELTA] |= glass || (gloss && may_be_smooth(scene, m));
    use[LR_SPEC_COAT] |= p->coat > 0;
    use[LR_SPEC_DELTA] |= p->coat > 0 && p->coat_alpha < LR_ALPHA_MIN;
    use[LR_SPEC_SHEEN] |= !lr_color_is_black(m->sheen);
    if (p->model == LR_GPU_MODEL_CLASSIC) {
        use[LR_SPEC_HIGHLIGHT] |= !lr_color_is_black(m->specular);
        use[LR_SPEC_DELTA] |= !lr_color_is_black(m->reflect) || !lr_color_is_black(m->transmit);
    }
}

/* The values at the corners of each cell of `layers` rectangles. */
static bool pack_table(const float *values, uint32_t columns, uint32_t rows, uint32_t layers,
                       lr_packed_scene *packed)
{
    uint32_t pitch = columns + 1;
    for (uint32_t i = 0; i < layers * rows * columns; i++) {
        uint32_t layer = i / (rows * columns), row = i / columns % rows, column = i % columns;
        const float *at = &values[(layer * (rows + 1) + row) * pitch + column];
        vec4 cell = {at[0], at[1], at[pitch], at[pitch + 1]};
        if (lr_pack_rows(packed, &cell, 1) == UINT32_MAX)
            return false;
    }
    return true;
}

static bool pack_tables(lr_packed_scene *packed)
{
    static const float *const tables[] = {
        [LR_ALBEDO_GGX] = albedo_ggx,
        [LR_ALBEDO_SCHLICK] = albedo_schlick,
        [LR_ALBEDO_SHEEN] = albedo_sheen,
    };
    const uint32_t *use = packed->constants;
    packed->frame.albedo = packed->row_count;
    bool needed =
        use[LR_SPEC_GLOSS] || use[LR_SPEC_ROUGH_GLASS] || use[LR_SPEC_COAT] || use[LR_SPEC_SHEEN];
    for (size_t i = 0; needed && i < sizeof tables / sizeof *tables; i++)
        if (!pack_table(tables[i], LR_ALBEDO_CELLS, LR_ALBEDO_CELLS, 1, packed))
            return false;
    packed->frame.glass_albedo = packed->row_count;
    return !use[LR_SPEC_ROUGH_GLASS] || pack_table(albedo_glass, LR_GLASS_COLUMNS, LR_GLASS_ROWS,
                                                   LR_GLASS_INTO + LR_GLASS_OUT_OF, packed);
}

/* Of every material its parts, if any is a mix and paths are to choose them. */
static bool pack_mixes(const lr_scene *scene, lr_packed_scene *packed)
{
    bool mixed = false, good = true;
    for (uint32_t i = 0; i < scene->material_count; i++)
        mixed = mixed || scene->materials[i].model == LR_MODEL_MIX;
    packed->constants[LR_SPEC_MIX] = mixed && packed->constants[LR_SPEC_PATH];
    packed->frame.mixes = packed->row_count;
    for (uint32_t i = 0; mixed && good && i < scene->material_count; i++) {
        const lr_material *m = &scene->materials[i];
        struct gpu_mix record = {.first = LR_GPU_MIX_NONE};
        if (m->model == LR_MODEL_MIX)
            record = (struct gpu_mix){.first = m->mix.first, .second = m->mix.second};
        good = lr_pack_rows(packed, &record, sizeof record / 16) != UINT32_MAX;
    }
    return good;
}

lr_status lr_pack_bsdfs(const lr_scene *scene, lr_packed_scene *packed, lr_error *error)
{
    uint32_t *use = packed->constants;
    packed->frame.bsdfs = packed->row_count;
    for (uint32_t i = 0; i < scene->material_count; i++) {
        struct gpu_bsdf record;
        pack_bsdf(&scene->materials[i], &record);
        if (scene->materials[i].model != LR_MODEL_MIX)
            note_use(scene, &scene->materials[i], &record, use);
        if (lr_pack_rows(packed, &record, sizeof record / 16) == UINT32_MAX)
            return no_memory(error);
    }
    return pack_mixes(scene, packed) && pack_tables(packed) ? LR_OK : no_memory(error);
}
