/* Pictures in memory to bytes in files: transfer curves and the PPM, PNG, PFM and EXR writers. The
 * public half (lr_picture, lr_encoding, lr_picture_write, lr_picture_hash) is in lavaray.h. */
#ifndef LR_IMAGE_IMAGE_H
#define LR_IMAGE_IMAGE_H

#include "base/status.h"

/* What pictures say about where they come from, in lr_encoding's texts. */
#define LR_STAMP_SOFTWARE "Software"
#define LR_STAMP_SCENE "lavaray.scene"
#define LR_STAMP_SETTINGS "lavaray.settings"
#define LR_STAMP_PIXELS "lavaray.pixels"

/* A transfer curve as an integer threshold table: a linear value encodes to the number of
 * thresholds that it reaches. Built from + - * / alone, so it is the same on every machine. */
typedef struct lr_curve {
    uint32_t maxval;
    float *thresholds; /* maxval of them, increasing */
    /* Where the search begins: the encoded value of the smallest float whose bits, shifted right by
     * `shift`, are `first` + index. */
    uint16_t *starts;
    uint32_t first, shift;
} lr_curve;

/* Builds the curve that rounds the transfer function's value times maxval to the nearest integer,
 * 1 <= maxval <= 65535. */
lr_status lr_curve_create(lr_curve *curve, lr_transfer transfer, uint32_t maxval, lr_error *error);
void lr_curve_free(lr_curve *curve);

/* The encoded value, 0..maxval; NaN and negative values encode to 0. */
uint32_t lr_curve_encode(const lr_curve *curve, float linear);

/* A value with the exposure applied, before it is encoded: times scale, 2^stops. */
float lr_exposed(float value, double scale);

/* Encodes the whole picture in memory; the caller frees *bytes. */
lr_status lr_picture_encode(const lr_picture *picture, const lr_encoding *encoding,
                            unsigned char **bytes, size_t *size, lr_error *error);

#endif
