/* Mappings against the tables of keys, with advice for keys that stand in the wrong place. */
#include "scene/read.h"

#include <stdio.h>
#include <string.h>

void lr_record_defaults(const lr_record *record, void *base)
{
    for (uint32_t i = 0; i < record->count; i++) {
        const lr_field *field = &record->fields[i];
        const double *d = field->fallback;
        char *out = (char *)base + field->offset;
        if (field->flags & LR_DERIVED)
            continue;
        switch (field->type) {
        case LR_FIELD_NUMBER:
            *(double *)(void *)out = d[0];
            break;
        case LR_FIELD_INTEGER:
        case LR_FIELD_CHOICE:
            *(uint32_t *)(void *)out = (uint32_t)(int64_t)d[0];
            break;
        case LR_FIELD_BOOLEAN:
            *(bool *)(void *)out = d[0] != 0;
            break;
        case LR_FIELD_VECTOR:
        case LR_FIELD_COLOR:
        case LR_FIELD_SCALE:
            *(lr_vec3 *)(void *)out = (lr_vec3){d[0], d[1], d[2]};
            break;
        case LR_FIELD_COLORS:
            memset(out, 0, 2 * sizeof(lr_color));
            break;
        case LR_FIELD_ROTATE:
            *(lr_transform *)(void *)out = lr_transform_identity();
            break;
        case LR_FIELD_MATRIX: /* derived */
            break;
        case LR_FIELD_TEXT:
            *(const char **)(void *)out = NULL;
            break;
        default:
            break;
        }
    }
}

const lr_node *lr_given_value(const lr_given *given, const lr_record *record, const char *name)
{
    return given->values[lr_field_index(record, name)];
}

/* Types up to LR_FIELD_TEXT are stored by the reader of values; the enum says so. */
static bool is_stored(const lr_field *field)
{
    return field->type <= LR_FIELD_TEXT;
}

/* The field that `name:value` without a space means, NULL when it is no such thing. */
static const lr_field *field_before_colon(const lr_record *record, const lr_node *key)
{
    const char *colon = memchr(key->text, ':', key->count);
    return colon ? lr_field_find(record, key->text, (size_t)(colon - key->text)) : NULL;
}

/* Whether an empty value above the key is a record that has the key: then the key was meant to be
 * inside and is not indented. */
static const char *empty_owner(const lr_record *record, const lr_given *given, const lr_node *key)
{
    for (uint32_t i = 0; i < record->count; i++) {
        const lr_field *field = &record->fields[i];
        const lr_node *value = given->values[i];
        if (field->record && value && value->kind == LR_NODE_EMPTY &&
            lr_field_find(field->record, key->text, key->count))
            return field->name;
    }
    return NULL;
}

/* Returns the field that was probably meant, or NULL. */
static const lr_field *report_unknown_key(lr_reader *reader, const lr_node *key,
                                          const lr_record *record, const lr_given *given)
{
    char shown[LR_SHOWN_MAX], message[1024];
    if (!lr_report_has_room(reader->report)) {
        reader->report->dropped++;
        return NULL;
    }
    lr_shown(shown, key->text, key->count);
    const lr_field *meant = field_before_colon(record, key);
    if (meant) {
        lr_report_add(reader->report, key->offset,
                      "no space after the colon in \"%s\", expected \"%s: %s\"", shown, meant->name,
                      shown + strlen(meant->name) + 1);
        return meant;
    }
    const char *owner = empty_owner(record, given, key);
    if (owner) {
        lr_report_add(reader->report, key->offset,
                      "%s belongs to %s, expected it indented deeper than %s", shown, owner, owner);
        return NULL;
    }
    lr_nearest nearest = {.text = key->text, .length = key->count};
    int used = snprintf(message, sizeof message, "unknown key \"%s\" in %s", shown, record->name);
    for (uint32_t i = 0; i < record->count; i++)
        lr_nearest_offer(&nearest, record->fields[i].name);
    for (uint32_t i = 0; !nearest.best && i < record->count; i++)
        used += snprintf(message + used, sizeof message - (size_t)used, "%s%s",
                         i ? ", " : ", expected one of ", record->fields[i].name);
    lr_report_unknown(reader, key, message, &nearest);
    return nearest.best ? lr_field_find(record, nearest.best, strlen(nearest.best)) : NULL;
}

bool lr_read_record(lr_reader *reader, const lr_node *node, const lr_node *at,
                    const lr_record *record, void *base, lr_given *given)
{
    *given = (lr_given){.valid = true};
    lr_record_defaults(record, base);
    if (node->kind != LR_NODE_MAP) {
        char expected[LR_EXPECTED_MAX];
        snprintf(expected, sizeof expected, "a mapping such as {%s: ...}", record->fields[0].name);
        lr_report_type(reader, node, record->name, expected);
        return given->valid = false;
    }
    /* A mistyped key is reported as such, not as missing too. */
    bool meant[LR_FIELDS_MAX] = {false};
    for (uint32_t i = 0; i < node->count; i++) {
        const lr_node *key = lr_map_key(node, i), *value = lr_map_value(node, i);
        const lr_field *field = lr_field_find(record, key->text, key->count);
        if (!field) {
            field = report_unknown_key(reader, key, record, given);
            if (field)
                meant[field - record->fields] = true;
            given->valid = false;
            continue;
        }
        given->values[field - record->fields] = value;
        if (is_stored(field) && !lr_read_value(reader, value, field, (char *)base + field->offset))
            given->valid = false;
    }
    for (uint32_t i = 0; i < record->count; i++) {
        const lr_field *field = &record->fields[i];
        char expected[LR_EXPECTED_MAX];
        if (!(field->flags & LR_REQUIRED) || given->values[i] || meant[i])
            continue;
        lr_report_add(reader->report, at->offset, "%s has no \"%s\", expected %s", record->name,
                      field->name, lr_field_expected(field, expected));
        given->valid = false;
    }
    return given->valid;
}

/* ---- Items of a list of kinds -------------------------------------------------------------- */

static const lr_record *find_kind(const lr_record *records, uint32_t count, const lr_record *extra,
                                  const lr_node *key)
{
    for (uint32_t i = 0; i < count; i++)
        if (strcmp(records[i].name, key->text) == 0)
            return &records[i];
    return extra && strcmp(extra->name, key->text) == 0 ? extra : NULL;
}

static void report_unknown_kind(lr_reader *reader, const lr_node *key, const char *what,
                                const lr_record *records, uint32_t count, const lr_record *extra)
{
    char shown[LR_SHOWN_MAX], message[1024];
    lr_nearest nearest = {.text = key->text, .length = key->count};
    int used = snprintf(message, sizeof message, "unknown %s \"%s\"", what,
                        lr_shown(shown, key->text, key->count));
    for (uint32_t i = 0; i < count; i++)
        lr_nearest_offer(&nearest, records[i].name);
    if (extra)
        lr_nearest_offer(&nearest, extra->name);
    for (uint32_t i = 0; !nearest.best && i < count; i++)
        used += snprintf(message + used, sizeof message - (size_t)used, "%s%s",
                         i ? ", " : ", expected one of ", records[i].name);
    if (!nearest.best && extra)
        snprintf(message + used, sizeof message - (size_t)used, ", %s", extra->name);
    lr_report_unknown(reader, key, message, &nearest);
}

/* The keys of an item beside the one that names its kind are all misplaced. False when the kind's
 * own value is empty because its keys stand there. */
static bool report_neighbours(lr_reader *reader, const lr_node *item, uint32_t kind_index,
                              const char *what, const lr_record *record, const lr_record *records,
                              uint32_t count, const lr_record *extra)
{
    const lr_node *value = lr_map_value(item, kind_index);
    for (uint32_t i = 0; i < item->count; i++) {
        const lr_node *key = lr_map_key(item, i);
        char shown[LR_SHOWN_MAX];
        if (i == kind_index)
            continue;
        lr_shown(shown, key->text, key->count);
        bool its_key = lr_field_find(record, key->text, key->count) != NULL ||
                       field_before_colon(record, key) != NULL;
        if (its_key && value->kind == LR_NODE_EMPTY) {
            lr_report_add(reader->report, key->offset,
                          "%s stands beside %s, which is empty; indent the keys of %s below it",
                          shown, record->name, record->name);
            return false;
        }
        if (its_key)
            lr_report_add(reader->report, key->offset,
                          "%s stands beside %s, expected inside it, with the keys of %s", shown,
                          record->name, record->name);
        else if (find_kind(records, count, extra, key))
            lr_report_add(reader->report, key->offset,
                          "a second %s in one item, expected a new item: \"- %s:\"", what, shown);
        else
            lr_report_add(reader->report, key->offset,
                          "unknown key \"%s\" beside %s, expected only keys inside %s", shown,
                          record->name, record->name);
    }
    return true;
}

const lr_record *lr_read_kind(lr_reader *reader, const lr_node *item, const char *what,
                              const lr_record *records, uint32_t count, const lr_record *extra,
                              const lr_node **key, const lr_node **value)
{
    char expected[LR_EXPECTED_MAX];
    snprintf(expected, sizeof expected, "a mapping such as `%s: {...}`", records[0].name);
    if (item->kind == LR_NODE_PLAIN && find_kind(records, count, extra, item))
        snprintf(expected, sizeof expected, "a colon and its keys: `%s: {...}`", item->text);
    if (item->kind != LR_NODE_MAP || item->count == 0) {
        char name[64];
        snprintf(name, sizeof name, "this %s", what);
        lr_report_type(reader, item, name, expected);
        return NULL;
    }
    const lr_record *record = NULL;
    uint32_t index = 0;
    while (index < item->count &&
           !(record = find_kind(records, count, extra, lr_map_key(item, index))))
        index++;
    if (!record) {
        report_unknown_kind(reader, lr_map_key(item, 0), what, records, count, extra);
        return NULL;
    }
    *key = lr_map_key(item, index);
    *value = lr_map_value(item, index);
    if (!report_neighbours(reader, item, index, what, record, records, count, extra))
        return NULL;
    if ((*value)->kind == LR_NODE_EMPTY) {
        lr_report_add(reader->report, (*key)->offset,
                      "%s is empty, expected its keys, indented below it, or {} for the defaults",
                      record->name);
        return NULL;
    }
    return record;
}
