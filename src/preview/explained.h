/* An explained pixel for the window: a tree in short lines, and its rays as lines in the world. */
#ifndef LR_PREVIEW_EXPLAINED_H
#define LR_PREVIEW_EXPLAINED_H

#include "base/vec.h"
#include "lavaray.h"

typedef struct lr_ray_line {
    lr_vec3 from, to;
    uint32_t color; /* 0xRRGGBB */
    bool arrow;     /* it meets something at its end */
} lr_ray_line;

typedef struct lr_explained_pixel {
    char *text;
    lr_ray_line *lines;
    uint32_t line_count;
    bool meets;  /* its camera ray meets something, */
    lr_vec3 met; /* here */
} lr_explained_pixel;

/* Rays that see nothing, and those to lights that are nowhere, end after `far` metres. NULL when
 * memory is out; freed with lr_explained_pixel_free, which accepts NULL. */
lr_explained_pixel *lr_explained_pixel_create(const lr_scene *scene, const lr_explanation *pixel,
                                              double far);
void lr_explained_pixel_free(lr_explained_pixel *pixel);

#endif
