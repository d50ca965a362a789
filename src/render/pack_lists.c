/* The primitives kind by kind, in lists or in trees. */
#include "render/pack_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"

/* Up to so many bounded primitives, and no mesh, every ray tests the balls of all of them. */
#define UNSORTED_MAX 32

#define CANDIDATE_COST 24
#define LEAF_SIZE 2
#define TESTS_IN_TREES 48

static const uint32_t rows_of[LR_LIST_COUNT] = {
    [LR_SPHERES] = sizeof(struct gpu_sphere) / 16,   [LR_FLATS] = sizeof(struct gpu_flat) / 16,
    [LR_ELLIPSOIDS] = sizeof(struct gpu_solid) / 16, [LR_BOXES] = sizeof(struct gpu_solid) / 16,
    [LR_CONES] = sizeof(struct gpu_solid) / 16,      [LR_PLANES] = sizeof(struct gpu_plane) / 16,
};

static uint32_t leaf_reference(const lr_bvh_node *leaf, uint32_t first)
{
    return LR_NODE_LEAF | (uint32_t)(leaf->count - 1) << LR_NODE_COUNT_SHIFT | (first + leaf->link);
}

static vec3 pack_corner(const float corner[3])
{
    return (vec3){corner[0], corner[1], corner[2]};
}

/* A tree of one leaf has a root beside it all the same, whose other child no ray reaches. */
static uint32_t pack_lone_leaf(lr_packed_scene *packed, const lr_bvh_node *leaf, uint32_t first)
{
    const vec3 nowhere = {3e15f, 3e15f, 3e15f};
    struct gpu_node node = {
        .min0 = pack_corner(leaf->min),
        .child0 = leaf_reference(leaf, first),
        .max0 = pack_corner(leaf->max),
        .child1 = LR_NODE_LEAF | first,
        .min1 = nowhere,
        .max1 = nowhere,
    };
    return lr_pack_rows(packed, &node, LR_NODE_ROWS);
}

/* A hierarchy on its way into rows. */
typedef struct tree_packing {
    const lr_bvh_node *nodes;
    uint32_t node_count;
    const uint32_t *references; /* what stands for each node in its parent */
    struct gpu_node *out;       /* the inner nodes */
    uint32_t root;              /* the row of the first of them */
} tree_packing;

#define NODES_A_PART 32768

static void pack_nodes(void *context, uint32_t part)
{
    const tree_packing *t = context;
    uint64_t end = (uint64_t)(part + 1) * NODES_A_PART;
    for (uint32_t i = part * NODES_A_PART; i < t->node_count && i < end; i++) {
        if (t->nodes[i].count)
            continue;
        uint32_t right = t->nodes[i].link;
        const lr_bvh_node *children[2] = {&t->nodes[i + 1], &t->nodes[right]};
        t->out[(t->references[i] - t->root) / LR_NODE_ROWS] = (struct gpu_node){
            .min0 = pack_corner(children[0]->min),
            .child0 = t->references[i + 1],
            .max0 = pack_corner(children[0]->max),
            .child1 = t->references[right],
            .min1 = pack_corner(children[1]->min),
            .max1 = pack_corner(children[1]->max),
        };
    }
}

uint32_t lr_pack_tree(lr_packed_scene *packed, const lr_bvh *bvh, uint32_t first)
{
    const lr_bvh_node *nodes = bvh->nodes;
    if (nodes[0].count)
        return pack_lone_leaf(packed, &nodes[0], first);
    uint32_t *references = lr_alloc_large(bvh->node_count, sizeof *references), inner = 0;
    uint32_t root = packed->row_count;
    if (!references || !lr_pack_reserve(packed, (uint64_t)bvh->node_count / 2 * LR_NODE_ROWS)) {
        free(references);
        return UINT32_MAX;
    }
    for (uint32_t i = 0; i < bvh->node_count; i++)
        references[i] =
            nodes[i].count ? leaf_reference(&nodes[i], first) : root + LR_NODE_ROWS * inner++;
    tree_packing packing = {nodes, bvh->node_count, references,
                            (struct gpu_node *)(void *)&packed->rows[root], root};
    lr_run_parallel_on(packed->threads, (bvh->node_count - 1) / NODES_A_PART + 1, pack_nodes,
                       &packing);
    packed->row_count += LR_NODE_ROWS * inner;
    free(references);
    return root;
}

void lr_pack_reach(float *reach, const lr_bvh_box *box)
{
    for (int i = 0; i < 3; i++) {
        float low = fabsf(box->min[i]), high = fabsf(box->max[i]), most = low > high ? low : high;
        *reach = most > *reach ? most : *reach;
    }
}

void lr_pack_place(lr_places *places, const lr_bvh_box *box)
{
    places->count += 2;
    for (int i = 0; i < 3; i++) {
        double low = box->min[i], high = box->max[i];
        places->sum[i] += low + high;
        places->square_sum[i] += low * low + high * high;
    }
}

void lr_pack_add_places(lr_places *places, const lr_places *more)
{
    places->count += more->count;
    for (int i = 0; i < 3; i++) {
        places->sum[i] += more->sum[i];
        places->square_sum[i] += more->square_sum[i];
    }
}

void lr_pack_cells(lr_packed_scene *packed)
{
    float *from = &packed->frame.cells_from.x, *inverse = &packed->frame.inv_cell.x;
    const lr_places *p = &packed->places;
    for (int i = 0; i < 3 && p->count > 0; i++) {
        double mean = p->sum[i] / p->count;
        double square = p->square_sum[i] / p->count;
        double deviation = sqrt(fmax(square - mean * mean, 0)) + fabs(mean) * 1e-6 + 1e-20;
        from[i] = (float)(mean - 2 * deviation);
        inverse[i] = (float)((1 << LR_CELL_BITS) / (4 * deviation));
    }
}

lr_status lr_pack_build(const lr_packed_scene *packed, const lr_bvh_box *boxes, uint32_t count,
                        uint32_t leaf_size, const lr_bvh **bvh, lr_error *error)
{
    lr_bvh_options options = {.leaf_size = packed->leaf_size ? packed->leaf_size : leaf_size,
                              .threads = packed->threads};
    return lr_trees_get(packed->trees, boxes, count, &options, bvh, error);
}

/* A hierarchy over `count` members of a kind. */
static lr_status build_tree(lr_packed_scene *packed, const lr_primitive *primitives,
                            const uint32_t *members, uint32_t count, const lr_bvh **bvh,
                            lr_error *error)
{
    lr_bvh_box *boxes = lr_alloc(count, sizeof *boxes);
    if (!boxes)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for the scene's objects");
    for (uint32_t i = 0; i < count; i++) {
        boxes[i] = primitives[members[i]].box;
        lr_pack_reach(&packed->frame.reach, &boxes[i]);
        lr_pack_place(&packed->places, &boxes[i]);
    }
    lr_status status = lr_pack_build(packed, boxes, count, LEAF_SIZE, bvh, error);
    free(boxes);
    return status;
}

/* Packs the records of a kind: if it has many members in the order of the leaves of a tree, *bvh.
 */
static lr_status pack_kind(const lr_primitive *primitives, const uint32_t *members, uint32_t count,
                           lr_list_kind kind, gpu_list *list, const lr_bvh **bvh,
                           lr_packed_scene *packed, lr_error *error)
{
    bool tree = packed->constants[LR_SPEC_TREES] && kind != LR_PLANES && count > LR_LISTED_MAX;
    list->base = packed->row_count - rows_of[kind] * list->begin;
    packed->constants[LR_SPEC_SPHERES + kind] = count > 0;
    if (tree) {
        lr_status status = build_tree(packed, primitives, members, count, bvh, error);
        if (status)
            return status;
        packed->constants[LR_SPEC_SPHERE_TREE + kind] = 1;
    }
    for (uint32_t i = 0; i < count; i++) {
        const lr_primitive *p = &primitives[members[tree ? (*bvh)->order[i] : i]];
        if (lr_pack_rows(packed, &p->record, rows_of[kind]) == UINT32_MAX)
            return lr_fail(error, LR_ERROR_MEMORY, "out of memory for the scene's objects");
    }
    return LR_OK;
}

static bool pack_balls(const lr_primitive *primitives, const uint32_t *sorted,
                       lr_packed_scene *packed)
{
    packed->frame.balls = packed->row_count;
    bool fits = true;
    for (uint32_t i = 0; i < packed->frame.bounded && fits; i++)
        fits = lr_pack_rows(packed, &primitives[sorted[i]].ball, 1) != UINT32_MAX;
    return fits;
}

/* Whether rays do better to test all bounded primitives than to look for those whose balls they
 * meet first. A ray meets a ball of radius r in a scene of radius R with a probability of about
 * r^2 / R^2; a test that is looked for costs as much as CANDIDATE_COST of the others, measured on
 * scenes of 8 to 33 balls, boxes and rectangles of many sizes. */
static bool are_few(const lr_primitive *primitives, const uint32_t *sorted, uint32_t count)
{
    double center[3] = {0}, radius2 = 0, met = 0;
    for (uint32_t i = 0; i < count; i++) {
        const vec4 *ball = &primitives[sorted[i]].ball;
        center[0] += ball->x / (double)count;
        center[1] += ball->y / (double)count;
        center[2] += ball->z / (double)count;
    }
    for (uint32_t i = 0; i < count; i++) {
        const vec4 *ball = &primitives[sorted[i]].ball;
        double x = ball->x - center[0], y = ball->y - center[1], z = ball->z - center[2];
        radius2 = fmax(radius2, x * x + y * y + z * z + ball->w);
    }
    for (uint32_t i = 0; i < count; i++)
        met += primitives[sorted[i]].ball.w / radius2;
    return met * CANDIDATE_COST >= count;
}

/* LR_SPEC_FEW: whether paths test all primitives, and how many there are of each kind. */
static void note_few(const lr_primitive *primitives, const uint32_t *sorted,
                     lr_packed_scene *packed)
{
    const struct gpu_frame *f = &packed->frame;
    uint32_t *use = packed->constants;
    uint32_t planes = f->planes.end - f->planes.begin, spheres = f->spheres.end - f->spheres.begin;
    uint32_t flats = f->flats.end - f->flats.begin, solids = f->solids.end - f->solids.begin;
    if (!use[LR_SPEC_PATH] || use[LR_SPEC_TRANSPARENT] || planes > LR_FEW_PLANES ||
        spheres > LR_FEW_SPHERES || flats > LR_FEW_FLATS || solids > LR_FEW_SOLIDS ||
        !are_few(primitives, sorted, f->bounded))
        return;
    use[LR_SPEC_FEW] = 1;
    use[LR_SPEC_FEW_PLANES] = planes;
    use[LR_SPEC_FEW_SPHERES] = spheres;
    use[LR_SPEC_FEW_FLATS] = flats;
    use[LR_SPEC_FEW_SOLIDS] = solids;
}

static lr_status pack_sorted(const lr_primitive *primitives, const uint32_t *sorted,
                             const uint32_t *counts, const lr_bvh **trees, lr_packed_scene *packed,
                             lr_error *error)
{
    struct gpu_frame *frame = &packed->frame;
    gpu_list *lists[LR_LIST_COUNT] = {&frame->spheres, &frame->flats, &frame->ellipsoids,
                                      &frame->boxes,   &frame->cones, &frame->planes};
    uint32_t number = 0;
    for (lr_list_kind kind = LR_SPHERES; kind < LR_LIST_COUNT; kind++) {
        *lists[kind] = (gpu_list){.begin = number, .end = number + counts[kind]};
        lr_status status = pack_kind(primitives, sorted + number, counts[kind], kind, lists[kind],
                                     &trees[kind], packed, error);
        if (status)
            return status;
        number += counts[kind];
    }
    /* The solids' records stand together, so they have one base. */
    frame->solids =
        (gpu_list){frame->ellipsoids.base, frame->ellipsoids.begin, frame->cones.end, 0};
    frame->bounded = frame->planes.begin;
    bool fits = true;
    for (lr_list_kind kind = LR_SPHERES; kind < LR_LIST_COUNT && fits; kind++)
        if (trees[kind]) {
            lists[kind]->nodes = lr_pack_tree(packed, trees[kind], lists[kind]->begin);
            fits = lists[kind]->nodes != UINT32_MAX;
        }
    if (fits && !packed->constants[LR_SPEC_TREES]) {
        note_few(primitives, sorted, packed);
        fits = pack_balls(primitives, sorted, packed);
    }
    if (!fits)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for the scene's objects");
    return LR_OK;
}

lr_status lr_pack_lists(const lr_primitive *primitives, uint32_t count, lr_packed_scene *packed,
                        lr_error *error)
{
    uint32_t counts[LR_MESHES + 1] = {0}, begin[LR_MESHES + 1], at = 0;
    for (uint32_t i = 0; i < count; i++)
        counts[primitives[i].list]++;
    for (int kind = 0; kind <= LR_MESHES; kind++) {
        begin[kind] = at;
        at += counts[kind];
    }
    uint32_t bounded = at - counts[LR_PLANES] - counts[LR_MESHES];
    packed->constants[LR_SPEC_TREES] = counts[LR_MESHES] > 0 || bounded > UNSORTED_MAX;
    packed->tests_per_ray = packed->constants[LR_SPEC_TREES] ? TESTS_IN_TREES : count;
    uint32_t *sorted = lr_alloc(count, sizeof *sorted);
    if (!sorted)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for the scene's objects");
    for (uint32_t i = 0; i < count; i++)
        sorted[begin[primitives[i].list]++] = i;
    const lr_bvh *trees[LR_LIST_COUNT] = {NULL};
    lr_status status = pack_sorted(primitives, sorted, counts, trees, packed, error);
    free(sorted);
    return status;
}
