/* A picture that becomes finer step by step: first of pixels far apart, then of all, then of more
 * samples. When it is finished, its film is the one that lr_render makes. */
#ifndef LR_RENDER_PROGRESSIVE_H
#define LR_RENDER_PROGRESSIVE_H

#include "render/display.h"
#include "render/wavefront.h"

/* Pixels (x + i step, y + j step), `samples` samples of each from first_sample on. */
typedef struct lr_sweep {
    uint32_t x, y, step;
    uint32_t first_sample, samples;
} lr_sweep;

typedef struct lr_progressive {
    const lr_scene *scene;
    lr_packed_scene packed;
    lr_settings settings;
    lr_wavefront wavefront;
    lr_render_stats stats; /* of the picture so far */
    lr_sweep sweep;
    uint32_t column, row, band; /* where in the sweep: so many rows are traced from left to right */
    double seconds_per_ray;     /* camera rays with all that comes of them */
    bool shown;                 /* there is a colour for every pixel, if only from afar */
    bool finished;
} lr_progressive;

/* Packs the scene and compiles the kernels. The scene must outlive it. */
lr_status lr_progressive_create(lr_device *device, const lr_scene *scene,
                                const lr_settings *settings, lr_progressive **progressive,
                                lr_error *error);
void lr_progressive_destroy(lr_progressive *progressive);

/* Takes another scene and its packing over, if the kernels and buffers do for it too; otherwise
 * leaves all as it is, and *taken is false. The picture is to be started anew then. */
lr_status lr_progressive_replace(lr_progressive *progressive, const lr_scene *scene,
                                 lr_packed_scene *packed, bool *taken, lr_error *error);

/* Starts a picture anew: with another camera, size, depth, number of samples, or another kind of
 * values to inspect; from light to these, or back, takes another lr_progressive. `camera` of the
 * settings is not looked at later. Must be called once before the first step. */
lr_status lr_progressive_start(lr_progressive *progressive, const lr_settings *settings,
                               lr_error *error);

/* Traces what takes about so many seconds. `go_on` is asked between passes, and no step is longer
 * than one of these after it has said no: LR_ERROR_INTERRUPTED, and the picture is to be started
 * anew. */
lr_status lr_progressive_step(lr_progressive *progressive, double seconds, lr_pass_done go_on,
                              void *user, lr_error *error);

/* Sets all but the exposure and the order of bytes. */
void lr_progressive_look(const lr_progressive *progressive, lr_look *look);

/* What fraction of the camera rays has been traced, 0 to 1. */
double lr_progressive_done(const lr_progressive *progressive);

/* The picture as far as it is; the caller frees it. */
lr_status lr_progressive_picture(lr_progressive *progressive, lr_picture *picture, lr_error *error);

#endif
