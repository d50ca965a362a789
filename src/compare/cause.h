/* What the detectors of causes share. Each looks at the pictures and, when it explains them, fills
 * the result's cause, confidence and numbers and returns true. */
#ifndef LR_COMPARE_CAUSE_H
#define LR_COMPARE_CAUSE_H

#include "compare/compare_internal.h"

typedef struct cause_view {
    const compare_pair *pair;
    uint32_t width, height;
    /* Luma, of float pictures compressed to 0..1 and encoded, so that bright spots do not outweigh
     * everything else. */
    float *reference, *test;
    double energy;        /* the sum of their squared differences */
    double sample_energy; /* the same of the colour samples as stored */
} cause_view;

/* Records a cause that explains this share of the squared difference. */
static inline bool cause_found(lr_compare_result *result, lr_cause cause, double share)
{
    result->cause = cause;
    result->confidence = share < 0 ? 0 : share > 1 ? 1 : share;
    return true;
}

bool cause_is_shift(const cause_view *view, lr_compare_result *result, bool *out_of_memory);
bool cause_is_color(const cause_view *view, lr_compare_result *result, bool *out_of_memory);
bool cause_is_rounding(const cause_view *view, lr_compare_result *result, bool *out_of_memory);
bool cause_is_blur(const cause_view *view, lr_compare_result *result, bool *out_of_memory);
bool cause_is_blocks(const cause_view *view, lr_compare_result *result, bool *out_of_memory);
bool cause_is_edges(const cause_view *view, lr_compare_result *result, bool *out_of_memory);
bool cause_is_noise(const cause_view *view, lr_compare_result *result, bool *out_of_memory);

#endif
