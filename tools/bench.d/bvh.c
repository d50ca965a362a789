/* Times builds of the hierarchy, and Embree's of the same triangles where it is installed: JSON for
 * `tools/bench --bvh`. Usage: bench_bvh RUNS. */
#include <stdio.h>
#ifdef HAVE_EMBREE
#include <embree3/rtcore.h>
#endif

#include "bvh_meshes.h"
#include "timing.h"

static lr_bvh *build(const mesh *m, timing *t)
{
    lr_bvh *bvh;
    lr_error error;
    timing_start(t);
    if (lr_bvh_create(m->boxes, m->count, NULL, &bvh, &error) != LR_OK) {
        fprintf(stderr, "bench_bvh: %s\n", error.message);
        exit(1);
    }
    timing_stop(t);
    timing_next(t);
    return bvh;
}

#ifdef HAVE_EMBREE
static RTCScene embree_build(RTCDevice device, const mesh *m, timing *t)
{
    RTCScene scene = rtcNewScene(device);
    RTCGeometry triangles = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(triangles, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, m->vertices,
                               0, 12, m->vertex_count);
    rtcSetSharedGeometryBuffer(triangles, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, m->triangles,
                               0, 12, m->count);
    timing_start(t);
    rtcCommitGeometry(triangles);
    rtcAttachGeometry(scene, triangles);
    rtcCommitScene(scene);
    timing_stop(t);
    timing_next(t);
    rtcReleaseGeometry(triangles);
    return scene;
}

/* The first build of a new device and the next one of the same mesh, with medium quality. */
static void embree_builds(const mesh *m, timing *first, timing *second)
{
    RTCDevice device = rtcNewDevice(NULL);
    rtcReleaseScene(embree_build(device, m, first));
    rtcReleaseScene(embree_build(device, m, second));
    rtcReleaseDevice(device);
}
#endif

static json_t *measure(mesh m, int runs)
{
    static timing ours, embree_first, embree_second;
    lr_bvh *bvh = NULL;
    ours = embree_first = embree_second = (timing){0};
    for (int i = 0; i < runs; i++) {
        lr_bvh_destroy(bvh);
        bvh = build(&m, &ours);
#ifdef HAVE_EMBREE
        embree_builds(&m, &embree_first, &embree_second);
#endif
    }
    json_t *result = json_pack("{s:i, s:o, s:i, s:i, s:f}", "triangles", (int)m.count, "lavaray",
                               summary(&ours), "nodes", (int)bvh->node_count, "depth",
                               (int)bvh->depth, "cost", lr_bvh_cost(bvh, 0));
    if (embree_first.count) {
        json_object_set_new(result, "embree_first", summary(&embree_first));
        json_object_set_new(result, "embree_second", summary(&embree_second));
    }
    lr_bvh_destroy(bvh);
    mesh_free(&m);
    return result;
}

int main(int count, char **arguments)
{
    int runs = runs_from(count > 1 ? arguments[1] : "5");
    json_t *results = json_pack("{s:o, s:o, s:o}", "terrain_70k", measure(mesh_terrain(187), runs),
                                "terrain_1m", measure(mesh_terrain(708), runs), "soup_1m",
                                measure(mesh_soup(1000000, 0.01f, 1), runs));
    json_dumpf(results, stdout, JSON_INDENT(2) | JSON_REAL_PRECISION(4));
    putchar('\n');
    json_decref(results);
    return 0;
}
