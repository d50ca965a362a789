/* A picture and two dozen faulty variants of it, the same on every machine: what comparisons are
 * held to. */
#ifndef LR_TESTS_FAULTY_H
#define LR_TESTS_FAULTY_H

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/exact.h"
#include "base/vec.h"
#include "image/read.h"

enum { FAULTY_WIDTH = 240, FAULTY_HEIGHT = 160, FAULTY_PIXELS = FAULTY_WIDTH * FAULTY_HEIGHT };

/* What to draw, before 8 bits. */
typedef struct faulty_scene {
    double shift_x, shift_y; /* of everything, in pixels */
    double ball_x;           /* of one ball, in pixels */
    int samples;             /* along a pixel's side */
    bool missing;            /* the small ball */
} faulty_scene;

static inline uint32_t faulty_random(uint32_t *state)
{
    *state = *state * 747796405u + 2891336453u;
    uint32_t word = ((*state >> ((*state >> 28) + 4)) ^ *state) * 277803737u;
    return (word >> 22) ^ word;
}

static inline double faulty_uniform(uint32_t *state)
{
    return faulty_random(state) / 4294967296.0;
}

/* The colour at a point of the picture plane: a sky, a checkered floor in perspective, lit balls.
 */
static inline void faulty_shade(const faulty_scene *scene, double px, double py, double rgb[3])
{
    static const struct {
        double x, y, radius, rgb[3];
    } balls[] = {
        {70, 84, 40, {0.85, 0.25, 0.2}},  {150, 96, 30, {0.2, 0.55, 0.85}},
        {201, 112, 17, {0.9, 0.75, 0.2}}, {112, 128, 13, {0.3, 0.8, 0.35}},
        {176, 44, 9, {0.75, 0.4, 0.85}},
    };
    double x = px - scene->shift_x, y = py - scene->shift_y;
    double t = y / FAULTY_HEIGHT;
    if (y < 70) {
        rgb[0] = 0.35 + 0.5 * t + 0.0004 * x;
        rgb[1] = 0.55 + 0.45 * t;
        rgb[2] = 0.85 + 0.12 * t - 0.0003 * x;
    } else {
        double depth = 900 / (y - 58), across = (x - 120) * depth / 70;
        bool dark = ((int)floor(depth / 6) + (int)floor(across / 7 + 100)) & 1;
        double fade = depth / 75;
        for (int c = 0; c < 3; c++)
            rgb[c] = (dark ? 0.22 + 0.02 * c : 0.78 - 0.05 * c) * (1 - 0.5 * fade) + 0.3 * fade;
    }
    for (size_t i = 0; i < sizeof balls / sizeof *balls; i++) {
        if (scene->missing && i == 3)
            continue;
        double dx = (x - balls[i].x - (i == 2 ? scene->ball_x : 0)) / balls[i].radius;
        double dy = (y - balls[i].y) / balls[i].radius, zz = 1 - dx * dx - dy * dy;
        if (zz < 0)
            continue;
        double z = sqrt(zz), light = -0.45 * dx - 0.6 * dy + 0.66 * z;
        light = light > 0 ? light : 0;
        double shine = light * light * light * light;
        for (int c = 0; c < 3; c++)
            rgb[c] = balls[i].rgb[c] * (0.15 + 0.75 * light) + 0.25 * shine * shine;
    }
}

/* Samples of 0..1, not yet rounded; RGB. */
static inline void faulty_draw(const faulty_scene *scene, double *out)
{
    for (int y = 0; y < FAULTY_HEIGHT; y++)
        for (int x = 0; x < FAULTY_WIDTH; x++) {
            double sum[3] = {0}, rgb[3];
            for (int s = 0; s < scene->samples * scene->samples; s++) {
                double u = (s % scene->samples + 0.5) / scene->samples;
                double v = (s / scene->samples + 0.5) / scene->samples;
                faulty_shade(scene, x + u, y + v, rgb);
                for (int c = 0; c < 3; c++)
                    sum[c] += fmin(fmax(rgb[c], 0), 1);
            }
            for (int c = 0; c < 3; c++)
                out[3 * (y * FAULTY_WIDTH + x) + c] = sum[c] / (scene->samples * scene->samples);
        }
}

/* A 3 x 3 binomial filter, edges repeated. */
static inline void faulty_smooth(const double *in, double *out)
{
    for (int y = 0; y < FAULTY_HEIGHT; y++)
        for (int x = 0; x < FAULTY_WIDTH; x++)
            for (int c = 0; c < 3; c++) {
                double sum = 0;
                for (int k = 0; k < 9; k++) {
                    int u = x + k % 3 - 1, v = y + k / 3 - 1;
                    u = u < 0 ? 0 : u >= FAULTY_WIDTH ? FAULTY_WIDTH - 1 : u;
                    v = v < 0 ? 0 : v >= FAULTY_HEIGHT ? FAULTY_HEIGHT - 1 : v;
                    double weight = (k % 3 == 1 ? 2 : 1) * (k / 3 == 1 ? 2 : 1);
                    sum += weight * in[3 * (v * FAULTY_WIDTH + u) + c];
                }
                out[3 * (y * FAULTY_WIDTH + x) + c] = sum / 16;
            }
}

/* The quantised discrete cosine transform of an 8 x 8 block, as baseline JPEG at about quality 40
 * has it, without its colour space. */
static inline void faulty_block(double *samples, int stride)
{
    static double cosines[8][8];
    if (cosines[0][0] == 0)
        for (int x = 0; x < 8; x++)
            for (int u = 0; u < 8; u++) {
                double sine;
                lr_sincos_degrees((2 * x + 1) * u * 11.25, &sine, &cosines[x][u]);
                cosines[x][u] *= u == 0 ? sqrt(0.125) : 0.5;
            }
    double coefficients[8][8] = {{0}};
    for (int u = 0; u < 8; u++)
        for (int v = 0; v < 8; v++) {
            double sum = 0, step = (16 + 6 * (u + v)) / 255.0;
            for (int i = 0; i < 64; i++)
                sum += samples[i / 8 * stride + i % 8 * 3] * cosines[i % 8][u] * cosines[i / 8][v];
            coefficients[v][u] = step * floor(sum / step + 0.5);
        }
    for (int i = 0; i < 64; i++) {
        double sum = 0;
        for (int u = 0; u < 8; u++)
            for (int v = 0; v < 8; v++)
                sum += coefficients[v][u] * cosines[i % 8][u] * cosines[i / 8][v];
        samples[i / 8 * stride + i % 8 * 3] = sum;
    }
}

typedef enum faulty_variant {
    FAULTY_NONE,
    FAULTY_PIXEL,
    FAULTY_BIT,
    FAULTY_SHIFT,
    FAULTY_OFFSET,
    FAULTY_SUBPIXEL,
    FAULTY_BLUR,
    FAULTY_SHARPEN,
    FAULTY_DARKER,
    FAULTY_GAMMA,
    FAULTY_CONTRAST,
    FAULTY_TINT,
    FAULTY_CHANNELS,
    FAULTY_MIRROR,
    FAULTY_UPSIDE_DOWN,
    FAULTY_MISSING,
    FAULTY_MOVED,
    FAULTY_BRIGHTER,
    FAULTY_ROW,
    FAULTY_NOISE,
    FAULTY_SALT,
    FAULTY_JPEG,
    FAULTY_QUANTISED,
    FAULTY_TRUNCATED,
    FAULTY_ALIASED,
    FAULTY_ALPHA,
    FAULTY_COUNT
} faulty_variant;

static inline double faulty_change_sample(faulty_variant variant, double v, int x, int y, int c,
                                          uint32_t *seed)
{
    static const double tint[3] = {1.08, 1, 0.85};
    switch (variant) {
    case FAULTY_DARKER:
        return 0.8 * v;
    case FAULTY_GAMMA:
        return v > 0 ? lr_exp2(lr_log2(v) / 2.2) : 0;
    case FAULTY_CONTRAST:
        return 1.15 * (v - 0.5) + 0.5;
    case FAULTY_TINT:
        return tint[c] * v;
    case FAULTY_BRIGHTER:
        return x >= 150 && x < 214 && y >= 20 && y < 60 ? 1.15 * v : v;
    case FAULTY_ROW:
        return y == 77 ? 0 : v;
    case FAULTY_NOISE: {
        double sum = -6; /* of standard deviation 1 */
        for (int i = 0; i < 12; i++)
            sum += faulty_uniform(seed);
        return v + 0.03 * sum;
    }
    case FAULTY_QUANTISED:
        return floor(v * 31 + 0.5) / 31;
    default:
        return v;
    }
}

/* Changes of the drawn picture that need its neighbourhood. */
static inline void faulty_change(faulty_variant variant, double *picture)
{
    static double smooth[3 * FAULTY_PIXELS], again[3 * FAULTY_PIXELS];
    uint32_t seed = 7;
    if (variant == FAULTY_BLUR || variant == FAULTY_SHARPEN) {
        faulty_smooth(picture, smooth);
        faulty_smooth(smooth, again);
        for (int i = 0; i < 3 * FAULTY_PIXELS; i++)
            picture[i] = variant == FAULTY_BLUR ? again[i] : 1.6 * picture[i] - 0.6 * again[i];
    }
    if (variant == FAULTY_JPEG)
        for (int y = 0; y < FAULTY_HEIGHT; y += 8)
            for (int x = 0; x < FAULTY_WIDTH; x += 8)
                for (int c = 0; c < 3; c++)
                    faulty_block(picture + 3 * (y * FAULTY_WIDTH + x) + c, 3 * FAULTY_WIDTH);
    for (int i = 0; i < FAULTY_PIXELS; i++)
        for (int c = 0; c < 3; c++)
            picture[3 * i + c] = faulty_change_sample(variant, picture[3 * i + c], i % FAULTY_WIDTH,
                                                      i / FAULTY_WIDTH, c, &seed);
    for (int i = 0; variant == FAULTY_SALT && i < FAULTY_PIXELS / 100; i++) {
        uint32_t at = faulty_random(&seed) % FAULTY_PIXELS;
        picture[3 * at] = picture[3 * at + 1] = picture[3 * at + 2] = i % 2;
    }
}

/* Changes of the picture's bytes. */
static inline void faulty_change_bytes(faulty_variant variant, const unsigned char *in,
                                       unsigned char *out)
{
    for (int i = 0; i < FAULTY_PIXELS; i++) {
        int x = i % FAULTY_WIDTH, y = i / FAULTY_WIDTH, from = i;
        if (variant == FAULTY_MIRROR)
            from = y * FAULTY_WIDTH + FAULTY_WIDTH - 1 - x;
        if (variant == FAULTY_UPSIDE_DOWN)
            from = FAULTY_PIXELS - 1 - i;
        for (int c = 0; c < 3; c++)
            out[3 * i + c] = in[3 * from + (variant == FAULTY_CHANNELS ? 2 - c : c)];
    }
    if (variant == FAULTY_PIXEL)
        out[3 * (90 * FAULTY_WIDTH + 121) + 1] ^= 64;
    if (variant == FAULTY_BIT)
        out[3 * (141 * FAULTY_WIDTH + 37) + 2] ^= 1;
}

static inline const char *faulty_name(faulty_variant variant)
{
    static const char *const names[FAULTY_COUNT] = {
        "none",           "one pixel",    "one bit",
        "shifted",        "offset",       "half a pixel",
        "blurred",        "sharpened",    "darker",
        "gamma",          "contrast",     "tinted",
        "channels",       "mirrored",     "upside down",
        "missing object", "moved object", "brighter region",
        "missing row",    "noise",        "salt and pepper",
        "jpeg",           "quantised",    "truncated",
        "aliased",        "alpha",
    };
    return names[variant];
}

/* An 8-bit RGB picture, or RGBA for FAULTY_ALPHA; freed with lr_image_free. */
static inline lr_image faulty_image(faulty_variant variant)
{
    static double picture[3 * FAULTY_PIXELS];
    static unsigned char bytes[3 * FAULTY_PIXELS], changed[3 * FAULTY_PIXELS];
    faulty_scene scene = {
        .shift_x = variant == FAULTY_SHIFT      ? 1
                   : variant == FAULTY_OFFSET   ? 9
                   : variant == FAULTY_SUBPIXEL ? 0.5
                                                : 0,
        .shift_y = variant == FAULTY_OFFSET ? -6 : 0,
        .ball_x = variant == FAULTY_MOVED ? 6 : 0,
        .samples = variant == FAULTY_ALIASED ? 1 : 3,
        .missing = variant == FAULTY_MISSING,
    };
    faulty_draw(&scene, picture);
    faulty_change(variant, picture);
    for (int i = 0; i < 3 * FAULTY_PIXELS; i++) {
        double rounding = variant == FAULTY_TRUNCATED ? 0 : 0.5;
        bytes[i] = (unsigned char)floor(fmin(fmax(picture[i], 0), 1) * 255 + rounding);
    }
    faulty_change_bytes(variant, bytes, changed);
    uint32_t channels = variant == FAULTY_ALPHA ? 4 : 3;
    lr_image image = {.width = FAULTY_WIDTH,
                      .height = FAULTY_HEIGHT,
                      .channels = channels,
                      .maxval = 255,
                      .samples = malloc(FAULTY_PIXELS * channels * sizeof(float))};
    for (uint32_t i = 0; image.samples && i < FAULTY_PIXELS; i++)
        for (uint32_t c = 0; c < channels; c++)
            image.samples[i * channels + c] = c == 3 ? (i % FAULTY_WIDTH < 100 ? 128 / 255.0f : 1)
                                                     : (float)changed[3 * i + c] / 255;
    return image;
}

#endif
