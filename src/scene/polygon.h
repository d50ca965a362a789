/* Polygons into triangles. */
#ifndef LR_SCENE_POLYGON_H
#define LR_SCENE_POLYGON_H

#include "base/vec.h"

#include <stdint.h>

#define LR_POLYGON_CORNERS_MAX 10000 /* the work grows with the square of the number */

typedef enum lr_polygon_result {
    LR_POLYGON_GOOD,
    LR_POLYGON_CROSSING,  /* it crosses itself: the triangles may overlap or leave gaps */
    LR_POLYGON_FLATTENED, /* no area to speak of: no triangles */
} lr_polygon_result;

/* One polygon at a time. The caller puts the corners in, 3 to LR_POLYGON_CORNERS_MAX,
 * counter-clockwise as seen from the front, |coordinates| <= LR_COORDINATE_MAX. */
typedef struct lr_polygon {
    lr_vec3 corners[LR_POLYGON_CORNERS_MAX];
    uint32_t count;
    lr_vec3 normal;                                /* out: of unit length, towards the front */
    uint32_t triangles[LR_POLYGON_CORNERS_MAX][3]; /* out: indices of corners, counter-clockwise */
    uint32_t triangle_count;                       /* out: at most count - 2 */
    /* Working memory: the corners in the plane, the ring of those that are left. */
    double plane[LR_POLYGON_CORNERS_MAX][2];
    uint32_t next[LR_POLYGON_CORNERS_MAX], previous[LR_POLYGON_CORNERS_MAX];
    bool reflex[LR_POLYGON_CORNERS_MAX], ear[LR_POLYGON_CORNERS_MAX];
} lr_polygon;

/* Cuts the polygon, which may be concave, into triangles by clipping its ears (Meisters, "Polygons
 * have ears", 1975): always the first ear behind the first corner, so a convex polygon becomes a
 * fan around corners[0]. Corners on a straight line take part in no triangle when cutting them off
 * leaves nothing. Everything is + - * / and sqrt of doubles in a fixed order: the same everywhere.
 *
 * A polygon is flattened when its area is at most 1e-12 times the square of its size. */
lr_polygon_result lr_polygon_triangulate(lr_polygon *polygon);

#endif
