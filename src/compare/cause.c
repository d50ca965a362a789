/* Why two pictures differ: each cause is tried in turn, and the first that explains nearly all of
 * the difference is taken. Here: those that need no search. */
#include "compare/cause.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "compare/approx.h"

/* The share of the squared difference that a cause must explain. */
#define ENOUGH 0.9

enum { BLOCK = 8 }; /* pixels along the side of the blocks that "local" is measured in */

static const char *const names[LR_CAUSE_COUNT] = {
    "none",     "unknown", "alpha", "shift",   "mirror", "channels", "color",
    "rounding", "noise",   "blur",  "sharpen", "blocks", "edges",    "local",
};

const char *lr_cause_name(lr_cause cause)
{
    return names[cause];
}

static float or_zero(float x)
{
    return x - x == 0 ? x : 0;
}

static bool is_alpha(const cause_view *view, lr_compare_result *result, bool *out_of_memory)
{
    (void)out_of_memory;
    const compare_pair *pair = view->pair;
    size_t count = (size_t)view->width * view->height;
    for (size_t i = 0; i < count; i++)
        for (uint32_t c = 0; c < pair->colors; c++)
            if (compare_difference(pair, pair->reference[i * pair->stride + c],
                                   pair->test[i * pair->stride + c]) != 0)
                return false;
    return cause_found(result, LR_CAUSE_ALPHA, 1);
}

/* Square of the test's difference to the reference with its pixels or channels moved. */
typedef struct rearranged {
    bool across, down;
    uint8_t order[3];
} rearranged;

static double squares(const cause_view *view, rearranged r, double stop)
{
    const compare_pair *pair = view->pair;
    double sum = 0;
    for (uint32_t y = 0; y < view->height && sum <= stop; y++) {
        size_t row = (size_t)(r.down ? view->height - 1 - y : y) * view->width;
        for (uint32_t x = 0; x < view->width; x++) {
            size_t from = row + (r.across ? view->width - 1 - x : x);
            const float *reference = pair->reference + from * pair->stride;
            const float *test = pair->test + ((size_t)y * view->width + x) * pair->stride;
            for (uint32_t c = 0; c < pair->colors; c++) {
                double d = (double)or_zero(test[c]) - (double)or_zero(reference[r.order[c]]);
                sum += d * d;
            }
        }
    }
    return sum;
}

static bool is_mirrored(const cause_view *view, lr_compare_result *result, bool *out_of_memory)
{
    (void)out_of_memory;
    rearranged r = {.order = {0, 1, 2}};
    double all = view->sample_energy, allowed = (1 - ENOUGH) * all;
    for (int way = 1; way <= 3; way++) {
        r.across = way & 1;
        r.down = way & 2;
        double rest = squares(view, r, allowed);
        if (rest > allowed)
            continue;
        result->dx = r.across;
        result->dy = r.down;
        return cause_found(result, LR_CAUSE_MIRROR, 1 - rest / all);
    }
    return false;
}

static bool is_channels(const cause_view *view, lr_compare_result *result, bool *out_of_memory)
{
    (void)out_of_memory;
    static const uint8_t orders[5][3] = {{2, 1, 0}, {1, 0, 2}, {0, 2, 1}, {1, 2, 0}, {2, 0, 1}};
    if (view->pair->colors != 3)
        return false;
    rearranged r = {.order = {0, 1, 2}};
    double all = view->sample_energy, allowed = (1 - ENOUGH) * all;
    for (int i = 0; i < 5; i++) {
        memcpy(r.order, orders[i], sizeof r.order);
        double rest = squares(view, r, allowed);
        if (rest > allowed)
            continue;
        memcpy(result->order, orders[i], sizeof result->order);
        return cause_found(result, LR_CAUSE_CHANNELS, 1 - rest / all);
    }
    return false;
}

/* Marks blocks, then counts how many groups of touching blocks there are. */
static uint32_t count_groups(unsigned char *blocks, uint32_t columns, uint32_t rows,
                             uint32_t *stack)
{
    uint32_t groups = 0;
    for (uint32_t start = 0; start < columns * rows; start++) {
        if (!blocks[start])
            continue;
        uint32_t waiting = 0;
        groups++;
        blocks[start] = 0;
        stack[waiting++] = start;
        while (waiting > 0) {
            uint32_t at = stack[--waiting], x = at % columns, y = at / columns;
            for (uint32_t v = y > 0 ? y - 1 : 0; v <= y + 1 && v < rows; v++)
                for (uint32_t u = x > 0 ? x - 1 : 0; u <= x + 1 && u < columns; u++)
                    if (blocks[v * columns + u]) {
                        blocks[v * columns + u] = 0;
                        stack[waiting++] = v * columns + u;
                    }
        }
    }
    return groups;
}

/* Few places, and less than half of the picture. */
static bool is_local(const cause_view *view, lr_compare_result *result, bool *out_of_memory)
{
    uint32_t columns = (view->width + BLOCK - 1) / BLOCK, rows = (view->height + BLOCK - 1) / BLOCK;
    unsigned char *blocks = lr_alloc((size_t)columns * rows, 1);
    uint32_t *stack = lr_alloc((size_t)columns * rows, sizeof *stack), marked = 0, groups = 0;
    if (!blocks || !stack) {
        *out_of_memory = true;
        goto done;
    }
    for (uint32_t y = 0; y < view->height; y++)
        for (uint32_t x = 0; x < view->width; x++)
            if (compare_largest(view->pair, (size_t)y * view->width + x) > 0)
                blocks[(y / BLOCK) * columns + x / BLOCK] = 1;
    for (uint32_t i = 0; i < columns * rows; i++)
        marked += blocks[i];
    groups = count_groups(blocks, columns, rows, stack);
done:
    free(blocks);
    free(stack);
    if (groups == 0 || groups > 8 || (marked > 1 && 2 * marked > columns * rows))
        return false;
    return cause_found(result, LR_CAUSE_LOCAL, 1);
}

static bool make_view(const compare_pair *pair, cause_view *view)
{
    size_t count = (size_t)pair->width * pair->height;
    *view = (cause_view){.pair = pair, .width = pair->width, .height = pair->height};
    view->reference = lr_alloc(count, sizeof(float));
    view->test = lr_alloc(count, sizeof(float));
    if (!view->reference || !view->test)
        return false;
    for (size_t i = 0; i < count; i++) {
        float luma[2];
        const float *samples[2] = {pair->reference + i * pair->stride,
                                   pair->test + i * pair->stride};
        for (int k = 0; k < 2; k++) {
            const float *s = samples[k];
            luma[k] = pair->colors == 3 ? 0.2126f * or_zero(s[0]) + 0.7152f * or_zero(s[1]) +
                                              0.0722f * or_zero(s[2])
                                        : or_zero(s[0]);
            if (pair->linear) {
                float light = approx_max(or_zero(luma[k]), 0);
                luma[k] = approx_power(light / (1 + light), 1 / 2.2f);
            }
        }
        view->reference[i] = luma[0];
        view->test[i] = luma[1];
        double d = (double)luma[1] - (double)luma[0];
        view->energy += d * d;
    }
    return true;
}

lr_status compare_explain(const compare_pair *pair, lr_compare_result *result, lr_error *error)
{
    static bool (*const detectors[])(const cause_view *, lr_compare_result *, bool *) = {
        is_alpha,          is_mirrored,     is_channels,    cause_is_shift,
        cause_is_color,    cause_is_blur,   cause_is_edges, is_local,
        cause_is_rounding, cause_is_blocks, cause_is_noise,
    };
    cause_view view;
    bool out_of_memory = !make_view(pair, &view);
    view.sample_energy = squares(&view, (rearranged){.order = {0, 1, 2}}, 1e300);
    result->cause = LR_CAUSE_UNKNOWN;
    for (size_t i = 0; i < sizeof detectors / sizeof *detectors && !out_of_memory; i++)
        if (detectors[i](&view, result, &out_of_memory))
            break;
    free(view.reference);
    free(view.test);
    if (out_of_memory)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for the cause of the difference");
    return LR_OK;
}
