/* Where to cut: centroids in bins, and the plane between bins that the heuristic likes best. */
#include "bvh/bvh_internal.h"

/* From so many references on, neighbours go into bins of their own, as those in the same one would
 * wait for each other. */
#define PAIRED 128

void bvh_bins_place(const bounds *centroids, split *s)
{
    lanes extent = centroids->hi - centroids->lo;
    *s = (split){.base = centroids->lo};
    /* A little less than BVH_BINS, so that rounding cannot reach the bin behind the last. */
    for (int axis = 0; axis < 3; axis++)
        s->scale[axis] = extent[axis] > 1e-30f ? BVH_BINS * 0.99999f / extent[axis] : 0;
}

void bvh_bins_clear(bins *b)
{
    for (int axis = 0; axis < 3; axis++) {
        for (int i = 0; i < BVH_BINS; i++) {
            b->box[axis][i] = bounds_empty();
            b->count[axis][i] = 0;
        }
    }
}

static inline void add_reference(bins *b, const split *s, const reference *r)
{
    int_lanes bin = bin_of(reference_centroid(r), s->base, s->scale);
    for (int axis = 0; axis < 3; axis++) {
        b->box[axis][bin[axis]] = bounds_union(b->box[axis][bin[axis]], r->box);
        b->count[axis][bin[axis]]++;
    }
}

void bvh_bins_add(bins *b, const split *s, const reference *references, uint32_t count)
{
    uint32_t done = 0;
    if (count >= PAIRED) {
        bins others;
        bvh_bins_clear(&others);
        for (; done + 1 < count; done += 2) {
            add_reference(b, s, &references[done]);
            add_reference(&others, s, &references[done + 1]);
        }
        bvh_bins_merge(b, &others);
    }
    for (; done < count; done++)
        add_reference(b, s, &references[done]);
}

void bvh_bins_merge(bins *b, const bins *other)
{
    for (int axis = 0; axis < 3; axis++) {
        for (int i = 0; i < BVH_BINS; i++) {
            b->box[axis][i] = bounds_union(b->box[axis][i], other->box[axis][i]);
            b->count[axis][i] += other->count[axis][i];
        }
    }
}

static void choose_on_axis(const bounds *box, const uint32_t *count, uint32_t axis, split *s)
{
    float right_cost[BVH_BINS];
    uint32_t right = 0, left = 0;
    bounds side = bounds_empty();
    for (int i = BVH_BINS - 1; i > 0; i--) {
        side = bounds_union(side, box[i]);
        right += count[i];
        right_cost[i] = right ? bounds_area(side) * (float)right : 0;
    }
    uint32_t total = right + count[0];
    side = bounds_empty();
    for (uint32_t i = 1; i < BVH_BINS; i++) {
        side = bounds_union(side, box[i - 1]);
        left += count[i - 1];
        if (left == 0 || left == total || count[i - 1] == 0)
            continue;
        float cost = bounds_area(side) * (float)left + right_cost[i];
        /* Boxes without area all cost nothing: then the evener split is better. */
        uint32_t best = s->left > total - s->left ? s->left : total - s->left;
        uint32_t larger = left > total - left ? left : total - left;
        if (s->left == 0 || cost < s->cost || (cost == s->cost && larger < best)) {
            s->axis = axis;
            s->bin = i;
            s->left = left;
            s->cost = cost;
        }
    }
}

void bvh_bins_choose(const bins *b, split *s)
{
    s->left = 0;
    for (uint32_t axis = 0; axis < 3; axis++)
        if (s->scale[axis] > 0)
            choose_on_axis(b->box[axis], b->count[axis], axis, s);
}
