/* Degenerate shapes and sizes, told at the key that makes them so. */
#include "scene/read.h"

#include <math.h>

bool lr_parallel(lr_vec3 a, lr_vec3 b)
{
    /* Written so that NaN counts as parallel. */
    lr_vec3 sine = lr_vec3_cross(lr_vec3_normalize(a), lr_vec3_normalize(b));
    return !(lr_vec3_length(sine) > 1e-6);
}

static bool fail_at(lr_reader *reader, const lr_node *node, const char *message)
{
    lr_report_add(reader->report, node->offset, "%s", message);
    return false;
}

static const lr_node *node_of(const lr_given *given, const lr_record *record, const char *name,
                              const lr_node *at)
{
    const lr_node *node = lr_given_value(given, record, name);
    return node ? node : at;
}

static bool too_short(lr_vec3 v)
{
    return !(lr_vec3_length(v) >= LR_LENGTH_MIN);
}

bool lr_check_shape(lr_reader *reader, const lr_object *object, const lr_record *record,
                    const lr_given *given, const lr_node *at)
{
    switch (object->kind) {
    case LR_BOX: {
        const double *low = &object->box.min.x, *high = &object->box.max.x;
        for (int i = 0; i < 3; i++)
            if (!(high[i] - low[i] >= LR_LENGTH_MIN)) {
                lr_report_add(reader->report, node_of(given, record, "max", at)->offset,
                              "%c of max is %.10g, expected more than %c of min, %.10g", "xyz"[i],
                              high[i], "xyz"[i], low[i]);
                return false;
            }
        return true;
    }
    case LR_RECTANGLE:
        if (too_short(object->rectangle.u) || too_short(object->rectangle.v))
            return fail_at(
                reader, node_of(given, record, too_short(object->rectangle.u) ? "u" : "v", at),
                "this edge of the rectangle has no length, expected a vector that is not 0");
        if (lr_parallel(object->rectangle.u, object->rectangle.v))
            return fail_at(reader, node_of(given, record, "v", at),
                           "v is parallel to u, expected two different directions");
        return true;
    case LR_CYLINDER:
    case LR_CONE:
        if (too_short(lr_vec3_sub(object->cone.to, object->cone.from)))
            return fail_at(reader, node_of(given, record, "to", at),
                           "from and to are the same point, expected two");
        if (fmax(object->cone.radius_from, object->cone.radius_to) < LR_LENGTH_MIN)
            return fail_at(reader, node_of(given, record, "radius", at),
                           "radius and top_radius are both 0, expected at least one above 0");
        return true;
    case LR_TRIANGLE: {
        lr_vec3 ab = lr_vec3_sub(object->triangle.b, object->triangle.a);
        lr_vec3 ac = lr_vec3_sub(object->triangle.c, object->triangle.a);
        lr_vec3 bc = lr_vec3_sub(object->triangle.c, object->triangle.b);
        if (too_short(ab) || too_short(ac) || too_short(bc) || lr_parallel(ab, ac) ||
            lr_parallel(ab, bc))
            return fail_at(reader, node_of(given, record, "c", at),
                           "the corners lie on one line, expected a triangle with an area");
        return true;
    }
    default:
        return true;
    }
}

/* The object as points that it lies between and edges that span it, in its own space. A plane has
 * only the point nearest to the origin. */
typedef struct extent {
    lr_vec3 center;
    lr_vec3 edges[3];
    int edge_count;
} extent;

static extent extent_of(const lr_object *object)
{
    extent e = {.edge_count = 3};
    switch (object->kind) {
    case LR_SPHERE: {
        double r = object->sphere.radius;
        e = (extent){object->sphere.center, {{r, 0, 0}, {0, r, 0}, {0, 0, r}}, 3};
        break;
    }
    case LR_PLANE: {
        lr_vec3 n = lr_vec3_normalize(object->plane.normal);
        double distance = object->plane.offset / lr_vec3_length(object->plane.normal);
        e = (extent){.center = lr_vec3_scale(n, distance)};
        break;
    }
    case LR_BOX: {
        lr_vec3 size = lr_vec3_sub(object->box.max, object->box.min);
        e = (extent){object->box.min, {{size.x, 0, 0}, {0, size.y, 0}, {0, 0, size.z}}, 3};
        break;
    }
    case LR_DISK: {
        lr_vec3 u, v;
        lr_vec3_frame(lr_vec3_normalize(object->disk.normal), &u, &v);
        double r = object->disk.radius;
        e = (extent){object->disk.center, {lr_vec3_scale(u, r), lr_vec3_scale(v, r)}, 2};
        break;
    }
    case LR_RECTANGLE:
        e = (extent){object->rectangle.corner, {object->rectangle.u, object->rectangle.v}, 2};
        break;
    case LR_CYLINDER:
    case LR_CONE: {
        lr_vec3 axis = lr_vec3_sub(object->cone.to, object->cone.from), u, v;
        lr_vec3_frame(lr_vec3_normalize(axis), &u, &v);
        /* The wider end at both ends: only the order of magnitude matters. */
        double r = fmax(object->cone.radius_from, object->cone.radius_to);
        e = (extent){object->cone.from, {axis, lr_vec3_scale(u, r), lr_vec3_scale(v, r)}, 3};
        break;
    }
    case LR_TRIANGLE:
        e = (extent){object->triangle.a,
                     {lr_vec3_sub(object->triangle.b, object->triangle.a),
                      lr_vec3_sub(object->triangle.c, object->triangle.a)},
                     2};
        break;
    case LR_MESH: /* its file's reader checks it */
        e.edge_count = 0;
        break;
    }
    return e;
}

static bool is_far(lr_vec3 p)
{
    /* Written so that NaN is far. */
    return !(fabs(p.x) <= LR_COORDINATE_MAX && fabs(p.y) <= LR_COORDINATE_MAX &&
             fabs(p.z) <= LR_COORDINATE_MAX);
}

bool lr_check_extent(lr_reader *reader, const lr_object *object, const lr_node *at)
{
    const lr_transform *t = &object->to_world;
    extent e = extent_of(object);
    lr_vec3 center = lr_transform_point(t, e.center);
    bool far = is_far(center), small = false;
    for (int i = 0; i < e.edge_count; i++) {
        lr_vec3 edge = lr_transform_vector(t, e.edges[i]);
        far |= is_far(lr_vec3_add(center, edge)) || is_far(lr_vec3_sub(center, edge));
        small |= too_short(edge);
    }
    if (far)
        lr_report_add(reader->report, at->offset,
                      "this object reaches beyond 1e12 metres from the origin, expected all of it "
                      "nearer");
    if (small)
        lr_report_add(reader->report, at->offset,
                      "this object is smaller than %g metres, expected it larger", LR_LENGTH_MIN);
    return !far && !small;
}
