#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "render/film.h"
#include "render/settings.h"
#include "render/wavefront.h"

static void resolve(const uint32_t *film, const lr_tile *tile, const lr_settings *settings,
                    lr_picture *picture)
{
    for (uint32_t y = 0; y < tile->height; y++) {
        size_t row = (tile->y - settings->crop_y + y) * (size_t)picture->width;
        lr_film_resolve(&film[(size_t)y * tile->width * LR_FILM_WORDS], tile->width,
                        &picture->pixels[3 * (row + tile->x - settings->crop_x)]);
    }
}

typedef struct tile_progress {
    const lr_render_options *options;
    double done, total; /* tiles */
} tile_progress;

static bool report_progress(void *user, double tile_fraction)
{
    tile_progress *p = user;
    if (!p->options->progress)
        return true;
    return p->options->progress(p->options->user, (p->done + tile_fraction) / p->total);
}

static lr_status render_tiles(lr_wavefront *wavefront, const lr_settings *settings,
                              const lr_render_options *options, lr_picture *picture,
                              lr_error *error)
{
    uint32_t size = wavefront->tile_size;
    uint32_t across = (settings->crop_width + size - 1) / size;
    uint32_t down = (settings->crop_height + size - 1) / size;
    tile_progress progress = {options, 0, (double)across * down};
    lr_status status = LR_OK;
    for (uint32_t i = 0; i < across * down && !status; i++) {
        uint32_t x = i % across * size, y = i / across * size;
        uint32_t right = settings->crop_width - x, below = settings->crop_height - y;
        lr_tile tile = {settings->crop_x + x, settings->crop_y + y, right < size ? right : size,
                        below < size ? below : size};
        const uint32_t *film;
        status = lr_wavefront_render(wavefront, &tile, report_progress, &progress, &film, error);
        if (!status)
            resolve(film, &tile, settings, picture);
        progress.done++;
    }
    return status;
}

lr_status lr_render(lr_device *device, const lr_scene *scene, const lr_render_options *options,
                    lr_picture *picture, lr_render_stats *stats, lr_error *error)
{
    static const lr_render_options defaults;
    lr_render_stats own_stats;
    lr_settings settings;
    lr_packed_scene packed = {0};
    lr_wavefront *wavefront = NULL;
    options = options ? options : &defaults;
    stats = stats ? stats : &own_stats;
    *stats = (lr_render_stats){.device_seconds = device->open_seconds};
    *picture = (lr_picture){0};
    lr_status status = lr_settle(scene, options, &settings, error);
    double start = lr_now(), cpu_start = lr_cpu_now();
    if (!status)
        status = lr_pack_scene(scene, &settings, &packed, error);
    stats->build_seconds = lr_now() - start;
    stats->build_cpu_seconds = lr_cpu_now() - cpu_start;
    if (!status) {
        picture->width = settings.crop_width;
        picture->height = settings.crop_height;
        picture->pixels = lr_alloc((size_t)picture->width * picture->height, 3 * sizeof(float));
        wavefront = lr_alloc(1, sizeof *wavefront);
        if (!picture->pixels || !wavefront)
            status = lr_fail(error, LR_ERROR_MEMORY,
                             "not enough memory for %ux%u pixels; try a smaller --size",
                             picture->width, picture->height);
    }
    if (!status)
        status = lr_wavefront_create(device, &packed, options, stats, wavefront, error);
    if (!status)
        status = render_tiles(wavefront, &settings, options, picture, error);
    if (!status) {
        stats->width = settings.width;
        stats->height = settings.height;
        stats->samples = settings.samples;
        stats->depth = settings.depth;
        stats->seed = settings.seed;
        stats->integrator = settings.integrator;
        lr_picture_hash(picture, stats->hash);
    } else {
        lr_picture_free(picture);
    }
    if (wavefront)
        lr_wavefront_destroy(wavefront);
    free(wavefront);
    lr_packed_scene_free(&packed);
    return status;
}
