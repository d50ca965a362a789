/* What the set-up and the passes of the ray tree share. */
#ifndef LR_RENDER_WAVEFRONT_INTERNAL_H
#define LR_RENDER_WAVEFRONT_INTERNAL_H

#include "render/wavefront.h"

static inline uint32_t at_least(uint32_t value, uint32_t least)
{
    return value > least ? value : least;
}

static inline uint32_t at_most(uint32_t value, uint32_t most)
{
    return value < most ? value : most;
}

static inline uint32_t groups_for(uint32_t items, uint32_t size)
{
    return (items + size - 1) / size;
}

static inline bool has_trees(const lr_wavefront *w)
{
    return w->scene->constants[LR_SPEC_TREES];
}

/* The rays are noted: LR_SPEC_EXPLAIN. */
static inline bool explains(const lr_wavefront *w)
{
    return w->scene->constants[LR_SPEC_EXPLAIN];
}

/* Paths, in one kernel: LR_SPEC_PATH. */
static inline bool has_paths(const lr_wavefront *w)
{
    return w->scene->constants[LR_SPEC_PATH];
}

/* Light sources that a hit asks. */
static inline uint32_t lights_asked(const lr_wavefront *w)
{
    return has_paths(w) ? 1 : w->scene->light_count;
}

/* Opens the queues of a pass over a generation and points the sets at them. */
lr_status wavefront_open_generation(lr_wavefront *w, uint32_t generation, lr_error *error);

/* Opens one queue that a pass reads and writes, the place of the paths of each pixel. */
lr_status wavefront_open_rounds(lr_wavefront *w, lr_error *error);
void wavefront_close_if_empty(lr_wavefront *w, lr_queue *queue);

void wavefront_reset_counters(lr_wavefront *w);

#endif
