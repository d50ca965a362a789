/* The objects as primitives: in the world, or in a space of their own, rounded to float. */
#include "render/pack_internal.h"

#include <math.h>

/* A solid's shortest extent may be this much smaller than its longest before its own space is too
 * distorted for floats. */
#define THINNESS_MIN 1e-9

#define BALL_SLACK 0x1p-18

lr_transform lr_pack_inverse(const lr_transform *t)
{
    lr_transform inverse = lr_transform_identity();
    lr_transform_inverse(t, &inverse); /* the reader refuses singular ones */
    return inverse;
}

/* Whether t keeps spheres spheres; *scale is by how much it scales them. */
static bool is_similarity(const lr_transform *t, double *scale)
{
    lr_vec3 columns[3];
    for (int i = 0; i < 3; i++)
        columns[i] = (lr_vec3){t->m[0][i], t->m[1][i], t->m[2][i]};
    double length = lr_vec3_length(columns[0]), tolerance = 1e-12 * length * length;
    for (int i = 0; i < 3; i++) {
        if (fabs(lr_vec3_dot(columns[i], columns[i]) - length * length) > tolerance)
            return false;
        if (fabs(lr_vec3_dot(columns[i], columns[(i + 1) % 3])) > tolerance)
            return false;
    }
    *scale = length;
    return true;
}

/* The map into a frame at `origin` whose coordinate i is axes[i] . (p - origin). */
static lr_transform into_frame(lr_vec3 origin, const lr_vec3 axes[3])
{
    lr_transform t;
    for (int i = 0; i < 3; i++) {
        t.m[i][0] = axes[i].x;
        t.m[i][1] = axes[i].y;
        t.m[i][2] = axes[i].z;
        t.m[i][3] = -lr_vec3_dot(axes[i], origin);
    }
    return t;
}

vec4 lr_pack_row(const double row[4], double scale)
{
    return (vec4){(float)(row[0] * scale), (float)(row[1] * scale), (float)(row[2] * scale),
                  (float)(row[3] * scale)};
}

static vec4 pack_ball(lr_vec3 center, double radius)
{
    double slack = BALL_SLACK * (radius + lr_vec3_length(center)) + 1e-15;
    vec3 c = lr_pack_vec3(center);
    return (vec4){c.x, c.y, c.z, (float)((radius + slack) * (radius + slack))};
}

/* Kernels allow for the rounding of boxes. */
static lr_bvh_box pack_box_around(const lr_vec3 *points, unsigned count)
{
    lr_vec3 low = points[0], high = points[0];
    for (unsigned i = 1; i < count; i++) {
        low =
            (lr_vec3){fmin(low.x, points[i].x), fmin(low.y, points[i].y), fmin(low.z, points[i].z)};
        high = (lr_vec3){fmax(high.x, points[i].x), fmax(high.y, points[i].y),
                         fmax(high.z, points[i].z)};
    }
    return (lr_bvh_box){{(float)low.x, (float)low.y, (float)low.z},
                        {(float)high.x, (float)high.y, (float)high.z}};
}

/* A ball around points, with some room for the rounding of kernels whose rays may start as far off
 * as the ball's own centre is from the world's. */
static vec4 ball_around(const lr_vec3 *points, unsigned count)
{
    lr_vec3 center = {0, 0, 0};
    for (unsigned i = 0; i < count; i++)
        center = lr_vec3_add(center, lr_vec3_scale(points[i], 1.0 / count));
    double radius = 0;
    for (unsigned i = 0; i < count; i++)
        radius = fmax(radius, lr_vec3_length(lr_vec3_sub(points[i], center)));
    return pack_ball(center, radius);
}

/* A solid whose own space is reached from object space by `canonical`. False when it is too thin.
 */
static bool pack_solid(const lr_object *object, lr_transform canonical, lr_list_kind list,
                       lr_primitive *out)
{
    lr_transform inverse = lr_pack_inverse(&object->to_world);
    lr_transform t = lr_transform_multiply(canonical, inverse);
    double longest = 0, shortest = INFINITY;
    for (int i = 0; i < 3; i++) {
        double length = lr_vec3_length((lr_vec3){t.m[i][0], t.m[i][1], t.m[i][2]});
        longest = fmax(longest, length);
        shortest = fmin(shortest, length);
    }
    if (!(shortest >= longest * THINNESS_MIN))
        return false;
    double scale = 1 / longest;
    out->list = list;
    out->encloses = true;
    out->record.solid = (struct gpu_solid){
        .row0 = lr_pack_row(t.m[0], scale),
        .row1 = lr_pack_row(t.m[1], scale),
        .row2 = lr_pack_row(t.m[2], scale),
        .scale = (float)scale,
        .inv_scale = (float)longest,
    };
    lr_transform back;
    lr_transform_inverse(&t, &back);
    lr_vec3 corners[8];
    for (int i = 0; i < 8; i++)
        corners[i] = lr_transform_point(&back, (lr_vec3){i & 1 ? 1 : -1, i & 2 ? 1 : -1,
                                                         i & 4 ? 1 : (list == LR_CONES ? 0 : -1)});
    out->ball = ball_around(corners, 8);
    out->box = pack_box_around(corners, 8);
    return true;
}

static bool pack_sphere(const lr_object *object, lr_primitive *out)
{
    double radius = object->sphere.radius, scale;
    if (!is_similarity(&object->to_world, &scale)) {
        double k = 1 / radius;
        lr_vec3 axes[3] = {{k, 0, 0}, {0, k, 0}, {0, 0, k}};
        return pack_solid(object, into_frame(object->sphere.center, axes), LR_ELLIPSOIDS, out);
    }
    radius *= scale;
    lr_vec3 center = lr_transform_point(&object->to_world, object->sphere.center);
    out->list = LR_SPHERES;
    out->encloses = true;
    out->record.sphere = (struct gpu_sphere){
        .center = lr_pack_vec3(center), .inv_radius = (float)(1 / radius), .radius = (float)radius};
    out->ball = pack_ball(center, radius);
    lr_vec3 reach = {radius, radius, radius};
    lr_vec3 corners[2] = {lr_vec3_sub(center, reach), lr_vec3_add(center, reach)};
    out->box = pack_box_around(corners, 2);
    return true;
}

static bool pack_plane(const lr_object *object, lr_primitive *out)
{
    lr_transform inverse = lr_pack_inverse(&object->to_world);
    double length2 = lr_vec3_dot(object->plane.normal, object->plane.normal);
    lr_vec3 point = lr_vec3_scale(object->plane.normal, object->plane.offset / length2);
    point = lr_transform_point(&object->to_world, point);
    lr_vec3 n = lr_vec3_normalize(lr_transform_normal(&inverse, object->plane.normal));
    out->list = LR_PLANES;
    out->encloses = true;
    out->record.plane =
        (struct gpu_plane){.normal = lr_pack_vec3(n), .offset = (float)lr_vec3_dot(n, point)};
    return true;
}

/* The piece of plane origin + a e1 + b e2 with the coordinates (a, b) that `shape` allows. */
static bool pack_flat(const lr_object *object, lr_vec3 origin, lr_vec3 e1, lr_vec3 e2,
                      uint32_t shape, lr_primitive *out)
{
    origin = lr_transform_point(&object->to_world, origin);
    e1 = lr_transform_vector(&object->to_world, e1);
    e2 = lr_transform_vector(&object->to_world, e2);
    lr_vec3 normal = lr_vec3_cross(e1, e2);
    double k = 1 / lr_vec3_dot(normal, normal);
    /* The basis dual to e1, e2 within the plane. */
    lr_vec3 u = lr_vec3_scale(lr_vec3_cross(e2, normal), k);
    lr_vec3 v = lr_vec3_scale(lr_vec3_cross(normal, e1), k);
    lr_vec3 n = lr_vec3_normalize(normal);
    out->list = LR_FLATS;
    out->encloses = false;
    out->sided = true;
    out->record.flat = (struct gpu_flat){
        .normal = lr_pack_vec3(n),
        .offset = (float)lr_vec3_dot(n, origin),
        .u = lr_pack_vec3(u),
        .u_offset = (float)-lr_vec3_dot(u, origin),
        .v = lr_pack_vec3(v),
        .v_offset = (float)-lr_vec3_dot(v, origin),
        .flags = shape,
    };
    lr_vec3 e3 = lr_vec3_add(e1, e2), e4 = lr_vec3_sub(e1, e2);
    if (shape == LR_FLAG_TRIANGLE) {
        lr_vec3 corners[] = {origin, lr_vec3_add(origin, e1), lr_vec3_add(origin, e2)};
        out->ball = ball_around(corners, 3);
        out->box = pack_box_around(corners, 3);
    } else {
        lr_vec3 corners[] = {lr_vec3_add(origin, e3), lr_vec3_sub(origin, e3),
                             lr_vec3_add(origin, e4), lr_vec3_sub(origin, e4)};
        out->ball = ball_around(corners, 4);
        out->box = pack_box_around(corners, 4);
    }
    return isfinite(k);
}

static bool pack_disk(const lr_object *object, lr_primitive *out)
{
    lr_vec3 u, v;
    lr_vec3_frame(lr_vec3_normalize(object->disk.normal), &u, &v);
    return pack_flat(object, object->disk.center, lr_vec3_scale(u, object->disk.radius),
                     lr_vec3_scale(v, object->disk.radius), LR_FLAG_DISK, out);
}

static bool pack_rectangle(const lr_object *object, lr_primitive *out)
{
    lr_vec3 u = lr_vec3_scale(object->rectangle.u, 0.5);
    lr_vec3 v = lr_vec3_scale(object->rectangle.v, 0.5);
    lr_vec3 center = lr_vec3_add(object->rectangle.corner, lr_vec3_add(u, v));
    return pack_flat(object, center, u, v, 0, out);
}

static bool pack_triangle(const lr_object *object, lr_primitive *out)
{
    lr_vec3 a = object->triangle.a;
    return pack_flat(object, a, lr_vec3_sub(object->triangle.b, a),
                     lr_vec3_sub(object->triangle.c, a), LR_FLAG_TRIANGLE, out);
}

static bool pack_box(const lr_object *object, lr_primitive *out)
{
    lr_vec3 half = lr_vec3_scale(lr_vec3_sub(object->box.max, object->box.min), 0.5);
    lr_vec3 center = lr_vec3_add(object->box.min, half);
    lr_vec3 axes[3] = {{1 / half.x, 0, 0}, {0, 1 / half.y, 0}, {0, 0, 1 / half.z}};
    return pack_solid(object, into_frame(center, axes), LR_BOXES, out);
}

static bool pack_cone(const lr_object *object, lr_primitive *out)
{
    lr_vec3 axis = lr_vec3_sub(object->cone.to, object->cone.from);
    double length = lr_vec3_length(axis);
    double radius = fmax(object->cone.radius_from, object->cone.radius_to);
    lr_vec3 w = lr_vec3_normalize(axis), u, v;
    lr_vec3_frame(w, &u, &v);
    lr_vec3 axes[3] = {lr_vec3_scale(u, 1 / radius), lr_vec3_scale(v, 1 / radius),
                       lr_vec3_scale(w, 1 / length)};
    if (!pack_solid(object, into_frame(object->cone.from, axes), LR_CONES, out))
        return false;
    out->encloses = !object->open;
    out->sided = object->open;
    out->record.solid.radius_from = (float)(object->cone.radius_from / radius);
    out->record.solid.radius_slope =
        (float)((object->cone.radius_to - object->cone.radius_from) / radius);
    out->record.solid.flags = object->open ? LR_FLAG_OPEN : 0;
    return true;
}

bool lr_pack_shape(const lr_scene *scene, const lr_object *object, lr_primitive *out)
{
    switch (object->kind) {
    case LR_SPHERE:
        return pack_sphere(object, out);
    case LR_PLANE:
        return pack_plane(object, out);
    case LR_BOX:
        return pack_box(object, out);
    case LR_DISK:
        return pack_disk(object, out);
    case LR_RECTANGLE:
        return pack_rectangle(object, out);
    case LR_CYLINDER:
    case LR_CONE:
        return pack_cone(object, out);
    case LR_TRIANGLE:
        return pack_triangle(object, out);
    case LR_MESH:
        out->list = LR_MESHES;
        out->encloses = scene->meshes[object->mesh].closed;
        out->sided = true;
        return true;
    }
    return false;
}

bool lr_pack_contains(const lr_object *object, lr_vec3 point)
{
    lr_transform inverse = lr_pack_inverse(&object->to_world);
    lr_vec3 p = lr_transform_point(&inverse, point);
    switch (object->kind) {
    case LR_SPHERE:
        return lr_vec3_length(lr_vec3_sub(p, object->sphere.center)) < object->sphere.radius;
    case LR_PLANE:
        return lr_vec3_dot(object->plane.normal, p) < object->plane.offset;
    case LR_BOX:
        return p.x > object->box.min.x && p.y > object->box.min.y && p.z > object->box.min.z &&
               p.x < object->box.max.x && p.y < object->box.max.y && p.z < object->box.max.z;
    case LR_CYLINDER:
    case LR_CONE: {
        lr_vec3 axis = lr_vec3_sub(object->cone.to, object->cone.from);
        lr_vec3 w = lr_vec3_normalize(axis), from = lr_vec3_sub(p, object->cone.from);
        double along = lr_vec3_dot(from, w), z = along / lr_vec3_length(axis);
        double across = lr_vec3_length(lr_vec3_sub(from, lr_vec3_scale(w, along)));
        return z > 0 && z < 1 &&
               across < object->cone.radius_from * (1 - z) + object->cone.radius_to * z;
    }
    default:
        return false;
    }
}
