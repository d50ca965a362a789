/* Textures from picture files, and the paths to them. */
#define _GNU_SOURCE
#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "temporary_folder.h"

#include "base/file.h"
#include "scene/path.h"
#include "scene/texture.h"

#define CORPUS SOURCE_DIR "/tests/fuzz/corpus/"

/* ---- Files --------------------------------------------------------------------------------- */

typedef struct memory_file {
    unsigned char bytes[4096];
    size_t size;
} memory_file;

static void append(png_structp png, png_bytep bytes, size_t size)
{
    memory_file *file = png_get_io_ptr(png);
    assert_true(file->size + size <= sizeof file->bytes);
    memcpy(file->bytes + file->size, bytes, size);
    file->size += size;
}

/* rows: width * height texels of the colour type's samples, those of 16 bits big-endian. */
static memory_file make_png(uint32_t width, uint32_t height, int bits, int type,
                            const unsigned char *rows)
{
    memory_file file = {.size = 0};
    int channels = type == PNG_COLOR_TYPE_RGB_ALPHA    ? 4
                   : type == PNG_COLOR_TYPE_RGB        ? 3
                   : type == PNG_COLOR_TYPE_GRAY_ALPHA ? 2
                                                       : 1;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(png, &file, append, NULL);
    png_set_IHDR(png, info, width, height, bits, type, PNG_INTERLACE_NONE, 0, 0);
    png_write_info(png, info);
    for (uint32_t y = 0; y < height; y++)
        png_write_row(png, rows + y * width * (uint32_t)(channels * bits / 8));
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return file;
}

static void save(const char *name, const void *bytes, size_t size, char path[128])
{
    snprintf(path, 128, "%s/%s", folder, name);
    assert_int_equal(lr_file_write(path, bytes, size, NULL), LR_OK);
}

/* ---- Textures ------------------------------------------------------------------------------ */

static lr_scene_builder new_builder(void)
{
    return (lr_scene_builder){.scene = calloc(1, sizeof(lr_scene))};
}

static const lr_texture *decode(lr_scene_builder *builder, const void *bytes, size_t size)
{
    uint32_t index = 77, before = builder->scene->texture_count;
    lr_error error = {0};
    if (lr_texture_decode(builder, bytes, size, "a picture", LR_WRAP_CLAMP, LR_WRAP_MIRROR,
                          LR_TEXELS_COLORS, &index, &error))
        fail_msg("%s", error.message);
    assert_int_equal(index, before);
    assert_int_equal(builder->scene->texture_count, before + 1);
    const lr_texture *texture = &builder->scene->textures[index];
    assert_string_equal(texture->name, "a picture");
    assert_int_equal(texture->wrap_u, LR_WRAP_CLAMP);
    assert_int_equal(texture->wrap_v, LR_WRAP_MIRROR);
    assert_true(!texture->bytes != !texture->floats);
    return texture;
}

static void expect_bytes(lr_scene_builder *builder, const memory_file *file, uint32_t width,
                         uint32_t height, const uint8_t *texels)
{
    const lr_texture *texture = decode(builder, file->bytes, file->size);
    assert_int_equal(texture->width, width);
    assert_int_equal(texture->height, height);
    assert_non_null(texture->bytes);
    assert_memory_equal(texture->bytes, texels, 4 * width * height);
}

static void test_png(void **state)
{
    (void)state;
    lr_scene_builder builder = new_builder();
    memory_file file;
    file = make_png(1, 1, 8, PNG_COLOR_TYPE_RGB, (unsigned char[]){1, 200, 255});
    expect_bytes(&builder, &file, 1, 1, (uint8_t[]){1, 200, 255, 255});
    file = make_png(3, 1, 8, PNG_COLOR_TYPE_RGB_ALPHA,
                    (unsigned char[]){9, 8, 7, 0, 255, 0, 1, 128, 3, 2, 1, 255});
    expect_bytes(&builder, &file, 3, 1, (uint8_t[]){9, 8, 7, 0, 255, 0, 1, 128, 3, 2, 1, 255});
    file = make_png(1, 3, 8, PNG_COLOR_TYPE_GRAY_ALPHA, (unsigned char[]){9, 1, 0, 2, 255, 3});
    expect_bytes(&builder, &file, 1, 3, (uint8_t[]){9, 9, 9, 1, 0, 0, 0, 2, 255, 255, 255, 3});
    /* 16 bits are rounded: 257 k is k, and the limit lies 128.5 above it. */
    file = make_png(2, 2, 16, PNG_COLOR_TYPE_GRAY,
                    (unsigned char[]){0, 128, 0, 129, 0x81, 0x01, 0xff, 0x7f});
    expect_bytes(&builder, &file, 2, 2,
                 (uint8_t[]){0, 0, 0, 255, 1, 1, 1, 255, 129, 129, 129, 255, 255, 255, 255, 255});
    file = make_png(1, 1, 16, PNG_COLOR_TYPE_RGB_ALPHA,
                    (unsigned char[]){0x80, 0x80, 0x81, 0x01, 0x81, 0x00, 0x01, 0x82});
    expect_bytes(&builder, &file, 1, 1, (uint8_t[]){128, 129, 128, 2});
    assert_int_equal(builder.scene->note_count, 0);
    lr_scene_destroy(builder.scene);
}

/* All 16-bit values against the definition. */
static void test_rounding(void **state)
{
    (void)state;
    enum { HEADER = 64 };
    lr_scene_builder builder = new_builder();
    unsigned char *pgm = malloc(HEADER + 2 * 65536);
    size_t size = (size_t)sprintf((char *)pgm, "P5 256 256 65535\n");
    for (uint32_t i = 0; i < 65536; i++) {
        pgm[size++] = (unsigned char)(i >> 8);
        pgm[size++] = (unsigned char)i;
    }
    const lr_texture *texture = decode(&builder, pgm, size);
    for (uint32_t i = 0; i < 65536; i++)
        assert_int_equal(texture->bytes[4 * i], (int)floor(i / 257.0 + 0.5));
    free(pgm);
    lr_scene_destroy(builder.scene);
}

static void test_floats(void **state)
{
    (void)state;
    lr_scene_builder builder = new_builder();
    float values[6] = {0.25f, -0.0f, 7e11f, -1, NAN, INFINITY};
    unsigned char pfm[64];
    size_t size = (size_t)sprintf((char *)pfm, "PF\n2 1\n-1.0\n");
    memcpy(pfm + size, values, sizeof values);
    const lr_texture *texture = decode(&builder, pfm, size + sizeof values);
    const float expected[6] = {0.25f, 0, 7e11f, 0, 0, 1e12f};
    assert_memory_equal(texture->floats, expected, sizeof expected);
    assert_int_equal(builder.scene->note_count, 1);
    assert_non_null(strstr(builder.scene->notes[0], "a picture: 3 of its values"));

    uint32_t index;
    lr_error error = {0};
    if (lr_texture_load(&builder, CORPUS "hdr/pixels.hdr", LR_WRAP_REPEAT, LR_WRAP_REPEAT,
                        LR_TEXELS_COLORS, &index, &error))
        fail_msg("%s", error.message);
    assert_non_null(builder.scene->textures[index].floats);
    if (lr_texture_load(&builder, CORPUS "exr/alpha.exr", LR_WRAP_REPEAT, LR_WRAP_REPEAT,
                        LR_TEXELS_COLORS, &index, &error))
        fail_msg("%s", error.message);
    assert_non_null(builder.scene->textures[index].floats);
    assert_non_null(strstr(builder.scene->notes[builder.scene->note_count - 1], "alpha"));
    lr_scene_destroy(builder.scene);
}

static void test_same_texture(void **state)
{
    (void)state;
    lr_scene_builder builder = new_builder();
    char path[128], other[128];
    memory_file file = make_png(1, 1, 8, PNG_COLOR_TYPE_GRAY, (unsigned char[]){5});
    save("a.png", file.bytes, file.size, path);
    save("b.png", file.bytes, file.size, other);
    const struct {
        const char *path;
        lr_wrap u, v;
        uint32_t index;
    } loads[] = {
        {path, LR_WRAP_REPEAT, LR_WRAP_REPEAT, 0}, {other, LR_WRAP_REPEAT, LR_WRAP_REPEAT, 1},
        {path, LR_WRAP_REPEAT, LR_WRAP_REPEAT, 0}, {path, LR_WRAP_CLAMP, LR_WRAP_REPEAT, 2},
        {path, LR_WRAP_REPEAT, LR_WRAP_CLAMP, 3},  {path, LR_WRAP_CLAMP, LR_WRAP_REPEAT, 2}};
    for (size_t i = 0; i < sizeof loads / sizeof *loads; i++) {
        uint32_t index = 77;
        assert_int_equal(lr_texture_load(&builder, loads[i].path, loads[i].u, loads[i].v,
                                         LR_TEXELS_COLORS, &index, NULL),
                         LR_OK);
        assert_int_equal(index, loads[i].index);
    }
    assert_int_equal(builder.scene->texture_count, 4);
    lr_scene_destroy(builder.scene);
}

static void expect_refused(const char *path, const char *words)
{
    lr_scene_builder builder = new_builder();
    lr_error error = {0};
    uint32_t index;
    lr_status status = lr_texture_load(&builder, path, LR_WRAP_REPEAT, LR_WRAP_REPEAT,
                                       LR_TEXELS_COLORS, &index, &error);
    assert_int_equal(status, LR_ERROR_FILE);
    if (!strstr(error.message, words) || strncmp(error.message, path, strlen(path)) != 0)
        fail_msg("expected \"%s\", got \"%s\"", words, error.message);
    assert_int_equal(builder.scene->texture_count, 0);
    lr_scene_destroy(builder.scene);
}

static void test_refusals(void **state)
{
    (void)state;
    char path[128];
    memory_file file = make_png(2, 2, 8, PNG_COLOR_TYPE_GRAY, (unsigned char[]){5, 6, 7, 8});
    save("cut.png", file.bytes, file.size - 20, path);
    expect_refused(path, "truncated: the file ends after");
    save("none.png", "", 0, path);
    expect_refused(path, "empty");
    save("words.png", "not a picture", 13, path);
    expect_refused(path, "not a picture in a known format");
    expect_refused("/tmp/lavaray-no-such-file.png", "No such file");
    size_t size = 16385;
    char *wide = calloc(size + 32, 1);
    int header = sprintf(wide, "P5 %zu 1 255\n", size);
    save("wide.pgm", wide, (size_t)header + size, path);
    expect_refused(path, "at most 16384 along a side");
    free(wide);
}

/* The limit of a scene counts what is there already. */
static void test_total(void **state)
{
    (void)state;
    lr_scene_builder builder = new_builder();
    for (int i = 0; i < 2; i++) {
        lr_texture *large = lr_scene_add_texture(&builder);
        large->width = 16384;
        large->height = i ? 8191 : 8192;
    }
    memory_file file = make_png(2, 1, 8, PNG_COLOR_TYPE_GRAY, (unsigned char[]){5, 6});
    decode(&builder, file.bytes, file.size);
    builder.scene->textures[1].height++;
    lr_error error = {0};
    uint32_t index;
    assert_int_equal(lr_texture_decode(&builder, file.bytes, file.size, "last", LR_WRAP_REPEAT,
                                       LR_WRAP_REPEAT, LR_TEXELS_COLORS, &index, &error),
                     LR_ERROR_FILE);
    assert_non_null(strstr(error.message, "last: with it the scene has over 268435456 texels"));
    lr_scene_destroy(builder.scene);
}

/* ---- Paths --------------------------------------------------------------------------------- */

static void expect_path(const char *base, const char *relative, bool allow, const char *expected,
                        const char *words)
{
    char *path;
    lr_error error = {0};
    lr_load_options options = {.allow_path = allow};
    lr_status status = lr_path_resolve(base, relative, &options, &path, &error);
    if (expected) {
        if (status)
            fail_msg("%s: %s", relative, error.message);
        assert_string_equal(path, expected);
    } else {
        assert_int_equal(status, LR_ERROR_FILE);
        assert_null(path);
        if (!strstr(error.message, words))
            fail_msg("%s: expected \"%s\", got \"%s\"", relative, words, error.message);
    }
    free(path);
}

static void test_paths(void **state)
{
    (void)state;
    char base[128], path[128], inner[128], link[128];
    snprintf(path, sizeof path, "%s/scene", folder);
    assert_int_equal(mkdir(path, 0700), 0);
    snprintf(path, sizeof path, "%s/scene/sub", folder);
    assert_int_equal(mkdir(path, 0700), 0);
    snprintf(path, sizeof path, "%s/scenery", folder); /* the folder's name begins its own */
    assert_int_equal(mkdir(path, 0700), 0);
    snprintf(base, sizeof base, "%s/scene/s.yaml", folder);
    save("scene/sub/a.png", "a", 1, inner);
    save("scenery/b.png", "b", 1, path);
    save("c.png", "c", 1, path);
    snprintf(link, sizeof link, "%s/scene/link.png", folder);
    assert_int_equal(symlink(path, link), 0);
    snprintf(link, sizeof link, "%s/scene/inner.png", folder);
    assert_int_equal(symlink(inner, link), 0);
    snprintf(link, sizeof link, "%s/scene/pipe", folder);
    assert_int_equal(mkfifo(link, 0600), 0);

    expect_path(base, "sub/a.png", false, inner, NULL);
    expect_path(base, "sub/missing.png", false, NULL, "No such file");
    expect_path(base, "sub", false, NULL, "is not a regular file");
    expect_path(base, "pipe", false, NULL, "is not a regular file");
    expect_path(base, "", false, NULL, "empty");
    snprintf(link, sizeof link, "%s/scene/inner.png", folder);
    expect_path(base, "inner.png", false, link, NULL);
    snprintf(link, sizeof link, "%s/scene/sub/../sub/a.png", folder);
    expect_path(base, "sub/../sub/a.png", false, link, NULL);

    const char *outside[] = {"../c.png", "link.png", "../scenery/b.png"};
    for (size_t i = 0; i < sizeof outside / sizeof *outside; i++) {
        expect_path(base, outside[i], false, NULL, "allow it with --allow-path");
        snprintf(link, sizeof link, "%s/scene/%s", folder, outside[i]);
        expect_path(base, outside[i], true, link, NULL);
    }
    expect_path(base, path, false, NULL, "is an absolute path");
    expect_path(base, path, true, path, NULL);

    assert_int_equal(chdir(folder), 0);
    expect_path("s.yaml", "c.png", false, "c.png", NULL);
    expect_path("<stdin>", "c.png", false, "c.png", NULL);
    expect_path("scene/s.yaml", "../c.png", false, NULL, "outside of the folder of scene/s.yaml");
    assert_int_equal(chdir("/"), 0);
    expect_path("s.yaml", path + 1, false, path + 1, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_png),      cmocka_unit_test(test_rounding),
        cmocka_unit_test(test_floats),   cmocka_unit_test(test_same_texture),
        cmocka_unit_test(test_refusals), cmocka_unit_test(test_total),
        cmocka_unit_test(test_paths),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
