/* How light becomes the colours of a picture file: denoising, white balance, tone map. */
#ifndef LR_CLI_LOOK_H
#define LR_CLI_LOOK_H

#include <stddef.h>
#include <stdio.h>

#include "cli/cli.h"

struct progress;
struct render_record;

/* A member of encoding_values. */
typedef struct look_values {
    const char *tone; /* NULL: not given */
    double white;     /* 0: not given */
    bool denoise;
} look_values;

/* The lines of the table; `type` has a member `encoding` of encoding_values. */
#define LOOK_OPTIONS(type)                                                                         \
    {.name = "tone",                                                                               \
     .kind = OPTION_CHOICE,                                                                        \
     .offset = offsetof(type, encoding.look.tone),                                                 \
     .value = "MAP",                                                                               \
     .choices = "none|reinhard|aces|agx",                                                          \
     .help = "how light becomes a colour of PPM and PNG: none\n"                                   \
             "(clipped at 1), reinhard, aces or agx; default: the\n"                               \
             "scene's",                                                                            \
     .also = "tonemap|tone-map|view-transform"},                                                   \
        {.name = "white",                                                                          \
         .kind = OPTION_REAL,                                                                      \
         .offset = offsetof(type, encoding.look.white),                                            \
         .value = "K",                                                                             \
         .min = LR_WHITE_MIN,                                                                      \
         .max = LR_WHITE_MAX,                                                                      \
         .help = "white balance: light of this colour temperature, 1667\n"                         \
                 "to 25000 kelvin, becomes white; default: the scene's",                           \
         .also = "temperature|white-balance|kelvin"},                                              \
    {                                                                                              \
        .name = "denoise", .kind = OPTION_FLAG, .offset = offsetof(type, encoding.look.denoise),   \
        .help = "remove noise with Open Image Denoise, where it is\n"                              \
                "installed; its bytes may differ between computers",                               \
        .also = "denoiser|oidn"                                                                    \
    }

/* Whether the flags suit the format. Returns an exit_code, having printed what is wrong. */
int check_look(const command *self, const look_values *values, lr_format format);

/* What the flags say, else what the scene says. */
void choose_look(const look_values *values, const lr_scene_info *scene, lr_encoding *encoding);

/* ", tone aces, white 3200" of what is applied. */
void describe_look(const lr_encoding *encoding, FILE *out);

/* Denoises the picture, with the help of the record's layers albedo and normal where they are, and
 * notes it in the record; nothing if denoiser is NULL. The bar, which may be asked to stop it, is
 * cleared.
 */
lr_status denoise_picture(lr_denoiser *denoiser, lr_picture *picture, struct progress *bar,
                          struct render_record *record, lr_error *error);

#endif
