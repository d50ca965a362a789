#include "compare/compare.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "compare/compare_internal.h"

/* The eye's resolution at 0.7 m from a display of 3840 pixels and 0.7 m, FLIP's default. */
#define PPD_DEFAULT 67.02064

static bool wants_flip(const lr_compare_options *options)
{
    return options->wanted[LR_METRIC_FLIP_MEAN] || options->wanted[LR_METRIC_FLIP_P99] ||
           options->wanted[LR_METRIC_FLIP_MAX];
}

static lr_status check_options(const lr_compare_options *options, lr_error *error)
{
    if (options->ignored_count > LR_IGNORED_MAX)
        return lr_fail(error, LR_ERROR_ARGUMENT, "%u ignored rectangles; at most %d are possible",
                       options->ignored_count, LR_IGNORED_MAX);
    if (!(options->ppd == 0 || (options->ppd >= 1 && options->ppd <= LR_PPD_MAX)))
        return lr_fail(error, LR_ERROR_ARGUMENT, "%g pixels per degree; expected 1 to %d",
                       options->ppd, LR_PPD_MAX);
    return LR_OK;
}

/* Sums the errors of the compared pixels and finds the 99th percentile. */
static lr_status pool_flip(const compare_pair *pair, const float *map, lr_compare_result *result,
                           lr_error *error)
{
    size_t count = (size_t)pair->width * pair->height, kept = 0;
    float *errors = lr_alloc(count, sizeof *errors);
    if (!errors)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for FLIP");
    double sum = 0, largest = 0;
    for (size_t i = 0; i < count; i++)
        if (compare_is_used(pair, i)) {
            errors[kept++] = map[i];
            sum += map[i];
            largest = map[i] > largest ? map[i] : largest;
        }
    size_t rank = kept - kept / 100; /* the nearest: at least 99 % of the pixels stay within */
    result->metrics[LR_METRIC_FLIP_MEAN].value = sum / (double)kept;
    result->metrics[LR_METRIC_FLIP_P99].value = compare_select(errors, kept, rank - 1);
    result->metrics[LR_METRIC_FLIP_MAX].value = largest;
    free(errors);
    return LR_OK;
}

static void judge(const lr_compare_options *options, lr_compare_result *result)
{
    bool any = false;
    for (int i = 0; i < LR_METRIC_COUNT; i++)
        any |= options->wanted[i];
    result->pass = true;
    for (int i = 0; i < LR_METRIC_COUNT; i++) {
        lr_metric_result *m = &result->metrics[i];
        if (!options->wanted[i] && (any || i != LR_METRIC_EXACT)) {
            *m = (lr_metric_result){0};
            continue;
        }
        m->measured = true;
        m->limit = i == LR_METRIC_EXACT ? 0 : options->limits[i];
        if (i == LR_METRIC_EXACT || i == LR_METRIC_ABS || i == LR_METRIC_REL) {
            m->allowed = i == LR_METRIC_ABS   ? options->abs_percent
                         : i == LR_METRIC_REL ? options->rel_percent
                                              : 0;
            m->pass = m->value <= m->allowed;
        } else {
            m->pass =
                lr_metric_at_least((lr_metric)i) ? m->value >= m->limit : m->value <= m->limit;
        }
        result->pass &= m->pass;
    }
}

static lr_status measure(const lr_image *reference, const lr_image *test, const compare_pair *pair,
                         const lr_compare_options *options, lr_compare_result *result,
                         lr_error *error)
{
    lr_status status = LR_OK;
    result->channels = pair->colors + pair->alpha;
    result->converted = pair->converted;
    result->compared = pair->compared;
    compare_pixels(pair, options, result);
    if (options->wanted[LR_METRIC_SSIM])
        status = compare_ssim(pair, &result->metrics[LR_METRIC_SSIM].value, error);
    if (wants_flip(options) || options->wanted[LR_METRIC_NOISE]) {
        size_t count = (size_t)pair->width * pair->height;
        result->map = lr_alloc(count, sizeof *result->map);
        if (!result->map)
            return lr_fail(error, LR_ERROR_MEMORY, "out of memory for the map of errors");
    }
    if (options->wanted[LR_METRIC_NOISE] && status == LR_OK) {
        result->map_name = "|z|";
        status = compare_noise(reference, test, pair, options, result, error);
    }
    if (wants_flip(options) && status == LR_OK) {
        result->map_name = "FLIP"; /* rather than the noise's */
        status =
            compare_flip(pair, options->ppd > 0 ? options->ppd : PPD_DEFAULT, result->map, error);
        if (status == LR_OK)
            status = pool_flip(pair, result->map, result, error);
    }
    return status;
}

/* The map that regions and the heat map are made of: FLIP where it was measured, else the largest
 * difference of each pixel's samples; -1 where nothing is compared. */
static lr_status make_map(const compare_pair *pair, lr_compare_result *result, lr_error *error)
{
    size_t count = (size_t)pair->width * pair->height;
    bool measured = result->map;
    if (!measured) {
        result->map = lr_alloc(count, sizeof *result->map);
        result->map_name = "difference";
    }
    if (!result->map)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for the map of differences");
    for (size_t i = 0; i < count; i++)
        if (!compare_is_used(pair, i))
            result->map[i] = -1;
        else if (!measured)
            result->map[i] = (float)compare_largest(pair, i);
    return LR_OK;
}

static lr_status explain(const compare_pair *pair, const lr_compare_options *options,
                         lr_compare_result *result, lr_error *error)
{
    lr_status status = LR_OK;
    if (options->map || (options->explain && result->different))
        status = make_map(pair, result, error);
    if (options->explain && result->different) {
        if (status == LR_OK)
            status =
                compare_regions(pair, options, result->map, wants_flip(options), result, error);
        if (status == LR_OK && result->metrics[LR_METRIC_NOISE].pass)
            result->cause = LR_CAUSE_NOISE; /* as it was tested */
        else if (status == LR_OK)
            status = compare_explain(pair, result, error);
    }
    if (!options->map) {
        free(result->map);
        result->map = NULL;
        result->map_name = NULL;
    }
    return status;
}

lr_status lr_compare(const lr_image *reference, const lr_image *test,
                     const lr_compare_options *options, lr_compare_result *result, lr_error *error)
{
    *result = (lr_compare_result){
        .width = reference->width,
        .height = reference->height,
        .test_width = test->width,
        .test_height = test->height,
        .same_size = reference->width == test->width && reference->height == test->height,
    };
    lr_status status = check_options(options, error);
    if (status != LR_OK || !result->same_size)
        return status;
    compare_pair pair;
    status = compare_prepare(reference, test, options, &pair, error);
    if (status == LR_OK)
        status = measure(reference, test, &pair, options, result, error);
    if (status == LR_OK)
        judge(options, result);
    if (status == LR_OK)
        status = explain(&pair, options, result, error);
    compare_release(&pair);
    if (status != LR_OK)
        lr_compare_result_free(result);
    return status;
}

void lr_compare_result_free(lr_compare_result *result)
{
    if (!result)
        return;
    free(result->map);
    *result = (lr_compare_result){0};
}
