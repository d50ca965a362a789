/* Objects and groups, flattened: each object carries the transforms and the material that the
 * groups around it give it. */
#include "scene/bounds.h"
#include "scene/read.h"

#include <string.h>

/* What a group hands down. */
typedef struct surroundings {
    lr_transform to_world;
    bool transformed, moves;
    uint32_t material; /* UINT32_MAX: none */
} surroundings;

static void read_list(lr_reader *reader, const lr_node *node, const surroundings *around);

/* The transform of the object or group in the world; false after reporting that it is singular or
 * so extreme that it or its inverse overflows. */
static bool compose(lr_reader *reader, const lr_object_draft *draft, const lr_record *record,
                    const lr_given *given, const lr_node *at, const surroundings *around,
                    lr_transform *to_world, bool *transformed)
{
    const lr_node *matrix = lr_given_value(given, record, "matrix");
    bool moved = lr_given_value(given, record, "scale") ||
                 lr_given_value(given, record, "rotate") ||
                 lr_given_value(given, record, "translate");
    *transformed = around->transformed || moved || matrix;
    if (!moved && !matrix) {
        *to_world = around->to_world;
        return true;
    }
    if (moved && matrix) {
        lr_report_add(reader->report, matrix->offset,
                      "the %s has a matrix and also scale, rotate or translate, expected only one "
                      "way",
                      record->name);
        return false;
    }
    lr_transform own = lr_transform_multiply(draft->rotate, lr_transform_scale(draft->scale));
    own = lr_transform_multiply(lr_transform_translate(draft->translate), own);
    own = matrix ? draft->matrix : own;
    *to_world = lr_transform_multiply(around->to_world, own);
    bool usable = lr_transform_usable(to_world);
    if (!usable)
        lr_report_add(reader->report, at->offset,
                      "the transforms of this %s are too extreme together, expected factors and "
                      "distances up to 1e12",
                      record->name);
    return usable;
}

static void read_group(lr_reader *reader, const lr_node *key, const lr_node *value,
                       const surroundings *around)
{
    lr_object_draft draft = {0};
    lr_given given;
    const lr_record *record = &lr_group_record;
    uint32_t keyed = reader->keyed;
    bool valid = lr_read_record(reader, value, key, record, &draft, &given);
    const lr_node *material = lr_given_value(&given, record, "material");
    const lr_node *objects = lr_given_value(&given, record, "objects");
    surroundings inside = *around;
    inside.moves = around->moves || reader->keyed > keyed;
    if (material)
        inside.material = lr_read_material_use(reader, material);
    valid = valid && compose(reader, &draft, record, &given, key, around, &inside.to_world,
                             &inside.transformed);
    /* The children are read all the same, for their own errors. */
    if (!valid)
        inside = *around;
    if (!objects)
        return;
    if (reader->nesting == LR_GROUP_NESTING_MAX) {
        lr_report_add(reader->report, key->offset, "groups nest more than %d deep",
                      LR_GROUP_NESTING_MAX);
        return;
    }
    reader->nesting++;
    read_list(reader, objects, &inside);
    reader->nesting--;
}

static void add_object(lr_reader *reader, const lr_object *object, const lr_node *at)
{
    if (reader->scene->object_count == LR_OBJECTS_MAX) {
        lr_report_add(reader->report, at->offset, "more than %d objects, groups counted out",
                      LR_OBJECTS_MAX);
        reader->full = true;
        return;
    }
    lr_object *added = lr_scene_add_object(&reader->builder);
    if (!added) {
        reader->report->no_memory = true;
        reader->full = true;
        return;
    }
    *added = *object;
}

/* One object for each of the file's, in the place and, if there is one, with the material that the
 * text gives. */
static void place_mesh(lr_reader *reader, const lr_object *object, const lr_mesh_file *file,
                       const lr_node *at)
{
    for (uint32_t i = 0; i < file->count && !reader->full; i++) {
        lr_object placed = file->objects[i];
        placed.line = object->line;
        placed.shadow = object->shadow;
        placed.moves = object->moves;
        if (object->material != UINT32_MAX)
            placed.material = object->material;
        if (object->transformed) {
            placed.to_world = lr_transform_multiply(object->to_world, placed.to_world);
            placed.transformed = true;
        }
        lr_bounds bounds = lr_bounds_transform(&file->bounds[i], &placed.to_world);
        if (!lr_transform_usable(&placed.to_world) || !lr_bounds_usable(&bounds)) {
            lr_report_add(reader->report, at->offset,
                          "with its transforms the model reaches beyond 1e12 metres or is "
                          "flattened, expected it nearer");
            return;
        }
        add_object(reader, &placed, at);
    }
}

static void read_object(lr_reader *reader, const lr_record *record, const lr_node *key,
                        const lr_node *value, const surroundings *around)
{
    lr_object_draft draft = {0};
    lr_given given;
    uint32_t keyed = reader->keyed;
    bool valid = lr_read_record(reader, value, key, record, &draft, &given);
    lr_object *object = &draft.object;
    object->kind = (lr_object_kind)record->kind;
    object->moves = around->moves || reader->keyed > keyed;
    object->line = key->line;
    const lr_node *material = lr_given_value(&given, record, "material");
    object->material = material ? lr_read_material_use(reader, material) : around->material;
    if (!material && object->material == UINT32_MAX && object->kind != LR_MESH)
        object->material = lr_default_material(reader);
    if (object->kind == LR_CYLINDER)
        object->cone.radius_to = object->cone.radius_from;
    /* Shapes are checked only when all their numbers are known. */
    if (!valid || !lr_check_shape(reader, object, record, &given, key) ||
        !compose(reader, &draft, record, &given, key, around, &object->to_world,
                 &object->transformed) ||
        !lr_check_extent(reader, object, key))
        return;
    if (object->kind != LR_MESH) {
        add_object(reader, object, key);
        return;
    }
    const lr_mesh_file *file = lr_read_mesh_file(reader, lr_given_value(&given, record, "file"));
    if (file)
        place_mesh(reader, object, file, key);
}

static void read_list(lr_reader *reader, const lr_node *node, const surroundings *around)
{
    if (node->kind != LR_NODE_LIST || node->count == 0) {
        lr_report_type(reader, node, "objects",
                       node->kind == LR_NODE_MAP
                           ? "a list: begin each object with a dash, `- sphere: {...}`"
                           : "a list of objects such as `- sphere: {radius: 1}`");
        return;
    }
    for (uint32_t i = 0; i < node->count && !reader->full; i++) {
        const lr_node *key, *value;
        const lr_record *record =
            lr_read_kind(reader, node->items[i], "object", lr_object_records,
                         lr_object_record_count, &lr_group_record, &key, &value);
        if (record == &lr_group_record)
            read_group(reader, key, value, around);
        else if (record)
            read_object(reader, record, key, value, around);
    }
}

void lr_read_objects(lr_reader *reader, const lr_node *node)
{
    surroundings world = {.to_world = lr_transform_identity(), .material = UINT32_MAX};
    read_list(reader, node, &world);
}
