/* What a picture depends on beside its scene, as flags that all the commands share that trace rays,
 * and the device that does it. */
#ifndef LR_CLI_PICTURE_H
#define LR_CLI_PICTURE_H

#include <stddef.h>

#include "cli/cli.h"

/* A member of a command's values. */
typedef struct picture_values {
    option_size size;
    int64_t samples, depth, seed; /* -1: not given */
    const char *integrator, *filter, *camera, *device;
} picture_values;

#define PICTURE_DEFAULTS                                                                           \
    {                                                                                              \
        .samples = -1, .depth = -1, .seed = -1                                                     \
    }

/* The lines of the table; `type` has a member `picture` of the above. */
#define PICTURE_OPTIONS(type)                                                                      \
    {.name = "size",                                                                               \
     .kind = OPTION_SIZE,                                                                          \
     .offset = offsetof(type, picture.size),                                                       \
     .value = "WxH",                                                                               \
     .min = 1,                                                                                     \
     .max = 32768,                                                                                 \
     .help = "width and height in pixels; default: the scene's",                                   \
     .also = "width|height|resolution|res"},                                                       \
        {.name = "spp",                                                                            \
         .kind = OPTION_INTEGER,                                                                   \
         .offset = offsetof(type, picture.samples),                                                \
         .value = "N",                                                                             \
         .min = 1,                                                                                 \
         .max = 65536,                                                                             \
         .help = "samples per pixel, 1 to 65536; default: the scene's",                            \
         .also = "samples"},                                                                       \
        {.name = "depth",                                                                          \
         .kind = OPTION_INTEGER,                                                                   \
         .offset = offsetof(type, picture.depth),                                                  \
         .value = "N",                                                                             \
         .min = 0,                                                                                 \
         .max = 64,                                                                                \
         .help = "bounces, 0 to 64, 0 being what the eye sees directly;\ndefault: the scene's",    \
         .also = "bounces|max-depth"},                                                             \
        {.name = "seed",                                                                           \
         .kind = OPTION_INTEGER,                                                                   \
         .offset = offsetof(type, picture.seed),                                                   \
         .value = "N",                                                                             \
         .min = 0,                                                                                 \
         .max = UINT32_MAX,                                                                        \
         .help = "of the random numbers, 0 to 4294967295;\ndefault: the scene's"},                 \
        {.name = "integrator",                                                                     \
         .kind = OPTION_CHOICE,                                                                    \
         .offset = offsetof(type, picture.integrator),                                             \
         .value = "NAME",                                                                          \
         .choices = "whitted|path",                                                                \
         .help = "whitted: mirrors, glass and direct light; path: all\n"                           \
                 "ways of light, by chance; default: the scene's",                                 \
         .also = "renderer|method"},                                                               \
        {.name = "filter",                                                                         \
         .kind = OPTION_CHOICE,                                                                    \
         .offset = offsetof(type, picture.filter),                                                 \
         .value = "NAME",                                                                          \
         .choices = "box|tent|blackman-harris",                                                    \
         .help = "of pixels: box, tent or blackman-harris; default: the\nscene's",                 \
         .also = "pixel-filter|reconstruction"},                                                   \
        {.name = "camera",                                                                         \
         .kind = OPTION_TEXT,                                                                      \
         .offset = offsetof(type, picture.camera),                                                 \
         .value = "NAME",                                                                          \
         .help = "of the scene's cameras; default: the first"},                                    \
    {                                                                                              \
        .name = "device", .kind = OPTION_TEXT, .offset = offsetof(type, picture.device),           \
        .value = "WHICH",                                                                          \
        .help = "auto (default: a GPU before a CPU), cpu, gpu, or the\n"                           \
                "index or part of the name that lavaray devices shows",                            \
        .also = "gpu|cpu"                                                                          \
    }

lr_render_options picture_options(const picture_values *values);

#endif
