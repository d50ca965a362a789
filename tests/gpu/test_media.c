/* Nested media. Boxes stand in a row along z and the camera looks along it. Media with an index of
 * 1 only absorb, so a pixel shows how far the ray went in each; with fresnel it shows which media
 * met at each surface. */
#include "gpu_tests.h"

static const char materials[] =
    "ambient: 0\nlights: []\nmaterials:\n"
    "  red: {transmit: 1, diffuse: 0, ior: 1, absorption: [1, 0, 0]}\n"
    "  green: {transmit: 1, diffuse: 0, ior: 1, absorption: [0, 1, 0]}\n"
    "  green_first: {transmit: 1, diffuse: 0, ior: 1, absorption: [0, 1, 0], priority: 1}\n"
    "  blue: {transmit: 1, diffuse: 0, ior: 1, absorption: [0, 0, 1]}\n"
    "  nothing: {transmit: 1, diffuse: 0, ior: 1}\n"
    "  glass: {transmit: 1, diffuse: 0, ior: 1.5, fresnel: true}\n"
    "  glass_first: {transmit: 1, diffuse: 0, ior: 1.5, fresnel: true, priority: 1}\n"
    "  tinted_glass: {transmit: 1, diffuse: 0, ior: 1.5, fresnel: true, absorption: 0.5}\n"
    "  water: {transmit: 1, diffuse: 0, ior: 1.33, fresnel: true}\n"
    "  air: {transmit: 1, diffuse: 0, ior: 1, fresnel: true}\n";

#define BOX(from, to, material)                                                                    \
    "  - box: {min: [-9, -9, " #from "], max: [9, 9, " #to "], material: " #material "}\n"

static rgb look(void **state, lr_render_stats *stats, double from, double to, const char *image,
                const char *objects)
{
    return render_pixel(*state, stats,
                        "camera: {from: [0, 0, %g], to: [0, 0, %g], up: [0, 1, 0]}\n"
                        "background: 1\nimage: {%s}\n%sobjects:\n%s",
                        from, to, image, materials, objects);
}

/* The lengths within the red, green and blue medium, seen from either end of the row. */
static void check_lengths(void **state, const char *objects, double red, double green, double blue,
                          uint64_t passed)
{
    for (int side = -1; side <= 1; side += 2) {
        lr_render_stats stats;
        rgb found = look(state, &stats, 20 * side, 0, "depth: 20", objects);
        assert_near(-log(found.r), red, 1e-4);
        assert_near(-log(found.g), green, 1e-4);
        assert_near(-log(found.b), blue, 1e-4);
        assert_int_equal(stats.passed, passed);
        assert_int_equal(stats.dropped_nesting, 0);
    }
}

static void test_one_inside_another(void **state)
{
    check_lengths(state, BOX(-2, 2, red), 4, 0, 0, 0);
    check_lengths(state, BOX(-2, 2, red) BOX(-1, 1.5, green), 1.5, 2.5, 0, 0);
    check_lengths(state, BOX(-1, 1.5, green) BOX(-2, 2, red), 4, 0, 0, 2); /* drowned */
    check_lengths(state, BOX(-1, 1.5, green_first) BOX(-2, 2, red), 1.5, 2.5, 0, 0);
    check_lengths(state, BOX(-2, 2, red) BOX(-1, 1, nothing), 2, 0, 0, 0); /* a bubble */
    check_lengths(state, BOX(-3, 3, red) BOX(-2, 2, green) BOX(-1, 1, blue), 2, 2, 2, 0);
    check_lengths(state, BOX(-3, 3, red) BOX(-2, 2, blue) BOX(-1, 1, red), 4, 0, 2, 0);
}

static void test_overlaps(void **state)
{
    check_lengths(state, BOX(-2, 1, red) BOX(0, 3, green), 2, 3, 0, 1);
    check_lengths(state, BOX(0, 3, green) BOX(-2, 1, red), 3, 2, 0, 1);
    check_lengths(state, BOX(0, 3, green_first) BOX(-2, 1, red), 2, 3, 0, 1);
    check_lengths(state, BOX(-2, 0, red) BOX(0.5, 3, green), 2, 2.5, 0, 0); /* apart */
    check_lengths(state, BOX(-3, 3, red) BOX(-2, 1, green) BOX(0, 2, blue), 2, 2, 2, 1);
    check_lengths(state,
                  "  - sphere: {radius: 2, material: red}\n"
                  "  - sphere: {center: [0, 0, 1], radius: 2, material: green}\n",
                  1, 4, 0, 1);
    check_lengths(state,
                  "  - cylinder: {from: [0, 0, -2], to: [0, 0, 2], material: red}\n"
                  "  - cylinder: {from: [0, 0, -1], to: [0, 0, 1.5], radius: 0.8, "
                  "material: green}\n",
                  1.5, 2.5, 0, 0);
    check_lengths(state,
                  "  - sphere: {radius: 1, scale: [1, 1, 3], material: red}\n"
                  "  - cone: {from: [0, 0, -1], to: [0, 0, 1], radius: 0.5, "
                  "top_radius: 0.4, material: green}\n",
                  4, 2, 0, 0);
}

/* Thin and open things enclose nothing. */
static void test_thin_things(void **state)
{
    check_lengths(state,
                  "  - rectangle: {corner: [-1, -1, 0], u: [2, 0, 0], v: [0, 2, 0], "
                  "material: red}\n",
                  0, 0, 0, 0);
    check_lengths(state,
                  "  - cylinder: {from: [0, -1, 0], to: [0, 1, 0], open: true, "
                  "material: red}\n",
                  0, 0, 0, 0);
}

/* The camera stands in a medium, or in several. */
static void test_camera_inside(void **state)
{
    const char *image = "depth: 20";
    rgb found = look(state, NULL, 0, -1, image, BOX(-2, 3, red));
    assert_near(-log(found.r), 2, 1e-4);
    found = look(state, NULL, 0, 1, image, BOX(-2, 3, red));
    assert_near(-log(found.r), 3, 1e-4);
    found = look(state, NULL, 0, 1, image, BOX(-2, 3, red) BOX(-1, 1, green));
    assert_near(-log(found.r), 2, 1e-4);
    assert_near(-log(found.g), 1, 1e-4);
    found = look(state, NULL, 0, 1, image, BOX(-1, 1, green) BOX(-2, 3, red));
    assert_near(-log(found.r), 3, 1e-4);
    found = look(state, NULL, 0, 1, image, BOX(-2, 1, red) BOX(-0.5, 4, green));
    assert_near(-log(found.g), 4, 1e-4);
    assert_near(found.r, 1, 1e-5);
    found = look(state, NULL, -3, 1, image,
                 "  - plane: {normal: [0, 0, 1], offset: 1, material: blue}\n");
    assert_near(-log(found.b), 4, 1e-4);
    found = look(state, NULL, 0.5, 3, image,
                 "  - sphere: {radius: 1, scale: [1, 1, 3], material: red}\n"
                 "  - cylinder: {from: [0, 0, -2], to: [0, 0, 2], material: green}\n");
    assert_near(-log(found.g), 1.5, 1e-4);
    assert_near(-log(found.r), 1, 1e-4);
}

static double through(double ior1, double ior2)
{
    double r = (ior1 - ior2) / (ior1 + ior2);
    return 1 - r * r;
}

/* With as many bounces as there are surfaces, only the ray straight through gets out behind. */
static void check_through(void **state, int surfaces, const char *objects, double expected,
                          uint64_t passed)
{
    for (int side = -1; side <= 1; side += 2) {
        lr_render_stats stats;
        rgb found = render_pixel(*state, &stats,
                                 "camera: {from: [0, 0, %d], up: [0, 1, 0]}\nup: [0, 0, %d]\n"
                                 "background: {gradient: [1, 0]}\nimage: {depth: %d}\n%s"
                                 "objects:\n%s",
                                 20 * side, side, surfaces, materials, objects);
        assert_near(found.r, expected, 3e-6);
        assert_in_range(stats.passed, passed, 10 * passed); /* mirrored rays pass some again */
    }
}

static void test_which_media_meet(void **state)
{
    double air_glass = through(1, 1.5), water_glass = through(1.33, 1.5);
    double air_water = through(1, 1.33);
    check_through(state, 2, BOX(-2, 2, glass), air_glass * air_glass, 0);
    /* a bubble in glass */
    check_through(state, 4, BOX(-2, 2, glass) BOX(-1, 1, air), pow(air_glass, 4), 0);
    /* water in glass: drawn within it, and in a gap between walls that it overlaps */
    double water_in_glass = pow(air_glass * water_glass, 2);
    check_through(state, 4, BOX(-2, 2, glass) BOX(-1, 1, water), water_in_glass, 0);
    check_through(state, 4, BOX(-2, -1, glass_first) BOX(1, 2, glass_first) BOX(-1.5, 1.5, water),
                  water_in_glass, 2);
    check_through(state, 4, BOX(-1.5, 1.5, water) BOX(-2, -1, glass) BOX(1, 2, glass),
                  water_in_glass, 2);
    /* glass in water reaches out of it */
    check_through(state, 3, BOX(-2, 1, water) BOX(0, 3, glass), air_water * water_glass * air_glass,
                  1);
}

/* Where glass overlaps the same glass nothing is mirrored and nothing bent. */
static void test_union_of_the_same_glass(void **state)
{
    lr_render_stats one, two;
    const char *spheres = "  - sphere: {radius: 2, material: tinted_glass}\n"
                          "  - sphere: {center: [0, 0, 1], radius: 2, material: tinted_glass}\n";
    double air_glass = through(1, 1.5), expected = air_glass * air_glass * exp(-0.5 * 5);
    check_through(state, 3, spheres, expected, 1);
    look(state, &one, 20, 0, "depth: 1", BOX(-2, 3, glass));
    look(state, &two, 20, 0, "depth: 3", BOX(-2, 1, glass) BOX(0, 3, glass));
    assert_int_equal(one.reflected.traced, 1);
    /* from the first surface, and from the last one there and back */
    assert_int_equal(two.reflected.traced, 2);
}

/* More than LR_MEDIA_MAX media around a point: counted, and the innermost are left out. */
static void test_too_many_nested(void **state)
{
    char objects[2048];
    int at = 0;
    for (int i = 0; i < LR_MEDIA_MAX + 1; i++)
        at += snprintf(objects + at, sizeof objects - (size_t)at,
                       "  - sphere: {radius: %d, material: %s}\n", 10 - i,
                       i == LR_MEDIA_MAX ? "green" : "red");
    lr_render_stats stats;
    rgb found = look(state, &stats, 20, 0, "depth: 30", objects);
    assert_int_equal(stats.dropped_nesting, 1);
    assert_int_equal(stats.passed, 2);
    assert_near(-log(found.r), 20, 2e-2);
    assert_near(found.g, 1, 1e-5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_one_inside_another), cmocka_unit_test(test_overlaps),
        cmocka_unit_test(test_thin_things),        cmocka_unit_test(test_camera_inside),
        cmocka_unit_test(test_which_media_meet),   cmocka_unit_test(test_union_of_the_same_glass),
        cmocka_unit_test(test_too_many_nested),    cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device, NULL);
}
