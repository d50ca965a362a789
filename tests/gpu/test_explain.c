/* The tree of rays behind a pixel: it adds up to the picture, for pixels of all kinds of scenes,
 * and says what is known of simple ones. */
#include "gpu_tests.h"

#include <glob.h>

#include "scene/moment.h"

static lr_scene *load(const char *path)
{
    lr_scene *scene = NULL;
    char *report = NULL;
    lr_error error = {0};
    if (lr_scene_load(path, NULL, &scene, &report, &error))
        fail_msg("%s: %s%s", path, error.message, report ? report : "");
    return scene;
}

static lr_scene *parse(const char *text)
{
    lr_scene *scene = NULL;
    char *report = NULL;
    lr_error error = {0};
    if (lr_scene_parse(text, strlen(text), "test.yaml", &scene, &report, &error))
        fail_msg("%s%s\n%s", error.message, report ? report : "", text);
    return scene;
}

static lr_explanation explain(lr_device *device, const lr_scene *scene,
                              const lr_render_options *options, uint32_t x, uint32_t y,
                              uint32_t sample)
{
    lr_explanation result;
    lr_error error = {0};
    if (lr_explain(device, scene, options, x, y, sample, &result, &error))
        fail_msg("pixel %u,%u: %s", x, y, error.message);
    return result;
}

/* ---- Sums ---------------------------------------------------------------------------------- */

static void add(uint64_t to[3], const uint64_t more[3])
{
    for (int c = 0; c < 3; c++)
        to[c] += more[c];
}

/* Every ray brings what it brings itself and what its children do, and the camera's ray the sample.
 */
static void check_tree(const lr_explanation *x)
{
    uint64_t leaves[3] = {0};
    assert_true(x->ray_count > 0);
    for (uint32_t i = 0; i < x->ray_count; i++) {
        const lr_explained_ray *ray = &x->rays[i];
        uint64_t sum[3] = {0};
        add(sum, ray->own_steps);
        add(sum, ray->fog_steps);
        for (uint32_t l = 0; l < ray->light_count; l++)
            add(sum, x->lights[ray->first_light + l].steps);
        add(leaves, sum);
        for (uint32_t child = i + 1; child < x->ray_count; child++)
            if (x->rays[child].parent == i)
                add(sum, x->rays[child].steps);
        assert_memory_equal(sum, ray->steps, sizeof sum);
        assert_true(i == 0 ? ray->parent == LR_NO_INDEX : ray->parent < i);
        assert_true((i == 0) == (ray->kind == LR_RAY_CAMERA));
        if (ray->cut)
            assert_true(sum[0] + sum[1] + sum[2] == 0);
    }
    assert_memory_equal(leaves, x->sample_steps, sizeof leaves);
    assert_memory_equal(leaves, x->rays[0].steps, sizeof leaves);
}

/* All samples of pixels add up to what the picture shows there. Scenes that move while the shutter
 * is open cannot be explained: test_refusals. */
static void check_scene(lr_device *device, const char *path, bool single_rays)
{
    enum { WIDTH = 24, HEIGHT = 18, SAMPLES = 2 };
    lr_render_options options = {.width = WIDTH,
                                 .height = HEIGHT,
                                 .samples = SAMPLES,
                                 .single_rays = single_rays,
                                 .integrator = LR_INTEGRATOR_WHITTED};
    lr_scene *scene = load(path);
    if (lr_scene_blurs_any(scene)) {
        lr_scene_destroy(scene);
        return;
    }
    picture p;
    MUST(lr_render(device, scene, &options, &p.image, &p.stats, error));
    for (uint32_t i = 0; i < 3; i++) {
        uint32_t x = (7 * i + 3) % WIDTH, y = (5 * i + 7) % HEIGHT;
        uint64_t sum[3] = {0}, total[3];
        for (uint32_t sample = 0; sample < SAMPLES; sample++) {
            lr_explanation e = explain(device, scene, &options, x, y, sample);
            check_tree(&e);
            add(sum, e.sample_steps);
            memcpy(total, e.total_steps, sizeof total);
            assert_memory_equal(e.pixel, &p.image.pixels[3 * (WIDTH * y + x)], sizeof e.pixel);
            for (int c = 0; c < 3 && !e.saturated; c++)
                assert_true(e.pixel[c] == (float)(ldexp((double)total[c], -36) / SAMPLES));
            lr_explanation_free(&e);
        }
        assert_memory_equal(sum, total, sizeof sum);
    }
    free_picture(&p);
    lr_scene_destroy(scene);
}

static void test_sums(void **state)
{
    const char *const patterns[] = {SOURCE_DIR "/scenes/*.yaml",
                                    SOURCE_DIR "/tests/images/scenes/*.yaml",
                                    SOURCE_DIR "/tests/cli/scenes/round.nff"};
    for (size_t i = 0; i < sizeof patterns / sizeof *patterns; i++) {
        glob_t found;
        assert_int_equal(glob(patterns[i], 0, NULL, &found), 0);
        for (size_t k = 0; k < found.gl_pathc; k++)
            check_scene(*state, found.gl_pathv[k], false);
        globfree(&found);
    }
    check_scene(*state, SOURCE_DIR "/scenes/meshes.yaml", true);
}

/* ---- Known answers ------------------------------------------------------------------------- */

static lr_explanation explain_text(lr_device *device, const char *text,
                                   const lr_render_options *options)
{
    lr_scene *scene = parse(text);
    lr_render_options own = options ? *options : (lr_render_options){0};
    own.width = own.height = 1;
    lr_explanation result = explain(device, scene, &own, 0, 0, 0);
    check_tree(&result);
    lr_scene_destroy(scene);
    return result;
}

static void expect_vector(const float found[3], double x, double y, double z)
{
    const double expected[3] = {x, y, z};
    for (int i = 0; i < 3; i++)
        assert_near(found[i], expected[i], 2e-5);
}

static double light_of(uint64_t steps)
{
    return ldexp((double)steps, -LR_FILM_STEP_BITS);
}

static void expect_light(const uint64_t found[3], double r, double g, double b)
{
    const double expected[3] = {r, g, b};
    for (int i = 0; i < 3; i++)
        assert_near(light_of(found[i]), expected[i], 1e-6);
}

/* The camera looks down onto the floor's origin from (0, 6, 0); the light is at (3, 4, 0). */
#define FLOOR                                                                                      \
    "camera: {from: [0, 6, 0], to: [0, 0, 0], up: [0, 0, 1]}\nimage: {samples: 1}\n"               \
    "background: [0.25, 0.5, 1]\nambient: 0.125\n"                                                 \
    "lights:\n  - point: {position: [3, 4, 0], intensity: 50, falloff: 2}\n"                       \
    "objects:\n  - plane: {material: {color: [1, 0.5, 0.25], diffuse: 0.5, ambient: 1}}\n"

static void test_light_and_ambient(void **state)
{
    lr_explanation x = explain_text(*state, FLOOR, NULL);
    assert_int_equal(x.ray_count, 1);
    assert_int_equal(x.light_count, 1);
    const lr_explained_ray *ray = x.rays;
    expect_vector(ray->origin, 0, 6, 0);
    expect_vector(ray->direction, 0, -1, 0);
    expect_vector(ray->weight, 1, 1, 1);
    expect_vector(ray->weight_there, 1, 1, 1);
    assert_near(ray->t, 6, 1e-5);
    assert_near(ray->cosine, 1, 1e-6);
    expect_vector(ray->position, 0, 0, 0);
    expect_vector(ray->normal, 0, 1, 0);
    expect_vector(ray->color, 1, 0.5, 0.25);
    assert_int_equal(ray->object, 0);
    assert_true(ray->entering && ray->lit && !ray->hidden && !ray->hole);
    expect_light(ray->own_steps, 0.125, 0.0625, 0.03125);
    const lr_explained_light *light = x.lights;
    expect_vector(light->wi, 0.6, 0.8, 0);
    assert_near(light->distance, 5, 1e-5);
    assert_near(light->attenuation, 1 / 25.0, 1e-7);
    assert_near(light->cosine, 0.8, 1e-6);
    assert_true(light->spot == 1 && light->highlight == 0 && light->tested);
    expect_vector(light->arriving, 2, 2, 2);
    expect_vector(light->left, 1, 1, 1);
    assert_int_equal(light->obstacle_count, 0);
    expect_light(light->steps, 0.8, 0.4, 0.2); /* colour . diffuse . 2 . cos theta */
    lr_explanation_free(&x);
}

/* Two panes on the way of the light, and then a ball behind them. */
#define PANES                                                                                      \
    "  - disk: {center: [0.6, 0.8, 0], normal: [0.6, 0.8, 0], radius: 0.25, material: {transmit: " \
    "0.5}}\n"                                                                                      \
    "  - disk: {center: [1.2, 1.6, 0], normal: [0.6, 0.8, 0], radius: 0.25, material: {transmit: " \
    "[1, 0.5, 0]}}\n"
#define BALL "  - sphere: {center: [2.4, 3.2, 0], radius: 0.5}\n"

static void check_shadow(lr_device *device, const char *others, bool single_rays)
{
    char text[8192];
    lr_render_options options = {.single_rays = single_rays};
    snprintf(text, sizeof text, "%s%s%s", FLOOR, PANES, others);
    lr_explanation x = explain_text(device, text, &options);
    assert_int_equal(x.light_count, 1);
    assert_int_equal(x.lights[0].obstacle_count, 2);
    for (uint32_t i = 0; i < 2; i++) {
        assert_int_equal(x.obstacles[i].object, i + 1);
        assert_near(x.obstacles[i].distance, i + 1, 1e-4);
    }
    expect_vector(x.obstacles[0].left, 0.5, 0.5, 0.5);
    expect_vector(x.obstacles[1].left, 1, 0.5, 0);
    expect_vector(x.lights[0].left, 0.5, 0.25, 0);
    expect_light(x.lights[0].steps, 0.4, 0.1, 0);
    lr_explanation_free(&x);

    snprintf(text, sizeof text, "%s%s%s%s", FLOOR, PANES, BALL, others);
    x = explain_text(device, text, &options);
    assert_int_equal(x.lights[0].obstacle_count, 3);
    assert_int_equal(x.obstacles[2].object, 3);
    assert_near(x.obstacles[2].distance, 3.5, 1e-4);
    expect_vector(x.obstacles[2].left, 0, 0, 0);
    expect_vector(x.lights[0].left, 0, 0, 0);
    expect_light(x.lights[0].steps, 0, 0, 0);
    expect_vector(x.lights[0].unshadowed, 0.8, 0.4, 0.2);
    lr_explanation_free(&x);
}

/* So many objects elsewhere that the scene has trees. */
static void add_many(char *text, size_t size)
{
    for (int i = 0; i < 40; i++) {
        size_t used = strlen(text);
        snprintf(text + used, size - used, "  - sphere: {center: [%d, 0, 50], radius: 0.25}\n", i);
    }
}

static void test_shadows(void **state)
{
    char many[4096] = "";
    add_many(many, sizeof many);
    check_shadow(*state, "", false);
    check_shadow(*state, many, false);
    check_shadow(*state, many, true);
}

/* Two mirrors face each other: a chain of reflected rays, cut by the depth or the weight. */
#define CORRIDOR                                                                                   \
    "camera: {from: [0, 0, 5]}\nambient: 1\nlights: []\n"                                          \
    "materials: {mirror: {reflect: [0.5, 0.25, 0.125], color: 1, ambient: 0.25}}\n"                \
    "objects:\n  - plane: {normal: [0, 0, 1], material: mirror}\n"                                 \
    "  - plane: {normal: [0, 0, -1], offset: -10, material: mirror}\n"

static void check_corridor(lr_device *device, const char *image, lr_ray_cut cut)
{
    char text[2048];
    snprintf(text, sizeof text, "image: {samples: 1, %s}\n%s", image, CORRIDOR);
    lr_explanation x = explain_text(device, text, NULL);
    assert_int_equal(x.ray_count, 5);
    for (uint32_t i = 0; i < 5; i++) {
        const lr_explained_ray *ray = &x.rays[i];
        double weight = ldexp(1, -(int)i);
        expect_vector(ray->weight, weight, weight * weight, weight * weight * weight);
        assert_int_equal(ray->parent, i ? i - 1 : LR_NO_INDEX);
        assert_int_equal(ray->kind, i ? LR_RAY_REFLECTED : LR_RAY_CAMERA);
        assert_int_equal(ray->cut, i == 4 ? cut : LR_CUT_NONE);
        assert_int_equal(ray->depth, i);
        expect_vector(ray->direction, 0, 0, i % 2 ? 1 : -1);
        if (i < 4) {
            assert_int_equal(ray->object, i % 2);
            expect_light(ray->own_steps, weight / 4, weight * weight / 4, pow(weight, 3) / 4);
        }
    }
    lr_explanation_free(&x);
}

static void test_cuts(void **state)
{
    check_corridor(*state, "depth: 3", LR_CUT_DEPTH);
    check_corridor(*state, "depth: 9, min_weight: 0.1", LR_CUT_WEIGHT);
}

/* Straight into a glass ball: 4 % are reflected, the rest sees the background below. */
static void test_glass(void **state)
{
    lr_explanation x = explain_text(
        *state,
        "camera: {from: [0, 0, 5]}\nimage: {samples: 1, depth: 2}\nbackground: 1\nlights: []\n"
        "objects:\n  - sphere: {material: {transmit: 1, ior: 1.5, fresnel: true, diffuse: 0}}\n",
        NULL);
    /* Each bounce has two children, and those of the last are not traced. */
    const lr_ray_kind kinds[] = {LR_RAY_CAMERA,    LR_RAY_REFLECTED, LR_RAY_REFRACTED,
                                 LR_RAY_REFLECTED, LR_RAY_REFLECTED, LR_RAY_REFRACTED,
                                 LR_RAY_REFRACTED};
    const double weights[] = {1, 0.04, 0.96, 0.0384, 0.001536, 0.036864, 0.9216};
    const uint32_t parents[] = {LR_NO_INDEX, 0, 0, 2, 3, 3, 2};
    assert_int_equal(x.ray_count, 7);
    for (uint32_t i = 0; i < 7; i++) {
        assert_int_equal(x.rays[i].kind, kinds[i]);
        assert_int_equal(x.rays[i].parent, parents[i]);
        assert_int_equal(x.rays[i].cut, i == 4 || i == 5 ? LR_CUT_DEPTH : LR_CUT_NONE);
        expect_vector(x.rays[i].weight, weights[i], weights[i], weights[i]);
        assert_int_equal(x.rays[i].medium, i == 2 || i == 3 ? 0 : LR_NO_INDEX);
    }
    const lr_explained_ray *in = &x.rays[0], *out = &x.rays[2];
    assert_true(in->bends && in->fresnel && !in->total && in->entering && !out->entering);
    assert_near(in->reflectance, 0.04, 1e-6);
    assert_near(in->refracted_cosine, 1, 1e-6);
    assert_true(in->ior == 1 && in->ior_beyond == 1.5f && out->ior == 1.5f && out->ior_beyond == 1);
    assert_int_equal(in->medium_beyond, 0);
    assert_int_equal(out->medium_beyond, LR_NO_INDEX);
    expect_vector(x.rays[1].background, 0.04, 0.04, 0.04);
    expect_light(x.sample_steps, 0.9616, 0.9616, 0.9616);
    lr_explanation_free(&x);
}

static void test_total_reflection(void **state)
{
    lr_explanation x = explain_text(
        *state,
        "camera: {from: [-0.7, 0, -0.7], to: [0, 0, 0]}\nimage: {samples: 1, depth: 0}\n"
        "lights: []\nobjects:\n  - box: {min: [-9, -9, -9], max: [9, 9, 0], material: "
        "{transmit: 1, diffuse: 0, ior: 1.5}}\n",
        NULL);
    assert_int_equal(x.ray_count, 2);
    assert_true(x.rays[0].total && x.rays[0].bends && !x.rays[0].entering);
    assert_near(x.rays[0].cosine, sqrt(0.5), 1e-6);
    assert_int_equal(x.rays[0].medium, 0);
    assert_int_equal(x.rays[1].kind, LR_RAY_REFLECTED);
    assert_int_equal(x.rays[1].cut, LR_CUT_DEPTH);
    expect_vector(x.rays[1].direction, sqrt(0.5), 0, -sqrt(0.5));
    expect_vector(x.rays[1].weight, 1, 1, 1);
    lr_explanation_free(&x);
}

/* Water within glass, which has priority: its two surfaces are passed. Absorption counts the way
 * through the glass. */
static void test_hidden_surfaces(void **state)
{
    lr_explanation x = explain_text(
        *state,
        "camera: {from: [0, 0, 9]}\nimage: {samples: 1}\nbackground: 1\nlights: []\nobjects:\n"
        "  - sphere: {radius: 2, material: {transmit: 1, ior: 1, diffuse: 0, priority: 1, "
        "absorption: 0.25}}\n"
        "  - sphere: {radius: 1, material: {transmit: 1, ior: 1, diffuse: 0}}\n",
        NULL);
    const lr_ray_kind kinds[] = {LR_RAY_CAMERA, LR_RAY_REFRACTED, LR_RAY_ONWARD, LR_RAY_ONWARD,
                                 LR_RAY_REFRACTED};
    const double lengths[] = {7, 1, 2, 1, LR_T_MAX};
    const uint32_t passed[] = {0, 0, 1, 2, 2};
    assert_int_equal(x.ray_count, 5);
    for (uint32_t i = 0; i < 5; i++) {
        assert_int_equal(x.rays[i].kind, kinds[i]);
        assert_int_equal(x.rays[i].hidden, i == 1 || i == 2);
        assert_int_equal(x.rays[i].passed, passed[i]);
        assert_int_equal(x.rays[i].medium, i == 0 || i == 4 ? LR_NO_INDEX : 0);
        assert_near(x.rays[i].t, lengths[i], 1e-4 * lengths[i]);
    }
    assert_near(x.rays[1].weight_there[0], exp(-0.25), 1e-5);
    assert_near(light_of(x.sample_steps[0]), exp(-1), 1e-5);
    lr_explanation_free(&x);
}

static void test_fog(void **state)
{
    lr_explanation x =
        explain_text(*state, "fog: {density: 0.125, color: [0.5, 1, 2]}\n" FLOOR, NULL);
    double left = exp(-0.75);
    expect_vector(x.rays[0].weight_there, left, left, left);
    expect_light(x.rays[0].fog_steps, 0.5 * (1 - left), 1 - left, 2 * (1 - left));
    expect_light(x.rays[0].own_steps, 0.125 * left, 0.0625 * left, 0.03125 * left);
    lr_explanation_free(&x);
}

/* Packets and single rays, texel and storage loads: the same explanation. */
static void test_ways_to_trace(void **state)
{
    const lr_render_options ways[] = {
        {0}, {.single_rays = true}, {.storage_loads = true}, {.leaf_size = 8}};
    lr_scene *scene = load(SOURCE_DIR "/scenes/meshes.yaml");
    lr_explanation first = {0};
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        lr_explanation x = explain(*state, scene, &ways[i], 480, 330, 1);
        if (i == 0) {
            first = x;
            assert_true(x.ray_count > 2 && x.light_count > 2 && x.obstacle_count > 0);
            continue;
        }
        assert_int_equal(x.ray_count, first.ray_count);
        assert_int_equal(x.light_count, first.light_count);
        assert_int_equal(x.obstacle_count, first.obstacle_count);
        assert_memory_equal(x.rays, first.rays, x.ray_count * sizeof *x.rays);
        assert_memory_equal(x.lights, first.lights, x.light_count * sizeof *x.lights);
        assert_memory_equal(x.obstacles, first.obstacles, x.obstacle_count * sizeof *x.obstacles);
        lr_explanation_free(&x);
    }
    lr_explanation_free(&first);
    lr_scene_destroy(scene);
}

static void test_refusals(void **state)
{
    lr_scene *scene = load(SOURCE_DIR "/scenes/first.yaml");
    lr_render_options options = {.width = 8, .height = 6, .samples = 3};
    lr_explanation x;
    lr_error error = {0};
    assert_int_equal(lr_explain(*state, scene, &options, 8, 0, 0, &x, &error), LR_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "8,0 is outside the picture of 8x6"));
    assert_int_equal(lr_explain(*state, scene, &options, 0, 6, 0, &x, &error), LR_ERROR_ARGUMENT);
    assert_int_equal(lr_explain(*state, scene, &options, 0, 0, 3, &x, &error), LR_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "no sample 3"));
    assert_true(!x.rays && !x.lights && !x.obstacles);
    lr_explanation_free(&x);
    lr_scene_destroy(scene);

    scene = load(SOURCE_DIR "/scenes/motion.yaml");
    options.integrator = LR_INTEGRATOR_WHITTED;
    assert_int_equal(lr_explain(*state, scene, &options, 0, 0, 0, &x, &error), LR_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "give it `shutter: 0`"));
    lr_scene_destroy(scene);
}

/* A pane between two mirrors doubles the rays with each bounce. */
static void test_too_large(void **state)
{
    lr_scene *scene = parse(
        "camera: {from: [0, 0, 1]}\nimage: {samples: 1, depth: 40, min_weight: 0}\nlights: []\n"
        "materials: {mirror: {reflect: 1}}\nobjects:\n"
        "  - plane: {normal: [0, 0, 1], offset: -2, material: mirror}\n"
        "  - plane: {normal: [0, 0, -1], offset: -2, material: mirror}\n"
        "  - rectangle: {corner: [-9, -9, 0], u: [18, 0, 0], v: [0, 18, 0], material: {reflect: "
        "0.5, transmit: 0.5}}\n");
    lr_render_options options = {.width = 1, .height = 1, .has_depth = true, .depth = 26};
    lr_explanation x;
    lr_error error = {0};
    assert_int_equal(lr_explain(*state, scene, &options, 0, 0, 0, &x, &error), LR_ERROR_MEMORY);
    assert_non_null(strstr(error.message, "--depth"));
    options.depth = 12;
    x = explain(*state, scene, &options, 0, 0, 0);
    check_tree(&x);
    assert_true(x.ray_count > 100);
    lr_explanation_free(&x);
    lr_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_light_and_ambient),
        cmocka_unit_test(test_shadows),
        cmocka_unit_test(test_cuts),
        cmocka_unit_test(test_glass),
        cmocka_unit_test(test_total_reflection),
        cmocka_unit_test(test_hidden_surfaces),
        cmocka_unit_test(test_fog),
        cmocka_unit_test(test_ways_to_trace),
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_too_large),
        cmocka_unit_test(test_sums),
        cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device, NULL);
}
