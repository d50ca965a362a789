/* Axis-aligned boxes around meshes and objects; and whether boxes, transforms and cameras lie
 * within what scenes may hold. */
#ifndef LR_SCENE_BOUNDS_H
#define LR_SCENE_BOUNDS_H

#include "scene/scene.h"

/* Empty when min.x > max.x. */
typedef struct lr_bounds {
    lr_vec3 min, max;
} lr_bounds;

lr_bounds lr_bounds_empty(void);
void lr_bounds_add_point(lr_bounds *bounds, lr_vec3 point);
void lr_bounds_add(lr_bounds *bounds, const lr_bounds *by);

/* Around the corners of the box after the transform. */
lr_bounds lr_bounds_transform(const lr_bounds *bounds, const lr_transform *transform);

/* Of the mesh in its own space. */
lr_bounds lr_mesh_bounds(const lr_mesh *mesh);

/* Whether an object with this mesh can be there: all of it within LR_COORDINATE_MAX. False for NaN.
 */
bool lr_bounds_usable(const lr_bounds *bounds);

/* Whether objects can have this transform: up to LR_COORDINATE_MAX, with an inverse up to 1e36. */
bool lr_transform_usable(const lr_transform *t);

#endif
