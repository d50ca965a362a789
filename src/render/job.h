/* A render, made ready, and its way through the tiles. */
#ifndef LR_RENDER_JOB_H
#define LR_RENDER_JOB_H

#include "render/sums.h"
#include "render/wavefront.h"

/* Zeroed, it may be finished. */
typedef struct lr_job {
    const lr_render_options *options;
    lr_settings settings;
    lr_device *device;
    const lr_scene *scene; /* as it is when the shutter opens */
    bool blurs;            /* and not as it is later, when a sample is taken */
    lr_packed_scene packed;
    lr_wavefront *wavefront;
    lr_render_stats *stats;
    double begun; /* lr_now() */
    /* Of a scene that blurs: the sample that is packed, with the settings that there were unless
     * they have changed since, and its trees. */
    uint32_t sample;
    bool changed;
    lr_trees trees;
} lr_job;

/* Settles what the options ask for, then opens the job; options may be NULL. Sets *stats anew. */
lr_status lr_job_start(lr_job *job, lr_device *device, const lr_scene *scene,
                       const lr_render_options *options, lr_render_stats *stats, lr_error *error);

/* Packs the scene by the job's settings and makes kernels and buffers for it. Both have to outlive
 * the job. */
lr_status lr_job_open(lr_job *job, lr_device *device, const lr_scene *scene, lr_render_stats *stats,
                      lr_error *error);
void lr_job_finish(lr_job *job);

/* Puts the scene on the device as it is when that sample is taken: all that moves while the shutter
 * is open stands still in a sample. The wavefront may be another one afterwards. */
lr_status lr_job_seek(lr_job *job, uint32_t sample, lr_error *error);

/* Takes over the settings that the caller has changed: what may change in a picture is the depth,
 * the samples, or, from one thing to inspect to another, these. */
lr_status lr_job_change(lr_job *job, lr_error *error);

/* A black picture of the job's size, with *picture the caller's also when it fails. */
lr_status lr_job_picture(const lr_job *job, lr_picture *picture, lr_error *error);

/* What is known once the picture is there. */
void lr_job_describe(const lr_job *job, const lr_picture *picture, lr_render_stats *stats);

/* The samples of the pixels; where they differ in number. */
void lr_job_count(const lr_sums *sums, lr_render_stats *stats);

/* Is given a tile's film, LR_FILM_WORDS words a pixel. */
typedef void (*lr_take_film)(void *user, const lr_tile *tile, const uint32_t *film);

/* Traces all tiles with the settings' samples: each tile's in `ranges` pieces, 1 up to the number
 * of samples, the first samples first, before the next tile. */
lr_status lr_job_trace(lr_job *job, uint32_t ranges, lr_take_film take, void *user,
                       lr_error *error);

/* The most pixels that a tile of these has. */
size_t lr_job_most_pixels(const lr_job *job);

#endif
