/* Trees kept from one packing to the next: the rows are those of a packing without them, and only
 * what moved is built again. */
#include "scene_tests.h"

#include "render/pack.h"
#include "scene/load.h"

/* A line of spheres, a mesh shown once, another one shown so often that the instances have a tree.
 */
static lr_scene *make_scene(const char *color, double first_sphere, double knot, double last_gem,
                            const lr_scene *previous)
{
    static char text[8192];
    int used = snprintf(text, sizeof text,
                        "camera: {}\nmaterials: {m: {color: %s}}\nobjects:\n"
                        "- mesh: {file: models/knot.ply, material: m, translate: [%g, 0, 0]}\n",
                        color, knot);
    for (int i = 0; i < 40; i++)
        used += snprintf(text + used, sizeof text - (size_t)used,
                         "- sphere: {center: [%g, 0, -5], radius: 0.4}\n", i ? i : first_sphere);
    for (int i = 0; i < 10; i++)
        used += snprintf(text + used, sizeof text - (size_t)used,
                         "- mesh: {file: models/gem.obj, translate: [%g, 5, 0]}\n",
                         i < 9 ? i : last_gem);
    lr_scene *scene = NULL;
    char *report = NULL;
    lr_load_options options = {.previous = previous};
    lr_status status = lr_scene_parse_with(text, strlen(text), SOURCE_DIR "/scenes/s.yaml",
                                           &options, &scene, &report, NULL);
    if (status)
        fail_msg("%s", report ? report : "no scene");
    return scene;
}

static lr_packed_scene pack(const lr_scene *scene, uint32_t leaf_size, lr_trees *trees)
{
    lr_packed_scene packed;
    lr_error error = {0};
    lr_settings settings = {.width = 64,
                            .height = 48,
                            .samples = 1,
                            .camera = &scene->cameras[0],
                            .leaf_size = leaf_size,
                            .trees = trees};
    if (lr_pack_scene(scene, &settings, &packed, &error))
        fail_msg("%s", error.message);
    assert_null(packed.trees);
    return packed;
}

/* Packs with the trees and without, and returns how many of them are other ones than before. */
static uint32_t built(const lr_scene *scene, uint32_t leaf_size, lr_trees *trees)
{
    const lr_bvh *before[16];
    uint32_t before_count = trees->count, fresh = 0;
    assert_true(before_count <= 16);
    for (uint32_t i = 0; i < before_count; i++)
        before[i] = trees->items[i].bvh;
    lr_packed_scene a = pack(scene, leaf_size, trees), b = pack(scene, leaf_size, NULL);
    assert_int_equal(a.row_count, b.row_count);
    assert_memory_equal(a.rows, b.rows, a.row_count * sizeof *a.rows);
    assert_memory_equal(&a.frame, &b.frame, sizeof a.frame);
    assert_memory_equal(a.constants, b.constants, sizeof a.constants);
    lr_packed_scene_free(&a);
    lr_packed_scene_free(&b);
    /* The spheres, the knot, the gem, the instances. */
    assert_int_equal(trees->count, 4);
    for (uint32_t i = 0; i < trees->count; i++) {
        bool known = false;
        for (uint32_t k = 0; k < before_count; k++)
            known |= before[k] == trees->items[i].bvh;
        fresh += !known;
    }
    return fresh;
}

static void test_edits(void **state)
{
    (void)state;
    static const struct {
        const char *color;
        double first_sphere, knot, last_gem;
        uint32_t leaf_size, built;
    } edits[] = {
        {"red", 0, 0, 9, 0, 4},    /* the first packing */
        {"red", 0, 0, 9, 0, 0},    /* nothing */
        {"blue", 0, 0, 9, 0, 0},   /* a colour */
        {"blue", -9, 0, 9, 0, 1},  /* a sphere moves */
        {"blue", -9, 0, 99, 0, 1}, /* one that shows the gem moves, but not the gem */
        {"blue", -9, 1, 99, 0, 2}, /* the knot moves, which is brought into the world */
        {"blue", -9, 1, 99, 3, 4}, /* other leaves */
        {"red", -9, 1, 99, 3, 0},
    };
    lr_trees trees = {0};
    lr_scene *scene = NULL;
    for (size_t i = 0; i < sizeof edits / sizeof *edits; i++) {
        lr_scene *before = scene;
        scene = make_scene(edits[i].color, edits[i].first_sphere, edits[i].knot, edits[i].last_gem,
                           before);
        lr_scene_destroy(before);
        assert_int_equal(built(scene, edits[i].leaf_size, &trees), edits[i].built);
    }
    lr_trees_free(&trees);
    assert_int_equal(trees.count, 0);
    lr_scene_destroy(scene);
}

/* The difference of one bit in one box is seen. */
static void test_boxes(void **state)
{
    (void)state;
    enum { COUNT = 100 };
    lr_bvh_box boxes[COUNT];
    for (int i = 0; i < COUNT; i++)
        boxes[i] = (lr_bvh_box){{(float)i, 0, 0}, {(float)i + 1, 1, 1}};
    lr_trees trees = {.keep = true}, forgetful = {0};
    lr_bvh_options options = {.leaf_size = 2};
    const lr_bvh *first, *again;
    assert_int_equal(lr_trees_get(&trees, boxes, COUNT, &options, &first, NULL), LR_OK);
    assert_int_equal(lr_trees_get(&trees, boxes, COUNT, &options, &again, NULL), LR_OK);
    assert_ptr_equal(first, again);
    assert_int_equal(lr_trees_get(&trees, boxes, COUNT - 1, &options, &again, NULL), LR_OK);
    assert_ptr_not_equal(first, again);
    boxes[COUNT - 1].max[2] = nextafterf(1, 2);
    assert_int_equal(lr_trees_get(&trees, boxes, COUNT, &options, &again, NULL), LR_OK);
    assert_ptr_not_equal(first, again);
    boxes[3].min[0] = NAN;
    lr_error error = {0};
    assert_int_equal(lr_trees_get(&trees, boxes, COUNT, &options, &again, &error),
                     LR_ERROR_ARGUMENT);
    assert_null(again);
    assert_int_equal(trees.count, 3);
    lr_trees_sweep(&trees);
    assert_int_equal(trees.count, 3);
    lr_trees_sweep(&trees);
    assert_int_equal(trees.count, 0);
    boxes[3].min[0] = 3;
    assert_int_equal(lr_trees_get(&forgetful, boxes, COUNT, &options, &first, NULL), LR_OK);
    assert_null(forgetful.items[0].boxes);
    lr_trees_free(&forgetful);
    lr_trees_free(&trees);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_edits),
        cmocka_unit_test(test_boxes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
