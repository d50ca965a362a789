/* What the writers of src/image share. */
#ifndef LR_IMAGE_INTERNAL_H
#define LR_IMAGE_INTERNAL_H

#include "image/image.h"
#include "image/tone.h"

/* Pixels on their way to integer samples. */
typedef struct image_encoder {
    const lr_picture *picture;
    const lr_encoding *encoding;
    lr_curve curve;  /* of formats with integers, */
    image_tone tone; /* ... and theirs */
    double scale;    /* 2^exposure */
    bool balanced;
    lr_transform balance;
    uint32_t
        sample_size; /* bytes: 1, or 2 with the most significant first, as PPM and PNG have it */
} image_encoder;

/* Writes one row of 3 * width samples. */
void image_encode_row(const image_encoder *encoder, uint32_t row, unsigned char *out);

/* A pixel with white balance, exposure and tone map applied. */
void image_adjust(const image_encoder *encoder, const float in[3], float out[3]);

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

/* Channels of an EXR file that lie together in memory. */
typedef struct image_exr_source {
    const char *name;    /* "", or of a layer */
    const char *letters; /* channels NAME.C, or C without a name; "": one that is called NAME */
    enum { IMAGE_EXR_FLOAT, IMAGE_EXR_HALF, IMAGE_EXR_UINT } type;
    const void *samples; /* of 4 bytes; halves are made of floats */
    size_t stride;       /* bytes from one pixel to the next */
    bool light;          /* colours as opposed to other numbers */
    bool adjusted;       /* ... that image_adjust changes: floats in threes; all halves are */
} image_exr_source;

typedef struct image_exr {
    uint32_t width, height;
    const image_exr_source *sources;
    uint32_t source_count;
    const lr_text *texts;
    uint32_t text_count;
    const image_encoder *encoder; /* NULL where nothing is adjusted */
    int zip_level;
    const char *what; /* for messages: "", or "the sums of " */
} image_exr;

/* The file in memory; the caller frees *bytes. */
lr_status image_exr_write(const image_exr *exr, unsigned char **bytes, size_t *size,
                          lr_error *error);

/* The nearest half, ties to even; finite values beyond the largest half become that one. */
uint16_t image_half(float value);

#endif
