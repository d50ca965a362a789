#include "render/pack_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "scene/camera.h"

#define LOG2_E 1.4426950408889634

vec3 lr_pack_vec3(lr_vec3 v)
{
    return (vec3){(float)v.x, (float)v.y, (float)v.z};
}

bool lr_pack_reserve(lr_packed_scene *packed, uint64_t rows)
{
    uint64_t wanted = packed->row_count + rows;
    if (wanted <= packed->row_capacity)
        return true;
    if (wanted >= UINT32_MAX)
        return false;
    /* By half at least, so that growing often is not slow. */
    uint64_t grown_by_half = packed->row_capacity + (uint64_t)packed->row_capacity / 2 + 64;
    wanted = wanted > grown_by_half ? wanted : grown_by_half;
    wanted = wanted < UINT32_MAX ? wanted : UINT32_MAX;
    vec4 *grown = lr_alloc_large(wanted, sizeof *grown);
    if (!grown)
        return false;
    if (packed->rows)
        memcpy(grown, packed->rows, packed->row_count * sizeof *grown);
    free(packed->rows);
    packed->rows = grown;
    packed->row_capacity = (uint32_t)wanted;
    return true;
}

uint32_t lr_pack_rows(lr_packed_scene *packed, const void *record, uint32_t rows)
{
    if (!lr_pack_reserve(packed, rows))
        return UINT32_MAX;
    uint32_t first = packed->row_count;
    memcpy(&packed->rows[first], record, 16 * (size_t)rows);
    packed->row_count += rows;
    return first;
}

static lr_color multiply(lr_color a, lr_color b)
{
    return (lr_color){a.x * b.x, a.y * b.y, a.z * b.z};
}

static uint32_t pack_pattern_kind(const lr_pattern *pattern)
{
    static const uint32_t kinds[] = {
        [LR_PATTERN_NONE] = LR_GPU_PATTERN_NONE,
        [LR_PATTERN_CHECKER] = LR_GPU_PATTERN_CHECKER,
        [LR_PATTERN_STRIPES] = LR_GPU_PATTERN_STRIPES,
        [LR_PATTERN_GRADIENT] = LR_GPU_PATTERN_GRADIENT,
        [LR_PATTERN_RINGS] = LR_GPU_PATTERN_RINGS,
        [LR_PATTERN_IMAGE] = LR_GPU_PATTERN_IMAGE,
    };
    if (pattern->kind == LR_PATTERN_IMAGE)
        return LR_GPU_PATTERN_IMAGE | pattern->texture << LR_GPU_TEXTURE_SHIFT;
    return kinds[pattern->kind] | (pattern->object_space ? LR_GPU_OBJECT_SPACE : 0);
}

/* `shown` is the pattern of what is looked up at a hit. */
static void pack_material(const lr_scene *scene, const lr_material *m, const lr_pattern *shown,
                          struct gpu_material *out)
{
    lr_color ambient = multiply(m->ambient, scene->ambient);
    bool lit = !lr_color_is_black(ambient) || !lr_color_is_black(m->diffuse) ||
               !lr_color_is_black(m->specular) || !lr_color_is_black(m->emission);
    const lr_pattern *p = shown;
    bool image = p->kind == LR_PATTERN_IMAGE;
    bool gradient = p->kind == LR_PATTERN_GRADIENT;
    lr_vec3 direction = gradient ? p->direction : lr_vec3_normalize(p->direction);
    double length2 = lr_vec3_dot(direction, direction);
    *out = (struct gpu_material){
        .color0 = lr_pack_vec3(p->colors[0]),
        .pattern = pack_pattern_kind(p),
        .color1 = lr_pack_vec3(p->kind == LR_PATTERN_NONE ? p->colors[0] : p->colors[1]),
        .inv_size = image         ? (float)m->alpha_cutoff
                    : p->size > 0 ? (float)(1 / p->size)
                                  : 1,
        .pattern_origin = lr_pack_vec3(p->origin),
        .inv_length2 = length2 > 0 ? (float)(1 / length2) : 0,
        .pattern_direction = lr_pack_vec3(direction),
        .flags = (m->fresnel ? LR_GPU_FRESNEL : 0) |
                 (m->highlight == LR_HIGHLIGHT_PHONG ? LR_GPU_PHONG : 0) | (lit ? LR_GPU_LIT : 0) |
                 (m->emits == LR_EMITS_FRONT ? LR_GPU_FRONT_ONLY : 0),
        .ambient = lr_pack_vec3(ambient),
        .shininess = (float)m->shininess,
        .diffuse = lr_pack_vec3(m->diffuse),
        .ior = (float)m->ior,
        .specular = lr_pack_vec3(m->specular),
        .emission_red = (float)m->emission.x,
        .reflect = lr_pack_vec3(m->reflect),
        .emission_green = (float)m->emission.y,
        .transmit = lr_pack_vec3(m->transmit),
        .emission_blue = (float)m->emission.z,
    };
}

static lr_status pack_materials(const lr_scene *scene, lr_packed_scene *packed, lr_error *error)
{
    packed->frame.materials = packed->row_count;
    for (uint32_t i = 0; i < scene->material_count; i++) {
        const lr_material *m = &scene->materials[i];
        /* Paths choose one of the materials of a mix by its weight. */
        bool chosen = m->model == LR_MODEL_MIX && packed->constants[LR_SPEC_PATH];
        const lr_pattern *shown = chosen ? &m->mix.weight : &m->color;
        struct gpu_material record;
        pack_material(scene, m, shown, &record);
        if (lr_pack_rows(packed, &record, sizeof record / 16) == UINT32_MAX)
            return lr_fail(error, LR_ERROR_MEMORY, "out of memory for the scene's materials");
        uint32_t *use = packed->constants;
        bool image = shown->kind == LR_PATTERN_IMAGE;
        bool cut = image && m->alpha_cutoff > 0;
        use[LR_SPEC_TEXTURES] |= image;
        use[LR_SPEC_CUTOUTS] |= cut;
        use[LR_SPEC_PATTERNS] |= !image && shown->kind != LR_PATTERN_NONE;
        use[LR_SPEC_SPECULAR] |= !lr_color_is_black(m->specular);
        use[LR_SPEC_SCATTER] |=
            cut || !lr_color_is_black(m->reflect) || !lr_color_is_black(m->transmit);
        use[LR_SPEC_FRESNEL] |= m->fresnel;
        use[LR_SPEC_EMITS_FRONT] |= m->emits == LR_EMITS_FRONT;
    }
    return LR_OK;
}

void lr_pack_light(const lr_light *light, struct gpu_light *out)
{
    *out = (struct gpu_light){
        .position = lr_pack_vec3(light->position),
        .half_falloff = (float)(light->falloff / 2),
        .color = lr_pack_vec3(lr_vec3_scale(light->color, light->intensity)),
        .flags = (light->kind == LR_LIGHT_DIRECTIONAL ? LR_GPU_LIGHT_DIRECTIONAL : 0) |
                 (light->kind == LR_LIGHT_SPOT ? LR_GPU_LIGHT_SPOT : 0) |
                 (light->shadows ? LR_GPU_LIGHT_SHADOWS : 0),
        .direction = lr_pack_vec3(lr_vec3_normalize(light->direction)),
        .radius = (float)light->radius,
    };
    double sine, edge, inner;
    if (light->kind == LR_LIGHT_DIRECTIONAL) {
        /* 1 - cos(2a) = 2 sin(a)^2, which does not cancel. */
        lr_sincos_degrees(light->angle / 4, &sine, &edge);
        out->spread = (float)(2 * sine * sine);
    }
    if (light->kind == LR_LIGHT_SPOT) {
        lr_sincos_degrees(light->angle, &sine, &edge);
        lr_sincos_degrees(light->inner, &sine, &inner);
        out->cos_angle = (float)edge;
        /* A light without a soft edge still needs a finite slope. */
        out->cos_scale = (float)(1 / fmax(inner - edge, 1e-6));
    }
}

/* inspected: what pixels show asks no light. */
static lr_status pack_lights(const lr_scene *scene, bool inspected, lr_packed_scene *packed,
                             lr_error *error)
{
    /* A scene that names no lights has one that follows the camera: lr_pack_camera writes it. */
    uint32_t count = scene->default_light ? 1 : scene->light_count;
    packed->frame.lights = packed->row_count;
    packed->light_count = inspected ? 0 : count;
    for (uint32_t i = 0; i < count; i++) {
        struct gpu_light record = {.flags = 0};
        if (!scene->default_light)
            lr_pack_light(&scene->lights[i], &record);
        if (lr_pack_rows(packed, &record, sizeof record / 16) == UINT32_MAX)
            return lr_fail(error, LR_ERROR_MEMORY, "out of memory for the scene's lights");
        if (scene->default_light)
            continue;
        packed->constants[LR_SPEC_FALLOFF] |= scene->lights[i].falloff > 0;
        packed->constants[LR_SPEC_SOFT_LIGHTS] |= lr_light_is_soft(&scene->lights[i]);
        packed->constants[LR_SPEC_SPOTS] |= scene->lights[i].kind == LR_LIGHT_SPOT;
    }
    return LR_OK;
}

/* Whether any camera needs more than a pinhole's rays, so that changing cameras changes no kernel.
 */
static bool has_lens(const lr_scene *scene)
{
    bool any = false;
    for (uint32_t i = 0; i < scene->camera_count; i++)
        any = any || !lr_camera_is_pinhole(&scene->cameras[i]);
    return any;
}

lr_status lr_pack_scene(const lr_scene *scene, const lr_settings *settings, lr_packed_scene *packed,
                        lr_error *error)
{
    lr_trees own_trees = {0};
    *packed = (lr_packed_scene){.leaf_size = settings->leaf_size,
                                .threads = settings->threads,
                                .moment = scene->moment,
                                .trees = settings->trees ? settings->trees : &own_trees};
    packed->trees->keep = packed->trees == settings->trees;
    packed->frame = (struct gpu_frame){
        .background_low = lr_pack_vec3(scene->background.colors[0]),
        .background_high = lr_pack_vec3(scene->background.colors[1]),
        .background_up = lr_pack_vec3(scene->background_up),
        .min_weight = (float)scene->image.min_weight,
        .fog_color = lr_pack_vec3(scene->fog_color),
        .fog_density = (float)(scene->fog_density * LOG2_E),
    };
    packed->constants[LR_SPEC_INSPECT] = settings->inspect != LR_INSPECT_LIGHT;
    packed->constants[LR_SPEC_PATH] =
        settings->integrator == LR_INTEGRATOR_PATH && settings->inspect == LR_INSPECT_LIGHT;
    packed->constants[LR_SPEC_CAMERA] = has_lens(scene) || lr_pack_filter(scene, settings);
    packed->constants[LR_SPEC_FOG] = scene->fog_density > 0;
    lr_status status = lr_pack_texture_records(scene, packed, error);
    if (!status)
        status = pack_materials(scene, packed, error);
    if (!status && settings->integrator == LR_INTEGRATOR_PATH)
        status = lr_pack_bsdfs(scene, packed, error);
    if (!status)
        status = lr_pack_maps(scene, packed, error);
    if (!status)
        status = pack_lights(scene, settings->inspect >= LR_INSPECT_ALBEDO, packed, error);
    if (!status)
        status = lr_pack_environment(scene, packed, error);
    if (!status)
        status = lr_pack_objects(scene, packed, error);
    if (!status)
        status = lr_pack_textures(scene, packed, error);
    packed->trees = NULL;
    free(packed->sky.floats);
    packed->sky = (lr_texture){.floats = NULL};
    lr_trees_free(&own_trees);
    if (!status)
        lr_pack_camera(scene, settings, packed);
    if (!status && settings->trees)
        lr_trees_sweep(settings->trees);
    if (status)
        lr_packed_scene_free(packed);
    return status;
}

void lr_packed_scene_free(lr_packed_scene *packed)
{
    free(packed->rows);
    *packed = (lr_packed_scene){0};
}
