/* The hierarchy's structure: complete, tight, bounded in depth and the same for any threads. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>
#include <cmocka.h>

#include "bvh_check.h"
#include "bvh_meshes.h"

/* The address space in use. */
static rlim_t mapped_bytes(void)
{
    unsigned long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    assert_non_null(file);
    assert_int_equal(fscanf(file, "%lu", &pages), 1);
    fclose(file);
    return (rlim_t)pages * (rlim_t)sysconf(_SC_PAGESIZE);
}

static lr_bvh *build(const lr_bvh_box *boxes, uint32_t count, const lr_bvh_options *options)
{
    lr_bvh *bvh = NULL;
    lr_error error = {0};
    if (lr_bvh_create(boxes, count, options, &bvh, &error) != LR_OK)
        fail_msg("%s", error.message);
    const char *problem =
        bvh_problem(bvh, boxes, count, options && options->leaf_size ? options->leaf_size : 4);
    if (problem)
        fail_msg("%u boxes: %s", count, problem);
    return bvh;
}

static void build_and_destroy(const lr_bvh_box *boxes, uint32_t count)
{
    for (uint32_t leaf = 1; leaf <= LR_BVH_MAX_LEAF; leaf += leaf < 2 ? 1 : 3) {
        lr_bvh_options options = {.leaf_size = leaf};
        lr_bvh_destroy(build(boxes, count, &options));
    }
}

static void test_few(void **state)
{
    (void)state;
    mesh m = mesh_soup(100, 0.3f, 1);
    for (uint32_t count = 0; count <= m.count; count++)
        build_and_destroy(m.boxes, count);
    lr_bvh *bvh = build(NULL, 0, NULL);
    assert_int_equal(bvh->node_count, 0);
    assert_true(lr_bvh_cost(bvh, 0) == 0);
    lr_bvh_destroy(bvh);
    bvh = build(m.boxes, 1, NULL);
    assert_int_equal(bvh->node_count, 1);
    assert_int_equal(bvh->depth, 1);
    lr_bvh_destroy(bvh);
    lr_bvh_destroy(NULL);
    mesh_free(&m);
}

static void test_meshes(void **state)
{
    (void)state;
    mesh m = mesh_terrain(187);
    build_and_destroy(m.boxes, m.count);
    mesh_free(&m);
    m = mesh_soup(200000, 0.01f, 2);
    build_and_destroy(m.boxes, m.count);
    mesh_free(&m);
}

/* Two boxes of area 6, side 1, one unit apart in a box of 3 x 1 x 1, whose area is 14: split, a ray
 * costs 1 + 6/14 + 6/14; as a leaf 2. */
static void test_cost(void **state)
{
    (void)state;
    const lr_bvh_box boxes[2] = {{{0, 0, 0}, {1, 1, 1}}, {{2, 0, 0}, {3, 1, 1}}};
    lr_bvh *bvh = build(boxes, 2, NULL);
    assert_int_equal(bvh->node_count, 3);
    assert_true(fabs(lr_bvh_cost(bvh, 0) - (1 + 12.0 / 14)) < 1e-12);
    assert_true(fabs(lr_bvh_cost(bvh, 3) - (3 + 12.0 / 14)) < 1e-12);
    lr_bvh_destroy(bvh);
    /* 1.2 + 12/14 > 2: one leaf. */
    bvh = build(boxes, 2, &(lr_bvh_options){.box_cost = 1.2f});
    assert_int_equal(bvh->node_count, 1);
    assert_true(lr_bvh_cost(bvh, 1.2) == 2);
    lr_bvh_destroy(bvh);
}

/* What a cut through the middle of the largest axis would cost is the least to expect. */
static void test_quality(void **state)
{
    (void)state;
    mesh m = mesh_terrain(187);
    lr_bvh *bvh = build(m.boxes, m.count, NULL);
    double cost = lr_bvh_cost(bvh, 0);
    if (!(cost < 30))
        fail_msg("the terrain's cost is %g", cost);
    assert_true(bvh->depth <= 24);
    lr_bvh_destroy(bvh);
    mesh_free(&m);
}

static void compare_builds(const lr_bvh_box *boxes, uint32_t count)
{
    lr_bvh *first = NULL;
    static const uint32_t threads[] = {1, 2, 3, 8, 16, 0};
    for (size_t i = 0; i < sizeof threads / sizeof *threads; i++) {
        lr_bvh *bvh = build(boxes, count, &(lr_bvh_options){.threads = threads[i]});
        if (!first) {
            first = bvh;
            continue;
        }
        assert_int_equal(bvh->node_count, first->node_count);
        assert_int_equal(bvh->depth, first->depth);
        assert_memory_equal(bvh->nodes, first->nodes, first->node_count * sizeof *first->nodes);
        assert_memory_equal(bvh->order, first->order, count * sizeof *first->order);
        lr_bvh_destroy(bvh);
    }
    lr_bvh_destroy(first);
}

static void test_threads(void **state)
{
    (void)state;
    mesh m = mesh_soup(150000, 0.02f, 3);
    compare_builds(m.boxes, m.count);
    /* Many ties, and zeros of either sign. */
    for (uint32_t i = 0; i < m.count; i++) {
        for (int k = 0; k < 3; k++) {
            m.boxes[i].min[k] = floorf(m.boxes[i].min[k] * 4) / 4;
            m.boxes[i].max[k] = m.boxes[i].min[k] + 0.25f;
            if (m.boxes[i].min[k] == 0 && mesh_hash(i) % 2)
                m.boxes[i].min[k] = -0.0f;
        }
    }
    compare_builds(m.boxes, m.count);
    mesh_free(&m);
}

/* Point boxes at ratio^i along the diagonal: bins of equal width part few from many. */
static void fill_exponential(lr_bvh_box *boxes, uint32_t count, double ratio)
{
    for (uint32_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            boxes[i].min[k] = boxes[i].max[k] = (float)(1e-37 * pow(ratio, i));
}

static void test_depth(void **state)
{
    (void)state;
    enum { COUNT = 40000 };
    lr_bvh_box *boxes = calloc(COUNT, sizeof *boxes);
    assert_non_null(boxes);
    static const double ratios[] = {1.004, 1.9, 17, 60};
    static const uint32_t counts[] = {COUNT, 265, 60, 40};
    for (int i = 0; i < 4; i++) {
        fill_exponential(boxes, counts[i], ratios[i]);
        build_and_destroy(boxes, counts[i]);
    }
    fill_deep_boxes(boxes, COUNT);
    lr_bvh_options options = {.leaf_size = 1};
    lr_bvh *bvh = build(boxes, COUNT, &options);
    assert_int_equal(bvh->depth, LR_BVH_MAX_DEPTH);
    lr_bvh_destroy(bvh);
    free(boxes);
}

static void test_coincident(void **state)
{
    (void)state;
    enum { COUNT = 100000 };
    lr_bvh_box *boxes = calloc(COUNT, sizeof *boxes);
    assert_non_null(boxes);
    build_and_destroy(boxes, COUNT);
    for (uint32_t i = 0; i < COUNT; i++)
        boxes[i] = (lr_bvh_box){{1, 2, 3}, {4, 5, 6}};
    build_and_destroy(boxes, COUNT);
    compare_builds(boxes, COUNT);
    /* Shells around one centre: the inner half must not be as large as the outer one. */
    for (uint32_t i = 0; i < COUNT; i++)
        for (int k = 0; k < 3; k++)
            boxes[i].min[k] = -(boxes[i].max[k] = (float)(1 + i * 7919 % COUNT));
    lr_bvh *bvh = build(boxes, COUNT, NULL);
    assert_int_equal(bvh->nodes[1].max[0], COUNT / 2);
    lr_bvh_destroy(bvh);
    free(boxes);
}

/* Flat, linear and extreme boxes; areas of these would overflow or vanish in float. */
static void test_extremes(void **state)
{
    (void)state;
    enum { COUNT = 30000 };
    lr_bvh_box *boxes = calloc(COUNT, sizeof *boxes);
    assert_non_null(boxes);
    static const float sizes[] = {FLT_MAX / 2, 1e30f, 1e-20f, 1e-37f, 1e-44f};
    for (int size = 0; size < 5; size++) {
        for (int flat = 0; flat < 4; flat++) {
            uint32_t seed = 5;
            for (uint32_t i = 0; i < COUNT; i++) {
                for (int k = 0; k < 3; k++) {
                    float at = k < flat ? 0 : 2 * mesh_random(&seed) - 1;
                    boxes[i].min[k] = at * sizes[size];
                    boxes[i].max[k] = (at + 0.01f * (float)(k >= flat)) * sizes[size];
                }
            }
            build_and_destroy(boxes, COUNT);
            lr_bvh *bvh = build(boxes, COUNT, NULL);
            /* Scaled, the boxes are cut as well as of ordinary size. */
            if (sizes[size] > 1e-30f && flat < 3)
                assert_true(bvh->depth < 40);
            lr_bvh_destroy(bvh);
        }
    }
    boxes[7] = (lr_bvh_box){{-FLT_MAX, -FLT_MAX, -FLT_MAX}, {FLT_MAX, FLT_MAX, FLT_MAX}};
    boxes[8] = (lr_bvh_box){{-1e-45f, 0, 0}, {1e-45f, 0, 0}};
    build_and_destroy(boxes, COUNT);
    free(boxes);
}

static void expect_refused(const lr_bvh_box *boxes, uint32_t count, const lr_bvh_options *options,
                           const char *message)
{
    lr_bvh *bvh = (lr_bvh *)&count;
    lr_error error = {0};
    assert_int_equal(lr_bvh_create(boxes, count, options, &bvh, &error), LR_ERROR_ARGUMENT);
    assert_null(bvh);
    if (!strstr(error.message, message))
        fail_msg("'%s' does not say '%s'", error.message, message);
    assert_int_equal(lr_bvh_create(boxes, count, options, &bvh, NULL), LR_ERROR_ARGUMENT);
}

static void test_refused(void **state)
{
    (void)state;
    mesh m = mesh_soup(50000, 0.1f, 6);
    static const uint32_t at[] = {49999, 31234, 17};
    static const float bad[] = {NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 3; i++) {
        char message[40];
        m.boxes[at[i]].max[i] = bad[i];
        snprintf(message, sizeof message, "primitive %u ", at[i]);
        expect_refused(m.boxes, m.count, NULL, message);
    }
    m.boxes[3].min[1] = 2;
    expect_refused(m.boxes, m.count, NULL, "primitive 3 is not finite or upside down");
    m.boxes[2].min[2] = NAN;
    expect_refused(m.boxes, m.count, NULL, "primitive 2 ");
    expect_refused(m.boxes, 1, &(lr_bvh_options){.leaf_size = 9}, "a leaf of 9");
    expect_refused(m.boxes, 1, &(lr_bvh_options){.box_cost = -1}, "box cost of -1");
    expect_refused(m.boxes, 1, &(lr_bvh_options){.box_cost = NAN}, "box cost");
    expect_refused(m.boxes, LR_BVH_MAX_COUNT + 1, NULL, "1073741825 primitives");
    mesh_free(&m);
}

/* With any limit on memory there is a hierarchy or a message. */
static void test_no_memory(void **state)
{
    (void)state;
#ifdef __SANITIZE_ADDRESS__
    skip(); /* it needs the address space itself */
#endif
    mesh m = mesh_soup(1500000, 0.1f, 6); /* too many for memory that was freed before */
    struct rlimit before, limited;
    assert_int_equal(getrlimit(RLIMIT_AS, &before), 0);
    int refused = 0;
    for (int megabytes = 0; megabytes < 300; megabytes += 30) {
        lr_bvh *bvh;
        lr_error error = {0};
        limited = before;
        limited.rlim_cur = mapped_bytes() + ((rlim_t)megabytes << 20);
        assert_int_equal(setrlimit(RLIMIT_AS, &limited), 0);
        lr_status status = lr_bvh_create(m.boxes, m.count, NULL, &bvh, &error);
        assert_int_equal(setrlimit(RLIMIT_AS, &before), 0);
        if (status == LR_OK)
            assert_null(bvh_problem(bvh, m.boxes, m.count, 4));
        else {
            assert_int_equal(status, LR_ERROR_MEMORY);
            assert_null(bvh);
            assert_non_null(strstr(error.message, "out of memory"));
            refused++;
        }
        lr_bvh_destroy(bvh);
    }
    assert_in_range(refused, 3, 9);
    mesh_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_few),        cmocka_unit_test(test_meshes),
        cmocka_unit_test(test_cost),       cmocka_unit_test(test_quality),
        cmocka_unit_test(test_threads),    cmocka_unit_test(test_depth),
        cmocka_unit_test(test_coincident), cmocka_unit_test(test_extremes),
        cmocka_unit_test(test_refused),    cmocka_unit_test(test_no_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
