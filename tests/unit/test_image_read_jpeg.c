/* JPEG files, as netpbm's pnmtojpeg wrote them. */
#include <math.h>

#include "image_tests.h"

#include "base/file.h"

#define CORPUS SOURCE_DIR "/tests/fuzz/corpus/jpeg/"

static char *load(const char *name, size_t *size)
{
    char path[256], *bytes;
    snprintf(path, sizeof path, "%s%s", CORPUS, name);
    assert_int_equal(lr_file_read(path, 1 << 20, &bytes, size, NULL), LR_OK);
    return bytes;
}

static const char *const names[] = {"baseline.jpg", "full-sampling.jpg", "grey-restarts.jpg",
                                    "progressive.jpg"};

/* The pictures were made of red 13 x, green 19 y, blue 3 x y, modulo 256, and lost some of that. */
static void test_kinds(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        size_t size;
        char *bytes = load(names[i], &size);
        lr_image image = decode_bytes((unsigned char *)bytes, size);
        bool grey = strstr(names[i], "grey") != NULL;
        assert_int_equal(image.width, 19);
        assert_int_equal(image.height, 13);
        assert_int_equal(image.maxval, 255);
        assert_int_equal(image.channels, grey ? 1 : 3);
        double error = 0;
        for (int at = 0; at < 19 * 13; at++) {
            int x = at % 19, y = at / 19;
            double red = 13 * x % 256, green = 19 * y % 256, blue = 3 * x * y % 256;
            double expected = grey ? 0.299 * red + 0.587 * green + 0.114 * blue : green;
            error += fabs(image.samples[grey ? at : 3 * at + 1] * 255.0 - expected);
        }
        if (!(error / (19 * 13) < 8))
            fail_msg("%s: %g levels from the picture", names[i], error / (19 * 13));
        lr_image_free(&image);
        expect_truncations((unsigned char *)bytes, size, 3);
        free(bytes);
    }
}

static void test_refusals(void **state)
{
    (void)state;
    expect_failure(BYTES("\xff\xd8\xff\xe0\x00\x01\xff\xd9"), "has a length of 1");
    expect_failure(BYTES("\xff\xd8\xff\xd9"), "corrupt: ");
    expect_failure(BYTES("\xff\xd8\xff\xc0\x00\x0b\x08\xff\xff\xff\xff\x01\x01\x11\x00\xff\xd9"),
                   "too large: 65535 x 65535");
    /* 17 codes of 15 and 240 of 16 bits: more than a byte can tell apart. */
    expect_failure(BYTES("\xff\xd8\xff\xc4\x00\x13\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00"
                         "\x00\x00\x00\x00\x11\xf0\xff\xd9"),
                   "has 257 codes");
    expect_failure(BYTES("\xff\xd8\xff\xc4\x00\x13\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00\x00"
                         "\x00\x00\x00\x00\x00\x01\xff\xd9"),
                   "cut short");
    /* Passes over the pixels beyond any that an encoder writes. */
    size_t size;
    char *bytes = load("progressive.jpg", &size);
    unsigned char *many = malloc(size + 200 * 10);
    memcpy(many, bytes, size - 2);
    for (int i = 0; i < 200; i++)
        memcpy(many + size - 2 + 10 * i, "\xff\xda\x00\x08\x01\x01\x00\x01\x3f\x00", 10);
    memcpy(many + size - 2 + 2000, "\xff\xd9", 2);
    expect_failure(many, size + 2000, "more than 100 passes");
    free(many);
    free(bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_kinds),
                                       cmocka_unit_test(test_refusals)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
