/* The build as a whole: large ranges are cut level by level with all threads on each step, and what
 * is small enough becomes a task of one thread. Chunks, tasks and the order within them depend on
 * the input alone, and what threads find is put together by minimum, maximum and integer sums. */
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/status.h"
#include "bvh/bvh_internal.h"

enum {
    CHUNK = 1 << 12, /* references a thread takes at once while a level is cut */
    TASK = 1 << 12,  /* ranges of at most this many are one thread's work */
};

/* A node of the levels that are cut by all threads, or a task below them. */
typedef struct top_node {
    range range;
    split split;             /* of an inner node */
    uint32_t left;           /* its left child, the right one follows; 0: a task */
    uint32_t parity;         /* which of the two buffers holds the references */
    uint32_t nodes, depth;   /* of a task: what it has built */
    uint32_t size, position; /* of the whole subtree, in the finished order */
} top_node;

/* A piece of a top node's range. */
typedef struct chunk {
    uint32_t node, first, count;
    uint32_t left_at, right_at; /* where its references go */
    bounds left, right;         /* their centroids */
    bins bins;
} chunk;

typedef struct builder {
    const lr_bvh_box *boxes;
    uint32_t count, leaf_size, threads;
    float box_cost;
    float scale; /* of the references' coordinates, a power of two */
    reference *references[2];
    lr_bvh_node *nodes; /* of the tasks; one over range r begins at 2 * r.first */
    top_node *top;
    uint32_t top_count, top_capacity;
    uint32_t *tasks; /* top nodes */
    uint32_t task_count;
    chunk *chunks;
    uint32_t chunk_count;
    lr_bvh *bvh;
} builder;

/* ---- References --------------------------------------------------------------------------- */

/* What a chunk of the input says: the references' largest coordinate, their centroids, the first
 * bad box. */
typedef struct survey {
    float largest;
    uint32_t bad;
    bounds centroids;
} survey;

typedef struct survey_work {
    builder *builder;
    survey *surveys;
} survey_work;

static bool box_is_good(const lr_bvh_box *box)
{
    for (int axis = 0; axis < 3; axis++)
        if (!(box->min[axis] >= -FLT_MAX && box->min[axis] <= box->max[axis] &&
              box->max[axis] <= FLT_MAX))
            return false;
    return true;
}

static void survey_chunk(void *context, uint32_t part)
{
    const survey_work *work = context;
    const builder *b = work->builder;
    survey s = {.bad = UINT32_MAX, .centroids = bounds_empty()};
    bounds all = bounds_empty();
    uint32_t first = part * CHUNK;
    uint32_t end = b->count - first < CHUNK ? b->count : first + CHUNK;
    for (uint32_t i = first; i < end; i++) {
        const lr_bvh_box *box = &b->boxes[i];
        reference *r = &b->references[0][i];
        if (!box_is_good(box)) {
            s.bad = i;
            break;
        }
        for (int axis = 0; axis < 3; axis++) {
            r->lo[axis] = box->min[axis] * b->scale;
            r->hi[axis] = box->max[axis] * b->scale;
        }
        r->index = i;
        r->key = 0;
        all = bounds_union(all, r->box);
        s.centroids = bounds_add(s.centroids, reference_centroid(r));
    }
    for (int axis = 0; axis < 3; axis++)
        s.largest = fmaxf(s.largest, fmaxf(-all.lo[axis], all.hi[axis]));
    work->surveys[part] = s;
}

/* Fills the references and the root's range. */
static lr_status survey_input(builder *b, survey *surveys, uint32_t parts, survey *whole,
                              lr_error *error)
{
    survey_work work = {b, surveys};
    lr_run_parallel_on(b->threads, parts, survey_chunk, &work);
    *whole = (survey){.centroids = bounds_empty()};
    for (uint32_t i = 0; i < parts; i++) {
        if (surveys[i].bad != UINT32_MAX) {
            const lr_bvh_box *box = &b->boxes[surveys[i].bad];
            return lr_fail(error, LR_ERROR_ARGUMENT,
                           "the box of primitive %u is not finite or upside down: (%g, %g, %g) to "
                           "(%g, %g, %g); leave it out",
                           surveys[i].bad, (double)box->min[0], (double)box->min[1],
                           (double)box->min[2], (double)box->max[0], (double)box->max[1],
                           (double)box->max[2]);
        }
        whole->largest = fmaxf(whole->largest, surveys[i].largest);
        whole->centroids = bounds_union(whole->centroids, surveys[i].centroids);
    }
    return LR_OK;
}

/* Areas times counts must neither overflow nor vanish, so extraordinary coordinates are scaled. */
static lr_status make_references(builder *b, lr_error *error)
{
    uint32_t parts = (b->count - 1) / CHUNK + 1;
    survey whole, *surveys = lr_alloc(parts, sizeof *surveys);
    if (!surveys)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory");
    b->scale = 1;
    lr_status status = survey_input(b, surveys, parts, &whole, error);
    if (status == LR_OK && whole.largest > 0 &&
        (whole.largest > 0x1p40f || whole.largest < 0x1p-30f)) {
        int exponent = ilogbf(whole.largest);
        b->scale = ldexpf(1, exponent > 0 ? -exponent : exponent < -100 ? 100 : -exponent);
        status = survey_input(b, surveys, parts, &whole, error);
    }
    free(surveys);
    b->top[0].range = (range){.count = b->count, .centroids = whole.centroids};
    return status;
}

/* ---- The top, level by level -------------------------------------------------------------- */

static void bin_chunk(void *context, uint32_t part)
{
    const builder *b = context;
    chunk *c = &b->chunks[part];
    const top_node *node = &b->top[c->node];
    bvh_bins_clear(&c->bins);
    bvh_bins_add(&c->bins, &node->split, b->references[node->parity] + c->first, c->count);
}

/* Keeps the order on both sides. */
static void scatter_chunk(void *context, uint32_t part)
{
    const builder *b = context;
    chunk *c = &b->chunks[part];
    const top_node *node = &b->top[c->node];
    if (!node->left)
        return;
    const reference *from = b->references[node->parity] + c->first;
    reference *to = b->references[!node->parity];
    uint32_t at[2] = {c->left_at, c->right_at};
    bounds sides[2] = {bounds_empty(), bounds_empty()};
    for (uint32_t i = 0; i < c->count; i++) {
        bool right = split_side(&node->split, &from[i]);
        bounds_add_to(sides, reference_centroid(&from[i]), right);
        to[at[right]++] = from[i];
    }
    c->left = sides[0];
    c->right = sides[1];
}

static void cut_chunks(builder *b, uint32_t node)
{
    const range *r = &b->top[node].range;
    for (uint32_t done = 0; done < r->count; done += CHUNK) {
        uint32_t rest = r->count - done;
        b->chunks[b->chunk_count++] =
            (chunk){.node = node, .first = r->first + done, .count = rest < CHUNK ? rest : CHUNK};
    }
}

/* Chooses the node's split and makes its children, whose centroids are still unknown; without a
 * split the node stays a task. */
static bool split_node(builder *b, uint32_t index, chunk *chunks, uint32_t chunk_count)
{
    bins all;
    bvh_bins_clear(&all);
    for (uint32_t i = 0; i < chunk_count; i++)
        bvh_bins_merge(&all, &chunks[i].bins);
    split s = b->top[index].split;
    const range r = b->top[index].range;
    bvh_bins_choose(&all, &s);
    uint32_t larger = s.left > r.count - s.left ? s.left : r.count - s.left;
    if (s.left == 0 || !bvh_fits(r.depth + 1, larger))
        return true;
    if (!lr_array_reserve((void **)&b->top, b->top_count + 1, &b->top_capacity, sizeof *b->top))
        return false;
    top_node *node = &b->top[index];
    node->split = s;
    node->left = b->top_count;
    top_node *children = &b->top[b->top_count];
    b->top_count += 2;
    children[0] = children[1] = (top_node){.parity = !node->parity};
    children[0].range = (range){r.first, s.left, r.depth + 1, bounds_empty()};
    children[1].range = (range){r.first + s.left, r.count - s.left, r.depth + 1, bounds_empty()};
    uint32_t left_at = r.first, right_at = r.first + s.left;
    for (uint32_t i = 0; i < chunk_count; i++) {
        chunks[i].left_at = left_at;
        chunks[i].right_at = right_at;
        uint32_t left = 0;
        for (uint32_t bin = 0; bin < s.bin; bin++)
            left += chunks[i].bins.count[s.axis][bin];
        left_at += left;
        right_at += chunks[i].count - left;
    }
    return true;
}

/* Splits the nodes of one level, those from `begin` on, that are large enough. */
static bool split_level(builder *b, uint32_t begin)
{
    uint32_t end = b->top_count;
    b->chunk_count = 0;
    for (uint32_t i = begin; i < end; i++) {
        if (b->top[i].range.count <= TASK)
            continue;
        bvh_bins_place(&b->top[i].range.centroids, &b->top[i].split);
        cut_chunks(b, i);
    }
    lr_run_parallel_on(b->threads, b->chunk_count, bin_chunk, b);
    for (uint32_t i = 0, next; i < b->chunk_count; i = next) {
        for (next = i + 1; next < b->chunk_count && b->chunks[next].node == b->chunks[i].node;)
            next++;
        if (!split_node(b, b->chunks[i].node, &b->chunks[i], next - i))
            return false;
    }
    lr_run_parallel_on(b->threads, b->chunk_count, scatter_chunk, b);
    for (uint32_t i = 0; i < b->chunk_count; i++) {
        const chunk *c = &b->chunks[i];
        if (!b->top[c->node].left)
            continue;
        top_node *children = &b->top[b->top[c->node].left];
        children[0].range.centroids = bounds_union(children[0].range.centroids, c->left);
        children[1].range.centroids = bounds_union(children[1].range.centroids, c->right);
    }
    return true;
}

/* ---- Tasks -------------------------------------------------------------------------------- */

static void build_task(void *context, uint32_t part)
{
    const builder *b = context;
    top_node *node = &b->top[b->tasks[part]];
    const range *r = &node->range;
    subtree tree = {.references = b->references[node->parity],
                    .nodes = b->nodes + 2 * (size_t)r->first,
                    .leaf_size = b->leaf_size,
                    .box_cost = b->box_cost};
    bvh_subtree_build(&tree, r);
    for (uint32_t i = r->first; i < r->first + r->count; i++)
        b->bvh->order[i] = tree.references[i].index;
    node->nodes = tree.node_count;
    node->depth = tree.depth;
}

/* The sizes of subtrees and where they go: depth first, left before right. */
static void place_nodes(builder *b)
{
    for (uint32_t i = b->top_count; i-- > 0;) {
        top_node *node = &b->top[i];
        const top_node *left = &b->top[node->left];
        node->size = node->left ? 1 + left[0].size + left[1].size : node->nodes;
        if (!node->left && node->depth + 1 > b->bvh->depth)
            b->bvh->depth = node->depth + 1;
    }
    for (uint32_t i = 0; i < b->top_count; i++) {
        const top_node *node = &b->top[i];
        if (!node->left)
            continue;
        top_node *left = &b->top[node->left];
        left[0].position = node->position + 1;
        left[1].position = node->position + 1 + left[0].size;
    }
    b->bvh->node_count = b->top[0].size;
}

static void copy_task(void *context, uint32_t part)
{
    const builder *b = context;
    const top_node *node = &b->top[b->tasks[part]];
    const lr_bvh_node *from = b->nodes + 2 * (size_t)node->range.first;
    lr_bvh_node *to = b->bvh->nodes + node->position;
    for (uint32_t i = 0; i < node->nodes; i++) {
        to[i] = from[i];
        if (to[i].count == 0)
            to[i].link += node->position;
    }
}

static void set_union(lr_bvh_node *nodes, uint32_t i)
{
    bvh_node_set_bounds(&nodes[i], bounds_union(bvh_node_bounds(&nodes[i + 1]),
                                                bvh_node_bounds(&nodes[nodes[i].link])));
}

static void finish_top(const builder *b)
{
    for (uint32_t i = b->top_count; i-- > 0;) {
        const top_node *node = &b->top[i];
        if (!node->left)
            continue;
        lr_bvh_node *out = &b->bvh->nodes[node->position];
        out->link = b->top[node->left + 1].position;
        out->count = 0;
        out->axis = (uint16_t)node->split.axis;
        set_union(b->bvh->nodes, node->position);
    }
}

/* Scaling may have rounded: takes all boxes from the input. */
static void restore_boxes(const builder *b)
{
    lr_bvh_node *nodes = b->bvh->nodes;
    for (uint32_t i = b->bvh->node_count; i-- > 0;) {
        bounds all = bounds_empty();
        for (uint32_t k = 0; k < nodes[i].count; k++) {
            const lr_bvh_box *box = &b->boxes[b->bvh->order[nodes[i].link + k]];
            all = bounds_add(all, (lanes){box->min[0], box->min[1], box->min[2], 0});
            all = bounds_add(all, (lanes){box->max[0], box->max[1], box->max[2], 0});
        }
        if (nodes[i].count)
            bvh_node_set_bounds(&nodes[i], all);
        else
            set_union(nodes, i);
    }
}

/* Half the surface, in double, where it cannot overflow. */
static double node_area(const lr_bvh_node *node)
{
    double e[3];
    for (int axis = 0; axis < 3; axis++)
        e[axis] = (double)node->max[axis] - (double)node->min[axis];
    return e[0] * e[1] + e[1] * e[2] + e[2] * e[0];
}

/* ---- The whole ---------------------------------------------------------------------------- */

static lr_status check(uint32_t count, const lr_bvh_options *options, builder *b, lr_error *error)
{
    b->leaf_size = options && options->leaf_size ? options->leaf_size : 4;
    b->box_cost = options && options->box_cost != 0 ? options->box_cost : 1;
    b->threads = options ? options->threads : 0;
    if (b->leaf_size > LR_BVH_MAX_LEAF)
        return lr_fail(error, LR_ERROR_ARGUMENT, "a leaf of %u primitives; 1 to %u are possible",
                       b->leaf_size, LR_BVH_MAX_LEAF);
    if (!(b->box_cost > 0 && b->box_cost <= 1000))
        return lr_fail(error, LR_ERROR_ARGUMENT, "a box cost of %g; it lies above 0 and up to 1000",
                       (double)b->box_cost);
    if (count > LR_BVH_MAX_COUNT)
        return lr_fail(error, LR_ERROR_ARGUMENT, "%u primitives in one hierarchy; at most %u",
                       count, LR_BVH_MAX_COUNT);
    return LR_OK;
}

static bool allocate(builder *b)
{
    uint32_t pieces = b->count / CHUNK + b->count / TASK + 1;
    b->bvh->order = lr_alloc_large(b->count, sizeof *b->bvh->order);
    b->references[0] = lr_alloc_large(b->count, sizeof(reference));
    b->references[1] = b->count > TASK ? lr_alloc_large(b->count, sizeof(reference)) : NULL;
    b->nodes = lr_alloc_large(2 * (size_t)b->count, sizeof *b->nodes);
    b->chunks = b->count > TASK ? lr_alloc(pieces, sizeof *b->chunks) : NULL;
    return b->bvh->order && b->references[0] && (b->references[1] || b->count <= TASK) &&
           b->nodes && (b->chunks || b->count <= TASK) &&
           lr_array_reserve((void **)&b->top, 0, &b->top_capacity, sizeof *b->top);
}

static bool build_top(builder *b)
{
    b->top_count = 1;
    for (uint32_t begin = 0, end = 0; end < b->top_count; begin = end) {
        end = b->top_count;
        if (!split_level(b, begin))
            return false;
    }
    b->tasks = lr_alloc(b->top_count, sizeof *b->tasks);
    for (uint32_t i = 0; b->tasks && i < b->top_count; i++)
        if (!b->top[i].left)
            b->tasks[b->task_count++] = i;
    return b->tasks != NULL;
}

static bool build_tasks(builder *b)
{
    lr_run_parallel_on(b->threads, b->task_count, build_task, b);
    for (int i = 0; i < 2; i++) {
        free(b->references[i]);
        b->references[i] = NULL;
    }
    place_nodes(b);
    b->bvh->nodes = lr_alloc_large(b->bvh->node_count, sizeof *b->bvh->nodes);
    if (!b->bvh->nodes)
        return false;
    lr_run_parallel_on(b->threads, b->task_count, copy_task, b);
    finish_top(b);
    if (b->scale != 1)
        restore_boxes(b);
    return true;
}

lr_status lr_bvh_create(const lr_bvh_box *boxes, uint32_t count, const lr_bvh_options *options,
                        lr_bvh **bvh, lr_error *error)
{
    builder b = {.boxes = boxes, .count = count};
    *bvh = NULL;
    lr_status status = check(count, options, &b, error);
    if (status != LR_OK)
        return status;
    b.bvh = lr_alloc(1, sizeof *b.bvh);
    if (!b.bvh)
        goto no_memory;
    b.bvh->count = count;
    if (count > 0) {
        if (!allocate(&b))
            goto no_memory;
        status = make_references(&b, error);
        if (status != LR_OK)
            goto done;
        if (!build_top(&b) || !build_tasks(&b))
            goto no_memory;
    }
    *bvh = b.bvh;
    b.bvh = NULL;
    goto done;
no_memory:
    status =
        lr_fail(error, LR_ERROR_MEMORY, "out of memory for the hierarchy of %u primitives", count);
done:
    lr_bvh_destroy(b.bvh);
    for (int i = 0; i < 2; i++)
        free(b.references[i]);
    free(b.nodes);
    free(b.top);
    free(b.tasks);
    free(b.chunks);
    return status;
}

void lr_bvh_destroy(lr_bvh *bvh)
{
    if (!bvh)
        return;
    free(bvh->nodes);
    free(bvh->order);
    free(bvh);
}

double lr_bvh_cost(const lr_bvh *bvh, double box_cost)
{
    double sum = 0, root = bvh->node_count ? node_area(&bvh->nodes[0]) : 0;
    for (uint32_t i = 0; i < bvh->node_count; i++) {
        const lr_bvh_node *node = &bvh->nodes[i];
        sum += node_area(node) * (node->count ? node->count : box_cost != 0 ? box_cost : 1);
    }
    return root > 0 ? sum / root : 0;
}
