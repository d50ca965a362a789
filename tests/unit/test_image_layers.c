/* EXR files with layers: every channel comes back, read by OpenEXR's C library without our reader.
 */
#define _GNU_SOURCE
#include <OpenEXR/openexr.h>
#include <unistd.h>

#include "image_tests.h"
#include "temporary_folder.h"

#include "image/image_internal.h"

enum { WIDTH = 37, HEIGHT = 41, PIXELS = WIDTH * HEIGHT }; /* three chunks, the last cut off */

static float colors[3 * PIXELS], normals[3 * PIXELS], depths[PIXELS], direct[3 * PIXELS];
static uint32_t ids[PIXELS], pairs[2 * PIXELS];

static void fill_samples(void)
{
    uint32_t seed = 3;
    for (int i = 0; i < 3 * PIXELS; i++) {
        seed = seed * 747796405u + 2891336453u;
        colors[i] = (float)(seed >> 8) / 65536;
        normals[i] = (float)(seed >> 7 & 0xFFFF) / 32768 - 1;
        direct[i] = colors[i] / 2;
        depths[i % PIXELS] = (float)i / 7;
        ids[i % PIXELS] = seed;
        pairs[i % (2 * PIXELS)] = ~seed;
    }
}

static const lr_layer layers[] = {
    {"normal", "XYZ", normals, false, false},
    {"depth", "Z", depths, false, false},
    {"id", "", ids, true, false},
    {"direct", "RGB", direct, false, true},
    {"Albedo", "RGB", normals, false, false},
    {"pair", "ba", pairs, true, false},
};
enum { LAYERS = sizeof layers / sizeof *layers };

static const char *write_layers(lr_encoding encoding)
{
    static char path[128];
    snprintf(path, sizeof path, "%s/layers.exr", folder);
    lr_picture picture = {WIDTH, HEIGHT, colors};
    lr_error error = {0};
    encoding.format = LR_FORMAT_EXR;
    if (lr_picture_write(&picture, path, &encoding, &error) != LR_OK)
        fail_msg("%s", error.message);
    return path;
}

#define OK(call) assert_int_equal((call), EXR_ERR_SUCCESS)

/* The 32-bit samples of a channel; the caller frees them. */
static void *read_channel(const char *path, const char *name, exr_pixel_type_t type)
{
    unsigned char *samples = calloc(PIXELS, 4);
    exr_context_t file;
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    int32_t lines;
    bool found = false;
    OK(exr_start_read(&file, path, &setup));
    OK(exr_get_scanlines_per_chunk(file, 0, &lines));
    for (int y = 0; y < HEIGHT; y += lines) {
        exr_chunk_info_t chunk;
        exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
        OK(exr_read_scanline_chunk_info(file, 0, y, &chunk));
        OK(exr_decoding_initialize(file, 0, &chunk, &pipeline));
        for (int i = 0; i < pipeline.channel_count; i++) {
            exr_coding_channel_info_t *channel = &pipeline.channels[i];
            if (strcmp(channel->channel_name, name) != 0)
                continue;
            assert_int_equal(channel->data_type, type);
            found = true;
            channel->decode_to_ptr = samples + 4 * (size_t)y * WIDTH;
            channel->user_bytes_per_element = 4;
            channel->user_pixel_stride = 4;
            channel->user_line_stride = 4 * WIDTH;
        }
        OK(exr_decoding_choose_default_routines(file, 0, &pipeline));
        OK(exr_decoding_run(file, 0, &pipeline));
        OK(exr_decoding_destroy(file, &pipeline));
    }
    OK(exr_finish(&file));
    if (!found)
        fail_msg("no channel %s", name);
    return samples;
}

/* samples[component + stride * i] must be the channel's. */
static void expect_channel(const char *path, const char *name, exr_pixel_type_t type,
                           const void *samples, size_t stride, size_t component)
{
    const uint32_t *want = samples;
    uint32_t *have = read_channel(path, name, type);
    for (size_t i = 0; i < PIXELS; i++)
        if (have[i] != want[stride * i + component])
            fail_msg("%s: pixel %zu has the bits %08x, not %08x", name, i, have[i],
                     want[stride * i + component]);
    free(have);
}

static void test_all_channels(void **state)
{
    (void)state;
    const char *path = write_layers((lr_encoding){.layers = layers, .layer_count = LAYERS});
    for (int i = 0; i < 3; i++) {
        char name[16];
        snprintf(name, sizeof name, "%c", "RGB"[i]);
        expect_channel(path, name, EXR_PIXEL_FLOAT, colors, 3, i);
        snprintf(name, sizeof name, "direct.%c", "RGB"[i]);
        expect_channel(path, name, EXR_PIXEL_FLOAT, direct, 3, i);
        snprintf(name, sizeof name, "normal.%c", "XYZ"[i]);
        expect_channel(path, name, EXR_PIXEL_FLOAT, normals, 3, i);
        snprintf(name, sizeof name, "Albedo.%c", "RGB"[i]);
        expect_channel(path, name, EXR_PIXEL_FLOAT, normals, 3, i);
    }
    expect_channel(path, "depth.Z", EXR_PIXEL_FLOAT, depths, 1, 0);
    expect_channel(path, "id", EXR_PIXEL_UINT, ids, 1, 0);
    expect_channel(path, "pair.b", EXR_PIXEL_UINT, pairs, 2, 0);
    expect_channel(path, "pair.a", EXR_PIXEL_UINT, pairs, 2, 1);
}

/* Layers of light follow the picture's exposure and white balance, others stay; the picture may
 * have 16 bits. */
static void test_light(void **state)
{
    (void)state;
    static float expected[3 * PIXELS];
    lr_transform balance = image_white_balance(3200);
    for (int i = 0; i < 3 * PIXELS; i += 3) {
        lr_vec3 v = {direct[i] * 4.0, direct[i + 1] * 4.0, direct[i + 2] * 4.0};
        v = lr_transform_vector(&balance, v);
        expected[i] = (float)v.x;
        expected[i + 1] = (float)v.y;
        expected[i + 2] = (float)v.z;
    }
    for (int half = 0; half < 2; half++) {
        const char *path = write_layers((lr_encoding){
            .half = half, .exposure = 2, .white = 3200, .layers = layers, .layer_count = LAYERS});
        expect_channel(path, "direct.G", EXR_PIXEL_FLOAT, expected, 3, 1);
        expect_channel(path, "Albedo.G", EXR_PIXEL_FLOAT, normals, 3, 1);
        expect_channel(path, "depth.Z", EXR_PIXEL_FLOAT, depths, 1, 0);
    }
}

/* The picture is the same with layers beside it as without. */
static void test_reader(void **state)
{
    (void)state;
    for (int half = 0; half < 2; half++) {
        lr_image with, without;
        lr_encoding encoding = {.half = half, .layers = layers, .layer_count = LAYERS};
        assert_int_equal(lr_image_read(write_layers(encoding), &with, NULL), LR_OK);
        encoding.layer_count = 0;
        assert_int_equal(lr_image_read(write_layers(encoding), &without, NULL), LR_OK);
        assert_int_equal(with.channels, 3);
        assert_memory_equal(with.samples, without.samples, sizeof colors);
        lr_image_free(&with);
        lr_image_free(&without);
    }
}

/* exrheader prints what OpenEXR's C++ library understands, exrmaketiled reads every channel. */
static void test_openexr_reads_it(void **state)
{
    (void)state;
    if (system("command -v exrheader >/dev/null 2>&1 && command -v exrmaketiled >/dev/null 2>&1")) {
        print_message("openexr is not installed\n");
        skip();
    }
    char command[512];
    const char *path = write_layers((lr_encoding){.layers = layers, .layer_count = LAYERS});
    snprintf(command, sizeof command,
             "exrheader %s | grep -c ', 32-bit floating-point, sampling 1 1' | grep -qx 13 && "
             "exrheader %s | grep -c ', 32-bit unsigned integer, sampling 1 1' | grep -qx 3 && "
             "exrmaketiled -t 16 16 %s %s/tiled.exr",
             path, path, path, folder);
    assert_int_equal(system(command), 0);
}

static void expect_refusal(lr_encoding encoding, const char *expected)
{
    lr_picture picture = {WIDTH, HEIGHT, colors};
    unsigned char *bytes;
    size_t size;
    lr_error error = {0};
    assert_int_equal(lr_picture_encode(&picture, &encoding, &bytes, &size, &error),
                     LR_ERROR_ARGUMENT);
    assert_null(bytes);
    if (!strstr(error.message, expected))
        fail_msg("expected \"%s\", got \"%s\"", expected, error.message);
}

static void test_refusals(void **state)
{
    (void)state;
    for (int format = LR_FORMAT_PPM; format < LR_FORMAT_EXR; format++)
        expect_refusal(
            (lr_encoding){.format = (lr_format)format, .layers = layers, .layer_count = 1},
            "only EXR files have layers");
    static const lr_layer wrong[] = {
        {"", "Z", depths, false, false},
        {"Y", "", depths, false, false},
        {"a.b", "Z", depths, false, false},
        {"a b", "Z", depths, false, false},
        {"depth", "ZZ", depths, false, false},
        {"depth", ".", depths, false, false},
        {"direct", "XYZ", direct, false, true},
        {"direct", "RGB", direct, true, true},
        {"ids\xc3", "", ids, true, false},
        {"depth", "Z ", depths, false, false},
        {"a23456789012345678901234567890", "Z", depths, false, false},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        expect_refusal(
            (lr_encoding){.format = LR_FORMAT_EXR, .layers = &wrong[i], .layer_count = 1},
            "is not possible");
    const lr_layer twice[] = {layers[0], layers[1], layers[0]};
    expect_refusal((lr_encoding){.format = LR_FORMAT_EXR, .layers = twice, .layer_count = 3},
                   "a layer 'normal' with channels 'XYZ'");
}

int main(void)
{
    fill_samples();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_all_channels), cmocka_unit_test(test_light),
        cmocka_unit_test(test_reader),       cmocka_unit_test(test_openexr_reads_it),
        cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
