/* What happens to light on its way into a picture for a screen. Built from + - * / alone, so the
 * bytes are the same on every machine. */
#ifndef LR_IMAGE_TONE_H
#define LR_IMAGE_TONE_H

#include "base/status.h"
#include "base/vec.h"

typedef struct image_tone {
    lr_tone kind;
    lr_transform in, out; /* AgX: from linear sRGB to drawn towards grey; from Rec. 2020 to sRGB */
    double *sigmoid, *power; /* AgX: tables */
} image_tone;

lr_status image_tone_create(image_tone *tone, lr_tone kind, lr_error *error);
void image_tone_free(image_tone *tone);

/* The colour that stands for this light, both linear sRGB; a channel may leave 0..1 and is to be
 * clipped. Negative light and NaN count as none. */
lr_vec3 image_tone_apply(const image_tone *tone, lr_vec3 light);

/* The map of linear sRGB that makes light of a colour temperature (LR_WHITE_MIN to LR_WHITE_MAX)
 * white and keeps its luminance. */
lr_transform image_white_balance(double kelvin);

#endif
