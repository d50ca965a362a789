/* Times builds of the hierarchy, and Embree's of the same triangles where it is installed: JSON for
 * `tools/bench --bvh`. Usage: bench_bvh RUNS. */
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <time.h>

#include <jansson.h>
#ifdef HAVE_EMBREE
#include <embree3/rtcore.h>
#endif

#include "bvh_meshes.h"

enum { RUNS_MAX = 1000 };

typedef struct timing {
    double cpu[RUNS_MAX], wall[RUNS_MAX];
    int count;
} timing;

static double cpu_seconds(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
           1e-6 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

static double wall_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void start(timing *t)
{
    t->cpu[t->count] = -cpu_seconds();
    t->wall[t->count] = -wall_seconds();
}

static void stop(timing *t)
{
    t->cpu[t->count] += cpu_seconds();
    t->wall[t->count++] += wall_seconds();
}

static int ascending(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return *x < *y ? -1 : *x > *y;
}

static json_t *summary(timing *t)
{
    qsort(t->cpu, (size_t)t->count, sizeof *t->cpu, ascending);
    qsort(t->wall, (size_t)t->count, sizeof *t->wall, ascending);
    return json_pack("{s:f, s:f, s:i}", "cpu_seconds", t->cpu[t->count / 2], "wall_seconds",
                     t->wall[t->count / 2], "runs", t->count);
}

static lr_bvh *build(const mesh *m, timing *t)
{
    lr_bvh *bvh;
    lr_error error;
    start(t);
    if (lr_bvh_create(m->boxes, m->count, NULL, &bvh, &error) != LR_OK) {
        fprintf(stderr, "bench_bvh: %s\n", error.message);
        exit(1);
    }
    stop(t);
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
    start(t);
    rtcCommitGeometry(triangles);
    rtcAttachGeometry(scene, triangles);
    rtcCommitScene(scene);
    stop(t);
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
    ours.count = embree_first.count = embree_second.count = 0;
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
    int runs = count > 1 ? atoi(arguments[1]) : 5;
    runs = runs < 1 ? 1 : runs > RUNS_MAX ? RUNS_MAX : runs;
    json_t *results = json_pack("{s:o, s:o, s:o}", "terrain_70k", measure(mesh_terrain(187), runs),
                                "terrain_1m", measure(mesh_terrain(708), runs), "soup_1m",
                                measure(mesh_soup(1000000, 0.01f, 1), runs));
    json_dumpf(results, stdout, JSON_INDENT(2) | JSON_REAL_PRECISION(4));
    putchar('\n');
    json_decref(results);
    return 0;
}
