/* The ray tree as queues: a pass traces one chunk of rays, lights the hits into the integer film
 * and puts their children into the next generation's queue. The deepest queue that holds rays is
 * always taken first, so each queue needs room for the children of one chunk only, whatever the
 * depth. */
#ifndef LR_RENDER_WAVEFRONT_H
#define LR_RENDER_WAVEFRONT_H

#include "gpu/program.h"
#include "render/pack.h"

/* A generation for every bounce, every hidden surface that a ray may pass, and the last ray of a
 * path. */
#define LR_GENERATIONS_MAX 323

typedef struct lr_queue {
    lr_buffer *rays; /* NULL while it is empty */
    uint32_t count;
} lr_queue;

typedef struct lr_wavefront {
    lr_device *device;
    const lr_packed_scene *scene;
    lr_layout layout;
    union {
        struct {
            VkPipeline camera, trace, shade, path, path_loop;
            VkPipeline nearest, shadow, sort_scan, sort_place; /* in scenes with trees */
        };
        VkPipeline programs[9]; /* all of them */
    };
    VkDescriptorSet camera_set, set;
    union {
        struct {
            lr_buffer frame, rows, film, film_host, counters, counters_host, hits, none;
            lr_buffer found, shadow_rays, cells; /* in scenes with trees */
            lr_buffer order;                     /* there too; in kernels that explain: the notes */
        };
        lr_buffer buffers[12]; /* all of them */
    };
    uint32_t shadow_counts[LR_SHADOW_LIGHTS]; /* waiting in the segments */
    bool shadows_sorted;                      /* those are to be sorted */
    uint32_t shadow_room;                     /* of a segment */
    uint32_t rays_at_once;                    /* that an invocation takes through the trees */
    uint32_t rounds_most;                     /* bounces that an invocation may take in one pass */
    bool loops; /* an invocation takes the paths of a pixel one after the other: path_loop.comp */
    lr_queue queues[LR_GENERATIONS_MAX];
    /* Where queues live. A buffer that a queue gives back is the first to be taken again: it is
     * still in the caches. */
    lr_buffer pool[LR_GENERATIONS_MAX];
    lr_buffer *unused[LR_GENERATIONS_MAX];
    uint32_t pool_count, unused_count;
    uint32_t tile_size, chunk_rays, lights_at_once;
    lr_render_stats *stats;
} lr_wavefront;

typedef struct lr_tile {
    uint32_t x, y, width, height; /* of the whole picture */
    uint32_t first_sample, samples;
} lr_tile;

/* Called between dispatches; false stops the render. */
typedef bool (*lr_pass_done)(void *user, double tile_fraction);

lr_status lr_wavefront_create(lr_device *device, const lr_packed_scene *scene,
                              const lr_render_options *options, lr_render_stats *stats,
                              lr_wavefront *wavefront, lr_error *error);
void lr_wavefront_destroy(lr_wavefront *wavefront);

/* Camera rays that are traced together: through pixels (x + i step, y + j step) of the picture, i <
 * columns, j < rows, `samples` of each. */
typedef struct lr_camera_rays {
    uint32_t x, y, columns, rows, step;
    uint32_t film_first; /* the pixel of the film that (x, y) is, */
    uint32_t film_pitch; /* and how many lie between it and the one below */
    uint32_t first_sample, samples;
} lr_camera_rays;

/* Whether the kernels and buffers made for one scene by these options do for another as well, whose
 * work is cut up then as that of the first. */
bool lr_wavefront_suits(const lr_wavefront *wavefront, const lr_packed_scene *scene,
                        const lr_render_options *options);

/* Takes another scene that it suits. */
lr_status lr_wavefront_replace_scene(lr_wavefront *wavefront, const lr_packed_scene *scene,
                                     lr_error *error);

/* Gives the film room for so many pixels, whatever the tile size. */
lr_status lr_wavefront_resize_film(lr_wavefront *wavefront, uint32_t pixels, lr_error *error);

/* Takes over what lr_pack_camera has changed in the scene. */
lr_status lr_wavefront_update_camera(lr_wavefront *wavefront, lr_error *error);

/* Makes the first `pixels` pixels of the film black. */
lr_status lr_wavefront_clear(lr_wavefront *wavefront, uint32_t pixels, lr_error *error);

/* Traces at most chunk_rays camera rays, or so many pixels, and all that comes of them; what `done`
 * is told lies between the two fractions. Shadow rays may be left waiting until the film is
 * settled. */
lr_status lr_wavefront_trace(lr_wavefront *wavefront, const lr_camera_rays *rays, lr_pass_done done,
                             void *user, const double fractions[2], lr_error *error);
lr_status lr_wavefront_settle(lr_wavefront *wavefront, lr_error *error);

/* Forgets the rays that wait after an interruption; what they had brought stays in the film. */
void lr_wavefront_discard(lr_wavefront *wavefront);

/* Renders the samples of a tile of at most tile_size pixels a side. *film then points at
 * LR_FILM_WORDS words a pixel, valid until the next call. */
lr_status lr_wavefront_render(lr_wavefront *wavefront, const lr_tile *tile, lr_pass_done done,
                              void *user, const uint32_t **film, lr_error *error);

#endif
