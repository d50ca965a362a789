#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "compare/compare_internal.h"

static const char *const names[] = {
#define X(id, name, value, help) [LR_METRIC_##id] = name,
    LR_METRICS(X)
#undef X
};

const char *lr_metric_name(lr_metric metric)
{
    return names[metric];
}

bool lr_metric_at_least(lr_metric metric)
{
    return metric == LR_METRIC_PSNR || metric == LR_METRIC_SSIM || metric == LR_METRIC_NOISE;
}

/* A decimal number, or the quotient of two, such as 2/255. */
static bool read_number(const char *text, double *number)
{
    static const char digits[] = "0123456789.eE+-/";
    char *end;
    if (!text || !*text || text[strspn(text, digits)])
        return false; /* strtod would take spaces, words and hexadecimal numbers */
    *number = strtod(text, &end);
    if (end == text)
        return false;
    if (*end == '/') {
        const char *divisor = end + 1;
        double by = strtod(divisor, &end);
        if (end == divisor || by == 0)
            return false;
        *number /= by;
    }
    return !*end && *number - *number == 0; /* finite */
}

static lr_status read_within(const char *text, double low, double high, const char *expected,
                             double *number, lr_error *error)
{
    double value;
    if (!read_number(text, &value) || value < low || value > high)
        return lr_fail(error, LR_ERROR_ARGUMENT, "expected %s, not '%.100s'", expected,
                       text ? text : "");
    *number = value;
    return LR_OK;
}

static lr_status set_exact(lr_compare_options *options, const char *value, lr_error *error)
{
    bool no = value && strcmp(value, "false") == 0;
    if (value && !no && strcmp(value, "true") != 0)
        return lr_fail(error, LR_ERROR_ARGUMENT, "expected true or false, not '%.100s'", value);
    options->wanted[LR_METRIC_EXACT] = !no;
    return LR_OK;
}

static lr_status set_limit(lr_compare_options *options, lr_metric metric, const char *value,
                           lr_error *error)
{
    const char *expected = "a number from 0 up";
    double high = 1e30;
    if (metric == LR_METRIC_PSNR)
        expected = "decibels from 0 to 1000", high = 1000;
    else if (metric == LR_METRIC_SSIM || metric == LR_METRIC_FLIP_MEAN ||
             metric == LR_METRIC_FLIP_P99 || metric == LR_METRIC_FLIP_MAX)
        expected = "a number from 0 to 1", high = 1;
    else if (metric == LR_METRIC_NOISE)
        expected = "a probability from 0 to 0.5, such as 0.01", high = 0.5;
    lr_status status = read_within(value, 0, high, expected, &options->limits[metric], error);
    if (status == LR_OK)
        options->wanted[metric] = true;
    return status;
}

lr_status lr_compare_set(lr_compare_options *options, const char *name, const char *value,
                         lr_error *error)
{
    if (strcmp(name, "abs-percent") == 0)
        return read_within(value, 0, 100, "a percentage from 0 to 100", &options->abs_percent,
                           error);
    if (strcmp(name, "rel-percent") == 0)
        return read_within(value, 0, 100, "a percentage from 0 to 100", &options->rel_percent,
                           error);
    if (strcmp(name, "ppd") == 0)
        return read_within(value, 1, LR_PPD_MAX, "pixels per degree from 1 to 1000", &options->ppd,
                           error);
    for (int i = 0; i < LR_METRIC_COUNT; i++)
        if (strcmp(name, names[i]) == 0)
            return i == LR_METRIC_EXACT ? set_exact(options, value, error)
                                        : set_limit(options, (lr_metric)i, value, error);
    return lr_fail(error, LR_ERROR_ARGUMENT, "there is no metric '%.100s'", name);
}
