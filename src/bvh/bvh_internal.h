/* What the builder's files share. */
#ifndef LR_BVH_BVH_INTERNAL_H
#define LR_BVH_BVH_INTERNAL_H

#include <float.h>
#ifdef __SSE__
#include <xmmintrin.h>
#endif

#include "bvh/bvh.h"

/* x, y, z and a lane that carries other things. */
typedef float lanes __attribute__((vector_size(16)));
typedef int32_t int_lanes __attribute__((vector_size(16)));

typedef struct bounds {
    lanes lo, hi;
} bounds;

/* A primitive on its way to a leaf. */
typedef union reference {
    struct {
        float lo[3];
        uint32_t index;
        float hi[3];
        float key; /* of a sort; otherwise of no meaning */
    };
    bounds box; /* its last lanes are index and key */
} reference;

/* A run of references that one node will hold. */
typedef struct range {
    uint32_t first, count;
    uint32_t depth;   /* of its node; the root's is 0 */
    bounds centroids; /* of twice the centroids */
} range;

enum { BVH_BINS = 16 };

typedef struct bins {
    bounds box[3][BVH_BINS];
    uint32_t count[3][BVH_BINS];
} bins;

/* A plane between bins; those below `bin` go left. */
typedef struct split {
    uint32_t axis, bin;
    uint32_t left;     /* the references on the left; 0: no plane parts them */
    float cost;        /* area times count, both sides */
    lanes base, scale; /* (centroid - base) * scale is the bin's number */
} split;

static inline lanes lanes_min(lanes a, lanes b)
{
#ifdef __SSE__
    return _mm_min_ps(a, b);
#else
    int_lanes less = a < b;
    return (lanes)(((int_lanes)a & less) | ((int_lanes)b & ~less));
#endif
}

static inline lanes lanes_max(lanes a, lanes b)
{
#ifdef __SSE__
    return _mm_max_ps(a, b);
#else
    int_lanes more = a > b;
    return (lanes)(((int_lanes)a & more) | ((int_lanes)b & ~more));
#endif
}

static inline bounds bounds_empty(void)
{
    return (bounds){{FLT_MAX, FLT_MAX, FLT_MAX, 0}, {-FLT_MAX, -FLT_MAX, -FLT_MAX, 0}};
}

static inline bounds bounds_union(bounds a, bounds b)
{
    return (bounds){lanes_min(a.lo, b.lo), lanes_max(a.hi, b.hi)};
}

static inline bounds bounds_add(bounds b, lanes point)
{
    return (bounds){lanes_min(b.lo, point), lanes_max(b.hi, point)};
}

/* Adds a point to sides[right]. By selects: memory chosen by `right` would be waited for. */
static inline void bounds_add_to(bounds sides[2], lanes point, bool right)
{
    const bounds none = bounds_empty();
    const int32_t bits = -(int32_t)right;
    const int_lanes p = (int_lanes)point, is_right = {bits, bits, bits, bits};
    const int_lanes lo = (int_lanes)none.lo, hi = (int_lanes)none.hi;
    sides[0].lo = lanes_min(sides[0].lo, (lanes)((p & ~is_right) | (lo & is_right)));
    sides[0].hi = lanes_max(sides[0].hi, (lanes)((p & ~is_right) | (hi & is_right)));
    sides[1].lo = lanes_min(sides[1].lo, (lanes)((p & is_right) | (lo & ~is_right)));
    sides[1].hi = lanes_max(sides[1].hi, (lanes)((p & is_right) | (hi & ~is_right)));
}

/* Half the surface. */
static inline float bounds_area(bounds b)
{
    lanes e = b.hi - b.lo;
    return e[0] * e[1] + e[1] * e[2] + e[2] * e[0];
}

/* Twice the centroid; the last lane is 0, as the index there may look like a subnormal. */
static inline lanes reference_centroid(const reference *r)
{
    const int_lanes xyz = {-1, -1, -1, 0};
    return (lanes)((int_lanes)(r->box.lo + r->box.hi) & xyz);
}

static inline int_lanes bin_of(lanes centroid, lanes base, lanes scale)
{
    return __builtin_convertvector((centroid - base) * scale, int_lanes);
}

/* Whether the reference goes right; in the arithmetic of bin_of. */
static inline bool split_side(const split *s, const reference *r)
{
    float centroid = r->lo[s->axis] + r->hi[s->axis];
    return (uint32_t)((centroid - s->base[s->axis]) * s->scale[s->axis]) >= s->bin;
}

/* The number of halvings that make one of count. */
static inline uint32_t bvh_halvings(uint32_t count)
{
    return count > 1 ? 32 - (uint32_t)__builtin_clz(count - 1) : 0;
}

/* Whether a node at `depth` can still hold count primitives below it by halving them. */
static inline bool bvh_fits(uint32_t depth, uint32_t count)
{
    return depth + bvh_halvings(count) < LR_BVH_MAX_DEPTH;
}

/* split.c */

/* The bins' positions for references with these centroids; all scales are 0 when no two bins
 * would part them. */
void bvh_bins_place(const bounds *centroids, split *s);
void bvh_bins_clear(bins *b);
void bvh_bins_add(bins *b, const split *s, const reference *references, uint32_t count);
void bvh_bins_merge(bins *b, const bins *other);

/* Completes the split that bvh_bins_place began with the cheapest plane. */
void bvh_bins_choose(const bins *b, split *s);

/* subtree.c */

typedef struct subtree {
    reference *references; /* of the whole input; the range's are reordered */
    lr_bvh_node *nodes;    /* room for 2 * count - 1; links of inner nodes count from here */
    uint32_t node_count;
    uint32_t depth; /* the deepest leaf's */
    uint32_t leaf_size;
    float box_cost;
} subtree;

/* Builds the nodes of a range and its descendants, one thread. */
void bvh_subtree_build(subtree *tree, const range *r);

/* The box of a node as bounds, and back. */
bounds bvh_node_bounds(const lr_bvh_node *node);
void bvh_node_set_bounds(lr_bvh_node *node, bounds b);

#endif
