/* The metrics against values worked out by hand or from their definitions, and what is compared:
 * channels, alpha, depths, masks, odd values, limits. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "compare/compare.h"

enum { SIZE = 24, SAMPLES = SIZE * SIZE * 4 };

static float reference_samples[SAMPLES], test_samples[SAMPLES], mask_samples[SAMPLES];

static lr_image make(float *samples, uint32_t channels, uint32_t maxval, float value)
{
    for (uint32_t i = 0; i < SIZE * SIZE * channels; i++)
        samples[i] = value;
    return (lr_image){
        .width = SIZE, .height = SIZE, .channels = channels, .maxval = maxval, .samples = samples};
}

static lr_compare_options with(const char *name, const char *limit)
{
    lr_compare_options options = {0};
    lr_error error = {0};
    if (lr_compare_set(&options, name, limit, &error) != LR_OK)
        fail_msg("%s", error.message);
    return options;
}

static lr_compare_result compare(const lr_image *a, const lr_image *b,
                                 const lr_compare_options *options)
{
    lr_compare_result result;
    lr_error error = {0};
    if (lr_compare(a, b, options, &result, &error) != LR_OK)
        fail_msg("%s", error.message);
    return result;
}

/* The value of one metric, and that it passes at `within` but not at `beyond`. */
static double value_of(const lr_image *a, const lr_image *b, const char *name, const char *within,
                       const char *beyond)
{
    lr_compare_options options = with(name, within);
    lr_compare_result result = compare(a, b, &options);
    double value = NAN;
    for (int i = 0; i < LR_METRIC_COUNT; i++)
        if (strcmp(lr_metric_name((lr_metric)i), name) == 0) {
            assert_true(result.metrics[i].measured);
            value = result.metrics[i].value;
        } else {
            assert_false(result.metrics[i].measured);
        }
    if (!result.pass)
        fail_msg("%s is %g, beyond %s", name, value, within);
    lr_compare_result_free(&result);
    options = with(name, beyond);
    result = compare(a, b, &options);
    if (result.pass)
        fail_msg("%s is %g, within %s", name, value, beyond);
    lr_compare_result_free(&result);
    return value;
}

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.9g is not within %g of %.9g", value, tolerance, expected);
}

/* 0.1 everywhere: every mean is known. */
static void test_constant_difference(void **state)
{
    (void)state;
    lr_image a = make(reference_samples, 3, 0, 0.5f), b = make(test_samples, 3, 0, 0.4f);
    double d = 0.5 - (double)0.4f;
    assert_near(value_of(&a, &b, "mse", "0.0101", "0.0099"), d * d, 1e-12);
    assert_near(value_of(&a, &b, "rmse", "0.101", "0.099"), d, 1e-12);
    assert_near(value_of(&a, &b, "relmse", "0.0385", "0.0384"), d * d / 0.26, 1e-12);
    assert_near(value_of(&a, &b, "psnr", "19.9", "20.1"), -20 * log10(d), 1e-9);
    assert_near(value_of(&a, &b, "max-abs", "0.101", "0.099"), d, 1e-12);
    assert_near(value_of(&a, &b, "max-rel", "0.201", "0.199"), d / 0.5, 1e-12);
    assert_near(value_of(&a, &b, "abs", "0.101", "0.099"), 0, 0);
    assert_near(value_of(&a, &b, "rel", "0.201", "0.199"), 0, 0);
    /* No variance, so only the means count: (2ab + c1) / (a^2 + b^2 + c1). */
    double expected = (2 * 0.5 * 0.4 + 1e-4) / (0.25 + 0.16 + 1e-4);
    assert_near(value_of(&a, &b, "ssim", "0.97", "0.98"), expected, 1e-4);
}

static void test_same(void **state)
{
    (void)state;
    lr_image a = make(reference_samples, 3, 255, 0.2f), b = make(test_samples, 3, 255, 0.2f);
    lr_compare_options options = {0};
    lr_compare_result result = compare(&a, &b, &options);
    assert_true(result.pass);
    assert_true(result.metrics[LR_METRIC_EXACT].measured); /* the default */
    assert_false(result.different);
    assert_int_equal(result.compared, SIZE * SIZE);
    lr_compare_result_free(&result);
    static const char *const most[] = {"rmse", "flip-mean", "flip-p99", "flip-max", "abs"};
    for (int i = 0; i < 5; i++) {
        options = with(most[i], "0");
        result = compare(&a, &b, &options);
        assert_true(result.pass);
        lr_compare_result_free(&result);
    }
    options = with("ssim", "1");
    result = compare(&a, &b, &options);
    assert_true(result.metrics[LR_METRIC_SSIM].value > 0.999999);
    lr_compare_result_free(&result);
}

/* Two pixels of 8 bits differ, one by a single step. */
static void test_first_and_largest(void **state)
{
    (void)state;
    lr_image a = make(reference_samples, 3, 255, 100.0f / 255);
    lr_image b = make(test_samples, 3, 255, 100.0f / 255);
    b.samples[3 * (5 * SIZE + 7) + 2] = 101.0f / 255;
    b.samples[3 * (9 * SIZE + 1) + 0] = 90.0f / 255;
    lr_compare_options options = with("exact", NULL);
    lr_compare_result result = compare(&a, &b, &options);
    assert_false(result.pass);
    assert_int_equal(result.different_pixels, 2);
    assert_int_equal(result.metrics[LR_METRIC_EXACT].pixels, 2);
    assert_near(result.metrics[LR_METRIC_EXACT].value, 200.0 / (SIZE * SIZE), 1e-12);
    assert_int_equal(result.first_x, 7);
    assert_int_equal(result.first_y, 5);
    assert_true(result.first_reference[2] == 100 && result.first_test[2] == 101);
    assert_true(result.max_difference == 10.0 / 255);
    assert_int_equal(result.max_x, 1);
    assert_int_equal(result.max_y, 9);
    assert_int_equal(result.max_channel, 0);
    lr_compare_result_free(&result);

    /* Steps of 1/255 do not drown in rounding: a limit of exactly the difference passes. */
    for (int step = 1; step <= 255; step++) {
        char limit[16], below[16];
        snprintf(limit, sizeof limit, "%d/255", step);
        snprintf(below, sizeof below, "%d/255", step - 1);
        for (int value = step; value <= 255; value++) {
            a.samples[0] = (float)value / 255;
            b.samples[0] = (float)(value - step) / 255;
            b.samples[3 * (9 * SIZE + 1)] = b.samples[3 * (5 * SIZE + 7) + 2] = 100.0f / 255;
            options = with("abs", limit);
            lr_compare_result at = compare(&a, &b, &options);
            options = with("max-abs", below);
            lr_compare_result beyond = compare(&a, &b, &options);
            assert_true(at.pass && !beyond.pass);
        }
    }
}

static void test_percentages(void **state)
{
    (void)state;
    lr_image a = make(reference_samples, 1, 255, 1), b = make(test_samples, 1, 255, 1);
    for (int i = 0; i < 6; i++) /* of 576: 1.0417 % */
        b.samples[50 * i] = 0;
    lr_compare_options options = with("abs", "0.5");
    lr_error error;
    lr_compare_set(&options, "abs-percent", "1.05", &error);
    assert_true(compare(&a, &b, &options).pass);
    lr_compare_set(&options, "abs-percent", "1.04", &error);
    assert_false(compare(&a, &b, &options).pass);
    lr_compare_set(&options, "abs-percent", "100", &error);
    lr_compare_set(&options, "max-abs", "0.9", &error); /* the hard limit holds all the same */
    assert_false(compare(&a, &b, &options).pass);
}

static void test_masks(void **state)
{
    (void)state;
    lr_image a = make(reference_samples, 3, 255, 0), b = make(test_samples, 3, 255, 0);
    lr_image mask = make(mask_samples, 1, 255, 1);
    for (uint32_t x = 4; x < 8; x++)
        b.samples[3 * (10 * SIZE + x)] = 1;
    lr_compare_options options = {.mask = &mask};
    assert_false(compare(&a, &b, &options).pass);
    for (uint32_t x = 4; x < 8; x++)
        mask.samples[10 * SIZE + x] = 0;
    lr_compare_result result = compare(&a, &b, &options);
    assert_true(result.pass);
    assert_int_equal(result.compared, SIZE * SIZE - 4);
    mask.samples[10 * SIZE + 7] = 1;
    result = compare(&a, &b, &options);
    assert_int_equal(result.different_pixels, 1);
    mask.samples[10 * SIZE + 7] = 127.0f / 255; /* nearer to black */
    assert_true(compare(&a, &b, &options).pass);
    mask.samples[10 * SIZE + 7] = 128.0f / 255;
    assert_false(compare(&a, &b, &options).pass);
    options.ignored[0] = (lr_rectangle){7, 10, UINT32_MAX, 1}; /* reaches over the edge */
    options.ignored_count = 1;
    assert_true(compare(&a, &b, &options).pass);

    /* What is masked does not reach its neighbours through FLIP's and SSIM's filters either, and
     * means are over what is compared. */
    lr_error error;
    lr_compare_set(&options, "flip-max", "0", &error);
    lr_compare_set(&options, "rmse", "0", &error);
    result = compare(&a, &b, &options);
    assert_true(result.pass);
    lr_compare_result_free(&result);
    options = (lr_compare_options){.mask = &mask};
    make(mask_samples, 1, 255, 0);
    mask.samples[10 * SIZE + 4] = mask.samples[0] = 1;
    lr_compare_set(&options, "mse", "0.2", &error);
    result = compare(&a, &b, &options); /* one of 2 x 3 samples differs by 1 */
    assert_near(result.metrics[LR_METRIC_MSE].value, 1.0 / 6, 1e-12);
    assert_int_equal(result.compared, 2);

    mask.width--;
    assert_int_equal(lr_compare(&a, &b, &options, &result, &error), LR_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "the mask has 23 x 24 pixels"));
    mask.width++;
    make(mask_samples, 1, 255, 0); /* nothing is compared: no test */
    assert_int_equal(lr_compare(&a, &b, &options, &result, &error), LR_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "nothing is left to compare"));
}

static void test_channels(void **state)
{
    (void)state;
    lr_compare_options options = with("exact", NULL);
    lr_image grey = make(reference_samples, 1, 255, 0.2f), rgb = make(test_samples, 3, 255, 0.2f);
    lr_compare_result result = compare(&grey, &rgb, &options);
    assert_true(result.pass);
    assert_int_equal(result.channels, 3);
    rgb.samples[4] = 0.4f;
    assert_false(compare(&grey, &rgb, &options).pass);

    lr_image rgba = make(test_samples, 4, 255, 1);
    lr_image white = make(reference_samples, 3, 255, 1);
    result = compare(&white, &rgba, &options);
    assert_true(result.pass); /* opaque */
    assert_int_equal(result.channels, 3);
    rgba.samples[7] = 0.5f;
    result = compare(&white, &rgba, &options);
    assert_false(result.pass);
    assert_int_equal(result.channels, 4);
    assert_int_equal(result.max_channel, 3);
    assert_int_equal(result.first_x, 1);
    result = compare(&rgba, &rgba, &options);
    assert_true(result.pass);
    lr_image grey_alpha = make(reference_samples, 2, 255, 1);
    grey_alpha.samples[3] = 0.5f;
    assert_true(compare(&grey_alpha, &rgba, &options).pass);
}

static void test_depths(void **state)
{
    (void)state;
    lr_compare_options options = with("exact", NULL);
    lr_image a = make(reference_samples, 1, 255, 0), b = make(test_samples, 1, 65535, 0);
    for (uint32_t i = 0; i < 256; i++) {
        a.samples[i] = (float)i / 255;
        b.samples[i] = (float)(i * 257) / 65535;
    }
    assert_true(compare(&a, &b, &options).pass);
    /* Encoded 0.5 is 0.21404 linear; the float picture is encoded for the comparison. */
    a = make(reference_samples, 3, 255, 0.5f);
    b = make(test_samples, 3, 0, 0.21404114f);
    options = with("max-abs", "1e-6");
    lr_compare_result result = compare(&a, &b, &options);
    assert_true(result.pass);
    assert_true(result.converted);
    result = compare(&b, &a, &options);
    assert_true(result.pass);
}

static void test_not_finite(void **state)
{
    (void)state;
    lr_image a = make(reference_samples, 3, 0, 1), b = make(test_samples, 3, 0, 1);
    lr_compare_options options = with("max-abs", "1e30");
    a.samples[0] = b.samples[0] = NAN;
    a.samples[1] = b.samples[1] = INFINITY;
    a.samples[2] = 0;
    b.samples[2] = -0.0f;
    lr_compare_result result = compare(&a, &b, &options);
    assert_true(result.pass);
    assert_false(result.different);
    static const float odd[] = {NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 3; i++) {
        b.samples[30] = odd[i];
        static const char *const names[] = {"mse", "rmse", "relmse", "max-abs", "max-rel", "abs"};
        for (int k = 0; k < 6; k++) {
            options = with(names[k], "1e30");
            result = compare(&a, &b, &options);
            assert_false(result.pass);
            assert_int_equal(result.non_finite, 1);
        }
        options = with("psnr", "0");
        assert_false(compare(&a, &b, &options).pass);
        options = with("flip-mean", "1");
        result = compare(&a, &b, &options);
        assert_true(result.metrics[LR_METRIC_FLIP_MEAN].value >= 0); /* a number, not NaN */
        lr_compare_result_free(&result);
        options = with("ssim", "0");
        result = compare(&a, &b, &options);
        assert_true(result.metrics[LR_METRIC_SSIM].value <= 1);
    }
}

/* Green against blue defines the largest colour error; FLIP is symmetric for LDR. */
static void test_flip(void **state)
{
    (void)state;
    lr_image a = make(reference_samples, 3, 255, 0), b = make(test_samples, 3, 255, 0);
    for (uint32_t i = 0; i < SIZE * SIZE; i++)
        a.samples[3 * i + 1] = b.samples[3 * i + 2] = 1;
    assert_near(value_of(&a, &b, "flip-mean", "1", "0.999"), 1, 1e-5);
    assert_near(value_of(&a, &b, "flip-p99", "1", "0.999"), 1, 1e-5);
    for (uint32_t i = 0; i < SIZE * SIZE; i++) {
        a.samples[3 * i] = (float)(i % 5) / 5;
        b.samples[3 * i] = (float)(i % 7) / 7;
    }
    double there = value_of(&a, &b, "flip-mean", "1", "0"),
           back = value_of(&b, &a, "flip-mean", "1", "0");
    assert_near(there, back, 1e-6);
    /* From far away nothing but the mean colour is seen. */
    lr_compare_options near = with("flip-mean", "1"), far = near;
    near.ppd = 5;
    far.ppd = 100;
    lr_image grey = make(reference_samples, 3, 255, 0.5f), dots = make(test_samples, 3, 255, 0.5f);
    for (uint32_t i = 0; i < 3 * SIZE * SIZE; i++)
        dots.samples[i] += (i / 3 + i / 3 / SIZE) % 2 ? 0.1f : -0.1f;
    lr_compare_result seen = compare(&grey, &dots, &near), unseen = compare(&grey, &dots, &far);
    assert_true(seen.metrics[LR_METRIC_FLIP_MEAN].value >
                unseen.metrics[LR_METRIC_FLIP_MEAN].value);
    lr_compare_result_free(&seen);
    lr_compare_result_free(&unseen);
}

/* The 99th percentile by rank: 1 % of 576 pixels are 5.76, so it stands behind 571 of them. */
static void test_percentile(void **state)
{
    (void)state;
    lr_image a = make(reference_samples, 3, 255, 0), b = make(test_samples, 3, 255, 0);
    lr_compare_options options = with("flip-p99", "1");
    options.map = true;
    b.samples[0] = 1;
    lr_compare_result result = compare(&a, &b, &options);
    const float *map = result.map;
    uint32_t above = 0, at_least = 0;
    float p99 = (float)result.metrics[LR_METRIC_FLIP_P99].value;
    for (uint32_t i = 0; i < SIZE * SIZE; i++) {
        above += map[i] > p99;
        at_least += map[i] >= p99;
    }
    assert_true(above <= 5 && at_least > 5);
    lr_compare_result_free(&result);
}

static void test_sizes(void **state)
{
    (void)state;
    lr_image a = make(reference_samples, 3, 255, 0), b = make(test_samples, 3, 255, 0);
    b.height = 10;
    lr_compare_options options = {0};
    lr_compare_result result = compare(&a, &b, &options);
    assert_false(result.pass);
    assert_false(result.same_size);
    assert_int_equal(result.test_height, 10);
    /* Pictures smaller than every filter. */
    a.width = a.height = b.width = b.height = 1;
    b.samples[0] = 0.5f;
    static const char *const names[] = {"flip-mean", "ssim", "rmse"};
    for (int i = 0; i < 3; i++) {
        options = with(names[i], "0.5");
        result = compare(&a, &b, &options);
        assert_true(result.different);
        lr_compare_result_free(&result);
    }
}

static void test_settings(void **state)
{
    (void)state;
    static const char *const refused[][2] = {
        {"rmse", ""},    {"rmse", NULL},        {"rmse", "-1"},    {"rmse", "x"},
        {"rmse", "0x1"}, {"rmse", " 1"},        {"rmse", "1e999"}, {"rmse", "nan"},
        {"rmse", "1/0"}, {"rmse", "1/"},        {"rmse", "/2"},    {"rmse", "1/2/3"},
        {"ssim", "1.1"}, {"flip-mean", "2"},    {"noise", "0.6"},  {"psnr", "1001"},
        {"ppd", "0"},    {"ppd", "1001"},       {"exact", "0"},    {"abs-percent", "101"},
        {"rmsd", "1"},   {"rel-percent", "-1"},
    };
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        lr_compare_options options = {0};
        lr_error error = {0};
        if (lr_compare_set(&options, refused[i][0], refused[i][1], &error) != LR_ERROR_ARGUMENT)
            fail_msg("%s %s is taken", refused[i][0], refused[i][1]);
        assert_true(error.message[0]);
        for (int k = 0; k < LR_METRIC_COUNT; k++)
            assert_false(options.wanted[k]);
    }
    lr_compare_options options = with("abs", "2/255");
    assert_true(options.limits[LR_METRIC_ABS] == 2.0 / 255);
    assert_string_equal(lr_metric_name(LR_METRIC_FLIP_P99), "flip-p99");
}

static uint32_t next(uint32_t *seed)
{
    *seed = *seed * 747796405u + 2891336453u;
    return *seed >> 8;
}

static lr_image make_random(float *samples, uint32_t width, uint32_t height, uint32_t *seed)
{
    static const uint32_t maxvals[] = {0, 1, 255, 1000, 65535};
    static const float odd[] = {NAN, INFINITY, -INFINITY, -1, 1e30f, -0.0f};
    lr_image image = {.width = width,
                      .height = height,
                      .channels = 1 + next(seed) % 4,
                      .maxval = maxvals[next(seed) % 5],
                      .samples = samples};
    uint32_t flat = next(seed) % 3;
    for (uint32_t i = 0; i < width * height * image.channels; i++) {
        uint32_t value = flat ? flat * 100 : next(seed);
        samples[i] = image.maxval      ? (float)(value % (image.maxval + 1)) / (float)image.maxval
                     : next(seed) % 50 ? (float)value / 1e6f
                                       : odd[next(seed) % 6];
    }
    return image;
}

/* Pictures of all kinds and small sizes through everything: a picture is the same as itself, values
 * are numbers, and what is said agrees with what is found. */
static void test_anything(void **state)
{
    (void)state;
    uint32_t seed = 5;
    for (int trial = 0; trial < 400; trial++) {
        uint32_t width = 1 + next(&seed) % SIZE, height = 1 + next(&seed) % SIZE;
        lr_image a = make_random(reference_samples, width, height, &seed);
        lr_image b = make_random(test_samples, width, height, &seed);
        lr_image mask = make_random(mask_samples, width, height, &seed);
        lr_compare_options options = {.explain = true, .map = true, .ppd = 1 + next(&seed) % 100};
        for (int i = 0; i < LR_METRIC_COUNT; i++)
            options.wanted[i] = i != LR_METRIC_NOISE || trial % 5 == 0;
        options.test_variance = trial % 5 == 0 ? &mask : NULL;
        options.mask = trial % 3 == 0 ? &mask : NULL;
        for (uint32_t i = 0; i < mask.channels; i++)
            mask.samples[i] = 1; /* of the first pixel: something is compared */
        lr_compare_result result = compare(&a, &b, &options);
        assert_true(result.pass || result.different);
        assert_true(result.different == (result.different_pixels > 0));
        assert_true(result.different == (result.cause != LR_CAUSE_NONE));
        for (int i = 0; i < LR_METRIC_COUNT; i++)
            assert_false(isnan(result.metrics[i].value));
        char text[512];
        lr_compare_describe(&result, text, sizeof text);
        lr_picture picture;
        assert_int_equal(lr_compare_heat_map(&a, &result, &picture, NULL), LR_OK);
        lr_picture_free(&picture);
        lr_compare_result_free(&result);

        memset(options.limits, 0, sizeof options.limits);
        options.wanted[LR_METRIC_NOISE] = false;
        result = compare(&a, &a, &options);
        assert_true(result.pass && !result.different);
        lr_compare_result_free(&result);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_constant_difference),
        cmocka_unit_test(test_same),
        cmocka_unit_test(test_first_and_largest),
        cmocka_unit_test(test_percentages),
        cmocka_unit_test(test_masks),
        cmocka_unit_test(test_channels),
        cmocka_unit_test(test_depths),
        cmocka_unit_test(test_not_finite),
        cmocka_unit_test(test_flip),
        cmocka_unit_test(test_percentile),
        cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_settings),
        cmocka_unit_test(test_anything),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
