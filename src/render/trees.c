#include "render/trees.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/status.h"

static lr_kept_tree *find(const lr_trees *trees, const lr_bvh_box *boxes, uint32_t count,
                          uint32_t leaf_size)
{
    for (uint32_t i = 0; i < trees->count; i++) {
        lr_kept_tree *tree = &trees->items[i];
        if (tree->boxes && tree->bvh->count == count && tree->leaf_size == leaf_size &&
            memcmp(tree->boxes, boxes, count * sizeof *boxes) == 0)
            return tree;
    }
    return NULL;
}

static void free_tree(lr_kept_tree *tree)
{
    lr_bvh_destroy(tree->bvh);
    free(tree->boxes);
}

/* Without room for its boxes it is a tree all the same, but not found again. */
static void keep_boxes(lr_kept_tree *tree, const lr_bvh_box *boxes, uint32_t count)
{
    tree->boxes = lr_alloc_large(count, sizeof *boxes);
    if (tree->boxes)
        memcpy(tree->boxes, boxes, count * sizeof *boxes);
}

lr_status lr_trees_get(lr_trees *trees, const lr_bvh_box *boxes, uint32_t count,
                       const lr_bvh_options *options, const lr_bvh **bvh, lr_error *error)
{
    lr_kept_tree *tree = trees->keep ? find(trees, boxes, count, options->leaf_size) : NULL;
    *bvh = NULL;
    if (!tree) {
        if (!lr_array_reserve((void **)&trees->items, trees->count, &trees->capacity,
                              sizeof *trees->items))
            return lr_fail(error, LR_ERROR_MEMORY, "out of memory for the scene's trees");
        tree = &trees->items[trees->count];
        *tree = (lr_kept_tree){.leaf_size = options->leaf_size};
        lr_status status = lr_bvh_create(boxes, count, options, &tree->bvh, error);
        if (status)
            return status;
        trees->count++;
        if (trees->keep)
            keep_boxes(tree, boxes, count);
    }
    tree->used = true;
    *bvh = tree->bvh;
    return LR_OK;
}

void lr_trees_sweep(lr_trees *trees)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < trees->count; i++) {
        if (trees->items[i].used) {
            trees->items[kept] = trees->items[i];
            trees->items[kept++].used = false;
        } else {
            free_tree(&trees->items[i]);
        }
    }
    trees->count = kept;
}

void lr_trees_free(lr_trees *trees)
{
    for (uint32_t i = 0; i < trees->count; i++)
        free_tree(&trees->items[i]);
    free(trees->items);
    *trees = (lr_trees){.keep = trees->keep};
}
