/* Pictures of materials that are not their colour. */
#include "render/pack_internal.h"

/* The kernels that look a map up; those of gloss are for paths alone. */
static const struct {
    uint32_t constant;
    bool for_paths;
} uses[LR_MAP_COUNT] = {
    [LR_MAP_NORMAL] = {LR_SPEC_NORMAL_MAPS, false},
    [LR_MAP_BUMP] = {LR_SPEC_BUMP_MAPS, false},
    [LR_MAP_ROUGHNESS] = {LR_SPEC_GLOSS_MAPS, true},
    [LR_MAP_METALLIC] = {LR_SPEC_GLOSS_MAPS, true},
    [LR_MAP_EMISSION] = {LR_SPEC_EMISSION_MAPS, false},
};

static bool note_use(const lr_scene *scene, bool paths, uint32_t *constants)
{
    bool any = false;
    for (uint32_t i = 0; i < scene->material_count; i++)
        for (int k = 0; k < LR_MAP_COUNT; k++) {
            bool used = scene->materials[i].maps[k].given && (paths || !uses[k].for_paths);
            constants[uses[k].constant] |= used;
            any = any || used;
        }
    return any;
}

static uint32_t row_of(const lr_map *map)
{
    return map->given ? map->texture : LR_NO_MAP;
}

static bool mirrors(const lr_material *m)
{
    bool classic = m->model == LR_MODEL_CLASSIC;
    return classic ? !lr_color_is_black(m->specular) || !lr_color_is_black(m->reflect)
                   : m->model != LR_MODEL_DIFFUSE;
}

static void pack_maps(const lr_material *m, struct gpu_maps *out)
{
    const lr_map *maps = m->maps;
    *out = (struct gpu_maps){
        .normal = row_of(&maps[LR_MAP_NORMAL]),
        .normal_scale = (float)maps[LR_MAP_NORMAL].amount,
        .bump = row_of(&maps[LR_MAP_BUMP]),
        .bump_height = (float)maps[LR_MAP_BUMP].amount,
        .roughness = row_of(&maps[LR_MAP_ROUGHNESS]),
        .metallic = row_of(&maps[LR_MAP_METALLIC]),
        .emission = row_of(&maps[LR_MAP_EMISSION]),
        .flags = (uint32_t)maps[LR_MAP_ROUGHNESS].channel |
                 (uint32_t)maps[LR_MAP_METALLIC].channel << LR_GPU_MAPS_METALLIC_SHIFT |
                 (mirrors(m) && lr_material_has_relief(m) ? LR_GPU_MAPS_MIRROR : 0),
    };
}

lr_status lr_pack_maps(const lr_scene *scene, lr_packed_scene *packed, lr_error *error)
{
    packed->frame.maps = packed->row_count;
    if (!note_use(scene, packed->constants[LR_SPEC_PATH], packed->constants))
        return LR_OK;
    packed->constants[LR_SPEC_TEXTURES] = 1;
    for (uint32_t i = 0; i < scene->material_count; i++) {
        struct gpu_maps record;
        pack_maps(&scene->materials[i], &record);
        if (lr_pack_rows(packed, &record, LR_MAP_ROWS) == UINT32_MAX)
            return lr_fail(error, LR_ERROR_MEMORY, "out of memory for the scene's materials");
    }
    return LR_OK;
}
