#include "render/film.h"
#include "render/gather.h"
#include "render/job.h"
#include "render/settings.h"

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
static lr_status render_tiles(lr_job *j, lr_picture *picture, lr_error *error)
{
    return lr_job_trace(j, 1, resolve, &(resolver){&j->settings, picture}, error);
}

/* The same over the sums of the whole picture, which are left in *sums. */
static lr_status render_sums(lr_job *j, const lr_scene *scene, lr_sums *sums, lr_picture *picture,
                             lr_render_stats *stats, lr_error *error)
{
    lr_status status = lr_sums_create(sums, scene, &j->settings, j->options, error);
    if (!status)
        status = lr_gather(j, sums, error);
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
