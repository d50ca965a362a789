/* What must hold of every hierarchy, for the tests and the fuzz target. */
#ifndef LR_TESTS_BVH_CHECK_H
#define LR_TESTS_BVH_CHECK_H

#include <math.h>
#include <stdlib.h>

#include "bvh/bvh.h"

static inline bool bvh_same_box(const lr_bvh_node *node, const lr_bvh_box *box)
{
    for (int k = 0; k < 3; k++)
        if (node->min[k] != box->min[k] || node->max[k] != box->max[k])
            return false;
    return true;
}

static inline void bvh_grow_box(lr_bvh_box *box, const float *min, const float *max)
{
    for (int k = 0; k < 3; k++) {
        box->min[k] = min[k] < box->min[k] ? min[k] : box->min[k];
        box->max[k] = max[k] > box->max[k] ? max[k] : box->max[k];
    }
}

/* Checks the subtree at index and returns what is wrong with it, or NULL; *end becomes the index
 * behind its last node, *next the place in `order` behind its last primitive. */
static inline const char *bvh_check_subtree(const lr_bvh *bvh, const lr_bvh_box *boxes,
                                            uint32_t leaf_size, uint32_t index, uint32_t level,
                                            uint32_t *end, uint32_t *next)
{
    if (index >= bvh->node_count)
        return "a link beyond the nodes";
    if (level > bvh->depth || level > LR_BVH_MAX_DEPTH)
        return "a path that is too long";
    const lr_bvh_node *node = &bvh->nodes[index];
    lr_bvh_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    if (node->count) {
        if (node->count > leaf_size || node->link != *next || node->count > bvh->count - *next)
            return "a leaf's range";
        for (uint32_t i = 0; i < node->count; i++) {
            const lr_bvh_box *member = &boxes[bvh->order[node->link + i]];
            bvh_grow_box(&box, member->min, member->max);
        }
        *next += node->count;
        *end = index + 1;
    } else {
        uint32_t children[2] = {index + 1, node->link}, right = 0;
        const char *problem =
            bvh_check_subtree(bvh, boxes, leaf_size, index + 1, level + 1, &right, next);
        if (!problem && right != node->link)
            problem = "a right child that does not follow the left one's subtree";
        if (!problem)
            problem = bvh_check_subtree(bvh, boxes, leaf_size, right, level + 1, end, next);
        if (problem)
            return problem;
        for (int i = 0; i < 2; i++)
            bvh_grow_box(&box, bvh->nodes[children[i]].min, bvh->nodes[children[i]].max);
    }
    if (node->axis > 2)
        return "an axis";
    return bvh_same_box(node, &box) ? NULL : "a box that is not the union of what it holds";
}

/* What is wrong with a hierarchy of these boxes, or NULL. */
static inline const char *bvh_problem(const lr_bvh *bvh, const lr_bvh_box *boxes, uint32_t count,
                                      uint32_t leaf_size)
{
    uint32_t end = 0, next = 0;
    if (bvh->count != count)
        return "the number of primitives";
    unsigned char *seen = calloc(count + 1, 1);
    bool once = seen != NULL;
    for (uint32_t i = 0; once && i < count; i++)
        once = bvh->order[i] < count && !seen[bvh->order[i]]++;
    free(seen);
    if (!once)
        return "a primitive that is missing or there twice";
    if (count == 0)
        return bvh->node_count || bvh->depth ? "nodes without a primitive" : NULL;
    const char *problem = bvh_check_subtree(bvh, boxes, leaf_size, 0, 1, &end, &next);
    if (!problem && (end != bvh->node_count || next != count))
        problem = "nodes or primitives that no path reaches";
    return problem;
}

#endif
