/* The polygons of an NFF text, gathered into meshes. */
#ifndef LR_SCENE_NFF_MESH_H
#define LR_SCENE_NFF_MESH_H

#include "scene/build.h"
#include "scene/polygon.h"
#include "scene/rows.h"

/* What does not go into the scene as it is written: how often, and where for the first time. */
typedef struct lr_nff_count {
    uint32_t count, line;
} lr_nff_count;

void lr_nff_add_count(lr_nff_count *count, uint32_t line);

typedef struct lr_nff_triangle {
    uint32_t vertices[3];
} lr_nff_triangle;

/* The polygons or the patches of one material. */
typedef struct lr_nff_part {
    lr_rows vertices; /* floats: a position, and of patches a unit normal behind it */
    lr_nff_triangle *triangles;
    uint32_t triangle_count, triangle_capacity;
    uint32_t line; /* of the first polygon */
} lr_nff_part;

typedef struct lr_nff_parts {
    lr_nff_part *items; /* two a material: polygons, patches */
    uint32_t count, capacity;
    lr_polygon *polygon;                                /* the one being read */
    lr_vec3 (*normals)[LR_POLYGON_CORNERS_MAX];         /* of the patch being read */
    lr_nff_count flattened, crossing, turned, vanished; /* for notes */
} lr_nff_parts;

/* False when memory is out; free all the same. */
bool lr_nff_parts_init(lr_nff_parts *parts);
void lr_nff_parts_free(lr_nff_parts *parts);

/* Adds parts->polygon, a patch with parts->normals or not, to the material's. False when memory is
 * out. */
bool lr_nff_add_polygon(lr_nff_parts *parts, uint32_t material, bool patch, uint32_t line);

/* Makes each part a mesh of the scene and an object that shows it. False when memory is out. */
bool lr_nff_add_meshes(lr_nff_parts *parts, lr_scene_builder *builder);

#endif
