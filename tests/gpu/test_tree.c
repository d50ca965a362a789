/* The ray tree as queues: a pixel whose tree is the full binary one, and what is counted rather
 * than accumulated. */
#include "gpu_tests.h"

#define DEPTH 12
#define PANES 13 /* on either side of the camera, one metre apart */

static const double reflect[3] = {0.5, 0.3, 0.6}, transmit[3] = {0.25, 0.7, 0.4};

static double glow(int pane, int channel)
{
    return 0.125 * (1 + (pane + PANES) % (3 + channel));
}

/* Thin panes that each mirror and transmit, so many that no ray of the tree gets past them all. */
static const char *panes_scene(const char *image)
{
    static char text[16384];
    int at = snprintf(text, sizeof text,
                      "camera: {from: [0, 0, 0], to: [0, 0, 1], fov: 10}\nimage: {%s}\n"
                      "ambient: 1\nbackground: 1e6\nlights: []\nobjects:\n",
                      image);
    for (int pane = -PANES; pane <= PANES; pane++)
        if (pane)
            at += snprintf(text + at, sizeof text - (size_t)at,
                           "  - rectangle: {corner: [-50, -50, %d], u: [100, 0, 0], v: [0, 100, 0],"
                           " material: {color: [%g, %g, %g], ambient: 1, diffuse: 0, "
                           "reflect: [0.5, 0.3, 0.6], transmit: [0.25, 0.7, 0.4]}}\n",
                           pane, glow(pane, 0), glow(pane, 1), glow(pane, 2));
    return text;
}

/* What a ray sees that hits this pane on its way along z (step is 1 or -1). */
static double seen(int pane, int step, int depth, int channel)
{
    if (depth > DEPTH)
        return 0;
    int ahead = pane + step ? pane + step : step; /* there is no pane 0 */
    int back = pane - step ? pane - step : -step;
    return glow(pane, channel) + reflect[channel] * seen(back, -step, depth + 1, channel) +
           transmit[channel] * seen(ahead, step, depth + 1, channel);
}

static void test_full_binary_tree(void **state)
{
    const char *text = panes_scene("width: 1, height: 1, depth: 12");
    picture p = render_text(*state, text, NULL);
    rgb found = pixel_at(&p, 0, 0);
    assert_int_equal(p.stats.primary.traced + p.stats.reflected.traced + p.stats.refracted.traced,
                     8191);
    assert_int_equal(p.stats.primary.hit + p.stats.reflected.hit + p.stats.refracted.hit, 8191);
    assert_int_equal(p.stats.reflected.traced, 4095);
    assert_int_equal(p.stats.refracted.traced, 4095);
    assert_int_equal(p.stats.dropped_depth, 8192);
    assert_near(found.r, seen(1, 1, 0, 0), 2e-6);
    assert_near(found.g, seen(1, 1, 0, 1), 2e-6);
    assert_near(found.b, seen(1, 1, 0, 2), 2e-6);

    const lr_render_options cuts[] = {{.tile_size = 1, .chunk_rays = 1},
                                      {.tile_size = 1, .chunk_rays = 64},
                                      {.tile_size = 8, .chunk_rays = 1024},
                                      {.chunk_rays = 100000}};
    for (int i = 0; i < 4; i++) {
        picture q = render_text(*state, text, &cuts[i]);
        assert_string_equal(p.stats.hash, q.stats.hash);
        assert_int_equal(q.stats.dropped_depth, 8192);
        free_picture(&q);
    }
    free_picture(&p);
}

/* Many trees at once, in every cut. */
static void test_forest(void **state)
{
    const char *text = panes_scene("width: 8, height: 8, depth: 12");
    const lr_render_options cuts[] = {{.tile_size = 8, .chunk_rays = 1024},
                                      {.tile_size = 3, .chunk_rays = 4096},
                                      {.chunk_rays = 1u << 20}};
    picture p = render_text(*state, text, NULL);
    uint64_t rays = p.stats.primary.traced + p.stats.reflected.traced + p.stats.refracted.traced;
    assert_int_equal(rays, 64 * 8191);
    for (uint32_t i = 0; i < 64; i++) /* nothing in the scene depends on the angle */
        assert_near(pixel_at(&p, i % 8, i / 8).r, seen(1, 1, 0, 0), 4e-6);
    for (int i = 0; i < 3; i++) {
        picture q = render_text(*state, text, &cuts[i]);
        assert_string_equal(p.stats.hash, q.stats.hash);
        free_picture(&q);
    }
    free_picture(&p);
}

static void test_min_weight_prunes(void **state)
{
    const char *format = "width: 1, height: 1, depth: 12, min_weight: %g";
    char image[128];
    uint64_t before = UINT64_MAX;
    double whole = seen(1, 1, 0, 0);
    for (double least = 0.001; least < 1; least *= 10) {
        snprintf(image, sizeof image, format, least);
        picture p = render_text(*state, panes_scene(image), NULL);
        uint64_t rays = 1 + p.stats.reflected.traced + p.stats.refracted.traced;
        uint64_t dropped = p.stats.dropped_weight + p.stats.dropped_depth;
        assert_true(rays < before && p.stats.dropped_weight > 0);
        assert_int_equal(dropped, rays + 1); /* the missing children of a binary tree */
        assert_true(pixel_at(&p, 0, 0).r <= whole + 1e-5);
        before = rays;
        free_picture(&p);
    }
}

static void test_samples_are_counted(void **state)
{
    picture p = render_text(*state, panes_scene("width: 5, height: 3, samples: 7, depth: 2"),
                            &(lr_render_options){.chunk_rays = 32, .tile_size = 4});
    assert_int_equal(p.stats.primary.traced, 5 * 3 * 7);
    assert_int_equal(p.stats.samples, 7);
    free_picture(&p);
}

/* ---- Out of range -------------------------------------------------------------------------- */

#define WALL                                                                                       \
    "camera: {from: [0, 0, 5]}\nambient: %s\nlights: [%s]\nimage: {samples: %d}\nobjects:\n"       \
    "  - plane: {normal: [0, 0, 1], material: {color: %s, diffuse: %s, ambient: 1}}\n"
#define SUN(color, intensity)                                                                      \
    "{directional: {direction: [0, 0, -1], color: " color ", intensity: " intensity "}}"

/* A light beyond the range of floats is left out and counted; all others stay. */
static void test_non_finite(void **state)
{
    lr_render_stats stats;
    rgb found =
        render_pixel(*state, &stats, WALL, "0.25",
                     SUN("1e12", "1e12") ", " SUN("[1e-24, 0, 0]", "1"), 4, "[1e12, 0, 1]", "1e12");
    assert_int_equal(stats.non_finite, 4);
    assert_int_equal(stats.saturated, 4); /* 0.25e12 of ambient light in red */
    assert_near(found.b, 0.25, 1e-7);
    assert_near(found.g, 0, 0);
    found = render_pixel(*state, &stats, WALL, "0.25",
                         SUN("1e12", "1e12") ", " SUN("[0.5, 0, 0]", "1"), 1, "1", "[1e12, 0, 1]");
    assert_int_equal(stats.non_finite, 0);
    assert_int_equal(stats.saturated, 2);
    found = render_pixel(*state, &stats, WALL, "0.25", SUN("1e12", "1e12"), 3, "1e12", "1e12");
    assert_int_equal(stats.non_finite, 3);
    assert_int_equal(stats.saturated, 3);
}

/* What is above the film's range is clipped to it and counted; other channels are not touched. */
static void test_saturation(void **state)
{
    lr_render_stats stats;
    rgb found = render_pixel(*state, &stats, WALL, "0", SUN("[1e12, 0.5, 0]", "1"), 1, "1", "1");
    assert_int_equal(stats.saturated, 1);
    assert_int_equal(stats.non_finite, 0);
    assert_near(found.r, LR_FILM_MAX, 0);
    assert_near(found.g, 0.5, 1e-6);
    assert_near(found.b, 0, 0);
    /* A sum that overflows reads as the range's end. */
    found =
        render_pixel(*state, &stats, WALL, "0",
                     SUN("[1.5e8, 0.5, 0]", "1") ", " SUN("[1.5e8, 0.25, 2e8]", "1"), 1, "1", "1");
    assert_int_equal(stats.saturated, 0);
    assert_near(found.r, LR_FILM_MAX, 0);
    assert_near(found.g, 0.75, 1e-6);
    assert_near(found.b, 2e8, 100);
    found = render_pixel(*state, &stats, WALL, "0", SUN("[1e8, 0.5, 0]", "1"), 4, "1", "1");
    assert_int_equal(stats.saturated, 0);
    assert_near(found.r, LR_FILM_MAX / 4, 0);
    assert_near(found.g, 0.5, 1e-6);
    found = render_pixel(*state, &stats,
                         "camera: {from: [0, 0, 5]}\nambient: 0.3\nbackground: [1e12, 0.5, 0]\n"
                         "lights: []\nobjects:\n  - plane: {normal: [0, 0, 1], material: "
                         "{color: 1, ambient: 1, diffuse: 0, reflect: 1}}\n");
    assert_near(found.r, LR_FILM_MAX, 0);
    assert_near(found.g, 0.8, 1e-6);
    /* Over several samples too, whose mean is then below what it should be, not above. */
    found = render_pixel(*state, &stats, WALL, "0", SUN("[1e12, 0.5, 0]", "1"), 4, "1", "1");
    assert_int_equal(stats.saturated, 4);
    assert_near(found.r, LR_FILM_MAX / 4, 0);
    assert_near(found.g, 0.5, 1e-6);
}

/* Contributions below the film's step vanish; just above it they add up. */
static void test_small_values(void **state)
{
    rgb found = render_pixel(*state, NULL, WALL, "0",
                             SUN("[1e-30, 1e-9, 1e-10]", "1") ", " SUN("[1e-30, 1e-9, 1e-10]", "1"),
                             1, "1", "1");
    assert_near(found.r, 0, 0);
    assert_near(found.g, 2e-9, 3e-11);
    assert_near(found.b, 2e-10, 3e-11);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_full_binary_tree),  cmocka_unit_test(test_forest),
        cmocka_unit_test(test_min_weight_prunes), cmocka_unit_test(test_samples_are_counted),
        cmocka_unit_test(test_non_finite),        cmocka_unit_test(test_saturation),
        cmocka_unit_test(test_small_values),      cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device, NULL);
}
