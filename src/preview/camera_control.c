#include "preview/camera_control.h"

#include <math.h>

#include "scene/camera.h"

#define DEGREES 57.295779513082321 /* in a radian */

/* Between the view and the plane across `up`: closer to the pole the picture would spin. */
#define ELEVATION_MAX 89.9

#define FOV_MIN 1.0
#define FOV_MAX 170.0

/* What is nearer, as a share of the distance to the focus, is not drawn. */
#define NEAR_SHARE 1e-3

/* Pixels: what lies farther aside is drawn there, which drawing libraries can still count in. */
#define SCREEN_MAX 1e6

/* From the eye to the focus, over the greatest coordinate: what doubles still resolve well. */
#define NEAREST 1e-9

static double clamp(double value, double low, double high)
{
    return value < low ? low : value > high ? high : value;
}

/* In a hand, a camera stands still while its shutter is open. */
static lr_camera checked(lr_camera moved, lr_camera before)
{
    moved.moves = false;
    return lr_camera_usable(&moved) ? moved : before;
}

static lr_vec3 mix3(lr_vec3 a, double x, lr_vec3 b, double y)
{
    return lr_vec3_add(lr_vec3_scale(a, x), lr_vec3_scale(b, y));
}

static lr_camera shifted(lr_camera camera, lr_vec3 offset)
{
    lr_camera moved = camera;
    moved.from = lr_vec3_add(camera.from, offset);
    moved.to = lr_vec3_add(camera.to, offset);
    return checked(moved, camera);
}

/* Unit vectors of the picture, right-handed. */
typedef struct frame {
    lr_vec3 forward, right, up;
    double distance; /* to the focus */
} frame;

static frame frame_of(const lr_camera *camera)
{
    lr_vec3 view = lr_vec3_sub(camera->to, camera->from);
    frame f = {.forward = lr_vec3_normalize(view), .distance = lr_vec3_length(view)};
    f.right = lr_vec3_normalize(lr_vec3_cross(f.forward, camera->up));
    f.up = lr_vec3_cross(f.right, f.forward);
    return f;
}

static double pixel_size(const lr_camera *camera, lr_screen screen)
{
    return lr_camera_pixel_size(camera, screen.height);
}

lr_vec3 lr_camera_point(const lr_camera *camera, lr_screen screen, double x, double y)
{
    frame f = frame_of(camera);
    double size = f.distance * pixel_size(camera, screen);
    return lr_vec3_add(camera->to, mix3(f.right, (x - screen.width * 0.5) * size, f.up,
                                        (screen.height * 0.5 - y) * size));
}

bool lr_camera_project(const lr_camera *camera, lr_screen screen, lr_vec3 a, lr_vec3 b,
                       double ends[4])
{
    frame f = frame_of(camera);
    lr_vec3 forward = lr_vec3_cross(f.up, f.right);
    double nearest = f.distance * NEAR_SHARE, pixel = pixel_size(camera, screen);
    lr_vec3 from_eye[2] = {lr_vec3_sub(a, camera->from), lr_vec3_sub(b, camera->from)};
    double depth[2] = {lr_vec3_dot(from_eye[0], forward), lr_vec3_dot(from_eye[1], forward)};
    if (camera->projection == LR_PANORAMA || (depth[0] < nearest && depth[1] < nearest))
        return false;
    for (int i = 0; i < 2; i++) {
        lr_vec3 p = from_eye[i];
        double z = depth[i];
        if (z < nearest) {
            double share = (nearest - z) / (depth[1 - i] - z);
            p = mix3(p, 1 - share, from_eye[1 - i], share);
            z = nearest;
        }
        double side = pixel * (camera->projection == LR_ORTHOGRAPHIC ? f.distance : z);
        double x = screen.width * 0.5 + lr_vec3_dot(p, f.right) / side;
        double y = screen.height * 0.5 - lr_vec3_dot(p, f.up) / side;
        ends[2 * i] = clamp(x, -SCREEN_MAX, SCREEN_MAX);
        ends[2 * i + 1] = clamp(y, -SCREEN_MAX, SCREEN_MAX);
    }
    return true;
}

/* The vector turned by degrees about `up`, to its own right, and then towards `up`. */
static lr_vec3 turned(lr_vec3 vector, lr_vec3 up, double right_degrees, double up_degrees)
{
    lr_vec3 axis = lr_vec3_normalize(up), unit = lr_vec3_normalize(vector);
    lr_vec3 side = lr_vec3_normalize(lr_vec3_cross(unit, axis));
    lr_vec3 level = lr_vec3_cross(axis, side);
    double elevation = atan2(lr_vec3_dot(unit, axis), lr_vec3_dot(unit, level)) * DEGREES;
    /* A scene's camera may look closer along `up`; then only the way back is free. */
    double limit = fmax(ELEVATION_MAX, fabs(elevation));
    double sine, cosine;
    lr_sincos_degrees(right_degrees, &sine, &cosine);
    level = mix3(level, cosine, side, sine);
    lr_sincos_degrees(clamp(elevation + up_degrees, -limit, limit), &sine, &cosine);
    return lr_vec3_scale(mix3(level, cosine, axis, sine), lr_vec3_length(vector));
}

lr_camera lr_camera_orbit(lr_camera camera, double right, double up)
{
    lr_camera moved = camera;
    /* Looked at from the focus, the eye's right is left. */
    lr_vec3 offset = turned(lr_vec3_sub(camera.from, camera.to), camera.up, -right, up);
    moved.from = lr_vec3_add(camera.to, offset);
    return checked(moved, camera);
}

lr_camera lr_camera_look(lr_camera camera, double right, double up)
{
    lr_camera moved = camera;
    lr_vec3 view = turned(lr_vec3_sub(camera.to, camera.from), camera.up, right, up);
    moved.to = lr_vec3_add(camera.from, view);
    return checked(moved, camera);
}

lr_camera lr_camera_pan(lr_camera camera, lr_screen screen, double x, double y)
{
    frame f = frame_of(&camera);
    double size = f.distance * pixel_size(&camera, screen);
    return shifted(camera, mix3(f.right, -x * size, f.up, y * size));
}

static double greatest_coordinate(const lr_camera *camera)
{
    const double *from = &camera->from.x, *to = &camera->to.x;
    double greatest = 0;
    for (int i = 0; i < 3; i++)
        greatest = fmax(greatest, fmax(fabs(from[i]), fabs(to[i])));
    return greatest;
}

lr_camera lr_camera_zoom(lr_camera camera, double factor, lr_vec3 about)
{
    lr_camera moved = camera;
    moved.from = lr_vec3_add(about, lr_vec3_scale(lr_vec3_sub(camera.from, about), factor));
    moved.to = lr_vec3_add(about, lr_vec3_scale(lr_vec3_sub(camera.to, about), factor));
    moved.height *= factor;
    moved.focus *= factor;
    double distance = lr_vec3_length(lr_vec3_sub(moved.to, moved.from));
    bool too_near = factor < 1 && distance < NEAREST * greatest_coordinate(&moved);
    return factor > 0 && !too_near ? checked(moved, camera) : camera;
}

lr_camera lr_camera_fly(lr_camera camera, double right, double up, double forward)
{
    frame f = frame_of(&camera);
    lr_vec3 across = mix3(f.right, right, lr_vec3_normalize(camera.up), up);
    return shifted(camera, mix3(across, 1, f.forward, forward));
}

double lr_camera_fly_speed(const lr_camera *camera, double size)
{
    double distance = lr_vec3_length(lr_vec3_sub(camera->to, camera->from));
    return size > 0 ? clamp(distance / 2, size / 100, size / 2) : distance / 2;
}

lr_camera lr_camera_focus(lr_camera camera, lr_vec3 point)
{
    frame f = frame_of(&camera);
    double depth = lr_vec3_dot(lr_vec3_sub(point, camera.from), f.forward);
    lr_camera moved = camera;
    moved.to = point;
    moved.from = lr_vec3_sub(point, lr_vec3_scale(f.forward, depth));
    moved.focus = camera.focus > 0 ? depth : 0;
    return depth > 0 ? checked(moved, camera) : camera;
}

lr_camera lr_camera_set_fov(lr_camera camera, double degrees)
{
    lr_camera moved = camera;
    moved.fov = clamp(degrees, FOV_MIN, FOV_MAX);
    return checked(moved, camera);
}
