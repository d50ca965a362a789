/* The traversal finds what a loop over all primitives finds. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "bvh_meshes.h"

enum { NONE = -1 };

typedef struct sphere {
    double center[3], radius;
} sphere;

/* A scene of one kind: triangles, or spheres where there are any. */
typedef struct query {
    const mesh *mesh;
    const sphere *spheres;
    const lr_bvh_ray *ray;
    bool any;
    int hit; /* the primitive, the smaller one of equal t */
    double t;
    uint32_t tested;
} query;

static bool sphere_hit(const sphere *s, const lr_bvh_ray *ray, double *t)
{
    double a = 0, b = 0, c = -s->radius * s->radius;
    for (int k = 0; k < 3; k++) {
        double from = ray->origin[k] - s->center[k];
        a += ray->direction[k] * ray->direction[k];
        b += ray->direction[k] * from;
        c += from * from;
    }
    double discriminant = b * b - a * c;
    if (!(discriminant >= 0))
        return false;
    *t = (-b - sqrt(discriminant)) / a;
    if (*t < ray->t_min)
        *t = (-b + sqrt(discriminant)) / a;
    return *t >= ray->t_min && *t <= ray->t_max;
}

static bool test_primitive(void *context, uint32_t primitive, double *t_max)
{
    query *q = context;
    double t;
    q->tested++;
    bool hit = q->spheres ? sphere_hit(&q->spheres[primitive], q->ray, &t)
                          : mesh_hit(q->mesh, primitive, q->ray, &t);
    if (!hit || t > *t_max || (t == *t_max && q->hit != NONE && q->hit < (int)primitive))
        return true;
    q->hit = (int)primitive;
    q->t = *t_max = t;
    return !q->any;
}

/* All primitives in turn. */
static query brute_force(query q, uint32_t count)
{
    double t_max = q.ray->t_max;
    for (uint32_t i = 0; i < count && test_primitive(&q, i, &t_max);)
        i++;
    return q;
}

static lr_bvh_ray random_ray(uint32_t *seed)
{
    lr_bvh_ray ray = {.t_min = 0, .t_max = INFINITY};
    for (int k = 0; k < 3; k++) {
        ray.origin[k] = 3 * (double)mesh_random(seed) - 1;
        ray.direction[k] = (double)mesh_random(seed) - ray.origin[k];
    }
    uint32_t kind = mesh_hash(*seed) % 8;
    if (kind < 3) /* along an axis */
        for (uint32_t k = 0; k < 3; k++)
            ray.direction[k] = k == kind ? 1 : kind == 0 ? -0.0 : 0.0;
    if (kind < 2)
        for (int k = 0; k < 3; k++)
            ray.origin[k] = (double)mesh_random(seed);
    if (kind == 3) /* in a plane */
        ray.direction[mesh_hash(*seed + 1) % 3] = 0;
    if (kind == 4) {
        ray.t_min = 0.3;
        ray.t_max = 0.6;
    }
    return ray;
}

/* Traces rays both ways; *tested is the number of primitives the hierarchy tried, a ray. */
static void compare(const lr_bvh_box *boxes, uint32_t count, const mesh *m, const sphere *spheres,
                    uint32_t rays, uint32_t leaf_size)
{
    lr_bvh *bvh;
    lr_bvh_options options = {.leaf_size = leaf_size};
    assert_int_equal(lr_bvh_create(boxes, count, &options, &bvh, NULL), LR_OK);
    uint32_t seed = 11, hits = 0;
    double tested = 0;
    for (uint32_t i = 0; i < rays; i++) {
        lr_bvh_ray ray = random_ray(&seed);
        query nearest = {.mesh = m, .spheres = spheres, .ray = &ray, .hit = NONE};
        query any = nearest, expected = brute_force(nearest, count);
        any.any = true;
        lr_bvh_trace(bvh, &ray, test_primitive, &nearest);
        lr_bvh_trace(bvh, &ray, test_primitive, &any);
        if (nearest.hit != expected.hit || (nearest.hit != NONE && nearest.t != expected.t))
            fail_msg("ray %u: %d at %g, not %d at %g", i, nearest.hit, nearest.t, expected.hit,
                     expected.t);
        assert_int_equal(any.hit != NONE, expected.hit != NONE);
        hits += expected.hit != NONE;
        tested += nearest.tested;
    }
    /* The rays are worth something, and the hierarchy saves work. */
    assert_in_range(hits, rays / 10, rays - rays / 10);
    if (count > 1000 && tested / rays > count / 10.0)
        fail_msg("%g of %u primitives tried", tested / rays, count);
    lr_bvh_destroy(bvh);
}

static void test_triangles(void **state)
{
    (void)state;
    mesh m = mesh_soup(5000, 0.05f, 4);
    for (uint32_t leaf = 1; leaf <= 8; leaf *= 2)
        compare(m.boxes, m.count, &m, NULL, 2000, leaf);
    mesh_free(&m);
    m = mesh_terrain(40);
    compare(m.boxes, m.count, &m, NULL, 3000, 0);
    mesh_free(&m);
}

/* Every triangle twice, and every vertex on a grid: hits tie, and rays run in faces of boxes. */
static void test_ties(void **state)
{
    (void)state;
    mesh m = mesh_soup(4000, 0.25f, 5);
    for (uint32_t i = 0; i < m.vertex_count; i++)
        for (int k = 0; k < 3; k++)
            m.vertices[i][k] = floorf(m.vertices[i][k] * 16) / 16;
    for (uint32_t i = 0; i < m.count; i++) {
        uint32_t from = i % (m.count / 2);
        mesh_set(&m, i, 3 * from, 3 * from + 1, 3 * from + 2);
    }
    compare(m.boxes, m.count, &m, NULL, 3000, 0);
    mesh_free(&m);
}

static void test_spheres(void **state)
{
    (void)state;
    enum { COUNT = 2000 };
    static sphere spheres[COUNT];
    static lr_bvh_box boxes[COUNT];
    uint32_t seed = 9;
    for (uint32_t i = 0; i < COUNT; i++) {
        spheres[i].radius = 0.02 * (double)mesh_random(&seed);
        for (int k = 0; k < 3; k++) {
            spheres[i].center[k] = (double)mesh_random(&seed);
            boxes[i].min[k] = nextafterf((float)(spheres[i].center[k] - spheres[i].radius), -9);
            boxes[i].max[k] = nextafterf((float)(spheres[i].center[k] + spheres[i].radius), 9);
        }
    }
    compare(boxes, COUNT, NULL, spheres, 3000, 0);
}

static void test_nothing(void **state)
{
    (void)state;
    lr_bvh *bvh;
    lr_bvh_ray ray = {{0, 0, 0}, {0, 0, 1}, 0, INFINITY};
    query q = {.ray = &ray, .hit = NONE};
    assert_int_equal(lr_bvh_create(NULL, 0, NULL, &bvh, NULL), LR_OK);
    assert_int_equal(lr_bvh_trace(bvh, &ray, test_primitive, &q), 0);
    lr_bvh_destroy(bvh);
}

static bool count_tests(void *context, uint32_t primitive, double *t_max)
{
    (void)primitive, (void)t_max;
    ++*(uint32_t *)context;
    return true;
}

/* A ray along the diagonal of the deepest hierarchy meets every node: the stack holds. */
static void test_deep(void **state)
{
    (void)state;
    enum { COUNT = 3000 };
    static lr_bvh_box boxes[COUNT];
    fill_deep_boxes(boxes, COUNT);
    lr_bvh *bvh;
    assert_int_equal(lr_bvh_create(boxes, COUNT, &(lr_bvh_options){.leaf_size = 1}, &bvh, NULL),
                     LR_OK);
    assert_int_equal(bvh->depth, LR_BVH_MAX_DEPTH);
    for (int sign = -1; sign <= 1; sign += 2) {
        lr_bvh_ray ray = {{0, 0, 0}, {sign, 0, 0}, -INFINITY, INFINITY};
        uint32_t tested = 0;
        assert_int_equal(lr_bvh_trace(bvh, &ray, count_tests, &tested), bvh->node_count);
        assert_int_equal(tested, COUNT);
    }
    lr_bvh_destroy(bvh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_triangles), cmocka_unit_test(test_ties),
        cmocka_unit_test(test_spheres),   cmocka_unit_test(test_nothing),
        cmocka_unit_test(test_deep),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
