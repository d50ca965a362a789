/* The noise test on synthetic noise of known variance: how often it rejects pictures that differ by
 * noise alone, and whether it finds a planted bias. Tails against published values. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "compare/compare.h"
#include "compare/probability.h"

enum { WIDTH = 40, HEIGHT = 36, CHANNELS = 3, SAMPLES = WIDTH * HEIGHT * CHANNELS };

static uint64_t seed = 1;

static double uniform(void)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    uint64_t x = seed ^ seed >> 29;
    x *= 0xbf58476d1ce4e5b9u;
    return ((double)((x ^ x >> 32) >> 11) + 0.5) / 9007199254740992.0;
}

static double normal(void)
{
    return sqrt(-2 * log(uniform())) * cos(6.283185307179586 * uniform());
}

static void assert_close(double value, double expected, double relative)
{
    if (!(fabs(value - expected) <= relative * fabs(expected)))
        fail_msg("%.12g is not %.12g", value, expected);
}

/* Tails as scipy.stats has them: 2 * norm.sf, 2 * t.sf. */
static void test_tails(void **state)
{
    (void)state;
    assert_close(probability_normal(0), 1, 1e-12);
    assert_close(probability_normal(1), 0.31731050786291415, 1e-10);
    assert_close(probability_normal(1.959963984540054), 0.05, 1e-10);
    assert_close(probability_normal(2.0000001), 0.04550025309, 1e-6);
    assert_close(probability_normal(5), 5.733031437583892e-07, 1e-10);
    assert_close(probability_normal(20), 5.507248237212467e-89, 1e-9);
    assert_close(probability_student_2(9.92484320091807), 0.01, 1e-9);
    assert_close(probability_student_2(1000), 9.999985000025e-07, 1e-9);
    assert_close(probability_student_2(0), 1, 0);
    for (double z = 0; z < 30; z += 0.01)
        if (fabs(probability_normal_inverse(probability_normal(z)) - z) > 5e-4)
            fail_msg("the inverse at %g", z);
    assert_close(probability_any(0.01, 1), 0.01, 1e-9);
    assert_close(probability_any(0.01, 100), 1 - pow(0.99, 100), 1e-9);
    assert_close(probability_any(1e-12, 1e6), 1e-6, 1e-5);
    assert_close(probability_any(1, 5), 1, 0);
}

/* The pictures of one trial. The standard deviation jumps between neighbours: a row of three
 * regions, and speckles. */
static float reference[SAMPLES], test[SAMPLES], reference_half[SAMPLES], test_half[SAMPLES];
static float reference_variance[SAMPLES], test_variance[SAMPLES];

static double mean_of(int i)
{
    return 0.2 + 0.5 * ((i / CHANNELS) % WIDTH) / WIDTH;
}

static double deviation_of(int i)
{
    int x = i / CHANNELS % WIDTH;
    double sigma = x < 12 ? 0.002 : x < 27 ? 0.1 : 0.02;
    return i / CHANNELS % 97 == 0 ? 0.5 : sigma;
}

static void make_trial(double bias)
{
    for (int i = 0; i < SAMPLES; i++) {
        double mean = mean_of(i), sigma = deviation_of(i);
        reference[i] = (float)(mean + sigma * normal());
        reference_half[i] = (float)(mean + sigma * normal());
        test[i] = (float)(mean * bias + sigma * normal());
        test_half[i] = (float)(mean * bias + sigma * normal());
        reference_variance[i] = test_variance[i] = (float)(sigma * sigma);
    }
}

static lr_image image_of(float *samples)
{
    return (lr_image){.width = WIDTH, .height = HEIGHT, .channels = CHANNELS, .samples = samples};
}

typedef enum kind { BOTH_VARIANCES, ONE_VARIANCE, HALVES } kind;

static lr_compare_result run(kind with, double significance)
{
    lr_image images[] = {image_of(reference),          image_of(test),
                         image_of(reference_variance), image_of(test_variance),
                         image_of(reference_half),     image_of(test_half)};
    lr_compare_options options = {0};
    options.wanted[LR_METRIC_NOISE] = true;
    options.limits[LR_METRIC_NOISE] = significance;
    if (with == BOTH_VARIANCES)
        options.reference_variance = &images[2];
    if (with != HALVES)
        options.test_variance = &images[3];
    if (with == HALVES) {
        options.reference_half = &images[4];
        options.test_half = &images[5];
    }
    if (with == ONE_VARIANCE) /* a reference without noise */
        for (int i = 0; i < SAMPLES; i++)
            reference[i] = (float)mean_of(i);
    lr_compare_result result;
    lr_error error = {0};
    if (lr_compare(&images[0], &images[1], &options, &result, &error) != LR_OK)
        fail_msg("%s", error.message);
    return result;
}

/* Pictures that differ by noise alone are rejected as often as asked for, within four standard
 * deviations of a binomial variable. Blocks that contain each other make the test reject a little
 * less often; a quarter less is allowed. */
static void expect_rates(kind with, const char *name, int trials)
{
    static const double levels[] = {0.1, 0.01, 0.001};
    int rejected[3] = {0};
    for (int i = 0; i < trials; i++) {
        make_trial(1);
        double p = run(with, 0.01).metrics[LR_METRIC_NOISE].value;
        for (int k = 0; k < 3; k++)
            rejected[k] += p < levels[k];
    }
    for (int k = 0; k < 3; k++) {
        double expected = levels[k] * trials, deviation = sqrt(expected * (1 - levels[k]));
        print_message("%s: %d of %d rejected at %g\n", name, rejected[k], trials, levels[k]);
        if (rejected[k] > expected + 4 * deviation || rejected[k] < 0.75 * expected - 4 * deviation)
            fail_msg("%s: %d of %d rejected at %g, expected %.0f", name, rejected[k], trials,
                     levels[k], expected);
    }
}

static void test_rates_of_variances(void **state)
{
    (void)state;
    expect_rates(BOTH_VARIANCES, "variances", 4000);
}

static void test_rates_of_one_variance(void **state)
{
    (void)state;
    expect_rates(ONE_VARIANCE, "one variance", 2000);
}

static void test_rates_of_halves(void **state)
{
    (void)state;
    expect_rates(HALVES, "halves", 4000);
}

/* A bias of 2 % of everything, far below the noise of a pixel, is found every time. */
static void test_bias(void **state)
{
    (void)state;
    for (kind with = BOTH_VARIANCES; with <= HALVES; with++)
        for (int i = 0; i < 20; i++) {
            make_trial(1.02);
            lr_compare_result result = run(with, 0.001);
            if (result.pass)
                fail_msg("kind %d, trial %d: p is %g", (int)with, i,
                         result.metrics[LR_METRIC_NOISE].value);
        }
}

/* The same where every pixel is noisy: a standard deviation of 5 % of the mean. */
static void test_bias_in_strong_noise(void **state)
{
    (void)state;
    for (kind with = BOTH_VARIANCES; with <= HALVES; with += HALVES)
        for (int i = 0; i < 20; i++) {
            for (int k = 0; k < SAMPLES; k++) {
                reference[k] = (float)(1 + 0.05 * normal());
                reference_half[k] = (float)(1 + 0.05 * normal());
                test[k] = (float)(1.02 + 0.05 * normal());
                test_half[k] = (float)(1.02 + 0.05 * normal());
                reference_variance[k] = test_variance[k] = 0.0025f;
            }
            assert_false(run(with, 0.001).pass);
        }
}

/* A spot of 4 x 4 pixels two standard deviations brighter, and where it is. */
static void test_spot(void **state)
{
    (void)state;
    for (kind with = BOTH_VARIANCES; with <= HALVES; with += HALVES) {
        make_trial(1);
        for (int y = 8; y < 12; y++)
            for (int x = 16; x < 20; x++)
                for (int c = 0; c < CHANNELS; c++) {
                    test[(y * WIDTH + x) * CHANNELS + c] += 0.3f;
                    test_half[(y * WIDTH + x) * CHANNELS + c] += 0.3f;
                }
        lr_compare_result result = run(with, 0.001);
        assert_false(result.pass);
        assert_true(result.noise_box.x <= 16 && result.noise_box.y <= 8);
        assert_true(result.noise_box.x + result.noise_box.width >= 20);
        assert_true(result.noise_box.width <= 16);
        assert_true(result.noise_z > 5);
    }
}

/* A single pixel far off is found with variances. Where there is no noise nothing may differ. */
static void test_pixels(void **state)
{
    (void)state;
    make_trial(1);
    test[300] += 12 * (float)deviation_of(300);
    lr_compare_result result = run(BOTH_VARIANCES, 0.001);
    assert_false(result.pass);
    assert_int_equal(result.noise_box.width, 1);
    assert_int_equal(result.noise_box.x, 100 % WIDTH);

    for (int i = 0; i < SAMPLES; i++)
        reference[i] = test[i] = reference_half[i] = test_half[i] = 0.25f;
    memset(reference_variance, 0, sizeof reference_variance);
    memset(test_variance, 0, sizeof test_variance);
    assert_true(run(BOTH_VARIANCES, 0.5).pass);
    assert_true(run(HALVES, 0.5).pass);
    test[7] = test_half[7] = 0.25000003f; /* rounding */
    assert_true(run(BOTH_VARIANCES, 0.5).pass);
    test[7] = test_half[7] = 0.26f;
    assert_false(run(BOTH_VARIANCES, 1e-9).pass);
    assert_false(run(HALVES, 1e-9).pass);
    test[7] = NAN;
    assert_false(run(BOTH_VARIANCES, 1e-9).pass);
}

static void test_refusals(void **state)
{
    (void)state;
    lr_image a = image_of(reference), b = image_of(test), v = image_of(test_variance);
    lr_compare_options options = {0};
    lr_compare_result result;
    lr_error error = {0};
    options.wanted[LR_METRIC_NOISE] = true;
    assert_int_equal(lr_compare(&a, &b, &options, &result, &error), LR_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "needs variances"));
    options.test_half = &v;
    assert_int_equal(lr_compare(&a, &b, &options, &result, &error), LR_ERROR_ARGUMENT);
    options = (lr_compare_options){.test_variance = &v};
    options.wanted[LR_METRIC_NOISE] = true;
    v.width--;
    assert_int_equal(lr_compare(&a, &b, &options, &result, &error), LR_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "test's variance has 39 x 36 pixels"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tails),
        cmocka_unit_test(test_rates_of_variances),
        cmocka_unit_test(test_rates_of_one_variance),
        cmocka_unit_test(test_rates_of_halves),
        cmocka_unit_test(test_bias),
        cmocka_unit_test(test_bias_in_strong_noise),
        cmocka_unit_test(test_spot),
        cmocka_unit_test(test_pixels),
        cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
