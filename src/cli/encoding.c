#include "cli/encoding.h"

#include "image/image.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

static lr_format format_named(const char *name)
{
    char path[16];
    lr_format format = LR_FORMAT_PPM;
    snprintf(path, sizeof path, ".%s", name);
    lr_format_from_path(path, &format);
    return format;
}

int choose_encoding(const command *self, const encoding_values *values, lr_encoding *encoding)
{
    const encoding_values *v = values;
    if (!v->output) {
        return wrong_usage(self, "where to? Give -o FILE.png, .ppm, .pfm or .exr");
    }
    bool to_stdout = strcmp(v->output, "-") == 0;
    encoding->format = LR_FORMAT_PPM;
    if (v->format) {
        encoding->format = format_named(v->format);
    } else if (!to_stdout && !lr_format_from_path(v->output, &encoding->format)) {
        print_error("%s: the name must end in .ppm, .png, .pfm or .exr; see lavaray %s --help",
                    v->output, self->name);
        return EXIT_USAGE;
    }
    if (to_stdout && isatty(STDOUT_FILENO)) {
        return wrong_usage(self, "-o - is for pipes and files, standard output is a terminal");
    }
    bool floats = encoding->format == LR_FORMAT_PFM || encoding->format == LR_FORMAT_EXR;
    if (floats && v->maxval >= 0) {
        return wrong_usage(self, "--maxval means nothing for PFM and EXR, which hold floats");
    }
    if (floats && v->transfer && strcmp(v->transfer, "srgb") == 0) {
        return wrong_usage(self, "--transfer srgb is not for PFM and EXR, which are always linear");
    }
    if (check_look(self, &v->look, encoding->format) != EXIT_FINE) {
        return EXIT_USAGE;
    }
    if (v->half && encoding->format != LR_FORMAT_EXR) {
        return wrong_usage(self, "--half is for EXR alone");
    }
    if (encoding->format == LR_FORMAT_PNG && v->maxval >= 0 && v->maxval != 255 &&
        v->maxval != 65535) {
        return wrong_usage(self, "--maxval must be 255 or 65535 for PNG");
    }
    encoding->maxval = v->maxval >= 0 ? (uint32_t)v->maxval : 0;
    encoding->transfer =
        v->transfer && strcmp(v->transfer, "linear") == 0 ? LR_TRANSFER_LINEAR : LR_TRANSFER_SRGB;
    encoding->half = v->half;
    return EXIT_FINE;
}

void finish_encoding(const encoding_values *values, const lr_scene_info *scene,
                     lr_encoding *encoding)
{
    encoding->exposure = isnan(values->exposure) ? scene->exposure : (float)values->exposure;
    choose_look(&values->look, scene, encoding);
}

/* "640x480, 4 samples, depth 6, seed 0" and what else the pixels depend on. */
static void describe(const lr_encoding *encoding, const picture_origin *origin, char *text,
                     size_t size)
{
    FILE *out = fmemopen(text, size, "w");
    if (!out) {
        text[0] = '\0';
        return;
    }
    fputs(origin->settings, out);
    if (origin->frame) {
        fprintf(out, ", frame %u", origin->frame);
    }
    if (encoding->exposure != 0) {
        fprintf(out, ", exposure %.7g", (double)encoding->exposure);
    }
    describe_look(encoding, out);
    if (origin->denoiser) {
        fprintf(out, ", denoised by %s", origin->denoiser);
    }
    if (encoding->format == LR_FORMAT_PNG && encoding->transfer == LR_TRANSFER_LINEAR) {
        fputs(", linear", out);
    }
    fclose(out);
}

int write_picture(const lr_picture *picture, const char *path, lr_encoding encoding,
                  const picture_origin *origin)
{
    lr_error error = {0};
    char settings[LR_SETTINGS_TEXT + 400];
    describe(&encoding, origin, settings, sizeof settings);
    const lr_text texts[] = {
        {LR_STAMP_SOFTWARE, "lavaray " LR_VERSION},
        {LR_STAMP_SCENE, origin->scene_hash},
        {LR_STAMP_SETTINGS, settings},
        {LR_STAMP_PIXELS, origin->pixel_hash},
    };
    encoding.texts = texts;
    encoding.text_count = sizeof texts / sizeof *texts;
    lr_status status = lr_picture_write(picture, path, &encoding, &error);
    if (status == LR_OK) {
        return EXIT_FINE;
    }
    error.status = status;
    return report_failure(&error);
}
