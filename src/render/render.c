#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "render/film.h"
#include "render/gather.h"
#include "render/job.h"
#include "render/settings.h"

lr_status lr_job_open(lr_job *j, lr_device *device, const lr_scene *scene, lr_render_stats *stats,
                      lr_error *error)
{
    double begun = lr_now(), cpu_begun = lr_cpu_now();
    lr_status status = lr_pack_scene(scene, &j->settings, &j->packed, error);
    stats->build_seconds += lr_now() - begun;
    stats->build_cpu_seconds += lr_cpu_now() - cpu_begun;
    if (status)
        return status;
    j->wavefront = lr_alloc(1, sizeof *j->wavefront);
    if (!j->wavefront)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory");
    return lr_wavefront_create(device, &j->packed, j->options, stats, j->wavefront, error);
}

lr_status lr_job_start(lr_job *j, lr_device *device, const lr_scene *scene,
                       const lr_render_options *options, lr_render_stats *stats, lr_error *error)
{
    static const lr_render_options defaults;
    *j = (lr_job){.options = options ? options : &defaults, .begun = lr_now()};
    *stats = (lr_render_stats){.device_seconds = device->open_seconds};
    lr_status status = lr_settle(scene, j->options, &j->settings, error);
    return status ? status : lr_job_open(j, device, scene, stats, error);
}

void lr_job_finish(lr_job *j)
{
    if (j->wavefront)
        lr_wavefront_destroy(j->wavefront);
    free(j->wavefront);
    lr_packed_scene_free(&j->packed);
}

void lr_job_describe(const lr_job *j, const lr_picture *picture, lr_render_stats *stats)
{
    stats->width = j->settings.width;
    stats->height = j->settings.height;
    stats->samples = j->settings.samples;
    stats->first_sample = j->settings.first_sample;
    stats->sample_count = j->settings.sample_count;
    if (!stats->most_samples)
        stats->mean_samples = stats->least_samples = stats->most_samples = stats->sample_count;
    stats->depth = j->settings.depth;
    stats->seed = j->settings.seed;
    stats->integrator = j->settings.integrator;
    lr_settings_describe(&j->settings, j->options, stats->settings, sizeof stats->settings);
    lr_picture_hash(picture, stats->hash);
}

lr_status lr_job_picture(const lr_job *j, lr_picture *picture, lr_error *error)
{
    picture->width = j->settings.crop_width;
    picture->height = j->settings.crop_height;
    picture->pixels = lr_alloc((size_t)picture->width * picture->height, 3 * sizeof(float));
    if (!picture->pixels)
        return lr_fail(error, LR_ERROR_MEMORY,
                       "not enough memory for %ux%u pixels; try a smaller --size", picture->width,
                       picture->height);
    return LR_OK;
}

typedef struct tile_progress {
    const lr_render_options *options;
    double done, total; /* tiles, or their ranges */
} tile_progress;

static bool report_progress(void *user, double tile_fraction)
{
    tile_progress *p = user;
    if (!p->options->progress)
        return true;
    return p->options->progress(p->options->user, (p->done + tile_fraction) / p->total);
}

lr_status lr_job_trace(const lr_job *j, uint32_t ranges, lr_take_film take, void *user,
                       lr_error *error)
{
    const lr_settings *settings = &j->settings;
    uint32_t size = j->wavefront->tile_size;
    uint32_t across = (settings->crop_width + size - 1) / size;
    uint32_t down = (settings->crop_height + size - 1) / size;
    tile_progress progress = {j->options, 0, (double)across * down * ranges};
    lr_status status = LR_OK;
    for (uint64_t i = 0; i < (uint64_t)across * down * ranges && !status; i++) {
        uint32_t number = (uint32_t)(i / ranges), range = (uint32_t)(i % ranges);
        uint32_t x = number % across * size, y = number / across * size;
        uint32_t right = settings->crop_width - x, below = settings->crop_height - y;
        uint32_t from = (uint32_t)((uint64_t)settings->sample_count * range / ranges);
        uint32_t to = (uint32_t)((uint64_t)settings->sample_count * (range + 1) / ranges);
        lr_tile tile = {
            .x = settings->crop_x + x,
            .y = settings->crop_y + y,
            .width = right < size ? right : size,
            .height = below < size ? below : size,
            .first_sample = settings->first_sample + from,
            .samples = to - from,
        };
        const uint32_t *film;
        status = lr_wavefront_render(j->wavefront, &tile, report_progress, &progress, &film, error);
        if (!status)
            take(user, &tile, film);
        progress.done++;
    }
    return status;
}

typedef struct resolver {
    const lr_settings *settings;
    lr_picture *picture;
} resolver;

static void resolve(void *user, const lr_tile *tile, const uint32_t *film)
{
    const resolver *r = user;
    for (uint32_t y = 0; y < tile->height; y++) {
        size_t row = (tile->y - r->settings->crop_y + y) * (size_t)r->picture->width;
        lr_film_resolve(&film[(size_t)y * tile->width * LR_FILM_WORDS], tile->width,
                        &r->picture->pixels[3 * (row + tile->x - r->settings->crop_x)]);
    }
}

/* Every tile with all of its samples, so that no sums but a tile's are ever kept. */
static lr_status render_tiles(const lr_job *j, lr_picture *picture, lr_error *error)
{
    return lr_job_trace(j, 1, resolve, &(resolver){&j->settings, picture}, error);
}

void lr_job_count(const lr_sums *sums, lr_render_stats *stats)
{
    size_t pixels = (size_t)sums->width * sums->height;
    uint64_t total = 0;
    stats->least_samples = UINT32_MAX;
    for (size_t i = 0; i < pixels; i++) {
        uint32_t count = sums->film[i * LR_FILM_WORDS + LR_FILM_SAMPLES];
        total += count;
        if (count < stats->least_samples)
            stats->least_samples = count;
        if (count > stats->most_samples)
            stats->most_samples = count;
    }
    stats->mean_samples = (double)total / (double)pixels;
}

/* The same over the sums of the whole picture, which are left in *sums. */
static lr_status render_sums(lr_job *j, const lr_scene *scene, lr_sums *sums, lr_picture *picture,
                             lr_render_stats *stats, lr_error *error)
{
    lr_status status = lr_sums_create(sums, scene, &j->settings, j->options, error);
    if (!status)
        status = lr_gather(j->wavefront, &j->settings, j->options, sums, j->begun, error);
    if (!status)
        lr_job_count(sums, stats);
    if (!status && j->options->seconds > 0)
        j->settings.samples = j->settings.sample_count = sums->count;
    if (!status)
        lr_sums_resolve(sums, picture->pixels);
    return status;
}

lr_status lr_render(lr_device *device, const lr_scene *scene, const lr_render_options *options,
                    lr_picture *picture, lr_render_stats *stats, lr_error *error)
{
    lr_render_stats own_stats;
    lr_sums sums = {0};
    lr_job j;
    stats = stats ? stats : &own_stats;
    *picture = (lr_picture){0};
    lr_status status = lr_job_start(&j, device, scene, options, stats, error);
    if (!status)
        status = lr_job_picture(&j, picture, error);
    if (!status && lr_needs_sums(j.options))
        status = render_sums(&j, scene, &sums, picture, stats, error);
    else if (!status)
        status = render_tiles(&j, picture, error);
    if (!status)
        lr_job_describe(&j, picture, stats);
    else
        lr_picture_free(picture);
    lr_sums_free(&sums);
    lr_job_finish(&j);
    return status;
}

lr_status lr_render_part(lr_device *device, const lr_scene *scene, const lr_render_options *options,
                         const char *path, lr_render_stats *stats, lr_error *error)
{
    lr_render_stats own_stats;
    lr_picture picture = {0};
    lr_sums sums = {0};
    lr_job j;
    stats = stats ? stats : &own_stats;
    lr_status status = lr_job_start(&j, device, scene, options, stats, error);
    if (!status)
        status = lr_job_picture(&j, &picture, error);
    if (!status)
        status = render_sums(&j, scene, &sums, &picture, stats, error);
    if (!status)
        status = lr_sums_write(&sums, path, error);
    if (!status)
        lr_job_describe(&j, &picture, stats);
    lr_picture_free(&picture);
    lr_sums_free(&sums);
    lr_job_finish(&j);
    return status;
}
