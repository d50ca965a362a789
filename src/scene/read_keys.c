/* Values that change from frame to frame: {keys: {0: value, 24: value}}, of which the reader takes
 * what they are in its frame. */
#include "scene/read.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define FRAME_MAX 1e6

const lr_node *lr_keys_of(const lr_reader *reader, const lr_node *node)
{
    bool keyed = reader->report->language == &lr_scene_language && node->kind == LR_NODE_MAP &&
                 node->count == 1 && strcmp(lr_map_key(node, 0)->text, "keys") == 0;
    return keyed ? lr_map_value(node, 0) : NULL;
}

/* A value at a frame. */
typedef struct key {
    double frame, value[3];
} key;

static void blend(const key *a, const key *b, double frame, uint32_t count, double *value)
{
    double length = b->frame - a->frame, share = length > 0 ? (frame - a->frame) / length : 0;
    for (uint32_t i = 0; i < count; i++) {
        double low = fmin(a->value[i], b->value[i]), high = fmax(a->value[i], b->value[i]);
        double between = a->value[i] + (b->value[i] - a->value[i]) * share;
        value[i] = fmin(fmax(between, low), high);
    }
}

bool lr_read_keys(lr_reader *reader, const lr_node *keys, const lr_field *field, const char *what,
                  lr_component_reader *read, uint32_t count, double *value)
{
    static const lr_field frame_field = {
        .type = LR_FIELD_NUMBER, .minimum = -FRAME_MAX, .maximum = FRAME_MAX};
    char name[96];
    snprintf(name, sizeof name, "keys of %s", what);
    if (keys->kind != LR_NODE_MAP || keys->count == 0) {
        lr_report_type(reader, keys, name, "frames and values, such as {0: ..., 24: ...}");
        return false;
    }
    snprintf(name, sizeof name, "a frame of %s", what);
    key before = {0}, after = {0}; /* the ones around the reader's frame */
    double last = -INFINITY;
    bool good = true, reached = false;
    for (uint32_t i = 0; i < keys->count; i++) {
        const lr_node *at = lr_map_key(keys, i);
        key now = {0};
        bool valid = lr_read_number(reader, at, &frame_field, name, &now.frame);
        valid &= read(reader, lr_map_value(keys, i), field, what, now.value);
        good &= valid;
        if (!valid)
            continue;
        if (now.frame <= last) {
            lr_report_add(reader->report, at->offset,
                          "%s is %.10g, expected more than the one before it, %.10g", name,
                          now.frame, last);
            good = false;
        }
        last = now.frame;
        if (now.frame <= reader->options.frame || i == 0)
            before = now;
        if (!reached)
            after = now;
        reached = reached || now.frame >= reader->options.frame;
    }
    if (good)
        blend(&before, &after, fmin(fmax(reader->options.frame, before.frame), after.frame), count,
              value);
    reader->scene->moves = reader->scene->moves || keys->count > 1;
    return good;
}
