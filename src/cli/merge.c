#include "cli/cli.h"
#include "cli/encoding.h"
#include "cli/output.h"
#include "cli/progress.h"
#include "cli/stats.h"

#include <limits.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

typedef struct values {
    encoding_values encoding;
    bool partial, quiet;
} values;

static const option options[] = {
    OUTPUT_OPTIONS(values),
    ENCODING_OPTIONS(values),
    {.name = "partial",
     .kind = OPTION_FLAG,
     .offset = offsetof(values, partial),
     .help = "write what is there when parts are missing",
     .also = "incomplete|force"},
    {.name = "quiet",
     .letter = 'q',
     .kind = OPTION_FLAG,
     .offset = offsetof(values, quiet),
     .help = "no summary: only warnings and errors",
     .also = "silent"},
};

static int check_values(const command *self, const values *v, char *const *parts, int count,
                        lr_encoding *encoding)
{
    int code = choose_encoding(self, &v->encoding, encoding);
    if (code == EXIT_FINE) {
        code = check_writable(v->encoding.output);
    }
    for (int i = 0; i < count && code == EXIT_FINE; i++) {
        if (same_file(v->encoding.output, parts[i])) {
            code = wrong_usage(self, "the output would replace a part");
        }
    }
    return code == EXIT_FINE ? check_writable(v->encoding.output) : code;
}

/* Writes the picture and says so. */
static int write_merged(const values *v, const lr_picture *picture, const lr_merge_info *info,
                        int count, lr_encoding encoding, const render_record *denoised)
{
    char settings[sizeof info->settings + sizeof info->missing + 20];
    const lr_scene_info scene = {
        .exposure = info->exposure, .tone = info->tone, .white = info->white};
    finish_encoding(&v->encoding, &scene, &encoding);
    snprintf(settings, sizeof settings, info->missing[0] ? "%s, without samples %s" : "%s",
             info->settings, info->missing);
    const picture_origin origin = {
        .scene_hash = info->scene_hash,
        .settings = settings,
        .pixel_hash = denoised->denoiser ? denoised->denoised_hash : info->hash,
        .denoiser = denoised->denoiser,
    };
    int code = write_picture(picture, v->encoding.output, encoding, &origin);
    if (code == EXIT_FINE && info->missing[0]) {
        print_warning("samples %s are missing", info->missing);
    }
    if (code == EXIT_FINE && !v->quiet) {
        fprintf(stderr, "wrote %s, %u×%u, %u sample%s from %d part%s\n",
                strcmp(v->encoding.output, "-") == 0 ? "standard output" : v->encoding.output,
                (unsigned)picture->width, (unsigned)picture->height, (unsigned)info->samples,
                info->samples == 1 ? "" : "s", count, count == 1 ? "" : "s");
    }
    return code;
}

static int merge(const values *v, const char *const *parts, int count, const lr_encoding *encoding)
{
    lr_error error = {0};
    lr_picture picture = {0};
    lr_merge_info info;
    lr_denoiser *denoiser = NULL;
    render_record denoised = {0};
    progress bar;
    progress_start(&bar, v->quiet);
    lr_status status = v->encoding.look.denoise ? lr_denoiser_open(&denoiser, &error) : LR_OK;
    if (status == LR_OK) {
        status = lr_merge_parts(parts, (uint32_t)count, v->partial, &picture, &info, &error);
    }
    if (status == LR_OK) {
        status = denoise_picture(denoiser, &picture, &bar, &denoised, &error);
    }
    int code;
    if (status == LR_OK) {
        code = write_merged(v, &picture, &info, count, *encoding, &denoised);
    } else {
        error.status = status;
        code = report_failure(&error);
    }
    lr_denoiser_close(denoiser);
    lr_picture_free(&picture);
    return code;
}

static int run(const command *self, int argc, char **argv)
{
    values v = {.encoding = ENCODING_DEFAULTS};
    int count;
    parse_result parsed = options_parse(self, argc, argv, &v, &count);
    if (parsed != PARSE_OK) {
        return (int)parsed;
    }
    lr_encoding encoding = {0};
    int code = check_values(self, &v, argv, count, &encoding);
    return code == EXIT_FINE ? merge(&v, (const char *const *)argv, count, &encoding) : code;
}

const command command_merge = {
    .name = "merge",
    .operands = "PART... -o FILE",
    .summary = "make a picture of parts that were rendered apart",
    .details = "Adds up the parts that lavaray render --sample-range wrote, in any order, and\n"
               "writes the picture: the same pixels as one render of all samples.",
    .examples = "  lavaray render room.yaml -o a.exr --spp 64 --sample-range 0-31\n"
                "  lavaray render room.yaml -o b.exr --spp 64 --sample-range 32-63\n"
                "  lavaray merge a.exr b.exr -o room.png",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .min_operands = 1,
    .max_operands = INT_MAX,
    .run = run,
};
