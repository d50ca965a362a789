/* Cameras against their formulas in double precision: where rays start and go, and how wide a lens
 * blurs what is out of focus. */
#include "gpu_tests.h"

#define PI 3.14159265358979323846

typedef struct vector {
    double x, y, z;
} vector;

static lr_scene *parse(const char *text)
{
    lr_scene *scene = NULL;
    char *report = NULL;
    lr_error error = {0};
    if (lr_scene_parse(text, strlen(text), "test.yaml", &scene, &report, &error))
        fail_msg("%s\n%s\n%s", error.message, report ? report : "", text);
    return scene;
}

/* The ray of a camera through a pixel, as the kernels that make pictures have it. */
static lr_explained_ray ray_of(lr_device *device, const lr_scene *scene, const char *camera,
                               uint32_t x, uint32_t y, uint32_t sample)
{
    lr_explanation explanation;
    lr_error error = {0};
    const lr_render_options options = {.camera = camera};
    if (lr_explain(device, scene, &options, x, y, sample, &explanation, &error))
        fail_msg("%s", error.message);
    lr_explained_ray ray = explanation.rays[0];
    lr_explanation_free(&explanation);
    return ray;
}

static void expect_vector(const float found[3], vector expected, double tolerance)
{
    assert_near(found[0], expected.x, tolerance);
    assert_near(found[1], expected.y, tolerance);
    assert_near(found[2], expected.z, tolerance);
}

#define OBJECTS "background: 0\nlights: []\nobjects: [{sphere: {center: [0, 0, -100]}}]\n"

static void test_orthographic(void **state)
{
    /* The view is along -z, the picture 8 x 4 pixels and 2 m high. */
    lr_scene *scene =
        parse("cameras:\n"
              "  given: {from: [1, 2, 3], to: [1, 2, 0], projection: orthographic, height: 2}\n"
              "  fitted: {from: [1, 2, 3], to: [1, 2, 0], projection: orthographic, fov: 90}\n"
              "image: {width: 8, height: 4}\n" OBJECTS);
    for (uint32_t i = 0; i < 4; i++) {
        uint32_t x = (i * 7) % 8, y = i;
        lr_explained_ray ray = ray_of(*state, scene, "given", x, y, 0);
        expect_vector(ray.direction, (vector){0, 0, -1}, 1e-6);
        expect_vector(ray.origin, (vector){1 + (x + 0.5 - 4) * 0.5, 2 - (y + 0.5 - 2) * 0.5, 3},
                      1e-6);
    }
    /* Without a height it shows what 90 degrees show 3 m away: 6 m. */
    lr_explained_ray ray = ray_of(*state, scene, "fitted", 0, 0, 0);
    expect_vector(ray.origin, (vector){1 - 3.5 * 1.5, 2 + 1.5 * 1.5, 3}, 1e-5);
    lr_scene_destroy(scene);
}

static void test_panorama(void **state)
{
    lr_scene *scene = parse("camera: {from: [1, 2, 3], to: [5, 2, 3], projection: panorama}\n"
                            "image: {width: 16, height: 8}\n" OBJECTS);
    const uint32_t places[][2] = {{8, 4}, {0, 0}, {3, 6}, {12, 3}, {15, 7}};
    for (uint32_t i = 0; i < 5; i++) {
        uint32_t x = places[i][0], y = places[i][1];
        lr_explained_ray ray = ray_of(*state, scene, NULL, x, y, 0);
        /* Forward is +x, right +z, up +y. */
        double longitude = (x + 0.5 - 8) / 16 * 2 * PI, latitude = -(y + 0.5 - 4) / 8 * PI;
        expect_vector(ray.origin, (vector){1, 2, 3}, 0);
        expect_vector(
            ray.direction,
            (vector){cos(latitude) * cos(longitude), sin(latitude), cos(latitude) * sin(longitude)},
            1e-6);
    }
    lr_scene_destroy(scene);
}

/* All rays of a lens meet where the pinhole's ray crosses the plane in focus. */
static void test_lens_focus(void **state)
{
    lr_scene *scene = parse("cameras:\n"
                            "  lens: {to: [0, 0, -1], from: [0, 0, 0], aperture: 0.5, focus: 4}\n"
                            "  pinhole: {to: [0, 0, -1], from: [0, 0, 0]}\n"
                            "image: {width: 30, height: 20, samples: 16}\n" OBJECTS);
    double spread = 0;
    for (uint32_t i = 0; i < 8; i++) {
        lr_explained_ray pinhole = ray_of(*state, scene, "pinhole", 3, 15, 2 * i);
        lr_explained_ray lens = ray_of(*state, scene, "lens", 3, 15, 2 * i);
        double t = (-4 - (double)lens.origin[2]) / lens.direction[2];
        double s = -4 / (double)pinhole.direction[2];
        assert_near(lens.origin[2], 0, 1e-7);
        assert_near(lens.origin[0] + t * lens.direction[0], s * pinhole.direction[0], 1e-5);
        assert_near(lens.origin[1] + t * lens.direction[1], s * pinhole.direction[1], 1e-5);
        double aside = hypot(lens.origin[0], lens.origin[1]);
        assert_true(aside <= 0.25 + 1e-6);
        spread = fmax(spread, aside);
    }
    assert_true(spread > 0.12);
    lr_scene_destroy(scene);
}

/* The light of a picture: its sum, where its middle is, and moments about that, in pixels. */
typedef struct spread {
    double sum, x, y, xx, yy, yyy;
} spread;

static spread spread_of(const picture *p)
{
    spread s = {0};
    for (uint32_t pass = 0; pass < 2; pass++) {
        spread next = {.x = s.x, .y = s.y};
        double x_sum = 0, y_sum = 0;
        for (uint32_t i = 0; i < p->image.width * p->image.height; i++) {
            double value = p->image.pixels[3 * i];
            double x = i % p->image.width + 0.5, y = i / p->image.width + 0.5;
            next.sum += value;
            x_sum += value * x;
            y_sum += value * y;
            next.xx += value * (x - s.x) * (x - s.x);
            next.yy += value * (y - s.y) * (y - s.y);
            next.yyy += value * (y - s.y) * (y - s.y) * (y - s.y);
        }
        next.x = x_sum / next.sum;
        next.y = y_sum / next.sum;
        next.xx /= next.sum;
        next.yy /= next.sum;
        next.yyy /= next.sum;
        s = next;
    }
    return s;
}

/* A picture 64 pixels high of 90 degrees at distance `to`, of a small glowing ball in its middle.
 */
static spread blur(lr_device *device, double distance, const char *lens, const char *integrator)
{
    char text[1024];
    double radius = 1.5 * distance / 64;
    snprintf(text, sizeof text,
             "camera: {from: [0, 0, 0], to: [0, 0, -4], fov: 90, %s}\n"
             "image: {width: 128, height: 128, samples: 256, integrator: %s}\n"
             "background: 0\nambient: 0\nlights: []\n"
             "objects: [{sphere: {center: [0, 0, %.9g], radius: %.9g, material: {color: 0, "
             "emission: 1}}}]\n",
             lens, integrator, -distance, radius);
    picture p = render_text(device, text, NULL);
    spread s = spread_of(&p);
    free_picture(&p);
    return s;
}

static void test_blur(void **state)
{
    /* The pixel and the ball, both seen through a pinhole: what a blur adds to. */
    for (int path = 0; path < 2; path++) {
        const char *integrator = path ? "path" : "whitted";
        double aperture = 1.5, focus = 4, pixel_at_focus = 2 * focus / 128;
        const double distances[] = {8, 2.5, 4};
        for (int i = 0; i < 3; i++) {
            double d = distances[i];
            spread sharp = blur(*state, d, "aperture: 0", integrator);
            spread wide = blur(*state, d, "aperture: 1.5, focus: 4", integrator);
            double diameter = aperture * fabs(d - focus) / d / pixel_at_focus;
            double expected = diameter * diameter / 16; /* the variance of a disk along a line */
            print_message("%s, %g m: blurred to %.3f, expected %.3f pixels\n", integrator, d,
                          4 * sqrt(fabs(wide.xx - sharp.xx)), diameter);
            assert_near(wide.xx - sharp.xx, expected, 0.03 * expected + 0.05);
            assert_near(wide.yy - sharp.yy, expected, 0.03 * expected + 0.05);
            assert_near(wide.x, 64, 0.1);
            assert_near(wide.y, 64, 0.1);
        }
    }
}

/* A triangle that points up, behind the focus; upside down before it and when it is turned. */
static void test_blades(void **state)
{
    double radius = 0.75 * 4 / 8 / (2 * 4.0 / 128),
           variance = radius * radius * (2 + cos(2 * PI / 3)) / 12;
    spread sharp = blur(*state, 8, "aperture: 0", "whitted");
    spread up = blur(*state, 8, "aperture: 1.5, focus: 4, blades: 3", "whitted");
    spread down =
        blur(*state, 8, "aperture: 1.5, focus: 4, blades: 3, blade_rotation: 180", "whitted");
    spread before = blur(*state, 2.5, "aperture: 1.5, focus: 4, blades: 3", "whitted");
    spread right =
        blur(*state, 8, "aperture: 1.5, focus: 4, blades: 3, blade_rotation: 90", "whitted");
    assert_near(up.xx - sharp.xx, variance, 0.04 * variance);
    assert_near(up.yy - sharp.yy, variance, 0.04 * variance);
    /* y counts downwards: the corner that points up is a long tail of small y. */
    double skew = 0.4 * variance * sqrt(variance);
    assert_true(up.yyy < -skew);
    assert_true(down.yyy > skew);
    assert_true(before.yyy > skew);
    assert_near(right.yyy, 0, 0.25 * skew);
}

/* A ball 12 pixels wide, blurred by filters: variances add up. */
static void test_filters(void **state)
{
    static const char world[] =
        "camera: {from: [0, 0, 8], to: [0, 0, 0], projection: orthographic, height: 24}\n"
        "image: {width: 24, height: 24, samples: 1024, integrator: %s, filter: %s}\n"
        "background: 0\nambient: 0\nlights: []\n"
        "objects: [{sphere: {radius: 6, material: {color: 0, emission: 1}}}]\n";
    const char *names[] = {"box", "tent", "blackman-harris"};
    const double variances[] = {1.0 / 12, 1.0 / 6, 0.172658};
    for (int i = 0; i < 6; i++) {
        char text[1024];
        snprintf(text, sizeof text, world, i / 3 ? "path" : "whitted", names[i % 3]);
        picture p = render_text(*state, text, NULL);
        spread s = spread_of(&p);
        assert_near(s.sum, 36 * PI, 0.1);
        assert_near(s.x, 12, 0.02);
        assert_near(s.y, 12, 0.02);
        assert_near(s.xx, 36 / 4.0 + variances[i % 3], 0.035);
        assert_near(s.yy, 36 / 4.0 + variances[i % 3], 0.035);
        /* The options' filter comes before the scene's. */
        picture other =
            render_text(*state, text, &(lr_render_options){.filter = LR_FILTER_BLACKMAN_HARRIS});
        assert_int_equal(strcmp(p.stats.hash, other.stats.hash) == 0, i % 3 == 2);
        free_picture(&p);
        free_picture(&other);
    }
}

/* A camera that goes 16 m to the right while a frame lasts; its shutter is open for half of it, a
 * pixel is a metre. */
static void test_motion(void **state)
{
    static const char world[] =
        "camera: {from: {keys: {0: [0, 0, 8], 1: [16, 0, 8]}}, to: {keys: {0: [0, 0, 0], 1: [16, "
        "0, "
        "0]}},\n"
        "         projection: %s, height: 32, fov: %.17g, shutter: %g}\n"
        "image: {width: 32, height: 32, samples: 1024, integrator: %s}\n"
        "background: 0\nambient: 0\nlights: []\n"
        "objects: [{sphere: {radius: 3, material: {color: 0, emission: 1}}}]\n";
    for (int i = 0; i < 4; i++) {
        const char *projection = i % 2 ? "perspective" : "orthographic";
        const char *integrator = i / 2 ? "path" : "whitted";
        spread s[2];
        for (int blurred = 0; blurred < 2; blurred++) {
            char text[1024];
            /* In perspective, 32 m are seen 8 m away. */
            snprintf(text, sizeof text, world, projection, 2 * atan(2) * 180 / PI,
                     blurred ? 0.5 : 0, integrator);
            picture p = render_text(*state, text, NULL);
            s[blurred] = spread_of(&p);
            free_picture(&p);
        }
        if (i % 2) { /* the ball is seen from aside, too, so only its middle is known */
            assert_near(s[0].x, 16, 0.05);
            assert_true(s[1].x < 13 && s[1].xx > s[0].xx + 4);
            continue;
        }
        assert_near(s[1].sum, s[0].sum, 0.02 * s[0].sum);
        assert_near(s[1].x, 16 - 4, 0.1);
        assert_near(s[1].y, 16, 0.05);
        assert_near(s[1].xx - s[0].xx, 64 / 12.0, 0.15);
        assert_near(s[1].yy - s[0].yy, 0, 0.05);
    }
}

/* One sample goes through the middle of the pixel, whatever the filter. */
static void test_single_sample(void **state)
{
    char hash[65] = "";
    for (lr_filter filter = LR_FILTER_BOX; filter <= LR_FILTER_BLACKMAN_HARRIS; filter++) {
        picture p = render_text(
            *state, "camera: {}\nimage: {width: 40, height: 30}\nobjects: [{sphere: {}}]\n",
            &(lr_render_options){.filter = filter});
        if (filter > LR_FILTER_BOX)
            assert_string_equal(p.stats.hash, hash);
        memcpy(hash, p.stats.hash, sizeof hash);
        free_picture(&p);
    }
}

/* The same pinhole camera has the same picture in the company of lenses. */
static void test_pinhole_bits(void **state)
{
    static const char world[] =
        "image: {width: 40, height: 30, samples: %u}\n"
        "objects: [{plane: {}}, {sphere: {center: [0, 1, 0], material: {reflect: 0.5}}}]\n";
    for (uint32_t samples = 1; samples <= 5; samples += 4) {
        char hashes[2][65];
        for (int i = 0; i < 2; i++) {
            char text[512];
            int used = snprintf(text, sizeof text,
                                "cameras:\n  a: {from: [1, 2, 5.1], up: [0.1, 1, 0]}\n%s",
                                i ? "  b: {aperture: 0.3}\n  c: {projection: panorama}\n" : "");
            snprintf(text + used, sizeof text - (size_t)used, world, samples);
            picture p = render_text(*state, text, NULL);
            memcpy(hashes[i], p.stats.hash, sizeof p.stats.hash);
            free_picture(&p);
        }
        assert_string_equal(hashes[0], hashes[1]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_orthographic),  cmocka_unit_test(test_panorama),
        cmocka_unit_test(test_lens_focus),    cmocka_unit_test(test_blur),
        cmocka_unit_test(test_blades),        cmocka_unit_test(test_pinhole_bits),
        cmocka_unit_test(test_filters),       cmocka_unit_test(test_motion),
        cmocka_unit_test(test_single_sample), cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device, NULL);
}
