/* The tables of keys, the JSON Schema made from them, and docs/scene.md say the same. */
#include "scene_tests.h"

#include "base/file.h"
#include "scene/keys.h"

#include <jansson.h>

static void test_tables(void **state)
{
    (void)state;
    const lr_record *record;
    for (uint32_t i = 0; (record = lr_record_at(i)) != NULL; i++) {
        assert_in_range(record->count, 1, LR_FIELDS_MAX);
        for (uint32_t k = 0; k < record->count; k++) {
            const lr_field *field = &record->fields[k];
            assert_int_equal(lr_field_index(record, field->name), k);
            assert_true(lr_key_is_known(field->name));
            assert_true(strlen(field->doc) > 0);
            assert_int_equal(field->doc[strlen(field->doc) - 1], '.');
            assert_int_equal(!!(field->flags & LR_DERIVED), field->derived != NULL);
        }
    }
    assert_false(lr_key_is_known("bananas"));
}

/* Finds an object of the schema whose properties are the record's keys, anywhere below node. */
static json_t *find_record(json_t *node, const lr_record *record)
{
    const char *key;
    size_t index;
    json_t *child, *found = NULL;
    json_t *properties = json_object_get(node, "properties");
    if (properties && json_object_size(properties) == record->count) {
        bool same = true;
        for (uint32_t i = 0; i < record->count; i++)
            same = same && json_object_get(properties, record->fields[i].name);
        const char *doc = json_string_value(json_object_get(node, "description"));
        /* The scene gives some records a description of their place. */
        if (same && doc)
            return node;
    }
    if (json_is_object(node))
        json_object_foreach(node, key, child) if (!found) found = find_record(child, record);
    if (json_is_array(node))
        json_array_foreach(node, index, child) if (!found) found = find_record(child, record);
    return found;
}

static void test_schema(void **state)
{
    (void)state;
    char *text = lr_scene_schema();
    assert_non_null(text);
    json_error_t error;
    json_t *root = json_loads(text, JSON_REJECT_DUPLICATES, &error);
    assert_non_null(root);
    assert_string_equal(json_string_value(json_object_get(root, "$schema")),
                        "https://json-schema.org/draft/2020-12/schema");
    const lr_record *record;
    for (uint32_t i = 0; (record = lr_record_at(i)) != NULL; i++) {
        json_t *node = find_record(root, record);
        if (!node)
            print_error("no schema of %s\n", record->name);
        assert_non_null(node);
        assert_true(json_is_false(json_object_get(node, "additionalProperties")));
        size_t required = 0;
        for (uint32_t k = 0; k < record->count; k++) {
            const lr_field *field = &record->fields[k];
            json_t *property = json_object_get(json_object_get(node, "properties"), field->name);
            assert_string_equal(json_string_value(json_object_get(property, "description")),
                                field->doc);
            required += field->flags & LR_REQUIRED ? 1 : 0;
            if (field->type == LR_FIELD_NUMBER && !(field->flags & (LR_REQUIRED | LR_DERIVED)))
                assert_near(json_number_value(json_object_get(property, "default")),
                            field->fallback[0], 0);
        }
        assert_int_equal(json_array_size(json_object_get(node, "required")), required);
    }
    json_t *objects = json_object_get(json_object_get(root, "$defs"), "object");
    for (uint32_t i = 0; i < lr_object_record_count; i++)
        assert_non_null(
            json_object_get(json_object_get(objects, "properties"), lr_object_records[i].name));
    assert_non_null(json_object_get(json_object_get(objects, "properties"), "group"));
    json_decref(root);
    free(text);
}

/* Whether some table row of the reference says the field's key, default and meaning. */
static bool is_documented(const char *docs, const lr_field *field)
{
    char start[64], fallback[LR_EXPECTED_MAX], cell[LR_EXPECTED_MAX + 8];
    snprintf(start, sizeof start, "\n| `%s` |", field->name);
    lr_field_default(field, fallback);
    snprintf(cell, sizeof cell, "| %s |", field->flags & LR_REQUIRED ? "required" : fallback);
    for (const char *at = docs; (at = strstr(at, start)) != NULL; at++) {
        size_t length = strcspn(at + 1, "\n") + 1;
        char *line = calloc(1, length + 1);
        memcpy(line, at, length);
        bool found = strstr(line, field->doc) && (!fallback[0] || strstr(line, cell));
        free(line);
        if (found)
            return true;
    }
    return false;
}

static void test_docs(void **state)
{
    (void)state;
    char *docs;
    size_t size;
    assert_int_equal(lr_file_read(SOURCE_DIR "/docs/scene.md", 1 << 20, &docs, &size, NULL), LR_OK);
    const lr_record *record;
    int missing = 0;
    for (uint32_t i = 0; (record = lr_record_at(i)) != NULL; i++)
        for (uint32_t k = 0; k < record->count; k++)
            if (!is_documented(docs, &record->fields[k])) {
                print_error("docs/scene.md: no row for %s of %s\n", record->fields[k].name,
                            record->name);
                missing++;
            }
    assert_int_equal(missing, 0);
    free(docs);
}

/* The scene in the reference is one. */
static void test_docs_example(void **state)
{
    (void)state;
    char *docs;
    size_t size;
    assert_int_equal(lr_file_read(SOURCE_DIR "/docs/scene.md", 1 << 20, &docs, &size, NULL), LR_OK);
    char *start = strstr(docs, "```yaml\n");
    assert_non_null(start);
    start += strlen("```yaml\n");
    *strstr(start, "```") = '\0';
    lr_scene *scene = parse_good(start);
    assert_int_equal(scene->object_count, 2);
    assert_int_equal(scene->material_count, 3);
    lr_scene_destroy(scene);
    free(docs);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tables),
        cmocka_unit_test(test_schema),
        cmocka_unit_test(test_docs),
        cmocka_unit_test(test_docs_example),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
