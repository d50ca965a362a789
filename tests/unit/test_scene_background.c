/* What is seen infinitely far away: its keys, the pictures that cannot be light, and the sky. */
#include "scene_tests.h"

#include "base/exact.h"
#include "scene/fingerprint.h"
#include "scene/sky.h"
#include "temporary_folder.h"

#define OBJECTS "camera: {}\nobjects: [sphere: {}]\n"

/* A float picture of 3 x 2, row by row from the top, red, green and blue the same. */
static void save(const char *name, const float values[6])
{
    char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fputs("PF\n3 2\n-1\n", file);
    for (int i = 0; i < 6; i++) {
        float grey = values[i < 3 ? i + 3 : i - 3]; /* the lowest row comes first */
        assert_int_equal(fwrite((float[3]){grey, grey, grey}, 12, 1, file), 1);
    }
    assert_int_equal(fclose(file), 0);
}

/* The scene with this background in the folder, or NULL and the report. */
static lr_scene *parse(const char *background, char **report)
{
    char text[1024], name[128];
    lr_scene *scene = NULL;
    int length = snprintf(text, sizeof text, "background: %s\n" OBJECTS, background);
    snprintf(name, sizeof name, "%s/s.yaml", folder);
    *report = NULL;
    lr_scene_parse(text, (size_t)length, name, &scene, report, NULL);
    return scene;
}

static lr_scene *parse_well(const char *background)
{
    char *report;
    lr_scene *scene = parse(background, &report);
    if (!scene)
        fail_msg("%s", report);
    return scene;
}

static void expect_report(const char *background, const char *fragment)
{
    char *report;
    lr_scene *scene = parse(background, &report);
    if (scene || !strstr(report, fragment))
        fail_msg("%s\nexpected: %s\n%s", background, fragment, report ? report : "no error");
    free(report);
}

static void test_values(void **state)
{
    (void)state;
    save("good.pfm", (const float[6]){0, 1, 2, 0, 0.5f, 1e12f});
    lr_scene *s = parse_well("{image: good.pfm, intensity: 2.5, rotate: -90}");
    assert_int_equal(s->background.kind, LR_BACKGROUND_IMAGE);
    assert_near(s->background.intensity, 2.5, 0);
    assert_near(s->background.rotate, -90, 0);
    const lr_texture *texture = &s->textures[s->background.texture];
    assert_int_equal(texture->width, 3);
    assert_int_equal(texture->wrap_u, LR_WRAP_REPEAT);
    assert_int_equal(texture->wrap_v, LR_WRAP_CLAMP);
    lr_scene_destroy(s);
    s = parse_well("{sky: [0, 2, 1]}");
    assert_int_equal(s->background.kind, LR_BACKGROUND_SKY);
    assert_near(s->background.sun.y, 2, 0);
    assert_near(s->background.turbidity, 3, 0);
    assert_near(s->background.ground.x, 0.2, 0);
    assert_near(s->background.intensity, 1, 0);
    lr_scene_destroy(s);
    s = parse_well("{gradient: [0, 0.5]}");
    assert_int_equal(s->background.kind, LR_BACKGROUND_GRADIENT);
    assert_near(s->background.colors[1].y, 0.5, 0);
    lr_scene_destroy(s);
}

static void test_errors(void **state)
{
    (void)state;
    save("nan.pfm", (const float[6]){0, 1, 2, 0, NAN, 1});
    save("infinite.pfm", (const float[6]){0, 1, INFINITY, 0, 3, 1});
    save("negative.pfm", (const float[6]){-1, 1, 1, 0, 3, 1});
    save("bright.pfm", (const float[6]){1, 1, 1, 0, 3, 2e12f});
    save("black.pfm", (const float[6]){0, 0, 0, 0, 0, -0.0f});
    expect_report("{image: nan.pfm}",
                  "nan.pfm: the pixel in column 1 of row 1, both from 0, is not a number");
    expect_report("{image: infinite.pfm}", "column 2 of row 0, both from 0, is infinite");
    expect_report("{image: negative.pfm}", "column 0 of row 0, both from 0, is negative");
    expect_report("{image: bright.pfm}", "column 2 of row 1, both from 0, is too bright");
    expect_report("{image: black.pfm}", "black.pfm is black everywhere");
    expect_report("{image: none.pfm}", "none.pfm");
    expect_report("{image: ../s.pfm}", "s.pfm");
    expect_report("{image: [1]}", "image is a list");
    expect_report("{intensity: 2}", "background has no kind, expected gradient, image or sky");
    expect_report("{}", "background has no kind");
    expect_report("{imag: good.pfm}", "did you mean \"image\"");
    expect_report("{image: good.pfm, intensity: -1}", "intensity is -1");
    expect_report("{sky: [0, 1, 0], image: good.pfm}", "unknown key");
    expect_report("{sky: [1, -0.1, 0]}", "the sun is not above the horizon");
    expect_report("{sky: [1, 0, 0]}", "the sun is not above the horizon");
    expect_report("{sky: [0, 0, 0]}", "sky is [0, 0, 0]");
    expect_report("{sky: [0, 1, 0], turbidity: 1}",
                  "turbidity is 1, expected a number from 1.7 to 10");
    expect_report("{sky: [0, 1, 0], ground: 2}", "ground is 2");
}

/* Written and read again it is the same; also in another folder than the picture's. */
static void test_conversion(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "{image: good.pfm, intensity: 2.5, rotate: 12}",
        "{sky: [0.1, 0.2, 0.3], ground: [0, 0.5, 1], turbidity: 6}"};
    char path[128];
    snprintf(path, sizeof path, "%s/out.yaml", folder);
    for (int i = 0; i < 2; i++) {
        lr_scene *scene = parse_well(texts[i]), *again = NULL;
        char *notes = NULL, *report = NULL, hashes[2][65];
        lr_error error = {0};
        if (lr_scene_write(scene, path, LR_SCENE_YAML, &notes, &error))
            fail_msg("%s", error.message);
        assert_null(notes);
        if (lr_scene_load(path, NULL, &again, &report, &error))
            fail_msg("%s", report);
        lr_scene_hash(scene, hashes[0]);
        lr_scene_hash(again, hashes[1]);
        assert_string_equal(hashes[0], hashes[1]);
        lr_scene_destroy(scene);
        lr_scene_destroy(again);
    }
}

/* ---- The sky ------------------------------------------------------------------------------- */

static void test_arccosine(void **state)
{
    (void)state;
    assert_true(lr_acos(1) == 0);
    for (int i = -100000; i <= 100000; i++)
        assert_near(lr_acos(i / 1e5), acos(i / 1e5), 1e-15);
    assert_near(lr_acos(1 - 1e-12), acos(1 - 1e-12), 1e-18);
}

/* What is measured: a clear sky's light on the ground is 5 to 25 klx, the sun's about 100 klx when
 * it is high; both as in the model's own words bluer above than at the horizon, and redder when
 * low. */
static void test_sky(void **state)
{
    (void)state;
    double before = 0;
    for (int degrees = 5; degrees <= 85; degrees += 10) {
        double height = sin(degrees * 0.017453292519943295), sum = 0;
        lr_sky sky = lr_sky_make(3, height);
        /* The zenith is by construction what the paper's formula says, in kcd/m^2. */
        double a = acos(height), chi = (4.0 / 9 - 3.0 / 120) * (3.14159265358979 - 2 * a);
        double zenith = (4.0453 * 3 - 4.9710) * tan(chi) - 0.2155 * 3 + 2.4192;
        lr_color up = lr_sky_radiance(&sky, 1, height), low = lr_sky_radiance(&sky, 0.02, 0);
        double luminance = 0.2126729 * up.x + 0.7151522 * up.y + 0.0721750 * up.z;
        assert_near(luminance * 10, zenith, 1e-4 * zenith);
        assert_true(up.z / up.x > low.z / low.x);
        for (int y = 0; y < 50; y++) /* uniform in height and azimuth, seen from the ground */
            for (int x = 0; x < 100; x++) {
                double h = (y + 0.5) / 50, r = sqrt(1 - h * h), azimuth = (x + 0.5) / 100;
                double cosine =
                    h * height + r * cos(6.2831853 * azimuth) * sqrt(1 - height * height);
                sum += 10 * lr_sky_radiance(&sky, h, cosine).y * h * 6.2831853 / 5000;
            }
        assert_in_range((uint64_t)(sum * 1000), 3000, 40000);
        lr_color sun = lr_sun_radiance(&sky);
        double solid_angle = 2 * 3.14159265 * (1 - cos(0.265 * 0.017453292519943295));
        double klx = 10 * sun.y * solid_angle;
        assert_true(klx > before && klx < 110);
        assert_true(sun.x > sun.y && sun.y > sun.z);
        before = klx;
    }
    assert_true(before > 85);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_values),     cmocka_unit_test(test_errors),
        cmocka_unit_test(test_conversion), cmocka_unit_test(test_arccosine),
        cmocka_unit_test(test_sky),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
