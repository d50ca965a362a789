/* An explained pixel as JSON; docs/explain.md describes it. */
#include "cli/explain_print.h"
#include "cli/json.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

/* JSON has no infinities: they become null. */
static json_t *real(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

static json_t *triple(const float v[3])
{
    return json_pack("[o, o, o]", real(v[0]), real(v[1]), real(v[2]));
}

/* Counts of steps are texts, as JSON's numbers end at 2^53 for many programs. */
static json_t *step_count(uint64_t steps)
{
    char text[24];
    snprintf(text, sizeof text, "%" PRIu64, steps);
    return json_string(text);
}

static json_t *light_json(const uint64_t steps[3])
{
    return json_pack("{s:[o, o, o], s:[o, o, o]}", "color", real(explained_light(steps[0])),
                     real(explained_light(steps[1])), real(explained_light(steps[2])), "steps",
                     step_count(steps[0]), step_count(steps[1]), step_count(steps[2]));
}

/* Names may hold bytes that are not UTF-8, which JSON cannot: such a name becomes null. */
static json_t *text_json(const char *text)
{
    json_t *json = text ? json_string(text) : NULL;
    return json ? json : json_null();
}

static json_t *line_json(uint32_t line)
{
    return line ? json_integer(line) : json_null();
}

static json_t *object_json(const lr_scene *scene, uint32_t index)
{
    lr_object_info object;
    lr_material_info material = {0};
    if (!lr_scene_get_object(scene, index, &object)) {
        return json_null();
    }
    lr_scene_get_material(scene, object.material, &material);
    return json_pack("{s:I, s:s, s:o, s:o, s:{s:o, s:o}}", "index", (json_int_t)index, "kind",
                     object.kind, "line", line_json(object.line), "mesh", text_json(object.mesh),
                     "material", "name", text_json(material.name), "line",
                     line_json(material.line));
}

static json_t *obstacles_json(const explained_pixel *pixel, const lr_explained_light *light)
{
    json_t *list = json_array();
    for (uint32_t i = 0; i < light->obstacle_count; i++) {
        const lr_explained_obstacle *o = &pixel->explanation->obstacles[light->first_obstacle + i];
        json_array_append_new(list, json_pack("{s:o, s:o, s:o}", "object",
                                              object_json(pixel->scene, o->object), "distance",
                                              real(o->distance), "left", triple(o->left)));
    }
    return list;
}

static json_t *one_light_json(const explained_pixel *pixel, const lr_explained_light *light)
{
    lr_light_info info = {.kind = "?"};
    lr_scene_get_light(pixel->scene, light->light, &info);
    json_t *source = json_pack("{s:I, s:s, s:o, s:f, s:b, s:b}", "index", (json_int_t)light->light,
                               "kind", info.kind, "line", line_json(info.line), "falloff",
                               info.falloff, "shadows", info.shadows, "added", info.added);
    json_t *distance = light->distance > 0 ? real(light->distance) : json_null();
    return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:b, s:o, s:o, s:o}",
                     "source", source, "origin", triple(light->origin), "wi", triple(light->wi),
                     "distance", distance, "attenuation", real(light->attenuation), "spot",
                     real(light->spot), "cosine", real(light->cosine), "highlight",
                     real(light->highlight), "arriving", triple(light->arriving), "unshadowed",
                     triple(light->unshadowed), "tested", light->tested, "left",
                     light->tested ? triple(light->left) : json_null(), "obstacles",
                     obstacles_json(pixel, light), "brings", light_json(light->steps));
}

static json_t *lights_json(const explained_pixel *pixel, const lr_explained_ray *ray)
{
    json_t *list = json_array();
    for (uint32_t i = 0; i < ray->light_count; i++) {
        json_array_append_new(
            list, one_light_json(pixel, &pixel->explanation->lights[ray->first_light + i]));
    }
    return list;
}

static json_t *scatter_json(const explained_pixel *pixel, const lr_explained_ray *r)
{
    if (r->ior == 0) { /* nothing in the scene scatters */
        return json_null();
    }
    return json_pack("{s:b, s:b, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "bends", r->bends, "total",
                     r->total, "medium_beyond", object_json(pixel->scene, r->medium_beyond), "ior",
                     real(r->ior), "ior_beyond", real(r->ior_beyond), "refracted_cosine",
                     real(r->refracted_cosine), "reflectance",
                     r->fresnel ? real(r->reflectance) : json_null(), "reflect_weight",
                     triple(r->reflect_weight), "transmit_weight", triple(r->transmit_weight));
}

static json_t *hit_json(const explained_pixel *pixel, const lr_explained_ray *r)
{
    if (r->object == LR_NO_INDEX) {
        return json_null();
    }
    json_t *triangle = r->triangle == LR_NO_INDEX ? json_null() : json_integer(r->triangle);
    return json_pack(
        "{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:b, s:b, s:b, s:b, s:b, s:o, s:o, s:o, s:o}",
        "t", real(r->t), "object", object_json(pixel->scene, r->object), "triangle", triangle,
        "position", triple(r->position), "normal", triple(r->normal), "lit_by", triple(r->lit_by),
        "cosine", real(r->cosine), "color", triple(r->color), "entering", r->entering, "lit",
        r->lit, "hidden", r->hidden, "hole", r->hole, "lost", r->lost, "ambient",
        triple(r->ambient), "emission", triple(r->emission), "lights", lights_json(pixel, r),
        "scatter", scatter_json(pixel, r));
}

static json_t *ray_json(const explained_pixel *pixel, uint32_t index)
{
    static const char *const kinds[] = {
        [LR_RAY_CAMERA] = "camera",
        [LR_RAY_REFLECTED] = "reflected",
        [LR_RAY_REFRACTED] = "refracted",
        [LR_RAY_ONWARD] = "onward",
    };
    static const char *const cuts[] = {[LR_CUT_DEPTH] = "depth", [LR_CUT_WEIGHT] = "weight"};
    const lr_explained_ray *r = &pixel->explanation->rays[index];
    json_t *json = json_pack(
        "{s:I, s:o, s:s, s:o, s:I, s:I, s:o, s:o, s:o}", "id", (json_int_t)index, "parent",
        r->parent == LR_NO_INDEX ? json_null() : json_integer(r->parent), "kind", kinds[r->kind],
        "cut", text_json(cuts[r->cut]), "depth", (json_int_t)r->depth, "passed",
        (json_int_t)r->passed, "origin", triple(r->origin), "direction", triple(r->direction),
        "weight", triple(r->weight));
    if (!json || r->cut != LR_CUT_NONE) {
        return json;
    }
    json_t *rest = json_pack(
        "{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "medium", object_json(pixel->scene, r->medium),
        "weight_there", triple(r->weight_there), "fog", triple(r->fog), "fog_brings",
        light_json(r->fog_steps), "background",
        r->object == LR_NO_INDEX ? triple(r->background) : json_null(), "hit", hit_json(pixel, r),
        "own_brings", light_json(r->own_steps), "brings", light_json(r->steps));
    json_object_update(json, rest);
    json_decref(rest);
    return json;
}

int print_explanation_json(const explained_pixel *pixel)
{
    const lr_explanation *x = pixel->explanation;
    json_t *rays = json_array();
    for (uint32_t i = 0; i < x->ray_count; i++) {
        json_array_append_new(rays, ray_json(pixel, i));
    }
    json_t *picture = json_pack("{s:I, s:I, s:I, s:I, s:I}", "width", (json_int_t)x->width,
                                "height", (json_int_t)x->height, "samples", (json_int_t)x->samples,
                                "depth", (json_int_t)x->depth, "seed", (json_int_t)x->seed);
    json_t *total = json_pack("{s:o, s:o, s:b}", "color", triple(x->pixel), "brings",
                              light_json(x->total_steps), "saturated", x->saturated);
    json_t *json = json_pack(
        "{s:i, s:s, s:o, s:o, s:o, s:[I, I], s:I, s:o, s:o, s:o}", "format", 1, "version",
        LR_VERSION, "scene", text_json(pixel->path), "camera", text_json(pixel->camera), "picture",
        picture, "pixel", (json_int_t)x->x, (json_int_t)x->y, "sample", (json_int_t)x->sample,
        "brings", light_json(x->sample_steps), "all_samples", total, "rays", rays);
    return write_json(json, "-");
}
