/* The integer film on the host; its format is in gpu_layout.h. */
#ifndef LR_RENDER_FILM_H
#define LR_RENDER_FILM_H

#include <stdint.h>

#include "gpu_layout.h"

/* The sum of a pixel's channel, in film steps; modulo 2^64 where its flag says that it overflowed.
 */
static inline uint64_t lr_film_sum(const uint32_t *pixel, uint32_t channel)
{
    return pixel[2 * channel] | (uint64_t)pixel[2 * channel + 1] << 32;
}

/* The mean of samples > 0 contributions that sum up to `sum` film steps. Every step of it is
 * correctly rounded in double, and it never falls when the sum grows. */
float lr_film_mean(uint64_t sum, uint32_t samples);

/* ... and of as many whose sum is beyond the film's range. */
float lr_film_overflow(uint32_t samples);

/* The linear values of `pixels` pixels, LR_FILM_WORDS words each, into 3 floats each; black where
 * there is no sample yet. */
void lr_film_resolve(const uint32_t *film, uint32_t pixels, float *out);

/* Adds the sums, flags and samples of one pixel to another's. The order of additions changes
 * nothing that lr_film_resolve tells. */
void lr_film_add(uint32_t *pixel, const uint32_t *other);

#endif
