/* A picture that becomes finer step by step ends as the one that lr_render makes, and the window's
 * bytes are those of its PPM file. */
#include "gpu_tests.h"

#include "render/progressive.h"
#include "render/settings.h"

static const char scene_text[] =
    "camera: {from: [0, 2, 7], to: [0, 0.8, 0]}\n"
    "image: {width: 61, height: 47, samples: 3, depth: 4, seed: 7}\n"
    "fog: {density: 0.01, color: [0.6, 0.7, 0.8]}\n"
    "objects:\n"
    "  - plane: {material: {color: {checker: [white, [0.05, 0.05, 0.05]]}, reflect: 0.2}}\n"
    "  - sphere: {center: [-1.2, 1, 0], material: {diffuse: 0, transmit: 0.95, ior: 1.5, fresnel: "
    "true}}\n"
    "  - sphere: {center: [1.2, 1, 0], material: {color: red, reflect: 0.3, emission: [1e9, 0, "
    "0]}}\n"
    "  - box: {min: [2.5, 0, -1], max: [3, 1.5, 0]}\n";

/* Spheres come to it: more primitives than a scene without trees has. */
static const char tree_text[] = "camera: {from: [0, 2, 7], to: [0, 0.8, 0]}\n"
                                "image: {width: 40, height: 33, samples: 2, depth: 2}\n"
                                "lights: [{point: {position: [3, 5, 4], intensity: 30}}, "
                                "{directional: {direction: [0, -1, 0]}}]\n"
                                "objects:\n"
                                "  - plane: {material: {reflect: 0.2}}\n";

typedef struct viewer {
    lr_device *device;
    lr_scene *scene;
    lr_settings settings;
    lr_progressive *progressive;
} viewer;

static bool always(void *user, double fraction)
{
    (void)user, (void)fraction;
    return true;
}

/* Says no when the count in *user is used up. */
static bool so_often(void *user, double fraction)
{
    (void)fraction;
    int *left = user;
    return (*left)-- > 0;
}

static viewer begin_inspecting(lr_device *device, const char *text, lr_inspect inspect)
{
    viewer v = {.device = device};
    char *report = NULL;
    lr_error message = {0};
    if (lr_scene_parse(text, strlen(text), "test.yaml", &v.scene, &report, &message))
        fail_msg("%s", report ? report : message.message);
    MUST(lr_settle(v.scene, &(lr_render_options){0}, &v.settings, error));
    v.settings.inspect = inspect;
    MUST(lr_progressive_create(device, v.scene, &v.settings, &v.progressive, error));
    MUST(lr_progressive_start(v.progressive, &v.settings, error));
    return v;
}

static viewer begin(lr_device *device, const char *text)
{
    return begin_inspecting(device, text, LR_INSPECT_LIGHT);
}

static void end(viewer *v)
{
    lr_progressive_destroy(v->progressive);
    lr_scene_destroy(v->scene);
}

static uint32_t finish(viewer *v, double seconds)
{
    uint32_t steps = 0;
    double done = 0;
    for (; !v->progressive->finished; steps++) {
        MUST(lr_progressive_step(v->progressive, seconds, always, NULL, error));
        double now = lr_progressive_done(v->progressive);
        assert_true(now > done);
        done = now;
        assert_true(steps < 100000);
    }
    assert_true(done == 1);
    assert_true(v->progressive->shown);
    return steps;
}

static void hash_now(viewer *v, char hash[65])
{
    lr_picture shown;
    MUST(lr_progressive_picture(v->progressive, &shown, error));
    lr_picture_hash(&shown, hash);
    lr_picture_free(&shown);
}

static void hash_rendered(viewer *v, const lr_settings *settings, char hash[65])
{
    lr_picture shown;
    lr_render_options options = {
        .width = settings->width,
        .height = settings->height,
        .samples = settings->samples,
        .depth = (int32_t)settings->depth,
        .has_depth = true,
    };
    MUST(lr_render(v->device, v->scene, &options, &shown, NULL, error));
    lr_picture_hash(&shown, hash);
    lr_picture_free(&shown);
}

static void expect_render(viewer *v)
{
    char hash[65], expected[65];
    hash_now(v, hash);
    hash_rendered(v, &v->settings, expected);
    assert_string_equal(hash, expected);
}

static void check_scene(lr_device *device, const char *text)
{
    viewer v = begin(device, text);
    uint32_t coarse = finish(&v, 1);
    expect_render(&v);

    /* In the smallest steps, the first pixels far apart. */
    v.progressive->seconds_per_ray = 1;
    MUST(lr_progressive_start(v.progressive, &v.settings, error));
    assert_int_equal(v.progressive->sweep.step, LR_COARSE_MAX);
    uint32_t fine = finish(&v, 1e-9);
    assert_true(fine > coarse);
    expect_render(&v);

    /* Another size, depth and number of samples; odd sizes smaller than a block. */
    static const lr_settings others[] = {{.width = 7, .height = 90, .samples = 5, .depth = 1},
                                         {.width = 33, .height = 1, .samples = 1, .depth = 0},
                                         {.width = 1, .height = 1, .samples = 64, .depth = 3}};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        v.settings.width = v.settings.crop_width = others[i].width;
        v.settings.height = v.settings.crop_height = others[i].height;
        v.settings.samples = others[i].samples;
        v.settings.depth = others[i].depth;
        v.progressive->seconds_per_ray = i == 0 ? 1 : 1e-6;
        MUST(lr_progressive_start(v.progressive, &v.settings, error));
        finish(&v, 0.001);
        expect_render(&v);
    }
    end(&v);
}

static void test_few_primitives(void **state)
{
    check_scene(*state, scene_text);
}

static void append_spheres(char *text)
{
    for (int i = 0; i < 40; i++)
        sprintf(text + strlen(text), "  - sphere: {center: [%d, 0.4, %d], radius: 0.4}\n",
                i % 8 - 4, i / 8 - 3);
}

static void test_trees(void **state)
{
    char text[8192];
    strcpy(text, tree_text);
    append_spheres(text);
    check_scene(*state, text);
}

/* Whenever it is interrupted, what is started next is not tainted by what was under way. */
static void test_interruptions(void **state)
{
    char text[8192];
    strcpy(text, tree_text);
    append_spheres(text);
    viewer v = begin(*state, text);
    for (int passes = 0; passes < 5; passes++) {
        int left = passes;
        lr_status status = LR_OK;
        while (!status && !v.progressive->finished)
            status = lr_progressive_step(v.progressive, 1e-9, so_often, &left, NULL);
        assert_int_equal(status, LR_ERROR_INTERRUPTED);
        MUST(lr_progressive_start(v.progressive, &v.settings, error));
    }
    finish(&v, 0.01);
    expect_render(&v);
    end(&v);
}

/* Another camera needs no other kernels, and its media and default light are those of a render. */
static void test_camera(void **state)
{
    viewer v = begin(*state, scene_text);
    lr_camera camera = v.scene->cameras[0], first = camera;
    camera.from = (lr_vec3){-1.2, 1.1, 0.2}; /* within the glass */
    camera.to = (lr_vec3){2, 0.5, 0.3};
    camera.fov = 70;
    v.settings.camera = &camera;
    MUST(lr_progressive_start(v.progressive, &v.settings, error));
    finish(&v, 0.01);
    v.scene->cameras[0] = camera;
    expect_render(&v);
    v.scene->cameras[0] = first;
    v.settings.camera = &v.scene->cameras[0];
    MUST(lr_progressive_start(v.progressive, &v.settings, error));
    finish(&v, 0.01);
    expect_render(&v);
    end(&v);
}

static void draw(viewer *v, lr_display *display, const lr_look *look, uint32_t *pixels)
{
    lr_buffer host;
    VkDeviceSize size = 4ull * display->width * display->height;
    MUST(lr_buffer_create(v->device, LR_BUFFER_HOST, size, "the test", &host, error));
    MUST(lr_commands_begin(v->device, error));
    lr_display_record(display, &v->progressive->wavefront.film, look);
    lr_commands_copy(v->device, &display->canvas, &host, size);
    MUST(lr_commands_finish(v->device, error));
    memcpy(pixels, host.mapped, size);
    lr_buffer_destroy(v->device, &host);
}

static void expect_ppm(viewer *v, const lr_look *look, const uint32_t *pixels)
{
    lr_picture shown;
    unsigned char *bytes;
    size_t size, raster = 3 * (size_t)v->settings.width * v->settings.height;
    MUST(lr_progressive_picture(v->progressive, &shown, error));
    lr_encoding encoding = {.format = LR_FORMAT_PPM, .exposure = (float)look->exposure};
    MUST(lr_picture_encode(&shown, &encoding, &bytes, &size, error));
    const unsigned char *in = bytes + size - raster;
    for (size_t i = 0; i < raster / 3; i++, in += 3) {
        uint32_t expected = in[look->blue_first ? 2 : 0] | in[1] << 8 |
                            in[look->blue_first ? 0 : 2] << 16 | 0xFF000000u;
        if (pixels[i] != expected)
            fail_msg("pixel %zu is %08x, not %08x", i, pixels[i], expected);
    }
    free(bytes);
    lr_picture_free(&shown);
}

static void test_window_has_the_bytes_of_files(void **state)
{
    viewer v = begin(*state, scene_text);
    lr_display display;
    uint32_t pixels[61 * 47];
    MUST(lr_display_create(v.device, &display, error));
    MUST(lr_display_resize(&display, 61, 47, error));
    v.progressive->seconds_per_ray = 1;
    MUST(lr_progressive_start(v.progressive, &v.settings, error));
    static const double exposures[] = {0, 1.5, -3, 60, -64};
    for (uint32_t step = 0; !v.progressive->finished; step++) {
        MUST(lr_progressive_step(v.progressive, 0.001, always, NULL, error));
        if (!v.progressive->shown)
            continue;
        lr_look look = {.exposure = exposures[step % 5], .blue_first = step % 2};
        lr_progressive_look(v.progressive, &look);
        draw(&v, &display, &look, pixels);
        expect_ppm(&v, &look, pixels);
    }
    for (int i = 0; i < 5; i++) {
        lr_look look = {.exposure = exposures[i]};
        lr_progressive_look(v.progressive, &look);
        draw(&v, &display, &look, pixels);
        expect_ppm(&v, &look, pixels);
    }
    lr_display_destroy(&display);
    end(&v);
}

static uint64_t rays_of(const lr_render_stats *s)
{
    return s->primary.traced + s->reflected.traced + s->refracted.traced + s->shadow.traced;
}

/* The numbers of rays that the pixels show add up to those that the same picture in light takes. */
static void check_ray_counts(lr_device *device, const char *text)
{
    viewer v = begin(device, text);
    finish(&v, 0.01);
    uint64_t expected = rays_of(&v.progressive->stats);
    end(&v);
    v = begin_inspecting(device, text, LR_INSPECT_RAYS);
    finish(&v, 0.01);
    lr_picture shown;
    MUST(lr_progressive_picture(v.progressive, &shown, error));
    double counted = 0;
    for (size_t i = 0; i < (size_t)shown.width * shown.height; i++)
        counted += (double)shown.pixels[3 * i] * v.settings.samples / LR_GPU_INSPECT_RAY;
    assert_near(counted, (double)expected, 1e-6 * (double)expected);
    lr_picture_free(&shown);
    end(&v);
}

static void test_ray_counts(void **state)
{
    char text[8192];
    check_ray_counts(*state, scene_text);
    strcpy(text, tree_text);
    append_spheres(text);
    check_ray_counts(*state, text);
}

static void expect_pixel(lr_device *device, lr_inspect inspect, uint32_t x, uint32_t y,
                         const double expected[3])
{
    static const char text[] = "camera: {from: [0, 0, 5], to: [0, 0, 0], fov: 90}\n"
                               "image: {width: 3, height: 3, samples: 1}\n"
                               "objects:\n"
                               "  - sphere: {radius: 1}\n"
                               "  - plane: {normal: [0, 1, 0], offset: -2.5}\n";
    viewer v = begin_inspecting(device, text, inspect);
    finish(&v, 1);
    lr_picture shown;
    MUST(lr_progressive_picture(v.progressive, &shown, error));
    for (int i = 0; i < 3; i++)
        assert_near(shown.pixels[3 * (y * 3 + x) + (uint32_t)i], expected[i], 1e-5);
    lr_picture_free(&shown);
    end(&v);
}

static void test_inspected_values(void **state)
{
    /* The sphere faces the camera 4 m away, whose focus is 5 m away; nothing is above. The ray
     * through the middle of the bottom row meets the plane where it has gone 2.5 down and, with a
     * slope of 2/3, 3.75 ahead. */
    double ground = sqrt(2.5 * 2.5 + 3.75 * 3.75);
    expect_pixel(*state, LR_INSPECT_NORMAL, 1, 1, (double[]){0.5, 0.5, 1});
    expect_pixel(*state, LR_INSPECT_NORMAL, 1, 2, (double[]){0.5, 1, 0.5});
    expect_pixel(*state, LR_INSPECT_NORMAL, 1, 0, (double[]){0, 0, 0});
    expect_pixel(*state, LR_INSPECT_DEPTH, 1, 1, (double[]){5.0 / 9, 5.0 / 9, 5.0 / 9});
    expect_pixel(*state, LR_INSPECT_DEPTH, 1, 2,
                 (double[]){5 / (5 + ground), 5 / (5 + ground), 5 / (5 + ground)});
    /* A camera ray and one towards the light that scenes without lights get. */
    expect_pixel(*state, LR_INSPECT_RAYS, 1, 1, (double[]){2.0 / 64, 2.0 / 64, 2.0 / 64});
    expect_pixel(*state, LR_INSPECT_RAYS, 1, 0, (double[]){1.0 / 64, 1.0 / 64, 1.0 / 64});
}

/* Premultiplied: what lies over the picture counts in full, the picture as much as is left. */
static void test_overlay(void **state)
{
    viewer v = begin(*state, scene_text);
    lr_display display;
    uint32_t plain[61 * 47], covered[61 * 47], over[61 * 47];
    MUST(lr_display_create(v.device, &display, error));
    MUST(lr_display_resize(&display, 61, 47, error));
    finish(&v, 0.01);
    lr_look look = {0};
    lr_progressive_look(v.progressive, &look);
    draw(&v, &display, &look, plain);
    for (uint32_t i = 0; i < 61 * 47; i++)
        over[i] = i % 3 == 0 ? 0 : i % 3 == 1 ? 0xFF102030u : 0x80402000u;
    MUST(lr_display_set_overlay(&display, over, error));
    draw(&v, &display, &look, covered);
    for (uint32_t i = 0; i < 61 * 47; i++)
        for (int shift = 0; shift < 24; shift += 8) {
            uint32_t top = over[i] >> (16 - shift) & 255, alpha = over[i] >> 24;
            double expected = top + (plain[i] >> shift & 255) * (255.0 - alpha) / 255;
            expected = expected > 255 ? 255 : expected;
            assert_near(covered[i] >> shift & 255, expected, 0.51);
        }
    MUST(lr_display_set_overlay(&display, NULL, error));
    draw(&v, &display, &look, covered);
    assert_memory_equal(plain, covered, sizeof plain);
    lr_display_destroy(&display);
    end(&v);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_few_primitives),
        cmocka_unit_test(test_trees),
        cmocka_unit_test(test_interruptions),
        cmocka_unit_test(test_camera),
        cmocka_unit_test(test_window_has_the_bytes_of_files),
        cmocka_unit_test(test_ray_counts),
        cmocka_unit_test(test_inspected_values),
        cmocka_unit_test(test_overlay),
        cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device, NULL);
}
