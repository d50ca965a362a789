/* Every function of exact.glsl against double precision, with the error bounds that its comments
 * state. */
#include "gpu_tests.h"

#include "exact.spv.h"

#define COUNT 131072u
#define ZERO_BELOW ldexp(1, -100)

typedef struct item {
    vec4 a, b;
} item;

enum {
    RCP,
    DIV,
    RSQRT,
    SQRT,
    LOG2,
    EXP2,
    POW,
    LENGTH,
    DOT,
    MIX,
    COS_SIN_TURNS,
    ANGLE_TURNS,
    IS_FINITE
};

static item given[COUNT];
static vec4 found[COUNT];

static void run(void **state, uint32_t which)
{
    run_kernel(*state, &(kernel){.words = exact_spv,
                                 .word_count = sizeof exact_spv / 4,
                                 .in = given,
                                 .in_size = sizeof given,
                                 .out = found,
                                 .out_size = sizeof found,
                                 .which = which,
                                 .groups = COUNT / LR_GROUP_SIZE});
}

static double ulps(double value, double expected)
{
    return fabs(value - expected) / ulp_of(expected);
}

/* Arguments of either sign over the whole domain, its ends first. */
static void fill_magnitudes(uint32_t seed, bool negative_too)
{
    for (uint32_t i = 0; i < COUNT; i++) {
        float sign = negative_too ? random_sign(&seed) : 1;
        given[i] = (item){.a = {.x = sign * random_magnitude(&seed, -100, 99)}};
    }
    given[0].a.x = ldexpf(1, -100);
    given[1].a.x = ldexpf(1, 100);
    given[2].a.x = 1;
    given[3].a.x = nextafterf(1, 0);
    given[4].a.x = nextafterf(ldexpf(1, -100), 1);
}

static void test_rcp(void **state)
{
    fill_magnitudes(1, true);
    run(state, RCP);
    double worst = 0;
    for (uint32_t i = 0; i < COUNT; i++)
        worst = fmax(worst, ulps(found[i].x, 1.0 / given[i].a.x));
    print_message("ex_rcp: %.3f ulp\n", worst);
    assert_true(worst <= 1.5);
}

static void test_div(void **state)
{
    uint32_t seed = 2;
    fill_magnitudes(2, true);
    for (uint32_t i = 0; i < COUNT; i++) {
        given[i].b.x = random_sign(&seed) * random_magnitude(&seed, -60, 60);
        given[i].a.x = random_sign(&seed) * random_magnitude(&seed, -60, 60);
    }
    run(state, DIV);
    double worst = 0;
    for (uint32_t i = 0; i < COUNT; i++)
        worst = fmax(worst, ulps(found[i].x, (double)given[i].a.x / given[i].b.x));
    print_message("ex_div: %.3f ulp\n", worst);
    assert_true(worst <= 2.5);
}

static void test_rsqrt(void **state)
{
    fill_magnitudes(3, false);
    run(state, RSQRT);
    double worst = 0;
    for (uint32_t i = 0; i < COUNT; i++)
        worst = fmax(worst, ulps(found[i].x, 1 / sqrt(given[i].a.x)));
    print_message("ex_rsqrt: %.3f ulp\n", worst);
    assert_true(worst <= 2);
}

static void test_sqrt(void **state)
{
    fill_magnitudes(4, false);
    const float zero[] = {0, -0.0f, -1, -1e-30f, -1e30f, -INFINITY, 1e-31f, 1e-38f, 1e-45f};
    uint32_t zeros = sizeof zero / sizeof *zero;
    for (uint32_t i = 0; i < zeros; i++)
        given[COUNT - 1 - i].a.x = zero[i];
    run(state, SQRT);
    double worst = 0;
    for (uint32_t i = 0; i < COUNT - zeros; i++)
        worst = fmax(worst, ulps(found[i].x, sqrt(given[i].a.x)));
    for (uint32_t i = COUNT - zeros; i < COUNT; i++)
        assert_int_equal(bits_of(found[i].x), 0);
    print_message("ex_sqrt: %.3f ulp\n", worst);
    assert_true(worst <= 3.5);
}

static void test_log2(void **state)
{
    uint32_t seed = 5;
    fill_magnitudes(5, false);
    for (uint32_t i = 8; i < COUNT; i++)
        given[i].a.x = i % 2 ? random_magnitude(&seed, -126, 126) : random_between(&seed, 0.5, 2);
    run(state, LOG2);
    double worst = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        double expected = log2(given[i].a.x);
        if (expected != 0)
            worst = fmax(worst, fabs(found[i].x - expected) / fabs(expected));
        else
            assert_true(found[i].x == 0);
    }
    print_message("ex_log2: %.3g relative\n", worst);
    assert_true(worst < 4e-7);
}

static void test_exp2(void **state)
{
    uint32_t seed = 6;
    for (uint32_t i = 0; i < COUNT; i++)
        given[i].a.x = random_between(&seed, -100, 100);
    const float beyond[] = {100, 101, 1e30f, 3.4e38f, -100.001f, -1e30f, -3.4e38f, 0, 1, -1};
    const double limits[] = {
        ldexp(1, 100), ldexp(1, 100), ldexp(1, 100), ldexp(1, 100), 0, 0, 0, 1, 2, 0.5};
    uint32_t limit_count = sizeof beyond / sizeof *beyond;
    for (uint32_t i = 0; i < limit_count; i++)
        given[i].a.x = beyond[i];
    run(state, EXP2);
    for (uint32_t i = 0; i < limit_count; i++)
        assert_true(found[i].x == limits[i]);
    double worst = 0;
    for (uint32_t i = limit_count; i < COUNT; i++) {
        double expected = exp2(given[i].a.x);
        worst = fmax(worst, fabs(found[i].x - expected) / expected);
    }
    print_message("ex_exp2: %.3g relative\n", worst);
    assert_true(worst < 3e-7);
}

static void test_pow(void **state)
{
    uint32_t seed = 7;
    for (uint32_t i = 0; i < COUNT; i++) {
        float x = i % 2 ? random_magnitude(&seed, -99, 99) : random_between(&seed, 1e-3, 1);
        double most = 99 / fmax(fabs(log2(x)), 0.01);
        given[i] = (item){{.x = x}, {.x = random_between(&seed, -most, most)}};
    }
    const float bases[] = {0, 1, 2, 1e-20f, 0.5f, -1, 1e30f};
    for (uint32_t i = 0; i < 7; i++) {
        given[i] = (item){{.x = bases[i]}, {.x = 0}};         /* x^0 */
        given[7 + i] = (item){{.x = -(float)i}, {.x = 2.5f}}; /* nothing of nothing */
    }
    given[14] = (item){{.x = 2}, {.x = 0.5f}};
    given[15] = (item){{.x = 10}, {.x = 3.7f}};
    run(state, POW);
    for (uint32_t i = 0; i < 7; i++) {
        assert_true(found[i].x == 1);
        assert_true(found[7 + i].x == 0);
    }
    assert_near(found[14].x, 1.41421356, 4e-7);
    assert_near(found[15].x, 5011.8723, 5012 * 4e-7 * 13.3);
    double worst = 0;
    for (uint32_t i = 14; i < COUNT; i++) {
        double power = given[i].b.x * log2(given[i].a.x), expected = exp2(power);
        worst = fmax(worst, fabs(found[i].x - expected) / expected / (1 + fabs(power)));
    }
    print_message("ex_pow: %.3g (1 + |y log2 x|) relative\n", worst);
    assert_true(worst < 4e-7);
}

static double dot(vec4 a, vec4 b)
{
    return (double)a.x * b.x + (double)a.y * b.y + (double)a.z * b.z;
}

static void fill_vectors(uint32_t seed)
{
    for (uint32_t i = 0; i < COUNT; i++) {
        float size = random_magnitude(&seed, -49, 48), other = random_magnitude(&seed, -49, 48);
        given[i] =
            (item){{random_between(&seed, -1, 1) * size, random_between(&seed, -1, 1) * size,
                    random_sign(&seed) * size, 0},
                   {random_between(&seed, -1, 1) * other, random_between(&seed, -1, 1) * other,
                    random_sign(&seed) * other, random_between(&seed, 0, 1)}};
    }
}

static void test_length_and_normalize(void **state)
{
    fill_vectors(8);
    run(state, LENGTH);
    double worst_length = 0, worst_unit = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        vec4 a = given[i].a, n = found[i];
        double length = sqrt(dot(a, a));
        worst_length = fmax(worst_length, ulps(n.w, length));
        worst_unit = fmax(worst_unit, fabs(n.x - a.x / length));
        worst_unit = fmax(worst_unit, fabs(n.y - a.y / length));
        worst_unit = fmax(worst_unit, fabs(n.z - a.z / length));
        worst_unit = fmax(worst_unit, fabs(sqrt(dot(n, n)) - 1));
    }
    print_message("ex_length: %.3f ulp, ex_normalize: %.3g\n", worst_length, worst_unit);
    assert_true(worst_length <= 4.5);
    assert_true(worst_unit <= 3e-7);
}

static void test_dot_and_cross(void **state)
{
    fill_vectors(9);
    run(state, DOT);
    double worst = 0; /* in units of the two vectors' lengths */
    for (uint32_t i = 0; i < COUNT; i++) {
        vec4 a = given[i].a, b = given[i].b, r = found[i];
        double scale = sqrt(dot(a, a) * dot(b, b));
        worst = fmax(worst, fabs(r.w - dot(a, b)) / scale);
        worst = fmax(worst, fabs(r.x - ((double)a.y * b.z - (double)a.z * b.y)) / scale);
        worst = fmax(worst, fabs(r.y - ((double)a.z * b.x - (double)a.x * b.z)) / scale);
        worst = fmax(worst, fabs(r.z - ((double)a.x * b.y - (double)a.y * b.x)) / scale);
    }
    print_message("ex_dot, ex_cross: %.3g |a| |b|\n", worst);
    assert_true(worst <= 2e-7);
}

static void test_mix(void **state)
{
    fill_vectors(10);
    for (uint32_t i = 0; i < 1000; i++)
        given[i].b.w = (float)(i % 2);
    run(state, MIX);
    for (uint32_t i = 0; i < 1000; i++) {
        vec4 end = i % 2 ? given[i].b : given[i].a;
        assert_true(found[i].x == end.x && found[i].y == end.y && found[i].z == end.z);
    }
    for (uint32_t i = 1000; i < COUNT; i++) {
        vec4 a = given[i].a, b = given[i].b;
        double t = b.w;
        assert_near(found[i].y, a.y * (1 - t) + b.y * t, 2e-7 * (fabs(a.y) + fabs(b.y)));
    }
}

static void test_cos_sin_turns(void **state)
{
    const double tau = 6.283185307179586476925287;
    uint32_t seed = 11;
    for (uint32_t i = 0; i < COUNT; i++)
        given[i].a.x = i % 4 == 0   ? random_between(&seed, -1048576, 1048576)
                       : i % 4 == 1 ? random_sign(&seed) * random_magnitude(&seed, -100, 0)
                                    : random_between(&seed, -1, 1);
    for (uint32_t i = 0; i < 64; i++) /* the quarters' ends and middles, and right beside them */
        given[i].a.x = nextafterf(((float)(i / 2) - 16) / 8, i % 2 ? INFINITY : -INFINITY);
    for (uint32_t i = 64; i < 128; i++)
        given[i].a.x = ((float)i - 96) / 4;
    run(state, COS_SIN_TURNS);
    for (uint32_t i = 64; i < 128; i++) {
        const float quarters[] = {1, 0, -1, 0};
        assert_true(found[i].x == quarters[i % 4] && found[i].y == quarters[(i + 3) % 4]);
    }
    double worst = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        double angle = tau * fmod(given[i].a.x, 1);
        worst = fmax(worst, fabs(found[i].x - cos(angle)));
        worst = fmax(worst, fabs(found[i].y - sin(angle)));
    }
    print_message("ex_cos_sin_turns: %.3g\n", worst);
    assert_true(worst < 1.2e-7);
}

static void test_angle_turns(void **state)
{
    const double tau = 6.283185307179586476925287;
    uint32_t seed = 12;
    for (uint32_t i = 0; i < COUNT; i++) {
        float scale = random_magnitude(&seed, -80, 98);
        given[i].a.x = scale * (i % 3 ? random_between(&seed, -1, 1) : random_sign(&seed));
        given[i].a.y = scale * (i % 3 == 1 ? random_sign(&seed) : random_between(&seed, -1, 1));
    }
    const float corners[][3] = {{1, 0, 0},     {1, 1, 0.125f},    {0, 1, 0.25f},   {-1, 1, 0.375f},
                                {-1, 0, 0.5f}, {-1, -1, -0.375f}, {0, -1, -0.25f}, {0, 0, 0}};
    for (uint32_t i = 0; i < 8; i++) {
        given[i].a.x = corners[i][0];
        given[i].a.y = corners[i][1];
    }
    run(state, ANGLE_TURNS);
    for (uint32_t i = 0; i < 8; i++)
        assert_near(found[i].x, corners[i][2], 3e-8);
    double worst = 0;
    for (uint32_t i = 8; i < COUNT; i++) {
        double error = fabs(found[i].x - atan2(given[i].a.y, given[i].a.x) / tau);
        worst = fmax(worst, fmin(error, 1 - error));
    }
    print_message("ex_angle_turns: %.3g\n", worst);
    assert_true(worst < 6e-8);
}

static void test_is_finite(void **state)
{
    const float values[] = {0,        -0.0f,     1e-45f, 3.4028235e38f, -3.4028235e38f,
                            INFINITY, -INFINITY, NAN,    -NAN};
    memset(given, 0, sizeof given);
    for (uint32_t i = 0; i < 9; i++)
        given[i].a.x = values[i];
    run(state, IS_FINITE);
    for (uint32_t i = 0; i < 9; i++)
        assert_true(found[i].x == (i < 5 ? 1.0f : 0.0f));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rcp),           cmocka_unit_test(test_div),
        cmocka_unit_test(test_rsqrt),         cmocka_unit_test(test_sqrt),
        cmocka_unit_test(test_log2),          cmocka_unit_test(test_exp2),
        cmocka_unit_test(test_pow),           cmocka_unit_test(test_length_and_normalize),
        cmocka_unit_test(test_dot_and_cross), cmocka_unit_test(test_mix),
        cmocka_unit_test(test_cos_sin_turns), cmocka_unit_test(test_angle_turns),
        cmocka_unit_test(test_is_finite),     cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device, NULL);
}
