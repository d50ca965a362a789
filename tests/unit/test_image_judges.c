/* Files that other programs wrote: netpbm, and ImageMagick where it is installed. */
#define _GNU_SOURCE
#include <math.h>
#include <unistd.h>

#include "image_tests.h"
#include "temporary_folder.h"

#include "base/file.h"

enum { WIDTH = 37, HEIGHT = 23, COUNT = 3 * WIDTH * HEIGHT };

static uint32_t numbers[COUNT]; /* the samples of the picture, 0..maxval */

/* Writes in.ppm with random samples, as text that needs no reader or writer of ours. */
static void write_picture(uint32_t maxval)
{
    char path[128], *text = malloc(64 + 8 * COUNT);
    size_t size = (size_t)sprintf(text, "P3\n%d %d\n%u\n", WIDTH, HEIGHT, maxval);
    uint32_t seed = maxval;
    for (int i = 0; i < COUNT; i++) {
        seed = seed * 747796405u + 2891336453u;
        numbers[i] = (uint32_t)((uint64_t)seed * (maxval + 1) >> 32);
        size += (size_t)sprintf(text + size, "%u\n", numbers[i]);
    }
    snprintf(path, sizeof path, "%s/in.ppm", folder);
    assert_int_equal(lr_file_write(path, text, size, NULL), LR_OK);
    free(text);
}

/* Runs the command in the folder and reads the file that it makes there. */
static lr_image made_by(const char *command, const char *name)
{
    char line[256], path[128];
    lr_image image;
    lr_error error = {0};
    snprintf(line, sizeof line, "cd %s && { %s; } 2>/dev/null", folder, command);
    if (system(line) != 0)
        fail_msg("fails: %s", command);
    snprintf(path, sizeof path, "%s/%s", folder, name);
    if (lr_image_read(path, &image, &error) != LR_OK)
        fail_msg("%s", error.message);
    assert_int_equal(image.width, WIDTH);
    assert_int_equal(image.height, HEIGHT);
    return image;
}

static void expect_integers(const char *command, const char *name, uint32_t maxval)
{
    lr_image image = made_by(command, name);
    assert_int_equal(image.channels, 3);
    assert_int_equal(image.maxval, maxval);
    for (int i = 0; i < COUNT; i++)
        if (image.samples[i] != (float)numbers[i] / (float)maxval)
            fail_msg("%s: sample %d is %.9g, not %u of %u", command, i, (double)image.samples[i],
                     numbers[i], maxval);
    lr_image_free(&image);
}

static bool installed(const char *program)
{
    char command[64];
    snprintf(command, sizeof command, "command -v %s >/dev/null 2>&1", program);
    if (system(command) == 0)
        return true;
    print_message("%s is not installed\n", program);
    return false;
}

static void test_netpbm(void **state)
{
    (void)state;
    if (!installed("pnmtopnm") || !installed("pamtopng") || !installed("pamtopfm"))
        skip();
    static const uint32_t maxvals[] = {1, 3, 100, 255, 256, 1000, 65535};
    for (size_t i = 0; i < sizeof maxvals / sizeof *maxvals; i++) {
        write_picture(maxvals[i]);
        expect_integers("true", "in.ppm", maxvals[i]);
        expect_integers("pnmtopnm in.ppm > raw.ppm", "raw.ppm", maxvals[i]);
        expect_integers("pnmtoplainpnm raw.ppm > plain.ppm", "plain.ppm", maxvals[i]);
        if (maxvals[i] != 255 && maxvals[i] != 65535)
            continue;
        expect_integers("pamtopng in.ppm > a.png", "a.png", maxvals[i]);
        expect_integers("pnmtopng -interlace -gamma 0.3 in.ppm > b.png", "b.png", maxvals[i]);
    }
}

/* The two decoders round and smooth the colours differently, so the picture has soft ones. */
static void test_netpbm_jpeg(void **state)
{
    (void)state;
    if (!installed("pnmtojpeg") || !installed("jpegtopnm") || !installed("pamscale"))
        skip();
    static const char *const options[] = {"", "-progressive", "-restart 2", "-greyscale",
                                          "-sample 1x1 -quality 95"};
    write_picture(255);
    for (size_t i = 0; i < sizeof options / sizeof *options; i++) {
        char command[256];
        snprintf(command, sizeof command,
                 "pamcut -width 5 -height 4 in.ppm | pamscale -linear -width %d -height %d | "
                 "pnmtojpeg %s > a.jpg && jpegtopnm a.jpg > b.pnm",
                 WIDTH, HEIGHT, options[i]);
        lr_image ours = made_by(command, "a.jpg"), theirs = made_by("true", "b.pnm");
        assert_int_equal(ours.channels, theirs.channels);
        double most = 0, sum = 0;
        uint32_t count = ours.channels * WIDTH * HEIGHT;
        for (uint32_t k = 0; k < count; k++) {
            double error = fabs((double)ours.samples[k] - (double)theirs.samples[k]) * 255;
            most = fmax(most, error);
            sum += error;
        }
        if (!(most <= 12 && sum / count <= 1))
            fail_msg("pnmtojpeg %s: %g levels apart, %g on average", options[i], most, sum / count);
        lr_image_free(&ours);
        lr_image_free(&theirs);
    }
}

static void test_netpbm_grey_and_bitmap(void **state)
{
    (void)state;
    if (!installed("ppmtopgm") || !installed("pgmtopbm") || !installed("pnmtopng"))
        skip();
    write_picture(255);
    lr_image grey = made_by("ppmtopgm in.ppm > a.pgm", "a.pgm");
    lr_image plain = made_by("pnmtoplainpnm a.pgm > b.pgm", "b.pgm");
    lr_image png = made_by("pnmtopng a.pgm > a.png", "a.png");
    assert_int_equal(grey.channels, 1);
    assert_int_equal(png.channels, 1);
    assert_memory_equal(grey.samples, plain.samples, WIDTH * HEIGHT * sizeof(float));
    assert_memory_equal(grey.samples, png.samples, WIDTH * HEIGHT * sizeof(float));

    lr_image bitmap = made_by("pgmtopbm -threshold a.pgm > a.pbm", "a.pbm");
    lr_image bitmap_plain = made_by("pnmtoplainpnm a.pbm > b.pbm", "b.pbm");
    lr_image bitmap_png = made_by("pnmtopng a.pbm > b.png", "b.png");
    assert_int_equal(bitmap.maxval, 1);
    assert_int_equal(bitmap_png.maxval, 1);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        assert_true(bitmap.samples[i] == (grey.samples[i] >= 0.5f));
        assert_true(bitmap_plain.samples[i] == bitmap.samples[i]);
        assert_true(bitmap_png.samples[i] == bitmap.samples[i]);
    }
    lr_image *all[] = {&grey, &plain, &png, &bitmap, &bitmap_plain, &bitmap_png};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        lr_image_free(all[i]);
}

static void test_netpbm_pfm(void **state)
{
    (void)state;
    if (!installed("pamtopfm"))
        skip();
    write_picture(65535);
    static const char *const commands[] = {
        "pamtopfm -endian=little in.ppm > a.pfm",
        "pamtopfm -endian=big in.ppm > a.pfm",
        "pamtopfm -scale=3.5 in.ppm > a.pfm",
    };
    for (int k = 0; k < 3; k++) {
        lr_image image = made_by(commands[k], "a.pfm");
        assert_int_equal(image.channels, 3);
        assert_int_equal(image.maxval, 0);
        float white = k == 2 ? 3.5f : 1; /* netpbm's scale is what white is */
        for (int i = 0; i < COUNT; i++)
            if (fabsf(image.samples[i] - (float)numbers[i] / 65535 * white) > 1e-6f)
                fail_msg("%s: sample %d is %.9g, not %.9g", commands[k], i,
                         (double)image.samples[i], (double)white * numbers[i] / 65535);
        lr_image_free(&image);
    }
}

/* One exponent for three mantissas of 8 bits: the error is below 1/128 of the largest. */
static void test_imagemagick(void **state)
{
    (void)state;
    if (!installed("convert"))
        skip();
    write_picture(65535);
    lr_image image = made_by("convert in.ppm -set colorspace RGB a.hdr", "a.hdr");
    for (int i = 0; i < COUNT; i += 3) {
        float largest = 0;
        for (int k = 0; k < 3; k++)
            largest = fmaxf(largest, (float)numbers[i + k] / 65535);
        for (int k = 0; k < 3; k++)
            if (fabsf(image.samples[i + k] - (float)numbers[i + k] / 65535) > largest / 128)
                fail_msg("sample %d is %.9g, not %.9g", i + k, (double)image.samples[i + k],
                         (double)numbers[i + k] / 65535);
    }
    lr_image_free(&image);
    expect_integers("convert in.ppm -interlace PNG PNG48:c.png", "c.png", 65535);
    write_picture(255);
    expect_integers("convert in.ppm -depth 8 d.png", "d.png", 255);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_netpbm),
        cmocka_unit_test(test_netpbm_jpeg),
        cmocka_unit_test(test_netpbm_grey_and_bitmap),
        cmocka_unit_test(test_netpbm_pfm),
        cmocka_unit_test(test_imagemagick),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
