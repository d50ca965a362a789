/* The trees of a scene, kept from one packing to the next: one over the same boxes with leaves of
 * the same size is taken instead of built, whatever else in the scene has changed. */
#ifndef LR_RENDER_TREES_H
#define LR_RENDER_TREES_H

#include "bvh/bvh.h"

typedef struct lr_kept_tree {
    lr_bvh *bvh;
    lr_bvh_box *boxes; /* what it was built over; NULL when it is not to be found again */
    uint32_t leaf_size;
    bool used; /* since the last sweep */
} lr_kept_tree;

/* Zeroed is empty; 24 bytes a primitive beside the trees themselves. For one packing at a time. */
typedef struct lr_trees {
    lr_kept_tree *items;
    uint32_t count, capacity;
    bool keep; /* for another packing: boxes are kept too */
} lr_trees;

/* The tree over the boxes, built if there is none; it belongs to `trees`. Errors are those of
 * lr_bvh_create. */
lr_status lr_trees_get(lr_trees *trees, const lr_bvh_box *boxes, uint32_t count,
                       const lr_bvh_options *options, const lr_bvh **bvh, lr_error *error);

/* Frees what was not used since the last sweep. */
void lr_trees_sweep(lr_trees *trees);
void lr_trees_free(lr_trees *trees);

#endif
