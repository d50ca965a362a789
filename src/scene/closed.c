/* Whether triangles enclose a space, and which of their vertices are in the same place. */
#include "scene/import_internal.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

enum { BATCH = 16 }; /* vertices whose slots are fetched ahead */

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

/* The bits of a position, -0 as 0. By them NaN is equal to itself, so a file full of it is no
 * slower than others. */
static void position_bits(const float *positions, uint32_t vertex, uint32_t bits[3])
{
    for (int k = 0; k < 3; k++) {
        float value = positions[3 * (size_t)vertex + k] + 0.0f;
        memcpy(&bits[k], &value, sizeof value);
    }
}

static bool same_position(const float *positions, uint32_t a, uint32_t b)
{
    uint32_t bits[2][3];
    position_bits(positions, a, bits[0]);
    position_bits(positions, b, bits[1]);
    return memcmp(bits[0], bits[1], sizeof bits[0]) == 0;
}

/* The first vertex at the position of `vertex`. A slot holds high bits of a hash over the vertex's
 * number, which is one too many so that 0 is free; so hardly any other vertex is looked at. */
static uint32_t find_first(const float *positions, uint32_t vertex, uint64_t hash, uint64_t *slots,
                           size_t mask)
{
    const uint64_t high = hash & 0xFFFFFFFF00000000u;
    size_t slot = hash & mask;
    for (; slots[slot]; slot = (slot + 1) & mask) {
        uint32_t other = (uint32_t)slots[slot] - 1;
        if ((slots[slot] & 0xFFFFFFFF00000000u) == high && same_position(positions, other, vertex))
            return other;
    }
    slots[slot] = high | (vertex + 1u);
    return vertex;
}

uint32_t *lr_vertices_weld(const float *positions, uint32_t count)
{
    size_t size = table_size(count), mask = size - 1;
    uint32_t *first = lr_alloc_large(count, sizeof *first);
    uint64_t *slots = lr_alloc_large(size, sizeof *slots);
    if (!first || !slots)
        goto fail;
    memset(slots, 0, size * sizeof *slots);
    for (uint32_t done = 0, n; done < count; done += n) {
        uint64_t hashes[BATCH];
        n = count - done < BATCH ? count - done : BATCH;
        for (uint32_t i = 0; i < n; i++) {
            uint32_t bits[3];
            position_bits(positions, done + i, bits);
            hashes[i] = mix(mix(bits[0] | (uint64_t)bits[1] << 32) ^ bits[2]);
            __builtin_prefetch(&slots[hashes[i] & mask], 1);
        }
        for (uint32_t i = 0; i < n; i++)
            first[done + i] = find_first(positions, done + i, hashes[i], slots, mask);
    }
    free(slots);
    return first;
fail:
    free(first);
    free(slots);
    return NULL;
}

/* Triangles by their welded vertices; what is a line or a point takes no part. */
typedef struct surface {
    const uint32_t *first, *triangles;
    uint32_t vertex_count, triangle_count;
    uint32_t *begin;   /* of each vertex's corners; one more for the end */
    uint32_t *corners; /* 3 * triangle + k, vertex by vertex */
    uint32_t *seen;    /* the last vertex from which an edge led to this one */
} surface;

static bool welded_corners(const surface *s, uint32_t triangle, uint32_t v[3])
{
    for (int k = 0; k < 3; k++)
        v[k] = s->first[s->triangles[3 * (size_t)triangle + k]];
    return v[0] != v[1] && v[1] != v[2] && v[2] != v[0];
}

/* Sorts the corners by their vertices. */
static void collect_corners(surface *s)
{
    uint32_t v[3];
    for (uint32_t i = 0; i < s->triangle_count; i++)
        for (int k = 0; k < 3 && welded_corners(s, i, v); k++)
            s->begin[v[k]]++;
    for (uint32_t i = 0; i < s->vertex_count; i++)
        s->begin[i + 1] += s->begin[i];
    for (uint32_t i = s->triangle_count; i-- > 0;)
        for (int k = 0; k < 3 && welded_corners(s, i, v); k++)
            s->corners[--s->begin[v[k]]] = 3 * i + (uint32_t)k;
}

/* The vertex `step` corners after this one in its triangle. */
static uint32_t vertex_after(const surface *s, uint32_t corner, uint32_t step)
{
    return s->first[s->triangles[corner - corner % 3 + (corner % 3 + step) % 3]];
}

/* Whether no two edges lead from here to the same vertex, and for each that comes from a vertex one
 * leads there. As many come as go, so these are then the same vertices. */
static bool edges_paired(surface *s, uint32_t vertex)
{
    uint32_t begin = s->begin[vertex], end = s->begin[vertex + 1];
    for (uint32_t i = begin; i < end; i++) {
        uint32_t next = vertex_after(s, s->corners[i], 1);
        if (s->seen[next] == vertex)
            return false;
        s->seen[next] = vertex;
    }
    for (uint32_t i = begin; i < end; i++)
        if (s->seen[vertex_after(s, s->corners[i], 2)] != vertex)
            return false;
    return true;
}

bool lr_triangles_closed(const uint32_t *first, uint32_t vertex_count, const uint32_t *triangles,
                         uint32_t triangle_count, bool *closed)
{
    surface s = {
        .first = first,
        .triangles = triangles,
        .vertex_count = vertex_count,
        .triangle_count = triangle_count,
        .begin = lr_alloc(vertex_count + (size_t)1, sizeof *s.begin),
        .corners = lr_alloc_large(3 * (size_t)triangle_count, sizeof *s.corners),
        .seen = lr_alloc_large(vertex_count, sizeof *s.seen),
    };
    bool done = s.begin && s.corners && s.seen;
    if (done) {
        memset(s.seen, 0xFF, vertex_count * sizeof *s.seen);
        collect_corners(&s);
        *closed = s.begin[vertex_count] > 0;
        for (uint32_t i = 0; i < vertex_count && *closed; i++)
            *closed = edges_paired(&s, i);
    }
    free(s.begin);
    free(s.corners);
    free(s.seen);
    return done;
}
