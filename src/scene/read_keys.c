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

static bool differ(const key *a, const key *b)
{
    return a->value[0] != b->value[0] || a->value[1] != b->value[1] || a->value[2] != b->value[2];
}

/* FNV-1a over the words of a key, with the high bits brought down. */
static uint64_t hash_key(uint64_t hash, const key *k, double frame)
{
    const double numbers[] = {k->frame - frame, k->value[0], k->value[1], k->value[2]};
    for (int i = 0; i < 4; i++) {
        uint64_t bits;
        double number = numbers[i] == 0 ? 0 : numbers[i]; /* -0 as +0 */
        memcpy(&bits, &number, sizeof bits);
        hash = (hash ^ bits) * 1099511628211u;
        hash ^= hash >> 32;
    }
    return hash;
}

/* How a value goes on from the reader's frame, as its keys are read one after the other. */
typedef struct course {
    uint64_t hash; /* of the keys around that frame and the next */
    bool changes;
    double changes_from;
} course;

static void follow(course *c, const key *last, const key *now, double frame)
{
    if (now->frame <= frame)
        c->hash = 0;
    if (now->frame <= frame || last->frame < frame + 1)
        c->hash = hash_key(c->hash, now, frame);
    if (!c->changes && now->frame > frame && differ(last, now)) {
        c->changes = true;
        c->changes_from = fmax(last->frame, frame);
    }
}

/* Tells the scene. */
static void note_course(lr_reader *reader, const course *c)
{
    lr_scene *scene = reader->scene;
    const key whole = {.value = {(double)(uint32_t)c->hash, (double)(c->hash >> 32)}};
    scene->motion = hash_key(scene->motion, &whole, 0);
    if (!c->changes || reader->beside_motion)
        return;
    if (!scene->things_move || c->changes_from < scene->moves_from)
        scene->moves_from = c->changes_from;
    scene->things_move = true;
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
    key last = {.frame = -INFINITY};
    course way = {0};
    bool good = true, reached = false;
    for (uint32_t i = 0; i < keys->count; i++) {
        const lr_node *at = lr_map_key(keys, i);
        key now = {0};
        bool valid = lr_read_number(reader, at, &frame_field, name, &now.frame);
        valid &= read(reader, lr_map_value(keys, i), field, what, now.value);
        good &= valid;
        if (!valid)
            continue;
        if (now.frame <= last.frame) {
            lr_report_add(reader->report, at->offset,
                          "%s is %.10g, expected more than the one before it, %.10g", name,
                          now.frame, last.frame);
            good = false;
        }
        if (i == 0)
            way.hash = hash_key(0, &now, reader->options.frame);
        else
            follow(&way, &last, &now, reader->options.frame);
        last = now;
        if (now.frame <= reader->options.frame || i == 0)
            before = now;
        if (!reached)
            after = now;
        reached = reached || now.frame >= reader->options.frame;
    }
    if (good)
        blend(&before, &after, fmin(fmax(reader->options.frame, before.frame), after.frame), count,
              value);
    note_course(reader, &way);
    reader->keyed += keys->count > 1;
    reader->scene->moves = reader->scene->moves || keys->count > 1;
    return good;
}
