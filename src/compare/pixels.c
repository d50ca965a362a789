/* Metrics that are sums and counts over samples. */
#include <math.h>

#include "base/exact.h"
#include "compare/compare_internal.h"

typedef struct sums {
    double square, relative_square;
    double max_relative;
    uint64_t over_abs, over_rel;
} sums;

double compare_difference(const compare_pair *pair, float reference, float test)
{
    if (reference == test)
        return 0;
    double difference = fabs((double)reference - (double)test);
    if (!(difference <= 3.5e38)) /* infinite or NaN */
        return reference != reference && test != test ? 0 : INFINITY;
    return pair->maxval ? floor(difference * pair->maxval + 0.5) / pair->maxval : difference;
}

double compare_relative(const compare_pair *pair, float reference, float test)
{
    double difference = compare_difference(pair, reference, test);
    if (difference == 0 || isinf(difference))
        return difference;
    return difference / fmax(fabs((double)reference), fabs((double)test));
}

static void note_first(const compare_pair *pair, const float *reference, const float *test,
                       uint32_t x, uint32_t y, lr_compare_result *result)
{
    result->different = true;
    result->first_x = x;
    result->first_y = y;
    uint32_t samples = pair->colors + pair->alpha;
    double scale = pair->maxval ? pair->maxval : 1;
    for (uint32_t c = 0; c < samples; c++) {
        result->first_reference[c] = reference[c] * scale;
        result->first_test[c] = test[c] * scale;
        if (pair->maxval) {
            result->first_reference[c] = floor(result->first_reference[c] + 0.5);
            result->first_test[c] = floor(result->first_test[c] + 0.5);
        }
    }
}

static void add_pixel(const compare_pair *pair, const lr_compare_options *options, uint32_t x,
                      uint32_t y, sums *s, lr_compare_result *result)
{
    size_t i = ((size_t)y * pair->width + x) * pair->stride;
    const float *reference = pair->reference + i, *test = pair->test + i;
    uint32_t samples = pair->colors + pair->alpha;
    double largest = 0, largest_relative = 0;
    bool finite = true;
    for (uint32_t c = 0; c < samples; c++) {
        double d = compare_difference(pair, reference[c], test[c]);
        if (d == 0)
            continue;
        finite &= !isinf(d);
        double square = d * d, r = reference[c];
        s->square += square;
        if (options->wanted[LR_METRIC_RELMSE])
            s->relative_square += isinf(d) ? d : square / (r * r + 0.01);
        if (options->wanted[LR_METRIC_REL] || options->wanted[LR_METRIC_MAX_REL]) {
            double share = compare_relative(pair, reference[c], test[c]);
            largest_relative = share > largest_relative ? share : largest_relative;
        }
        if (d > largest)
            largest = d;
        if (d > result->max_difference) {
            result->max_difference = d;
            result->max_x = x;
            result->max_y = y;
            result->max_channel = c;
        }
    }
    if (largest == 0)
        return;
    if (!result->different)
        note_first(pair, reference, test, x, y, result);
    result->different_pixels++;
    result->non_finite += !finite;
    s->max_relative = largest_relative > s->max_relative ? largest_relative : s->max_relative;
    s->over_abs += largest > options->limits[LR_METRIC_ABS];
    s->over_rel += largest_relative > options->limits[LR_METRIC_REL];
}

static void put_share(lr_compare_result *result, lr_metric metric, uint64_t pixels)
{
    result->metrics[metric].pixels = pixels;
    result->metrics[metric].value = 100.0 * (double)pixels / (double)result->compared;
}

void compare_pixels(const compare_pair *pair, const lr_compare_options *options,
                    lr_compare_result *result)
{
    sums s = {0};
    for (uint32_t y = 0; y < pair->height; y++)
        if (!compare_same_row(pair, y))
            for (uint32_t x = 0; x < pair->width; x++)
                add_pixel(pair, options, x, y, &s, result);
    double samples = (double)pair->compared * (pair->colors + pair->alpha);
    double mse = s.square / samples;
    put_share(result, LR_METRIC_EXACT, result->different_pixels);
    put_share(result, LR_METRIC_ABS, s.over_abs);
    put_share(result, LR_METRIC_REL, s.over_rel);
    result->metrics[LR_METRIC_MAX_ABS].value = result->max_difference;
    result->metrics[LR_METRIC_MAX_REL].value = s.max_relative;
    result->metrics[LR_METRIC_MSE].value = mse;
    result->metrics[LR_METRIC_RMSE].value = sqrt(mse);
    result->metrics[LR_METRIC_RELMSE].value = s.relative_square / samples;
    /* 10 log10(peak^2 / MSE) */
    result->metrics[LR_METRIC_PSNR].value =
        mse == 0     ? INFINITY
        : isinf(mse) ? -INFINITY
                     : 3.0102999566398120 * lr_log2(pair->peak * pair->peak / mse);
}
