/* What the header of a PLY file says. */
#ifndef LR_SCENE_IMPORT_PLY_H
#define LR_SCENE_IMPORT_PLY_H

#include <locale.h>

#include "scene/import_internal.h"

enum { PROPERTIES_MAX = 64, ELEMENTS_MAX = 16, LINE_MAX_LENGTH = 200 };

typedef enum ply_type {
    INT8,
    UINT8,
    INT16,
    UINT16,
    INT32,
    UINT32,
    FLOAT32,
    FLOAT64,
    TYPES
} ply_type;

/* Where a number of a vertex goes. */
typedef enum slot { X, Y, Z, NX, NY, NZ, U, V, RED, GREEN, BLUE, SLOTS, OTHER = SLOTS } slot;

typedef struct property {
    bool is_list, is_corners;
    ply_type type, count_type;
    slot slot;
} property;

typedef struct element {
    char name[32];
    uint64_t count;
    property properties[PROPERTIES_MAX];
    uint32_t property_count;
} element;

typedef struct reader {
    lr_import *import;
    struct lr_ply *ply;
    size_t at;
    enum { TEXT, LITTLE, BIG } format;
    locale_t locale;
    element elements[ELEMENTS_MAX];
    uint32_t element_count;
    bool has[SLOTS];
    const char *what; /* being read, for messages */
    uint64_t row;
} reader;

/* import_ply_header.c: reads the header, of which r->at is then behind the end. */
lr_status lr_ply_read_header(reader *r);

#endif
