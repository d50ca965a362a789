/* The separate places where two pictures differ. */
#include <stdlib.h>

#include "base/memory.h"
#include "compare/compare_internal.h"

double compare_largest(const compare_pair *pair, size_t pixel)
{
    const float *reference = pair->reference + pixel * pair->stride;
    const float *test = pair->test + pixel * pair->stride;
    double largest = 0;
    for (uint32_t c = 0; c < pair->colors + pair->alpha; c++) {
        double d = compare_difference(pair, reference[c], test[c]);
        largest = d > largest ? d : largest;
    }
    return largest;
}

static double relative_error(const compare_pair *pair, size_t pixel)
{
    double largest = 0;
    for (uint32_t c = 0; c < pair->colors + pair->alpha; c++) {
        double d = compare_relative(pair, pair->reference[pixel * pair->stride + c],
                                    pair->test[pixel * pair->stride + c]);
        largest = d > largest ? d : largest;
    }
    return largest;
}

/* Whether the pixel breaks one of the limits that are set for single pixels; with none set, whether
 * it differs. */
static bool is_marked(const compare_pair *pair, const lr_compare_options *options,
                      const float *errors, bool flip, size_t pixel)
{
    const bool *wanted = options->wanted;
    const double *limits = options->limits;
    bool by_flip = flip && (wanted[LR_METRIC_FLIP_P99] || wanted[LR_METRIC_FLIP_MAX]);
    if (wanted[LR_METRIC_NOISE]) /* all pixels differ a little: what counts is tested by blocks */
        return false;
    if (wanted[LR_METRIC_EXACT] || (!wanted[LR_METRIC_ABS] && !wanted[LR_METRIC_REL] && !by_flip))
        return flip ? compare_largest(pair, pixel) > 0 : errors[pixel] > 0;
    if (wanted[LR_METRIC_ABS] && compare_largest(pair, pixel) > limits[LR_METRIC_ABS])
        return true;
    if (wanted[LR_METRIC_REL] && relative_error(pair, pixel) > limits[LR_METRIC_REL])
        return true;
    if (!by_flip)
        return false;
    double limit = wanted[LR_METRIC_FLIP_P99] ? limits[LR_METRIC_FLIP_P99] : 1;
    if (wanted[LR_METRIC_FLIP_MAX] && limits[LR_METRIC_FLIP_MAX] < limit)
        limit = limits[LR_METRIC_FLIP_MAX];
    return (double)errors[pixel] > limit;
}

/* A flood fill's state: pixels wait on the stack with their mark taken away. */
typedef struct flood {
    uint32_t width, height;
    unsigned char *marks;
    size_t *stack;
    size_t waiting;
} flood;

static void push_neighbours(flood *f, size_t pixel)
{
    uint32_t x = (uint32_t)(pixel % f->width), y = (uint32_t)(pixel / f->width);
    uint32_t left = x > 0 ? x - 1 : 0, right = x + 1 < f->width ? x + 1 : x;
    uint32_t top = y > 0 ? y - 1 : 0, bottom = y + 1 < f->height ? y + 1 : y;
    for (uint32_t v = top; v <= bottom; v++)
        for (uint32_t u = left; u <= right; u++) {
            size_t next = (size_t)v * f->width + u;
            if (f->marks[next]) {
                f->marks[next] = 0;
                f->stack[f->waiting++] = next;
            }
        }
}

static lr_region take_region(flood *f, size_t start, const float *errors)
{
    lr_region region = {.worst = -1};
    uint32_t left = UINT32_MAX, top = UINT32_MAX, right = 0, bottom = 0;
    size_t worst = start; /* the first in reading order, of several */
    f->marks[start] = 0;
    f->stack[f->waiting++] = start;
    while (f->waiting > 0) {
        size_t pixel = f->stack[--f->waiting];
        uint32_t x = (uint32_t)(pixel % f->width), y = (uint32_t)(pixel / f->width);
        left = x < left ? x : left;
        right = x > right ? x : right;
        top = y < top ? y : top;
        bottom = y > bottom ? y : bottom;
        region.pixels++;
        region.center_x += x;
        region.center_y += y;
        region.total += (double)errors[pixel];
        double here = (double)errors[pixel];
        if (here > region.worst || (here == region.worst && pixel < worst)) {
            worst = pixel;
            region.worst = here;
            region.worst_x = x;
            region.worst_y = y;
        }
        push_neighbours(f, pixel);
    }
    region.center_x /= (double)region.pixels;
    region.center_y /= (double)region.pixels;
    region.box = (lr_rectangle){left, top, right - left + 1, bottom - top + 1};
    return region;
}

/* Keeps the regions with the largest totals, the largest first. */
static void keep_region(lr_compare_result *result, const lr_region *region)
{
    uint32_t i = result->regions_kept;
    if (i == LR_REGIONS_MAX) {
        i--;
        if (result->regions[i].total >= region->total)
            return;
    } else {
        result->regions_kept++;
    }
    for (; i > 0 && result->regions[i - 1].total < region->total; i--)
        result->regions[i] = result->regions[i - 1];
    result->regions[i] = *region;
}

lr_status compare_regions(const compare_pair *pair, const lr_compare_options *options,
                          const float *errors, bool flip, lr_compare_result *result,
                          lr_error *error)
{
    size_t count = (size_t)pair->width * pair->height;
    flood f = {.width = pair->width, .height = pair->height};
    f.marks = lr_alloc(count, 1);
    f.stack = lr_alloc(count, sizeof *f.stack);
    lr_status status = LR_OK;
    if (!f.marks || !f.stack) {
        status = lr_fail(error, LR_ERROR_MEMORY, "out of memory for the regions that differ");
        goto done;
    }
    for (size_t i = 0; i < count; i++)
        f.marks[i] = compare_is_used(pair, i) && is_marked(pair, options, errors, flip, i);
    for (size_t i = 0; i < count; i++)
        if (f.marks[i]) {
            lr_region region = take_region(&f, i, errors);
            keep_region(result, &region);
            result->region_count++;
        }
done:
    free(f.marks);
    free(f.stack);
    return status;
}
