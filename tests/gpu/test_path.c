/* Paths in scenes whose light is known without tracing any. */
#include "gpu_tests.h"

/* Point, spot and directional lights on matt surfaces are the ray tracer's, whatever the falloff.
 */
static void test_direct_light_is_the_ray_tracers(void **state)
{
    static const char scene[] =
        "camera: {from: [0, 4, 7], to: [0, 0, 0]}\n"
        "image: {width: 24, height: 16, samples: 1024, depth: 0}\n"
        "ambient: 0\nbackground: 0\n"
        "lights:\n"
        "  - point: {position: [2, 3, 0], intensity: 5, color: [1, 0.5, 0.2]}\n"
        "  - point: {position: [-2, 3, 0], intensity: 0.5, falloff: 0}\n"
        "  - spot: {position: [0, 5, 3], to: [0, 0, 0], intensity: 9, falloff: 1.5, angle: 60}\n"
        "  - directional: {direction: [0.2, -1, -0.4], intensity: 0.3}\n"
        "objects:\n"
        "  - plane: {material: {color: [0.9, 0.6, 0.3]}}\n";
    picture trees = render_text(*state, scene, NULL);
    picture paths =
        render_text(*state, scene, &(lr_render_options){.integrator = LR_INTEGRATOR_PATH});
    /* The upper rows see farther than the lights reach evenly within a pixel. */
    for (uint32_t y = 4; y < 16; y++)
        for (uint32_t x = 0; x < 24; x++) {
            rgb expected = pixel_at(&trees, x, y), found = pixel_at(&paths, x, y);
            assert_near(found.r, expected.r, 0.03 * expected.r);
            assert_near(found.g, expected.g, 0.03 * expected.g);
            assert_near(found.b, expected.b, 0.03 * expected.b);
        }
    for (int c = 0; c < 3; c++)
        assert_near(mean_of(&paths, c), mean_of(&trees, c), 0.002 * mean_of(&trees, c));
    assert_int_equal(paths.stats.primary.traced, 24 * 16 * 1024);
    free_picture(&trees);
    free_picture(&paths);
}

/* Inside a ball that shines with 1 and reflects a of what falls on it, bounce k adds a^k; depth d
 * has direct light after d bounces. */
static void test_inside_a_shining_ball(void **state)
{
    for (int depth = 0; depth <= 8; depth += 4) {
        char scene[512];
        double expected = 0;
        for (int k = 0; k <= depth + 1; k++)
            expected += pow(0.6, k);
        snprintf(scene, sizeof scene,
                 "camera: {from: [0.3, 0.2, 0], to: [0, 0, -1], fov: 90}\n"
                 "image: {width: 16, height: 16, samples: 256, depth: %d, integrator: path}\n"
                 "lights: []\nobjects:\n"
                 "  - sphere: {material: {color: 0.6, emission: 1}}\n",
                 depth);
        picture p = render_text(*state, scene, NULL);
        assert_near(mean_of(&p, 0), expected, 0.004 * expected);
        assert_int_equal(p.stats.non_finite, 0);
        free_picture(&p);
    }
}

/* What reflects all light, in the same light from everywhere, cannot be seen. */
static void test_white_furnace(void **state)
{
    static const struct {
        const char *material;
        int depth;
        double tolerance; /* of a sample */
    } cases[] = {
        {"{color: 1}", 0, 2e-6},
        {"{color: 1}", 5, 2e-6},
        {"{diffuse: 0, reflect: 1}", 0, 2e-6},
        {"{diffuse: 0, transmit: 1, fresnel: true}", 64, 1e-5},
        {"{diffuse: 0, transmit: 1, ior: 1.33}", 64, 1e-5},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char scene[512];
        snprintf(scene, sizeof scene,
                 "camera: {from: [0, 0, 4], to: [0, 0, 0]}\n"
                 "image: {width: 32, height: 32, samples: 16, depth: %d, integrator: path}\n"
                 "background: 1\nlights: []\nobjects:\n  - sphere: {material: %s}\n",
                 cases[i].depth, cases[i].material);
        picture p = render_text(*state, scene, NULL);
        if (!(worst_distance_from(&p, 1) <= cases[i].tolerance))
            fail_msg("%s, depth %d: off by %g", cases[i].material, cases[i].depth,
                     worst_distance_from(&p, 1));
        free_picture(&p);
    }
}

/* A lamp above a floor, found by asking it and by running into it: the sum is as if only one of the
 * ways were there. The irradiance under the middle of a disk is pi L r^2 / (r^2 + h^2). */
static void test_light_found_in_both_ways(void **state)
{
    static const char scene[] =
        "camera: {from: [0, 0.5, 0], to: [0, 0, 0], up: [0, 0, -1], fov: 2}\n"
        "image: {width: 8, height: 8, samples: 1024, depth: 0, integrator: path}\n"
        "background: 0\nlights: []\n"
        "objects:\n"
        "  - plane: {material: {color: 0.5}}\n"
        "  - disk: {center: [0, 1, 0], normal: [0, -1, 0], radius: 2, material: {diffuse: 0, "
        "emission: 3, emits: front}}\n";
    picture p = render_text(*state, scene, NULL);
    assert_near(mean_of(&p, 0), 0.5 * 3 * 4 / 5.0, 0.005);
    free_picture(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_direct_light_is_the_ray_tracers),
        cmocka_unit_test(test_inside_a_shining_ball),
        cmocka_unit_test(test_white_furnace),
        cmocka_unit_test(test_light_found_in_both_ways),
        cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device, NULL);
}
