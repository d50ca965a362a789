/* Where lens.glsl puts samples, against the densities that it is to have: positions, moments, and a
 * chi-square test. */
#include "gpu_tests.h"

#include "lens.spv.h"

#define SIDE 512u
#define COUNT (SIDE * SIDE)
#define PI 3.14159265358979323846
#define BINS 64

enum { DISK, POLYGON, TENT, BLACKMAN_HARRIS };

typedef struct vec2 {
    float x, y;
} vec2;

static vec4 given[COUNT];
static vec2 found[COUNT];

static void run(void **state, uint32_t which)
{
    run_kernel(*state, &(kernel){.words = lens_spv,
                                 .word_count = sizeof lens_spv / 4,
                                 .in = given,
                                 .in_size = sizeof given,
                                 .out = found,
                                 .out_size = sizeof found,
                                 .which = which,
                                 .groups = COUNT / LR_GROUP_SIZE});
}

/* Places in [0, 1)^2, at random in the cells of a grid. */
static void fill_square(uint32_t seed)
{
    for (uint32_t i = 0; i < COUNT; i++)
        given[i] = (vec4){((float)(i % SIDE) + random_between(&seed, 0, 0.999)) / SIDE,
                          ((float)(i / SIDE) + random_between(&seed, 0, 0.999)) / SIDE, 0, 0};
}

/* Numbers of [-1, 1), the least and the greatest that a sample can have among them. */
static void fill_line(uint32_t seed)
{
    for (uint32_t i = 0; i < COUNT; i++) {
        given[i].x = 2 * ((float)(random_bits(&seed) >> 8) * 0x1p-24f) - 1;
        given[i].y = 2 * ((float)(random_bits(&seed) >> 8) * 0x1p-24f) - 1;
    }
    given[0].x = -1;
    given[1].x = 2 * 0.99999994f - 1;
    given[2].x = 0;
}

/* Mean and variance of 2 COUNT coordinates. */
static void moments(double *mean, double *variance)
{
    double sum = 0, squares = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        sum += (double)found[i].x + found[i].y;
        squares += (double)found[i].x * found[i].x + (double)found[i].y * found[i].y;
    }
    *mean = sum / (2.0 * COUNT);
    *variance = squares / (2.0 * COUNT) - *mean * *mean;
}

/* Numbers that fall into bins of equal probability; the statistic of BINS - 1 degrees of freedom
 * exceeds 2.5 times its mean less often than once in 1e9. */
static void expect_even(const uint32_t counts[BINS], double total, const char *what)
{
    double chi = 0, expected = total / BINS;
    for (int i = 0; i < BINS; i++)
        chi += (counts[i] - expected) * (counts[i] - expected) / expected;
    print_message("%s: chi-square %.1f of %d\n", what, chi, BINS - 1);
    assert_true(chi < 2.5 * (BINS - 1));
}

static void test_disk(void **state)
{
    fill_square(1);
    given[0] = (vec4){0.5f, 0.5f, 0, 0};
    given[1] = (vec4){0, 0, 0, 0};
    run(state, DISK);
    assert_true(found[0].x == 0 && found[0].y == 0);
    uint32_t counts[BINS] = {0};
    for (uint32_t i = 0; i < COUNT; i++) {
        double r2 = (double)found[i].x * found[i].x + (double)found[i].y * found[i].y;
        assert_true(r2 <= 1 + 1e-6);
        double turn = atan2(found[i].y, found[i].x) / (2 * PI) + 0.5;
        int ring = (int)fmin(r2 * 8, 7), sector = (int)fmin(turn * 8, 7);
        counts[8 * ring + sector]++;
    }
    expect_even(counts, COUNT, "disk_point");
    double mean, variance;
    moments(&mean, &variance);
    assert_near(mean, 0, 1e-3);
    assert_near(variance, 0.25, 1e-3);
}

static void test_polygon(void **state)
{
    fill_square(2);
    for (uint32_t i = 0; i < COUNT; i++) {
        given[i].z = 5;
        given[i].w = 0.25f;
    }
    given[0].x = 0.99999994f;
    run(state, POLYGON);
    uint32_t counts[BINS] = {0};
    double apothem = cos(PI / 5), top = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        double x = found[i].x, y = found[i].y, outmost = 0, share = 0;
        int side = 0;
        for (int k = 0; k < 5; k++) {
            double middle = PI / 2 + (2 * k + 1) * PI / 5;
            double out = (x * cos(middle) + y * sin(middle)) / apothem;
            if (out > outmost) {
                outmost = out;
                side = k;
                share = (-x * sin(middle) + y * cos(middle)) / sin(PI / 5);
            }
        }
        assert_true(outmost <= 1 + 1e-6);
        top = fmax(top, y);
        /* Five triangles, and in each the same from the middle to the edge and along it. */
        int bin = (int)fmin(outmost * outmost * 4, 3);
        int along = (int)fmin((share / fmax(outmost, 1e-9) + 1) * 1.5, 2);
        counts[side * 12 + bin * 3 + along]++;
    }
    double chi = 0, expected = COUNT / 60.0;
    for (int i = 0; i < 60; i++)
        chi += (counts[i] - expected) * (counts[i] - expected) / expected;
    print_message("polygon_point: chi-square %.1f of 59\n", chi);
    assert_true(chi < 2.5 * 59);
    assert_true(top > 0.99); /* the corner that points up */
    double mean, variance;
    moments(&mean, &variance);
    assert_near(mean, 0, 1e-3);
    assert_near(variance, (2 + cos(2 * PI / 5)) / 12, 1e-3);
}

static double tent_integral(double x)
{
    return x < 0 ? 0.5 * (1 + x) * (1 + x) : 1 - 0.5 * (1 - x) * (1 - x);
}

/* The four terms of Harris, "On the Use of Windows for Harmonic Analysis", 1978, over a width of 3.
 */
static double harris_integral(double x)
{
    const double a[] = {0.35875, 0.48829, 0.14128, 0.01168};
    double s = x / 1.5, sum = a[0] * s;
    for (int k = 1; k < 4; k++)
        sum += a[k] * sin(k * PI * s) / (k * PI);
    return 0.5 + 0.5 * sum / a[0];
}

static double variance_of(double (*integral)(double), double radius)
{
    double sum = 0;
    int steps = 30000;
    for (int i = 0; i < steps; i++) {
        double a = radius * (2.0 * i / steps - 1), b = a + 2 * radius / steps;
        sum += (integral(b) - integral(a)) * (a + b) * (a + b) / 4;
    }
    return sum;
}

static void expect_filter(void **state, uint32_t which, double (*integral)(double), double radius,
                          double tolerance, const char *name)
{
    fill_line(3 + which);
    run(state, which);
    double worst = 0, mean, variance;
    uint32_t counts[BINS] = {0};
    for (uint32_t i = 0; i < COUNT; i++) {
        double x = found[i].x, t = given[i].x;
        assert_true(fabs(x) <= radius + tolerance);
        /* Where the integral has the sample's share: the error in x is that of the share over the
         * density, so it is looked for where shares tell places apart. */
        double low = integral(x - tolerance), high = integral(x + tolerance);
        if (!(low <= 0.5 * (1 + t) + 1e-7 && 0.5 * (1 + t) - 1e-7 <= high))
            worst = fmax(worst, fabs(integral(x) - 0.5 * (1 + t)));
        counts[(int)fmin(fmax(integral(x), 0) * BINS, BINS - 1)]++;
    }
    assert_true(worst == 0);
    assert_true(found[2].x == 0);
    expect_even(counts, COUNT, name);
    moments(&mean, &variance);
    print_message("%s: variance %.5f, expected %.5f\n", name, variance,
                  variance_of(integral, radius));
    assert_near(mean, 0, 3e-3);
    assert_near(variance, variance_of(integral, radius), 2e-3);
}

static void test_tent(void **state)
{
    expect_filter(state, TENT, tent_integral, 1, 1e-6, "tent_offset");
}

static void test_blackman_harris(void **state)
{
    expect_filter(state, BLACKMAN_HARRIS, harris_integral, 1.5, 8e-4, "blackman_harris_offset");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_disk),
        cmocka_unit_test(test_polygon),
        cmocka_unit_test(test_tent),
        cmocka_unit_test(test_blackman_harris),
        cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device, NULL);
}
