/* One of many, each with a probability of its own, in one step and in whole numbers. */
#ifndef LR_RENDER_CHOICE_H
#define LR_RENDER_CHOICE_H

#include <stdbool.h>
#include <stdint.h>

#include "gpu_layout.h"

#define LR_CHOICES_MAX (1u << 18)

/* Rounds up to LR_CHOICES_MAX weights (>= 0, at least one above 0, finite sum) to whole steps of
 * 1 / LR_CHOICE_STEPS that sum to 1; none above 0 becomes 0. */
void lr_choice_steps(const double *weights, uint32_t count, uint32_t *steps);

/* Makes the 2^*bits >= count choices for 1..LR_CHOICES_MAX such steps; choice[i].first and second
 * are indices of them. Owned by the caller; NULL when memory is out. */
struct gpu_choice *lr_choice_table(const uint32_t *steps, uint32_t count, uint32_t *bits);

#endif
