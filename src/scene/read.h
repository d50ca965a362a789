/* From the tree of nodes to the scene: what the parts of the reader share. Functions named read
 * return false after reporting at least one error; the value is then unchanged or the default. */
#ifndef LR_SCENE_READ_H
#define LR_SCENE_READ_H

#include "scene/bounds.h"
#include "scene/build.h"
#include "scene/keys.h"
#include "scene/names.h"
#include "scene/node.h"

#include <locale.h>

/* A file of meshes that the text names, read once: its objects, which stand in no scene yet. */
typedef struct lr_mesh_file {
    char *name;
    lr_object *objects;
    lr_bounds *bounds; /* of each object's mesh, in its own space */
    uint32_t count;
    uint32_t first_material, end_material; /* those that came with it */
} lr_mesh_file;

typedef struct lr_mesh_files {
    lr_mesh_file *items;
    uint32_t count, capacity;
} lr_mesh_files;

/* A mix of materials whose parts are still to be found. */
typedef struct lr_mix {
    uint32_t material;
    const lr_node *at, *first, *second; /* NULL: not given */
} lr_mix;

typedef struct lr_mixes {
    lr_mix *items;
    uint32_t count, capacity;
    bool open; /* parts are being read: what they add is completed with the rest */
} lr_mixes;

typedef struct lr_reader {
    lr_report *report;
    lr_scene *scene;
    lr_scene_builder builder; /* of that scene */
    lr_load_options options;  /* for the files that the text names */
    lr_mesh_files files;      /* read so far */
    locale_t locale;          /* "C", whatever the program chose */
    lr_names materials;       /* names to indices of scene->materials */
    lr_mixes mixes;
    uint32_t default_material; /* UINT32_MAX until an object needs it */
    uint32_t nesting;          /* of groups */
    uint32_t keyed;            /* values with keys that change, so far */
    bool beside_motion;        /* what is being read moves nothing in the picture */
    bool moment;               /* the scene is a moment of another: cameras stand still */
    bool full;                 /* too many objects or materials: reported, reading has stopped */
} lr_reader;

#define LR_GROUP_NESTING_MAX 32

/* "a list", "the text "abc"", ... for messages. Returns buffer. */
const char *lr_node_describe(const lr_node *node, char buffer[LR_SHOWN_MAX + 32]);

/* Reports `what` as wrong at the node: "radius is a list, expected a number ...". An empty value
 * and the common slips of YAML get messages of their own. */
void lr_report_type(lr_reader *reader, const lr_node *node, const char *what, const char *expected);

/* Reports a name that is not one of those offered to the search. */
void lr_report_unknown(lr_reader *reader, const lr_node *node, const char *message,
                       const lr_nearest *nearest);

/* Reads a value of one of the stored field types to `out`. */
bool lr_read_value(lr_reader *reader, const lr_node *node, const lr_field *field, void *out);

/* A finite number within the field's range. */
bool lr_read_number(lr_reader *reader, const lr_node *node, const lr_field *field, const char *what,
                    double *value);
bool lr_read_color(lr_reader *reader, const lr_node *node, const lr_field *field, const char *what,
                   lr_color *color);

/* The keys of a value that changes from frame to frame, NULL of any other. */
const lr_node *lr_keys_of(const lr_reader *reader, const lr_node *node);

/* Reads what such a value is in the reader's frame: up to three numbers that `read` reads of each
 * key, blended along straight lines; before the first key and after the last it stays. */
typedef bool lr_component_reader(lr_reader *reader, const lr_node *node, const lr_field *field,
                                 const char *what, double *value);
bool lr_read_keys(lr_reader *reader, const lr_node *keys, const lr_field *field, const char *what,
                  lr_component_reader *read, uint32_t count, double *value);

/* Two colours, reported as `what`. */
bool lr_read_colors(lr_reader *reader, const lr_node *node, const lr_field *field,
                    lr_color colors[2]);

/* What a record's mapping gave, by the index of the field; NULL: not given. */
typedef struct lr_given {
    const lr_node *values[LR_FIELDS_MAX];
    bool valid; /* every stored value was read and nothing required is missing */
} lr_given;

/* Fills the defaults into base, then reads the mapping's stored fields over them, reporting unknown
 * keys, wrong values and missing required keys (at `at`). Structural fields are left to the caller
 * in *given. False when the node is no mapping or anything was wrong. */
bool lr_read_record(lr_reader *reader, const lr_node *node, const lr_node *at,
                    const lr_record *record, void *base, lr_given *given);
void lr_record_defaults(const lr_record *record, void *base);
const lr_node *lr_given_value(const lr_given *given, const lr_record *record, const char *name);

/* Of an item such as {sphere: {...}}: the record that its key names and the value. NULL after
 * reporting. `extra` is one more record to look among, or NULL. */
const lr_record *lr_read_kind(lr_reader *reader, const lr_node *item, const char *what,
                              const lr_record *records, uint32_t count, const lr_record *extra,
                              const lr_node **key, const lr_node **value);

void lr_read_materials(lr_reader *reader, const lr_node *node);
/* The material that `node`, a name or a mapping, stands for; UINT32_MAX after reporting. */
uint32_t lr_read_material_use(lr_reader *reader, const lr_node *node);
/* Completes the mixes that have been added since the last time, when all materials have names. */
void lr_complete_mixes(lr_reader *reader);
/* The material of objects that name none; UINT32_MAX when memory is out. */
uint32_t lr_default_material(lr_reader *reader);

/* The texture of the file that `node`, the text `file`, names. */
bool lr_read_picture(lr_reader *reader, const lr_node *node, const char *file, lr_wrap wrap_u,
                     lr_wrap wrap_v, lr_texels texels, uint32_t *texture);

void lr_read_background(lr_reader *reader, const lr_node *node, const lr_field *field);
void lr_read_lights(lr_reader *reader, const lr_node *node);
void lr_read_objects(lr_reader *reader, const lr_node *node);

/* The path of a file that the text names: lr_path_resolve, but that the files of a moment, which have all
 * been read, may be gone since. */
lr_status lr_read_path(lr_reader *reader, const char *name, char **path, lr_error *error);

/* The objects of the mesh file that `file` names; NULL after reporting. */
const lr_mesh_file *lr_read_mesh_file(lr_reader *reader, const lr_node *file);
void lr_mesh_files_free(lr_mesh_files *files);

/* Drops the materials of mesh files that no object has, since the text gives them others. */
void lr_drop_unused_materials(lr_reader *reader);

/* Checks of shapes, at the best node; false after reporting. */
bool lr_check_shape(lr_reader *reader, const lr_object *object, const lr_record *record,
                    const lr_given *given, const lr_node *at);
bool lr_check_extent(lr_reader *reader, const lr_object *object, const lr_node *at);
/* Whether b is zero or along a, to within a millionth of a radian. */
bool lr_parallel(lr_vec3 a, lr_vec3 b);

extern const lr_language lr_scene_language;

/* Runs one of the functions below on the tree's root; what is wrong goes to the report. */
void lr_read_tree(const lr_tree *tree, lr_scene *scene, lr_report *report,
                  const lr_load_options *options,
                  void (*read)(lr_reader *reader, const lr_node *root));
void lr_read_scene(lr_reader *reader, const lr_node *root);
void lr_read_cameras(lr_reader *reader, const lr_node *root); /* and nothing else */

#endif
