/* Whether two noisy pictures differ by more than their noise: tests of all pixels and of the means
 * of blocks, with Sidak's correction for their number (Z. Sidak, "Rectangular Confidence Regions
 * for the Means of Multivariate Normal Distributions", 1967, whose inequality also covers blocks
 * that contain each other).
 *
 * With variances V of the pixels' means, sum(d) / sqrt(sum(V)) over a block is standard normal.
 *
 * With halves A1, A2 and B1, B2 of equal sample counts the difference of a pixel's means is
 * d = (B1 + B2 - A1 - A2) / 2, and s = ((A1 - A2)^2 + (B1 - B2)^2) / 4 estimates its variance with
 * two degrees of freedom, independently of d. So d / sqrt(s) follows Student's t with two degrees
 * of freedom whatever the pixel's noise is. Such a value is too wild to be summed, and variances of
 * neighbours may differ too much to be pooled; but the normal variable z with the same probability
 * is standard normal exactly, and so is sum(z) / sqrt(n) over a block. */
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "compare/compare_internal.h"
#include "compare/probability.h"

/* Blocks of 1, 4, 16 and 64 pixels along their side, and the whole picture. */
static const uint32_t sides[] = {1, 4, 16, 64, UINT32_MAX};
enum { LEVELS = sizeof sides / sizeof *sides };

/* Differences that rounding explains where there is no noise at all. */
#define ROUNDING 1e-6

typedef struct noise_pictures {
    const compare_pair *pair;
    const lr_image *reference, *test;
    const lr_image *reference_variance, *test_variance;
    const lr_image *reference_half, *test_half;
} noise_pictures;

/* What a pixel adds to its blocks: under the hypothesis that only noise differs, the difference is
 * normal with this variance. */
typedef struct term {
    double difference, variance;
} term;

static double sample(const lr_image *image, size_t pixel, uint32_t channel)
{
    if (!image)
        return 0;
    return (double)image->samples[pixel * image->channels + (image->channels >= 3 ? channel : 0)];
}

static term normal_score(double difference, double variance)
{
    double t = fabs(difference) / sqrt(variance);
    double z = t < 1e100 ? probability_normal_inverse(probability_student_2(t)) : INFINITY;
    return (term){difference < 0 ? -z : z, 1};
}

static term measure_pixel(const noise_pictures *p, size_t pixel, uint32_t channel)
{
    double a = sample(p->reference, pixel, channel), b = sample(p->test, pixel, channel);
    double difference = b - a, variance;
    if (p->reference_half) {
        double a2 = sample(p->reference_half, pixel, channel);
        double b2 = sample(p->test_half, pixel, channel);
        difference = (difference + (b2 - a2)) / 2;
        variance = ((a - a2) * (a - a2) + (b - b2) * (b - b2)) / 4;
    } else {
        variance = fmax(sample(p->reference_variance, pixel, channel), 0) +
                   fmax(sample(p->test_variance, pixel, channel), 0);
    }
    if (variance == 0 && fabs(difference) <= ROUNDING * fmax(fabs(a), fabs(b)))
        return (term){0, 0};
    if (!(fabs(difference) < 1e300 && variance < 1e300)) /* infinite or not a number */
        return (term){INFINITY, 1};
    return p->reference_half ? normal_score(difference, variance) : (term){difference, variance};
}

static double score(const term *t)
{
    double z = t->difference == 0 ? 0 : fabs(t->difference) / sqrt(t->variance);
    return z == z ? z : INFINITY; /* opposite infinities */
}

/* The largest score of one size of blocks. */
typedef struct level {
    uint32_t side, columns;
    term *row; /* of blocks, being summed */
    double largest, tests;
    lr_rectangle where;
} level;

static void finish_row(const compare_pair *pair, level *l, uint32_t top, uint32_t bottom)
{
    for (uint32_t i = 0; i < l->columns; i++) {
        term sum = l->row[i];
        l->row[i] = (term){0};
        if (sum.variance == 0 && sum.difference == 0)
            continue; /* nothing compared, or nothing random and nothing different */
        double z = score(&sum);
        l->tests++;
        if (z > l->largest) {
            uint32_t left = l->columns == 1 ? 0 : i * l->side, rest = pair->width - left;
            l->largest = z;
            l->where = (lr_rectangle){left, top, rest < l->side ? rest : l->side, bottom - top};
        }
    }
}

static void test_level(const compare_pair *pair, const term *terms, level *l)
{
    uint32_t top = 0;
    for (uint32_t y = 0; y < pair->height; y++) {
        for (uint32_t x = 0; x < pair->width; x++) {
            const term *one = &terms[(size_t)y * pair->width + x];
            l->row[x / l->side].difference += one->difference;
            l->row[x / l->side].variance += one->variance;
        }
        if (y + 1 == pair->height || y + 1 - top == l->side) {
            finish_row(pair, l, top, y + 1);
            top = y + 1;
        }
    }
}

/* The terms of one channel; pixels that are not compared add nothing. */
static void measure_channel(const noise_pictures *p, uint32_t channel, term *terms, float *map)
{
    size_t count = (size_t)p->pair->width * p->pair->height;
    for (size_t i = 0; i < count; i++) {
        terms[i] = compare_is_used(p->pair, i) ? measure_pixel(p, i, channel) : (term){0, 0};
        float z = (float)score(&terms[i]);
        if (map && (channel == 0 || z > map[i]))
            map[i] = z;
    }
}

static lr_status check(const lr_image *image, const lr_image *reference, const char *what,
                       lr_error *error)
{
    if (image && (image->width != reference->width || image->height != reference->height))
        return lr_fail(error, LR_ERROR_ARGUMENT,
                       "the %s has %u x %u pixels, the reference %u x %u; they must be the same",
                       what, image->width, image->height, reference->width, reference->height);
    return LR_OK;
}

static lr_status check_all(const lr_image *reference, const lr_compare_options *o, lr_error *error)
{
    bool variances = o->reference_variance || o->test_variance;
    bool halves = o->reference_half && o->test_half;
    if (variances == halves || (!halves && (o->reference_half || o->test_half)))
        return lr_fail(error, LR_ERROR_ARGUMENT,
                       "the noise test needs variances of one or both pictures, or a second half "
                       "of both");
    lr_status status = check(o->reference_variance, reference, "reference's variance", error);
    if (status == LR_OK)
        status = check(o->test_variance, reference, "test's variance", error);
    if (status == LR_OK)
        status = check(o->reference_half, reference, "reference's second half", error);
    return status == LR_OK ? check(o->test_half, reference, "test's second half", error) : status;
}

lr_status compare_noise(const lr_image *reference, const lr_image *test, const compare_pair *pair,
                        const lr_compare_options *options, lr_compare_result *result,
                        lr_error *error)
{
    lr_status status = check_all(reference, options, error);
    if (status != LR_OK)
        return status;
    noise_pictures p = {
        .pair = pair,
        .reference = reference,
        .test = test,
        .reference_variance = options->reference_variance,
        .test_variance = options->test_variance,
        .reference_half = options->reference_half,
        .test_half = options->test_half,
    };
    term *terms = lr_alloc((size_t)pair->width * pair->height, sizeof *terms);
    term *row = lr_alloc(pair->width, sizeof *row);
    level levels[LEVELS] = {{0}};
    for (uint32_t c = 0; c < pair->colors && terms && row; c++) {
        measure_channel(&p, c, terms, result->map);
        for (int i = 0; i < LEVELS; i++) {
            level *l = &levels[i];
            l->side = sides[i];
            l->columns = (pair->width - 1) / l->side + 1;
            l->row = row;
            test_level(pair, terms, l);
        }
    }
    if (!terms || !row)
        status = lr_fail(error, LR_ERROR_MEMORY, "out of memory for the noise test");
    free(terms);
    free(row);
    double least = 2;
    for (int i = 0; i < LEVELS; i++) {
        double p_pixel = probability_normal(fmin(levels[i].largest, 38));
        double p_level = probability_any(p_pixel, levels[i].tests);
        if (levels[i].tests > 0 && p_level < least) {
            least = p_level;
            result->noise_box = levels[i].where;
            result->noise_z = levels[i].largest;
        }
    }
    result->metrics[LR_METRIC_NOISE].value = least <= 1 ? probability_any(least, LEVELS) : 1;
    return status;
}
