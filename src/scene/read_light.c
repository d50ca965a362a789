/* Lights. */
#include "scene/read.h"

#include "base/memory.h"

static bool complete_spot(lr_reader *reader, const lr_record *record, const lr_given *given,
                          const lr_node *at, lr_light_draft *draft)
{
    const lr_node *to = lr_given_value(given, record, "to");
    const lr_node *direction = lr_given_value(given, record, "direction");
    const lr_node *inner = lr_given_value(given, record, "inner");
    lr_light *light = &draft->light;
    if (to && direction) {
        lr_report_add(reader->report, direction->offset,
                      "the spot has both \"to\" and \"direction\", expected one of them");
        return false;
    }
    if (!to && !direction) {
        lr_report_add(reader->report, at->offset,
                      "the spot has no \"to\" and no \"direction\", expected one of them");
        return false;
    }
    /* A direction that is given is not zero; one that is computed may be. */
    if (to)
        light->direction = lr_vec3_sub(draft->to, light->position);
    if (to && !(lr_vec3_length(light->direction) >= LR_LENGTH_MIN)) {
        lr_report_add(reader->report, to->offset,
                      "the spot's \"to\" is its position, expected another point");
        return false;
    }
    if (!inner)
        light->inner = 0.8 * light->angle;
    if (light->inner > light->angle) {
        lr_report_add(reader->report, inner->offset,
                      "inner is %.10g, expected at most the angle, %.10g", light->inner,
                      light->angle);
        return false;
    }
    return true;
}

/* Reports a light that is black, and not by keys at this frame alone: most likely a slip. */
static bool check_bright(lr_reader *reader, const lr_record *record, const lr_given *given,
                         const lr_light *light)
{
    const lr_node *color = lr_given_value(given, record, "color");
    const lr_node *intensity = lr_given_value(given, record, "intensity");
    if ((color && lr_keys_of(reader, color)) || (intensity && lr_keys_of(reader, intensity)))
        return true;
    if (!lr_light_is_black(light))
        return true;
    lr_report_add(reader->report, light->intensity > 0 ? color->offset : intensity->offset,
                  "the %s light is black; leave it out, or write `lights: []` for none",
                  record->name);
    return false;
}

void lr_read_lights(lr_reader *reader, const lr_node *node)
{
    if (node->kind != LR_NODE_LIST) {
        lr_report_type(reader, node, "lights",
                       node->kind == LR_NODE_MAP
                           ? "a list: begin each light with a dash, `- point: {...}`"
                           : "a list of lights such as `- point: {position: [4, 6, 3]}`, or []");
        return;
    }
    if (node->count > LR_LIGHTS_MAX) {
        lr_report_add(reader->report, node->offset, "%u lights, expected at most %d", node->count,
                      LR_LIGHTS_MAX);
        return;
    }
    for (uint32_t i = 0; i < node->count; i++) {
        const lr_node *key, *value;
        const lr_record *record = lr_read_kind(reader, node->items[i], "light", lr_light_records,
                                               lr_light_record_count, NULL, &key, &value);
        lr_light_draft draft = {0};
        lr_given given;
        if (!record || !lr_read_record(reader, value, key, record, &draft, &given))
            continue;
        draft.light.kind = (lr_light_kind)record->kind;
        draft.light.line = key->line;
        if (draft.light.kind == LR_LIGHT_SPOT &&
            !complete_spot(reader, record, &given, key, &draft))
            continue;
        if (!check_bright(reader, record, &given, &draft.light))
            continue;
        lr_light *light = lr_scene_add_light(&reader->builder);
        if (!light) {
            reader->report->no_memory = true;
            return;
        }
        *light = draft.light;
    }
}
