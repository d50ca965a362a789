/* Where a picture needs no more samples: an estimate of the noise of its blocks, from exact sums
 * alone, so that the same blocks stop on every device, however the work is cut up. */
#ifndef LR_RENDER_NOISE_H
#define LR_RENDER_NOISE_H

#include "render/sums.h"

#define LR_NOISE_BLOCK 16u /* pixels along a block's side */
#define LR_NOISE_FIRST                                                                             \
    16u /* samples at the first decision; the others are at the double of one                      \
         */

typedef struct lr_noise {
    uint32_t width, height, across, down;
    uint64_t *halves; /* the sums of each pixel, 3 of them, at half of its samples */
    bool *stopped;    /* of each block */
} lr_noise;

lr_status lr_noise_create(lr_noise *noise, const lr_sums *sums, lr_error *error);
void lr_noise_free(lr_noise *noise);

static inline bool lr_noise_stopped(const lr_noise *noise, uint32_t x, uint32_t y)
{
    return noise->stopped[y / LR_NOISE_BLOCK * noise->across + x / LR_NOISE_BLOCK];
}

/* Notes the sums of the pixels that go on: when they have twice the samples, these are the halves.
 */
void lr_noise_keep(lr_noise *noise, const lr_sums *sums);

/* Stops the blocks whose noise is below `target`, all pixels having twice the samples of their
 * halves. The noise is the root of the mean, over the block and some pixels around it and the three
 * channels, of the squared error of a pixel's light divided by its brightness: about the error in
 * square roots of light, which is how files hold it (after Dammertz, Hanika, Keller and Lensch, "A
 * Hierarchical Automatic Stopping Condition for Monte Carlo Global Illumination", WSCG 2010). The
 * error is estimated by the difference to the half: for independent samples that has the variance
 * of the mean of all. Returns the number of pixels that go on. */
uint64_t lr_noise_decide(lr_noise *noise, const lr_sums *sums, double target);

#endif
