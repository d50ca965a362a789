#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "render/wavefront.h"

#define PIXELS_MAX (1u << 28)

static lr_status choose_camera(const lr_scene *scene, const char *name, const lr_camera **camera,
                               lr_error *error)
{
    *camera = &scene->cameras[0];
    if (!name)
        return LR_OK;
    char known[512] = "";
    for (uint32_t i = 0; i < scene->camera_count; i++) {
        *camera = &scene->cameras[i];
        if (!(*camera)->name)
            continue;
        if (!strcmp((*camera)->name, name))
            return LR_OK;
        size_t used = strlen(known);
        if (used + strlen((*camera)->name) + 3 < sizeof known) {
            strcat(known, used ? ", " : "");
            strcat(known, (*camera)->name);
        }
    }
    return lr_fail(error, LR_ERROR_ARGUMENT, "the scene has no camera '%s'; it has %s", name,
                   known[0] ? known : "one without a name");
}

static lr_status settle(const lr_scene *scene, const lr_render_options *options,
                        lr_settings *settings, lr_error *error)
{
    lr_settings *s = settings;
    *s = (lr_settings){
        .width = options->width ? options->width : scene->image.width,
        .height = options->height ? options->height : scene->image.height,
        .samples = options->samples ? options->samples : scene->image.samples,
        .depth = options->has_depth ? (uint32_t)options->depth : scene->image.depth,
        .seed = options->has_seed ? options->seed : scene->image.seed,
        .crop_x = options->crop.x,
        .crop_y = options->crop.y,
        .crop_width = options->crop.width,
        .crop_height = options->crop.height,
        .leaf_size = options->leaf_size,
        .threads = options->threads,
    };
    if (s->width > 32768 || s->height > 32768)
        return lr_fail(error, LR_ERROR_ARGUMENT, "the size %ux%u is over 32768 (--size)", s->width,
                       s->height);
    if (s->samples > 65536)
        return lr_fail(error, LR_ERROR_ARGUMENT, "%u samples are over 65536 (--spp)", s->samples);
    if (s->depth > 64)
        return lr_fail(error, LR_ERROR_ARGUMENT, "the depth %u is over 64 (--depth)", s->depth);
    if (!s->crop_width || !s->crop_height) {
        s->crop_x = s->crop_y = 0;
        s->crop_width = s->width;
        s->crop_height = s->height;
    }
    if (s->crop_width > s->width || s->crop_x > s->width - s->crop_width ||
        s->crop_height > s->height || s->crop_y > s->height - s->crop_height)
        return lr_fail(error, LR_ERROR_ARGUMENT,
                       "the crop %u,%u,%u,%u reaches outside the picture of %ux%u", s->crop_x,
                       s->crop_y, s->crop_width, s->crop_height, s->width, s->height);
    if ((uint64_t)s->crop_width * s->crop_height > PIXELS_MAX)
        return lr_fail(error, LR_ERROR_ARGUMENT,
                       "%ux%u pixels are over the cap of %u; render parts with --crop",
                       s->crop_width, s->crop_height, PIXELS_MAX);
    return choose_camera(scene, options->camera, &s->camera, error);
}

/* The mean of a channel's samples. Every step is correctly rounded in double. */
static float film_value(const uint32_t *pixel, uint32_t channel, uint32_t samples)
{
    if (pixel[LR_FILM_FLAGS] & 1u << channel)
        return (float)(LR_FILM_MAX / samples);
    uint64_t sum = pixel[2 * channel] | (uint64_t)pixel[2 * channel + 1] << 32;
    return (float)((double)sum / (double)(1ull << LR_FILM_STEP_BITS) / samples);
}

static void resolve(const uint32_t *film, const lr_tile *tile, const lr_settings *settings,
                    lr_picture *picture)
{
    for (uint32_t y = 0; y < tile->height; y++) {
        size_t row = (tile->y - settings->crop_y + y) * (size_t)picture->width;
        float *out = &picture->pixels[3 * (row + tile->x - settings->crop_x)];
        const uint32_t *in = &film[(size_t)y * tile->width * LR_FILM_WORDS];
        for (uint32_t x = 0; x < tile->width; x++, in += LR_FILM_WORDS)
            for (uint32_t channel = 0; channel < 3; channel++)
                *out++ = film_value(in, channel, settings->samples);
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
    lr_status status = settle(scene, options, &settings, error);
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
