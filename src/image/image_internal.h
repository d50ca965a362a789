/* What the writers of src/image share. */
#ifndef LR_IMAGE_INTERNAL_H
#define LR_IMAGE_INTERNAL_H

#include "image/image.h"

/* Pixels on their way to integer samples. */
typedef struct image_encoder {
    const lr_picture *picture;
    lr_transfer transfer;
    lr_curve curve;
    double scale; /* 2^exposure */
    uint32_t
        sample_size; /* bytes: 1, or 2 with the most significant first, as PPM and PNG have it */
} image_encoder;

/* Writes one row of 3 * width samples. */
void image_encode_row(const image_encoder *encoder, uint32_t row, unsigned char *out);

/* A PNG file in memory; the caller frees *bytes. */
lr_status image_encode_png(const image_encoder *encoder, unsigned char **bytes, size_t *size,
                           lr_error *error);

#endif
