#include "compare/filter.h"

#include <stdlib.h>
#include <string.h>

#include "base/exact.h"
#include "base/memory.h"

/* Four of these stay in registers: enough sums in flight to hide the latency of an addition. */
typedef float lanes __attribute__((vector_size(16)));

enum { VECTORS = FILTER_LANES / 4 };

static lanes load(const float *p)
{
    lanes v;
    memcpy(&v, p, sizeof v);
    return v;
}

static void store(float *p, lanes v)
{
    memcpy(p, &v, sizeof v);
}

double filter_gaussian(filter_kernel *kernel, double sigma, uint32_t radius)
{
    *kernel = (filter_kernel){0};
    double w[FILTER_RADIUS_MAX + 1], sum = 0;
    for (uint32_t k = 0; k <= radius; k++) {
        w[k] = lr_exp2(-0.72134752044448170 * k * k / (sigma * sigma)); /* log2(e) / 2 */
        sum += k == 0 ? w[k] : 2 * w[k];
        if (w[k] > 1e-6)
            kernel->radius = k;
    }
    for (uint32_t k = 0; k <= kernel->radius; k++)
        kernel->w[k] = (float)(w[k] / sum);
    return sum;
}

uint32_t filter_row_size(uint32_t width)
{
    return (width + FILTER_LANES - 1) / FILTER_LANES * FILTER_LANES;
}

void filter_pad(float *center, uint32_t width, uint32_t radius)
{
    for (uint32_t k = 1; k <= radius; k++)
        center[-(int64_t)k] = center[0];
    for (uint32_t x = width; x < filter_row_size(width) + radius; x++)
        center[x] = center[width - 1];
}

void filter_along(float *out, const float *center, uint32_t width, const filter_kernel *kernel)
{
    for (uint32_t x = 0; x < width; x += FILTER_LANES) {
        const float *in = center + x;
        lanes sum[VECTORS];
        for (int i = 0; i < VECTORS; i++)
            sum[i] = kernel->w[0] * load(in + 4 * i);
        if (kernel->odd)
            for (uint32_t k = 1; k <= kernel->radius; k++)
                for (int i = 0; i < VECTORS; i++)
                    sum[i] += kernel->w[k] * (load(in + k + 4 * i) - load(in - k + 4 * i));
        else
            for (uint32_t k = 1; k <= kernel->radius; k++)
                for (int i = 0; i < VECTORS; i++)
                    sum[i] += kernel->w[k] * (load(in + k + 4 * i) + load(in - k + 4 * i));
        for (int i = 0; i < VECTORS; i++)
            store(out + x + 4 * i, sum[i]);
    }
}

void filter_across(float *out, const float *const *middle, uint32_t width,
                   const filter_kernel *kernel)
{
    for (uint32_t x = 0; x < width; x += FILTER_LANES) {
        lanes sum[VECTORS];
        for (int i = 0; i < VECTORS; i++)
            sum[i] = kernel->w[0] * load(middle[0] + x + 4 * i);
        for (uint32_t k = 1; k <= kernel->radius; k++) {
            const float *above = middle[-(int32_t)k] + x, *below = middle[k] + x;
            if (kernel->odd)
                for (int i = 0; i < VECTORS; i++)
                    sum[i] += kernel->w[k] * (load(below + 4 * i) - load(above + 4 * i));
            else
                for (int i = 0; i < VECTORS; i++)
                    sum[i] += kernel->w[k] * (load(below + 4 * i) + load(above + 4 * i));
        }
        for (int i = 0; i < VECTORS; i++)
            store(out + x + 4 * i, sum[i]);
    }
}

bool filter_plane(float *out, const float *in, uint32_t width, uint32_t height,
                  const filter_kernel *kernel)
{
    uint32_t radius = kernel->radius;
    size_t size = filter_row_size(width);
    float *along = lr_alloc(size * height, sizeof *along);
    float *padded = lr_alloc(size + 2 * radius, sizeof *padded);
    for (uint32_t y = 0; along && padded && y < height; y++) {
        memcpy(padded + radius, in + (size_t)y * width, width * sizeof *in);
        filter_pad(padded + radius, width, radius);
        filter_along(along + y * size, padded + radius, width, kernel);
    }
    for (uint32_t y = 0; along && padded && y < height; y++) {
        const float *rows[2 * FILTER_RADIUS_MAX + 1];
        for (uint32_t k = 0; k <= 2 * radius; k++) {
            int64_t row = (int64_t)y + k - radius;
            row = row < 0 ? 0 : row >= height ? height - 1 : row;
            rows[k] = along + (size_t)row * size;
        }
        filter_across(out + y * size, rows + radius, width, kernel);
    }
    bool done = along && padded;
    free(along);
    free(padded);
    return done;
}
