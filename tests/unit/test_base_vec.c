/* Vectors and transforms in double, against libm and against each other. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "base/vec.h"

#define assert_near(value, expected, tolerance)                                                    \
    do {                                                                                           \
        double value_ = (value), expected_ = (expected);                                           \
        if (!(fabs(value_ - expected_) <= (tolerance)))                                            \
            fail_msg("%s is %.17g, expected %.17g", #value, value_, expected_);                    \
    } while (0)

static uint64_t seed = 1;

static double random_between(double low, double high)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * ((double)(seed >> 11) / 9007199254740992.0);
}

static lr_vec3 random_vector(double size)
{
    return (lr_vec3){random_between(-size, size), random_between(-size, size),
                     random_between(-size, size)};
}

static void assert_vector(lr_vec3 v, lr_vec3 expected, double tolerance)
{
    assert_near(v.x, expected.x, tolerance);
    assert_near(v.y, expected.y, tolerance);
    assert_near(v.z, expected.z, tolerance);
}

static void test_arithmetic(void **state)
{
    (void)state;
    lr_vec3 a = {1, 2, 3}, b = {-4, 5, 0.5};
    assert_vector(lr_vec3_add(a, b), (lr_vec3){-3, 7, 3.5}, 0);
    assert_vector(lr_vec3_sub(a, b), (lr_vec3){5, -3, 2.5}, 0);
    assert_vector(lr_vec3_scale(a, -2), (lr_vec3){-2, -4, -6}, 0);
    assert_near(lr_vec3_dot(a, b), 7.5, 0);
    assert_vector(lr_vec3_cross(a, b), (lr_vec3){-14, -12.5, 13}, 0);
    assert_near(lr_vec3_length((lr_vec3){2, 3, 6}), 7, 1e-15);
}

static void test_extreme_lengths(void **state)
{
    (void)state;
    const double sizes[] = {1e-320, 1e-200, 1e-20, 1, 1e20, 1e200, 1e307};
    for (int i = 0; i < 7; i++) {
        lr_vec3 v = {2 * sizes[i], 3 * sizes[i], 6 * sizes[i]};
        double tolerance = i ? 1e-15 : 1e-3; /* a subnormal has few digits */
        assert_near(lr_vec3_length(v) / sizes[i], 7, 7 * tolerance);
        assert_vector(lr_vec3_normalize(v), (lr_vec3){2 / 7.0, 3 / 7.0, 6 / 7.0}, tolerance);
    }
    assert_near(lr_vec3_length((lr_vec3){0, 0, 0}), 0, 0);
    assert_vector(lr_vec3_normalize((lr_vec3){0, 0, 0}), (lr_vec3){0, 0, 0}, 0);
}

static void test_frame(void **state)
{
    (void)state;
    for (int i = 0; i < 1000; i++) {
        lr_vec3 n = lr_vec3_normalize(random_vector(1)), u, v;
        if (i < 6)
            n = (lr_vec3){i / 2 == 0 ? 1 - i % 2 * 2 : 0, i / 2 == 1 ? 1 - i % 2 * 2 : 0,
                          i / 2 == 2 ? 1 - i % 2 * 2 : 0};
        lr_vec3_frame(n, &u, &v);
        assert_near(lr_vec3_length(u), 1, 1e-15);
        assert_near(lr_vec3_length(v), 1, 1e-15);
        assert_near(lr_vec3_dot(u, v), 0, 1e-15);
        assert_vector(lr_vec3_cross(u, v), n, 1e-15);
    }
}

static void test_sine_and_cosine(void **state)
{
    (void)state;
    double sine, cosine;
    for (int i = 0; i < 100000; i++) {
        double degrees = random_between(-720, 720);
        lr_sincos_degrees(degrees, &sine, &cosine);
        assert_near(sine, sin(degrees * 0.017453292519943295), 2e-15);
        assert_near(cosine, cos(degrees * 0.017453292519943295), 2e-15);
    }
    const double sines[] = {0, 1, 0, -1};
    for (int quarter = -40; quarter <= 40; quarter++) {
        lr_sincos_degrees(90.0 * quarter, &sine, &cosine);
        assert_true(sine == sines[(quarter + 400) % 4]);
        assert_true(cosine == sines[(quarter + 401) % 4]);
    }
}

static void test_transforms(void **state)
{
    (void)state;
    lr_vec3 p = {1, 2, 3};
    lr_transform move = lr_transform_translate((lr_vec3){10, 20, 30});
    lr_transform grow = lr_transform_scale((lr_vec3){2, -1, 0.5});
    lr_transform turn = lr_transform_rotate((lr_vec3){0, 0, 9}, 90);
    lr_transform none = lr_transform_identity();
    assert_vector(lr_transform_point(&none, p), p, 0);
    assert_vector(lr_transform_point(&move, p), (lr_vec3){11, 22, 33}, 0);
    assert_vector(lr_transform_vector(&move, p), p, 0);
    assert_vector(lr_transform_point(&grow, p), (lr_vec3){2, -2, 1.5}, 0);
    assert_vector(lr_transform_point(&turn, p), (lr_vec3){-2, 1, 3}, 0);
    /* the right factor comes first */
    lr_transform both = lr_transform_multiply(move, turn);
    assert_vector(lr_transform_point(&both, p), (lr_vec3){8, 21, 33}, 0);
    both = lr_transform_multiply(turn, move);
    assert_vector(lr_transform_point(&both, p), (lr_vec3){-22, 11, 33}, 0);
    /* a third of a turn about the diagonal permutes the axes */
    lr_transform third = lr_transform_rotate((lr_vec3){1, 1, 1}, 120);
    assert_vector(lr_transform_point(&third, p), (lr_vec3){3, 1, 2}, 1e-14);
}

static lr_transform random_transform(void)
{
    lr_transform t = lr_transform_rotate(random_vector(1), random_between(0, 360));
    t = lr_transform_multiply(
        lr_transform_scale(
            (lr_vec3){random_between(0.1, 9), random_between(0.1, 9), random_between(-9, -0.1)}),
        t);
    return lr_transform_multiply(lr_transform_translate(random_vector(10)), t);
}

static void test_inverse(void **state)
{
    (void)state;
    for (int i = 0; i < 1000; i++) {
        lr_transform t = random_transform(), inverse;
        lr_vec3 p = random_vector(10);
        assert_true(lr_transform_inverse(&t, &inverse));
        assert_vector(lr_transform_point(&inverse, lr_transform_point(&t, p)), p, 1e-11);
        assert_vector(lr_transform_point(&t, lr_transform_point(&inverse, p)), p, 1e-11);
    }
    lr_transform flat = lr_transform_scale((lr_vec3){1, 0, 1}), untouched = lr_transform_identity();
    assert_false(lr_transform_inverse(&flat, &untouched));
    assert_near(untouched.m[1][1], 1, 0);
    flat.m[1][1] = NAN;
    assert_false(lr_transform_inverse(&flat, &untouched));
}

/* A normal stays at right angles to the directions in its surface. */
static void test_normals(void **state)
{
    (void)state;
    for (int i = 0; i < 1000; i++) {
        lr_transform t = random_transform(), inverse;
        lr_vec3 n = lr_vec3_normalize(random_vector(1)), u, v;
        lr_vec3_frame(n, &u, &v);
        assert_true(lr_transform_inverse(&t, &inverse));
        lr_vec3 moved = lr_transform_normal(&inverse, n);
        assert_near(lr_vec3_dot(moved, lr_transform_vector(&t, u)), 0, 1e-12);
        assert_near(lr_vec3_dot(moved, lr_transform_vector(&t, v)), 0, 1e-12);
        assert_near(lr_vec3_dot(moved, lr_transform_vector(&t, n)), 1, 1e-12);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_arithmetic), cmocka_unit_test(test_extreme_lengths),
        cmocka_unit_test(test_frame),      cmocka_unit_test(test_sine_and_cosine),
        cmocka_unit_test(test_transforms), cmocka_unit_test(test_inverse),
        cmocka_unit_test(test_normals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
