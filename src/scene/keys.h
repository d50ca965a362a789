/* The keys of the scene language, once: the reader, the JSON Schema, the suggestions and the test
 * of docs/scene.md all come from these tables. */
#ifndef LR_SCENE_KEYS_H
#define LR_SCENE_KEYS_H

#include "scene/report.h"
#include "scene/scene.h"

typedef enum lr_field_type {
    /* The reader stores these at `offset` of the record's struct. */
    LR_FIELD_NUMBER,  /* double */
    LR_FIELD_INTEGER, /* 32 bits; signed when minimum is negative */
    LR_FIELD_BOOLEAN, /* bool */
    LR_FIELD_CHOICE,  /* an enum: the index in `choices` */
    LR_FIELD_VECTOR,  /* lr_vec3 */
    LR_FIELD_COLOR,   /* lr_color */
    LR_FIELD_COLORS,  /* lr_color[2] */
    LR_FIELD_SCALE,   /* lr_vec3 from a number or a vector */
    LR_FIELD_ROTATE,  /* lr_transform from three angles or {axis, angle} */
    LR_FIELD_MATRIX,  /* lr_transform from its rows */
    LR_FIELD_TEXT,    /* const char *, which lives as long as the tree of nodes */
    /* The rest is structure, which the record's own reader takes from its node. */
    LR_FIELD_RECORD,     /* a mapping as `record` says */
    LR_FIELD_PAINT,      /* a colour or a pattern */
    LR_FIELD_MAP,        /* a file, or a mapping as `record` says */
    LR_FIELD_BACKGROUND, /* a colour or a record of backgrounds */
    LR_FIELD_MATERIAL,   /* a name or a mapping */
    LR_FIELD_MATERIALS,  /* name: material, ... */
    LR_FIELD_CAMERAS,    /* name: camera, ... */
    LR_FIELD_LIGHTS,
    LR_FIELD_OBJECTS,
    LR_FIELD_TEXTS,   /* a list of texts */
    LR_FIELD_MAPPING, /* any other mapping, such as of names */
} lr_field_type;

enum {
    LR_REQUIRED = 1,
    LR_ABOVE = 2,   /* minimum itself is out of range */
    LR_BELOW = 4,   /* maximum itself is out of range */
    LR_NONZERO = 8, /* a direction or a scale: not the zero vector; no scale factor zero */
    LR_DERIVED = 16 /* the default depends on other keys; `derived` describes it */
};

typedef struct lr_record lr_record;

typedef struct lr_field {
    const char *name;
    lr_field_type type;
    unsigned flags;
    double minimum, maximum; /* of each component */
    double fallback[6];      /* the default; a boolean's and choice's is an integer */
    const char *derived;     /* of a text: what is expected, "a text" when NULL */
    const char *doc;
    size_t offset;
    const lr_record *record;
    const char *const *choices; /* ends with NULL */
} lr_field;

#define LR_FIELDS_MAX 64

struct lr_record {
    const char *name; /* as messages call it */
    const char *doc;
    const lr_field *fields;
    uint32_t count; /* <= LR_FIELDS_MAX */
    int kind;       /* lr_object_kind, lr_light_kind, lr_pattern_kind, lr_map_kind or
                          lr_background_kind */
};

/* What the records of objects, lights, patterns, maps and backgrounds are read into before they are
 * completed. */
typedef struct lr_object_draft {
    lr_object object;
    lr_vec3 translate, scale;
    lr_transform rotate, matrix;
    const char *file; /* mesh */
} lr_object_draft;

typedef struct lr_light_draft {
    lr_light light;
    lr_vec3 to;
} lr_light_draft;

typedef struct lr_pattern_draft {
    lr_pattern pattern;
    lr_vec3 to;
    uint32_t space;    /* 0 world, 1 object */
    const char *image; /* as written */
    uint32_t wrap;     /* lr_wrap */
} lr_pattern_draft;

typedef struct lr_map_draft {
    lr_map map;
    const char *image; /* as written */
    uint32_t wrap;     /* lr_wrap */
} lr_map_draft;

typedef struct lr_background_draft {
    lr_background background;
    const char *image; /* as written */
} lr_background_draft;

typedef struct lr_rotation_draft {
    lr_vec3 axis;
    double angle;
} lr_rotation_draft;

typedef struct lr_scene_draft {
    lr_scene scene; /* only what the top level stores by itself */
    lr_vec3 up;
    double version;
} lr_scene_draft;

extern const lr_record lr_scene_record, lr_camera_record, lr_image_record, lr_fog_record,
    lr_air_record, lr_material_record, lr_rotation_record, lr_group_record;
/* Of maps: the same order as lr_map_kind, which is also that of these keys of a material. */
extern const lr_record lr_map_records[LR_MAP_COUNT];
extern const lr_record lr_background_records[], lr_pattern_records[], lr_light_records[],
    lr_object_records[];
extern const uint32_t lr_background_record_count, lr_pattern_record_count, lr_light_record_count,
    lr_object_record_count;

/* All records in the order of the documentation, NULL behind the last. */
const lr_record *lr_record_at(uint32_t index);

/* The field's place in the record; the name must be one of its fields. */
uint32_t lr_field_index(const lr_record *record, const char *name);
const lr_field *lr_field_find(const lr_record *record, const char *name, size_t length);
bool lr_key_is_known(const char *name);

/* What the field expects, such as "a number from 0 to 1". Returns buffer. */
#define LR_EXPECTED_MAX 256
const char *lr_field_expected(const lr_field *field, char buffer[LR_EXPECTED_MAX]);

/* The number in ten digits, with 1e12 for 1e+12. Returns buffer. */
const char *lr_show_number(double value, char buffer[32]);

/* The default as the language writes it, such as "[0, 1, 0]"; "" when there is none. */
const char *lr_field_default(const lr_field *field, char buffer[LR_EXPECTED_MAX]);

/* Where, on the line from offset on, a comment looks like an unquoted colour (#rgb, #rrggbb):
 * the offset of the #, or SIZE_MAX. */
size_t lr_hex_comment(const lr_report *report, size_t offset, size_t *digits);

#endif
