/* Light, as real renders of one pixel against closed forms. The camera looks at the origin of a
 * wall at z = 0, askew where something stands in front of it. */
#include "gpu_tests.h"

#define STRAIGHT "camera: {from: [0, 0, 5]}\nbackground: 0\nambient: 0\n"
#define ASKEW "camera: {from: [3, 0, 4]}\nbackground: 0\nambient: 0\n"
#define WALL "  - plane: {normal: [0, 0, 1], material: {color: 1}}\n"
#define DEGREE 0.017453292519943295

static void expect(rgb found, double r, double g, double b, double tolerance)
{
    if (!(fabs(found.r - r) <= tolerance && fabs(found.g - g) <= tolerance &&
          fabs(found.b - b) <= tolerance))
        fail_msg("found %.9g %.9g %.9g, expected %.9g %.9g %.9g", found.r, found.g, found.b, r, g,
                 b);
}

static void expect_grey(rgb found, double value, double tolerance)
{
    expect(found, value, value, value, tolerance);
}

/* ---- Falloff and the cosine ---------------------------------------------------------------- */

static void test_falloff(void **state)
{
    const double exponents[] = {0, 0.5, 1, 2, 3.7}, distances[] = {0.01, 0.5, 1, 2, 100};
    for (int e = 0; e < 5; e++)
        for (int d = 0; d < 5; d++) {
            double expected = 3 / pow(distances[d], exponents[e]);
            rgb found = render_pixel(
                *state, NULL,
                ASKEW "lights: [{point: {position: [0, 0, %g], intensity: 3, falloff: %g}}]\n"
                      "objects:\n" WALL,
                distances[d], exponents[e]);
            expect_grey(found, expected, 2e-5 * expected + ldexp(1, -LR_FILM_STEP_BITS));
        }
}

static void test_cosine(void **state)
{
    for (int angle = -80; angle <= 80; angle += 20) {
        double s = sin(angle * DEGREE), c = cos(angle * DEGREE);
        rgb point = render_pixel(
            *state, NULL,
            ASKEW "lights: [{point: {position: [0, %.9g, %.9g], intensity: 4, falloff: 2}}]\n"
                  "objects:\n" WALL,
            2 * s, 2 * c);
        expect_grey(point, c, 2e-6);
        rgb directional = render_pixel(
            *state, NULL,
            ASKEW "lights: [{directional: {direction: [0, %.9g, %.9g], color: [1, 0.5, 2]}}]\n"
                  "objects:\n" WALL,
            -7 * s, -7 * c);
        expect(directional, c, 0.5 * c, 2 * c, 2e-6);
    }
}

static void test_light_behind_on_and_at_the_surface(void **state)
{
    const char *positions[] = {"[0, 0, -1]", "[1, 0, 0]", "[0, 0, 0]"};
    for (int i = 0; i < 3; i++) {
        lr_render_stats stats;
        rgb found = render_pixel(*state, &stats,
                                 STRAIGHT "lights: [{point: {position: %s}}]\nobjects:\n" WALL,
                                 positions[i]);
        expect_grey(found, 0, 0);
        assert_int_equal(stats.shadow.traced, 0);
        assert_int_equal(stats.non_finite, 0);
    }
    rgb behind = render_pixel(
        *state, NULL, STRAIGHT "lights: [{directional: {direction: [0, 0, 1]}}]\nobjects:\n" WALL);
    expect_grey(behind, 0, 0);
}

/* Surfaces have two sides. */
static void test_back_of_a_surface(void **state)
{
    rgb found = render_pixel(*state, NULL,
                             ASKEW "lights: [{directional: {direction: [0, 0, -1]}}]\nobjects:\n"
                                   "  - plane: {normal: [0, 0, -1], material: {color: 1}}\n");
    expect_grey(found, 1, 1e-6);
}

static void test_ambient_and_color(void **state)
{
    rgb found = render_pixel(*state, NULL,
                             "camera: {from: [0, 0, 5]}\nambient: [0.1, 0.2, 0.3]\nlights: []\n"
                             "objects:\n  - plane: {normal: [0, 0, 1], material: {color: "
                             "[0.5, 1, 0.25], ambient: 2}}\n");
    expect(found, 0.1, 0.4, 0.15, 1e-7);
    found = render_pixel(*state, NULL,
                         "camera: {from: [0, 0, 5]}\nambient: 0.5\nlights: []\n"
                         "objects:\n  - plane: {normal: [0, 0, 1], material: {color: "
                         "[0.5, 1, 0.25], diffuse: [1, 0.5, 0]}}\n");
    expect(found, 0.25, 0.25, 0, 1e-7);
}

static void test_lights_add_up(void **state)
{
    rgb found = render_pixel(*state, NULL,
                             "camera: {from: [3, 0, 4]}\nambient: 0.25\nlights:\n"
                             "  - directional: {direction: [0, 0, -1], color: [1, 0, 0]}\n"
                             "  - point: {position: [0, 0, 2], intensity: 2, color: [0, 1, 0]}\n"
                             "  - point: {position: [0, 0, 2], intensity: 6, color: [0, 1, 1]}\n"
                             "objects:\n" WALL);
    expect(found, 1.25, 2.25, 1.75, 5e-6);
}

/* Sums whose low words carry over. */
static void test_many_lights_add_up(void **state)
{
    char lights[4096] = "";
    for (int i = 0; i < 40; i++)
        strcat(lights, "  - directional: {direction: [0, 0, -1], color: [0.37, 0.0511, 1e-4]}\n");
    rgb found = render_pixel(*state, NULL, ASKEW "lights:\n%sobjects:\n" WALL, lights);
    expect(found, 40 * 0.37, 40 * 0.0511, 40 * 1e-4, 1e-5);
}

/* ---- Shadows ------------------------------------------------------------------------------- */

static void check_shadow(void **state, const char *light, const char *object, double left,
                         bool traced)
{
    lr_render_stats stats;
    rgb found = render_pixel(*state, &stats, ASKEW "lights: [%s]\nobjects:\n" WALL "  - %s\n",
                             light, object);
    expect_grey(found, left, 2e-6);
    assert_int_equal(stats.shadow.traced, traced);
    assert_int_equal(stats.shadow.hit, traced && left < 1);
}

static void test_shadows(void **state)
{
    const char *at_4 = "{point: {position: [0, 0, 4], falloff: 0}}";
    const char *sun = "{directional: {direction: [0, 0, -1]}}";
    const char *between = "sphere: {center: [0, 0, 2], radius: 0.5}";
    check_shadow(state, at_4, between, 0, true);
    check_shadow(state, sun, between, 0, true);
    check_shadow(state, at_4, "sphere: {center: [0, 0, 6], radius: 0.5}", 1, true); /* beyond */
    check_shadow(state, sun, "sphere: {center: [0, 0, 600], radius: 0.5}", 0, true);
    check_shadow(state, at_4, "sphere: {center: [0, 0, 4], radius: 0.5}", 0, true); /* around */
    check_shadow(state, at_4, "sphere: {center: [0, 0, -3], radius: 0.5}", 1, true);
    check_shadow(state, at_4, "sphere: {center: [0, 2, 2], radius: 0.5}", 1, true); /* beside */
    check_shadow(state, at_4, "sphere: {center: [0, 0, 2], radius: 0.5, shadow: false}", 1, true);
    check_shadow(state, "{point: {position: [0, 0, 4], falloff: 0, shadows: false}}", between, 1,
                 false);
    check_shadow(state, at_4, "sphere: {center: [0, 0, 2], radius: 0.5, scale: [1, 1, 0.5]}", 0,
                 true);
    check_shadow(state, at_4, "plane: {normal: [0, 0, 1], offset: 4.5}", 1, true);
    check_shadow(state, at_4, "box: {min: [-1, -1, 2], max: [1, 1, 3]}", 0, true);
    check_shadow(state, at_4, "rectangle: {corner: [-1, -1, 2], u: [2, 0, 0], v: [0, 2, 0]}", 0,
                 true);
    check_shadow(state, at_4, "disk: {center: [0, 0, 2], normal: [0, 0, 1]}", 0, true);
    check_shadow(state, at_4, "triangle: {a: [-1, -1, 2], b: [1, -1, 2], c: [0, 1, 2]}", 0, true);
    check_shadow(state, at_4, "cylinder: {from: [0, -1, 2], to: [0, 1, 2], radius: 0.1}", 0, true);
    check_shadow(state, at_4, "cone: {from: [0, 0, 1], to: [0, 0, 2], radius: 0.3}", 0, true);
}

/* Light straight through a transparent object is tinted by each surface and by the way inside. */
static void test_tinted_shadows(void **state)
{
    const char *format = ASKEW "lights: [{point: {position: [0, 0, 4], falloff: 0}}]\n"
                               "objects:\n" WALL "  - %s\n";
    rgb thin = render_pixel(*state, NULL, format,
                            "rectangle: {corner: [-1, -1, 2], u: [2, 0, 0], v: [0, 2, 0], "
                            "material: {transmit: [0.5, 0.25, 0]}}");
    expect(thin, 0.5, 0.25, 0, 2e-6);
    rgb solid = render_pixel(*state, NULL, format,
                             "box: {min: [-0.5, -1, 1], max: [0.5, 1, 2.5], material: "
                             "{transmit: [0.5, 1, 0.9], absorption: [0, 0.5, 2]}}");
    expect(solid, 0.25, exp(-0.75), 0.81 * exp(-3), 1e-5);
    rgb reaching_past = render_pixel(*state, NULL, format,
                                     "box: {min: [-1, -1, 3], max: [1, 1, 9], material: "
                                     "{transmit: 0.5, absorption: 0.5}}");
    expect_grey(reaching_past, 0.5 * exp(-0.5), 1e-5); /* the light is inside */
    rgb opaque_too = render_pixel(*state, NULL, format,
                                  "sphere: {center: [0, 0, 2], radius: 0.2, material: "
                                  "{transmit: 0.9}}\n  - disk: {center: [0, 0, 3], "
                                  "normal: [0, 0, 1]}");
    expect_grey(opaque_too, 0, 0);
}

/* ---- Spots --------------------------------------------------------------------------------- */

static double smooth_step(double x)
{
    double s = fmin(fmax(x, 0), 1);
    return s * s * (3 - 2 * s);
}

static void test_spot(void **state)
{
    const double angles[] = {0, 5, 9.9, 12, 15, 20, 25, 29, 30.1, 60, 90, 120, 180};
    for (size_t i = 0; i < sizeof angles / sizeof *angles; i++) {
        double s = sin(angles[i] * DEGREE), c = cos(angles[i] * DEGREE);
        double edge = cos(30 * DEGREE), inner = cos(10 * DEGREE);
        rgb found = render_pixel(*state, NULL,
                                 ASKEW "lights: [{spot: {position: [0, 0, 2], direction: "
                                       "[0, %.9g, %.9g], angle: 30, inner: 10, intensity: 4}}]\n"
                                       "objects:\n" WALL,
                                 3 * s, -3 * c);
        expect_grey(found, smooth_step((c - edge) / (inner - edge)), 2e-5);
    }
    for (int outside = 0; outside < 2; outside++) {
        rgb hard = render_pixel(*state, NULL,
                                ASKEW "lights: [{spot: {position: [0, 0, 2], to: [0, %.9g, 0], "
                                      "angle: 30, inner: 30, falloff: 0}}]\nobjects:\n" WALL,
                                2 * tan((outside ? 30.1 : 29.9) * DEGREE));
        expect_grey(hard, outside ? 0 : 1, 1e-6);
    }
}

/* ---- Highlights ---------------------------------------------------------------------------- */

/* The eye is at (0.6, 0, 0.8), the light at this angle on the other side of the normal. */
static void check_highlight(void **state, const char *kind, double angle, double shininess)
{
    double s = sin(angle * DEGREE), c = cos(angle * DEGREE);
    double hx = 0.6 - s, hz = 0.8 + c;
    double blinn = hz / sqrt(hx * hx + hz * hz), phong = fmax(0.6 * s + 0.8 * c, 0);
    double peak = strcmp(kind, "blinn") ? phong : blinn;
    double expected = c > 0 && peak > 0 ? pow(peak, shininess) : 0;
    rgb found = render_pixel(*state, NULL,
                             ASKEW "lights: [{point: {position: [%.9g, 0, %.9g], intensity: 2, "
                                   "falloff: 1}}]\nobjects:\n"
                                   "  - plane: {normal: [0, 0, 1], material: {diffuse: 0, "
                                   "specular: [1, 0.5, 0], highlight: %s, shininess: %g}}\n",
                             -2 * s, 2 * c, kind, shininess);
    expect(found, expected, expected / 2, 0, 2e-6 * (1 + shininess));
}

static void test_highlights(void **state)
{
    const double angles[] = {36.8698976, 30, 45, 0, 80, -30, -80, 100};
    const double shininess[] = {0, 1, 32, 1.5, 500};
    for (int a = 0; a < 8; a++)
        for (int s = 0; s < 5; s++) {
            check_highlight(state, "blinn", angles[a], shininess[s]);
            check_highlight(state, "phong", angles[a], shininess[s]);
        }
}

/* ---- Fog and absorption -------------------------------------------------------------------- */

static void test_fog(void **state)
{
    double e = exp(-0.1 * 5);
    rgb wall = render_pixel(*state, NULL,
                            "camera: {from: [0, 0, 5]}\nambient: [1, 0.5, 0]\nlights: []\n"
                            "fog: {density: 0.1, color: [0, 1, 2]}\nobjects:\n" WALL);
    expect(wall, e, 0.5 * e + (1 - e), 2 * (1 - e), 1e-6);
    rgb sky = render_pixel(*state, NULL,
                           "camera: {from: [0, 0, 5], to: [0, 0, 9]}\nlights: []\n"
                           "fog: {density: 0.1, color: [0, 1, 2]}\nobjects:\n" WALL);
    expect(sky, 0, 1, 2, 1e-6);
    rgb mirror = render_pixel(*state, NULL,
                              "camera: {from: [0, 0, 5]}\nlights: []\n"
                              "fog: {density: 0.1, color: [0, 1, 2]}\nobjects:\n"
                              "  - plane: {normal: [0, 0, 1], material: {reflect: 0.5, "
                              "diffuse: 0}}\n");
    expect(mirror, 0, (1 - e) + 0.5 * e, 2 * (1 - e) + e, 1e-6);
}

/* Through a slab of 1.5 metres; there is no fog inside. */
static void test_absorption(void **state)
{
    for (int i = 0; i < 3; i++) {
        rgb found = render_pixel(*state, NULL,
                                 "camera: {from: [0, 0, 5]}\nbackground: 1\nlights: []\nobjects:\n"
                                 "  - box: {min: [-2, -2, -1], max: [2, 2, 0.5], material: "
                                 "{transmit: 1, diffuse: 0, ior: %g, absorption: [0.1, 0.5, 2]}}\n",
                                 1 + 0.5 * i);
        expect(found, exp(-0.15), exp(-0.75), exp(-3), 5e-6);
    }
    double e = exp(-0.1 * 4.5);
    rgb fog = render_pixel(*state, NULL,
                           "camera: {from: [0, 0, 5]}\nbackground: 1\nlights: []\n"
                           "fog: {density: 0.1, color: 0}\nambient: 1\nobjects:\n"
                           "  - box: {min: [-2, -2, -1], max: [2, 2, 0.5], material: "
                           "{transmit: 1, diffuse: 0, ior: 1}}\n"
                           "  - plane: {normal: [0, 0, 1], offset: -1.5, material: {color: 1}}\n");
    expect_grey(fog, e * exp(-0.05), 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_falloff),
        cmocka_unit_test(test_cosine),
        cmocka_unit_test(test_light_behind_on_and_at_the_surface),
        cmocka_unit_test(test_back_of_a_surface),
        cmocka_unit_test(test_ambient_and_color),
        cmocka_unit_test(test_lights_add_up),
        cmocka_unit_test(test_many_lights_add_up),
        cmocka_unit_test(test_shadows),
        cmocka_unit_test(test_tinted_shadows),
        cmocka_unit_test(test_spot),
        cmocka_unit_test(test_highlights),
        cmocka_unit_test(test_fog),
        cmocka_unit_test(test_absorption),
        cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device, NULL);
}
