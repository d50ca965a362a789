/* The traversal that judges others: in double, one ray, no cleverness. */
#include <math.h>

#include "bvh/bvh.h"

/* Rounding of the slabs' and the primitives' t. */
#define SLACK 0x1p-20

typedef struct entry {
    uint32_t node;
    double near; /* where the ray enters the node's box */
} entry;

typedef struct ray_slopes {
    double inverse[3]; /* infinite for a component 0 */
} ray_slopes;

/* Where the ray enters the box; infinite when it misses. 0 * infinity, a ray within the plane of a
 * face, is NaN: it fails both comparisons and so restricts nothing. */
static double enter(const lr_bvh_node *node, const lr_bvh_ray *ray, const ray_slopes *slopes,
                    double t_max)
{
    double near = ray->t_min, far = t_max;
    for (int axis = 0; axis < 3; axis++) {
        double slope = slopes->inverse[axis], origin = ray->origin[axis];
        bool backwards = signbit(slope);
        double t_in = ((double)(backwards ? node->max : node->min)[axis] - origin) * slope;
        double t_out = ((double)(backwards ? node->min : node->max)[axis] - origin) * slope;
        if (t_in > near)
            near = t_in;
        if (t_out < far)
            far = t_out;
    }
    return near <= far + SLACK * fabs(far) ? near : INFINITY;
}

uint32_t lr_bvh_trace(const lr_bvh *bvh, const lr_bvh_ray *ray, lr_bvh_test test, void *context)
{
    entry stack[LR_BVH_MAX_DEPTH];
    ray_slopes slopes;
    uint32_t held = 0, tested = 1;
    double t_max = ray->t_max;
    for (int axis = 0; axis < 3; axis++)
        slopes.inverse[axis] = 1 / ray->direction[axis];
    if (bvh->node_count == 0)
        return 0;
    double near = enter(&bvh->nodes[0], ray, &slopes, t_max);
    if (near < INFINITY)
        stack[held++] = (entry){0, near};
    while (held > 0) {
        entry top = stack[--held];
        const lr_bvh_node *node = &bvh->nodes[top.node];
        if (top.near > t_max + SLACK * fabs(t_max))
            continue;
        for (uint32_t i = 0; i < node->count; i++)
            if (!test(context, bvh->order[node->link + i], &t_max))
                return tested;
        if (node->count)
            continue;
        entry a = {top.node + 1, enter(node + 1, ray, &slopes, t_max)};
        entry b = {node->link, enter(&bvh->nodes[node->link], ray, &slopes, t_max)};
        tested += 2;
        /* The nearer one is taken next; of equals the left one. */
        entry first = b.near < a.near ? b : a, second = b.near < a.near ? a : b;
        if (second.near < INFINITY)
            stack[held++] = second;
        if (first.near < INFINITY)
            stack[held++] = first;
    }
    return tested;
}
