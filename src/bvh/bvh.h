/* Bounding volume hierarchies over primitives of any kind that have boxes: the builder, and a
 * traversal on the CPU that judges the kernels in the tests. */
#ifndef LR_BVH_BVH_H
#define LR_BVH_BVH_H

#include "lavaray.h"

/* No path from the root to a leaf, both counted, has more nodes, whatever the input: a traversal
 * that puts one child aside at each inner node never holds more than LR_BVH_MAX_DEPTH - 1. */
#define LR_BVH_MAX_DEPTH 64
#define LR_BVH_MAX_LEAF 8
#define LR_BVH_MAX_COUNT (1u << 30)

typedef struct lr_bvh_box {
    float min[3], max[3];
} lr_bvh_box;

/* A node of 32 bytes. The left child stands right behind its parent; it holds the smaller
 * centroids along `axis`. A node's box is the union of its children's, a leaf's of its
 * primitives', without any margin. */
typedef struct lr_bvh_node {
    float min[3];
    uint32_t link; /* leaf: where its primitives begin in `order`; inner: the right child's index */
    float max[3];
    uint16_t count; /* the primitives of a leaf; 0: an inner node */
    uint16_t axis;  /* inner: 0..2, the axis of the split; leaf: 0 */
} lr_bvh_node;

typedef struct lr_bvh {
    lr_bvh_node *nodes; /* in depth-first order, the root first */
    uint32_t node_count;
    uint32_t *order; /* the primitives' indices, each once; leaves name ranges of it */
    uint32_t count;  /* of the primitives */
    uint32_t depth;  /* nodes on the longest path; 0 when there is no primitive */
} lr_bvh;

typedef struct lr_bvh_options {
    uint32_t leaf_size; /* most primitives in a leaf, 1 to LR_BVH_MAX_LEAF; 0: 4 */
    float box_cost;     /* of a step at an inner node, over that of testing a primitive; 0: 1 */
    uint32_t threads;   /* 0: as many as there are processors */
} lr_bvh_options;

/* Builds the hierarchy of `count` boxes by the surface area heuristic over binned centroids (Wald,
 * "On fast Construction of SAH-based Bounding Volume Hierarchies", 2007). The nodes and their order
 * depend on the boxes, leaf_size and box_cost alone, not on the threads. No boxes make a
 * hierarchy without nodes. `boxes` is only read; options may be NULL. The caller destroys *bvh,
 * which is NULL after an error. At its peak it holds about 135 bytes a primitive beside the
 * boxes. LR_ERROR_ARGUMENT: a box that is not finite or whose min exceeds its max (the message
 * names the first by its index), an option out of range, more than LR_BVH_MAX_COUNT boxes. */
lr_status lr_bvh_create(const lr_bvh_box *boxes, uint32_t count, const lr_bvh_options *options,
                        lr_bvh **bvh, lr_error *error);
void lr_bvh_destroy(lr_bvh *bvh);

/* The expected cost of a ray that meets the root's box, in tests of primitives: the sum over the
 * inner nodes of box_cost and over the leaves of their counts, weighted by the area of the node
 * over the root's (MacDonald and Booth, 1990). 0 when the root has no area. box_cost 0: 1. */
double lr_bvh_cost(const lr_bvh *bvh, double box_cost);

/* Points origin + t * direction with t_min <= t <= t_max. The direction need not be of unit
 * length and may have zero components. */
typedef struct lr_bvh_ray {
    double origin[3], direction[3];
    double t_min, t_max;
} lr_bvh_ray;

/* Tests one primitive. For the nearest hit it lowers *t_max to its hit; a tie is its own to decide,
 * as boxes that begin at *t_max are still visited. False ends the traversal, as for any hit. */
typedef bool (*lr_bvh_test)(void *context, uint32_t primitive, double *t_max);

/* Calls test for the primitives in leaves that the ray meets, nearer ones roughly first, and
 * returns the number of nodes whose boxes it tested. Boxes are widened by 2^-20 of the distance,
 * which covers the rounding of tests in double; a test in float wants boxes with margins. */
uint32_t lr_bvh_trace(const lr_bvh *bvh, const lr_bvh_ray *ray, lr_bvh_test test, void *context);

#endif
