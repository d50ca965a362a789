#include <math.h>
#include <stdlib.h>

#include "base/exact.h"
#include "base/memory.h"
#include "render/pack.h"

#define LOG2_E 1.4426950408889634

/* A solid's shortest extent may be this much smaller than its longest before its own space is too
 * distorted for floats. */
#define THINNESS_MIN 1e-9

#define BALL_SLACK 0x1p-18

/* In the order of the primitives' numbers; LR_SPEC_SPHERES + kind tells whether there are any. */
typedef enum list_kind { SPHERES, FLATS, ELLIPSOIDS, BOXES, CONES, PLANES, LIST_COUNT } list_kind;

typedef union primitive_record {
    struct gpu_sphere sphere;
    struct gpu_plane plane;
    struct gpu_flat flat;
    struct gpu_solid solid;
} primitive_record;

typedef struct primitive {
    primitive_record record;
    list_kind list;
    bool encloses; /* a medium, if its material transmits */
    vec4 ball;     /* holds it, if it is bounded: centre, radius squared */
} primitive;

static lr_transform inverse_of(const lr_transform *t)
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

static vec4 pack_row(const double row[4], double scale)
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
static bool pack_solid(const lr_object *object, lr_transform canonical, list_kind list,
                       primitive *out)
{
    lr_transform inverse = inverse_of(&object->to_world);
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
        .row0 = pack_row(t.m[0], scale),
        .row1 = pack_row(t.m[1], scale),
        .row2 = pack_row(t.m[2], scale),
        .scale = (float)scale,
        .inv_scale = (float)longest,
    };
    lr_transform back;
    lr_transform_inverse(&t, &back);
    lr_vec3 corners[8];
    for (int i = 0; i < 8; i++)
        corners[i] = lr_transform_point(
            &back, (lr_vec3){i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : (list == CONES ? 0 : -1)});
    out->ball = ball_around(corners, 8);
    return true;
}

static bool pack_sphere(const lr_object *object, primitive *out)
{
    double radius = object->sphere.radius, scale;
    if (!is_similarity(&object->to_world, &scale)) {
        double k = 1 / radius;
        lr_vec3 axes[3] = {{k, 0, 0}, {0, k, 0}, {0, 0, k}};
        return pack_solid(object, into_frame(object->sphere.center, axes), ELLIPSOIDS, out);
    }
    radius *= scale;
    lr_vec3 center = lr_transform_point(&object->to_world, object->sphere.center);
    out->list = SPHERES;
    out->encloses = true;
    out->record.sphere = (struct gpu_sphere){
        .center = lr_pack_vec3(center), .inv_radius = (float)(1 / radius), .radius = (float)radius};
    out->ball = pack_ball(center, radius);
    return true;
}

static bool pack_plane(const lr_object *object, primitive *out)
{
    lr_transform inverse = inverse_of(&object->to_world);
    double length2 = lr_vec3_dot(object->plane.normal, object->plane.normal);
    lr_vec3 point = lr_vec3_scale(object->plane.normal, object->plane.offset / length2);
    point = lr_transform_point(&object->to_world, point);
    lr_vec3 n = lr_vec3_normalize(lr_transform_normal(&inverse, object->plane.normal));
    out->list = PLANES;
    out->encloses = true;
    out->record.plane =
        (struct gpu_plane){.normal = lr_pack_vec3(n), .offset = (float)lr_vec3_dot(n, point)};
    return true;
}

/* The piece of plane origin + a e1 + b e2 with the coordinates (a, b) that `shape` allows. */
static bool pack_flat(const lr_object *object, lr_vec3 origin, lr_vec3 e1, lr_vec3 e2,
                      uint32_t shape, primitive *out)
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
    out->list = FLATS;
    out->encloses = false;
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
    } else {
        lr_vec3 corners[] = {lr_vec3_add(origin, e3), lr_vec3_sub(origin, e3),
                             lr_vec3_add(origin, e4), lr_vec3_sub(origin, e4)};
        out->ball = ball_around(corners, 4);
    }
    return isfinite(k);
}

static bool pack_disk(const lr_object *object, primitive *out)
{
    lr_vec3 u, v;
    lr_vec3_frame(lr_vec3_normalize(object->disk.normal), &u, &v);
    return pack_flat(object, object->disk.center, lr_vec3_scale(u, object->disk.radius),
                     lr_vec3_scale(v, object->disk.radius), LR_FLAG_DISK, out);
}

static bool pack_rectangle(const lr_object *object, primitive *out)
{
    lr_vec3 u = lr_vec3_scale(object->rectangle.u, 0.5);
    lr_vec3 v = lr_vec3_scale(object->rectangle.v, 0.5);
    lr_vec3 center = lr_vec3_add(object->rectangle.corner, lr_vec3_add(u, v));
    return pack_flat(object, center, u, v, 0, out);
}

static bool pack_triangle(const lr_object *object, primitive *out)
{
    lr_vec3 a = object->triangle.a;
    return pack_flat(object, a, lr_vec3_sub(object->triangle.b, a),
                     lr_vec3_sub(object->triangle.c, a), LR_FLAG_TRIANGLE, out);
}

static bool pack_box(const lr_object *object, primitive *out)
{
    lr_vec3 half = lr_vec3_scale(lr_vec3_sub(object->box.max, object->box.min), 0.5);
    lr_vec3 center = lr_vec3_add(object->box.min, half);
    lr_vec3 axes[3] = {{1 / half.x, 0, 0}, {0, 1 / half.y, 0}, {0, 0, 1 / half.z}};
    return pack_solid(object, into_frame(center, axes), BOXES, out);
}

static bool pack_cone(const lr_object *object, primitive *out)
{
    lr_vec3 axis = lr_vec3_sub(object->cone.to, object->cone.from);
    double length = lr_vec3_length(axis);
    double radius = fmax(object->cone.radius_from, object->cone.radius_to);
    lr_vec3 w = lr_vec3_normalize(axis), u, v;
    lr_vec3_frame(w, &u, &v);
    lr_vec3 axes[3] = {lr_vec3_scale(u, 1 / radius), lr_vec3_scale(v, 1 / radius),
                       lr_vec3_scale(w, 1 / length)};
    if (!pack_solid(object, into_frame(object->cone.from, axes), CONES, out))
        return false;
    out->encloses = !object->open;
    out->record.solid.radius_from = (float)(object->cone.radius_from / radius);
    out->record.solid.radius_slope =
        (float)((object->cone.radius_to - object->cone.radius_from) / radius);
    out->record.solid.flags = object->open ? LR_FLAG_OPEN : 0;
    return true;
}

static bool pack_object(const lr_object *object, primitive *out)
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
        break;
    }
    return false;
}

static void set_ids(primitive *p, uint32_t object, uint32_t flags)
{
    switch (p->list) {
    case SPHERES:
        p->record.sphere.object = object;
        p->record.sphere.flags = flags;
        break;
    case PLANES:
        p->record.plane.object = object;
        p->record.plane.flags = flags;
        break;
    case FLATS:
        p->record.flat.object = object;
        p->record.flat.flags |= flags;
        break;
    default:
        p->record.solid.object = object;
        p->record.solid.flags |= flags;
    }
}

/* Whether a point lies inside a solid primitive, in double from the object's own description. */
static bool contains(const lr_object *object, lr_vec3 point)
{
    lr_transform inverse = inverse_of(&object->to_world);
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

/* Media in the order of their rank: by priority, then by their place in the scene. */
typedef struct medium_order {
    int priority;
    uint32_t object;
} medium_order;

static int compare_media(const void *a, const void *b)
{
    const medium_order *x = a, *y = b;
    if (x->priority != y->priority)
        return x->priority < y->priority ? -1 : 1;
    return x->object < y->object ? -1 : x->object > y->object;
}

static const lr_material *material_of(const lr_scene *scene, uint32_t object)
{
    return &scene->materials[scene->objects[object].material];
}

/* Packs the table of media and gives the ranks of the objects' media in ranks[]. */
static lr_status pack_media(const lr_scene *scene, const lr_settings *settings,
                            const primitive *primitives, uint32_t *ranks, lr_packed_scene *packed,
                            lr_error *error)
{
    medium_order *order = lr_alloc(scene->object_count, sizeof *order);
    if (!order)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for the scene's media");
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->object_count; i++) {
        const lr_material *m = material_of(scene, i);
        if (primitives[i].encloses && !lr_color_is_black(m->transmit))
            order[count++] = (medium_order){m->priority, i};
    }
    qsort(order, count, sizeof *order, compare_media);

    struct gpu_medium outside = {.ior = 1};
    packed->frame.media = lr_pack_rows(packed, &outside, 1);
    uint32_t inside[LR_MEDIA_MAX] = {0}, inside_count = 0;
    bool fits = packed->frame.media != UINT32_MAX;
    for (uint32_t i = 0; fits && i < count; i++) {
        uint32_t object = order[i].object;
        const lr_material *m = material_of(scene, object);
        ranks[object] = i + 1;
        struct gpu_medium medium = {
            .absorption = lr_pack_vec3(lr_vec3_scale(m->absorption, LOG2_E)),
            .ior = (float)m->ior,
        };
        fits = lr_pack_rows(packed, &medium, 1) != UINT32_MAX;
        packed->constants[LR_SPEC_MEDIA] = 1;
        packed->constants[LR_SPEC_ABSORPTION] |= !lr_color_is_black(m->absorption);
        if (contains(&scene->objects[object], settings->camera->from))
            inside[inside_count++ % LR_MEDIA_MAX] = i + 1;
    }
    packed->frame.inside0 = inside[0] | inside[1] << 16;
    packed->frame.inside1 = inside[2] | inside[3] << 16;
    packed->frame.inside2 = inside[4] | inside[5] << 16;
    packed->frame.inside3 = inside[6] | inside[7] << 16;
    free(order);
    return fits ? LR_OK : lr_fail(error, LR_ERROR_MEMORY, "out of memory for the scene's media");
}

/* A transmitted share as optical depth in shadows. */
static uint32_t shadow_depth(double transmit)
{
    if (transmit <= 0)
        return LR_SHADOW_OPAQUE;
    double depth = -lr_log2(transmit) * LR_SHADOW_UNIT;
    return depth < LR_SHADOW_OPAQUE ? (uint32_t)floor(depth + 0.5) : LR_SHADOW_OPAQUE;
}

static bool pack_object_record(const lr_scene *scene, uint32_t index, uint32_t flags, uint32_t rank,
                               lr_packed_scene *packed)
{
    const lr_object *object = &scene->objects[index];
    lr_transform inverse = inverse_of(&object->to_world);
    lr_color transmit = material_of(scene, index)->transmit;
    struct gpu_object record = {
        .row0 = pack_row(inverse.m[0], 1),
        .row1 = pack_row(inverse.m[1], 1),
        .row2 = pack_row(inverse.m[2], 1),
        .material = object->material,
        .flags = flags,
        .rank = rank,
        .shadow_red = shadow_depth(transmit.x),
        .shadow_green = shadow_depth(transmit.y),
        .shadow_blue = shadow_depth(transmit.z),
        .shadow_rank = flags & LR_FLAG_SOLID ? rank : 0,
    };
    return lr_pack_rows(packed, &record, sizeof record / 16) != UINT32_MAX;
}

/* Packs the records kind by kind, and then the balls around the bounded ones. */
static bool pack_lists(const primitive *primitives, uint32_t count, lr_packed_scene *packed)
{
    static const uint32_t rows[LIST_COUNT] = {
        [SPHERES] = sizeof(struct gpu_sphere) / 16,   [FLATS] = sizeof(struct gpu_flat) / 16,
        [ELLIPSOIDS] = sizeof(struct gpu_solid) / 16, [BOXES] = sizeof(struct gpu_solid) / 16,
        [CONES] = sizeof(struct gpu_solid) / 16,      [PLANES] = sizeof(struct gpu_plane) / 16,
    };
    struct gpu_frame *frame = &packed->frame;
    gpu_list *lists[LIST_COUNT] = {&frame->spheres, &frame->flats, &frame->ellipsoids,
                                   &frame->boxes,   &frame->cones, &frame->planes};
    uint32_t number = 0;
    for (list_kind kind = SPHERES; kind < LIST_COUNT; kind++) {
        gpu_list *list = lists[kind];
        list->base = packed->row_count - rows[kind] * number;
        list->begin = number;
        for (uint32_t i = 0; i < count; i++) {
            if (primitives[i].list != kind)
                continue;
            if (lr_pack_rows(packed, &primitives[i].record, rows[kind]) == UINT32_MAX)
                return false;
            number++;
        }
        list->end = number;
        packed->constants[LR_SPEC_SPHERES + kind] = list->end > list->begin;
    }
    /* The solids' records stand together, so they have one base. */
    frame->solids =
        (gpu_list){frame->ellipsoids.base, frame->ellipsoids.begin, frame->cones.end, 0};
    frame->bounded = frame->planes.begin;
    frame->balls = packed->row_count;
    for (list_kind kind = SPHERES; kind < PLANES; kind++)
        for (uint32_t i = 0; i < count; i++)
            if (primitives[i].list == kind &&
                lr_pack_rows(packed, &primitives[i].ball, 1) == UINT32_MAX)
                return false;
    return true;
}

lr_status lr_pack_objects(const lr_scene *scene, const lr_settings *settings,
                          lr_packed_scene *packed, lr_error *error)
{
    uint32_t count = scene->object_count;
    packed->primitive_count = count;
    primitive *primitives = lr_alloc(count, sizeof *primitives);
    uint32_t *ranks = lr_alloc(count, sizeof *ranks);
    lr_status status = LR_OK;
    bool fits = primitives && ranks;
    for (uint32_t i = 0; fits && i < count && !status; i++)
        if (!pack_object(&scene->objects[i], &primitives[i]))
            status = lr_fail(error, LR_ERROR_SCENE,
                             "%s:%u: the object is too thin: its shortest extent must be at least "
                             "1e-9 of its longest",
                             scene->source, scene->objects[i].line);
    if (fits && !status)
        status = pack_media(scene, settings, primitives, ranks, packed, error);
    packed->frame.objects = packed->row_count;
    for (uint32_t i = 0; fits && i < count && !status; i++) {
        bool transparent = !lr_color_is_black(material_of(scene, i)->transmit);
        bool shadow = scene->objects[i].shadow;
        uint32_t flags = (primitives[i].encloses ? LR_FLAG_SOLID : 0) |
                         (transparent ? LR_FLAG_TRANSPARENT : 0) | (shadow ? LR_FLAG_SHADOW : 0);
        packed->constants[LR_SPEC_TRANSPARENT] |= shadow && transparent;
        packed->constants[LR_SPEC_TRANSPARENT_PLANES] |=
            shadow && transparent && primitives[i].list == PLANES;
        set_ids(&primitives[i], i, flags);
        fits = pack_object_record(scene, i, flags, ranks[i], packed);
    }
    if (fits && !status)
        fits = pack_lists(primitives, count, packed);
    free(primitives);
    free(ranks);
    if (!fits)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for the scene's objects");
    return status;
}
