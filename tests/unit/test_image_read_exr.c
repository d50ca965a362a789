/* EXR files made by hand, attribute by attribute and uncompressed, after OpenEXR's description of
 * its file layout. */
#include <math.h>

#include "image_tests.h"

enum { UINT, HALF, FLOAT };

typedef struct window {
    int32_t x0, y0, x1, y1; /* the last pixel is inside */
} window;

typedef struct channel {
    const char *name;
    int32_t type, sampling;
} channel;

typedef struct exr_file {
    channel channels[6]; /* in alphabetical order, ended by one without a name */
    window data, display;
    unsigned char compression;
    uint32_t tile; /* the side of tiles, 0 for scan lines */
    bool part_of_many;
    const char *text; /* of an attribute "note", NULL for none */
} exr_file;

typedef struct file_bytes {
    unsigned char bytes[8192];
    size_t size;
} file_bytes;

static void put(file_bytes *file, const void *bytes, size_t size)
{
    assert_true(file->size + size <= sizeof file->bytes);
    memcpy(file->bytes + file->size, bytes, size);
    file->size += size;
}

static void put_number(file_bytes *file, uint64_t value, size_t size)
{
    for (size_t i = 0; i < size; i++)
        put(file, (unsigned char[]){value >> 8 * i & 255}, 1);
}

static void put_name(file_bytes *file, const char *name)
{
    put(file, name, strlen(name) + 1);
}

static void begin_attribute(file_bytes *file, const char *name, const char *type, size_t size)
{
    put_name(file, name);
    put_name(file, type);
    put_number(file, size, 4);
}

static void put_window(file_bytes *file, const char *name, window w)
{
    begin_attribute(file, name, "box2i", 16);
    put_number(file, (uint32_t)w.x0, 4);
    put_number(file, (uint32_t)w.y0, 4);
    put_number(file, (uint32_t)w.x1, 4);
    put_number(file, (uint32_t)w.y1, 4);
}

static void put_channels(file_bytes *file, const exr_file *exr)
{
    size_t size = 1;
    for (const channel *c = exr->channels; c->name; c++)
        size += strlen(c->name) + 1 + 16;
    begin_attribute(file, "channels", "chlist", size);
    for (const channel *c = exr->channels; c->name; c++) {
        put_name(file, c->name);
        put_number(file, (uint32_t)c->type, 4);
        put_number(file, 0, 4);
        put_number(file, c->sampling ? (uint32_t)c->sampling : 1, 4);
        put_number(file, c->sampling ? (uint32_t)c->sampling : 1, 4);
    }
    put_number(file, 0, 1);
}

static void put_header(file_bytes *file, const exr_file *exr, uint32_t chunks)
{
    float one = 1;
    put_channels(file, exr);
    begin_attribute(file, "compression", "compression", 1);
    put_number(file, exr->compression, 1);
    put_window(file, "dataWindow", exr->data);
    put_window(file, "displayWindow", exr->display);
    begin_attribute(file, "lineOrder", "lineOrder", 1);
    put_number(file, 0, 1);
    begin_attribute(file, "pixelAspectRatio", "float", 4);
    put(file, &one, 4);
    begin_attribute(file, "screenWindowCenter", "v2f", 8);
    put_number(file, 0, 8);
    begin_attribute(file, "screenWindowWidth", "float", 4);
    put(file, &one, 4);
    if (exr->tile) {
        begin_attribute(file, "tiles", "tiledesc", 9);
        put_number(file, exr->tile, 4);
        put_number(file, exr->tile, 4);
        put_number(file, 0, 1);
    }
    if (exr->text) {
        begin_attribute(file, "note", "string", strlen(exr->text));
        put(file, exr->text, strlen(exr->text));
    }
    if (exr->part_of_many) {
        begin_attribute(file, "name", "string", 1);
        put(file, "a", 1);
        const char *type = exr->tile ? "tiledimage" : "scanlineimage";
        begin_attribute(file, "type", "string", strlen(type));
        put(file, type, strlen(type));
        begin_attribute(file, "chunkCount", "int", 4);
        put_number(file, chunks, 4);
    }
    put_number(file, 0, 1);
}

/* What the test expects of a channel at a pixel of the display window. */
static float value_at(const char *name, int32_t x, int32_t y)
{
    const char *dot = strrchr(name, '.');
    int kind = dot ? dot[1] : name[0];
    return (float)(kind % 16 * 100 + (y + 5) * 10 + (x + 5)); /* small enough for exact halves */
}

static uint16_t half_of(float value)
{
    int exponent;
    double mantissa = frexp((double)value, &exponent); /* 0.5 <= mantissa < 1 */
    if (value == 0)
        return 0;
    return (uint16_t)((exponent + 14) << 10 | (int)(mantissa * 2048 - 1024));
}

static bool is_stored(const channel *c, int32_t x, int32_t y)
{
    return c->sampling == 0 || (x % c->sampling == 0 && y % c->sampling == 0);
}

static void put_pixels(file_bytes *file, const exr_file *exr, window w)
{
    for (int32_t y = w.y0; y <= w.y1; y++)
        for (const channel *c = exr->channels; c->name; c++)
            for (int32_t x = w.x0; x <= w.x1; x++) {
                float value = value_at(c->name, x, y);
                if (!is_stored(c, x, y))
                    continue;
                if (c->type == FLOAT)
                    put(file, &value, 4);
                else if (c->type == HALF)
                    put_number(file, half_of(value), 2);
                else
                    put_number(file, (uint32_t)value, 4);
            }
}

static void put_chunk(file_bytes *file, size_t table, int *index, const exr_file *exr, window w)
{
    size_t end = file->size;
    file->size = table + 8 * (size_t)(*index)++;
    put_number(file, end, 8);
    file->size = end;
    if (exr->part_of_many)
        put_number(file, 0, 4);
    if (exr->tile) {
        put_number(file, (uint32_t)(w.x0 - exr->data.x0) / exr->tile, 4);
        put_number(file, (uint32_t)(w.y0 - exr->data.y0) / exr->tile, 4);
        put_number(file, 0, 8); /* the full resolution */
    } else {
        put_number(file, (uint32_t)w.y0, 4);
    }
    size_t start = file->size;
    put_number(file, 0, 4);
    put_pixels(file, exr, w);
    end = file->size;
    file->size = start;
    put_number(file, end - start - 4, 4);
    file->size = end;
}

static file_bytes make(const exr_file *exr)
{
    file_bytes file = {{0}, 0};
    window d = exr->data;
    int32_t step_x = exr->tile ? (int32_t)exr->tile : d.x1 - d.x0 + 1;
    int32_t step_y = exr->tile ? (int32_t)exr->tile : 1;
    uint32_t chunks =
        (uint32_t)((d.x1 - d.x0) / step_x + 1) * (uint32_t)((d.y1 - d.y0) / step_y + 1);
    put(&file, "\x76\x2f\x31\x01", 4);
    put_number(&file, 2 | (exr->part_of_many ? 0x1000 : exr->tile ? 0x200 : 0), 4);
    put_header(&file, exr, chunks);
    if (exr->part_of_many)
        put_number(&file, 0, 1);
    size_t table = file.size;
    int index = 0;
    for (uint32_t i = 0; i < chunks; i++)
        put_number(&file, 0, 8);
    for (int32_t y = d.y0; y <= d.y1; y += step_y)
        for (int32_t x = d.x0; x <= d.x1; x += step_x) {
            window w = {x, y, x + step_x - 1, y + step_y - 1};
            w.x1 = w.x1 < d.x1 ? w.x1 : d.x1;
            w.y1 = w.y1 < d.y1 ? w.y1 : d.y1;
            put_chunk(&file, table, &index, exr, w);
        }
    return file;
}

/* The picture must hold these channels, 0 outside the data window. */
static void expect(const exr_file *exr, const char *const *names, uint32_t count)
{
    file_bytes file = make(exr);
    float samples[1024];
    size_t used = 0;
    for (int32_t y = exr->display.y0; y <= exr->display.y1; y++)
        for (int32_t x = exr->display.x0; x <= exr->display.x1; x++)
            for (uint32_t i = 0; i < count; i++) {
                bool inside = x >= exr->data.x0 && x <= exr->data.x1 && y >= exr->data.y0 &&
                              y <= exr->data.y1;
                samples[used++] = inside ? value_at(names[i], x, y) : 0;
            }
    expect_image(file.bytes, file.size, (uint32_t)(exr->display.x1 - exr->display.x0 + 1),
                 (uint32_t)(exr->display.y1 - exr->display.y0 + 1), count, 0, samples);
}

#define EXPECT(exr, ...)                                                                           \
    expect(exr, (const char *const[]){__VA_ARGS__},                                                \
           sizeof((const char *const[]){__VA_ARGS__}) / sizeof(const char *))
#define SMALL                                                                                      \
    {0, 0, 2, 1},                                                                                  \
    {                                                                                              \
        0, 0, 2, 1                                                                                 \
    }
#define RGB .channels = {{"B", HALF, 0}, {"G", HALF, 0}, {"R", HALF, 0}}

static void test_channels(void **state)
{
    (void)state;
    EXPECT((&(exr_file){RGB, SMALL}), "R", "G", "B");
    EXPECT((&(exr_file){.channels = {{"B", FLOAT, 0}, {"G", UINT, 0}, {"R", HALF, 0}}, SMALL}), "R",
           "G", "B");
    EXPECT((&(exr_file){
               .channels = {{"A", HALF, 0}, {"B", FLOAT, 0}, {"G", FLOAT, 0}, {"R", FLOAT, 0}},
               SMALL}),
           "R", "G", "B", "A");
    EXPECT((&(exr_file){.channels = {{"Y", FLOAT, 0}}, SMALL}), "Y");
    EXPECT((&(exr_file){.channels = {{"A", HALF, 0}, {"Y", HALF, 0}}, SMALL}), "Y", "A");
    EXPECT((&(exr_file){.channels = {{"Y", UINT, 0}, {"Z", FLOAT, 0}}, SMALL}), "Y");
    /* Channels beside the picture's own are left out, the default layer goes before others. */
    EXPECT((&(exr_file){.channels = {{"B", HALF, 0},
                                     {"G", HALF, 0},
                                     {"R", HALF, 0},
                                     {"Z", FLOAT, 0},
                                     {"variance.G", FLOAT, 0}},
                        SMALL}),
           "R", "G", "B");
    EXPECT(
        (&(exr_file){.channels = {{"B", HALF, 0}, {"G", HALF, 0}, {"R", HALF, 0}, {"Z", HALF, 0}},
                     SMALL}),
        "R", "G", "B");
    EXPECT((&(exr_file){.channels = {{"Y", HALF, 0}, {"a.x", HALF, 0}, {"a.y", HALF, 0}}, SMALL}),
           "Y");
    EXPECT(
        (&(exr_file){.channels = {{"B", HALF, 0}, {"G", HALF, 0}, {"R", HALF, 0}, {"Z", HALF, 2}},
                     .data = {0, 0, 5, 3},
                     .display = {0, 0, 5, 3}}),
        "R", "G", "B");
    EXPECT((&(exr_file){
               .channels = {{"A", FLOAT, 2}, {"R.B", UINT, 0}, {"R.G", HALF, 0}, {"R.R", FLOAT, 0}},
               .data = {0, 0, 5, 3},
               .display = {0, 0, 5, 3}}),
           "R.R", "R.G", "R.B");
    EXPECT((&(exr_file){.channels = {{"a.b.B", HALF, 0},
                                     {"a.b.G", HALF, 0},
                                     {"a.b.R", FLOAT, 0},
                                     {"c.Y", HALF, 0}},
                        SMALL}),
           "a.b.R", "a.b.G", "a.b.B");
    EXPECT((&(exr_file){.channels = {{"a.X", HALF, 0}, {"c.A", HALF, 0}, {"c.Y", HALF, 0}}, SMALL}),
           "c.Y", "c.A");
}

static void test_windows(void **state)
{
    (void)state;
    for (uint32_t tile = 0; tile < 4; tile++) {
        EXPECT((&(exr_file){RGB, .data = {0, 0, 4, 3}, .display = {0, 0, 4, 3}, .tile = tile}), "R",
               "G", "B");
        EXPECT((&(exr_file){RGB, .data = {-3, -2, 1, 2}, .display = {-3, -2, 1, 2}, .tile = tile}),
               "R", "G", "B");
        /* Data around, inside, across and beside what is displayed. */
        EXPECT((&(exr_file){RGB, .data = {-3, -3, 5, 5}, .display = {0, 0, 2, 1}, .tile = tile}),
               "R", "G", "B");
        EXPECT((&(exr_file){RGB, .data = {1, 1, 2, 2}, .display = {0, 0, 5, 4}, .tile = tile}), "R",
               "G", "B");
        EXPECT((&(exr_file){RGB, .data = {2, -2, 7, 1}, .display = {0, 0, 4, 4}, .tile = tile}),
               "R", "G", "B");
        EXPECT((&(exr_file){RGB, .data = {-4, 2, 1, 7}, .display = {0, 0, 4, 4}, .tile = tile}),
               "R", "G", "B");
        EXPECT((&(exr_file){RGB, .data = {6, 0, 8, 2}, .display = {0, 0, 4, 4}, .tile = tile}), "R",
               "G", "B");
        EXPECT((&(exr_file){RGB, .data = {0, -4, 2, -1}, .display = {0, 0, 4, 4}, .tile = tile}),
               "R", "G", "B");
        EXPECT((&(exr_file){RGB, .data = {0, 0, 4, 3}, .display = {0, 0, 4, 3}, .tile = tile,
                            .part_of_many = true}),
               "R", "G", "B");
    }
}

static void test_texts(void **state)
{
    (void)state;
    file_bytes file = make(&(exr_file){RGB, SMALL, .text = "some text"});
    lr_image image = decode_bytes(file.bytes, file.size);
    assert_int_equal(image.text_count, 1);
    assert_string_equal(lr_image_find_text(&image, "note"), "some text");
    lr_image_free(&image);
}

static void refuse(const exr_file *exr, const char *words)
{
    file_bytes file = make(exr);
    expect_failure(file.bytes, file.size, words);
}

static void test_refusals(void **state)
{
    (void)state;
    for (int many = 0; many < 2; many++)
        for (uint32_t tile = 0; tile < 3; tile += 2) {
            file_bytes file = make(&(exr_file){RGB, SMALL, .tile = tile, .part_of_many = many});
            expect_truncations(file.bytes, file.size, 4);
            expect_failure(file.bytes, file.size - 1, ", in row ");
        }
    refuse(&(exr_file){.channels = {{"G", HALF, 0}, {"R", HALF, 0}}, SMALL},
           "has no channels that make a picture: neither R, G and B nor Y");
    refuse(&(exr_file){.channels = {{"a.B", HALF, 0}, {"b.G", HALF, 0}, {"c.R", HALF, 0}}, SMALL},
           "has no channels");
    refuse(&(exr_file){.channels = {{"BY", HALF, 0}, {"RY", HALF, 0}, {"Y", HALF, 0}}, SMALL},
           "holds luminance and chroma");
    refuse(&(exr_file){.channels = {{"Y", HALF, 2}}, .data = {0, 0, 3, 3}, .display = {0, 0, 3, 3}},
           "subsampled");
    for (unsigned char compression = 6; compression <= 9; compression++)
        refuse(&(exr_file){RGB, SMALL, .compression = compression},
               "B44 or DWA, which are not read");
    refuse(&(exr_file){RGB, SMALL, .compression = 99}, "Invalid value 99");
    refuse(&(exr_file){RGB, .data = {0, 0, 2, 1}, .display = {0, 0, 99999, 99999}},
           "too large: 100000 x 100000 pixels");
    refuse(&(exr_file){RGB, .data = {0, 0, 2, 1}, .display = {0, 0, -1, 3}}, "");
    refuse(&(exr_file){RGB, .data = {0, 0, 2, 1}, .display = {INT32_MIN, 0, INT32_MAX, 3}}, "");

    /* Data windows that the file cannot fill: the last number of dataWindow is made large. */
    file_bytes file = make(&(exr_file){RGB, SMALL});
    for (size_t at = 0; at < file.size - 10; at++)
        if (memcmp(file.bytes + at, "dataWindow", 10) == 0) {
            file.bytes[at + 17 + 4 + 12 + 2] = 0x50; /* y1 is 1 + 0x500000 */
            expect_failure(file.bytes, file.size, "truncated: ");
            file.bytes[at + 17 + 4 + 8 + 2] = 0x50;
            expect_failure(file.bytes, file.size, "too large: 5242883 x 5242882 pixels");
            break;
        }
}

/* Files with any one byte changed read as something or are refused. */
static void test_damage(void **state)
{
    (void)state;
    for (uint32_t tile = 0; tile < 3; tile += 2) {
        file_bytes file = make(&(exr_file){RGB, SMALL, .tile = tile, .text = "x"});
        for (size_t at = 4; at < file.size; at++)
            for (int change = 1; change < 256; change += 50) {
                file_bytes copy = file;
                copy.bytes[at] = (unsigned char)(copy.bytes[at] + change);
                lr_image image;
                lr_error error = {0};
                lr_status status = lr_image_decode(copy.bytes, copy.size, "file", &image, &error);
                assert_true(status == LR_OK || error.message[0]);
                lr_image_free(&image);
            }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_channels), cmocka_unit_test(test_windows),
        cmocka_unit_test(test_texts),    cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_damage),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
