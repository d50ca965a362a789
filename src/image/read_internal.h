/* What the readers of src/image share. Each reads a file in memory into a zeroed lr_image; when it
 * fails the caller frees what it left there. */
#ifndef LR_IMAGE_READ_INTERNAL_H
#define LR_IMAGE_READ_INTERNAL_H

#include "image/read.h"

typedef struct image_file {
    const unsigned char *bytes;
    size_t size;
    const char *name; /* for messages */
} image_file;

lr_status image_read_pnm(const image_file *file, lr_image *image, lr_error *error);
lr_status image_read_pfm(const image_file *file, lr_image *image, lr_error *error);
lr_status image_read_png(const image_file *file, lr_image *image, lr_error *error);
lr_status image_read_exr(const image_file *file, lr_image *image, lr_error *error);
lr_status image_read_hdr(const image_file *file, lr_image *image, lr_error *error);
lr_status image_read_jpeg(const image_file *file, lr_image *image, lr_error *error);

/* Sets the picture's shape; refuses none of width, none of height and too many samples. */
lr_status image_set_size(const image_file *file, lr_image *image, uint32_t width, uint32_t height,
                         uint32_t channels, lr_error *error);

/* Allocates the samples of a picture whose shape is set, as zeros. */
lr_status image_allocate(const image_file *file, lr_image *image, lr_error *error);

/* Keeps a text; at most some thousand of them. Bytes behind a NUL are dropped. */
lr_status image_add_text(const image_file *file, lr_image *image, const char *key,
                         size_t key_length, const char *value, size_t value_length,
                         lr_error *error);

/* "NAME: corrupt: ..." and "NAME: truncated: the file ends after N bytes, ..."; both
 * LR_ERROR_FILE. */
lr_status image_corrupt(const image_file *file, lr_error *error, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
lr_status image_truncated(const image_file *file, lr_error *error, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* The text header of PNM and PFM files: tokens between white space, where a comment from # to the
 * end of its line counts as white space. */
typedef struct image_header {
    const image_file *file;
    size_t at;
} image_header;

/* The next character, a comment as the line break behind it; -1 at the end of the file. */
int image_header_character(image_header *header);

bool image_is_space(int character);

/* The next decimal number, 0..limit; `what` names it in messages. One character of white space
 * behind it is consumed; the end of the file may take its place. */
lr_status image_header_number(image_header *header, const char *what, uint32_t limit,
                              uint32_t *value, lr_error *error);

#endif
