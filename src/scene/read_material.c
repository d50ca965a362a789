/* Materials and their patterns. */
#include "scene/read.h"

#include "base/memory.h"
#include "scene/models.h"
#include "scene/texture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool lr_read_picture(lr_reader *reader, const lr_node *node, const char *file, lr_wrap wrap_u,
                     lr_wrap wrap_v, lr_texels texels, uint32_t *texture)
{
    char *path;
    lr_error error = {0};
    lr_status status = lr_read_path(reader, file, &path, &error);
    if (!status)
        status = lr_texture_load(&reader->builder, path, wrap_u, wrap_v, texels, texture, &error);
    free(path);
    if (status == LR_ERROR_MEMORY)
        reader->report->no_memory = true;
    else if (status)
        lr_report_add(reader->report, node->offset, "%s", error.message);
    return !status;
}

/* A colour, or a mapping with a key that names a pattern. */
static bool read_paint(lr_reader *reader, const lr_node *node, const lr_field *field,
                       lr_pattern *pattern)
{
    char expected[LR_EXPECTED_MAX];
    if (node->kind == LR_NODE_EMPTY) {
        lr_report_type(reader, node, field->name, lr_field_expected(field, expected));
        return false;
    }
    if (node->kind != LR_NODE_MAP || lr_keys_of(reader, node))
        return lr_read_color(reader, node, field, field->name, &pattern->colors[0]);
    const lr_record *record = NULL;
    for (uint32_t i = 0; i < lr_pattern_record_count && !record; i++)
        for (uint32_t k = 0; k < node->count && !record; k++)
            if (strcmp(lr_map_key(node, k)->text, lr_pattern_records[i].name) == 0)
                record = &lr_pattern_records[i];
    if (!record) {
        lr_nearest nearest = {0};
        const lr_node *at = node->count ? lr_map_key(node, 0) : node;
        for (uint32_t k = 0; k < node->count && !nearest.best; k++) {
            at = lr_map_key(node, k);
            nearest = (lr_nearest){.text = at->text, .length = at->count};
            for (uint32_t i = 0; i < lr_pattern_record_count; i++)
                lr_nearest_offer(&nearest, lr_pattern_records[i].name);
        }
        char message[128];
        snprintf(message, sizeof message,
                 "%s has no pattern, expected checker, stripes, gradient, rings or image",
                 field->name);
        lr_report_unknown(reader, nearest.best ? at : node, message, &nearest);
        return false;
    }
    lr_pattern_draft draft = {.pattern.direction = {0, 1, 0}, .pattern.size = 1};
    lr_given given;
    if (!lr_read_record(reader, node, node, record, &draft, &given))
        return false;
    *pattern = draft.pattern;
    pattern->kind = (lr_pattern_kind)record->kind;
    pattern->object_space = draft.space == 1;
    if (pattern->kind == LR_PATTERN_IMAGE)
        return lr_read_picture(reader, lr_given_value(&given, record, "image"), draft.image,
                               (lr_wrap)draft.wrap, (lr_wrap)draft.wrap, LR_TEXELS_COLORS,
                               &pattern->texture);
    if (pattern->kind == LR_PATTERN_GRADIENT) {
        pattern->direction = lr_vec3_sub(draft.to, pattern->origin);
        if (!(lr_vec3_length(pattern->direction) >= LR_LENGTH_MIN)) {
            const lr_node *to = lr_given_value(&given, record, "to");
            const lr_node *from = lr_given_value(&given, record, "from");
            lr_report_add(reader->report,
                          (to     ? to
                           : from ? from
                                  : node)
                              ->offset,
                          "the gradient's from and to are the same point, expected two");
            return false;
        }
    }
    return true;
}

/* A picture that is not the colour: its file, or a mapping. */
static void read_map(lr_reader *reader, const lr_node *node, const lr_record *record, lr_map *map)
{
    lr_map_draft draft = {.map.channel = LR_CHANNEL_RED};
    lr_given given;
    const lr_node *file = node;
    if (node->kind == LR_NODE_MAP) {
        if (!lr_read_record(reader, node, node, record, &draft, &given))
            return;
        file = lr_given_value(&given, record, "image");
    } else {
        const lr_field named = {record->name, LR_FIELD_TEXT,
                                .derived = "the file of a picture or a mapping such as "
                                           "{image: file}"};
        lr_record_defaults(record, &draft);
        if (!lr_read_value(reader, node, &named, &draft.image))
            return;
    }
    *map = draft.map;
    map->given =
        lr_read_picture(reader, file, draft.image, (lr_wrap)draft.wrap, (lr_wrap)draft.wrap,
                        lr_map_texels((lr_map_kind)record->kind), &map->texture);
}

static double greatest(lr_color c)
{
    return fmax(c.x, fmax(c.y, c.z));
}

static void read_maps(lr_reader *reader, const lr_given *given, lr_material *material)
{
    for (int i = 0; i < LR_MAP_COUNT; i++) {
        const lr_record *record = &lr_map_records[i];
        const lr_node *node = lr_given_value(given, &lr_material_record, record->name);
        if (node)
            read_map(reader, node, record, &material->maps[i]);
    }
    lr_map *light = &material->maps[LR_MAP_EMISSION];
    if (light->given && !lr_given_value(given, &lr_material_record, "emission"))
        material->emission = (lr_color){1, 1, 1};
    /* A picture of no light is none. */
    if (greatest(material->emission) == 0)
        *light = (lr_map){.given = false};
}

/* Reports keys that belong to other models. */
static void check_keys(lr_reader *reader, const lr_given *given, lr_model model)
{
    const lr_record *record = &lr_material_record;
    for (uint32_t i = 0; i < record->count; i++) {
        const char *name = record->fields[i].name;
        char others[128] = "";
        if (!given->values[i] || lr_model_has_key(model, name))
            continue;
        for (int other = 0; lr_model_names[other]; other++)
            if (lr_model_has_key((lr_model)other, name))
                snprintf(others + strlen(others), sizeof others - strlen(others), "%s%s",
                         others[0] ? ", " : "", lr_model_names[other]);
        lr_report_add(reader->report, given->values[i]->offset,
                      "%s is no key of materials of model %s, expected model: %s", name,
                      lr_model_names[model], others);
    }
}

/* What follows from the keys of a model other than the classic one. */
static void complete_model(lr_reader *reader, const lr_given *given, lr_material *material)
{
    const lr_record *record = &lr_material_record;
    const lr_node *metal = lr_given_value(given, record, "metal");
    const lr_node *eta = lr_given_value(given, record, "eta");
    const lr_node *k = lr_given_value(given, record, "k");
    bool measured = material->metal != LR_METAL_NONE;
    if (measured && (eta || k))
        lr_report_add(reader->report, metal->offset,
                      "metal stands beside %s, expected one of the two", eta ? "eta" : "k");
    else if (material->model == LR_MODEL_CONDUCTOR && !eta != !k)
        lr_report_add(reader->report, (eta ? eta : k)->offset, "%s needs %s beside it",
                      eta ? "eta" : "k", eta ? "k" : "eta");
    if (measured)
        lr_metal_index(material->metal, &material->eta, &material->k);
    /* The colour of a metal is in its refractive index; that of glass is `transmit`. */
    bool white = lr_model_is_glass(material->model) || measured || eta;
    if (white && !lr_given_value(given, record, "color"))
        material->color.colors[0] = material->color.colors[1] = (lr_color){1, 1, 1};
    if (lr_model_is_glass(material->model) && !lr_given_value(given, record, "transmit"))
        material->transmit = (lr_color){1, 1, 1};
    material->pane = material->model == LR_MODEL_THIN_GLASS;
    lr_approximate(material);
}

/* Reads the colour or pattern of a field, if it is given, over the field's default. */
static void read_field_paint(lr_reader *reader, const lr_given *given, const char *name,
                             lr_pattern *pattern)
{
    const lr_field *field = &lr_material_record.fields[lr_field_index(&lr_material_record, name)];
    const double *d = field->fallback;
    *pattern = (lr_pattern){.colors[0] = {d[0], d[1], d[2]},
                            .colors[1] = {d[0], d[1], d[2]},
                            .size = 1,
                            .direction = {0, 1, 0}};
    const lr_node *node = lr_given_value(given, &lr_material_record, name);
    if (!node)
        return;
    read_paint(reader, node, field, pattern);
    if (pattern->kind == LR_PATTERN_NONE)
        pattern->colors[1] = pattern->colors[0];
}

/* Keeps what there is of a mix until its parts can be found. */
static void add_mix(lr_reader *reader, const lr_given *given, const lr_node *at,
                    lr_material *material)
{
    lr_mixes *mixes = &reader->mixes;
    read_field_paint(reader, given, "weight", &material->mix.weight);
    if (!lr_array_reserve((void **)&mixes->items, mixes->count, &mixes->capacity,
                          sizeof *mixes->items)) {
        reader->report->no_memory = true;
        return;
    }
    mixes->items[mixes->count++] = (lr_mix){
        .material = (uint32_t)(material - reader->scene->materials),
        .at = at,
        .first = lr_given_value(given, &lr_material_record, "first"),
        .second = lr_given_value(given, &lr_material_record, "second"),
    };
}

/* Reads a material over its defaults. The result is usable even when errors were reported; a mix is
 * still to be completed. */
static void read_material(lr_reader *reader, const lr_node *node, const lr_node *at,
                          lr_material *material)
{
    const lr_record *record = &lr_material_record;
    lr_given given;
    *material = (lr_material){.line = at->line};
    lr_read_record(reader, node, at, record, material, &given);
    read_field_paint(reader, &given, "color", &material->color);
    check_keys(reader, &given, material->model);
    read_maps(reader, &given, material);
    if (material->model == LR_MODEL_MIX) {
        add_mix(reader, &given, at, material);
        return;
    }
    if (material->model != LR_MODEL_CLASSIC) {
        complete_model(reader, &given, material);
        return;
    }
    /* What is mirrored or let through is not scattered as well; with a coloured share, its greatest
     * component counts, so that the default stays grey. */
    if (!lr_given_value(&given, record, "diffuse")) {
        double rest = fmax(0, 1 - greatest(material->reflect) - greatest(material->transmit));
        material->diffuse = (lr_color){rest, rest, rest};
    }
    if (!lr_given_value(&given, record, "ambient"))
        material->ambient = material->diffuse;
}

/* A new material at the end of the scene's; NULL after reporting. */
static lr_material *add_material(lr_reader *reader, size_t offset, uint32_t *index)
{
    lr_scene *scene = reader->scene;
    if (scene->material_count == LR_MATERIALS_MAX) {
        if (!reader->full)
            lr_report_add(reader->report, offset, "more than %d materials", LR_MATERIALS_MAX);
        reader->full = true;
        return NULL;
    }
    *index = scene->material_count;
    lr_material *material = lr_scene_add_material(&reader->builder);
    if (!material)
        reader->report->no_memory = true;
    return material;
}

void lr_read_materials(lr_reader *reader, const lr_node *node)
{
    if (node->kind != LR_NODE_MAP) {
        lr_report_type(reader, node, "materials",
                       node->kind == LR_NODE_LIST
                           ? "a mapping of names to materials: `name: {...}`, without dashes"
                           : "a mapping of names to materials");
        return;
    }
    const lr_node *empty = NULL; /* a material without a value, just above */
    for (uint32_t i = 0; i < node->count && !reader->full; i++) {
        const lr_node *key = lr_map_key(node, i), *value = lr_map_value(node, i);
        bool is_field = lr_field_find(&lr_material_record, key->text, key->count) != NULL;
        char shown[LR_SHOWN_MAX];
        lr_shown(shown, key->text, key->count);
        if (is_field && value->kind != LR_NODE_MAP) {
            if (empty) {
                char other[LR_SHOWN_MAX];
                lr_report_add(reader->report, key->offset,
                              "%s belongs to material \"%s\", expected it indented deeper than "
                              "that name",
                              shown, lr_shown(other, empty->text, empty->count));
            } else {
                lr_report_add(reader->report, key->offset,
                              "%s stands directly in materials, expected `name: {%s: ...}`", shown,
                              shown);
            }
            continue;
        }
        uint32_t index;
        lr_material *material = add_material(reader, key->offset, &index);
        if (!material)
            return;
        if (!lr_names_put(&reader->materials, key->text, key->count, index) ||
            !(material->name = lr_string_copy(key->text, key->count))) {
            reader->report->no_memory = true;
            return;
        }
        /* read_material() overwrites the whole struct. */
        char *name = material->name;
        empty = value->kind == LR_NODE_EMPTY ? key : NULL;
        if (empty) {
            const lr_node *next = i + 1 < node->count ? lr_map_key(node, i + 1) : NULL;
            bool outdented = next && lr_field_find(&lr_material_record, next->text, next->count);
            *material = (lr_material){.line = key->line};
            if (!outdented)
                lr_report_add(reader->report, key->offset,
                              "material \"%s\" is empty, expected its keys, indented below it, or "
                              "{} for the defaults",
                              shown);
        } else {
            read_material(reader, value, key, material);
        }
        material->name = name;
    }
    lr_complete_mixes(reader);
}

static void report_unknown_material(lr_reader *reader, const lr_node *node)
{
    lr_report *report = reader->report;
    if (!lr_report_has_room(report)) {
        report->dropped++;
        return;
    }
    char shown[LR_SHOWN_MAX], message[LR_SHOWN_MAX * 2];
    lr_nearest nearest = {.text = node->text, .length = node->count};
    const lr_scene *scene = reader->scene;
    for (uint32_t i = 0; i < scene->material_count && i < 2000; i++)
        if (scene->materials[i].name)
            lr_nearest_offer(&nearest, scene->materials[i].name);
    snprintf(message, sizeof message, "unknown material \"%s\", expected a name from materials",
             lr_shown(shown, node->text, node->count));
    /* Names are the author's: they may hold anything, unlike keys. */
    char best[LR_SHOWN_MAX];
    if (nearest.best)
        nearest.best = lr_shown(best, nearest.best, strlen(nearest.best));
    lr_report_unknown(reader, node, message, &nearest);
}

uint32_t lr_read_material_use(lr_reader *reader, const lr_node *node)
{
    uint32_t index;
    if (node->kind == LR_NODE_PLAIN || node->kind == LR_NODE_QUOTED) {
        if (lr_names_get(&reader->materials, node->text, node->count, &index))
            return index;
        report_unknown_material(reader, node);
        return UINT32_MAX;
    }
    if (node->kind != LR_NODE_MAP) {
        lr_report_type(reader, node, "material",
                       "the name of a material or a mapping of material keys");
        return UINT32_MAX;
    }
    lr_material *material = add_material(reader, node->offset, &index);
    if (!material)
        return UINT32_MAX;
    read_material(reader, node, node, material);
    lr_complete_mixes(reader);
    return index;
}

uint32_t lr_default_material(lr_reader *reader)
{
    if (reader->default_material == UINT32_MAX) {
        lr_node empty = {.kind = LR_NODE_MAP};
        uint32_t index;
        lr_material *material = add_material(reader, 0, &index);
        if (!material)
            return UINT32_MAX;
        read_material(reader, &empty, &empty, material);
        reader->default_material = index;
    }
    return reader->default_material;
}
