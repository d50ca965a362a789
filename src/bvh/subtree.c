/* One thread's share of a build: the nodes of a range of references, in depth-first order. */
#include <stdlib.h>

#include "bvh/bvh_internal.h"

/* Up to this many references every plane between two of them is tried instead of bins. */
enum { EXACT = 8 };

bounds bvh_node_bounds(const lr_bvh_node *node)
{
    return (bounds){{node->min[0], node->min[1], node->min[2], 0},
                    {node->max[0], node->max[1], node->max[2], 0}};
}

void bvh_node_set_bounds(lr_bvh_node *node, bounds b)
{
    for (int axis = 0; axis < 3; axis++) {
        node->min[axis] = b.lo[axis];
        node->max[axis] = b.hi[axis];
    }
}

static bounds range_bounds(const reference *references, uint32_t count)
{
    bounds b = references[0].box;
    for (uint32_t i = 1; i < count; i++)
        b = bounds_union(b, references[i].box);
    return b;
}

static bounds range_centroids(const reference *references, uint32_t count)
{
    bounds b = bounds_empty();
    for (uint32_t i = 0; i < count; i++)
        b = bounds_add(b, reference_centroid(&references[i]));
    return b;
}

static uint32_t widest_axis(const bounds *b)
{
    lanes e = b->hi - b->lo;
    return e[0] >= e[1] && e[0] >= e[2] ? 0 : e[1] >= e[2] ? 1 : 2;
}

static lr_bvh_node *new_node(subtree *tree, uint32_t depth)
{
    if (depth > tree->depth)
        tree->depth = depth;
    return &tree->nodes[tree->node_count++];
}

static bounds make_leaf(lr_bvh_node *node, const subtree *tree, const range *r)
{
    bounds b = range_bounds(tree->references + r->first, r->count);
    bvh_node_set_bounds(node, b);
    node->link = r->first;
    node->count = (uint16_t)r->count;
    node->axis = 0;
    return b;
}

static void make_inner(lr_bvh_node *node, bounds b, uint32_t right, uint32_t axis)
{
    bvh_node_set_bounds(node, b);
    node->link = right;
    node->count = 0;
    node->axis = (uint16_t)axis;
}

/* ---- When nothing better is left: halves of a sorted range -------------------------------- */

static int by_key(const void *a, const void *b)
{
    const reference *x = a, *y = b;
    if (x->key != y->key)
        return x->key < y->key ? -1 : 1;
    return x->index < y->index ? -1 : x->index > y->index;
}

static bounds build_halves(subtree *tree, const range *r, uint32_t axis)
{
    lr_bvh_node *node = new_node(tree, r->depth);
    if (r->count <= tree->leaf_size)
        return make_leaf(node, tree, r);
    range left = {.first = r->first, .count = (r->count + 1) / 2, .depth = r->depth + 1};
    range right = {
        .first = r->first + left.count, .count = r->count - left.count, .depth = r->depth + 1};
    bounds b = build_halves(tree, &left, axis);
    uint32_t at = tree->node_count;
    b = bounds_union(b, build_halves(tree, &right, axis));
    make_inner(node, b, at, axis);
    return b;
}

/* By centroids where they differ; primitives around one centre from the smallest to the largest. */
static bounds build_sorted(subtree *tree, const range *r, bool same_centroid)
{
    bounds centroids = range_centroids(tree->references + r->first, r->count);
    uint32_t axis = widest_axis(&centroids);
    for (uint32_t i = r->first; i < r->first + r->count; i++) {
        reference *ref = &tree->references[i];
        ref->key = same_centroid ? bounds_area(ref->box) : reference_centroid(ref)[axis];
    }
    qsort(tree->references + r->first, r->count, sizeof(reference), by_key);
    return build_halves(tree, r, axis);
}

/* ---- A few references: every plane -------------------------------------------------------- */

/* The places of the references in their order by centroid along axis, those of ties in the order
 * they have. Counting who comes before costs less than a sort's branches. */
static void sort_few(const reference *references, uint32_t count, uint32_t axis, uint8_t *places)
{
    float keys[EXACT];
    for (uint32_t i = 0; i < count; i++)
        keys[i] = references[i].lo[axis] + references[i].hi[axis];
    for (uint32_t i = 0; i < count; i++) {
        uint32_t rank = 0;
        for (uint32_t k = 0; k < i; k++)
            rank += keys[k] <= keys[i];
        for (uint32_t k = i + 1; k < count; k++)
            rank += keys[k] < keys[i];
        places[rank] = (uint8_t)i;
    }
}

static void split_two(reference *references, split *s)
{
    bounds centroids = range_centroids(references, 2);
    s->axis = widest_axis(&centroids);
    s->left = 1;
    s->cost = bounds_area(references[0].box) + bounds_area(references[1].box);
    if (references[1].lo[s->axis] + references[1].hi[s->axis] <
        references[0].lo[s->axis] + references[0].hi[s->axis]) {
        reference first = references[1];
        references[1] = references[0];
        references[0] = first;
    }
}

/* Finds the cheapest plane and sorts the references along its axis. */
static void split_few(reference *references, uint32_t count, split *s)
{
    uint8_t places[3][EXACT];
    *s = (split){0};
    if (count == 2) {
        split_two(references, s);
        return;
    }
    for (uint32_t axis = 0; axis < 3; axis++) {
        float right_cost[EXACT];
        sort_few(references, count, axis, places[axis]);
        bounds side = bounds_empty();
        for (uint32_t i = count - 1; i > 0; i--) {
            side = bounds_union(side, references[places[axis][i]].box);
            right_cost[i] = bounds_area(side) * (float)(count - i);
        }
        side = bounds_empty();
        for (uint32_t i = 1; i < count; i++) {
            side = bounds_union(side, references[places[axis][i - 1]].box);
            float cost = bounds_area(side) * (float)i + right_cost[i];
            if (s->left == 0 || cost < s->cost) {
                s->axis = axis;
                s->left = i;
                s->cost = cost;
            }
        }
    }
    reference sorted[EXACT];
    for (uint32_t i = 0; i < count; i++)
        sorted[i] = references[places[s->axis][i]];
    for (uint32_t i = 0; i < count; i++)
        references[i] = sorted[i];
}

/* ---- The ordinary case -------------------------------------------------------------------- */

static void find_split(const reference *references, const range *r, split *s)
{
    bins b;
    bvh_bins_place(&r->centroids, s);
    bvh_bins_clear(&b);
    bvh_bins_add(&b, s, references, r->count);
    bvh_bins_choose(&b, s);
}

/* Moves the left side's references before the right's and measures both sides' centroids. Branches
 * on the side would be guessed wrong half the time. */
static void partition(reference *references, uint32_t count, const split *s, range *left,
                      range *right)
{
    bounds sides[2] = {bounds_empty(), bounds_empty()};
    reference *end = references; /* of the left side */
    for (uint32_t i = 0; i < count; i++) {
        const reference r = references[i];
        bool is_right = split_side(s, &r);
        bounds_add_to(sides, reference_centroid(&r), is_right);
        references[i] = *end;
        *end = r;
        end += !is_right;
    }
    left->centroids = sides[0];
    right->centroids = sides[1];
}

static bounds build(subtree *tree, const range *r)
{
    reference *references = tree->references + r->first;
    split s;
    bool few = r->count <= EXACT;
    if (r->count == 1)
        return make_leaf(new_node(tree, r->depth), tree, r);
    if (few)
        split_few(references, r->count, &s);
    else
        find_split(references, r, &s);
    if (r->count <= tree->leaf_size) {
        float area = bounds_area(range_bounds(references, r->count));
        if (tree->box_cost * area + s.cost >= area * (float)r->count)
            return make_leaf(new_node(tree, r->depth), tree, r);
    }
    uint32_t larger = s.left > r->count - s.left ? s.left : r->count - s.left;
    if (s.left == 0 || !bvh_fits(r->depth + 1, larger))
        return build_sorted(tree, r, s.left == 0);

    range left = {.first = r->first, .count = s.left, .depth = r->depth + 1};
    range right = {.first = r->first + s.left, .count = r->count - s.left, .depth = r->depth + 1};
    if (!few)
        partition(references, r->count, &s, &left, &right);
    lr_bvh_node *node = new_node(tree, r->depth);
    bounds b = build(tree, &left);
    uint32_t at = tree->node_count;
    b = bounds_union(b, build(tree, &right));
    make_inner(node, b, at, s.axis);
    return b;
}

void bvh_subtree_build(subtree *tree, const range *r)
{
    tree->node_count = tree->depth = 0;
    build(tree, r);
}
