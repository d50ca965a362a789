/* How much the ranges of a pixel's samples differ, and so how far the pixel may be off. */
#ifndef LR_RENDER_SPREAD_H
#define LR_RENDER_SPREAD_H

#include <stdint.h>

/* Zeroed: of no range yet. */
typedef struct lr_spread {
    double mean[3];    /* of all samples */
    double squares[3]; /* sum over the ranges of samples * (their mean - mean)^2 */
    uint32_t samples, ranges;
} lr_spread;

/* Adds a range: LR_FILM_WORDS words of its film, with a sample or more. The order counts. */
void lr_spread_add(lr_spread *spread, const uint32_t *film);

/* The variance of the mean of all samples, by channel, were the samples independent; 0 for less
 * than two ranges. */
void lr_spread_variance(const lr_spread *spread, float variance[3]);

#endif
