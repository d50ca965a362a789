/* Whether triangles enclose a space. */
#include "scene/import_internal.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Finalizer of MurmurHash3, by Austin Appleby: spreads all bits. */
static uint64_t mix(uint64_t x)
{
    x ^= x >> 33;
    x *= 0xFF51AFD7ED558CCDu;
    x ^= x >> 33;
    x *= 0xC4CEB9FE1A85EC53u;
    return x ^ x >> 33;
}

/* A power of two with room for twice the count. */
static size_t table_size(uint64_t count)
{
    size_t size = 16;
    while (size < 2 * count)
        size *= 2;
    return size;
}

/* Of each vertex, the first one at its position. NULL when memory is out. */
static uint32_t *weld(const float *positions, uint32_t count)
{
    size_t size = table_size(count), mask = size - 1;
    uint32_t *first = malloc(((size_t)count + 1) * sizeof *first);
    uint32_t *table = malloc(size * sizeof *table);
    if (!first || !table)
        goto fail;
    memset(table, 0xFF, size * sizeof *table);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t bits[3];
        for (int k = 0; k < 3; k++) {
            float value = positions[3 * (size_t)i + k] + 0.0f; /* -0 as 0 */
            memcpy(&bits[k], &value, sizeof value);
        }
        uint64_t hash = mix(mix(bits[0] | (uint64_t)bits[1] << 32) ^ bits[2]);
        size_t slot = hash & mask;
        for (; table[slot] != LR_NONE; slot = (slot + 1) & mask) {
            const float *a = &positions[3 * (size_t)table[slot]], *b = &positions[3 * (size_t)i];
            if (a[0] == b[0] && a[1] == b[1] && a[2] == b[2])
                break;
        }
        if (table[slot] == LR_NONE)
            table[slot] = i;
        first[i] = table[slot];
    }
    free(table);
    return first;
fail:
    free(first);
    free(table);
    return NULL;
}

/* A set of directed edges from << 32 | to. Never UINT64_MAX, which marks free slots. */
typedef struct edge_set {
    uint64_t *slots;
    size_t mask;
} edge_set;

static uint64_t *find_edge(const edge_set *set, uint64_t edge)
{
    size_t slot = mix(edge) & set->mask;
    while (set->slots[slot] != UINT64_MAX && set->slots[slot] != edge)
        slot = (slot + 1) & set->mask;
    return &set->slots[slot];
}

/* False when one of them is there already. */
static bool add_edges(edge_set *set, const uint32_t corners[3])
{
    for (int k = 0; k < 3; k++) {
        uint64_t edge = (uint64_t)corners[k] << 32 | corners[(k + 1) % 3];
        uint64_t *slot = find_edge(set, edge);
        if (*slot == edge)
            return false;
        *slot = edge;
    }
    return true;
}

bool lr_triangles_closed(const float *positions, uint32_t vertex_count, const uint32_t *triangles,
                         uint32_t triangle_count, bool *closed)
{
    *closed = false;
    size_t size = table_size(3 * (uint64_t)triangle_count);
    edge_set set = {malloc(size * sizeof *set.slots), size - 1};
    uint32_t *first = weld(positions, vertex_count);
    bool done = set.slots && first, paired = done && triangle_count > 0;
    if (done)
        memset(set.slots, 0xFF, size * sizeof *set.slots);
    uint64_t used = 0;
    for (uint32_t i = 0; paired && i < triangle_count; i++) {
        uint32_t corners[3];
        for (int k = 0; k < 3; k++)
            corners[k] = first[triangles[3 * (size_t)i + k]];
        /* What is a line or a point takes no part. */
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
            continue;
        paired = add_edges(&set, corners);
        used++;
    }
    for (size_t i = 0; paired && i < size; i++) {
        uint64_t edge = set.slots[i];
        if (edge != UINT64_MAX)
            paired = *find_edge(&set, edge << 32 | edge >> 32) != UINT64_MAX;
    }
    *closed = paired && used > 0;
    free(set.slots);
    free(first);
    return done;
}
