/* What follows from a camera as the scene describes it. */
#ifndef LR_SCENE_CAMERA_H
#define LR_SCENE_CAMERA_H

#include "scene/scene.h"

/* The side of a pixel of a picture of so many rows, over the distance at which it is measured:
 * where `to` is, or in perspective anywhere along the view. */
double lr_camera_pixel_size(const lr_camera *camera, double rows);

/* The distance along the view at which a lens is sharp. */
double lr_camera_focus_distance(const lr_camera *camera);

/* Lets the camera move, while its shutter is open, to where another one is. */
void lr_camera_move(lr_camera *camera, const lr_camera *closing);

/* The camera when its shutter closes. */
lr_camera lr_camera_closing(const lr_camera *camera);

/* Whether its rays are those of a pinhole. */
bool lr_camera_is_pinhole(const lr_camera *camera);

/* Whether both take the same picture; their names and lines may differ. */
bool lr_camera_same(const lr_camera *a, const lr_camera *b);

/* What is wrong with the lens or the projection and what was expected, and the key to blame; NULL
 * when nothing is. from != to. */
const char *lr_camera_flaw(const lr_camera *camera, const char **key);

/* Whether a scene can have this camera: coordinates up to LR_COORDINATE_MAX, from and to apart, up
 * not along the view, 0 < fov < 180, no flaw. */
bool lr_camera_usable(const lr_camera *camera);

#endif
