/* The film of a whole picture on the host, as it grows, and its files: parts of renders and
 * checkpoints. */
#ifndef LR_RENDER_SUMS_H
#define LR_RENDER_SUMS_H

#include "render/film.h"
#include "render/settings.h"

/* What a picture is of; sums whose pictures are not the same are never added. */
typedef struct lr_picture_id {
    char software[40]; /* "lavaray 0.1.0" */
    char numbers[65];  /* lr_scene_hash */
    char settings[LR_SETTINGS_TEXT];
} lr_picture_id;

typedef struct lr_sums {
    lr_picture_id id;
    char scene[65];         /* hash of the scene's text: only for the file of the picture, */
    float exposure, white;  /* ... as are these: the scene's own, */
    lr_tone tone;           /* and this */
    uint32_t width, height; /* of the film */
    uint32_t samples;       /* of the whole picture, */
    uint32_t first, count;  /* and which of them these sums are to have */
    uint32_t *film;         /* LR_FILM_WORDS words a pixel */
} lr_sums;

/* Black sums for a picture. LR_ERROR_ARGUMENT: a file could not hold as many pixels. */
lr_status lr_sums_create(lr_sums *sums, const lr_scene *scene, const lr_settings *settings,
                         const lr_render_options *options, lr_error *error);
void lr_sums_free(lr_sums *sums);

static inline uint32_t *lr_sums_pixel(const lr_sums *sums, uint32_t x, uint32_t y)
{
    return &sums->film[((size_t)y * sums->width + x) * LR_FILM_WORDS];
}

/* The linear values, into 3 floats a pixel. */
void lr_sums_resolve(const lr_sums *sums, float *pixels);

/* The share of the samples that are there, 0 to 1. */
double lr_sums_done(const lr_sums *sums);

/* Writes the sums to path as an EXR file that replaces an older one only when it is complete. */
lr_status lr_sums_write(const lr_sums *sums, const char *path, lr_error *error);

/* Reads such a file, of which nothing is believed: LR_ERROR_FILE when it is something else,
 * damaged, or cut short. The caller frees *sums. */
lr_status lr_sums_read(const char *path, lr_sums *sums, lr_error *error);

/* The same from a file in memory; name stands for it in messages. */
lr_status lr_sums_decode(const unsigned char *bytes, size_t size, const char *name, lr_sums *sums,
                         lr_error *error);

#endif
