/* Transfer curves against the definitions, evaluated with pow in long double. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <cmocka.h>

#include "image/image.h"

static const uint32_t maxvals[] = {1, 2, 3, 7, 100, 254, 255, 256, 1000, 4095, 65534, 65535};

static lr_curve create(lr_transfer transfer, uint32_t maxval)
{
    lr_curve curve;
    lr_error error = {0};
    if (lr_curve_create(&curve, transfer, maxval, &error) != LR_OK)
        fail_msg("%s", error.message);
    return curve;
}

/* The smallest float that is not below the linear value of `encoded`, from 0 to 1. */
static float exact_threshold(lr_transfer transfer, long double encoded)
{
    long double x = encoded;
    if (transfer == LR_TRANSFER_SRGB)
        x = encoded <= 0.04045L ? encoded / 12.92L : powl((encoded + 0.055L) / 1.055L, 2.4L);
    float rounded = (float)x;
    return rounded < x ? nextafterf(rounded, 2) : rounded;
}

static void test_thresholds(void **state)
{
    (void)state;
    for (size_t m = 0; m < sizeof maxvals / sizeof *maxvals; m++)
        for (lr_transfer transfer = LR_TRANSFER_SRGB; transfer <= LR_TRANSFER_LINEAR; transfer++) {
            uint32_t maxval = maxvals[m];
            lr_curve curve = create(transfer, maxval);
            assert_int_equal(curve.maxval, maxval);
            for (uint32_t i = 0; i < maxval; i++) {
                float expected = exact_threshold(transfer, (i + 0.5L) / maxval);
                if (curve.thresholds[i] != expected)
                    fail_msg("transfer %d, maxval %u, threshold %u: %a, expected %a", transfer,
                             maxval, i, curve.thresholds[i], expected);
                assert_true(i == 0 || curve.thresholds[i] > curve.thresholds[i - 1]);
            }
            lr_curve_free(&curve);
        }
}

static void test_encode_at_thresholds(void **state)
{
    (void)state;
    for (size_t m = 0; m < sizeof maxvals / sizeof *maxvals; m++)
        for (lr_transfer transfer = LR_TRANSFER_SRGB; transfer <= LR_TRANSFER_LINEAR; transfer++) {
            lr_curve curve = create(transfer, maxvals[m]);
            for (uint32_t i = 0; i < maxvals[m]; i++) {
                float at = exact_threshold(transfer, (i + 0.5L) / maxvals[m]);
                assert_int_equal(lr_curve_encode(&curve, at), i + 1);
                assert_int_equal(lr_curve_encode(&curve, nextafterf(at, 2)), i + 1);
                assert_int_equal(lr_curve_encode(&curve, nextafterf(at, 0)), i);
            }
            lr_curve_free(&curve);
        }
}

/* Linear values round to the nearest integer, halves up; a quotient of integers is exact in
 * long double as far as the comparison needs it. */
static void test_linear_rounds(void **state)
{
    (void)state;
    lr_curve curve = create(LR_TRANSFER_LINEAR, 255);
    for (uint32_t i = 0; i <= 1000000; i++) {
        float linear = (float)i / 1000000;
        uint32_t expected = (uint32_t)floorl((long double)linear * 255 + 0.5L);
        assert_int_equal(lr_curve_encode(&curve, linear), expected);
    }
    lr_curve_free(&curve);
    curve = create(LR_TRANSFER_LINEAR, 1);
    assert_int_equal(lr_curve_encode(&curve, 0.5f), 1);
    assert_int_equal(lr_curve_encode(&curve, nextafterf(0.5f, 0)), 0);
    lr_curve_free(&curve);
}

static void test_every_float_is_monotonic(void **state)
{
    (void)state;
    for (uint32_t maxval = 255; maxval <= 65535; maxval += 65280) {
        lr_curve curve = create(LR_TRANSFER_SRGB, maxval);
        uint32_t last = 0;
        for (uint32_t bits = 0; bits <= 0x3f810000u; bits += 61) {
            float linear;
            memcpy(&linear, &bits, sizeof linear);
            uint32_t value = lr_curve_encode(&curve, linear);
            if (value < last || value > maxval ||
                (value > 0 && linear < curve.thresholds[value - 1]))
                fail_msg("%a encodes to %u", linear, value);
            last = value;
        }
        assert_int_equal(last, maxval);
        lr_curve_free(&curve);
    }
}

static void test_special_values(void **state)
{
    (void)state;
    static const uint32_t some[] = {1, 255, 256, 65535};
    for (size_t i = 0; i < 4; i++)
        for (lr_transfer transfer = LR_TRANSFER_SRGB; transfer <= LR_TRANSFER_LINEAR; transfer++) {
            lr_curve curve = create(transfer, some[i]);
            static const float zeros[] = {0, -0.0f, -1, -INFINITY, 1e-45f, 1e-30f, NAN, -NAN};
            static const float ones[] = {1, 1.5f, 2, 1e30f, INFINITY};
            for (size_t k = 0; k < sizeof zeros / sizeof *zeros; k++)
                assert_int_equal(lr_curve_encode(&curve, zeros[k]), 0);
            for (size_t k = 0; k < sizeof ones / sizeof *ones; k++)
                assert_int_equal(lr_curve_encode(&curve, ones[k]), some[i]);
            lr_curve_free(&curve);
        }
}

static void test_known_srgb_values(void **state)
{
    (void)state;
    /* From the sRGB definition by hand: 0.5 -> 0.7354 * 255, 0.18 -> 0.4613, 0.002 -> 0.02584. */
    lr_curve curve = create(LR_TRANSFER_SRGB, 255);
    assert_int_equal(lr_curve_encode(&curve, 0.5f), 188);
    assert_int_equal(lr_curve_encode(&curve, 0.18f), 118);
    assert_int_equal(lr_curve_encode(&curve, 0.002f), 7);
    lr_curve_free(&curve);
}

static void test_refusals(void **state)
{
    (void)state;
    lr_curve curve;
    lr_error error = {0};
    assert_int_equal(lr_curve_create(&curve, LR_TRANSFER_SRGB, 0, &error), LR_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "maxval is 0; expected 1 to 65535"));
    assert_int_equal(lr_curve_create(&curve, LR_TRANSFER_SRGB, 65536, NULL), LR_ERROR_ARGUMENT);
    assert_int_equal(lr_curve_create(&curve, (lr_transfer)7, 255, NULL), LR_ERROR_ARGUMENT);
    lr_curve_free(&curve);
    lr_curve_free(NULL);
}

/* Printed, not asserted: a loaded machine is no failure. */
static void test_speed(void **state)
{
    (void)state;
    enum { COUNT = 1920 * 1080 * 3 };
    static const struct {
        uint32_t maxval;
        lr_transfer transfer;
    } cases[] = {{255, LR_TRANSFER_SRGB}, {65535, LR_TRANSFER_SRGB}, {65535, LR_TRANSFER_LINEAR}};
    float *values = malloc(COUNT * sizeof *values);
    uint32_t seed = 1;
    for (size_t i = 0; i < COUNT; i++) {
        seed = seed * 747796405u + 2891336453u;
        values[i] = (float)(seed >> 8) / 16777216;
    }
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        lr_curve curve = create(cases[i].transfer, cases[i].maxval);
        clock_t start = clock();
        uint64_t sum = 0;
        for (size_t k = 0; k < COUNT; k++)
            sum += lr_curve_encode(&curve, values[k]);
        double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
        print_message("1080p, maxval %u, transfer %d: %.0f ms\n", cases[i].maxval,
                      cases[i].transfer, seconds * 1000);
        assert_true(sum > 0);
        lr_curve_free(&curve);
    }
    free(values);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_thresholds),     cmocka_unit_test(test_encode_at_thresholds),
        cmocka_unit_test(test_linear_rounds),  cmocka_unit_test(test_every_float_is_monotonic),
        cmocka_unit_test(test_special_values), cmocka_unit_test(test_known_srgb_values),
        cmocka_unit_test(test_refusals),       cmocka_unit_test(test_speed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
