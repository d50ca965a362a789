/* A render, made ready: the scene on the device, in motion one moment of it after the other, and
 * the way through the tiles. */
#include "render/job.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "render/film.h"
#include "scene/moment.h"

/* ---- The scene on the device -------------------------------------------------------------- */

static lr_status open_wavefront(lr_job *j, lr_render_stats *stats, lr_error *error)
{
    j->wavefront = lr_alloc(1, sizeof *j->wavefront);
    if (!j->wavefront)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory");
    return lr_wavefront_create(j->device, &j->packed, j->options, stats, j->wavefront, error);
}

static void close_wavefront(lr_job *j)
{
    if (j->wavefront)
        lr_wavefront_destroy(j->wavefront);
    free(j->wavefront);
    j->wavefront = NULL;
}

/* Takes over what was packed: into the kernels and buffers that there are, if they do for it. */
static lr_status take_packed(lr_job *j, lr_packed_scene *packed, lr_render_stats *stats,
                             lr_error *error)
{
    bool suits = j->wavefront && lr_wavefront_suits(j->wavefront, packed, j->options);
    if (!suits)
        close_wavefront(j);
    lr_packed_scene_free(&j->packed);
    j->packed = *packed;
    if (!suits)
        return open_wavefront(j, stats, error);
    double begun = lr_now(), cpu_begun = lr_cpu_now();
    lr_status status = lr_wavefront_replace_scene(j->wavefront, &j->packed, error);
    if (!status)
        status = lr_wavefront_update_camera(j->wavefront, error);
    stats->upload_seconds += lr_now() - begun;
    stats->upload_cpu_seconds += lr_cpu_now() - cpu_begun;
    return status;
}

/* The radical inverse, in [0, 1): the digits of i to the base, mirrored at the point. */
static double radical_inverse(uint32_t i, uint32_t base)
{
    uint64_t mirrored = 0, scale = 1;
    for (; i > 0; i /= base, scale *= base)
        mirrored = mirrored * base + i % base;
    return (double)mirrored / (double)scale;
}

/* When a sample is taken while the shutter is open, 0 to 1. Its place in the pixel comes from its
 * binary digits in ray trees, so that the time has to come from others there. */
static double time_of(const lr_job *j, uint32_t sample)
{
    return radical_inverse(sample, j->settings.integrator == LR_INTEGRATOR_PATH ? 2 : 3);
}

/* The scene as it is when the sample is taken, packed. */
static lr_status pack_moment(lr_job *j, uint32_t sample, lr_packed_scene *packed, lr_error *error)
{
    const lr_camera *camera = j->settings.camera;
    double frame = j->scene->frame + camera->shutter * time_of(j, sample);
    lr_scene *moment;
    lr_status status = lr_scene_at(j->scene, frame, &moment, error);
    if (status)
        return status;
    lr_settings settings = j->settings;
    settings.camera = &moment->cameras[camera - j->scene->cameras];
    settings.trees = &j->trees;
    status = lr_pack_scene(moment, &settings, packed, error);
    lr_scene_destroy(moment);
    return status;
}

lr_status lr_job_seek(lr_job *j, uint32_t sample, lr_error *error)
{
    if (!j->blurs || (j->wavefront && j->sample == sample && !j->changed))
        return LR_OK;
    lr_render_stats *stats = j->wavefront ? j->wavefront->stats : j->stats;
    lr_packed_scene packed = {0};
    double begun = lr_now(), cpu_begun = lr_cpu_now();
    lr_status status = pack_moment(j, sample, &packed, error);
    stats->build_seconds += lr_now() - begun;
    stats->build_cpu_seconds += lr_cpu_now() - cpu_begun;
    j->sample = sample;
    j->changed = false;
    return status ? status : take_packed(j, &packed, stats, error);
}

lr_status lr_job_open(lr_job *j, lr_device *device, const lr_scene *scene, lr_render_stats *stats,
                      lr_error *error)
{
    j->device = device;
    j->scene = scene;
    j->stats = stats;
    j->blurs = lr_scene_blurs(scene, j->settings.camera);
    if (j->blurs)
        return lr_job_seek(j, j->settings.first_sample, error);
    double begun = lr_now(), cpu_begun = lr_cpu_now();
    lr_status status = lr_pack_scene(scene, &j->settings, &j->packed, error);
    stats->build_seconds += lr_now() - begun;
    stats->build_cpu_seconds += lr_cpu_now() - cpu_begun;
    return status ? status : open_wavefront(j, stats, error);
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

lr_status lr_job_change(lr_job *j, lr_error *error)
{
    j->changed = true;
    if (j->blurs)
        return LR_OK; /* lr_job_seek packs it all anew */
    lr_pack_camera(j->scene, &j->settings, &j->packed);
    return lr_wavefront_update_camera(j->wavefront, error);
}

void lr_job_finish(lr_job *j)
{
    close_wavefront(j);
    lr_packed_scene_free(&j->packed);
    lr_trees_free(&j->trees);
}

/* ---- Pictures ----------------------------------------------------------------------------- */

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

/* ---- The way through the tiles ------------------------------------------------------------ */

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

/* The first sample of a range, counted from the settings' first. */
static uint32_t range_start(const lr_settings *settings, uint32_t range, uint32_t ranges)
{
    return (uint32_t)((uint64_t)settings->sample_count * range / ranges);
}

static lr_status trace_tiles(lr_job *j, uint32_t ranges, lr_take_film take, void *user,
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
        uint32_t from = range_start(settings, range, ranges);
        uint32_t to = range_start(settings, range + 1, ranges);
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

/* The film of the whole picture, which is a tile for those who take it. */
static lr_tile whole_picture(const lr_settings *settings)
{
    return (lr_tile){.x = settings->crop_x,
                     .y = settings->crop_y,
                     .width = settings->crop_width,
                     .height = settings->crop_height};
}

static lr_status add_sample(lr_job *j, uint32_t sample, tile_progress *progress, uint32_t *film,
                            lr_error *error)
{
    lr_status status = lr_job_seek(j, sample, error);
    if (status)
        return status;
    const lr_settings *settings = &j->settings;
    uint32_t size = j->wavefront->tile_size;
    for (uint32_t y = 0; y < settings->crop_height && !status; y += size)
        for (uint32_t x = 0; x < settings->crop_width && !status; x += size) {
            uint32_t right = settings->crop_width - x, below = settings->crop_height - y;
            lr_tile tile = {
                .x = settings->crop_x + x,
                .y = settings->crop_y + y,
                .width = right < size ? right : size,
                .height = below < size ? below : size,
                .first_sample = sample,
                .samples = 1,
            };
            const uint32_t *sums;
            status =
                lr_wavefront_render(j->wavefront, &tile, report_progress, progress, &sums, error);
            for (uint32_t row = 0; row < tile.height && !status; row++) {
                uint32_t *pixel =
                    &film[((size_t)(y + row) * settings->crop_width + x) * LR_FILM_WORDS];
                for (uint32_t i = 0; i < tile.width; i++, sums += LR_FILM_WORDS)
                    lr_film_add(&pixel[(size_t)i * LR_FILM_WORDS], sums);
            }
        }
    return status;
}

/* Of a scene in motion all pixels have their first sample before any has its second. */
static lr_status trace_moments(lr_job *j, uint32_t ranges, lr_take_film take, void *user,
                               lr_error *error)
{
    const lr_settings *settings = &j->settings;
    lr_tile whole = whole_picture(settings);
    size_t pixels = (size_t)whole.width * whole.height;
    uint32_t *film = lr_alloc(pixels, LR_FILM_WORDS * sizeof *film);
    if (!film)
        return lr_fail(error, LR_ERROR_MEMORY,
                       "not enough memory for the sums of %ux%u pixels; try a smaller --size",
                       whole.width, whole.height);
    tile_progress progress = {j->options, 0, settings->sample_count};
    lr_status status = LR_OK;
    for (uint32_t range = 0; range < ranges && !status; range++) {
        uint32_t to = range_start(settings, range + 1, ranges);
        memset(film, 0, pixels * LR_FILM_WORDS * sizeof *film);
        for (uint32_t i = range_start(settings, range, ranges); i < to && !status; i++) {
            status = add_sample(j, settings->first_sample + i, &progress, film, error);
            progress.done++;
        }
        if (!status)
            take(user, &whole, film);
    }
    free(film);
    return status;
}

lr_status lr_job_trace(lr_job *j, uint32_t ranges, lr_take_film take, void *user, lr_error *error)
{
    return j->blurs ? trace_moments(j, ranges, take, user, error)
                    : trace_tiles(j, ranges, take, user, error);
}

size_t lr_job_most_pixels(const lr_job *j)
{
    size_t size = j->wavefront->tile_size;
    return j->blurs ? (size_t)j->settings.crop_width * j->settings.crop_height : size * size;
}
