/* Causes that show in how the difference varies from pixel to pixel. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vec.h"
#include "compare/approx.h"
#include "compare/cause.h"
#include "compare/filter.h"

static float difference(const cause_view *view, uint32_t x, uint32_t y)
{
    size_t i = (size_t)y * view->width + x;
    return view->test[i] - view->reference[i];
}

enum { LEVELS = 65536, BLOCK = 8 };

static uint32_t level_of(float value)
{
    return (uint32_t)(approx_min(approx_max(value, 0), 1) * (LEVELS - 1) + 0.5f);
}

/* How many different levels a picture has, or some number above `most`. */
static uint32_t count_levels(const compare_pair *pair, const float *picture, unsigned char *seen,
                             uint32_t most)
{
    size_t count = (size_t)pair->width * pair->height;
    uint32_t levels = 0;
    memset(seen, 0, LEVELS);
    for (size_t i = 0; i < count && levels <= most; i++)
        for (uint32_t c = 0; c < pair->colors; c++) {
            unsigned char *level = &seen[level_of(picture[i * pair->stride + c])];
            levels += !*level;
            *level = 1;
        }
    return levels;
}

/* Differences of one step in many pixels; or one picture with far fewer levels than the other, and
 * differences below the distance of two. */
bool cause_is_rounding(const cause_view *view, lr_compare_result *result, bool *out_of_memory)
{
    const compare_pair *pair = view->pair;
    if (pair->linear || 20 * result->different_pixels < result->compared)
        return false;
    if (pair->maxval && result->max_difference * pair->maxval < 1.5)
        return cause_found(result, LR_CAUSE_ROUNDING, 1);
    double most = 1 + 1.01 / result->max_difference;
    unsigned char *seen = lr_alloc(LEVELS, 1);
    if (!seen || !(most < LEVELS)) {
        *out_of_memory |= !seen;
        free(seen);
        return false;
    }
    bool coarse = false;
    for (int i = 0; i < 2 && !coarse; i++) {
        const float *few = i ? pair->reference : pair->test;
        const float *many = i ? pair->test : pair->reference;
        uint32_t levels = count_levels(pair, few, seen, (uint32_t)most);
        coarse = levels <= (uint32_t)most && count_levels(pair, many, seen, LEVELS) >= 2 * levels;
    }
    free(seen);
    return coarse && cause_found(result, LR_CAUSE_ROUNDING, 1);
}

/* How much of the difference is a multiple of what a Gaussian does to the reference; the multiple
 * is positive for a blur and negative for an unsharp mask. */
static double blur_share(const cause_view *view, const float *blurred, double *factor)
{
    double du = 0, uu = 0;
    size_t count = (size_t)view->width * view->height, size = filter_row_size(view->width);
    for (size_t i = 0; i < count; i++) {
        double r = (double)view->reference[i];
        double u = (double)blurred[i / view->width * size + i % view->width] - r;
        du += ((double)view->test[i] - r) * u;
        uu += u * u;
    }
    *factor = uu > 0 ? du / uu : 0;
    return uu > 0 && view->energy > 0 ? du * du / (uu * view->energy) : 0;
}

bool cause_is_blur(const cause_view *view, lr_compare_result *result, bool *out_of_memory)
{
    const double enough = 0.85;
    /* What Gaussians of different widths take away looks much alike, so the first one tells whether
     * it is worth trying the others. */
    const double hopeless = 0.15;
    static const double sigmas[] = {1.5, 0.5, 0.75, 1, 2.5, 4};
    float *blurred = lr_alloc((size_t)filter_row_size(view->width) * view->height, sizeof *blurred);
    double best = 0, factor = 0;
    for (size_t i = 0; i < sizeof sigmas / sizeof *sigmas && blurred; i++) {
        if (i > 0 && best < hopeless)
            break;
        filter_kernel kernel;
        filter_gaussian(&kernel, sigmas[i], (uint32_t)(3 * sigmas[i] + 1));
        if (!filter_plane(blurred, view->reference, view->width, view->height, &kernel)) {
            *out_of_memory = true;
            break;
        }
        double f, share = blur_share(view, blurred, &f);
        if (share > best) {
            best = share;
            factor = f;
        }
    }
    *out_of_memory |= !blurred;
    free(blurred);
    return best >= enough &&
           cause_found(result, factor > 0 ? LR_CAUSE_BLUR : LR_CAUSE_SHARPEN, best);
}

/* The sum of the absolute high frequencies, u + v >= 8, of a picture's 8 x 8 blocks, the first at
 * offset, offset. */
static double high_frequencies(const cause_view *view, const float *picture, uint32_t offset)
{
    double cosines[BLOCK][BLOCK], sum = 0;
    for (int x = 0; x < BLOCK; x++)
        for (int u = 0; u < BLOCK; u++) {
            double sine;
            lr_sincos_degrees((2 * x + 1) * u * 11.25, &sine, &cosines[x][u]);
        }
    for (uint32_t y = offset; y + BLOCK <= view->height; y += BLOCK)
        for (uint32_t x = offset; x + BLOCK <= view->width; x += BLOCK) {
            double rows[BLOCK][BLOCK] = {{0}};
            for (int v = 0; v < BLOCK; v++)
                for (int u = 1; u < BLOCK; u++)
                    for (int k = 0; k < BLOCK; k++)
                        rows[v][u] +=
                            (double)picture[(size_t)(y + v) * view->width + x + k] * cosines[k][u];
            for (int u = 1; u < BLOCK; u++)
                for (int v = BLOCK - u; v < BLOCK; v++) {
                    double c = 0;
                    for (int k = 0; k < BLOCK; k++)
                        c += rows[k][u] * cosines[k][v];
                    sum += fabs(c);
                }
        }
    return sum;
}

/* Block codecs leave out high frequencies on their own grid; on a grid half a block aside the jumps
 * between the blocks bring them back. */
static double block_ratio(const cause_view *view, const float *picture)
{
    double aside = high_frequencies(view, picture, BLOCK / 2);
    return aside > 0 ? high_frequencies(view, picture, 0) / aside : 1;
}

bool cause_is_blocks(const cause_view *view, lr_compare_result *result, bool *out_of_memory)
{
    (void)out_of_memory;
    if (view->width < 3 * BLOCK || view->height < 3 * BLOCK ||
        2 * result->different_pixels < result->compared)
        return false;
    double ratio = block_ratio(view, view->test) / block_ratio(view, view->reference);
    return ratio < 0.8 && cause_found(result, LR_CAUSE_BLOCKS, 1 - ratio);
}

static float contrast(const cause_view *view, uint32_t x, uint32_t y)
{
    const float *p = view->reference + (size_t)y * view->width + x;
    float largest = 0;
    if (x > 0)
        largest = approx_max(largest, fabsf(p[0] - p[-1]));
    if (x + 1 < view->width)
        largest = approx_max(largest, fabsf(p[0] - p[1]));
    if (y > 0)
        largest = approx_max(largest, fabsf(p[0] - *(p - view->width)));
    if (y + 1 < view->height)
        largest = approx_max(largest, fabsf(p[0] - p[view->width]));
    return largest;
}

/* Nearly all of the difference within a pixel of the reference's edges, which are not everywhere.
 */
bool cause_is_edges(const cause_view *view, lr_compare_result *result, bool *out_of_memory)
{
    const float edge_contrast = 0.06f;
    uint32_t width = view->width, height = view->height;
    size_t count = (size_t)width * height;
    unsigned char *near = lr_alloc(count, 1);
    if (!near) {
        *out_of_memory = true;
        return false;
    }
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            if (contrast(view, x, y) < edge_contrast)
                continue;
            for (uint32_t v = y > 0 ? y - 1 : 0; v <= y + 1 && v < height; v++)
                for (uint32_t u = x > 0 ? x - 1 : 0; u <= x + 1 && u < width; u++)
                    near[(size_t)v * width + u] = 1;
        }
    double sum = 0;
    size_t pixels = 0, differing = 0;
    for (size_t i = 0; i < count; i++)
        if (near[i]) {
            double d = (double)view->test[i] - (double)view->reference[i];
            sum += d * d;
            pixels++;
            differing += fabs(d) > 0.01;
        }
    free(near);
    double share = view->energy > 0 ? sum / view->energy : 0;
    return share > 0.95 && 2 * pixels < count && 5 * differing > pixels &&
           cause_found(result, LR_CAUSE_EDGES, share);
}

/* The correlation of the difference with itself one pixel on. */
static double correlation(const cause_view *view, uint32_t dx, uint32_t dy)
{
    double sum = 0;
    for (uint32_t y = dy; y < view->height; y++)
        for (uint32_t x = dx; x < view->width; x++)
            sum += (double)(difference(view, x, y) * difference(view, x - dx, y - dy));
    return view->energy > 0 ? sum / view->energy : 1;
}

bool cause_is_noise(const cause_view *view, lr_compare_result *result, bool *out_of_memory)
{
    (void)out_of_memory;
    double largest = fmax(fabs(correlation(view, 1, 0)), fabs(correlation(view, 0, 1)));
    return largest < 0.25 && cause_found(result, LR_CAUSE_NOISE, 1 - largest);
}
