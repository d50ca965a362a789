/* The JSON Schema (draft 2020-12) of the scene language, from the tables of keys. */
#include "scene/keys.h"

#include <jansson.h>
#include <string.h>

/* jansson's functions accept NULL and then fail, so the results are checked once, at the end:
 * put() remembers whether anything failed. */
typedef struct schema {
    bool failed;
} schema;

static json_t *put(schema *s, json_t *object, const char *key, json_t *value)
{
    if (json_object_set_new(object, key, value) != 0)
        s->failed = true;
    return object;
}

static json_t *append(schema *s, json_t *array, json_t *value)
{
    if (json_array_append_new(array, value) != 0)
        s->failed = true;
    return array;
}

static json_t *typed(schema *s, const char *type)
{
    return put(s, json_object(), "type", json_string(type));
}

static json_t *reference(schema *s, const char *name)
{
    char path[64] = "#/$defs/";
    strncat(path, name, sizeof path - strlen(path) - 1);
    return put(s, json_object(), "$ref", json_string(path));
}

/* Whole numbers are written as such: 1, not 1.0. */
static json_t *number(double value)
{
    if (value == (double)(json_int_t)value && value < 1e15 && value > -1e15)
        return json_integer((json_int_t)value);
    return json_real(value);
}

static json_t *numbers(schema *s, const double *values, int count)
{
    json_t *array = json_array();
    for (int i = 0; i < count; i++)
        append(s, array, number(values[i]));
    return array;
}

static json_t *ranged(schema *s, const char *type, const lr_field *field)
{
    json_t *node = typed(s, type);
    put(s, node, field->flags & LR_ABOVE ? "exclusiveMinimum" : "minimum", number(field->minimum));
    put(s, node, field->flags & LR_BELOW ? "exclusiveMaximum" : "maximum", number(field->maximum));
    return node;
}

static json_t *list_of(schema *s, json_t *items, int count)
{
    json_t *node = put(s, typed(s, "array"), "items", items);
    put(s, node, "minItems", json_integer(count));
    return put(s, node, "maxItems", json_integer(count));
}

static json_t *any_of(schema *s, json_t *first, json_t *second)
{
    json_t *options = append(s, append(s, json_array(), first), second);
    return put(s, json_object(), "anyOf", options);
}

/* A colour with components up to 1, or up to the language's limit. */
static json_t *color(schema *s, const lr_field *field)
{
    return reference(s, field->maximum <= 1 ? "share" : "color");
}

static json_t *record_schema(schema *s, const lr_record *record);

static json_t *named(schema *s, const char *definition, int minimum)
{
    json_t *node = put(s, typed(s, "object"), "additionalProperties", reference(s, definition));
    return minimum ? put(s, node, "minProperties", json_integer(minimum)) : node;
}

/* A value, or one that changes from frame to frame. */
static json_t *moving(schema *s, json_t *node)
{
    return any_of(s, node, reference(s, "keys"));
}

static json_t *field_schema(schema *s, const lr_field *field)
{
    const double *d = field->fallback;
    json_t *node = NULL, *fallback = NULL;
    bool grey = d[0] == d[1] && d[1] == d[2];
    switch (field->type) {
    case LR_FIELD_NUMBER:
    case LR_FIELD_INTEGER:
        node = field->type == LR_FIELD_INTEGER ? ranged(s, "integer", field)
                                               : moving(s, ranged(s, "number", field));
        fallback = number(d[0]);
        break;
    case LR_FIELD_BOOLEAN:
        node = typed(s, "boolean");
        fallback = json_boolean(d[0] != 0);
        break;
    case LR_FIELD_CHOICE: {
        json_t *choices = json_array();
        for (int i = 0; field->choices[i]; i++)
            append(s, choices, json_string(field->choices[i]));
        node = put(s, json_object(), "enum", choices);
        fallback = json_string(field->choices[(int)d[0]]);
        break;
    }
    case LR_FIELD_VECTOR:
        node = moving(s, reference(s, "vector"));
        fallback = numbers(s, d, 3);
        break;
    case LR_FIELD_COLOR:
        node = moving(s, color(s, field));
        fallback = grey ? number(d[0]) : numbers(s, d, 3);
        break;
    case LR_FIELD_COLORS:
        node = list_of(s, color(s, field), 2);
        break;
    case LR_FIELD_SCALE:
        node = moving(s, any_of(s, ranged(s, "number", field), reference(s, "vector")));
        fallback = number(d[0]);
        break;
    case LR_FIELD_ROTATE:
        node = moving(s, any_of(s, reference(s, "vector"), reference(s, "rotate")));
        fallback = numbers(s, d, 3);
        break;
    case LR_FIELD_MATRIX:
        node = list_of(s, list_of(s, ranged(s, "number", field), 4), 3);
        break;
    case LR_FIELD_RECORD:
        node = record_schema(s, field->record);
        break;
    case LR_FIELD_PAINT:
        node = moving(s, any_of(s, reference(s, "color"), reference(s, "pattern")));
        fallback = numbers(s, d, 3);
        break;
    case LR_FIELD_MAP:
        node = any_of(s, typed(s, "string"), record_schema(s, field->record));
        break;
    case LR_FIELD_BACKGROUND:
        node = moving(s, any_of(s, reference(s, "color"), reference(s, "background")));
        fallback = put(s, json_object(), "gradient",
                       append(s, append(s, json_array(), numbers(s, d, 3)), numbers(s, d + 3, 3)));
        break;
    case LR_FIELD_MATERIAL:
        node = any_of(s, typed(s, "string"), reference(s, "material"));
        break;
    case LR_FIELD_MATERIALS:
        node = named(s, "material", 0);
        break;
    case LR_FIELD_CAMERAS:
        node = named(s, "camera", 1);
        break;
    case LR_FIELD_LIGHTS:
        node = put(s, typed(s, "array"), "items", reference(s, "light"));
        put(s, node, "maxItems", json_integer(LR_LIGHTS_MAX));
        break;
    case LR_FIELD_OBJECTS:
        node = put(s, typed(s, "array"), "items", reference(s, "object"));
        put(s, node, "minItems", json_integer(1));
        break;
    case LR_FIELD_TEXT:
        node = typed(s, "string");
        break;
    case LR_FIELD_TEXTS:
        node = put(s, typed(s, "array"), "items", typed(s, "string"));
        break;
    case LR_FIELD_MAPPING:
        node = typed(s, "object");
        break;
    }
    put(s, node, "description", json_string(field->doc));
    if (fallback && !(field->flags & (LR_REQUIRED | LR_DERIVED)))
        put(s, node, "default", fallback);
    else
        json_decref(fallback);
    return node;
}

static json_t *record_schema(schema *s, const lr_record *record)
{
    json_t *node = typed(s, "object");
    json_t *properties = json_object(), *required = json_array();
    put(s, node, "description", json_string(record->doc));
    for (uint32_t i = 0; i < record->count; i++) {
        const lr_field *field = &record->fields[i];
        put(s, properties, field->name, field_schema(s, field));
        if (field->flags & LR_REQUIRED)
            append(s, required, json_string(field->name));
    }
    put(s, node, "properties", properties);
    if (json_array_size(required) > 0)
        put(s, node, "required", required);
    else
        json_decref(required);
    return put(s, node, "additionalProperties", json_false());
}

/* An item {kind: {...}} of a list: exactly one of the records' names. */
static json_t *item_schema(schema *s, const lr_record *records, uint32_t count,
                           const lr_record *extra)
{
    json_t *node = typed(s, "object"), *properties = json_object();
    for (uint32_t i = 0; i < count; i++)
        put(s, properties, records[i].name, record_schema(s, &records[i]));
    if (extra)
        put(s, properties, extra->name, record_schema(s, extra));
    put(s, node, "properties", properties);
    put(s, node, "minProperties", json_integer(1));
    put(s, node, "maxProperties", json_integer(1));
    return put(s, node, "additionalProperties", json_false());
}

/* Any word passes as a colour name here: 148 names in a schema would drown the completion. */
static json_t *color_schema(schema *s, double maximum)
{
    lr_field component = {.maximum = maximum};
    json_t *options = json_array();
    append(s, options, ranged(s, "number", &component));
    append(s, options, list_of(s, ranged(s, "number", &component), 3));
    append(s, options,
           put(s, typed(s, "string"), "pattern",
               json_string("^(#[0-9a-fA-F]{3}|#[0-9a-fA-F]{6}|[a-zA-Z]+)$")));
    json_t *node = put(s, json_object(), "anyOf", options);
    return put(s, node, "description",
               json_string("Linear [r, g, b], one number for a grey, or sRGB as \"#rrggbb\", "
                           "\"#rgb\" or a CSS colour name."));
}

/* {keys: {0: ..., 24: ...}} */
static json_t *keys_schema(schema *s)
{
    json_t *frames = put(s, typed(s, "object"), "propertyNames",
                         put(s, json_object(), "pattern", json_string("^[-+]?[0-9.]+$")));
    put(s, frames, "minProperties", json_integer(1));
    put(s, frames, "description", json_string("Frames and the values there, blended in between."));
    json_t *node = put(s, typed(s, "object"), "properties", put(s, json_object(), "keys", frames));
    put(s, node, "required", append(s, json_array(), json_string("keys")));
    return put(s, node, "additionalProperties", json_false());
}

static json_t *one_of(schema *s, const lr_record *records, uint32_t count)
{
    json_t *options = json_array();
    for (uint32_t i = 0; i < count; i++)
        append(s, options, record_schema(s, &records[i]));
    return put(s, json_object(), "oneOf", options);
}

static json_t *definitions(schema *s)
{
    json_t *defs = json_object();
    put(s, defs, "keys", keys_schema(s));
    lr_field coordinate = {.minimum = -LR_COORDINATE_MAX, .maximum = LR_COORDINATE_MAX};
    put(s, defs, "vector", list_of(s, ranged(s, "number", &coordinate), 3));
    put(s, defs, "color", color_schema(s, LR_COLOR_MAX));
    put(s, defs, "share", color_schema(s, 1));
    put(s, defs, "rotate", record_schema(s, &lr_rotation_record));
    put(s, defs, "camera", record_schema(s, &lr_camera_record));
    put(s, defs, "background", one_of(s, lr_background_records, lr_background_record_count));
    put(s, defs, "pattern", one_of(s, lr_pattern_records, lr_pattern_record_count));
    put(s, defs, "material", record_schema(s, &lr_material_record));
    put(s, defs, "light", item_schema(s, lr_light_records, lr_light_record_count, NULL));
    return put(s, defs, "object",
               item_schema(s, lr_object_records, lr_object_record_count, &lr_group_record));
}

/* The scene's `camera` or `cameras`, not both. */
static json_t *one_camera(schema *s)
{
    json_t *options = json_array();
    static const char *const keys[] = {"camera", "cameras"};
    for (int i = 0; i < 2; i++) {
        json_t *required = append(s, json_array(), json_string(keys[i]));
        append(s, options, put(s, json_object(), "required", required));
    }
    return options;
}

char *lr_scene_schema(void)
{
    schema s = {0};
    json_t *root = json_object();
    put(&s, root, "$schema", json_string("https://json-schema.org/draft/2020-12/schema"));
    put(&s, root, "title", json_string("lavaray scene, version 1"));
    json_t *scene = record_schema(&s, &lr_scene_record);
    if (!scene || json_object_update(root, scene) != 0)
        s.failed = true;
    json_decref(scene);
    put(&s, root, "oneOf", one_camera(&s));
    put(&s, root, "$defs", definitions(&s));
    char *text = s.failed ? NULL : json_dumps(root, JSON_INDENT(2) | JSON_REAL_PRECISION(15));
    json_decref(root);
    return text;
}
