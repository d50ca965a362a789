/* What the writers of src/image share. */
#ifndef LR_IMAGE_INTERNAL_H
#define LR_IMAGE_INTERNAL_H

#include "image/image.h"

/* Pixels on their way to integer samples. */
typedef struct image_encoder {
    const lr_picture *picture;
    const lr_encoding *encoding;
    lr_curve curve; /* of formats with integers */
    double scale;   /* 2^exposure */
    uint32_t
        sample_size; /* bytes: 1, or 2 with the most significant first, as PPM and PNG have it */
} image_encoder;

/* Writes one row of 3 * width samples. */
void image_encode_row(const image_encoder *encoder, uint32_t row, unsigned char *out);

/* The sample with the exposure applied. */
float image_exposed(const image_encoder *encoder, float value);

/* A file that grows in memory; the bytes are freed with free(). */
typedef struct image_buffer {
    unsigned char *bytes;
    size_t size, capacity;
} image_buffer;

/* Puts bytes at an offset, with zeros between the end and there; false when memory is out. */
bool image_buffer_write(image_buffer *buffer, size_t offset, const void *bytes, size_t size);

/* A PNG or EXR file in memory; the caller frees *bytes. */
lr_status image_encode_png(const image_encoder *encoder, unsigned char **bytes, size_t *size,
                           lr_error *error);
lr_status image_encode_exr(const image_encoder *encoder, unsigned char **bytes, size_t *size,
                           lr_error *error);

/* The nearest half, ties to even; finite values beyond the largest half become that one. */
uint16_t image_half(float value);

#endif
