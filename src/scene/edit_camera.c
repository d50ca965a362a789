/* A camera into a scene's text. The places of its values come from the tree that the reader uses;
 * the result is read again and must be the old scene with the new camera. */
#include "scene/save_camera.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "scene/bounds.h"
#include "scene/read.h"
#include "scene/write.h"

#define SHOWN "%.400s"

/* ---- Reading ------------------------------------------------------------------------------- */

/* A text of which the cameras are known. */
typedef struct document {
    lr_report *report;
    lr_tree tree;
    lr_scene *scene;
} document;

static void close_document(document *d)
{
    lr_tree_free(&d->tree);
    lr_scene_destroy(d->scene);
    if (d->report)
        lr_report_free(d->report);
    free(d->report);
}

/* LR_ERROR_SCENE, without a message, when the text is wrong. */
static lr_status open_document(document *d, const char *text, size_t length, const char *name)
{
    *d = (document){.report = lr_alloc(1, sizeof *d->report),
                    .scene = lr_alloc(1, sizeof *d->scene)};
    if (!d->report || !d->scene)
        return LR_ERROR_MEMORY;
    d->report->language = &lr_scene_language;
    d->report->name = name;
    d->report->text = text;
    d->report->length = length;
    if (lr_text_check(d->report)) {
        lr_tree_read(&d->tree, d->report);
        lr_read_tree(&d->tree, d->scene, d->report, NULL, lr_read_cameras);
    }
    if (d->report->no_memory)
        return LR_ERROR_MEMORY;
    return d->report->count ? LR_ERROR_SCENE : LR_OK;
}

static const lr_node *value_of(const lr_node *map, const char *key)
{
    for (uint32_t i = 0; i < map->count; i++)
        if (strcmp(lr_map_key(map, i)->text, key) == 0)
            return lr_map_value(map, i);
    return NULL;
}

/* ---- Writing ------------------------------------------------------------------------------- */

/* The text on its way from the old one to the new one. */
typedef struct edit {
    const char *text;
    size_t length, at; /* so far has the old text gone out, or was left out */
    FILE *out;
    const lr_node *map;              /* the camera's */
    const lr_camera *before, *after; /* as it is written, as it is to be */
    const char *line_end;
} edit;

static void copy_to(edit *e, size_t offset)
{
    if (offset > e->at) {
        fwrite(e->text + e->at, 1, offset - e->at, e->out);
        e->at = offset;
    }
}

static bool is_alias(const edit *e, const lr_node *node)
{
    return node->start < e->length && e->text[node->start] == '*';
}

/* How many numbers the field holds; 0: it is not a matter of the pose. */
static uint32_t numbers_in(const lr_field *field)
{
    return field->type == LR_FIELD_VECTOR ? 3 : field->type == LR_FIELD_NUMBER ? 1 : 0;
}

static const double *numbers_of(const lr_field *field, const lr_camera *camera)
{
    return (const double *)(const void *)((const char *)camera + field->offset);
}

static bool is_right(const edit *e, const lr_field *field)
{
    const double *before = numbers_of(field, e->before), *after = numbers_of(field, e->after);
    for (uint32_t i = 0; i < numbers_in(field); i++)
        if (before[i] != after[i])
            return false;
    return true;
}

static bool holds_mapping(const lr_node *node)
{
    bool found = node->kind == LR_NODE_MAP;
    for (uint32_t i = 0; node->kind == LR_NODE_LIST && i < node->count; i++)
        found = found || holds_mapping(node->items[i]);
    return found;
}

/* The first key that would have to change and has keys of frames, which one pose cannot replace;
 * NULL: none. */
static const char *moving_key(const edit *e)
{
    for (uint32_t i = 0; i < e->map->count; i++) {
        const lr_node *key = lr_map_key(e->map, i);
        const lr_field *field = lr_field_find(&lr_camera_record, key->text, key->count);
        if (field && !is_right(e, field) && holds_mapping(lr_map_value(e->map, i)))
            return field->name;
    }
    return NULL;
}

static void put_numbers(edit *e, const lr_field *field)
{
    bool list = field->type == LR_FIELD_VECTOR;
    fputs(list ? "[" : "", e->out);
    lr_put_numbers(e->out, numbers_of(field, e->after), numbers_in(field));
    fputs(list ? "]" : "", e->out);
}

static void replace(edit *e, const lr_field *field, const lr_node *value)
{
    if (value->kind == LR_NODE_LIST && !is_alias(e, value) && value->count == 3) {
        const double *before = numbers_of(field, e->before), *after = numbers_of(field, e->after);
        for (uint32_t i = 0; i < 3; i++) {
            if (before[i] == after[i])
                continue;
            copy_to(e, value->items[i]->start);
            lr_put_number(e->out, after[i]);
            e->at = value->items[i]->end;
        }
    } else {
        copy_to(e, value->start);
        put_numbers(e, field);
        e->at = value->end;
    }
}

/* ---- New keys ------------------------------------------------------------------------------ */

static bool is_blank(char c)
{
    return c == ' ' || c == '\t';
}

static size_t skip_blanks(const edit *e, size_t offset)
{
    while (offset < e->length && is_blank(e->text[offset]))
        offset++;
    return offset;
}

static bool ends_line(const edit *e, size_t offset)
{
    return offset == e->length || e->text[offset] == '\n' || e->text[offset] == '\r';
}

static size_t line_start(const edit *e, size_t offset)
{
    while (offset > 0 && e->text[offset - 1] != '\n' && e->text[offset - 1] != '\r')
        offset--;
    return offset;
}

static size_t line_end(const edit *e, size_t offset)
{
    while (!ends_line(e, offset))
        offset++;
    return offset;
}

/* Begins a line where `offset` of the old text stands in its own. */
static void put_indentation(edit *e, size_t offset)
{
    size_t start = line_start(e, offset);
    fputs(e->line_end, e->out);
    for (size_t i = start; i < offset;) {
        size_t size = lr_utf8_length(e->text + i, e->length - i);
        /* Tabs may stand between brackets; a byte order mark takes no room. */
        if (e->text[i] == '\t' || size == 1)
            fputc(e->text[i] == '\t' ? '\t' : ' ', e->out);
        else if (size > 1 && i > 0)
            fputc(' ', e->out);
        i += size ? size : 1;
    }
}

/* The next field from *index on that must be added, NULL when there is none. */
static const lr_field *next_missing(const edit *e, uint32_t *index)
{
    while (*index < lr_camera_record.count) {
        const lr_field *field = &lr_camera_record.fields[(*index)++];
        if (numbers_in(field) && !is_right(e, field) && !value_of(e->map, field->name))
            return field;
    }
    return NULL;
}

/* As the keys are written that are there already. */
typedef struct style {
    bool quoted;
    bool tight; /* no space behind colons and commas, as in JSON for machines */
} style;

static style style_of(const edit *e, const lr_node *key)
{
    style found = {.quoted = key->kind == LR_NODE_QUOTED};
    found.tight = found.quoted && key->end + 1 < e->length && e->text[key->end] == ':' &&
                  !is_blank(e->text[key->end + 1]) && !ends_line(e, key->end + 1);
    return found;
}

static void put_pair(edit *e, const lr_field *field, style like)
{
    const char *quote = like.quoted ? "\"" : "";
    fprintf(e->out, "%s%s%s:%s", quote, field->name, quote, like.tight ? "" : " ");
    put_numbers(e, field);
}

/* Below the last pair, behind its comment. */
static void add_to_block(edit *e, const lr_node *last_key, const lr_node *last_value)
{
    uint32_t index = 0;
    copy_to(e, line_end(e, last_value->end));
    for (const lr_field *field; (field = next_missing(e, &index));) {
        put_indentation(e, last_key->start);
        put_pair(e, field, style_of(e, last_key));
    }
}

/* Behind the last pair: on its line, or on lines of their own if it has one. */
static void add_to_flow(edit *e, const lr_node *last_key, const lr_node *last_value)
{
    style like = style_of(e, last_key);
    size_t first = skip_blanks(e, line_start(e, last_key->start));
    size_t behind = skip_blanks(e, last_value->end);
    bool comma = behind < e->length && e->text[behind] == ',';
    behind = comma ? skip_blanks(e, behind + 1) : behind;
    bool own_line = first == last_key->start;
    uint32_t index = 0;
    copy_to(e, last_value->end);
    if (own_line && (ends_line(e, behind) || e->text[behind] == '#')) {
        fputs(comma ? "" : ",", e->out);
        copy_to(e, line_end(e, behind));
        const lr_field *field = next_missing(e, &index);
        while (field) {
            put_indentation(e, last_key->start);
            put_pair(e, field, like);
            field = next_missing(e, &index);
            fputs(field || comma ? "," : "", e->out);
        }
        return;
    }
    for (const lr_field *field; (field = next_missing(e, &index));) {
        fputs(own_line || like.tight ? "," : ", ", e->out);
        if (own_line)
            put_indentation(e, last_key->start);
        put_pair(e, field, like);
    }
}

/* Between the brackets of an empty mapping; `key` is the one that the mapping is the value of. */
static void fill_empty(edit *e, const lr_node *key)
{
    style like = style_of(e, key);
    uint32_t index = 0;
    copy_to(e, e->map->start + 1);
    const lr_field *field = next_missing(e, &index);
    while (field) {
        put_pair(e, field, like);
        field = next_missing(e, &index);
        fputs(!field ? "" : like.tight ? "," : ", ", e->out);
    }
}

/* ---- The whole ----------------------------------------------------------------------------- */

static void put_map(edit *e, const lr_node *map_key)
{
    const lr_node *map = e->map;
    if (is_alias(e, map)) {
        copy_to(e, map->start);
        lr_put_camera(e->out, e->after);
        e->at = map->end;
        return;
    }
    for (uint32_t i = 0; i < map->count; i++) {
        const lr_node *key = lr_map_key(map, i);
        const lr_field *field = lr_field_find(&lr_camera_record, key->text, key->count);
        if (field && !is_right(e, field))
            replace(e, field, lr_map_value(map, i));
    }
    uint32_t index = 0;
    if (!next_missing(e, &index))
        return;
    bool flow = e->text[map->start] == '{';
    if (map->count == 0)
        fill_empty(e, map_key);
    else
        (flow ? add_to_flow : add_to_block)(e, lr_map_key(map, map->count - 1),
                                            lr_map_value(map, map->count - 1));
}

typedef struct job {
    edit edit;
    const lr_node *key;
} job;

static void put_text(FILE *out, void *of)
{
    job *j = of;
    j->edit.out = out;
    put_map(&j->edit, j->key);
    copy_to(&j->edit, j->edit.length);
}

/* As the text's first line ends. */
static const char *line_end_of(const char *text, size_t length)
{
    const char *end = memchr(text, '\n', length);
    return end && end > text && end[-1] == '\r' ? "\r\n" : "\n";
}

static bool same_node(const lr_node *a, const lr_node *b)
{
    if (a->kind != b->kind || a->count != b->count)
        return false;
    if (a->kind == LR_NODE_PLAIN || a->kind == LR_NODE_QUOTED)
        return memcmp(a->text, b->text, a->count) == 0;
    uint32_t count = a->kind == LR_NODE_LIST ? a->count : a->kind == LR_NODE_MAP ? 2 * a->count : 0;
    for (uint32_t i = 0; i < count; i++)
        if (!same_node(a->items[i], b->items[i]))
            return false;
    return true;
}

/* Whether the maps are the same but for the value number `but`. */
static bool same_pairs(const lr_node *a, const lr_node *b, uint32_t but)
{
    bool same = a->count == b->count;
    for (uint32_t i = 0; same && i < a->count; i++)
        same = same_node(lr_map_key(a, i), lr_map_key(b, i)) &&
               (i == but || same_node(lr_map_value(a, i), lr_map_value(b, i)));
    return same;
}

static bool same_pose(const lr_camera *a, const lr_camera *b)
{
    bool same = a->fov_to_centers == b->fov_to_centers;
    for (uint32_t i = 0; i < lr_camera_record.count; i++) {
        const lr_field *field = &lr_camera_record.fields[i];
        for (uint32_t k = 0; k < numbers_in(field); k++)
            same = same && numbers_of(field, a)[k] == numbers_of(field, b)[k];
    }
    return same;
}

/* Whether `after` is `before` with another camera `index`, and which. */
static bool is_meant(const document *before, const document *after, uint32_t index,
                     const lr_camera *camera)
{
    const lr_node *a = before->tree.root, *b = after->tree.root;
    uint32_t at = 0;
    while (strncmp(lr_map_key(a, at)->text, "camera", 6) != 0)
        at++;
    bool named = before->scene->cameras[0].name != NULL;
    return same_pairs(a, b, at) &&
           (!named || same_pairs(lr_map_value(a, at), lr_map_value(b, at), index)) &&
           same_pose(&after->scene->cameras[index], camera);
}

/* The camera's mapping, and the key that it is the value of. */
static const lr_node *find_map(const lr_node *root, uint32_t index, const lr_node **key)
{
    const lr_node *map = root;
    for (uint32_t i = 0; i < root->count; i++) {
        *key = lr_map_key(root, i);
        map = lr_map_value(root, i);
        if (strcmp((*key)->text, "camera") == 0)
            return map;
        if (strcmp((*key)->text, "cameras") == 0)
            break;
    }
    *key = lr_map_key(map, index);
    return lr_map_value(map, index);
}

static lr_status check(const document *before, const char *text, size_t length, const char *name,
                       uint32_t index, const lr_camera *camera, lr_error *error)
{
    document after;
    lr_status status = open_document(&after, text, length, name);
    if (status == LR_OK && !is_meant(before, &after, index, camera))
        status = LR_ERROR_SCENE;
    close_document(&after);
    if (status == LR_ERROR_SCENE)
        return lr_fail(error, status,
                       SHOWN ":%u: the camera cannot be changed without another part of the scene, "
                             "such as one that repeats it by an alias (*name): write its values "
                             "out there",
                       name, before->scene->cameras[index].line);
    return status;
}

lr_status lr_camera_edit(const char *text, size_t length, const char *name, uint32_t index,
                         const lr_camera *camera, char **edited, size_t *edited_length,
                         lr_error *error)
{
    *edited = NULL;
    document before;
    lr_status status = open_document(&before, text, length, name);
    if (status == LR_ERROR_SCENE) {
        lr_fail(error, status, SHOWN ": is not a scene; lavaray validate tells what is wrong",
                name);
    } else if (!status && index >= before.scene->camera_count) {
        status = lr_fail(error, LR_ERROR_ARGUMENT, SHOWN ": has no camera number %u", name, index);
    } else if (!status) {
        lr_camera after = *camera;
        after.fov_to_centers = before.scene->cameras[index].fov_to_centers;
        job j = {.edit = {.text = text,
                          .length = length,
                          .before = &before.scene->cameras[index],
                          .after = &after,
                          .line_end = line_end_of(text, length)}};
        j.edit.map = find_map(before.tree.root, index, &j.key);
        const char *moving = moving_key(&j.edit);
        if (moving)
            status = lr_fail(error, LR_ERROR_ARGUMENT,
                             SHOWN ":%u: the camera's %s has keys, which one pose cannot replace: "
                                   "change them by hand",
                             name, before.scene->cameras[index].line, moving);
        else
            *edited = lr_written(put_text, &j, edited_length);
        if (*edited)
            status = check(&before, *edited, *edited_length, name, index, &after, error);
        else if (!moving)
            status = LR_ERROR_MEMORY;
    }
    close_document(&before);
    if (status == LR_ERROR_MEMORY)
        lr_fail(error, status, SHOWN ": out of memory while saving the camera", name);
    if (status) {
        free(*edited);
        *edited = NULL;
    }
    return status;
}
