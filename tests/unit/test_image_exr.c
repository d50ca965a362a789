/* EXR files: what the writer makes is read back and judged by OpenEXR's own tools. */
#define _GNU_SOURCE
#include <math.h>
#include <unistd.h>

#include "image_tests.h"
#include "temporary_folder.h"

#include "image/image_internal.h"

static uint32_t random_bits(uint32_t *seed)
{
    *seed = *seed * 747796405u + 2891336453u;
    return (*seed >> 22 ^ *seed) >> 3 ^ *seed << 13;
}

/* Any bits at all, so also infinities, NaN and subnormals. */
static lr_picture random_picture(uint32_t width, uint32_t height, uint32_t *seed)
{
    lr_picture picture = {width, height, malloc(3 * sizeof(float) * width * height)};
    for (size_t i = 0; i < 3 * (size_t)width * height; i++) {
        uint32_t bits = random_bits(seed);
        memcpy(&picture.pixels[i], &bits, sizeof bits);
    }
    return picture;
}

static unsigned char *encode(const lr_picture *picture, const lr_encoding *encoding, size_t *size)
{
    unsigned char *bytes;
    lr_error error = {0};
    if (lr_picture_encode(picture, encoding, &bytes, size, &error) != LR_OK)
        fail_msg("%s", error.message);
    return bytes;
}

static lr_image read_back(const lr_picture *picture, const lr_encoding *encoding)
{
    size_t size;
    unsigned char *bytes = encode(picture, encoding, &size);
    lr_image image = decode_bytes(bytes, size);
    free(bytes);
    assert_int_equal(image.width, picture->width);
    assert_int_equal(image.height, picture->height);
    assert_int_equal(image.channels, 3);
    return image;
}

static void test_floats_come_back(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {{1, 1}, {1, 16}, {7, 17}, {300, 1}, {129, 65}};
    uint32_t seed = 1;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        for (int exposure = -2; exposure <= 2; exposure += 2) {
            lr_picture picture = random_picture(sizes[i][0], sizes[i][1], &seed);
            size_t count = 3 * (size_t)picture.width * picture.height;
            /* A NaN's bits are those of the pixel only without exposure. */
            for (size_t k = 0; k < count && exposure != 0; k++)
                if (isnan(picture.pixels[k]))
                    picture.pixels[k] = 0.5f;
            lr_encoding exr = {.format = LR_FORMAT_EXR, .exposure = (float)exposure};
            lr_encoding pfm = {.format = LR_FORMAT_PFM, .exposure = (float)exposure};
            lr_image a = read_back(&picture, &exr), b = read_back(&picture, &pfm);
            assert_int_equal(a.maxval, 0);
            assert_memory_equal(a.samples, b.samples, count * sizeof(float));
            if (exposure == 0)
                assert_memory_equal(a.samples, picture.pixels, count * sizeof(float));
            lr_image_free(&a);
            lr_image_free(&b);
            lr_picture_free(&picture);
        }
}

/* Random pictures with ever more black in them: some compress to just the size that they have
 * uncompressed. */
static void test_incompressible(void **state)
{
    (void)state;
    uint32_t seed = 7;
    for (uint32_t i = 0; i < 4000; i++) {
        lr_picture picture = random_picture(4 + i % 61, 1, &seed);
        size_t size = 12 * (size_t)picture.width;
        memset(picture.pixels, 0, random_bits(&seed) % size);
        lr_image image = read_back(&picture, &(lr_encoding){.format = LR_FORMAT_EXR});
        assert_memory_equal(image.samples, picture.pixels, size);
        lr_image_free(&image);
        lr_picture_free(&picture);
    }
}

static double half_value(uint32_t bits)
{
    int exponent = (int)(bits >> 10 & 31);
    double mantissa = bits & 1023;
    double value = exponent ? ldexp(1024 + mantissa, exponent - 25) : ldexp(mantissa, -24);
    return bits & 0x8000 ? -value : value;
}

static void test_half(void **state)
{
    (void)state;
    for (uint32_t bits = 0; bits < 0x7bff; bits++) {
        double low = half_value(bits), high = half_value(bits + 1);
        float middle = (float)((low + high) / 2); /* exact: one bit more than a half */
        uint32_t even = bits + (bits & 1);
        assert_int_equal(image_half((float)low), bits);
        assert_int_equal(image_half((float)-low), bits | 0x8000);
        assert_int_equal(image_half(middle), even);
        assert_int_equal(image_half(-middle), even | 0x8000);
        assert_int_equal(image_half(nextafterf(middle, 0)), bits);
        assert_int_equal(image_half(nextafterf(middle, INFINITY)), bits + 1);
    }
    static const float large[] = {65504, 65519, 65520, 65536, 1e10f, 3.4e38f};
    for (size_t i = 0; i < sizeof large / sizeof *large; i++) {
        assert_int_equal(image_half(large[i]), 0x7bff);
        assert_int_equal(image_half(-large[i]), 0xfbff);
    }
    assert_int_equal(image_half(INFINITY), 0x7c00);
    assert_int_equal(image_half(-INFINITY), 0xfc00);
    assert_int_equal(image_half(NAN) & 0x7e00, 0x7e00);
    assert_int_equal(image_half(1e-30f), 0);
    assert_int_equal(image_half(-0.0f), 0x8000);
}

static void test_halves_come_back(void **state)
{
    (void)state;
    uint32_t seed = 3;
    lr_picture picture = random_picture(61, 47, &seed);
    lr_image image = read_back(&picture, &(lr_encoding){.format = LR_FORMAT_EXR, .half = true});
    for (size_t i = 0; i < 3 * 61 * 47; i++) {
        uint16_t half = image_half(picture.pixels[i]);
        if (isnan(picture.pixels[i]))
            assert_true(isnan(image.samples[i]));
        else if (isinf(picture.pixels[i]))
            assert_true(image.samples[i] == picture.pixels[i]);
        else
            assert_true(image.samples[i] == half_value(half));
    }
    lr_image_free(&image);
    lr_picture_free(&picture);
}

static void test_texts(void **state)
{
    (void)state;
    float pixels[3] = {0};
    lr_picture picture = {1, 1, pixels};
    static const lr_text texts[] = {{"lavaray:version", "0.1.0"},
                                    {"settings", "{\"a\": 1,\n \"b\": 2}"},
                                    {"name2", "Grün ∞"},
                                    {"e", ""}};
    for (int format = LR_FORMAT_PPM; format <= LR_FORMAT_EXR; format++) {
        lr_image image = read_back(
            &picture, &(lr_encoding){.format = (lr_format)format, .texts = texts, .text_count = 4});
        bool carries = format == LR_FORMAT_PNG || format == LR_FORMAT_EXR;
        assert_int_equal(image.text_count, carries ? 4 : 0);
        for (int i = 0; i < 4 && carries; i++)
            assert_string_equal(lr_image_find_text(&image, texts[i].key), texts[i].value);
        lr_image_free(&image);
    }
    static const char *const bad[] = {
        "", "a b", "ä", "a\n", "12345678901234567890123456789012", "channels", "type"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        lr_text text = {bad[i], "x"};
        unsigned char *bytes;
        size_t size;
        lr_error error = {0};
        lr_encoding encoding = {.format = LR_FORMAT_EXR, .texts = &text, .text_count = 1};
        assert_int_equal(lr_picture_encode(&picture, &encoding, &bytes, &size, &error),
                         LR_ERROR_ARGUMENT);
        assert_null(bytes);
        assert_true(error.message[0]);
    }
}

static void test_same_bytes(void **state)
{
    (void)state;
    uint32_t seed = 5;
    lr_picture picture = random_picture(50, 40, &seed);
    size_t sizes[2];
    unsigned char *files[2];
    for (int i = 0; i < 2; i++)
        files[i] = encode(&picture, &(lr_encoding){.format = LR_FORMAT_EXR}, &sizes[i]);
    assert_int_equal(sizes[0], sizes[1]);
    assert_memory_equal(files[0], files[1], sizes[0]);
    free(files[0]);
    free(files[1]);
    lr_picture_free(&picture);
}

static void test_truncations(void **state)
{
    (void)state;
    uint32_t seed = 6;
    lr_picture picture = random_picture(9, 33, &seed);
    size_t size;
    unsigned char *bytes = encode(&picture, &(lr_encoding){.format = LR_FORMAT_EXR}, &size);
    expect_truncations(bytes, size, 4);
    free(bytes);
    lr_picture_free(&picture);
}

/* exrheader prints what OpenEXR's C++ library understands, exrmaketiled reads every pixel. */
static void test_openexr_reads_it(void **state)
{
    (void)state;
    if (system("command -v exrheader >/dev/null 2>&1 && command -v exrmaketiled >/dev/null 2>&1")) {
        print_message("openexr is not installed\n");
        skip();
    }
    uint32_t seed = 9;
    lr_picture picture = random_picture(70, 50, &seed);
    for (size_t i = 0; i < 3 * 70 * 50; i++)
        picture.pixels[i] = (float)(random_bits(&seed) >> 8) / 65536;
    char path[128], tiled[128], command[1024];
    snprintf(path, sizeof path, "%s/a.exr", folder);
    snprintf(tiled, sizeof tiled, "%s/tiled.exr", folder);
    for (int half = 0; half < 2; half++) {
        lr_text text = {"scene", "some scene"};
        lr_encoding encoding = {
            .format = LR_FORMAT_EXR, .half = half, .texts = &text, .text_count = 1};
        assert_int_equal(lr_picture_write(&picture, path, &encoding, NULL), LR_OK);
        snprintf(command, sizeof command,
                 "exrheader %s | grep -A 3 '^channels' | grep -c ', %d-bit floating-point, "
                 "sampling 1 1' | grep -qx 3 && exrheader %s | grep -q '^scene .*\"some scene\"' "
                 "&& exrmaketiled -t 16 16 -z none %s %s",
                 path, half ? 16 : 32, path, path, tiled);
        assert_int_equal(system(command), 0);
        lr_image a, b;
        assert_int_equal(lr_image_read(path, &a, NULL), LR_OK);
        assert_int_equal(lr_image_read(tiled, &b, NULL), LR_OK);
        assert_string_equal(lr_image_find_text(&b, "scene"), "some scene");
        assert_memory_equal(a.samples, b.samples, 3 * 70 * 50 * sizeof(float));
        lr_image_free(&a);
        lr_image_free(&b);
    }
    lr_picture_free(&picture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_floats_come_back),
        cmocka_unit_test(test_incompressible),
        cmocka_unit_test(test_half),
        cmocka_unit_test(test_halves_come_back),
        cmocka_unit_test(test_texts),
        cmocka_unit_test(test_same_bytes),
        cmocka_unit_test(test_truncations),
        cmocka_unit_test(test_openexr_reads_it),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
