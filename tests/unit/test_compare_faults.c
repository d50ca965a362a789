/* A picture and its faulty variants: what each metric must say at one set of limits, what must be
 * given as the cause, and where. With a folder as argument it writes the pictures there as PPM, and
 * prints the values as the table of docs/compare.md. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "compare/compare.h"
#include "faulty.h"

/* In the order of the verdicts below. */
static const struct {
    const char *name, *limit;
} limits[] = {
    {"exact", NULL},       {"abs", "2/255"},    {"max-abs", "0.1"},
    {"rmse", "0.01"},      {"psnr", "30"},      {"ssim", "0.99"},
    {"flip-mean", "0.02"}, {"flip-p99", "0.1"}, {"flip-max", "0.2"},
};
enum { LIMITS = sizeof limits / sizeof *limits };

/* One letter a limit: F where it must fail. --abs lets 2 % of the pixels pass. */
static const struct {
    const char *verdicts;
    lr_cause cause;
} expected[FAULTY_COUNT] = {
    [FAULTY_NONE] = {".........", LR_CAUSE_NONE},
    [FAULTY_PIXEL] = {"F.F......", LR_CAUSE_LOCAL},
    [FAULTY_BIT] = {"F........", LR_CAUSE_LOCAL},
    [FAULTY_SHIFT] = {"FFFFFFFFF", LR_CAUSE_SHIFT},
    [FAULTY_OFFSET] = {"FFFFFFFFF", LR_CAUSE_SHIFT},
    [FAULTY_SUBPIXEL] = {"FFFF.FFFF", LR_CAUSE_EDGES},
    [FAULTY_BLUR] = {"FFFFFFFFF", LR_CAUSE_BLUR},
    [FAULTY_SHARPEN] = {"FFFF.FFFF", LR_CAUSE_SHARPEN},
    [FAULTY_DARKER] = {"FFFFFFFFF", LR_CAUSE_COLOR},
    [FAULTY_GAMMA] = {"FFFFFFFFF", LR_CAUSE_COLOR},
    [FAULTY_CONTRAST] = {"FF.FFFFFF", LR_CAUSE_COLOR},
    [FAULTY_TINT] = {"FFFFF.FFF", LR_CAUSE_COLOR},
    [FAULTY_CHANNELS] = {"FFFFF.FFF", LR_CAUSE_CHANNELS},
    [FAULTY_MIRROR] = {"FFFFFFFFF", LR_CAUSE_MIRROR},
    [FAULTY_UPSIDE_DOWN] = {"FFFFFFFFF", LR_CAUSE_MIRROR},
    [FAULTY_MISSING] = {"F.FFFF.FF", LR_CAUSE_LOCAL},
    [FAULTY_MOVED] = {"FFFFFFFFF", LR_CAUSE_LOCAL},
    [FAULTY_BRIGHTER] = {"FFFF.FFFF", LR_CAUSE_LOCAL},
    [FAULTY_ROW] = {"F.FFFF.FF", LR_CAUSE_LOCAL},
    [FAULTY_NOISE] = {"FFFF.FFFF", LR_CAUSE_NOISE},
    [FAULTY_SALT] = {"F.FFFFFFF", LR_CAUSE_NOISE},
    [FAULTY_JPEG] = {"FFFF.FFFF", LR_CAUSE_BLOCKS},
    [FAULTY_QUANTISED] = {"FF...FFF.", LR_CAUSE_ROUNDING},
    [FAULTY_TRUNCATED] = {"F.....F..", LR_CAUSE_ROUNDING},
    [FAULTY_ALIASED] = {"FFFF.FFFF", LR_CAUSE_EDGES},
    [FAULTY_ALPHA] = {"FFFFF....", LR_CAUSE_ALPHA},
};

static lr_compare_options all_limits(void)
{
    lr_compare_options options = {.explain = true};
    lr_error error = {0};
    for (int i = 0; i < LIMITS; i++)
        if (lr_compare_set(&options, limits[i].name, limits[i].limit, &error) != LR_OK)
            fail_msg("%s", error.message);
    options.abs_percent = 2;
    return options;
}

static const lr_metric_result *metric(const lr_compare_result *result, const char *name)
{
    for (int i = 0; i < LR_METRIC_COUNT; i++)
        if (strcmp(lr_metric_name((lr_metric)i), name) == 0)
            return &result->metrics[i];
    return NULL;
}

static lr_compare_result compare(faulty_variant variant, const lr_compare_options *options)
{
    lr_image reference = faulty_image(FAULTY_NONE), test = faulty_image(variant);
    lr_compare_result result;
    lr_error error = {0};
    if (lr_compare(&reference, &test, options, &result, &error) != LR_OK)
        fail_msg("%s", error.message);
    lr_image_free(&reference);
    lr_image_free(&test);
    return result;
}

static void test_verdicts(void **state)
{
    (void)state;
    lr_compare_options options = all_limits();
    int wrong = 0;
    for (int v = 0; v < FAULTY_COUNT; v++) {
        lr_compare_result result = compare((faulty_variant)v, &options);
        char verdicts[LIMITS + 1] = "", text[512];
        for (int i = 0; i < LIMITS; i++)
            verdicts[i] = metric(&result, limits[i].name)->pass ? '.' : 'F';
        lr_compare_describe(&result, text, sizeof text);
        if (strcmp(verdicts, expected[v].verdicts) != 0 || result.cause != expected[v].cause) {
            print_error("%s: %s, expected %s; %s\n", faulty_name((faulty_variant)v), verdicts,
                        expected[v].verdicts, text);
            wrong++;
        }
        assert_true(result.pass == (v == FAULTY_NONE));
        assert_true((*text != '\0') == (v != FAULTY_NONE));
        lr_compare_result_free(&result);
    }
    assert_int_equal(wrong, 0);
}

/* The sentence must hold these words. */
static void expect_words(faulty_variant variant, const char *words)
{
    lr_compare_options options = {.explain = true};
    lr_compare_result result = compare(variant, &options);
    char text[512];
    lr_compare_describe(&result, text, sizeof text);
    if (!strstr(text, words))
        fail_msg("%s: \"%s\" says nothing of \"%s\"", faulty_name(variant), text, words);
    lr_compare_result_free(&result);
}

static void test_sentences(void **state)
{
    (void)state;
    expect_words(FAULTY_PIXEL, "One pixel differs, at 121,90.");
    expect_words(FAULTY_SHIFT, "moved by 1 pixel to the right.");
    expect_words(FAULTY_OFFSET, "moved by 9 pixels to the right and 6 pixels up.");
    expect_words(FAULTY_DARKER, "20 % darker");
    expect_words(FAULTY_GAMMA, "to the power of 0.45");
    expect_words(FAULTY_CONTRAST, "contrast: 1.15 times the reference -0.075");
    expect_words(FAULTY_TINT, "times 1.08, 1.00, 0.85");
    expect_words(FAULTY_CHANNELS, "R, G, B are the reference's B, G, R");
    expect_words(FAULTY_MIRROR, "mirrored left to right");
    expect_words(FAULTY_UPSIDE_DOWN, "upside down");
    expect_words(FAULTY_BRIGHTER, "64 x 40 pixels at 150,20");
    expect_words(FAULTY_ROW, "240 x 1 pixels at 0,77");
}

/* The missing ball has its centre at 112,128 and a radius of 13. */
static void test_regions(void **state)
{
    (void)state;
    lr_compare_options options = {.explain = true};
    lr_compare_result result = compare(FAULTY_MISSING, &options);
    assert_int_equal(result.region_count, 1);
    const lr_region *region = &result.regions[0];
    assert_true(region->box.x >= 98 && region->box.x <= 100);
    assert_true(region->box.width >= 25 && region->box.width <= 27);
    assert_true(region->box.y >= 114 && region->box.y <= 116);
    assert_true(fabs(region->center_x - 111.5) < 1 && fabs(region->center_y - 127.5) < 1);
    assert_true(result.max_x == region->worst_x && result.max_y == region->worst_y);
    lr_compare_result_free(&result);

    /* Two pixels that touch by a corner are one region; one that is two away is another. */
    lr_image a = faulty_image(FAULTY_NONE), b = faulty_image(FAULTY_NONE);
    static const uint32_t at[3][2] = {{10, 10}, {11, 11}, {13, 10}};
    for (int i = 0; i < 3; i++)
        b.samples[3 * (at[i][1] * FAULTY_WIDTH + at[i][0])] = i == 2 ? 1.0f : 0.9f;
    lr_error error = {0};
    assert_int_equal(lr_compare(&a, &b, &options, &result, &error), LR_OK);
    assert_int_equal(result.region_count, 2);
    assert_int_equal(result.regions[0].pixels, 2);
    assert_true(result.regions[0].center_x == 10.5 && result.regions[0].center_y == 10.5);
    assert_true(result.regions[1].box.x == 13 && result.regions[1].box.width == 1);
    lr_compare_result_free(&result);

    /* Only pixels beyond the limit count. */
    lr_compare_set(&options, "abs", "0.5", &error);
    assert_int_equal(lr_compare(&a, &b, &options, &result, &error), LR_OK);
    assert_true(result.region_count <= 2);
    lr_compare_result_free(&result);
    lr_image_free(&a);
    lr_image_free(&b);
}

/* Regions that are kept have the largest totals, in order. */
static void test_many_regions(void **state)
{
    (void)state;
    lr_compare_options options = {.explain = true};
    lr_compare_result result = compare(FAULTY_SALT, &options);
    assert_true(result.region_count > 300);
    assert_int_equal(result.regions_kept, LR_REGIONS_MAX);
    for (int i = 1; i < LR_REGIONS_MAX; i++)
        assert_true(result.regions[i - 1].total >= result.regions[i].total);
    lr_compare_result_free(&result);
}

/* Shifts by any small amount and to all sides are found; light works like encoded pictures. */
static void test_shifts(void **state)
{
    (void)state;
    static const int32_t shifts[][2] = {{0, 1}, {-1, 0}, {3, -2}, {-14, 5}, {2, 31}, {-25, -20}};
    static double picture[3 * FAULTY_PIXELS];
    static float samples[2][3 * FAULTY_PIXELS];
    lr_compare_options options = {.explain = true};
    for (size_t i = 0; i < sizeof shifts / sizeof *shifts; i++)
        for (uint32_t maxval = 0; maxval <= 255; maxval += 255) {
            for (int k = 0; k < 2; k++) {
                faulty_scene scene = {
                    .shift_x = k * shifts[i][0], .shift_y = k * shifts[i][1], .samples = 2};
                faulty_draw(&scene, picture);
                for (int s = 0; s < 3 * FAULTY_PIXELS; s++)
                    samples[k][s] = maxval ? (float)floor(picture[s] * 255 + 0.5) / 255
                                           : (float)(4 * picture[s] * picture[s]);
            }
            lr_image a = {.width = FAULTY_WIDTH,
                          .height = FAULTY_HEIGHT,
                          .channels = 3,
                          .maxval = maxval,
                          .samples = samples[0]};
            lr_image b = a;
            b.samples = samples[1];
            lr_compare_result result;
            assert_int_equal(lr_compare(&a, &b, &options, &result, NULL), LR_OK);
            if (result.cause != LR_CAUSE_SHIFT || result.dx != shifts[i][0] ||
                result.dy != shifts[i][1])
                fail_msg("moved by %d, %d: %s by %d, %d", shifts[i][0], shifts[i][1],
                         lr_cause_name(result.cause), result.dx, result.dy);
            lr_compare_result_free(&result);
        }
}

/* An exposure of half a stop in light. */
static void test_exposure(void **state)
{
    (void)state;
    lr_image a = faulty_image(FAULTY_NONE), b = faulty_image(FAULTY_NONE);
    a.maxval = b.maxval = 0;
    for (int i = 0; i < 3 * FAULTY_PIXELS; i++)
        b.samples[i] = a.samples[i] * 1.4142135f;
    lr_compare_options options = {.explain = true};
    lr_compare_result result;
    char text[512];
    assert_int_equal(lr_compare(&a, &b, &options, &result, NULL), LR_OK);
    lr_compare_describe(&result, text, sizeof text);
    assert_string_equal(text, "The whole picture is 41.4 % brighter.");
    lr_compare_result_free(&result);
    lr_image_free(&a);
    lr_image_free(&b);
}

/* Not a known answer, but the same on every compiler and machine, and with any number of threads:
 * FNV-1a of the bits of FLIP's map, encoded and of light. */
static void test_same_everywhere(void **state)
{
    (void)state;
    static const uint64_t hashes[2] = {0x45c759c78e07aeeb, 0xe207eb3cc235f25c};
    lr_compare_options options = {.map = true};
    lr_error error = {0};
    lr_compare_set(&options, "flip-mean", "1", &error);
    lr_image a = faulty_image(FAULTY_NONE), b = faulty_image(FAULTY_NOISE);
    for (int light = 0; light < 2; light++) {
        if (light)
            a.maxval = b.maxval = 0;
        lr_compare_result result;
        assert_int_equal(lr_compare(&a, &b, &options, &result, &error), LR_OK);
        uint64_t hash = 0xcbf29ce484222325u;
        for (int i = 0; i < FAULTY_PIXELS; i++) {
            uint32_t bits;
            memcpy(&bits, &result.map[i], sizeof bits);
            hash = (hash ^ bits) * 0x100000001b3u;
        }
        if (hash != hashes[light])
            fail_msg("map %d is %#llx", light, (unsigned long long)hash);
        lr_compare_result_free(&result);
    }
    lr_image_free(&a);
    lr_image_free(&b);
}

static void test_heat_map(void **state)
{
    (void)state;
    lr_compare_options options = {.explain = true, .map = true};
    lr_compare_result result = compare(FAULTY_PIXEL, &options);
    lr_image reference = faulty_image(FAULTY_NONE);
    lr_picture picture;
    assert_int_equal(lr_compare_heat_map(&reference, &result, &picture, NULL), LR_OK);
    assert_int_equal(picture.width, FAULTY_WIDTH);
    assert_true(picture.height > FAULTY_HEIGHT); /* the scale */
    /* Coloured at the pixel that differs and on its frame, grey elsewhere. */
    int colored = 0;
    for (int i = 0; i < FAULTY_PIXELS; i++)
        colored += picture.pixels[3 * i] != picture.pixels[3 * i + 1];
    assert_int_equal(colored, 1 + 4 * 6);
    assert_true(picture.pixels[3 * (90 * FAULTY_WIDTH + 121)] !=
                picture.pixels[3 * (90 * FAULTY_WIDTH + 121) + 1]);
    lr_picture_free(&picture);
    lr_compare_result_free(&result);
    lr_image_free(&reference);
}

static int write_all(const char *folder)
{
    lr_compare_options options = all_limits();
    printf("| variant | exact | abs | max-abs | rmse | psnr | ssim | flip-mean | flip-p99 | "
           "flip-max | cause |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (int v = 0; v < FAULTY_COUNT; v++) {
        char path[4096];
        lr_image image = faulty_image((faulty_variant)v);
        snprintf(path, sizeof path, "%s/%02d.ppm", folder, v);
        FILE *file = fopen(path, "wb");
        if (!file)
            return 1;
        fprintf(file, "P6\n%d %d\n255\n", FAULTY_WIDTH, FAULTY_HEIGHT);
        for (uint32_t i = 0; i < FAULTY_PIXELS; i++)
            for (uint32_t c = 0; c < 3; c++)
                fputc((int)(image.samples[i * image.channels + c] * 255 + 0.5f), file);
        if (fclose(file) != 0)
            return 1;
        lr_image_free(&image);
        lr_compare_result result = compare((faulty_variant)v, &options);
        printf("| %s |", faulty_name((faulty_variant)v));
        for (int i = 0; i < LIMITS; i++) {
            const lr_metric_result *m = metric(&result, limits[i].name);
            printf(" %s%.*g%s%s |", m->pass ? "" : "**", i < 2 ? 3 : 4, m->value, i < 2 ? " %" : "",
                   m->pass ? "" : "**");
        }
        printf(" %s |\n", lr_cause_name(result.cause));
        lr_compare_result_free(&result);
    }
    return 0;
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_verdicts), cmocka_unit_test(test_sentences),
        cmocka_unit_test(test_regions),  cmocka_unit_test(test_many_regions),
        cmocka_unit_test(test_shifts),   cmocka_unit_test(test_exposure),
        cmocka_unit_test(test_heat_map), cmocka_unit_test(test_same_everywhere),
    };
    return argc > 1 ? write_all(argv[1]) : cmocka_run_group_tests(tests, NULL, NULL);
}
