/* Mirrors, thin panes and glass: the weights of child rays and the depth threshold. */
#include "gpu_tests.h"

static void expect(rgb found, double r, double g, double b, double tolerance)
{
    assert_near(found.r, r, tolerance);
    assert_near(found.g, g, tolerance);
    assert_near(found.b, b, tolerance);
}

/* What the mirrored ray sees is 1 upwards of z, what goes through sees 0, or the other way round.
 */
#define UPPER "camera: {from: [0, 0, 5], up: [0, 1, 0]}\nup: [0, 0, 1]\nlights: []\n"
#define BEFORE UPPER "background: {gradient: [0, 1]}\n"
#define BEHIND UPPER "background: {gradient: [1, 0]}\n"
#define PANE "objects:\n  - rectangle: {corner: [-1, -1, 0], u: [2, 0, 0], v: [0, 2, 0], material: "

static void test_weights(void **state)
{
    const char *both = "{reflect: [0.5, 0.25, 1], transmit: [0.2, 0.4, 0], diffuse: 0}}\n";
    expect(render_pixel(*state, NULL, BEFORE PANE "%s", both), 0.5, 0.25, 1, 1e-6);
    expect(render_pixel(*state, NULL, BEHIND PANE "%s", both), 0.2, 0.4, 0, 1e-6);
    /* diffuse is what is left over, and ambient is as much as diffuse */
    rgb rest =
        render_pixel(*state, NULL,
                     "camera: {from: [0, 0, 5]}\nambient: 1\nbackground: 2\nlights: []\n" PANE
                     "{color: 1, reflect: 0.3, transmit: 0.1}}\n");
    expect(rest, 0.6 + 0.8, 0.6 + 0.8, 0.6 + 0.8, 1e-6);
}

static double fresnel(double cosine, double ior)
{
    double c2 = sqrt(1 - (1 - cosine * cosine) / (ior * ior));
    double s = (cosine - ior * c2) / (cosine + ior * c2);
    double p = (c2 - ior * cosine) / (c2 + ior * cosine);
    return (s * s + p * p) / 2;
}

static void test_fresnel(void **state)
{
    const char *glass = "{transmit: 1, diffuse: 0, ior: 1.5, fresnel: true}}\n";
    expect(render_pixel(*state, NULL, BEFORE PANE "%s", glass), 0.04, 0.04, 0.04, 1e-6);
    expect(render_pixel(*state, NULL, BEHIND PANE "%s", glass), 0.96, 0.96, 0.96, 1e-6);
    /* A solid: at depth 1 only the mirrored ray gets anywhere. */
    rgb solid = render_pixel(
        *state, NULL, BEFORE "image: {depth: 1}\nobjects:\n  - sphere: {material: %s", glass);
    expect(solid, 0.04, 0.04, 0.04, 1e-6);
    for (int angle = 10; angle < 90; angle += 10) {
        double s = sin(angle * 0.017453292519943295), c = cos(angle * 0.017453292519943295);
        rgb found = render_pixel(
            *state, NULL,
            "camera: {from: [%.9g, 0, %.9g]}\nimage: {depth: 1}\nambient: 0\nbackground: "
            "1\nlights: "
            "[]\nobjects:\n  - box: {min: [-99, -99, -9], max: [99, 99, 0], material: %s",
            s, c, glass);
        double f = fresnel(c, 1.5);
        expect(found, f, f, f, 3e-6);
    }
}

/* From inside a block of glass: total reflection at more than 41.8 degrees to the normal. */
static void test_total_reflection(void **state)
{
    for (int angle = 40; angle <= 44; angle += 4) {
        double s = sin(angle * 0.017453292519943295), c = cos(angle * 0.017453292519943295);
        lr_render_stats stats;
        rgb found = render_pixel(*state, &stats,
                                 "camera: {from: [%.9g, 0, %.9g]}\nimage: {depth: 1}\nambient: "
                                 "0\nbackground: 1\nlights: "
                                 "[]\nobjects:\n  - box: {min: [-99, -99, -9], max: [99, 99, 0], "
                                 "material: {transmit: 1, "
                                 "diffuse: 0, ior: 1.5}}\n",
                                 -s, -c);
        bool total = angle > 42;
        expect(found, !total, !total, !total, 1e-6);
        assert_int_equal(stats.reflected.traced, total);
        assert_int_equal(stats.refracted.traced, !total);
    }
}

/* Two mirrors face each other: the mirror images are a geometric series. */
static void test_mirror_corridor(void **state)
{
    for (int depth = 0; depth <= 64; depth += depth < 8 ? 1 : 28) {
        lr_render_stats stats;
        rgb found = render_pixel(
            *state, &stats,
            "camera: {from: [0, 0, 5]}\nimage: {depth: %d}\nambient: 1\nlights: []\n"
            "materials: {mirror: {reflect: [0.5, 0.25, 0.125], color: 1, ambient: 0.3}}\n"
            "objects:\n  - plane: {normal: [0, 0, 1], material: mirror}\n"
            "  - plane: {normal: [0, 0, -1], offset: -10, material: mirror}\n",
            depth);
        /* A weight below 2^-40 is 0, so bounces end at the 40th. */
        int bounces = depth < 40 ? depth : 40;
        double r = 0, g = 0, b = 0;
        for (int k = 0; k <= bounces; k++) {
            r += 0.3 * pow(0.5, k);
            g += 0.3 * pow(0.25, k);
            b += 0.3 * pow(0.125, k);
        }
        expect(found, r, g, b, 1e-6);
        assert_int_equal(stats.depth, depth);
        assert_int_equal(stats.reflected.traced, bounces);
        assert_int_equal(stats.reflected.hit, bounces);
        assert_int_equal(stats.dropped_depth, depth < 40 ? 1 : 0);
    }
}

static void test_depth_zero_is_what_the_eye_sees(void **state)
{
    lr_render_stats stats;
    rgb found = render_pixel(*state, &stats,
                             "camera: {from: [0, 0, 5]}\nimage: {depth: 0}\nambient: 1\n"
                             "background: 9\nlights: []\n" PANE
                             "{color: 1, ambient: 0.25, reflect: 0.5, transmit: 0.5}}\n");
    expect(found, 0.25, 0.25, 0.25, 1e-7);
    assert_int_equal(stats.dropped_depth, 2);
    assert_int_equal(stats.primary.traced, 1);
    assert_int_equal(stats.reflected.traced + stats.refracted.traced, 0);
}

static void test_min_weight(void **state)
{
    for (int i = 0; i < 2; i++) {
        lr_render_stats stats;
        rgb found =
            render_pixel(*state, &stats,
                         "camera: {from: [0, 0, 5]}\nimage: {min_weight: %g}\nambient: 0\n"
                         "background: 1\nlights: []\n" PANE "{reflect: 0.25, transmit: 0.5}}\n",
                         i ? 0.26 : 0.25);
        expect(found, i ? 0.5 : 0.75, i ? 0.5 : 0.75, i ? 0.5 : 0.75, 1e-6);
        assert_int_equal(stats.dropped_weight, i);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_weights),
        cmocka_unit_test(test_fresnel),
        cmocka_unit_test(test_total_reflection),
        cmocka_unit_test(test_mirror_corridor),
        cmocka_unit_test(test_depth_zero_is_what_the_eye_sees),
        cmocka_unit_test(test_min_weight),
        cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device, NULL);
}
