/* A shift of the whole picture: the best one is looked for in smaller and smaller halves of the
 * pictures and refined on the way back. */
#include <stdlib.h>

#include "base/memory.h"
#include "compare/cause.h"

/* The share of the mean squared difference that a shift must explain. */
#define ENOUGH 0.75

enum { LEVELS_MAX = 12, SMALLEST = 24, COARSE_RANGE = 6, FINE_RANGE = 2 };

typedef struct level {
    uint32_t width, height;
    const float *reference, *test;
} level;

static void halve(const float *in, uint32_t width, float *out, uint32_t out_width,
                  uint32_t out_height)
{
    for (uint32_t y = 0; y < out_height; y++)
        for (uint32_t x = 0; x < out_width; x++) {
            const float *p = in + (size_t)2 * y * width + 2 * x;
            out[(size_t)y * out_width + x] = (p[0] + p[1] + p[width] + p[width + 1]) / 4;
        }
}

/* The mean squared difference where the shifted pictures overlap; 1e300 when there is too little of
 * that, or when it is sure to be more than `enough`. */
static double mean_square(const level *l, int32_t dx, int32_t dy, double enough)
{
    int32_t width = (int32_t)l->width, height = (int32_t)l->height;
    int32_t x0 = dx > 0 ? dx : 0, x1 = dx < 0 ? width + dx : width;
    int32_t y0 = dy > 0 ? dy : 0, y1 = dy < 0 ? height + dy : height;
    if (2 * (x1 - x0) < width || 2 * (y1 - y0) < height)
        return 1e300;
    double sum = 0, pixels = (double)(x1 - x0) * (y1 - y0);
    for (int32_t y = y0; y < y1; y++) {
        if (sum > enough * pixels)
            return 1e300;
        const float *test = l->test + (size_t)y * l->width;
        const float *reference = l->reference + (ptrdiff_t)(y - dy) * width - dx;
        float row = 0;
        for (int32_t x = x0; x < x1; x++) {
            float d = test[x] - reference[x];
            row += d * d;
        }
        sum += (double)row;
    }
    return sum / pixels;
}

static double refine(const level *l, int32_t range, int32_t *dx, int32_t *dy)
{
    int32_t from_x = *dx, from_y = *dy;
    double best = mean_square(l, from_x, from_y, 1e300);
    for (int32_t y = from_y - range; y <= from_y + range; y++)
        for (int32_t x = from_x - range; x <= from_x + range; x++) {
            double here = mean_square(l, x, y, best);
            if (here < best) {
                best = here;
                *dx = x;
                *dy = y;
            }
        }
    return best;
}

bool cause_is_shift(const cause_view *view, lr_compare_result *result, bool *out_of_memory)
{
    level levels[LEVELS_MAX] = {{view->width, view->height, view->reference, view->test}};
    size_t room = 0;
    int count = 1;
    for (; count < LEVELS_MAX; count++) {
        level *l = &levels[count];
        l->width = levels[count - 1].width / 2;
        l->height = levels[count - 1].height / 2;
        if (l->width < SMALLEST || l->height < SMALLEST)
            break;
        room += 2 * (size_t)l->width * l->height;
    }
    float *memory = lr_alloc(room + 1, sizeof *memory), *next = memory;
    if (!memory) {
        *out_of_memory = true;
        return false;
    }
    for (int i = 1; i < count; i++) {
        level *l = &levels[i];
        size_t size = (size_t)l->width * l->height;
        halve(levels[i - 1].reference, levels[i - 1].width, next, l->width, l->height);
        halve(levels[i - 1].test, levels[i - 1].width, next + size, l->width, l->height);
        l->reference = next;
        l->test = next + size;
        next += 2 * size;
    }
    int32_t dx = 0, dy = 0;
    double rest = 0;
    for (int i = count - 1; i >= 0; i--) {
        dx *= 2;
        dy *= 2;
        int32_t from_x, from_y;
        do {
            from_x = dx;
            from_y = dy;
            rest = refine(&levels[i], i == count - 1 ? COARSE_RANGE : FINE_RANGE, &dx, &dy);
        } while (dx != from_x || dy != from_y);
    }
    double share = 1 - rest / mean_square(&levels[0], 0, 0, 1e300);
    free(memory);
    if ((dx == 0 && dy == 0) || !(share >= ENOUGH))
        return false;
    result->dx = dx;
    result->dy = dy;
    return cause_found(result, LR_CAUSE_SHIFT, share);
}
