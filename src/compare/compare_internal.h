/* What the files of src/compare share. */
#ifndef LR_COMPARE_INTERNAL_H
#define LR_COMPARE_INTERNAL_H

#include "compare/compare.h"

/* Two pictures in one layout. Pixels that are not compared are the same in both. */
typedef struct compare_pair {
    uint32_t width, height;
    uint32_t stride; /* samples from one pixel to the next */
    uint32_t colors; /* 1 or 3, the first of a pixel's samples */
    bool alpha;      /* the sample behind them is compared too */
    bool linear;     /* floats; otherwise sRGB-encoded */
    bool converted;  /* an integer picture met a float one */
    uint32_t maxval; /* of both integer pictures; 0: floats, or not the same */
    double peak;     /* what PSNR and SSIM take for white: 1, or the largest colour of a float
                        reference when that is more */
    const float *reference, *test;
    float *owned[2];     /* copies, where the pictures' own samples would not do */
    unsigned char *used; /* 1 for pixels to compare; NULL: all */
    uint64_t compared;   /* their number, not 0 */
} compare_pair;

/* LR_ERROR_ARGUMENT when the mask has another size or nothing is left to compare. The caller
 * releases the pair in any case. */
lr_status compare_prepare(const lr_image *reference, const lr_image *test,
                          const lr_compare_options *options, compare_pair *pair, lr_error *error);
void compare_release(compare_pair *pair);

static inline bool compare_is_used(const compare_pair *pair, size_t pixel)
{
    return !pair->used || pair->used[pixel];
}

/* The difference of two samples: 0 also for two NaNs, infinite when one is not finite, and of
 * integers with the same maxval the quotient nearest to the true one. */
double compare_difference(const compare_pair *pair, float reference, float test);

/* The same as a share of the larger sample. */
double compare_relative(const compare_pair *pair, float reference, float test);

/* The largest difference of a pixel's samples. */
double compare_largest(const compare_pair *pair, size_t pixel);

/* Whether the rows hold the same bits. */
bool compare_same_row(const compare_pair *pair, uint32_t y);

/* EXACT to PSNR, the first and the largest difference: all that is sums and counts of samples. */
void compare_pixels(const compare_pair *pair, const lr_compare_options *options,
                    lr_compare_result *result);

/* FLIP or, for linear pairs, HDR-FLIP of every pixel, 0..1, into map of width * height. */
lr_status compare_flip(const compare_pair *pair, double ppd, float *map, lr_error *error);

/* The value that `rank` of the values would stand before, were they sorted; none is negative. */
float compare_select(const float *values, size_t count, size_t rank);

/* The mean structural similarity of the compared pixels. */
lr_status compare_ssim(const compare_pair *pair, double *similarity, lr_error *error);

/* Finds the regions that differ; errors are those of the pixels, FLIP's or plain differences. */
lr_status compare_regions(const compare_pair *pair, const lr_compare_options *options,
                          const float *errors, bool flip, lr_compare_result *result,
                          lr_error *error);

/* Finds the cause of a difference that there is. */
lr_status compare_explain(const compare_pair *pair, lr_compare_result *result, lr_error *error);

/* The noise test: NOISE's value and its place, and into result->map (unless NULL) the score of each
 * pixel: its difference in standard deviations. */
lr_status compare_noise(const lr_image *reference, const lr_image *test, const compare_pair *pair,
                        const lr_compare_options *options, lr_compare_result *result,
                        lr_error *error);

#endif
