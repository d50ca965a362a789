#include "render/noise.h"

#include <stdlib.h>

#include "base/memory.h"

#define BORDER 8u /* pixels around a block that count, so that blocks side by side agree */

#define DARK 1e-4 /* light; darker pixels are taken for this bright */

lr_status lr_noise_create(lr_noise *noise, const lr_sums *sums, lr_error *error)
{
    *noise = (lr_noise){
        .width = sums->width,
        .height = sums->height,
        .across = (sums->width + LR_NOISE_BLOCK - 1) / LR_NOISE_BLOCK,
        .down = (sums->height + LR_NOISE_BLOCK - 1) / LR_NOISE_BLOCK,
    };
    noise->halves = lr_alloc((size_t)noise->width * noise->height, 3 * sizeof *noise->halves);
    noise->stopped = lr_alloc((size_t)noise->across * noise->down, sizeof *noise->stopped);
    return noise->halves && noise->stopped
               ? LR_OK
               : lr_fail(error, LR_ERROR_MEMORY, "not enough memory for the noise of %ux%u pixels",
                         noise->width, noise->height);
}

void lr_noise_free(lr_noise *noise)
{
    free(noise->halves);
    free(noise->stopped);
    *noise = (lr_noise){0};
}

void lr_noise_keep(lr_noise *noise, const lr_sums *sums)
{
    uint64_t *half = noise->halves;
    for (uint32_t y = 0; y < noise->height; y++)
        for (uint32_t x = 0; x < noise->width; x++, half += 3)
            for (uint32_t channel = 0; channel < 3; channel++)
                if (!lr_noise_stopped(noise, x, y))
                    half[channel] = lr_film_sum(lr_sums_pixel(sums, x, y), channel);
}

/* The squared error of a pixel's light over its brightness, the three channels together. Channels
 * beyond the film's range cannot become better. */
static double pixel_noise(const uint32_t *pixel, const uint64_t *half)
{
    const double step = 1.0 / (double)(1ull << LR_FILM_STEP_BITS);
    double samples = pixel[LR_FILM_SAMPLES], error = 0, light = 0;
    for (uint32_t channel = 0; channel < 3; channel++) {
        if (pixel[LR_FILM_FLAGS] & 1u << channel)
            continue;
        double all = (double)lr_film_sum(pixel, channel) * step / samples;
        double first = (double)half[channel] * step / (samples / 2);
        error += (all - first) * (all - first);
        light += all / 3;
    }
    return error / (light > DARK ? light : DARK);
}

/* The square of the noise of a block. */
static double block_noise(const lr_noise *noise, const lr_sums *sums, uint32_t column, uint32_t row)
{
    uint32_t x0 = column * LR_NOISE_BLOCK, y0 = row * LR_NOISE_BLOCK;
    uint32_t x1 = x0 + LR_NOISE_BLOCK + BORDER, y1 = y0 + LR_NOISE_BLOCK + BORDER;
    x0 = x0 > BORDER ? x0 - BORDER : 0;
    y0 = y0 > BORDER ? y0 - BORDER : 0;
    x1 = x1 < noise->width ? x1 : noise->width;
    y1 = y1 < noise->height ? y1 : noise->height;
    double sum = 0;
    for (uint32_t y = y0; y < y1; y++)
        for (uint32_t x = x0; x < x1; x++)
            sum += pixel_noise(lr_sums_pixel(sums, x, y),
                               &noise->halves[3 * ((size_t)y * noise->width + x)]);
    return sum / (3.0 * (x1 - x0) * (y1 - y0));
}

static uint64_t pixels_in(const lr_noise *noise, uint32_t column, uint32_t row)
{
    uint32_t right = noise->width - column * LR_NOISE_BLOCK;
    uint32_t below = noise->height - row * LR_NOISE_BLOCK;
    return (uint64_t)(right < LR_NOISE_BLOCK ? right : LR_NOISE_BLOCK) *
           (below < LR_NOISE_BLOCK ? below : LR_NOISE_BLOCK);
}

uint64_t lr_noise_decide(lr_noise *noise, const lr_sums *sums, double target)
{
    uint64_t left = 0;
    for (uint32_t row = 0; row < noise->down; row++)
        for (uint32_t column = 0; column < noise->across; column++) {
            bool *stopped = &noise->stopped[row * noise->across + column];
            *stopped = *stopped || block_noise(noise, sums, column, row) < target * target;
            left += *stopped ? 0 : pixels_in(noise, column, row);
        }
    return left;
}
