/* Layers of what is known beforehand, and against the pictures that they belong to. */
#include "gpu_tests.h"

#include "render/spread.h"

#define ALL ((1u << LR_AOV_COUNT) - 1)

static const lr_integrator integrators[] = {LR_INTEGRATOR_WHITTED, LR_INTEGRATOR_PATH};

typedef struct layered {
    picture picture;
    lr_layers layers;
} layered;

static lr_status try_layers(lr_device *device, const char *text, const lr_render_options *options,
                            uint32_t wanted, layered *result, lr_error *error)
{
    lr_scene *scene = NULL;
    char *report = NULL;
    if (lr_scene_parse(text, strlen(text), "test.yaml", &scene, &report, error))
        fail_msg("%s\n%s\n%s", error->message, report ? report : "", text);
    lr_status status = lr_render_layers(device, scene, options, wanted, &result->picture.image,
                                        &result->layers, &result->picture.stats, error);
    lr_scene_destroy(scene);
    return status;
}

static layered render_layers(lr_device *device, const char *text, const lr_render_options *options,
                             uint32_t wanted)
{
    layered result;
    lr_error error = {0};
    if (try_layers(device, text, options, wanted, &result, &error))
        fail_msg("%s\n%s", error.message, text);
    return result;
}

static void free_layered(layered *l)
{
    free_picture(&l->picture);
    lr_layers_free(&l->layers);
}

static const void *samples_of(const layered *l, lr_aov aov)
{
    for (uint32_t i = 0; i < l->layers.count; i++)
        if (!strcmp(l->layers.layers[i].name, lr_aov_name(aov)))
            return l->layers.layers[i].samples;
    fail_msg("no layer %s", lr_aov_name(aov));
    return NULL;
}

static const float *floats_of(const layered *l, lr_aov aov)
{
    return samples_of(l, aov);
}

static size_t pixels_of(const layered *l)
{
    return (size_t)l->picture.image.width * l->picture.image.height;
}

/* Pinhole rays through the middles of 3 x 3 pixels, one metre apart at distance 1.5: the sphere
 * stands in the middle one, the floor below it, nothing above. */
static void test_what_is_seen(void **state)
{
    static const char text[] =
        "camera: {from: [0, 0, 5], to: [0, 0, 0], fov: 90}\n"
        "image: {width: 3, height: 3, samples: 1}\n"
        "objects:\n"
        "  - plane: {normal: [0, 1, 0], offset: -2.5, material: {color: [0.25, 0.5, 1]}}\n"
        "  - sphere: {radius: 1, material: {diffuse: 0, reflect: 0.75}}\n";
    layered l = render_layers(*state, text, NULL, ALL & ~(1u << LR_AOV_VARIANCE));
    const uint32_t *id = samples_of(&l, LR_AOV_ID), *samples = samples_of(&l, LR_AOV_SAMPLES);
    const float *depth = floats_of(&l, LR_AOV_DEPTH), *alpha = floats_of(&l, LR_AOV_ALPHA);
    const float *normal = floats_of(&l, LR_AOV_NORMAL), *position = floats_of(&l, LR_AOV_POSITION);
    const float *albedo = floats_of(&l, LR_AOV_ALBEDO);
    for (size_t i = 0; i < 9; i++) {
        int64_t x = (int64_t)(i % 3) - 1;
        bool sphere = i == 4, plane = i >= 6;
        assert_int_equal(id[i], sphere ? 2 : plane ? 1 : 0);
        assert_int_equal(samples[i], 1);
        assert_near(alpha[i], sphere || plane, 0);
        /* The floor is met 2.5 below, so 3.75 ahead and 2.5 x aside. */
        double far = sphere ? 4 : plane ? sqrt(2.5 * 2.5 * (double)(x * x + 1) + 3.75 * 3.75) : 0;
        assert_near(depth[i], far, 1e-6);
        const double at[3] = {plane ? 2.5 * (double)x : 0, plane ? -2.5 : 0,
                              sphere  ? 1
                              : plane ? 1.25
                                      : 0};
        const double n[3] = {0, plane, sphere};
        const double color[3] = {sphere  ? 0.75
                                 : plane ? 0.25
                                         : 0,
                                 sphere  ? 0.75
                                 : plane ? 0.5
                                         : 0,
                                 sphere ? 0.75 : plane};
        for (int c = 0; c < 3; c++) {
            assert_near(position[3 * i + c], at[c], 1e-6);
            assert_near(normal[3 * i + c], n[c], 1e-6);
            assert_near(albedo[3 * i + c], color[c], 0);
        }
    }
    free_layered(&l);
}

/* What shines with 1 where there is something is as bright as that is there, but for the step that
 * weights are truncated to: so the samples of layers are those of the picture. */
static void test_samples_are_the_pictures(void **state)
{
    static const char *const cameras[] = {
        "{from: [0, 0, 5], to: [0, 0, 0], fov: 40}",
        "{from: [0, 0, 5], to: [0, 0, 0], fov: 40, aperture: 0.4, focus: 3}"};
    for (int camera = 0; camera < 2; camera++)
        for (int filter = LR_FILTER_BOX; filter <= LR_FILTER_TENT; filter++)
            for (int k = 0; k < 2; k++) {
                char text[512];
                snprintf(text, sizeof text,
                         "camera: %s\nimage: {width: 16, height: 12, samples: 8}\n"
                         "background: 0\nambient: 0\nlights: []\nobjects:\n"
                         "  - sphere: {center: [0.1, 0, 0], radius: 1.3,"
                         " material: {diffuse: 0, emission: 1}}\n",
                         cameras[camera]);
                lr_render_options options = {.integrator = integrators[k],
                                             .filter = (lr_filter)filter};
                layered l = render_layers(*state, text, &options,
                                          1u << LR_AOV_ALPHA | 1u << LR_AOV_POSITION);
                size_t edges = 0;
                for (size_t i = 0; i < pixels_of(&l); i++) {
                    float alpha = floats_of(&l, LR_AOV_ALPHA)[i];
                    assert_near(l.picture.image.pixels[3 * i], alpha, 0);
                    edges += alpha > 0 && alpha < 1;
                    /* Where the background mixes in, the mean is still one of the sphere's. */
                    float z = floats_of(&l, LR_AOV_POSITION)[3 * i + 2];
                    assert_true(alpha > 0 ? z > 0.2 && z <= 1.3 : z == 0);
                }
                assert_in_range(edges, 10, 120);
                free_layered(&l);
            }
}

/* A bubble of water in glass is not there for a camera in that glass. */
static void test_what_is_hidden_is_not_seen(void **state)
{
    static const char text[] =
        "camera: {from: [0, 0, 1], to: [0, 0, 0], fov: 5}\n"
        "image: {width: 1, height: 1, samples: 1}\n"
        "objects:\n"
        "  - sphere: {center: [0, 0, -0.5], radius: 0.25,"
        " material: {diffuse: 0, transmit: 1, ior: 1.33, priority: -1}}\n"
        "  - sphere: {radius: 2, material: {diffuse: 0, transmit: 1, ior: 1.5}}\n";
    layered l = render_layers(*state, text, NULL, ALL & ~(1u << LR_AOV_VARIANCE));
    assert_int_equal(*(const uint32_t *)samples_of(&l, LR_AOV_ID), 2);
    assert_near(*floats_of(&l, LR_AOV_DEPTH), 3, 1e-5);
    assert_near(floats_of(&l, LR_AOV_POSITION)[2], -2, 1e-5);
    free_layered(&l);
}

static const char room[] =
    "camera: {from: [0, 2, 7], to: [0, 0.8, 0]}\n"
    "image: {width: 45, height: 37, samples: 8, depth: 4, seed: 7}\n"
    "fog: {density: 0.01, color: [0.6, 0.7, 0.8]}\n"
    "materials:\n"
    "  floor: {color: {checker: [white, [0.05, 0.05, 0.05]]}, reflect: 0.2}\n"
    "  glass: {diffuse: 0, transmit: 0.95, ior: 1.5, fresnel: true, absorption: [0.1, 0, 0.3]}\n"
    "lights:\n"
    "  - point: {position: [4, 6, 3], intensity: 40}\n"
    "  - directional: {direction: [0.2, -1, -0.4], intensity: 0.3}\n"
    "objects:\n"
    "  - plane: {material: floor}\n"
    "  - sphere: {center: [-1.6, 1, 0], material: glass}\n"
    "  - box: {min: [1, 0, -1], max: [2, 1.5, 0], rotate: [0, 20, 0]}\n"
    "  - rectangle: {corner: [-1, 4, -1], u: [2, 0, 0], v: [0, 0, 2], material: {emission: 3}}\n"
    "  - disk: {center: [0, 2, -3], normal: [0, 0, 1], material: {reflect: 0.8}}\n";

/* The picture is lr_render's, direct light the picture of depth 0, both to the bit, and the rest is
 * what is missing to the sum. */
static void test_direct_and_indirect(void **state)
{
    for (int k = 0; k < 2; k++) {
        lr_render_options options = {.integrator = integrators[k]};
        picture whole = render_text(*state, room, &options);
        layered l = render_layers(*state, room, &options, ALL);
        options.has_depth = true;
        picture shallow = render_text(*state, room, &options);
        size_t bytes = 3 * sizeof(float) * pixels_of(&l);
        assert_string_equal(l.picture.stats.hash, whole.stats.hash);
        assert_string_equal(l.picture.stats.settings, whole.stats.settings);
        assert_int_equal(l.picture.stats.shadow.traced, whole.stats.shadow.traced);
        const float *direct = floats_of(&l, LR_AOV_DIRECT);
        const float *indirect = floats_of(&l, LR_AOV_INDIRECT);
        assert_memory_equal(direct, shallow.image.pixels, bytes);
        double all = 0;
        for (size_t i = 0; i < 3 * pixels_of(&l); i++) {
            double sum = whole.image.pixels[i];
            all += indirect[i];
            assert_true(indirect[i] >= 0);
            assert_near((double)direct[i] + indirect[i], sum, 1.5 * ulp_of(sum));
        }
        assert_true(all > 100);
        free_picture(&whole);
        free_picture(&shallow);
        free_layered(&l);
    }
}

static void test_other_cuts_change_nothing(void **state)
{
    static const lr_render_options cuts[] = {
        {.tile_size = 8}, {.chunk_rays = 512}, {.storage_loads = true}};
    for (int k = 0; k < 2; k++) {
        lr_render_options plain = {.integrator = integrators[k]};
        layered whole = render_layers(*state, room, &plain, ALL);
        assert_int_equal(whole.layers.count, LR_AOV_COUNT);
        for (size_t i = 0; i < sizeof cuts / sizeof *cuts; i++) {
            lr_render_options options = cuts[i];
            options.integrator = integrators[k];
            layered l = render_layers(*state, room, &options, ALL);
            assert_string_equal(l.picture.stats.hash, whole.picture.stats.hash);
            for (uint32_t a = 0; a < LR_AOV_COUNT; a++) {
                const lr_layer *layer = &l.layers.layers[a];
                size_t channels = layer->channels[0] ? strlen(layer->channels) : 1;
                assert_memory_equal(layer->samples, whole.layers.layers[a].samples,
                                    4 * channels * pixels_of(&l));
            }
            free_layered(&l);
        }
        free_layered(&whole);
    }
}

static void put_range(uint32_t *film, double sum, uint32_t samples)
{
    uint64_t steps = (uint64_t)ldexp(sum, LR_FILM_STEP_BITS);
    memset(film, 0, LR_FILM_WORDS * sizeof *film);
    for (int channel = 0; channel < 3; channel++) {
        film[2 * channel] = (uint32_t)steps;
        film[2 * channel + 1] = (uint32_t)(steps >> 32);
    }
    film[LR_FILM_SAMPLES] = samples;
}

/* Means 1, 4 and 3 of 1, 2 and 1 samples have the mean 3; (1 * 4 + 2 * 1 + 1 * 0) / (4 * 2). */
static void test_spread(void **state)
{
    (void)state;
    uint32_t film[LR_FILM_WORDS];
    lr_spread spread = {.samples = 0};
    float variance[3];
    put_range(film, 1, 1);
    lr_spread_add(&spread, film);
    lr_spread_variance(&spread, variance);
    assert_near(variance[0], 0, 0);
    put_range(film, 8, 2);
    lr_spread_add(&spread, film);
    put_range(film, 3, 1);
    film[LR_FILM_FLAGS] = 4;
    lr_spread_add(&spread, film);
    lr_spread_variance(&spread, variance);
    assert_near(variance[0], 0.75, 1e-7);
    assert_near(variance[1], 0.75, 1e-7);
    assert_true(variance[2] > 1e15f); /* blue left the film's range */
}

/* Against the pictures of many seeds. Sobol points are spread more evenly than by chance, which the
 * ranges show less than the whole. */
static void test_variance_is_that_of_seeds(void **state)
{
    enum { SEEDS = 32, SIDE = 12, VALUES = 3 * SIDE * SIDE };
    static double sums[VALUES], squares[VALUES];
    double estimated = 0, found = 0;
    for (uint32_t seed = 0; seed < SEEDS; seed++) {
        lr_render_options options = {.width = SIDE,
                                     .height = SIDE,
                                     .samples = 40,
                                     .seed = seed,
                                     .has_seed = true,
                                     .integrator = LR_INTEGRATOR_PATH};
        layered l = render_layers(*state, room, &options, 1u << LR_AOV_VARIANCE);
        for (size_t i = 0; i < VALUES; i++) {
            double value = l.picture.image.pixels[i];
            sums[i] += value;
            squares[i] += value * value;
            estimated += floats_of(&l, LR_AOV_VARIANCE)[i];
        }
        free_layered(&l);
    }
    for (size_t i = 0; i < VALUES; i++)
        found += (squares[i] - sums[i] * sums[i] / SEEDS) / (SEEDS - 1);
    print_message("estimated %.3g, found %.3g\n", estimated / SEEDS, found);
    assert_in_range((uint64_t)(100 * estimated / SEEDS / found), 80, 400);
}

static void refused(lr_device *device, const lr_render_options *options, uint32_t wanted,
                    const char *part)
{
    layered l;
    lr_error error = {0};
    assert_int_equal(try_layers(device, room, options, wanted, &l, &error), LR_ERROR_ARGUMENT);
    if (!strstr(error.message, part))
        fail_msg("no '%s' in: %s", part, error.message);
    assert_null(l.picture.image.pixels);
    assert_int_equal(l.layers.count, 0);
}

static void test_what_does_not_go_together(void **state)
{
    refused(*state, &(lr_render_options){.samples = 1}, 1u << LR_AOV_VARIANCE, "--spp 2");
    refused(*state, &(lr_render_options){.sample_range.count = 1}, ALL, "--sample-range");
    refused(*state, &(lr_render_options){.checkpoint = "x"}, 1, "--checkpoint");
    refused(*state, &(lr_render_options){.seconds = 1, .integrator = LR_INTEGRATOR_PATH}, ALL,
            "--time");
    assert_null(lr_aov_name(LR_AOV_COUNT));
}

static bool stop_late(void *user, double fraction)
{
    double *seen = user;
    assert_true(fraction >= *seen && fraction <= 1);
    *seen = fraction;
    return fraction < 0.9;
}

/* The progress never falls, and stops also what comes after the picture. */
static void test_interrupted(void **state)
{
    layered l;
    lr_error error = {0};
    double seen = 0;
    lr_render_options options = {.progress = stop_late, .user = &seen};
    assert_int_equal(try_layers(*state, room, &options, ALL, &l, &error), LR_ERROR_INTERRUPTED);
    assert_true(seen >= 0.9);
    assert_null(l.picture.image.pixels);
    assert_int_equal(l.layers.count, 0);
}

/* As many samples as fit. */
static void test_in_time(void **state)
{
    lr_render_options options = {.seconds = 0.2, .samples = 64, .integrator = LR_INTEGRATOR_PATH};
    layered l = render_layers(*state, room, &options, 1u << LR_AOV_SAMPLES | 1u << LR_AOV_DIRECT);
    uint32_t reached = l.picture.stats.samples;
    assert_in_range(reached, 1, 64);
    for (size_t i = 0; i < pixels_of(&l); i++)
        assert_int_equal(((const uint32_t *)samples_of(&l, LR_AOV_SAMPLES))[i], reached);
    picture direct =
        render_text(*state, room,
                    &(lr_render_options){
                        .samples = reached, .has_depth = true, .integrator = LR_INTEGRATOR_PATH});
    assert_memory_equal(floats_of(&l, LR_AOV_DIRECT), direct.image.pixels,
                        3 * sizeof(float) * pixels_of(&l));
    free_picture(&direct);
    free_layered(&l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_is_seen),
        cmocka_unit_test(test_samples_are_the_pictures),
        cmocka_unit_test(test_what_is_hidden_is_not_seen),
        cmocka_unit_test(test_direct_and_indirect),
        cmocka_unit_test(test_other_cuts_change_nothing),
        cmocka_unit_test(test_spread),
        cmocka_unit_test(test_variance_is_that_of_seeds),
        cmocka_unit_test(test_what_does_not_go_together),
        cmocka_unit_test(test_interrupted),
        cmocka_unit_test(test_in_time),
        cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device, NULL);
}
