/* How Open Image Denoise is called, with a library of ours in its place (tests/faults/oidn_shim.c).
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "lavaray.h"

enum { WIDTH = 5, HEIGHT = 3, SAMPLES = 3 * WIDTH * HEIGHT };

static lr_denoiser *open_denoiser(void)
{
    lr_denoiser *denoiser;
    lr_error error = {0};
    if (lr_denoiser_open(&denoiser, &error) != LR_OK)
        fail_msg("%s", error.message);
    assert_string_equal(lr_denoiser_name(denoiser), "Open Image Denoise 2.7.8");
    return denoiser;
}

static lr_picture make_picture(void)
{
    lr_picture picture = {WIDTH, HEIGHT, malloc(SAMPLES * sizeof(float))};
    for (int i = 0; i < SAMPLES; i++)
        picture.pixels[i] = (float)i;
    return picture;
}

static bool keep_going(void *user, double fraction)
{
    *(double *)user = fraction;
    return true;
}

static bool stop(void *user, double fraction)
{
    (void)user;
    (void)fraction;
    return false;
}

static void test_pictures(void **state)
{
    (void)state;
    lr_denoiser *denoiser = open_denoiser();
    float albedo[SAMPLES], normal[SAMPLES];
    for (int i = 0; i < SAMPLES; i++) {
        albedo[i] = (float)i / SAMPLES;
        normal[i] = 1 - albedo[i];
    }
    for (int guides = 0; guides < 3; guides++) {
        double fraction = 0;
        lr_denoise_options options = {.albedo = guides >= 1 ? albedo : NULL,
                                      .normal = guides >= 2 ? normal : NULL,
                                      .progress = keep_going,
                                      .user = &fraction};
        lr_picture picture = make_picture();
        assert_int_equal(lr_denoiser_run(denoiser, &picture, guides ? &options : NULL, NULL),
                         LR_OK);
        for (int i = 0; i < SAMPLES; i++)
            assert_true(
                picture.pixels[i] ==
                ((float)i + (guides >= 1 ? albedo[i] : 0) + 2 * (guides >= 2 ? normal[i] : 0)) / 2);
        assert_true(fraction == (guides ? 1 : 0));
        lr_picture_free(&picture);
    }
    lr_denoiser_close(denoiser);
}

/* The picture stays as it was. */
static void test_failures(void **state)
{
    (void)state;
    static const struct {
        const char *fault;
        bool stopped;
        lr_status status;
        const char *words;
    } cases[] = {
        {"", true, LR_ERROR_INTERRUPTED, "interrupted"},
        {"memory", false, LR_ERROR_MEMORY, "out of memory"},
        {"filter", false, LR_ERROR_DEVICE, "no filter"},
    };
    lr_denoiser *denoiser = open_denoiser();
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        lr_error error = {0};
        lr_picture picture = make_picture();
        const float *pixels = picture.pixels;
        setenv("LAVARAY_FAULT_OIDN", cases[i].fault, 1);
        lr_denoise_options options = {.progress = cases[i].stopped ? stop : NULL};
        assert_int_equal(lr_denoiser_run(denoiser, &picture, &options, &error), cases[i].status);
        assert_non_null(strstr(error.message, cases[i].words));
        assert_ptr_equal(picture.pixels, pixels);
        for (int k = 0; k < SAMPLES; k++)
            assert_true(picture.pixels[k] == (float)k);
        lr_picture_free(&picture);
    }
    unsetenv("LAVARAY_FAULT_OIDN");
    lr_picture picture = make_picture();
    assert_int_equal(lr_denoiser_run(denoiser, &picture, NULL, NULL), LR_OK);
    lr_picture_free(&picture);
    lr_denoiser_close(denoiser);
    lr_denoiser_close(NULL);
}

static void test_no_device(void **state)
{
    (void)state;
    static const char *const faults[][2] = {{"device", "no such device"},
                                            {"hardware", "SSE4.1 support"}};
    for (int i = 0; i < 2; i++) {
        lr_denoiser *denoiser;
        lr_error error = {0};
        setenv("LAVARAY_FAULT_OIDN", faults[i][0], 1);
        assert_int_equal(lr_denoiser_open(&denoiser, &error), LR_ERROR_DEVICE);
        assert_null(denoiser);
        assert_non_null(strstr(error.message, faults[i][1]));
    }
    unsetenv("LAVARAY_FAULT_OIDN");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pictures),
        cmocka_unit_test(test_failures),
        cmocka_unit_test(test_no_device),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
