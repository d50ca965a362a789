/* How a picture is written, as flags that the commands share that write one of a render. */
#ifndef LR_CLI_ENCODING_H
#define LR_CLI_ENCODING_H

#include <stddef.h>
#include <stdio.h>

#include "cli/cli.h"
#include "cli/look.h"

/* A member of a command's values. */
typedef struct encoding_values {
    const char *output, *format, *transfer;
    int64_t maxval;  /* -1: not given */
    double exposure; /* NaN: not given */
    bool half;
    look_values look;
} encoding_values;

#define ENCODING_DEFAULTS                                                                          \
    {                                                                                              \
        .maxval = -1, .exposure = NAN                                                              \
    }

/* The lines of the table; `type` has a member `encoding` of the above. */
#define OUTPUT_OPTIONS(type)                                                                       \
    {.name = "output",                                                                             \
     .letter = 'o',                                                                                \
     .kind = OPTION_TEXT,                                                                          \
     .offset = offsetof(type, encoding.output),                                                    \
     .value = "FILE",                                                                              \
     .help = "the picture, in the format of its ending: .ppm, .png,\n"                             \
             ".pfm or .exr (linear floats); \"-\" is standard output",                             \
     .also = "out|file"},                                                                          \
    {                                                                                              \
        .name = "format", .kind = OPTION_CHOICE, .offset = offsetof(type, encoding.format),        \
        .value = "FORMAT", .choices = "ppm|png|pfm|exr",                                           \
        .help = "ppm, png, pfm or exr, whatever the name ends in;\n"                               \
                "default for standard output: ppm",                                                \
        .also = "type"                                                                             \
    }

#define ENCODING_OPTIONS(type)                                                                     \
    {.name = "maxval",                                                                             \
     .kind = OPTION_INTEGER,                                                                       \
     .offset = offsetof(type, encoding.maxval),                                                    \
     .value = "N",                                                                                 \
     .min = 1,                                                                                     \
     .max = 65535,                                                                                 \
     .help = "the value of white: 1 to 65535 for PPM, 255 or 65535\nfor PNG; default: 255",        \
     .also = "bits|bit-depth"},                                                                    \
        {.name = "transfer",                                                                       \
         .kind = OPTION_CHOICE,                                                                    \
         .offset = offsetof(type, encoding.transfer),                                              \
         .value = "CURVE",                                                                         \
         .choices = "srgb|linear",                                                                 \
         .help = "srgb (default) or linear; PFM and EXR are linear",                               \
         .also = "gamma"},                                                                         \
        {.name = "half",                                                                           \
         .kind = OPTION_FLAG,                                                                      \
         .offset = offsetof(type, encoding.half),                                                  \
         .help = "16-bit floats in EXR; default: 32 bits, exact",                                  \
         .also = "float|exr"},                                                                     \
        {.name = "exposure",                                                                       \
         .kind = OPTION_REAL,                                                                      \
         .offset = offsetof(type, encoding.exposure),                                              \
         .value = "EV",                                                                            \
         .min = -64,                                                                               \
         .max = 64,                                                                                \
         .help = "stops, -64 to 64; 1 is twice as bright;\ndefault: the scene's"},                 \
        LOOK_OPTIONS(type)

/* What the flags mean together, as far as no scene is needed for it. Returns an exit_code, having
 * printed what is wrong. */
int choose_encoding(const command *self, const encoding_values *values, lr_encoding *encoding);

/* Completes it by the exposure, tone map and white that the scene says. */
void finish_encoding(const encoding_values *values, const lr_scene_info *scene,
                     lr_encoding *encoding);

/* What a picture's file says about where it comes from. */
typedef struct picture_origin {
    const char *scene_hash; /* of its text */
    const char *settings;   /* of the render */
    const char *pixel_hash;
    const char *denoiser; /* NULL: not denoised */
    unsigned frame;       /* 0: not said */
} picture_origin;

/* Returns an exit_code, having printed what failed. */
int write_picture(const lr_picture *picture, const char *path, lr_encoding encoding,
                  const picture_origin *origin);

#endif
