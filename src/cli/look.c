#include "cli/look.h"

#include "cli/progress.h"
#include "cli/stats.h"

#include <string.h>

static bool holds_light(lr_format format)
{
    return format == LR_FORMAT_PFM || format == LR_FORMAT_EXR;
}

static lr_tone tone_named(const char *name)
{
    int tone = LR_TONE_NONE;
    while (strcmp(lr_tone_name((lr_tone)tone), name) != 0) {
        tone++;
    }
    return (lr_tone)tone;
}

int check_look(const command *self, const look_values *values, lr_format format)
{
    if (holds_light(format) && values->tone && tone_named(values->tone) != LR_TONE_NONE) {
        return wrong_usage(self, "--tone is not for PFM and EXR, which hold the light as it is");
    }
    return EXIT_FINE;
}

void choose_look(const look_values *values, const lr_scene_info *scene, lr_encoding *encoding)
{
    encoding->tone = values->tone ? tone_named(values->tone) : scene->tone;
    if (holds_light(encoding->format)) {
        encoding->tone = LR_TONE_NONE;
    }
    encoding->white = values->white != 0 ? (float)values->white : scene->white;
}

void describe_look(const lr_encoding *encoding, FILE *out)
{
    if (encoding->tone != LR_TONE_NONE) {
        fprintf(out, ", tone %s", lr_tone_name(encoding->tone));
    }
    if (encoding->white != 0) {
        fprintf(out, ", white %.7g", (double)encoding->white);
    }
}

static const float *floats_of(const lr_layers *layers, lr_aov aov)
{
    for (uint32_t i = 0; layers && i < layers->count; i++) {
        if (strcmp(layers->layers[i].name, lr_aov_name(aov)) == 0) {
            return layers->layers[i].samples;
        }
    }
    return NULL;
}

lr_status denoise_picture(lr_denoiser *denoiser, lr_picture *picture, progress *bar,
                          render_record *record, lr_error *error)
{
    if (!denoiser) {
        return LR_OK;
    }
    lr_denoise_options options = {.albedo = floats_of(record->layers, LR_AOV_ALBEDO),
                                  .progress = progress_update,
                                  .user = bar};
    options.normal = options.albedo ? floats_of(record->layers, LR_AOV_NORMAL) : NULL;
    double start = seconds_now();
    progress_phase(bar, "denoising");
    lr_status status = lr_denoiser_run(denoiser, picture, &options, error);
    progress_clear(bar);
    if (status == LR_OK) {
        record->denoiser = lr_denoiser_name(denoiser);
        record->denoise_seconds = seconds_now() - start;
        lr_picture_hash(picture, record->denoised_hash);
    }
    return status;
}
