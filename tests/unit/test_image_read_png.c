/* PNG files made by hand, chunk by chunk. */
#include <zlib.h>

#include "image_tests.h"

typedef struct file_bytes {
    unsigned char bytes[1024];
    size_t size;
} file_bytes;

static void put(file_bytes *file, const void *bytes, size_t size)
{
    assert_true(file->size + size <= sizeof file->bytes);
    memcpy(file->bytes + file->size, bytes, size);
    file->size += size;
}

static void put_number(file_bytes *file, uint32_t value)
{
    put(file, (unsigned char[]){value >> 24, value >> 16 & 255, value >> 8 & 255, value & 255}, 4);
}

static void put_chunk(file_bytes *file, const char *type, const void *bytes, size_t size)
{
    put_number(file, (uint32_t)size);
    size_t start = file->size;
    put(file, type, 4);
    put(file, bytes, size);
    put_number(file, (uint32_t)crc32(0, file->bytes + start, (uInt)(size + 4)));
}

typedef struct png_file {
    uint32_t width, height;
    unsigned char bits, type, interlaced;
    const char *chunk_type, *chunk; /* one more in front of the pixels, type NULL for none */
    size_t chunk_size;
} png_file;

static file_bytes make(const png_file *png, const void *rows, size_t size)
{
    file_bytes file = {{0}, 0};
    unsigned char packed[512] = {0};
    uLongf packed_size = sizeof packed;
    put(&file, "\x89PNG\r\n\x1a\n", 8);
    unsigned char header[13] = {png->width >> 24,
                                png->width >> 16 & 255,
                                png->width >> 8 & 255,
                                png->width & 255,
                                png->height >> 24,
                                png->height >> 16 & 255,
                                png->height >> 8 & 255,
                                png->height & 255,
                                png->bits,
                                png->type,
                                0,
                                0,
                                png->interlaced};
    put_chunk(&file, "IHDR", header, sizeof header);
    if (png->type == 3)
        put_chunk(&file, "PLTE", "\x00\x00\x00\xff\x00\x00\x33\x66\x99\x01\x02\x03", 12);
    if (png->chunk_type)
        put_chunk(&file, png->chunk_type, png->chunk, png->chunk_size);
    assert_int_equal(compress(packed, &packed_size, rows, size), Z_OK);
    put_chunk(&file, "IDAT", packed, packed_size);
    put_chunk(&file, "IEND", "", 0);
    return file;
}

#define ROWS(text) (text), sizeof(text) - 1
#define CHUNK(type, text) .chunk_type = (type), .chunk = (text), .chunk_size = sizeof(text) - 1

static void expect(const png_file *png, const void *rows, size_t size, uint32_t channels,
                   uint32_t maxval, const float *samples)
{
    file_bytes file = make(png, rows, size);
    expect_image(file.bytes, file.size, png->width, png->height, channels, maxval, samples);
    expect_truncations(file.bytes, file.size, 8);
}

static void test_kinds(void **state)
{
    (void)state;
    expect(&(png_file){3, 2, .bits = 1}, ROWS("\0\xa0\0\x40"), 1, 1, (float[]){1, 0, 1, 0, 1, 0});
    expect(&(png_file){5, 1, .bits = 2}, ROWS("\0\x1b\xc0"), 1, 3,
           (float[]){0, 1 / 3.0f, 2 / 3.0f, 1, 1});
    expect(&(png_file){2, 1, .bits = 4}, ROWS("\0\x1f"), 1, 15, (float[]){1 / 15.0f, 1});
    expect(&(png_file){2, 1, .bits = 8}, ROWS("\0\x33\xff"), 1, 255, (float[]){0.2f, 1});
    expect(&(png_file){1, 2, .bits = 16}, ROWS("\0\x12\x34\0\xff\xff"), 1, 65535,
           (float[]){0x1234 / 65535.0f, 1});
    expect(&(png_file){1, 1, .bits = 8, .type = 2}, ROWS("\0\x33\x66\x99"), 3, 255,
           (float[]){0.2f, 0.4f, 0.6f});
    expect(&(png_file){1, 1, .bits = 16, .type = 2}, ROWS("\0\0\1\0\2\0\3"), 3, 65535,
           (float[]){1 / 65535.0f, 2 / 65535.0f, 3 / 65535.0f});
    expect(&(png_file){1, 1, .bits = 8, .type = 4}, ROWS("\0\x33\x66"), 2, 255,
           (float[]){0.2f, 0.4f});
    expect(&(png_file){1, 1, .bits = 8, .type = 6}, ROWS("\0\x33\x66\x99\xcc"), 4, 255,
           (float[]){0.2f, 0.4f, 0.6f, 0.8f});
    expect(&(png_file){3, 1, .bits = 2, .type = 3}, ROWS("\0\x60"), 3, 255,
           (float[]){1, 0, 0, 0.2f, 0.4f, 0.6f, 0, 0, 0});
    /* A row predicted from the one above (filter 2). */
    expect(&(png_file){2, 2, .bits = 8}, ROWS("\0\x11\x22\2\x22\x11"), 1, 255,
           (float[]){0x11 / 255.0f, 0x22 / 255.0f, 0.2f, 0.2f});
}

static void test_transparency(void **state)
{
    (void)state;
    expect(&(png_file){3, 1, .bits = 2, .type = 3, CHUNK("tRNS", "\xff\x33")}, ROWS("\0\x60"), 4,
           255, (float[]){1, 0, 0, 0.2f, 0.2f, 0.4f, 0.6f, 1, 0, 0, 0, 1});
    expect(&(png_file){2, 1, .bits = 4, CHUNK("tRNS", "\0\x0f")}, ROWS("\0\x1f"), 2, 15,
           (float[]){1 / 15.0f, 1, 1, 0});
    expect(&(png_file){2, 1, .bits = 8, .type = 2, CHUNK("tRNS", "\0\1\0\2\0\3")},
           ROWS("\0\1\2\3\1\2\4"), 4, 255,
           (float[]){1 / 255.0f, 2 / 255.0f, 3 / 255.0f, 0, 1 / 255.0f, 2 / 255.0f, 4 / 255.0f, 1});
}

/* Adam7: of 3 x 3 pixels pass 1 has (0,0); 4 (2,0); 5 row 2 of 0 and 2; 6 column 1 of rows 0 and 2;
 * 7 row 1. */
static void test_interlaced(void **state)
{
    (void)state;
    expect(&(png_file){3, 3, .bits = 8, .interlaced = 1},
           ROWS("\0\x00"
                "\0\x33"
                "\0\x66\x99"
                "\0\xcc\0\xff"
                "\0\x01\x02\x03"),
           1, 255, (float[]){0, 0.8f, 0.2f, 1 / 255.0f, 2 / 255.0f, 3 / 255.0f, 0.4f, 1, 0.6f});
}

static void test_chunks(void **state)
{
    (void)state;
    /* What says how to show the samples does not change them. */
    static const float two[] = {0.2f, 1};
    expect(&(png_file){2, 1, .bits = 8, CHUNK("gAMA", "\0\1\x86\xa0")}, ROWS("\0\x33\xff"), 1, 255,
           two);
    expect(&(png_file){2, 1, .bits = 8, CHUNK("sRGB", "\0")}, ROWS("\0\x33\xff"), 1, 255, two);
    expect(&(png_file){2, 1, .bits = 8, CHUNK("sBIT", "\4")}, ROWS("\0\x33\xff"), 1, 255, two);
    expect(&(png_file){2, 1, .bits = 8, CHUNK("bKGD", "\0\4")}, ROWS("\0\x33\xff"), 1, 255, two);

    file_bytes file =
        make(&(png_file){2, 1, .bits = 8, CHUNK("tEXt", "Title\0some text")}, ROWS("\0\x33\xff"));
    lr_image image = decode_bytes(file.bytes, file.size);
    assert_int_equal(image.text_count, 1);
    assert_string_equal(lr_image_find_text(&image, "Title"), "some text");
    lr_image_free(&image);
    file = make(&(png_file){2, 1, .bits = 8, CHUNK("iTXt", "key\0\0\0de\0Wort\0Gr\xc3\xbcn")},
                ROWS("\0\x33\xff"));
    image = decode_bytes(file.bytes, file.size);
    assert_string_equal(lr_image_find_text(&image, "key"), "Gr\xc3\xbcn");
    lr_image_free(&image);
}

static void refuse(const png_file *png, const void *rows, size_t size, const char *words)
{
    file_bytes file = make(png, rows, size);
    expect_failure(file.bytes, file.size, words);
}

static void test_refusals(void **state)
{
    (void)state;
    refuse(&(png_file){0, 1, .bits = 8}, ROWS("\0"), "Image width is zero");
    refuse(&(png_file){1, 0, .bits = 8}, ROWS("\0"), "Image height is zero");
    refuse(&(png_file){1, 1, .bits = 3}, ROWS("\0\0"), "corrupt: ");
    refuse(&(png_file){1, 1, .bits = 8, .type = 5}, ROWS("\0\0"), "corrupt: ");
    refuse(&(png_file){99999, 99999, .bits = 8}, ROWS("\0\0"), "too large: 99999 x 99999 pixels");
    refuse(&(png_file){0x7fffffff, 0x7fffffff, .bits = 16, .type = 6}, ROWS("\0\0"), "");
    refuse(&(png_file){9000, 9000, .bits = 1}, ROWS("\0\0"), "corrupt: "); /* too few pixels */
    refuse(&(png_file){1, 2, .bits = 8}, ROWS("\0\0"), "corrupt: ");
    refuse(&(png_file){1, 1, .bits = 8}, ROWS("\7\0"), "corrupt: "); /* an unknown filter */
    refuse(&(png_file){1, 1, .bits = 8, CHUNK("XXXX", "?")}, ROWS("\0\0"), "unhandled critical");

    /* Any bit of the pixels or the header turned is noticed. */
    file_bytes file = make(&(png_file){2, 1, .bits = 8}, ROWS("\0\x33\xff"));
    for (size_t at = 8; at < file.size; at++) {
        file_bytes copy = file;
        copy.bytes[at] ^= 4;
        expect_failure(copy.bytes, copy.size, "");
    }
    /* A chunk that claims more than there is allocates nothing. */
    file.bytes[8 + 25] = 0x7f;
    expect_failure(file.bytes, file.size,
                   "the file ends after 68 bytes, the chunk at "
                   "33 needs ");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_kinds),      cmocka_unit_test(test_transparency),
        cmocka_unit_test(test_interlaced), cmocka_unit_test(test_chunks),
        cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
