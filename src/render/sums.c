#include "render/sums.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/read.h"
#include "scene/fingerprint.h"

lr_status lr_sums_create(lr_sums *sums, const lr_scene *scene, const lr_settings *settings,
                         const lr_render_options *options, lr_error *error)
{
    *sums = (lr_sums){
        .exposure = (float)scene->image.exposure,
        .white = (float)scene->image.white,
        .tone = scene->image.tone,
        .width = settings->crop_width,
        .height = settings->crop_height,
        .samples = settings->samples,
        .first = settings->first_sample,
        .count = settings->sample_count,
    };
    size_t pixels = (size_t)sums->width * sums->height;
    if (pixels > LR_IMAGE_MAX_SAMPLES / LR_FILM_WORDS)
        return lr_fail(error, LR_ERROR_ARGUMENT,
                       "%ux%u pixels are more than the %d of parts, checkpoints and layers; render "
                       "pieces with --crop",
                       sums->width, sums->height, LR_IMAGE_MAX_SAMPLES / LR_FILM_WORDS);
    sums->film = lr_alloc(pixels, LR_FILM_WORDS * sizeof *sums->film);
    if (!sums->film)
        return lr_fail(error, LR_ERROR_MEMORY,
                       "not enough memory for the sums of %ux%u pixels; try a smaller --size",
                       sums->width, sums->height);
    snprintf(sums->id.software, sizeof sums->id.software, "lavaray %s", LR_VERSION);
    memcpy(sums->scene, scene->sha256, sizeof sums->scene);
    lr_scene_hash(scene, sums->id.numbers);
    lr_settings_describe(settings, options, sums->id.settings, sizeof sums->id.settings);
    return LR_OK;
}

void lr_sums_free(lr_sums *sums)
{
    free(sums->film);
    sums->film = NULL;
}

void lr_sums_resolve(const lr_sums *sums, float *pixels)
{
    for (uint32_t y = 0; y < sums->height; y++)
        lr_film_resolve(lr_sums_pixel(sums, 0, y), sums->width,
                        &pixels[3 * (size_t)y * sums->width]);
}

double lr_sums_done(const lr_sums *sums)
{
    uint64_t total = 0;
    size_t pixels = (size_t)sums->width * sums->height;
    for (size_t i = 0; i < pixels; i++)
        total += sums->film[i * LR_FILM_WORDS + LR_FILM_SAMPLES];
    return (double)total / (double)pixels / sums->count;
}
