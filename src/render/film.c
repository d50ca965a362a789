#include "render/film.h"

float lr_film_mean(uint64_t sum, uint32_t samples)
{
    return (float)((double)sum / (double)(1ull << LR_FILM_STEP_BITS) / samples);
}

float lr_film_overflow(uint32_t samples)
{
    return (float)(LR_FILM_MAX / samples);
}

void lr_film_resolve(const uint32_t *film, uint32_t pixels, float *out)
{
    for (uint32_t i = 0; i < pixels; i++, film += LR_FILM_WORDS)
        for (uint32_t channel = 0; channel < 3; channel++) {
            uint32_t samples = film[LR_FILM_SAMPLES];
            if (samples == 0)
                *out++ = 0;
            else if (film[LR_FILM_FLAGS] & 1u << channel)
                *out++ = lr_film_overflow(samples);
            else
                *out++ = lr_film_mean(lr_film_sum(film, channel), samples);
        }
}

void lr_film_add(uint32_t *pixel, const uint32_t *other)
{
    for (uint32_t channel = 0; channel < 3; channel++) {
        uint64_t own = lr_film_sum(pixel, channel), sum = own + lr_film_sum(other, channel);
        pixel[2 * channel] = (uint32_t)sum;
        pixel[2 * channel + 1] = (uint32_t)(sum >> 32);
        if (sum < own)
            pixel[LR_FILM_FLAGS] |= 1u << channel;
    }
    pixel[LR_FILM_FLAGS] |= other[LR_FILM_FLAGS];
    pixel[LR_FILM_SAMPLES] += other[LR_FILM_SAMPLES];
}
