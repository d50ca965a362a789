/* What a caller asks for and what the scene says, as one. */
#include "render/settings.h"

#include <stdio.h>
#include <string.h>

/* Of a path-traced picture that nobody asked a number for: it shows what it will be. */
#define PATH_SAMPLES 64

#define SAMPLES_MAX 65536
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

static uint64_t at_least_one(uint32_t count)
{
    return count ? count : 1;
}

uint32_t lr_default_samples(lr_integrator integrator)
{
    return integrator == LR_INTEGRATOR_PATH ? PATH_SAMPLES : 1;
}

lr_status lr_settle(const lr_scene *scene, const lr_render_options *options, lr_settings *settings,
                    lr_error *error)
{
    lr_settings *s = settings;
    *s = (lr_settings){
        .width = options->width ? options->width : scene->image.width,
        .height = options->height ? options->height : scene->image.height,
        .depth = options->has_depth ? (uint32_t)options->depth : scene->image.depth,
        .seed = options->has_seed ? options->seed : scene->image.seed,
        .crop_x = options->crop.x,
        .crop_y = options->crop.y,
        .crop_width = options->crop.width,
        .crop_height = options->crop.height,
        .integrator = options->integrator ? options->integrator
                                          : (lr_integrator)(scene->image.integrator + 1),
        .first_sample = options->sample_range.first,
        .sample_count = options->sample_range.count,
        .noise = (uint32_t)(options->noise * 1e6 + 0.5),
        .filter = options->filter,
        .leaf_size = options->leaf_size,
        .threads = options->threads,
    };
    s->samples = options->samples ? options->samples : scene->image.samples;
    if (!options->samples && (options->seconds > 0 || options->noise > 0))
        s->samples = SAMPLES_MAX;
    if (!s->samples)
        s->samples = lr_default_samples(s->integrator);
    if (s->width > 32768 || s->height > 32768)
        return lr_fail(error, LR_ERROR_ARGUMENT, "the size %ux%u is over 32768 (--size)", s->width,
                       s->height);
    if (s->samples > SAMPLES_MAX)
        return lr_fail(error, LR_ERROR_ARGUMENT, "%u samples are over %d (--spp)", s->samples,
                       SAMPLES_MAX);
    if (!(options->noise >= 0 && options->noise <= 1) || (options->noise > 0 && !s->noise))
        return lr_fail(error, LR_ERROR_ARGUMENT, "the noise %g is not from 0.000001 to 1 (--noise)",
                       options->noise);
    if (s->noise && s->integrator != LR_INTEGRATOR_PATH)
        return lr_fail(error, LR_ERROR_ARGUMENT,
                       "an end by noise (--noise) needs --integrator path: where a whitted sample "
                       "lies depends on how many there will be");
    if (s->noise && (options->checkpoint || options->sample_range.count || options->seconds > 0))
        return lr_fail(error, LR_ERROR_ARGUMENT,
                       "an end by noise (--noise) goes with none of --time, --checkpoint and "
                       "--sample-range");
    if (options->seconds > 0 && s->integrator != LR_INTEGRATOR_PATH)
        return lr_fail(error, LR_ERROR_ARGUMENT,
                       "a time limit (--time) needs --integrator path: where a whitted sample lies "
                       "depends on how many there will be");
    if (options->seconds > 0 && (options->checkpoint || options->sample_range.count))
        return lr_fail(error, LR_ERROR_ARGUMENT,
                       "a time limit (--time) goes with neither --checkpoint nor --sample-range; "
                       "give the number of samples by --spp");
    if (s->first_sample >= s->samples || s->sample_count > s->samples - s->first_sample)
        return lr_fail(error, LR_ERROR_ARGUMENT,
                       "samples %u to %llu are not all among the picture's, 0 to %u "
                       "(--sample-range, --spp)",
                       s->first_sample,
                       (unsigned long long)(s->first_sample + at_least_one(s->sample_count) - 1),
                       s->samples - 1);
    if (s->sample_count == 0)
        s->sample_count = s->samples - s->first_sample;
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

void lr_settings_describe(const lr_settings *settings, const lr_render_options *options, char *text,
                          size_t size)
{
    static const char *const filters[] = {NULL, "box", "tent", "blackman-harris"};
    const lr_settings *s = settings;
    size_t used =
        (size_t)snprintf(text, size, "%s%ux%u, %u sample%s, depth %u, seed %u",
                         s->integrator == LR_INTEGRATOR_PATH ? "paths, " : "", s->width, s->height,
                         s->samples, s->samples == 1 ? "" : "s", s->depth, s->seed);
    if (options->crop.width)
        used += (size_t)snprintf(text + used, size - used, ", crop %u,%u,%u,%u", s->crop_x,
                                 s->crop_y, s->crop_width, s->crop_height);
    if (options->camera)
        used += (size_t)snprintf(text + used, size - used, ", camera %.200s", options->camera);
    if (s->noise)
        used += (size_t)snprintf(text + used, size - used, ", noise %u.%06u", s->noise / 1000000,
                                 s->noise % 1000000);
    if (options->filter)
        snprintf(text + used, size - used, ", filter %s", filters[options->filter]);
}
