#include "render/choice.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

#define STEPS (1u << LR_CHOICE_BITS)

void lr_choice_steps(const double *weights, uint32_t count, uint32_t *steps)
{
    double sum = 0;
    uint32_t used = 0, greatest = 0;
    for (uint32_t i = 0; i < count; i++) {
        sum += weights[i];
        greatest = weights[i] > weights[greatest] ? i : greatest;
    }
    /* One step is everybody's, so that rounding down takes too many from nobody; what is left over
     * goes to the greatest. */
    for (uint32_t i = 0; i < count; i++) {
        double share = floor(weights[i] / sum * (STEPS - count));
        steps[i] = weights[i] > 0 ? 1 + (uint32_t)share : 0;
        used += steps[i];
    }
    steps[greatest] += STEPS - used;
}

/* Vose's way to Walker's table ("A Linear Algorithm for Generating Random Numbers With a Given
 * Distribution", IEEE Trans. Software Eng. 17-9, 1991): a slot that a small one does not fill is
 * filled up by a large one. */
static void fill_slots(struct gpu_choice *slots, uint32_t *rest, uint32_t *order, uint32_t size,
                       uint32_t slot_steps)
{
    /* The small ones grow from the front of order[], the large ones from its end. */
    uint32_t small = 0, large = size;
    for (uint32_t i = 0; i < size; i++)
        if (rest[i] < slot_steps)
            order[small++] = i;
        else
            order[--large] = i;
    while (small > 0) {
        uint32_t low = order[--small], high = order[large];
        slots[low] = (struct gpu_choice){.threshold = rest[low], .first = low, .second = high};
        rest[high] -= slot_steps - rest[low];
        if (rest[high] < slot_steps) {
            large++;
            order[small++] = high;
        }
    }
    for (; large < size; large++) {
        uint32_t i = order[large];
        slots[i] = (struct gpu_choice){.threshold = slot_steps, .first = i, .second = i};
    }
}

struct gpu_choice *lr_choice_table(const uint32_t *steps, uint32_t count, uint32_t *bits)
{
    *bits = 0;
    while (1u << *bits < count)
        ++*bits;
    uint32_t size = 1u << *bits;
    struct gpu_choice *slots = lr_alloc(size, sizeof *slots);
    uint32_t *rest = lr_alloc(size, sizeof *rest), *order = lr_alloc(size, sizeof *order);
    if (slots && rest && order) {
        for (uint32_t i = 0; i < count; i++)
            rest[i] = steps[i];
        fill_slots(slots, rest, order, size, STEPS >> *bits);
    } else {
        free(slots);
        slots = NULL;
    }
    free(rest);
    free(order);
    return slots;
}
