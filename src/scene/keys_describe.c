/* Searching the tables of keys, and what their fields expect in words. */
#include "scene/keys.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

const lr_record *lr_record_at(uint32_t index)
{
    static const lr_record *const singles[] = {
        &lr_scene_record, &lr_camera_record,   &lr_image_record,    &lr_fog_record,
        &lr_air_record,   &lr_material_record, &lr_rotation_record, &lr_group_record,
    };
    const uint32_t single_count = sizeof singles / sizeof singles[0];
    if (index < single_count)
        return singles[index];
    index -= single_count;
    if (index < lr_background_record_count)
        return &lr_background_records[index];
    index -= lr_background_record_count;
    if (index < lr_pattern_record_count)
        return &lr_pattern_records[index];
    index -= lr_pattern_record_count;
    if (index < LR_MAP_COUNT)
        return &lr_map_records[index];
    index -= LR_MAP_COUNT;
    if (index < lr_light_record_count)
        return &lr_light_records[index];
    index -= lr_light_record_count;
    return index < lr_object_record_count ? &lr_object_records[index] : NULL;
}

const lr_field *lr_field_find(const lr_record *record, const char *name, size_t length)
{
    for (uint32_t i = 0; i < record->count; i++)
        if (strlen(record->fields[i].name) == length &&
            memcmp(record->fields[i].name, name, length) == 0)
            return &record->fields[i];
    return NULL;
}

uint32_t lr_field_index(const lr_record *record, const char *name)
{
    const lr_field *field = lr_field_find(record, name, strlen(name));
    assert(field);
    return (uint32_t)(field - record->fields);
}

bool lr_key_is_known(const char *name)
{
    const lr_record *record;
    for (uint32_t i = 0; (record = lr_record_at(i)) != NULL; i++)
        if (strcmp(record->name, name) == 0 || lr_field_find(record, name, strlen(name)))
            return true;
    return false;
}

const char *lr_show_number(double value, char buffer[32])
{
    snprintf(buffer, 32, "%.10g", value);
    char *plus = strchr(buffer, '+'); /* 1e+12 */
    if (plus)
        memmove(plus, plus + 1, strlen(plus));
    return buffer;
}

/* "from 0 to 1", "above 0 and below 180". */
static void describe_range(const lr_field *field, char *out, size_t size)
{
    char low[32], high[32];
    lr_show_number(field->minimum, low);
    lr_show_number(field->maximum, high);
    if (field->flags & (LR_ABOVE | LR_BELOW))
        snprintf(out, size, "%s %s and %s %s", field->flags & LR_ABOVE ? "above" : "from", low,
                 field->flags & LR_BELOW ? "below" : "at most", high);
    else
        snprintf(out, size, "from %s to %s", low, high);
}

/* "one, two or three". */
static void describe_choices(const char *const *choices, char *out, size_t size)
{
    size_t used = 0;
    for (uint32_t i = 0; choices[i]; i++) {
        const char *between = i == 0 ? "" : choices[i + 1] ? ", " : " or ";
        int length = snprintf(out + used, size - used, "%s%s", between, choices[i]);
        used += (size_t)length < size - used ? (size_t)length : size - used - 1;
    }
}

const char *lr_field_expected(const lr_field *field, char buffer[LR_EXPECTED_MAX])
{
    char range[96];
    describe_range(field, range, sizeof range);
    size_t size = LR_EXPECTED_MAX;
    switch (field->type) {
    case LR_FIELD_NUMBER:
        if (field->minimum == field->maximum)
            snprintf(buffer, size, "%g", field->minimum);
        else
            snprintf(buffer, size, "a number %s", range);
        break;
    case LR_FIELD_INTEGER:
        snprintf(buffer, size, "a whole number %s", range);
        break;
    case LR_FIELD_BOOLEAN:
        snprintf(buffer, size, "true or false");
        break;
    case LR_FIELD_CHOICE:
        describe_choices(field->choices, buffer, size);
        break;
    case LR_FIELD_VECTOR:
        snprintf(buffer, size, "three numbers [x, y, z]%s",
                 field->flags & LR_NONZERO ? ", not all 0" : "");
        break;
    case LR_FIELD_COLOR:
        snprintf(buffer, size, "a colour: [r, g, b], one number, \"#rrggbb\" or a name, %s", range);
        break;
    case LR_FIELD_COLORS:
        snprintf(buffer, size, "two colours [first, second]");
        break;
    case LR_FIELD_SCALE:
        snprintf(buffer, size, "a number or three numbers [x, y, z], none of them 0");
        break;
    case LR_FIELD_ROTATE:
        snprintf(buffer, size, "three angles [x, y, z] or {axis: [x, y, z], angle: degrees}");
        break;
    case LR_FIELD_MATRIX:
        snprintf(buffer, size, "three rows of four numbers");
        break;
    case LR_FIELD_TEXT:
        snprintf(buffer, size, "%s", field->derived ? field->derived : "a text");
        break;
    case LR_FIELD_RECORD:
        snprintf(buffer, size, "a mapping of the keys of %s", field->record->name);
        break;
    case LR_FIELD_PAINT:
        snprintf(buffer, size,
                 "a colour ([r, g, b], one number, \"#rrggbb\" or a name) or a pattern such as "
                 "{checker: [white, black]}");
        break;
    case LR_FIELD_MAP:
        snprintf(buffer, size, "the file of a picture or a mapping such as {image: file}");
        break;
    case LR_FIELD_BACKGROUND:
        snprintf(buffer, size,
                 "a colour, {gradient: [below, above]}, {image: file} or {sky: direction to "
                 "the sun}");
        break;
    case LR_FIELD_MATERIAL:
        snprintf(buffer, size, "the name of a material or a mapping of material keys");
        break;
    case LR_FIELD_MATERIALS:
        snprintf(buffer, size, "a mapping of names to materials");
        break;
    case LR_FIELD_CAMERAS:
        snprintf(buffer, size, "a mapping of names to cameras");
        break;
    case LR_FIELD_LIGHTS:
        snprintf(buffer, size, "a list of lights such as `- point: {position: [4, 6, 3]}`");
        break;
    case LR_FIELD_OBJECTS:
        snprintf(buffer, size, "a list of objects such as `- sphere: {radius: 1}`");
        break;
    case LR_FIELD_TEXTS:
        snprintf(buffer, size, "a list such as [one, two]");
        break;
    case LR_FIELD_MAPPING:
        snprintf(buffer, size, "a mapping");
        break;
    }
    return buffer;
}

const char *lr_field_default(const lr_field *field, char buffer[LR_EXPECTED_MAX])
{
    const double *d = field->fallback;
    buffer[0] = '\0';
    if (field->flags & LR_REQUIRED)
        return buffer;
    if (field->flags & LR_DERIVED) {
        snprintf(buffer, LR_EXPECTED_MAX, "%s", field->derived);
        return buffer;
    }
    bool grey = d[0] == d[1] && d[1] == d[2];
    switch (field->type) {
    case LR_FIELD_NUMBER:
    case LR_FIELD_INTEGER:
        snprintf(buffer, LR_EXPECTED_MAX, "%.10g", d[0]);
        break;
    case LR_FIELD_BOOLEAN:
        snprintf(buffer, LR_EXPECTED_MAX, "%s", d[0] != 0 ? "true" : "false");
        break;
    case LR_FIELD_CHOICE:
        snprintf(buffer, LR_EXPECTED_MAX, "%s", field->choices[(int)d[0]]);
        break;
    case LR_FIELD_COLOR:
    case LR_FIELD_PAINT:
    case LR_FIELD_SCALE:
        if (grey) {
            snprintf(buffer, LR_EXPECTED_MAX, "%.10g", d[0]);
            break;
        }
        /* fallthrough */
    case LR_FIELD_VECTOR:
    case LR_FIELD_ROTATE:
        snprintf(buffer, LR_EXPECTED_MAX, "[%.10g, %.10g, %.10g]", d[0], d[1], d[2]);
        break;
    case LR_FIELD_BACKGROUND:
        snprintf(buffer, LR_EXPECTED_MAX,
                 "{gradient: [[%.10g, %.10g, %.10g], [%.10g, %.10g, %.10g]]}", d[0], d[1], d[2],
                 d[3], d[4], d[5]);
        break;
    default:
        break;
    }
    return buffer;
}
