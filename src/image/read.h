/* Pictures from files: PNM, PNG, PFM, EXR, Radiance HDR and JPEG, as the file holds them, before
 * any decision about colour. */
#ifndef LR_IMAGE_READ_H
#define LR_IMAGE_READ_H

#include "base/status.h"

#ifndef LR_IMAGE_MAX_SAMPLES
#define LR_IMAGE_MAX_SAMPLES (1 << 28) /* of one picture; more are refused */
#endif

/* A key and a value that the file carries beside its pixels, in the bytes that it has there. */
typedef struct lr_image_text {
    char *key, *value;
} lr_image_text;

typedef struct lr_image {
    uint32_t width, height;
    uint32_t channels; /* 1 grey, 2 grey + alpha, 3 RGB, 4 RGBA; alpha as stored */
    /* Of integer files, 1..65535: samples are value / maxval, still encoded (as a rule sRGB). 0:
     * floating point, linear; samples may be infinite or not a number. */
    uint32_t maxval;
    float *samples;       /* channels * width * height, interleaved, top row first */
    lr_image_text *texts; /* PNG text chunks, EXR string attributes, HDR header lines */
    uint32_t text_count;
} lr_image;

/* Reads the picture at path ("-" is standard input). The format is told from the content, not from
 * the name:
 *   PNM  P1 to P6, any maxval; the first picture of several. Bitmaps have maxval 1, 1 is white.
 *   PNG  all kinds; palettes become RGB and transparent colours alpha. Greys of 1, 2 and 4 bits
 *        have maxval 1, 3 and 15; gAMA and sRGB change nothing.
 *   PFM  PF and Pf; of the scale only the sign matters.
 *   EXR  the first part, flat, without B44 and DWA: R G B A or Y A, else those of the first layer
 *        that has some. The picture is the display window, 0 where there are no data.
 *   HDR  RGBE with rows from top to bottom; EXPOSURE is not applied.
 *   JPEG 8 bits, baseline and progressive, as they lie in the file: no rotation by EXIF.
 * LR_ERROR_FILE, with the path in the message, when the file cannot be read, is in no known format,
 * truncated, corrupt, empty of pixels, or larger than LR_IMAGE_MAX_SAMPLES; LR_ERROR_MEMORY. */
lr_status lr_image_read(const char *path, lr_image *image, lr_error *error);

/* The same from a file in memory; name stands for it in messages. */
lr_status lr_image_decode(const unsigned char *bytes, size_t size, const char *name,
                          lr_image *image, lr_error *error);

/* The value of a key, NULL when the picture has none. */
const char *lr_image_find_text(const lr_image *image, const char *key);

/* Accepts NULL and a zeroed image; leaves it zeroed. Failed reads leave nothing to free. */
void lr_image_free(lr_image *image);

#endif
