#include "scene/camera.h"

#include "scene/bounds.h"
#include "scene/read.h"

/* The ray directions that the kernels compute stay within their range. */
#define APERTURE_PER_FOCUS 1000

static double view_length(const lr_camera *camera)
{
    return lr_vec3_length(lr_vec3_sub(camera->to, camera->from));
}

double lr_camera_pixel_size(const lr_camera *camera, double rows)
{
    double sine, cosine;
    double steps = camera->fov_to_centers && rows > 1 ? rows - 1 : rows;
    if (camera->projection == LR_ORTHOGRAPHIC && camera->height > 0)
        return camera->height / steps / view_length(camera);
    lr_sincos_degrees(camera->fov / 2, &sine, &cosine);
    return 2 * sine / cosine / steps;
}

double lr_camera_focus_distance(const lr_camera *camera)
{
    return camera->focus > 0 ? camera->focus : view_length(camera);
}

bool lr_camera_is_pinhole(const lr_camera *camera)
{
    return camera->projection == LR_PERSPECTIVE && camera->aperture == 0 && !camera->moves;
}

static bool same_vector(lr_vec3 a, lr_vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

static bool same_pose(const lr_camera *a, const lr_camera *b)
{
    return same_vector(a->from, b->from) && same_vector(a->to, b->to) &&
           same_vector(a->up, b->up) && a->fov == b->fov && a->height == b->height;
}

bool lr_camera_same(const lr_camera *a, const lr_camera *b)
{
    lr_camera a_closing = lr_camera_closing(a), b_closing = lr_camera_closing(b);
    return same_pose(a, b) && same_pose(&a_closing, &b_closing) &&
           a->fov_to_centers == b->fov_to_centers && a->projection == b->projection &&
           a->aperture == b->aperture && a->focus == b->focus && a->blades == b->blades &&
           a->blade_rotation == b->blade_rotation;
}

void lr_camera_move(lr_camera *camera, const lr_camera *closing)
{
    camera->moves = !same_pose(camera, closing);
    camera->closing.from = closing->from;
    camera->closing.to = closing->to;
    camera->closing.up = closing->up;
    camera->closing.fov = closing->fov;
    camera->closing.height = closing->height;
}

lr_camera lr_camera_closing(const lr_camera *camera)
{
    lr_camera closing = *camera;
    if (camera->moves) {
        closing.from = camera->closing.from;
        closing.to = camera->closing.to;
        closing.up = camera->closing.up;
        closing.fov = camera->closing.fov;
        closing.height = camera->closing.height;
    }
    return closing;
}

const char *lr_camera_flaw(const lr_camera *camera, const char **key)
{
    bool lens = camera->aperture > 0;
    *key = "aperture";
    if (lens && camera->projection != LR_PERSPECTIVE)
        return "only perspective cameras have an aperture, expected 0";
    if (lens && camera->aperture < LR_LENGTH_MIN)
        return "expected 0 or at least 1e-20";
    if (lens && camera->aperture > APERTURE_PER_FOCUS * lr_camera_focus_distance(camera))
        return "expected at most 1000 times the distance that is in focus";
    *key = "height";
    if (camera->height > 0 && camera->height < LR_LENGTH_MIN)
        return "expected 0 or at least 1e-20";
    *key = "blades";
    if (camera->blades == 1 || camera->blades == 2)
        return "a polygon has 3 corners or more, expected 3 to 32, or 0 for a circle";
    return NULL;
}

bool lr_camera_usable(const lr_camera *camera)
{
    const char *key;
    lr_bounds bounds = lr_bounds_empty();
    lr_bounds_add_point(&bounds, camera->from);
    lr_bounds_add_point(&bounds, camera->to);
    lr_bounds_add_point(&bounds, camera->up);
    lr_vec3 view = lr_vec3_sub(camera->to, camera->from);
    /* Bounds leave NaN out, lengths and lr_parallel do not. */
    return lr_bounds_usable(&bounds) && lr_vec3_length(view) >= LR_LENGTH_MIN &&
           !lr_parallel(view, camera->up) && camera->fov > 0 && camera->fov < 180 &&
           camera->height >= 0 && camera->height <= LR_COORDINATE_MAX &&
           !lr_camera_flaw(camera, &key);
}
