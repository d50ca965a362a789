/* A second judge of hits: Embree, where it is installed. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#ifdef HAVE_EMBREE
#include <embree3/rtcore.h>

#include "bvh_meshes.h"

enum { RAYS = 100000 };

static RTCScene embree_scene(RTCDevice device, const mesh *m)
{
    RTCScene scene = rtcNewScene(device);
    RTCGeometry triangles = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float(*vertices)[3] = rtcSetNewGeometryBuffer(triangles, RTC_BUFFER_TYPE_VERTEX, 0,
                                                  RTC_FORMAT_FLOAT3, 12, m->vertex_count);
    uint32_t(*indices)[3] = rtcSetNewGeometryBuffer(triangles, RTC_BUFFER_TYPE_INDEX, 0,
                                                    RTC_FORMAT_UINT3, 12, m->count);
    assert_non_null(vertices);
    assert_non_null(indices);
    for (uint32_t i = 0; i < m->vertex_count; i++)
        for (int k = 0; k < 3; k++)
            vertices[i][k] = m->vertices[i][k];
    for (uint32_t i = 0; i < m->count; i++)
        for (int k = 0; k < 3; k++)
            indices[i][k] = m->triangles[i][k];
    rtcCommitGeometry(triangles);
    rtcAttachGeometry(scene, triangles);
    rtcReleaseGeometry(triangles);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(scene);
    return scene;
}

typedef struct query {
    const mesh *mesh;
    const lr_bvh_ray *ray;
    double t;
} query;

static bool nearest(void *context, uint32_t triangle, double *t_max)
{
    query *q = context;
    double t;
    if (mesh_hit(q->mesh, triangle, q->ray, &t) && t <= *t_max)
        q->t = *t_max = t;
    return true;
}

/* From above, below and between the hills towards them; in float, for both. */
static void random_ray(lr_bvh_ray *ray, struct RTCRayHit *hit, uint32_t *seed)
{
    float origin[3], direction[3];
    for (int k = 0; k < 3; k++) {
        origin[k] = 1.4f * mesh_random(seed) - 0.2f;
        direction[k] = (k == 1 ? 0.5f : 1) * mesh_random(seed) - origin[k];
        ray->origin[k] = origin[k];
        ray->direction[k] = direction[k];
    }
    ray->t_min = 0;
    ray->t_max = INFINITY;
    *hit = (struct RTCRayHit){
        .ray = {.org_x = origin[0],
                .org_y = origin[1],
                .org_z = origin[2],
                .dir_x = direction[0],
                .dir_y = direction[1],
                .dir_z = direction[2],
                .tfar = INFINITY,
                .mask = ~0u},
        .hit = {.geomID = RTC_INVALID_GEOMETRY_ID, .primID = RTC_INVALID_GEOMETRY_ID}};
}

/* In float a ray may pass an edge on its other side, so some rays may differ; but Embree must never
 * have found a triangle that is nearer in double too. */
static void test_hits(void **state)
{
    (void)state;
    mesh m = mesh_terrain(187);
    RTCDevice device = rtcNewDevice(NULL);
    assert_non_null(device);
    RTCScene scene = embree_scene(device, &m);
    lr_bvh *bvh;
    assert_int_equal(lr_bvh_create(m.boxes, m.count, NULL, &bvh, NULL), LR_OK);
    uint32_t seed = 21, hits = 0, different = 0;
    for (uint32_t i = 0; i < RAYS; i++) {
        lr_bvh_ray ray;
        struct RTCRayHit theirs;
        struct RTCIntersectContext context;
        random_ray(&ray, &theirs, &seed);
        query ours = {&m, &ray, INFINITY};
        rtcInitIntersectContext(&context);
        rtcIntersect1(scene, &context, &theirs);
        lr_bvh_trace(bvh, &ray, nearest, &ours);
        hits += ours.t < INFINITY;
        double t =
            theirs.hit.geomID == RTC_INVALID_GEOMETRY_ID ? INFINITY : (double)theirs.ray.tfar;
        if (t == ours.t || fabs(t - ours.t) <= 1e-4 * (1 + ours.t))
            continue;
        different++;
        if (t < INFINITY && mesh_hit(&m, theirs.hit.primID, &ray, &t) && t < ours.t)
            fail_msg("ray %u: a hit at %g, not at %g", i, t, ours.t);
    }
    print_message("%u of %u rays hit, %u differ\n", hits, RAYS, different);
    assert_in_range(hits, RAYS / 4, RAYS);
    assert_true(different <= RAYS / 10000);
    lr_bvh_destroy(bvh);
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
    mesh_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_hits)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#else

int main(void)
{
    return 77; /* skipped */
}

#endif
