/* What is seen infinitely far away. */
#include "scene/read.h"

#include <math.h>
#include <string.h>

/* The record that one of the mapping's keys names; NULL after reporting. */
static const lr_record *find_kind(lr_reader *reader, const lr_node *node)
{
    lr_nearest nearest = {0};
    const lr_node *at = node;
    for (uint32_t k = 0; k < node->count; k++)
        for (uint32_t i = 0; i < lr_background_record_count; i++)
            if (strcmp(lr_map_key(node, k)->text, lr_background_records[i].name) == 0)
                return &lr_background_records[i];
    for (uint32_t k = 0; k < node->count && !nearest.best; k++) {
        at = lr_map_key(node, k);
        nearest = (lr_nearest){.text = at->text, .length = at->count};
        for (uint32_t i = 0; i < lr_background_record_count; i++)
            lr_nearest_offer(&nearest, lr_background_records[i].name);
    }
    lr_report_unknown(reader, nearest.best ? at : node,
                      "background has no kind, expected gradient, image or sky", &nearest);
    return NULL;
}

static bool is_black(const lr_texture *texture)
{
    size_t texels = (size_t)texture->width * texture->height;
    for (size_t i = 0; i < texels; i++)
        for (int k = 0; k < 3; k++)
            if (texture->floats ? texture->floats[3 * i + (size_t)k] > 0
                                : texture->bytes[4 * i + (size_t)k] > 0)
                return false;
    return true;
}

/* Whether the picture can be light: one wrong pixel would be all over the scene. */
static bool check_picture(lr_reader *reader, const lr_node *node, const lr_texture *texture)
{
    if (texture->changed) {
        uint32_t texel = texture->changed - 1;
        float value = texture->changed_from;
        const char *what = value != value ? "not a number"
                           : isinf(value) ? "infinite"
                           : value < 0    ? "negative"
                                          : "too bright";
        lr_report_add(reader->report, node->offset,
                      "%.300s: the pixel in column %u of row %u, both from 0, is %s; expected "
                      "values from 0 to %g in pictures that light a scene",
                      texture->name, texel % texture->width, texel / texture->width, what,
                      LR_COLOR_MAX);
        return false;
    }
    if (is_black(texture)) {
        lr_report_add(reader->report, node->offset,
                      "%.300s is black everywhere; for no light write `background: 0`",
                      texture->name);
        return false;
    }
    return true;
}

static bool check_sun(lr_reader *reader, const lr_node *node, lr_vec3 sun)
{
    /* Where the model's optical depth of the air still means something. */
    if (lr_vec3_dot(lr_vec3_normalize(sun), reader->scene->background_up) > 0)
        return true;
    lr_report_add(reader->report, node->offset,
                  "the sun is not above the horizon, expected a direction that rises along \"up\"");
    return false;
}

static void read_kind(lr_reader *reader, const lr_node *node, const lr_record *record)
{
    lr_background_draft draft = {.image = NULL};
    lr_background *background = &draft.background;
    lr_given given;
    if (!lr_read_record(reader, node, node, record, &draft, &given))
        return;
    const lr_node *value = lr_given_value(&given, record, record->name);
    background->kind = (lr_background_kind)record->kind;
    if (background->kind == LR_BACKGROUND_IMAGE &&
        (!lr_read_picture(reader, value, draft.image, LR_WRAP_REPEAT, LR_WRAP_CLAMP,
                          LR_TEXELS_COLORS, &background->texture) ||
         !check_picture(reader, value, &reader->scene->textures[background->texture])))
        return;
    if (background->kind == LR_BACKGROUND_SKY && !check_sun(reader, value, background->sun))
        return;
    reader->scene->background = *background;
}

void lr_read_background(lr_reader *reader, const lr_node *node, const lr_field *field)
{
    lr_color *colors = reader->scene->background.colors;
    if (node->kind == LR_NODE_MAP && !lr_keys_of(reader, node)) {
        const lr_record *record = find_kind(reader, node);
        if (record)
            read_kind(reader, node, record);
    } else if (node->kind == LR_NODE_EMPTY) {
        char expected[LR_EXPECTED_MAX];
        lr_report_type(reader, node, field->name, lr_field_expected(field, expected));
    } else if (lr_read_color(reader, node, field, field->name, &colors[0])) {
        colors[1] = colors[0];
    }
}
