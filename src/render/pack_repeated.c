/* Boxes that are there again and again. A ray that meets such a heap tests all that is in it, and
 * no tree parts it: lavapipe of Mesa 22.3 gives up at some 30,000 (docs/drivers.md). */
#include "render/pack_internal.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* From so many nodes on whose children have the same box. Until then it is not worth a search. */
#define HEAP_NODES 1000

static bool same_box(const lr_bvh_node *a, const lr_bvh_node *b)
{
    return memcmp(a->min, b->min, sizeof a->min) == 0 && memcmp(a->max, b->max, sizeof a->max) == 0;
}

bool lr_pack_has_heaps(const lr_bvh *bvh)
{
    uint32_t found = 0;
    for (uint32_t i = 0; i < bvh->node_count; i++)
        found += bvh->nodes[i].count == 0 && same_box(&bvh->nodes[i + 1], &bvh->nodes[i]) &&
                 same_box(&bvh->nodes[bvh->nodes[i].link], &bvh->nodes[i]);
    return found >= HEAP_NODES;
}

/* FNV-1a over the words of a box, with the high bits brought down. */
static size_t hash_box(const lr_bvh_box *box)
{
    uint32_t words[6];
    uint64_t hash = 14695981039346656037u;
    memcpy(words, box, sizeof words);
    for (int i = 0; i < 6; i++)
        hash = (hash ^ words[i]) * 1099511628211u;
    return (size_t)(hash ^ hash >> 32);
}

bool lr_pack_find_repeated(const lr_bvh_box *boxes, uint32_t count, lr_pack_hides hides,
                           const void *context, bool *hidden)
{
    size_t size = 16;
    while (size < 2 * (size_t)count)
        size *= 2;
    uint32_t *table = lr_alloc(size, sizeof *table); /* numbers from 1; 0: free */
    if (!table)
        return false;
    for (uint32_t i = 0; i < count; i++) {
        size_t slot = hash_box(&boxes[i]) & (size - 1);
        while (table[slot] && memcmp(&boxes[table[slot] - 1], &boxes[i], sizeof *boxes) != 0)
            slot = (slot + 1) & (size - 1);
        hidden[i] = table[slot] && hides(context, table[slot] - 1, i);
        /* Only the last of them is kept, so that the search stays short. */
        if (!hidden[i])
            table[slot] = i + 1;
    }
    free(table);
    return true;
}
