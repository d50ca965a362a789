/* Tone maps and white balance against published values and other people's approximations. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "base/hash.h"
#include "image/image_internal.h"

#define assert_close(value, expected, tolerance)                                                   \
    do {                                                                                           \
        double value_ = (value), expected_ = (expected);                                           \
        if (!(fabs(value_ - expected_) <= (tolerance)))                                            \
            fail_msg("%s is %.10g, expected %.10g", #value, value_, expected_);                    \
    } while (0)

static lr_vec3 map(lr_tone kind, double r, double g, double b)
{
    image_tone tone;
    assert_int_equal(image_tone_create(&tone, kind, NULL), LR_OK);
    lr_vec3 color = image_tone_apply(&tone, (lr_vec3){r, g, b});
    image_tone_free(&tone);
    return color;
}

static void expect_color(lr_vec3 color, double r, double g, double b, double tolerance)
{
    assert_close(color.x, r, tolerance);
    assert_close(color.y, g, tolerance);
    assert_close(color.z, b, tolerance);
}

static void test_names(void **state)
{
    (void)state;
    assert_string_equal(lr_tone_name(LR_TONE_NONE), "none");
    assert_string_equal(lr_tone_name(LR_TONE_REINHARD), "reinhard");
    assert_string_equal(lr_tone_name(LR_TONE_ACES), "aces");
    assert_string_equal(lr_tone_name(LR_TONE_AGX), "agx");
    assert_null(lr_tone_name((lr_tone)4));
    assert_null(lr_tone_name((lr_tone)-1));
}

/* Each channel by itself: 1 is 1.0625 / 2, and 4 is white. */
static void test_reinhard(void **state)
{
    (void)state;
    expect_color(map(LR_TONE_REINHARD, 0, 1, 4), 0, 0.53125, 1, 1e-15);
    expect_color(map(LR_TONE_REINHARD, 0.18, 0.5, 2), 0.154258474576271, 0.34375, 0.75, 1e-14);
}

/* Reference values were computed from the published matrices with numpy. That greys stay grey and
 * middle grey comes out near the 0.1 of ACES is known of the original. */
static void test_aces(void **state)
{
    (void)state;
    lr_vec3 grey = map(LR_TONE_ACES, 0.18, 0.18, 0.18);
    assert_close(grey.x, 0.1, 0.01);
    assert_close(grey.y, grey.x, 2e-5);
    assert_close(grey.z, grey.x, 2e-5);
    expect_color(map(LR_TONE_ACES, 0.18, 0.18, 0.18), 0.105591247228931, 0.105591247228931,
                 0.105590191316458, 1e-12);
    expect_color(map(LR_TONE_ACES, 4, 0.25, 0.0625), 1.13438599827049, 0.352392217747351,
                 0.100344396200718, 1e-12);
}

/* Benjamin Wrensch's polynomial for the table of AgX's sigmoid, with a mean squared error of 3.7e-6
 * to that. */
static double wrensch(double x)
{
    return ((((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x + 0.1191) * x -
            0.00232);
}

static void test_agx_greys(void **state)
{
    (void)state;
    double squares = 0, before = 0;
    const int count = 1000;
    image_tone tone;
    assert_int_equal(image_tone_create(&tone, LR_TONE_AGX, NULL), LR_OK);
    for (int i = 0; i <= count; i++) {
        double x = (double)i / count, light = 0.18 * exp2(16.5 * x - 10);
        lr_vec3 color = image_tone_apply(&tone, (lr_vec3){light, light, light});
        assert_close(color.y, color.x, 1e-9);
        assert_close(color.z, color.x, 1e-9);
        assert_true(color.x >= before && color.x <= 1 + 1e-9);
        before = color.x;
        double shade = pow(color.x, 1 / 2.2);
        squares += pow(shade - wrensch(x), 2) / count;
        assert_close(shade, wrensch(x), 0.006);
    }
    image_tone_free(&tone);
    assert_true(squares < 8e-6);
    lr_vec3 grey = map(LR_TONE_AGX, 0.18, 0.18, 0.18);
    assert_close(grey.x, pow(0.5, 2.2), 1e-7);
    expect_color(map(LR_TONE_AGX, 0, 0, 0), 0, 0, 0, 0);
    expect_color(map(LR_TONE_AGX, 1e9, 1e9, 1e9), 1, 1, 1, 1e-9);
}

/* Between the steps of the tables: the closed form of the sigmoid and of the power, with libm. */
static void test_agx_tables(void **state)
{
    (void)state;
    image_tone tone;
    assert_int_equal(image_tone_create(&tone, LR_TONE_AGX, NULL), LR_OK);
    const double grey = 20.0 / 33;
    for (int i = 0; i < 100000; i++) {
        double x = (i + 0.37) / 100000, light = 0.18 * exp2(16.5 * x - 10);
        double n = x < grey ? 3 : 3.25, side = x < grey ? grey : 1 - grey, rise = 2 * (x - grey);
        double bend = pow(fabs(rise), n) * (pow(2, n) - pow(2 * side, -n));
        double want = pow(0.5 + rise / pow(1 + bend, 1 / n), 2.2);
        lr_vec3 color = image_tone_apply(&tone, (lr_vec3){light, light, light});
        assert_close(color.x, want, 3e-7);
    }
    image_tone_free(&tone);
}

/* Colours, as numpy has them from Filament's matrices and the closed form. */
static void test_agx_colors(void **state)
{
    (void)state;
    expect_color(map(LR_TONE_AGX, 4, 0.25, 0.0625), 1.03277314227788, 0.456219485114956,
                 0.319726443947921, 1e-6);
    expect_color(map(LR_TONE_AGX, 0, 0, 8), 0.386532975004332, 0.559817032121716, 1.0976601788051,
                 1e-6);
}

/* Whatever light there is, a colour comes out. */
static void test_any_light(void **state)
{
    (void)state;
    static const double lights[] = {0,    -0.0, 1e-300, 1e-30, 1e-5,     0.5,       1,
                                    1000, 1e30, 1e308,  -1,    INFINITY, -INFINITY, NAN};
    const int count = sizeof lights / sizeof *lights;
    for (int kind = LR_TONE_REINHARD; kind <= LR_TONE_AGX; kind++) {
        image_tone tone;
        assert_int_equal(image_tone_create(&tone, (lr_tone)kind, NULL), LR_OK);
        for (int i = 0; i < count * count * count; i++) {
            lr_vec3 light = {lights[i % count], lights[i / count % count],
                             lights[i / count / count]};
            lr_vec3 color = image_tone_apply(&tone, light);
            assert_true(isfinite(color.x) && isfinite(color.y) && isfinite(color.z));
        }
        image_tone_free(&tone);
        lr_vec3 dark = map((lr_tone)kind, NAN, -1, 0),
                bright = map((lr_tone)kind, 1e30, 1e30, 1e30);
        assert_true(dark.x <= 0 && dark.y <= 0 && dark.z <= 0);
        assert_true(bright.x >= 0.9999 && bright.y >= 0.9999 && bright.z >= 0.9999);
    }
}

/* The linear sRGB colour of a chromaticity, of luminance 1. */
static lr_vec3 light_of(double x, double y)
{
    static const lr_transform to_xyz = {
        {{0.4124, 0.3576, 0.1805, 0}, {0.2126, 0.7152, 0.0722, 0}, {0.0193, 0.1192, 0.9505, 0}}};
    lr_transform from_xyz;
    assert_true(lr_transform_inverse(&to_xyz, &from_xyz));
    return lr_transform_vector(&from_xyz, (lr_vec3){x / y, 1, (1 - x - y) / y});
}

/* Chromaticities from the tables of Wyszecki and Stiles, "Color Science" (black bodies) and CIE 15
 * (illuminants A, D50, D65, D75; these have 1.4388 / 1.4380 times their nominal temperature). */
static void test_white(void **state)
{
    (void)state;
    static const struct {
        double kelvin, x, y;
    } lights[] = {
        {2000, 0.5267, 0.4133},     {2500, 0.4770, 0.4137},     {3000, 0.4369, 0.4041},
        {3500, 0.4053, 0.3907},     {2856, 0.44757, 0.40745},   {5002.8, 0.34567, 0.35850},
        {6503.6, 0.31272, 0.32903}, {7504.2, 0.29902, 0.31485},
    };
    for (size_t i = 0; i < sizeof lights / sizeof *lights; i++) {
        lr_transform balance = image_white_balance(lights[i].kelvin);
        lr_vec3 white = lr_transform_vector(&balance, light_of(lights[i].x, lights[i].y));
        expect_color(white, 1, 1, 1, 0.006);
    }
}

/* Bruce Lindbloom's matrix from D50 to D65 by Bradford's transform, around the map of colours. */
static void test_bradford(void **state)
{
    (void)state;
    static const lr_transform adapt = {{{0.9555766, -0.0230393, 0.0631636, 0},
                                        {-0.0282895, 1.0099416, 0.0210077, 0},
                                        {0.0122982, -0.0204830, 1.3299098, 0}}};
    static const lr_transform to_xyz = {
        {{0.4124, 0.3576, 0.1805, 0}, {0.2126, 0.7152, 0.0722, 0}, {0.0193, 0.1192, 0.9505, 0}}};
    lr_transform from_xyz, balance = image_white_balance(5002.8);
    assert_true(lr_transform_inverse(&to_xyz, &from_xyz));
    lr_transform want = lr_transform_multiply(from_xyz, lr_transform_multiply(adapt, to_xyz));
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            assert_close(balance.m[i][k], want.m[i][k], 0.002);
}

/* Warmer light is drawn to blue and colder light to red, without jumps but for the one at 4000 K
 * from black bodies to daylight. */
static void test_white_is_smooth(void **state)
{
    (void)state;
    double before = 1e9;
    for (int kelvin = LR_WHITE_MIN; kelvin <= LR_WHITE_MAX; kelvin++) {
        lr_transform balance = image_white_balance(kelvin);
        lr_vec3 color = lr_transform_vector(&balance, (lr_vec3){1, 1, 1});
        double cold = color.z - color.x;
        if (kelvin != LR_WHITE_MIN)
            assert_true(kelvin == 4000 ? fabs(cold - before) < 0.1
                                       : cold < before && cold > before - 0.06);
        before = cold;
    }
}

static unsigned char *encode(const lr_picture *picture, lr_encoding encoding, size_t *size)
{
    unsigned char *bytes;
    lr_error error = {0};
    if (lr_picture_encode(picture, &encoding, &bytes, size, &error) != LR_OK)
        fail_msg("%s", error.message);
    return bytes;
}

static void expect_same(const lr_picture *a, lr_encoding a_encoding, const lr_picture *b,
                        lr_encoding b_encoding)
{
    size_t sizes[2];
    unsigned char *bytes[2] = {encode(a, a_encoding, &sizes[0]), encode(b, b_encoding, &sizes[1])};
    assert_int_equal(sizes[0], sizes[1]);
    assert_memory_equal(bytes[0], bytes[1], sizes[0]);
    free(bytes[0]);
    free(bytes[1]);
}

#define ENCODING(...) ((lr_encoding){__VA_ARGS__})
#define SIZE 64

/* Light over 24 stops in many colours. */
static void fill(float pixels[3 * SIZE * SIZE])
{
    uint32_t seed = 1;
    for (int i = 0; i < 3 * SIZE * SIZE; i++) {
        seed = seed * 747796405u + 2891336453u;
        pixels[i] = ldexpf((float)(seed >> 8), (int)(seed % 24) - 36);
    }
}

/* White balance, then exposure, then the tone map; files of light have no tone. */
static void test_order(void **state)
{
    (void)state;
    static float pixels[3 * SIZE * SIZE], twice[3 * SIZE * SIZE];
    fill(pixels);
    for (int i = 0; i < 3 * SIZE * SIZE; i++)
        twice[i] = 2 * pixels[i];
    lr_picture one = {SIZE, SIZE, pixels}, two = {SIZE, SIZE, twice};
    for (int kind = LR_TONE_NONE; kind <= LR_TONE_AGX; kind++) {
        lr_tone tone = (lr_tone)kind;
        expect_same(&one, ENCODING(.tone = tone, .exposure = 1, .white = 3200), &two,
                    ENCODING(.tone = tone, .white = 3200));
        for (int format = LR_FORMAT_PFM; format <= LR_FORMAT_EXR; format++)
            expect_same(&one, ENCODING(.format = (lr_format)format, .tone = tone), &one,
                        ENCODING(.format = (lr_format)format));
    }
    size_t size;
    unsigned char *pfm = encode(&one, ENCODING(.format = LR_FORMAT_PFM, .white = 3200), &size);
    float last[3];
    memcpy(last, pfm + size - sizeof last, sizeof last);
    lr_transform balance = image_white_balance(3200);
    const float *in = pixels + 3 * (SIZE - 1); /* the top row is last */
    lr_vec3 want = lr_transform_vector(&balance, (lr_vec3){in[0], in[1], in[2]});
    assert_true(last[0] == (float)want.x && last[1] == (float)want.y && last[2] == (float)want.z);
    free(pfm);
}

/* The bytes are the same on every machine. */
static void test_bytes(void **state)
{
    (void)state;
    static const char *const hashes[] = {
        "8229dc6fce231022d5c2a8247b716bc2b1a227339a6dd9eb58bf38a002822457",
        "95e69f3b48cad9da5b36f0188bb31474608022c1f1192c481f88fe8d7f0630d3",
        "9d91e0a0d37f136a55ee62e5c23a6edab227411c6d11c75018c595e1a7e69d41",
        "a2a368c218c0c9df9c77cacaa93cdb12976987a59c8e90cb3ca782a3e19055be"};
    static float pixels[3 * SIZE * SIZE];
    fill(pixels);
    lr_picture picture = {SIZE, SIZE, pixels};
    for (int kind = LR_TONE_NONE; kind <= LR_TONE_AGX; kind++) {
        size_t size;
        char hash[65];
        unsigned char *bytes = encode(
            &picture, ENCODING(.maxval = 65535, .tone = (lr_tone)kind, .white = 3200), &size);
        lr_hash_bytes(bytes, size, hash);
        assert_string_equal(hash, hashes[kind]);
        free(bytes);
    }
}

static void test_refusals(void **state)
{
    (void)state;
    float pixels[3] = {0};
    lr_picture picture = {1, 1, pixels};
    static const float wrong[] = {1666, 25001, -1, NAN, INFINITY};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        unsigned char *bytes;
        size_t size;
        lr_error error = {0};
        assert_int_equal(
            lr_picture_encode(&picture, &ENCODING(.white = wrong[i]), &bytes, &size, &error),
            LR_ERROR_ARGUMENT);
        assert_non_null(strstr(error.message, "expected 1667 to 25000"));
    }
    unsigned char *bytes;
    size_t size;
    lr_error error = {0};
    assert_int_equal(
        lr_picture_encode(&picture, &ENCODING(.tone = (lr_tone)4), &bytes, &size, &error),
        LR_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "unknown tone map"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_names),      cmocka_unit_test(test_reinhard),
        cmocka_unit_test(test_aces),       cmocka_unit_test(test_agx_greys),
        cmocka_unit_test(test_agx_tables), cmocka_unit_test(test_agx_colors),
        cmocka_unit_test(test_any_light),  cmocka_unit_test(test_white),
        cmocka_unit_test(test_bradford),   cmocka_unit_test(test_white_is_smooth),
        cmocka_unit_test(test_order),      cmocka_unit_test(test_bytes),
        cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
