/* What moves while the shutter is open, against closed forms and against still pictures of the
 * moments that samples see. */
#include "gpu_tests.h"

#include "exact.spv.h"
#include "scene/load.h"

#define PI 3.14159265358979323846

static lr_scene *parse_at(const char *text, double frame)
{
    lr_scene *scene = NULL;
    char *report = NULL;
    lr_error error = {0};
    const lr_load_options options = {.frame = frame};
    if (lr_scene_parse_with(text, strlen(text), SOURCE_DIR "/scenes/test.yaml", &options, &scene,
                            &report, &error))
        fail_msg("%s\n%s\n%s", error.message, report ? report : "", text);
    return scene;
}

static picture render_at(lr_device *device, const char *text, double frame,
                         const lr_render_options *options)
{
    picture result;
    lr_error error = {0};
    lr_scene *scene = parse_at(text, frame);
    if (lr_render(device, scene, options, &result.image, &result.stats, &error))
        fail_msg("%s\n%s", error.message, text);
    lr_scene_destroy(scene);
    return result;
}

/* When a sample is taken: its number's digits to the base behind the point, backwards. */
static double time_of(uint32_t sample, uint32_t base)
{
    double time = 0, place = 1;
    for (; sample > 0; sample /= base)
        time += (place /= base) * (sample % base);
    return time;
}

/* ---- Closed forms -------------------------------------------------------------------------- */

static double overlap(double a0, double a1, double b0, double b1)
{
    return fmax(0, fmin(a1, b1) - fmax(a0, b0));
}

/* A wall of light 5 pixels wide that goes 20 pixels to the right: a trapezoid. */
static void test_linear(void **state)
{
    static const char world[] = "camera: {from: [0, 0, 8], to: [0, 0, 0], projection: "
                                "orthographic, height: 4, shutter: 0.5}\n"
                                "image: {width: 32, height: 4, samples: %u, integrator: %s}\n"
                                "background: 0\nambient: 0\nlights: []\n"
                                "objects: [{box: {min: [-14, -9, -1], max: [-9, 9, 1], translate: "
                                "{keys: {2: [0, 0, 0], 3: [40, 0, "
                                "0]}}, material: {color: 0, emission: 1}}}]\n";
    for (int whitted = 0; whitted < 2; whitted++) {
        uint32_t samples = whitted ? 729 : 1024;
        char text[1024];
        snprintf(text, sizeof text, world, samples, whitted ? "whitted" : "path");
        picture p = render_at(*state, text, 2, NULL);
        for (uint32_t x = 0; x < 32; x++) {
            double moments = 0, all = 0, steps = 4000;
            for (uint32_t i = 0; i < samples; i++) {
                double left = 2 + 20 * time_of(i, whitted ? 3 : 2);
                moments += overlap(x, x + 1, left, left + 5) / samples;
            }
            for (int i = 0; i < steps; i++)
                all += overlap(x, x + 1, 2 + 20 * (i + 0.5) / steps, 7 + 20 * (i + 0.5) / steps) /
                       steps;
            assert_near(moments, all, 0.001);
            for (uint32_t y = 0; y < 4; y++)
                assert_near(pixel_at(&p, x, y).g, all, 0.012);
        }
        free_picture(&p);
    }
}

/* A bar that turns by a right angle about its end: a point is covered as long as the bar takes to
 * go over it. */
static void test_turning(void **state)
{
    static const char world[] = "camera: {from: [16, 16, 8], to: [16, 16, 0], projection: "
                                "orthographic, height: 32, shutter: 1}\n"
                                "image: {width: 32, height: 32, samples: %u, integrator: %s}\n"
                                "background: 0\nambient: 0\nlights: []\n"
                                "objects: [{rectangle: {corner: [0, -3, 0], u: [40, 0, 0], v: [0, "
                                "6, 0], rotate: [0, 0, {keys: {0: "
                                "0, 1: 90}}], material: {color: 0, emission: 1}}}]\n";
    for (int whitted = 0; whitted < 2; whitted++) {
        char text[1024];
        snprintf(text, sizeof text, world, whitted ? 729 : 1024, whitted ? "whitted" : "path");
        picture p = render_at(*state, text, 0, NULL);
        for (uint32_t i = 8; i < 24; i++) { /* along an arc */
            double angle = i / 32.0 * PI / 2;
            uint32_t x = (uint32_t)(24 * cos(angle)), y = (uint32_t)(24 * sin(angle));
            double radius = hypot(x + 0.5, y + 0.5), covered = 2 * asin(3 / radius) / (PI / 2);
            assert_near(pixel_at(&p, x, 31 - y).g, covered, 0.012);
        }
        free_picture(&p);
    }
}

/* Light that goes up from 0 to 1: the mean of the moments, to the last digit. */
static void test_rising_light(void **state)
{
    static const char world[] =
        "camera: {from: [0, 0, 8], to: [0, 0, 0], projection: orthographic, height: 4, shutter: "
        "1}\n"
        "image: {width: 4, height: 4, integrator: %s}\nbackground: 0\nambient: 0\n"
        "lights: [%s]\n"
        "objects: [{rectangle: {corner: [-9, -9, 0], u: [18, 0, 0], v: [0, 18, 0], material: "
        "{%s}}}]\n";
    static const char lamp[] =
        "{directional: {direction: [0, 0, -1], intensity: {keys: {0: 0, 1: 1}}}}";
    const struct {
        const char *integrator, *light, *material;
        uint32_t samples;
    } cases[] = {
        {"path", "", "color: 0, emission: {keys: {0: 0, 1: 1}}", 64},
        {"path", "", "color: 0, emission: {keys: {0: 0, 1: 1}}", 50},
        {"path", lamp, "color: 1", 64},
        {"whitted", lamp, "color: 1, diffuse: 1", 81},
        {"whitted", "{directional: {direction: [0, 0, -1], color: {keys: {0: 0, 0.5: 1, 1: 0}}}}",
         "color: 1, diffuse: 1", 81},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[1024];
        double mean = 0;
        snprintf(text, sizeof text, world, cases[i].integrator, cases[i].light, cases[i].material);
        for (uint32_t k = 0; k < cases[i].samples; k++) {
            double t = time_of(k, strcmp(cases[i].integrator, "path") ? 3 : 2);
            mean += (i == 4 ? 1 - fabs(2 * t - 1) : t) / cases[i].samples;
        }
        picture p = render_at(*state, text, 0, &(lr_render_options){.samples = cases[i].samples});
        for (uint32_t k = 0; k < 16; k++)
            assert_near(pixel_at(&p, k % 4, k / 4).r, mean, 2e-7);
        free_picture(&p);
        if (i == 0)
            assert_near(mean, 63.0 / 128, 1e-15);
    }
}

/* ---- Still pictures ------------------------------------------------------------------------ */

#define SAMPLES 8

/* All that may move does. */
static const char everything[] =
    "camera: {from: {keys: {0: [0, 1, 6], 4: [3, 2, 6]}}, to: [0, 0.5, 0], fov: {keys: {0: 40, 2: "
    "50}}, "
    "aperture: 0.05, shutter: %g}\n"
    "image: {width: 48, height: 32, samples: 8, integrator: %s}\n"
    "background: {gradient: [{keys: {0: [0.2, 0.1, 0], 3: white}}, [0.4, 0.6, 1]]}\n"
    "ambient: {keys: {0: 0.1, 3: 0.3}}\n"
    "fog: {color: [0.5, 0.5, 0.5], density: {keys: {0: 0, 2: 0.02}}}\n"
    "materials:\n"
    "  glass: {diffuse: 0, transmit: 1, ior: {keys: {0: 1.2, 4: 1.8}}, fresnel: true}\n"
    "  paint: {color: {keys: {1: red, 2: [0.1, 0.2, 0.9]}}, reflect: {keys: {1: 0, 2: 0.4}}}\n"
    "lights:\n"
    "  - point: {position: {keys: {0: [-4, 5, 4], 3: [4, 5, 4]}}, intensity: {keys: {0: 10, 3: "
    "40}}}\n"
    "  - spot: {position: [3, 5, 2], direction: [-3, {keys: {0: -5, 3: -3}}, -2], angle: 30, "
    "intensity: 20}\n"
    "objects:\n"
    "  - plane: {material: {color: [0.7, 0.6, 0.5]}}\n"
    "  - sphere: {radius: 0.6, translate: {keys: {0: [-2, 0.6, 0], 3: [2, 0.6, 1]}}, material: "
    "glass}\n"
    "  - group:\n"
    "      rotate: [0, {keys: {0: 0, 3: 400}}, 0]\n"
    "      objects:\n"
    "        - box: {min: [0.7, 0, -0.3], max: [1.3, 0.9, 0.3], material: paint}\n"
    "        - mesh: {file: models/gem.obj, translate: [-1, 0.5, 0], scale: 0.5}\n"
    "  - mesh: {file: models/knot.ply, scale: 0.3, translate: [0, 1.4, -1]}\n";

/* Every sample is that of a scene that stands still as everything is in its moment. The order in
 * which surfaces are met may differ in the last bits, as a mesh that moves stands in a space of its
 * own. */
static void test_moments(void **state)
{
    for (int whitted = 0; whitted < 2; whitted++) {
        char blurred[4096], still[4096];
        const char *integrator = whitted ? "whitted" : "path";
        snprintf(blurred, sizeof blurred, everything, 0.75, integrator);
        snprintf(still, sizeof still, everything, 0.0, integrator);
        picture p = render_at(*state, blurred, 1, NULL);
        double *sums = calloc(48 * 32 * 3, sizeof *sums);
        for (uint32_t i = 0; i < SAMPLES; i++) {
            const lr_render_options one = {.sample_range = {i, 1}};
            picture q = render_at(*state, still, 1 + 0.75 * time_of(i, whitted ? 3 : 2), &one);
            for (uint32_t k = 0; k < 48 * 32 * 3; k++)
                sums[k] += (double)q.image.pixels[k] / SAMPLES;
            free_picture(&q);
        }
        uint32_t other = 0;
        for (uint32_t k = 0; k < 48 * 32 * 3; k++)
            other += fabs(sums[k] - (double)p.image.pixels[k]) > 1e-5 * (1 + sums[k]);
        if (other > 48 * 32 * 3 / 200)
            fail_msg("%s: %u values are not the mean of the moments", integrator, other);
        free(sums);
        free_picture(&p);
    }
}

/* The same bytes however the work is cut up, and whatever is told about it beside. */
static void test_invariance(void **state)
{
    const lr_render_options ways[] = {
        {.tile_size = 7},        {.tile_size = 32, .chunk_rays = 2000},
        {.single_rays = true},   {.leaf_size = 1},
        {.storage_loads = true}, {.checkpoint_seconds = 1},
        {.noise = 0.000001},     {.seconds = 1000},
    };
    for (int whitted = 0; whitted < 2; whitted++) {
        char text[4096];
        snprintf(text, sizeof text, everything, 0.75, whitted ? "whitted" : "path");
        picture p = render_at(*state, text, 1, NULL);
        for (size_t i = 0; i < sizeof ways / sizeof *ways - 2u * (size_t)whitted; i++) {
            lr_render_options way = ways[i];
            way.samples = SAMPLES;
            picture q = render_at(*state, text, 1, &way);
            assert_string_equal(q.stats.hash, p.stats.hash);
            free_picture(&q);
        }
        lr_scene *scene = parse_at(text, 1);
        lr_layers layers;
        picture q;
        lr_error error = {0};
        uint32_t all = (1u << LR_AOV_COUNT) - 1;
        if (lr_render_layers(*state, scene, NULL, all, &q.image, &layers, &q.stats, &error))
            fail_msg("%s", error.message);
        assert_string_equal(q.stats.hash, p.stats.hash);
        for (size_t k = 0; k < 48 * 32 * 3; k++) {
            const float *direct = layers.layers[LR_AOV_DIRECT].samples;
            const float *indirect = layers.layers[LR_AOV_INDIRECT].samples;
            assert_near(direct[k] + indirect[k], q.image.pixels[k], 1e-6 * (1 + q.image.pixels[k]));
        }
        lr_layers_free(&layers);
        free_picture(&q);
        lr_scene_destroy(scene);
        free_picture(&p);
    }
}

/* What the camera follows is as sharp as if both stood still, and the rest of the world goes by. */
static void test_following(void **state)
{
    static const char world[] =
        "camera: {from: %s, to: %s, projection: orthographic, height: 32, shutter: 0.5}\n"
        "image: {width: 32, height: 32, samples: 64, integrator: path}\n"
        "background: 0\nambient: 0\nlights: []\n"
        "objects:\n"
        "  - sphere: {radius: 5, translate: %s, material: {color: 0, emission: 1}}\n"
        "  - box: {min: [-64, -14, -1], max: [64, -12, 1], material: {color: 0, emission: 1}}\n"
        "  - box: {min: [0, 12, -1], max: [1, 14, 1], material: {color: 0, emission: 1}}\n";
    char text[2][1024];
    snprintf(text[0], sizeof text[0], world, "[0, 0, 8]", "[0, 0, 0]", "[0, 0, 0]");
    snprintf(text[1], sizeof text[1], world, "{keys: {0: [0, 0, 8], 1: [32, 0, 8]}}",
             "{keys: {0: [0, 0, 0], 1: [32, 0, 0]}}", "{keys: {0: [0, 0, 0], 1: [32, 0, 0]}}");
    picture still = render_at(*state, text[0], 0, NULL), p = render_at(*state, text[1], 0, NULL);
    for (uint32_t y = 4; y < 32; y++)
        for (uint32_t x = 0; x < 32; x++)
            assert_near(pixel_at(&p, x, y).g, pixel_at(&still, x, y).g, 2.0 / 64);
    assert_near(pixel_at(&still, 16, 2).g, 1, 0);
    for (uint32_t x = 2; x < 15; x++) /* a post of one pixel, on 16 of them */
        assert_near(pixel_at(&p, x, 2).g, 1.0 / 16, 2.0 / 64);
    free_picture(&still);
    free_picture(&p);
}

/* ---- Which way is taken -------------------------------------------------------------------- */

/* What rests while the shutter is open does not change the picture of a camera that moves. */
static void test_resting(void **state)
{
    static const char world[] =
        "camera: {from: {keys: {0: [0, 1, 5], 4: [4, 1, 5]}}, to: [0, 0, 0], shutter: %s}\n"
        "image: {width: 32, height: 20, samples: 8, exposure: {keys: {0: 0, 4: 3}}}\n"
        "objects: [{sphere: {translate: %s}}]\n";
    const struct {
        const char *shutter, *way;
        bool blurs;
    } cases[] = {
        {"0.5", "[0, 0, 0]", false},
        {"0.5", "{keys: {1.5: [0, 0, 0], 2: [9, 0, 0]}}", false},
        {"0.5", "{keys: {0: [-3, 0, 0], 1: [0, 0, 0], 2: [0, 0, 0], 3: [5, 0, 0]}}", false},
        {"0.5", "{keys: {1.4: [0, 0, 0], 2: [9, 0, 0]}}", true},
        {"0.5", "{keys: {0: [0, 0, 0], 1.2: [0, 0, 0], 1.3: [1, 0, 0], 1.4: [0, 0, 0]}}", true},
        {"0", "{keys: {1: [0, 0, 0], 2: [9, 0, 0]}}", false},
    };
    char hash[65];
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[1024];
        lr_scene_info info;
        snprintf(text, sizeof text, world, cases[i].shutter, cases[i].way);
        lr_scene *scene = parse_at(text, 1);
        lr_scene_get_info(scene, &info);
        assert_true(info.moves);
        assert_int_equal(info.blurs, cases[i].blurs);
        lr_scene_destroy(scene);
        picture p = render_at(*state, text, 1, NULL);
        if (i == 0)
            memcpy(hash, p.stats.hash, sizeof hash);
        assert_int_equal(strcmp(p.stats.hash, hash) == 0, i < 3);
        free_picture(&p);
    }
}

/* Scenes with another way, or that open their shutter for longer, are not taken for the same. */
static void test_fingerprint(void **state)
{
    (void)state;
    static const char *const ways[] = {"0.5: 0, 1: 360", "0.5: 0, 1: 720",
                                       "0.5: 0, 0.75: 90, 1: 360", "0.5: 0, 1.0: 360",
                                       "0.5: 0, 1: 360, 2: 5"};
    char hashes[6][65];
    for (int i = 0; i < 6; i++) {
        char text[512];
        snprintf(text, sizeof text,
                 "camera: {shutter: %g}\nobjects: [{sphere: {rotate: [0, 0, {keys: {%s}}]}}]\n",
                 i == 5 ? 0.75 : 1.0, ways[i % 5]);
        lr_scene *scene = parse_at(text, 0.5);
        lr_scene_facts facts;
        lr_scene_get_facts(scene, &facts);
        memcpy(hashes[i], facts.sha256, sizeof hashes[i]);
        lr_scene_destroy(scene);
        for (int k = 0; k < i; k++)
            assert_int_equal(strcmp(hashes[i], hashes[k]) == 0, i == 3 && k == 0);
    }
}

/* A moment in which the scene is none has its name told. */
static void test_bad_moment(void **state)
{
    picture p;
    lr_error error = {0};
    lr_scene *scene =
        parse_at("camera: {shutter: 1}\nimage: {width: 8, height: 8, samples: 4, integrator: "
                 "path}\nobjects: [{sphere: {scale: {keys: {0: 1, 1: -1}}}}]\n",
                 0);
    assert_int_equal(lr_render(*state, scene, NULL, &p.image, &p.stats, &error), LR_ERROR_SCENE);
    assert_non_null(strstr(error.message, "test.yaml:3:"));
    assert_non_null(strstr(error.message, "in frame 0.5 while the shutter is open"));
    assert_null(p.image.pixels);
    lr_explanation explanation;
    assert_int_equal(lr_explain(*state, scene,
                                &(lr_render_options){.integrator = LR_INTEGRATOR_WHITTED}, 4, 4, 0,
                                &explanation, &error),
                     LR_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "stand still"));
    lr_scene_destroy(scene);
}

/* Kernels are compiled once for all moments and frames, and not kept for ever. */
static void test_kept_programs(void **state)
{
    static const char world[] =
        "camera: {shutter: 1}\nimage: {width: 8, height: 8, samples: 8}\n"
        "objects: [{sphere: {translate: {keys: {0: [0, 0, 0], 9: [1, 0, 0]}}}}]\n";
    lr_device *device = *state;
    uint32_t programs = 0;
    for (uint32_t frame = 0; frame < 4; frame++) {
        picture p = render_at(device, world, frame, NULL);
        free_picture(&p);
        programs = frame ? programs : device->program_count;
        assert_int_not_equal(programs, 0);
        assert_int_equal(device->program_count, programs);
    }
    const VkDescriptorType types[] = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                      VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
    const lr_layout_desc layout_desc = {
        .types = types, .binding_count = 2, .push_size = sizeof(struct gpu_work), .set_count = 1};
    lr_layout layout;
    VkPipeline taken[2], first = VK_NULL_HANDLE;
    MUST(lr_layout_create(device, &layout_desc, &layout, error));
    for (uint32_t i = 0; i < 100; i++) {
        const lr_program_desc desc = {exact_spv, sizeof exact_spv / 4, &i, 1};
        for (int k = 0; k < 2; k++)
            MUST(lr_program_take(device, &layout, &desc, &taken[k], error));
        assert_true(taken[0] == taken[1]);
        first = i ? first : taken[0];
        assert_true(i == 0 || taken[0] != first);
        lr_program_give_back(device, taken[0]);
        if (i) /* the first is in use all along */
            lr_program_give_back(device, taken[0]);
    }
    assert_int_equal(device->program_count, 49);
    uint32_t zero = 0;
    const lr_program_desc desc = {exact_spv, sizeof exact_spv / 4, &zero, 1};
    MUST(lr_program_take(device, &layout, &desc, &taken[0], error));
    assert_true(taken[0] == first);
    lr_layout_destroy(device, &layout);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_linear),
        cmocka_unit_test(test_turning),
        cmocka_unit_test(test_rising_light),
        cmocka_unit_test(test_moments),
        cmocka_unit_test(test_invariance),
        cmocka_unit_test(test_following),
        cmocka_unit_test(test_resting),
        cmocka_unit_test(test_fingerprint),
        cmocka_unit_test(test_bad_moment),
        cmocka_unit_test(test_kept_programs),
        cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device, NULL);
}
