#include "traverse.h"

#ifndef HAVE_EMBREE
embree *embree_open(const mesh *m)
{
    (void)m;
    return NULL;
}

void embree_close(embree *e)
{
    (void)e;
}

uint32_t embree_trace(embree *e, const ray_set *set, int kind, bool packets)
{
    (void)e, (void)set, (void)kind, (void)packets;
    return 0;
}
#else
#include <pthread.h>
#include <stdatomic.h>
#include <string.h>

#include <embree3/rtcore.h>

enum { PACKET = 16, PORTION = 256 * PACKET, THREADS = 2 };

struct embree {
    RTCDevice device;
    RTCScene scene;
};

embree *embree_open(const mesh *m)
{
    embree *e = malloc(sizeof *e);
    if (!e)
        abort();
    e->device = rtcNewDevice(NULL);
    e->scene = rtcNewScene(e->device);
    RTCGeometry g = rtcNewGeometry(e->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void *vertices = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12,
                                             m->vertex_count);
    void *triangles =
        rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, m->count);
    memcpy(vertices, m->vertices, 12 * (size_t)m->vertex_count);
    memcpy(triangles, m->triangles, 12 * (size_t)m->count);
    rtcCommitGeometry(g);
    rtcAttachGeometry(e->scene, g);
    rtcReleaseGeometry(g);
    rtcCommitScene(e->scene);
    return e;
}

void embree_close(embree *e)
{
    if (!e)
        return;
    rtcReleaseScene(e->scene);
    rtcReleaseDevice(e->device);
    free(e);
}

/* What the threads share. */
typedef struct job {
    RTCScene scene;
    const ray *rays;
    uint32_t count;
    int kind;
    bool packets;
    atomic_uint next, hits;
} job;

static uint32_t trace_packet(const job *j, struct RTCIntersectContext *context, uint32_t first)
{
    struct RTCRayHit16 r;
    int valid[PACKET] __attribute__((aligned(64)));
    uint32_t hits = 0;
    for (uint32_t i = 0; i < PACKET; i++) {
        valid[i] = first + i < j->count ? -1 : 0;
        const ray *from = &j->rays[valid[i] ? first + i : first];
        r.ray.org_x[i] = from->origin[0];
        r.ray.org_y[i] = from->origin[1];
        r.ray.org_z[i] = from->origin[2];
        r.ray.dir_x[i] = from->direction[0];
        r.ray.dir_y[i] = from->direction[1];
        r.ray.dir_z[i] = from->direction[2];
        r.ray.tnear[i] = 0;
        r.ray.tfar[i] = from->t_max;
        r.ray.time[i] = 0;
        r.ray.mask[i] = ~0u;
        r.ray.flags[i] = 0;
        r.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        r.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    if (j->kind == SHADOW)
        rtcOccluded16(valid, j->scene, context, &r.ray);
    else
        rtcIntersect16(valid, j->scene, context, &r);
    for (uint32_t i = 0; i < PACKET; i++)
        hits += valid[i] && (j->kind == SHADOW ? r.ray.tfar[i] < 0
                                               : r.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID);
    return hits;
}

static uint32_t trace_single(const job *j, struct RTCIntersectContext *context, uint32_t i)
{
    const ray *from = &j->rays[i];
    struct RTCRayHit r = {
        .ray = {.org_x = from->origin[0],
                .org_y = from->origin[1],
                .org_z = from->origin[2],
                .dir_x = from->direction[0],
                .dir_y = from->direction[1],
                .dir_z = from->direction[2],
                .tfar = from->t_max,
                .mask = ~0u},
        .hit = {.geomID = RTC_INVALID_GEOMETRY_ID, .instID = {RTC_INVALID_GEOMETRY_ID}},
    };
    if (j->kind == SHADOW) {
        rtcOccluded1(j->scene, context, &r.ray);
        return r.ray.tfar < 0;
    }
    rtcIntersect1(j->scene, context, &r);
    return r.hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

static void *work(void *context)
{
    job *j = context;
    struct RTCIntersectContext intersect;
    rtcInitIntersectContext(&intersect);
    intersect.flags = j->kind == BOUNCE ? RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT
                                        : RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    uint32_t hits = 0, first;
    while ((first = atomic_fetch_add(&j->next, PORTION)) < j->count) {
        uint32_t end = first + PORTION < j->count ? first + PORTION : j->count;
        for (uint32_t i = first; i < end; i += j->packets ? PACKET : 1)
            hits += j->packets ? trace_packet(j, &intersect, i) : trace_single(j, &intersect, i);
    }
    atomic_fetch_add(&j->hits, hits);
    return NULL;
}

uint32_t embree_trace(embree *e, const ray_set *set, int kind, bool packets)
{
    job j = {.scene = e->scene,
             .rays = set->rays[kind],
             .count = set->count[kind],
             .kind = kind,
             .packets = packets};
    pthread_t threads[THREADS];
    for (int i = 0; i < THREADS; i++)
        if (pthread_create(&threads[i], NULL, work, &j))
            abort();
    for (int i = 0; i < THREADS; i++)
        pthread_join(threads[i], NULL);
    return atomic_load(&j.hits);
}
#endif
