/* The bytes of PPM, PFM and PNG files; netpbm and libpng read them back. */
#define _GNU_SOURCE
#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

#include "temporary_folder.h"

#include "base/file.h"
#include "base/exact.h"
#include "image/image_internal.h"

/* Every sample differs from its neighbours; some lie outside 0..1. */
static lr_picture make_picture(uint32_t width, uint32_t height)
{
    lr_picture picture = {width, height, malloc(3 * sizeof(float) * width * height)};
    uint32_t seed = width * 31 + height;
    for (size_t i = 0; i < 3 * (size_t)width * height; i++) {
        seed = seed * 747796405u + 2891336453u;
        picture.pixels[i] = (float)(seed >> 8) / 16777216 * 1.2f - 0.1f;
    }
    return picture;
}

static unsigned char *encode(const lr_picture *picture, lr_encoding encoding, size_t *size)
{
    unsigned char *bytes;
    lr_error error = {0};
    if (lr_picture_encode(picture, &encoding, &bytes, size, &error) != LR_OK)
        fail_msg("%s", error.message);
    return bytes;
}

static void expect_bytes(const lr_picture *picture, lr_encoding encoding, const void *expected,
                         size_t expected_size)
{
    size_t size;
    unsigned char *bytes = encode(picture, encoding, &size);
    assert_int_equal(size, expected_size);
    assert_memory_equal(bytes, expected, size);
    free(bytes);
}

#define EXPECT(picture, text, ...)                                                                 \
    expect_bytes(picture, (lr_encoding){__VA_ARGS__}, text, sizeof text - 1)

static void test_ppm_bytes(void **state)
{
    (void)state;
    float pixels[] = {0, 0.25f, 0.5f, 1, 2, NAN};
    lr_picture wide = {2, 1, pixels}, tall = {1, 2, pixels};
    EXPECT(&wide, "P6\n2 1\n255\n\x00\x40\x80\xff\xff\x00", .transfer = LR_TRANSFER_LINEAR);
    EXPECT(&tall, "P6\n1 2\n255\n\x00\x40\x80\xff\xff\x00", .transfer = LR_TRANSFER_LINEAR,
           .maxval = 255);
    EXPECT(&wide, "P6\n2 1\n1\n\x00\x00\x01\x01\x01\x00", .transfer = LR_TRANSFER_LINEAR,
           .maxval = 1);
    EXPECT(&wide, "P6\n2 1\n256\n\x00\x00\x00\x40\x00\x80\x01\x00\x01\x00\x00\x00",
           .transfer = LR_TRANSFER_LINEAR, .maxval = 256);
    EXPECT(&wide, "P6\n2 1\n65535\n\x00\x00\x40\x00\x80\x00\xff\xff\xff\xff\x00\x00",
           .transfer = LR_TRANSFER_LINEAR, .maxval = 65535);
    EXPECT(&wide, "P6\n2 1\n255\n\x00\x89\xbc\xff\xff\x00", .transfer = LR_TRANSFER_SRGB);
}

static void test_exposure(void **state)
{
    (void)state;
    float pixels[] = {0.25f, 0.125f, 0.3f};
    lr_picture picture = {1, 1, pixels};
    EXPECT(&picture, "P6\n1 1\n255\n\x80\x40\x99", .transfer = LR_TRANSFER_LINEAR, .exposure = 1);
    EXPECT(&picture, "P6\n1 1\n255\n\x20\x10\x26", .transfer = LR_TRANSFER_LINEAR, .exposure = -1);

    /* Whole stops are exact, also at the ends of the range; others are right to the last bit. */
    static const float stops[] = {-126, -3, -1, 0, 1, 4, 100, 0.5f, -0.25f, 1.75f, 0.1f, -7.3f};
    for (size_t i = 0; i < sizeof stops / sizeof *stops; i++) {
        size_t size;
        float value;
        pixels[2] = 1;
        unsigned char *bytes =
            encode(&picture, (lr_encoding){.format = LR_FORMAT_PFM, .exposure = stops[i]}, &size);
        memcpy(&value, bytes + size - 4, 4);
        assert_true(value == (float)exp2l((long double)stops[i]));
        free(bytes);
    }
    pixels[2] = 1e-30f;
    EXPECT(&picture, "P6\n1 1\n255\n\xff\xff\xff", .transfer = LR_TRANSFER_LINEAR, .exposure = 100);
}

static void test_exp2(void **state)
{
    (void)state;
    for (int i = -20000; i <= 20000; i += 7) {
        double stops = i / 100.0, power = lr_exp2(stops);
        assert_true(fabsl(power / exp2l((long double)stops) - 1) < 4e-16L);
    }
}

static void test_pfm_bytes(void **state)
{
    (void)state;
    float pixels[] = {1, 2, 3, -0.5f, 0, 1e-30f};
    lr_picture picture = {1, 2, pixels};
    /* The bottom row comes first; maxval and transfer do not matter. */
    EXPECT(&picture,
           "PF\n1 2\n-1.0\n"
           "\x00\x00\x00\xbf\x00\x00\x00\x00\x60\x42\xa2\x0d"
           "\x00\x00\x80\x3f\x00\x00\x00\x40\x00\x00\x40\x40",
           .format = LR_FORMAT_PFM, .maxval = 1000);
    EXPECT(&picture,
           "PF\n1 2\n-1.0\n"
           "\x00\x00\x80\xbf\x00\x00\x00\x00\x60\x42\x22\x0e"
           "\x00\x00\x00\x40\x00\x00\x80\x40\x00\x00\xc0\x40",
           .format = LR_FORMAT_PFM, .transfer = LR_TRANSFER_LINEAR, .exposure = 1);
}

/* The samples as the curve alone gives them. */
static void expect_samples(const lr_picture *picture, lr_transfer transfer, uint32_t maxval,
                           const unsigned char *raster, size_t size)
{
    lr_curve curve;
    assert_int_equal(lr_curve_create(&curve, transfer, maxval, NULL), LR_OK);
    size_t count = 3 * (size_t)picture->width * picture->height, sample = maxval < 256 ? 1 : 2;
    assert_int_equal(size, count * sample);
    for (size_t i = 0; i < count; i++) {
        uint32_t value = sample == 1 ? raster[i] : raster[2 * i] * 256u + raster[2 * i + 1];
        if (value != lr_curve_encode(&curve, picture->pixels[i]))
            fail_msg("sample %zu of %zu, maxval %u: %u", i, count, maxval, value);
    }
    lr_curve_free(&curve);
}

typedef struct png_input {
    const unsigned char *bytes;
    size_t left;
} png_input;

static void read_png(png_structp png, png_bytep out, size_t size)
{
    png_input *input = png_get_io_ptr(png);
    if (size > input->left)
        png_error(png, "the file is too short");
    memcpy(out, input->bytes, size);
    input->bytes += size;
    input->left -= size;
}

static void expect_png(const lr_picture *picture, lr_transfer transfer, uint32_t maxval)
{
    size_t size;
    unsigned char *bytes = encode(
        picture, (lr_encoding){.format = LR_FORMAT_PNG, .transfer = transfer, .maxval = maxval},
        &size);
    /* Looked up in the bytes, as libpng would give sRGB's gamma whatever gAMA says. */
    const unsigned char *chunk = memmem(bytes, size, "gAMA", 4);
    assert_non_null(chunk);
    assert_int_equal(png_get_uint_32(chunk + 4), transfer == LR_TRANSFER_SRGB ? 45455 : 100000);

    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_input input = {bytes, size};
    if (setjmp(png_jmpbuf(png)))
        fail_msg("libpng does not read it back");
    png_set_read_fn(png, &input, read_png);
    png_read_png(png, info, PNG_TRANSFORM_IDENTITY, NULL);
    assert_int_equal(input.left, 0);
    assert_int_equal(png_get_image_width(png, info), picture->width);
    assert_int_equal(png_get_image_height(png, info), picture->height);
    assert_int_equal(png_get_bit_depth(png, info), maxval == 255 ? 8 : 16);
    assert_int_equal(png_get_color_type(png, info), PNG_COLOR_TYPE_RGB);

    int intent, has_srgb = png_get_sRGB(png, info, &intent) != 0;
    assert_int_equal(has_srgb, transfer == LR_TRANSFER_SRGB);

    size_t row_size = png_get_rowbytes(png, info);
    unsigned char *raster = malloc(row_size * picture->height);
    for (uint32_t y = 0; y < picture->height; y++)
        memcpy(raster + y * row_size, png_get_rows(png, info)[y], row_size);
    expect_samples(picture, transfer, maxval, raster, row_size * picture->height);
    png_destroy_read_struct(&png, &info, NULL);
    free(raster);
    free(bytes);
}

static void test_png(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{1, 1}, {1, 7}, {13, 1}, {64, 33}, {300, 200}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        lr_picture picture = make_picture(sizes[i][0], sizes[i][1]);
        for (lr_transfer transfer = LR_TRANSFER_SRGB; transfer <= LR_TRANSFER_LINEAR; transfer++) {
            expect_png(&picture, transfer, 255);
            expect_png(&picture, transfer, 65535);
        }
        lr_picture_free(&picture);
    }
}

static bool has_netpbm(void)
{
    return system(
               "command -v pamtopng >/dev/null 2>&1 && command -v pngtopnm >/dev/null 2>&1 && "
               "command -v pnmtopnm >/dev/null 2>&1 && command -v pnmtoplainpnm >/dev/null 2>&1") ==
           0;
}

static void run(const char *format, ...) __attribute__((format(printf, 1, 2)));

static void run(const char *format, ...)
{
    char command[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(command, sizeof command, format, arguments);
    va_end(arguments);
    if (system(command) != 0)
        fail_msg("fails: %s", command);
}

/* netpbm's plain format is decimal text: what another program understood each sample to be. */
static void expect_plain(const lr_picture *picture, const char *path, lr_transfer transfer,
                         uint32_t maxval)
{
    char *text, *at;
    size_t size, count = 3 * (size_t)picture->width * picture->height;
    lr_curve curve;
    assert_int_equal(lr_file_read(path, 1 << 26, &text, &size, NULL), LR_OK);
    assert_int_equal(lr_curve_create(&curve, transfer, maxval, NULL), LR_OK);
    assert_memory_equal(text, "P3\n", 3);
    at = text + 3;
    assert_int_equal(strtoul(at, &at, 10), picture->width);
    assert_int_equal(strtoul(at, &at, 10), picture->height);
    assert_int_equal(strtoul(at, &at, 10), maxval);
    for (size_t i = 0; i < count; i++) {
        uint32_t value = (uint32_t)strtoul(at, &at, 10);
        if (value != lr_curve_encode(&curve, picture->pixels[i]))
            fail_msg("maxval %u, sample %zu: %u", maxval, i, value);
    }
    assert_int_equal(strspn(at, " \n"), strlen(at));
    lr_curve_free(&curve);
    free(text);
}

static void test_netpbm_reads_ppm(void **state)
{
    (void)state;
    static const uint32_t maxvals[] = {1,   2,   3,   7,    100,  127,   128,   254,
                                       255, 256, 257, 1000, 4095, 32768, 65534, 65535};
    if (!has_netpbm()) {
        print_message("netpbm is not installed\n");
        skip();
    }
    lr_picture picture = make_picture(37, 23);
    char path[128], plain[128];
    snprintf(path, sizeof path, "%s/a.ppm", folder);
    snprintf(plain, sizeof plain, "%s/plain.ppm", folder);
    for (size_t i = 0; i < sizeof maxvals / sizeof *maxvals; i++) {
        lr_encoding encoding = {.maxval = maxvals[i]};
        assert_int_equal(lr_picture_write(&picture, path, &encoding, NULL), LR_OK);
        run("pnmtoplainpnm %s > %s", path, plain);
        expect_plain(&picture, plain, LR_TRANSFER_SRGB, maxvals[i]);
        /* Through netpbm and back without a byte changed: nothing is missing or left over. */
        run("pnmtopnm %s | cmp - %s", path, path);
        if (maxvals[i] == 255 || maxvals[i] == 65535)
            run("pamtopng %s | pngtopnm | cmp - %s", path, path);
    }
    lr_picture_free(&picture);
}

static void test_netpbm_reads_png(void **state)
{
    (void)state;
    if (!has_netpbm()) {
        print_message("netpbm is not installed\n");
        skip();
    }
    lr_picture picture = make_picture(41, 19);
    char path[128], plain[128];
    snprintf(path, sizeof path, "%s/a.png", folder);
    snprintf(plain, sizeof plain, "%s/plain.ppm", folder);
    for (uint32_t maxval = 255; maxval <= 65535; maxval += 65280) {
        lr_encoding encoding = {.format = LR_FORMAT_PNG, .maxval = maxval};
        assert_int_equal(lr_picture_write(&picture, path, &encoding, NULL), LR_OK);
        run("pngtopnm %s | pnmtoplainpnm > %s", path, plain);
        expect_plain(&picture, plain, LR_TRANSFER_SRGB, maxval);
    }
    lr_picture_free(&picture);
}

static void expect_refusal(const lr_picture *picture, lr_encoding encoding, const char *expected)
{
    unsigned char *bytes;
    size_t size;
    lr_error error = {0};
    assert_int_equal(lr_picture_encode(picture, &encoding, &bytes, &size, &error),
                     LR_ERROR_ARGUMENT);
    assert_null(bytes);
    if (!strstr(error.message, expected))
        fail_msg("expected \"%s\", got \"%s\"", expected, error.message);
}

static void test_refusals(void **state)
{
    (void)state;
    float pixels[3] = {0};
    lr_picture picture = {1, 1, pixels};
    expect_refusal(&picture, (lr_encoding){.maxval = 65536},
                   "maxval is 65536; expected 1 to 65535");
    expect_refusal(&picture, (lr_encoding){.format = LR_FORMAT_PNG, .maxval = 100},
                   "expected 255 or 65535");
    expect_refusal(&picture, (lr_encoding){.format = LR_FORMAT_PNG, .maxval = 256},
                   "expected 255 or 65535");
    expect_refusal(&picture, (lr_encoding){.exposure = NAN}, "exposure");
    expect_refusal(&picture, (lr_encoding){.exposure = INFINITY}, "exposure");
    expect_refusal(&picture, (lr_encoding){.exposure = 1e9f}, "exposure");
    expect_refusal(&picture, (lr_encoding){.format = (lr_format)9}, "unknown image format");
    expect_refusal(&picture, (lr_encoding){.transfer = (lr_transfer)9}, "unknown transfer");
    expect_refusal(&(lr_picture){0}, (lr_encoding){0}, "empty");
    expect_refusal(&(lr_picture){0, 5, pixels}, (lr_encoding){0}, "empty");
    expect_refusal(&(lr_picture){UINT32_MAX, UINT32_MAX, pixels}, (lr_encoding){0}, "too large");
}

static void test_format_from_path(void **state)
{
    (void)state;
    static const struct {
        const char *path;
        int format;
    } cases[] = {
        {"a.ppm", LR_FORMAT_PPM},
        {"a.PNG", LR_FORMAT_PNG},
        {"x/y.z/b.Pfm", LR_FORMAT_PFM},
        {"a.exr", LR_FORMAT_EXR},
        {"a.ppm.png", LR_FORMAT_PNG},
        {"a.jpg", -1},
        {"ppm", -1},
        {"", -1},
        {"-", -1},
        {"a.ppm/b", -1},
        {"a.ppm ", -1},
        {"a.pp", -1},
        {"a_png", -1},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        lr_format format = (lr_format)77;
        assert_int_equal(lr_format_from_path(cases[i].path, &format), cases[i].format >= 0);
        assert_int_equal(format, cases[i].format >= 0 ? cases[i].format : 77);
    }
}

/* The expected hashes are from Python's struct and hashlib. */
static void test_hash(void **state)
{
    (void)state;
    char hash[65];
    float pixels[] = {0, 0.5f, 1};
    lr_picture picture = {1, 1, pixels};
    const char *expected = "f54b1316ea8d308564e00aa5d0a3657abf5913da4c9011aebf380868a3980a2a";
    lr_picture_hash(&picture, hash);
    assert_string_equal(hash, expected);
    pixels[0] = -0.0f;
    lr_picture_hash(&picture, hash);
    assert_string_equal(hash, expected);
    pixels[0] = 1e-45f;
    lr_picture_hash(&picture, hash);
    assert_string_not_equal(hash, expected);

    lr_picture large = {40, 30, malloc(40 * 30 * 3 * sizeof(float))};
    for (int i = 0; i < 40 * 30 * 3; i++)
        large.pixels[i] = (float)i / 256;
    lr_picture_hash(&large, hash);
    assert_string_equal(hash, "64012aa30c31c48d4d5c00fb0d04cf3d6e9ec048ac0bef03b152b092568017bc");
    large.width = 30;
    large.height = 40;
    lr_picture_hash(&large, hash);
    assert_string_not_equal(hash,
                            "64012aa30c31c48d4d5c00fb0d04cf3d6e9ec048ac0bef03b152b092568017bc");
    lr_picture_free(&large);
    assert_null(large.pixels);
    lr_picture_free(&large);
    lr_picture_free(NULL);
}

static void test_write_failure(void **state)
{
    (void)state;
    char path[128];
    float pixels[3] = {0};
    lr_picture picture = {1, 1, pixels};
    lr_error error = {0};
    snprintf(path, sizeof path, "%s/none/a.ppm", folder);
    assert_int_equal(lr_picture_write(&picture, path, &(lr_encoding){0}, &error), LR_ERROR_FILE);
    assert_non_null(strstr(error.message, path));
    assert_int_equal(lr_picture_write(&picture, path, &(lr_encoding){.maxval = 70000}, &error),
                     LR_ERROR_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ppm_bytes),
        cmocka_unit_test(test_exposure),
        cmocka_unit_test(test_exp2),
        cmocka_unit_test(test_pfm_bytes),
        cmocka_unit_test(test_png),
        cmocka_unit_test(test_netpbm_reads_ppm),
        cmocka_unit_test(test_netpbm_reads_png),
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_format_from_path),
        cmocka_unit_test(test_hash),
        cmocka_unit_test(test_write_failure),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
