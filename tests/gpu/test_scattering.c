/* Media that scatter light, where the light is known without tracing. */
#include "gpu_tests.h"

/* One pixel down the middle: `scene` after the camera and the picture's settings. */
static rgb through_the_middle(lr_device *device, int samples, int depth, const char *scene)
{
    return render_pixel(device, NULL,
                        "camera: {from: [0, 0, 4], to: [0, 0, 0], fov: 0.001}\n"
                        "image: {samples: %d, depth: %d, integrator: path}\n%s",
                        samples, depth, scene);
}

/* What scatters all light, in the same light from everywhere, cannot be seen, however dense it is.
 */
static void test_white_furnace(void **state)
{
    static const struct {
        const char *material;
        double tolerance; /* of the mean */
    } cases[] = {
        {"{model: dielectric, ior: 1, scattering: 1}", 1e-5},
        {"{model: dielectric, ior: 1, scattering: 5, anisotropy: 0.8}", 1e-5},
        {"{model: dielectric, ior: 1, scattering: 1.5, anisotropy: -0.9}", 1e-5},
        {"{model: dielectric, ior: 1, scattering: [0.2, 1, 4]}", 0.01},
        {"{model: dielectric, ior: 1.4, scattering: 2, anisotropy: 0.3}", 0.01},
        {"{model: dielectric, ior: 1.4, roughness: 0.5, scattering: 2}", 0.02},
        {"{model: mix, first: {model: dielectric, ior: 1, scattering: 2}, second: {color: 1}}",
         1e-4},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char scene[512];
        snprintf(scene, sizeof scene,
                 "camera: {from: [0, 0, 4], to: [0, 0, 0], fov: 30}\n"
                 "image: {width: 32, height: 32, samples: 64, depth: 64, integrator: path}\n"
                 "background: 1\nlights: []\nobjects:\n  - sphere: {material: %s}\n",
                 cases[i].material);
        picture p = render_text(*state, scene, NULL);
        for (int c = 0; c < 3; c++)
            if (!(fabs(mean_of(&p, c) - 1) <= cases[i].tolerance))
                fail_msg("%s: channel %d has mean %.7g", cases[i].material, c, mean_of(&p, c));
        assert_int_equal(p.stats.non_finite, 0);
        free_picture(&p);
    }
}

/* Without a bounce what comes through is exp(-extinction * 2), in each channel. */
static void test_extinction(void **state)
{
    rgb air = through_the_middle(*state, 64, 0,
                                 "air: {absorption: [0.1, 0.2, 0]}\nbackground: 0\nlights: []\n"
                                 "objects:\n  - sphere: {material: {diffuse: 0, emission: 1}}\n");
    assert_near(air.r, exp(-0.3), 1e-5);
    assert_near(air.g, exp(-0.6), 1e-5);
    assert_near(air.b, 1, 1e-6);
    /* The scattered light is on top of that, and there is none where the lamp is the only one and
     * cannot be reached again with no bounce left. */
    rgb mist = through_the_middle(*state, 65535, 0,
                                  "air: {absorption: [0.1, 0.2, 0], scattering: [0.2, 0, 0.1], "
                                  "anisotropy: 0.5}\nbackground: 0\nlights: []\nobjects:\n"
                                  "  - rectangle: {corner: [-1e-3, -1e-3, 1], u: [2e-3, 0, 0], v: "
                                  "[0, 2e-3, 0], material: {diffuse: 0, emission: 1}}\n");
    assert_near(mist.r, exp(-0.9), 0.01);
    assert_near(mist.g, exp(-0.6), 0.01);
    assert_near(mist.b, exp(-0.3), 0.01);
}

static double phase(double g, double cosine)
{
    return (1 - g * g) / (4 * acos(-1.0) * pow(1 + g * g - 2 * g * cosine, 1.5));
}

/* Light of a lamp at (0, h, 0) that scatters once on the line of sight from z = 4 to the wall at
 * z = -2, per unit of radiant intensity. */
static double scattered_once(double extinction, double scattering, double g, double h)
{
    enum { STEPS = 200000 };
    double sum = 0;
    for (int i = 0; i < STEPS; i++) {
        double t = 6 * (i + 0.5) / STEPS, z = 4 - t, d = hypot(z, h);
        /* The ray goes towards -z; the light comes along it from (0, h, 0). */
        double cosine = z / d;
        sum += scattering * exp(-extinction * (t + d)) * phase(g, cosine) / (d * d) * (6.0 / STEPS);
    }
    return sum;
}

/* Objects far behind the wall, so many that they have trees. */
static const char *many(void)
{
    static char text[4096];
    size_t used = 0;
    for (int i = 0; i < 40; i++)
        used += (size_t)snprintf(text + used, sizeof text - used,
                                 "  - sphere: {center: [%d, 0, -40], radius: 0.1}\n", i);
    return text;
}

/* Light of a point that scatters once, in air and in a ball that one cannot see, which holds all
 * else and dims the light within; in scenes with and without trees. */
static void test_single_scattering(void **state)
{
    static const struct {
        double absorption, scattering, g;
    } cases[] = {{0, 0.2, 0}, {0.1, 0.3, 0.7}, {0.2, 0.5, -0.6}, {0.05, 1, 0.9}};
    for (size_t i = 0; i < 4 * (sizeof cases / sizeof *cases); i++) {
        double absorption = cases[i / 4].absorption, scattering = cases[i / 4].scattering;
        double g = cases[i / 4].g;
        bool air = i & 1, trees = i & 2;
        char medium[128], scene[6000];
        snprintf(medium, sizeof medium, "absorption: %g, scattering: %g, anisotropy: %g",
                 absorption, scattering, g);
        snprintf(scene, sizeof scene,
                 "%s%s%sbackground: 0\nlights: [point: {position: [0, 1, 0], intensity: 3}]\n"
                 "objects:\n  - rectangle: {corner: [-9, -9, -2], u: [18, 0, 0], v: [0, 18, 0], "
                 "material: {diffuse: 0}}\n%s%s%s%s",
                 air ? "air: {" : "", air ? medium : "", air ? "}\n" : "", trees ? many() : "",
                 air ? "" : "  - sphere: {radius: 90, material: {model: dielectric, ior: 1, ",
                 air ? "" : medium, air ? "" : "}}\n");
        rgb found = through_the_middle(*state, 65535, 0, scene);
        double expected =
            3 * acos(-1.0) * scattered_once(absorption + scattering, scattering, g, 1);
        if (!(fabs(found.g - expected) <= 0.01 * expected))
            fail_msg("%s, %s, %s: %g, expected %g", medium, air ? "air" : "ball",
                     trees ? "trees" : "list", found.g, expected);
    }
}

/* Each channel by itself gives what three equal ones do. */
static void test_channels(void **state)
{
    static const double absorption[3] = {0.1, 0, 0.2}, scattering[3] = {0.1, 0.3, 0.6};
    rgb found = through_the_middle(
        *state, 65535, 0,
        "air: {absorption: [0.1, 0, 0.2], scattering: [0.1, 0.3, 0.6], anisotropy: 0.3}\n"
        "background: 0\nlights: [point: {position: [0, 1, 0], intensity: 3}]\nobjects:\n"
        "  - rectangle: {corner: [-9, -9, -2], u: [18, 0, 0], v: [0, 18, 0], material: {diffuse: "
        "0}}\n");
    for (int c = 0; c < 3; c++) {
        double expected =
            3 * acos(-1.0) * scattered_once(absorption[c] + scattering[c], scattering[c], 0.3, 1);
        assert_near((&found.r)[c], expected, 0.01 * expected);
    }
}

/* A lamp that surfaces and the medium between are lit by, found by asking it and by running into
 * it: the matt wall that a small lamp of area a faces at distance d sends back color * L a exp(-2 d
 * s) / (pi d^2) next to the lamp, as long as nothing scatters on the way. */
static void test_lamp_in_a_medium(void **state)
{
    rgb found = through_the_middle(
        *state, 65535, 0,
        "air: {absorption: 0.2, scattering: 1e-9}\nbackground: 0\nlights: []\nobjects:\n"
        "  - rectangle: {corner: [-9, -9, 0], u: [18, 0, 0], v: [0, 18, 0], material: {color: "
        "0.5}}\n"
        "  - disk: {center: [0.2, 0, 4], normal: [0, 0, -1], radius: 0.1, material: {diffuse: 0, "
        "emission: 1000, emits: front}}\n");
    double cosine2 = 16 / 16.04, pi = acos(-1.0);
    double irradiance = 1000 * pi * 0.01 * cosine2 / 16.04 * exp(-0.2 * sqrt(16.04));
    assert_near(found.r, 0.5 / pi * irradiance * exp(-0.2 * 4), 0.005 * found.r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_white_furnace),     cmocka_unit_test(test_extinction),
        cmocka_unit_test(test_single_scattering), cmocka_unit_test(test_channels),
        cmocka_unit_test(test_lamp_in_a_medium),  cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device, NULL);
}
