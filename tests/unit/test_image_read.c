/* PNM, PFM and HDR files made by hand, whole, cut short, corrupt and too large. */
#include <math.h>

#include "image_tests.h"

#define EXPECT(text, width, height, channels, maxval, ...)                                         \
    expect_image(BYTES(text), width, height, channels, maxval, (const float[]){__VA_ARGS__})
#define REFUSE(text, words) expect_failure(BYTES(text), words)
#define TRUNCATIONS(text, header) expect_truncations(BYTES(text), header)

static void test_plain_pnm(void **state)
{
    (void)state;
    EXPECT("P2 2 1 10 0 5", 2, 1, 1, 10, 0, 0.5f);
    EXPECT("P2\n1 2\n65535\n65535\n1\n", 1, 2, 1, 65535, 1, 1 / 65535.0f);
    EXPECT("P3\n1 2\n255\n0 51 255\n 1 2 3 ", 1, 2, 3, 255, 0, 51 / 255.0f, 1, 1 / 255.0f,
           2 / 255.0f, 3 / 255.0f);
    /* White space of every kind, comments wherever a token may be, also right behind one. */
    EXPECT("P3#c\r# P3 9 9\n\t1\v\f#\n1#1\r3 0#\n1 # 7 7 7\r\n2 3#", 1, 1, 3, 3, 0, 1 / 3.0f,
           2 / 3.0f);
    EXPECT("P2 000001 1 007 7", 1, 1, 1, 7, 1);
    /* 1 is black in a bitmap; its digits may touch. */
    EXPECT("P1 3 2 101\n0 1#1\n1", 3, 2, 1, 1, 0, 1, 0, 1, 0, 0);
}

static void test_raw_pnm(void **state)
{
    (void)state;
    EXPECT("P5 2 1 255 \x00\xff", 2, 1, 1, 255, 0, 1);
    EXPECT("P5\n2 1\n256\n\x00\x40\x01\x00", 2, 1, 1, 256, 0.25f, 1);
    EXPECT("P6\n1 2\n255\n\x00\x33\xff\x01\x02\x03", 1, 2, 3, 255, 0, 0.2f, 1, 1 / 255.0f,
           2 / 255.0f, 3 / 255.0f);
    EXPECT("P6 1 1 65535\t\x00\x01\xff\xff\x12\x34", 1, 1, 3, 65535, 1 / 65535.0f, 1,
           0x1234 / 65535.0f);
    EXPECT("P5#a\n1# b\r1\n#c\n#d\n1#e\n\x01", 1, 1, 1, 1, 1);
    /* One character of white space ends the header; what follows is the raster. */
    EXPECT("P5 1 1 255\n\n", 1, 1, 1, 255, 10 / 255.0f);
    EXPECT("P5 1 1 255 #", 1, 1, 1, 255, 35 / 255.0f);
    /* The first picture of several. */
    EXPECT("P5 1 1 9 \x03P5 1 1 9 \x09", 1, 1, 1, 9, 3 / 9.0f);
    EXPECT("P4 9 2 \xa0\x80\x00\x7f", 9, 2, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1, 0, 1, 1, 1, 1, 1, 1, 1, 1,
           1);
}

static void test_pnm_refusals(void **state)
{
    (void)state;
    TRUNCATIONS("P6\n2 2\n255\nabcdefghijkl", 3);
    TRUNCATIONS("P5 3 1 65535\nabcdef", 3);
    TRUNCATIONS("P4 9 2 abcd", 3);
    TRUNCATIONS("P3 1 1 100 11 22 3", 3); /* cut within its last number a plain file reads well */
    TRUNCATIONS("P1 2 2 1 0 1 0", 3);
    REFUSE("P6\n2 2\n255\nabcdefghijk", "ends after 22 bytes, 2x2 pixels need 23");
    REFUSE("P3 1 1 255 1 2", "ends after 14 bytes, 1x1 pixels need at least 16");
    REFUSE("P3 1 1 255 1 255  ", "before a sample");
    REFUSE("P5 0 3 255 ", "has no pixels: its size is 0 x 3");
    REFUSE("P5 3 0 255 ", "has no pixels");
    REFUSE("P5 1 1 0 x", "the maximum value is 0; expected 1 to 65535");
    REFUSE("P5 1 1 65536 xx", "the maximum value is above 65535");
    REFUSE("P5 1 1 2 \x03", "corrupt: sample 3 in row 0 is above the maximum 2");
    REFUSE("P6 1 2 258 \1\0\1\0\1\0\1\3\0\0\0\0", "sample 259 in row 1 is above the maximum 258");
    REFUSE("P2 2 1 10 3 11", "sample 11 in row 0 is above the maximum 10");
    REFUSE("P3 -1 1 255 ", "byte 0x2d at 3 in place of the width");
    REFUSE("P3 1x1 255 ", "byte 0x78 at 4 in place of white space");
    REFUSE("P3 1 1 255 1 2 z", "byte 0x7a at 15 in place of a sample");
    REFUSE("P1 1 1 2", "in place of a pixel");
    REFUSE("P5 65536 65536 255 ", "too large: 65536 x 65536 pixels of 1 samples; the limit is "
                                  "268435456 samples");
    REFUSE("P6 4294967295 4294967295 65535 ", "too large: ");
    REFUSE("P6 4294967296 1 65535 ", "the width is above 4294967295");
    REFUSE("P3 99999999999999999999999 1 65535 ", "the width is above");
    REFUSE("P6 9000 9000 255 ", "need 243000017"); /* below the limit: nothing is allocated */
    REFUSE("P3 9000 9000 255 ", "truncated");
}

static void test_pfm(void **state)
{
    (void)state;
    static const char little[] = "PF\n1 2\n-1.0\n"
                                 "\x00\x00\x80\x3f\x00\x00\x00\x40\x00\x00\x40\x40"
                                 "\x00\x00\x00\xbf\x00\x00\x00\x00\x60\x42\xa2\x0d";
    EXPECT(little, 1, 2, 3, 0, -0.5f, 0, 1e-30f, 1, 2, 3);
    EXPECT("Pf 2 1 1 \x3f\x80\x00\x00\xc0\x00\x00\x00", 2, 1, 1, 0, 1, -2);
    EXPECT("Pf\n1 2\n-2.5e-1\n\x00\x00\x80\x3f\x00\x00\x00\x40", 1, 2, 1, 0, 2, 1);
    lr_image image = decode_bytes(BYTES("Pf 2 1 1\n\x7f\xc0\x00\x00\xff\x80\x00\x00"));
    assert_true(isnan(image.samples[0]) && image.samples[1] == -INFINITY);
    lr_image_free(&image);

    TRUNCATIONS(little, 3);
    REFUSE("PF\n1 1\n-1.0\n01234567890", "ends after 23 bytes, 1x1 pixels need 24");
    REFUSE("PF 1 1 0 abcd", "the scale must be a number that is not 0, such as -1.0");
    REFUSE("PF 1 1 -0.0 abcd", "the scale must be");
    REFUSE("PF 1 1 nan abcd", "the scale must be");
    REFUSE("PF 1 1 inf abcd", "the scale must be");
    REFUSE("PF 1 1 1e99 abcd", "the scale must be");
    REFUSE("PF 1 1 1e-99 abcd", "the scale must be");
    REFUSE("PF 1 1 0x1p3 abcd", "the scale must be");
    REFUSE("PF 1 1 1.0.0 abcd", "the scale must be");
    REFUSE("PF 1 1 "
           "1.000000000000000000000000000000000000000000000000000000000000000000000 abcd",
           "the scale must be");
    REFUSE("PF 0 1 -1 ", "has no pixels");
    REFUSE("PF 100000 100000 -1 ", "too large");
    REFUSE("PF 9000 9000 -1 ", "truncated");
}

#define HDR_HEADER "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n"

static void test_hdr_pixels(void **state)
{
    (void)state;
    /* mantissa * 2^(exponent - 136): 128 with exponent 129 is 1. */
    EXPECT(HDR_HEADER "-Y 1 +X 2\n\x80\x40\x00\x81\xff\x01\x80\x00", 2, 1, 3, 0, 1, 0.5f, 0, 0, 0,
           0);
    EXPECT("#?RGBE\n# comment=1\n\n-Y 2 +X 1\n\x80\x80\x80\x80\x01\x02\x03\x88", 1, 2, 3, 0, 0.5f,
           0.5f, 0.5f, 1, 2, 3);
    EXPECT(HDR_HEADER "-Y 1 +X 1\n\x80\x40\x20\x01", 1, 1, 3, 0, 0x1p-128f, 0x1p-129f, 0x1p-130f);
    EXPECT(HDR_HEADER "-Y 1 +X 1\n\xff\x00\x00\xff", 1, 1, 3, 0, 0xffp119f, 0, 0);
    /* Old runs: one pixel and three more of it; then 2 + 256 more. */
    EXPECT(HDR_HEADER "-Y 1 +X 5\n\x02\x00\x00\x88\x01\x01\x01\x03\x05\x00\x00\x88", 5, 1, 3, 0, 2,
           0, 0, 2, 0, 0, 2, 0, 0, 2, 0, 0, 5, 0, 0);
    lr_image image = decode_bytes(
        BYTES(HDR_HEADER "-Y 1 +X 259\n\x07\x00\x00\x88\x01\x01\x01\x02\x01\x01\x01\x01"));
    for (int i = 0; i < 259; i++)
        assert_true(image.samples[3 * i] == 7);
    lr_image_free(&image);
}

/* Eight pixels as planes: a run of red, copied greens, blue as both, one exponent. */
static const char hdr_planes[] = HDR_HEADER "-Y 1 +X 8\n\x02\x02\x00\x08"
                                            "\x88\x09"
                                            "\x08\x01\x02\x03\x04\x05\x06\x07\x08"
                                            "\x83\x03\x01\x04\x84\x05"
                                            "\x88\x88";

static void test_hdr_planes(void **state)
{
    (void)state;
    EXPECT(hdr_planes, 8, 1, 3, 0, 9, 1, 3, 9, 2, 3, 9, 3, 3, 9, 4, 4, 9, 5, 5, 9, 6, 5, 9, 7, 5, 9,
           8, 5);
    lr_image image = decode_bytes(BYTES("#?RADIANCE\nEXPOSURE=2.5\nno text\n=x\nVIEW= -vp 1 2\n\n"
                                        "-Y 1 +X 1\n\x80\x40\x00\x81"));
    assert_int_equal(image.text_count, 2);
    assert_string_equal(lr_image_find_text(&image, "EXPOSURE"), "2.5");
    assert_string_equal(lr_image_find_text(&image, "VIEW"), " -vp 1 2");
    assert_null(lr_image_find_text(&image, "FORMAT"));
    assert_true(image.samples[0] == 1); /* not divided by the exposure */
    lr_image_free(&image);
}

static void test_hdr_refusals(void **state)
{
    (void)state;
    TRUNCATIONS(hdr_planes, 2);
    TRUNCATIONS(HDR_HEADER "-Y 2 +X 1\n\x80\x40\x00\x81\x80\x40\x00\x81", 2);
    TRUNCATIONS(HDR_HEADER "-Y 1 +X 5\n\x02\x00\x00\x88\x01\x01\x01\x03\x05\x00\x00\x88", 2);
    REFUSE(HDR_HEADER "-Y 2 +X 2\n\x80\x40\x00\x81\x80\x40\x00\x81\x80\x40\x00\x81",
           "bytes, in row 1 of 2");
    REFUSE(HDR_HEADER "-Y 9000 +X 9000\n\x80\x40\x00\x81", "rows need at least");
    REFUSE(HDR_HEADER "-Y 1 +X 8\n\x02\x02\x00\x09", "row 0 has 9 pixels, not 8");
    REFUSE(HDR_HEADER "-Y 1 +X 8\n\x02\x02\x00\x08\x89\x01", "a run of 9 pixels in row 0");
    REFUSE(HDR_HEADER "-Y 1 +X 8\n\x02\x02\x00\x08\x00\x01", "a run of 0 pixels in row 0");
    REFUSE(HDR_HEADER "-Y 1 +X 2\n\x01\x01\x01\x01", "a run of pixels that does not fit in row 0");
    REFUSE(HDR_HEADER "-Y 1 +X 2\n\x09\x01\x01\x80\x01\x01\x01\x02", "does not fit in row 0");
    REFUSE(HDR_HEADER "+Y 1 +X 2\n\x01\x01\x01\x01", "expected \"-Y HEIGHT +X WIDTH\"");
    REFUSE(HDR_HEADER "-Y 1 +X\n\x01\x01\x01\x01", "expected \"-Y HEIGHT +X WIDTH\"");
    REFUSE(HDR_HEADER "-Y 1 +X 2 3\n\x01\x01\x01\x01", "expected \"-Y HEIGHT +X WIDTH\"");
    REFUSE(HDR_HEADER "-Y -1 +X 2\n\x01\x01\x01\x01", "corrupt: the size is ");
    REFUSE(HDR_HEADER "-Y 0 +X 2\n", "has no pixels: its size is 2 x 0");
    REFUSE(HDR_HEADER "-Y 99999 +X 99999\n", "too large");
    REFUSE("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\nabcd", "XYZ");
}

static void test_unknown(void **state)
{
    (void)state;
    REFUSE("", "the file is empty");
    static const char *const others[] = {"P",       "P0 1 1",      "P7\nWIDTH 1", "PG 1 1",
                                         "P6x1",    "GIF89a...",   "BM......",    "hello",
                                         "\x89PNG", "\x76\x2f\x31"};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        expect_failure((const unsigned char *)others[i], strlen(others[i]),
                       "not a picture in a known format; PPM, PGM, PBM, PNG, PFM, EXR, HDR");
    lr_image image;
    lr_error error = {0};
    assert_int_equal(lr_image_read("/nonexistent/x.png", &image, &error), LR_ERROR_FILE);
    assert_string_equal(error.message, "/nonexistent/x.png: No such file or directory");
    lr_image_free(&image);
    lr_image_free(NULL);
    assert_int_equal(lr_image_read("/", &image, NULL), LR_ERROR_FILE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_plain_pnm),    cmocka_unit_test(test_raw_pnm),
        cmocka_unit_test(test_pnm_refusals), cmocka_unit_test(test_pfm),
        cmocka_unit_test(test_hdr_pixels),   cmocka_unit_test(test_hdr_planes),
        cmocka_unit_test(test_hdr_refusals), cmocka_unit_test(test_unknown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
