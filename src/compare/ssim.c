/* Z. Wang, A. Bovik, H. Sheikh, E. Simoncelli, "Image Quality Assessment: From Error Visibility to
 * Structural Similarity", 2004: Gaussian window of 11 x 11 with sigma 1.5, K1 = 0.01, K2 = 0.03, of
 * the luma 0.2126 R + 0.7152 G + 0.0722 B. As in the paper, only windows wholly inside the picture
 * count, unless it is smaller than a window. */
#include <stdlib.h>

#include "base/memory.h"
#include "compare/compare_internal.h"
#include "compare/filter.h"

enum { RADIUS = 5, ROWS = 2 * RADIUS + 1 };
enum { A, B, AA, BB, AB, PLANES };

typedef struct ssim_rows {
    float *memory;
    float *row[PLANES];  /* padded */
    float *ring[PLANES]; /* horizontally filtered */
    float *mean[PLANES];
    uint32_t size, next;
} ssim_rows;

static float luma(const compare_pair *pair, const float *p)
{
    float sum = pair->colors == 3 ? 0.2126f * p[0] + 0.7152f * p[1] + 0.0722f * p[2] : p[0];
    return sum - sum == 0 ? sum : 0; /* not finite: as black */
}

static void read_row(ssim_rows *rows, const compare_pair *pair, const filter_kernel *kernel)
{
    uint32_t y = rows->next++;
    size_t start = (size_t)y * pair->width * pair->stride;
    float scale = (float)(1 / pair->peak);
    float *in[PLANES];
    for (int i = 0; i < PLANES; i++)
        in[i] = rows->row[i] + RADIUS;
    for (uint32_t x = 0; x < pair->width; x++) {
        float a = luma(pair, pair->reference + start + x * pair->stride) * scale;
        float b = luma(pair, pair->test + start + x * pair->stride) * scale;
        in[A][x] = a;
        in[B][x] = b;
        in[AA][x] = a * a;
        in[BB][x] = b * b;
        in[AB][x] = a * b;
    }
    for (int i = 0; i < PLANES; i++) {
        filter_pad(in[i], pair->width, RADIUS);
        filter_along(rows->ring[i] + (size_t)(y % ROWS) * rows->size, in[i], pair->width, kernel);
    }
}

static void make_row(ssim_rows *rows, const compare_pair *pair, const filter_kernel *kernel,
                     uint32_t y)
{
    while (rows->next < pair->height && rows->next <= y + RADIUS)
        read_row(rows, pair, kernel);
    for (int i = 0; i < PLANES; i++) {
        const float *pointers[ROWS];
        for (int k = -RADIUS; k <= RADIUS; k++) {
            int64_t row = (int64_t)y + k, last = (int64_t)pair->height - 1;
            row = row < 0 ? 0 : row > last ? last : row;
            pointers[k + RADIUS] = rows->ring[i] + (size_t)(row % ROWS) * rows->size;
        }
        filter_across(rows->mean[i], pointers + RADIUS, pair->width, kernel);
    }
}

static double similarity(const ssim_rows *rows, uint32_t x)
{
    const double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
    double a = rows->mean[A][x], b = rows->mean[B][x];
    double variance = rows->mean[AA][x] - a * a + rows->mean[BB][x] - b * b;
    double covariance = rows->mean[AB][x] - a * b;
    return (2 * a * b + c1) * (2 * covariance + c2) / ((a * a + b * b + c1) * (variance + c2));
}

static bool create_rows(ssim_rows *rows, uint32_t width)
{
    size_t size = filter_row_size(width), padded = size + 2 * RADIUS;
    *rows = (ssim_rows){.size = (uint32_t)size};
    rows->memory = lr_alloc(PLANES * (padded + (ROWS + 1) * size), sizeof(float));
    float *next = rows->memory;
    for (int i = 0; next && i < PLANES; i++) {
        rows->row[i] = next;
        rows->ring[i] = next + padded;
        rows->mean[i] = rows->ring[i] + ROWS * size;
        next = rows->mean[i] + size;
    }
    return rows->memory;
}

lr_status compare_ssim(const compare_pair *pair, double *mean, lr_error *error)
{
    filter_kernel kernel;
    ssim_rows rows;
    filter_gaussian(&kernel, 1.5, RADIUS);
    if (!create_rows(&rows, pair->width))
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for SSIM");
    uint32_t border = pair->width < ROWS || pair->height < ROWS ? 0 : RADIUS;
    double sum = 0;
    uint64_t count = 0;
    for (uint32_t y = border; y < pair->height - border; y++) {
        make_row(&rows, pair, &kernel, y);
        for (uint32_t x = border; x < pair->width - border; x++)
            if (compare_is_used(pair, (size_t)y * pair->width + x)) {
                sum += similarity(&rows, x);
                count++;
            }
    }
    free(rows.memory);
    *mean = count ? sum / (double)count : 1;
    return LR_OK;
}
