/* The parts of bench_traverse: the rays, and who traces them. */
#ifndef BENCH_TRAVERSE_H
#define BENCH_TRAVERSE_H

#include "bvh_meshes.h"
#include "timing.h"

enum { PRIMARY, SHADOW, BOUNCE, RAY_KINDS };

typedef struct ray {
    float origin[3], direction[3]; /* the direction of unit length */
    float t_max;
} ray;

/* Neighbours stand beside each other: squares of 8 x 8 pixels, in them Morton's order. Shadow rays
 * end at `light`. */
typedef struct ray_set {
    ray *rays[RAY_KINDS];
    uint32_t count[RAY_KINDS];
    float light[3];
} ray_set;

/* Rays of a camera above hills (mesh_terrain), and from where these meet them. */
ray_set make_rays(const mesh *m);
void free_rays(ray_set *set);

typedef struct embree embree;

/* NULL without Embree. */
embree *embree_open(const mesh *m);
void embree_close(embree *e);
/* Traces the rays with two threads, in packets of 16 or one by one; for the nearest hit, or for any
 * if they are SHADOW. Returns how many met something. */
uint32_t embree_trace(embree *e, const ray_set *set, int kind, bool packets);

#endif
