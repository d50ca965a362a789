/* How a hand moves a camera: arithmetic alone, no window. Every function takes a camera and returns
 * the moved one; where a scene could not have that (lr_camera_usable), it returns the one that it
 * was given. `up` never changes, so the picture stays upright, and the view keeps off the poles of
 * `up`. The focus is `to`: the focus plane goes through it, across the view. Names are passed on,
 * not copied. */
#ifndef LR_PREVIEW_CAMERA_CONTROL_H
#define LR_PREVIEW_CAMERA_CONTROL_H

#include "scene/scene.h"

/* Pixels. Points of a screen have (0, 0) at its top left corner and y pointing down, so that the
 * first pixel's centre is (0.5, 0.5). */
typedef struct lr_screen {
    uint32_t width, height;
} lr_screen;

/* The point of the focus plane that is seen at (x, y). */
lr_vec3 lr_camera_point(const lr_camera *camera, lr_screen screen, double x, double y);

/* Where the line from a to b is seen: from (ends[0], ends[1]) to (ends[2], ends[3]). What is nearer
 * than a thousandth of the distance to the focus is cut off; false when nothing is left. */
bool lr_camera_project(const lr_camera *camera, lr_screen screen, lr_vec3 a, lr_vec3 b,
                       double ends[4]);

/* Moves the eye around `to`, by degrees to the right and up as seen from it. */
lr_camera lr_camera_orbit(lr_camera camera, double right, double up);

/* Moves eye and focus so that what is seen on the focus plane goes (x, y) pixels right and down. */
lr_camera lr_camera_pan(lr_camera camera, lr_screen screen, double x, double y);

/* Scales the distances of eye and focus from a point, which stays where it is seen: with
 * lr_camera_point under the cursor, with `to` in the middle. A factor below 1 goes nearer. What an
 * orthographic picture shows is scaled along. */
lr_camera lr_camera_zoom(lr_camera camera, double factor, lr_vec3 about);

/* Moves eye and focus by metres: to the right, along `up`, along the view. */
lr_camera lr_camera_fly(lr_camera camera, double right, double up, double forward);

/* Turns the view around the eye, by degrees to the right and up. */
lr_camera lr_camera_look(lr_camera camera, double right, double up);

/* Metres a second for lr_camera_fly: half of the distance to the focus, but at least 1/100 and at
 * most 1/2 of the scene's size. `size` is the length of the diagonal of its bounds; 0: unknown. */
double lr_camera_fly_speed(const lr_camera *camera, double size);

/* Makes a point in front of the eye the focus, in the middle of the picture: the eye moves sideways
 * alone, so the direction of the view stays, and what is as far away as the point stays as large. A
 * lens is sharp there, too. */
lr_camera lr_camera_focus(lr_camera camera, lr_vec3 point);

/* Sets the vertical field of view, brought into 1..170 degrees. */
lr_camera lr_camera_set_fov(lr_camera camera, double degrees);

#endif
