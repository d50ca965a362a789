/* EXR files of 32-bit words: whole numbers that no rounding may touch, in UINT channels that other
 * programs show, beside the picture that they make. */
#ifndef LR_IMAGE_WORDS_H
#define LR_IMAGE_WORDS_H

#include "image/image.h"
#include "image/read.h"

/* Channels of whole numbers. */
typedef struct lr_words {
    const char *const *names;
    uint32_t count;  /* of channels; up to LR_WORDS_MAX */
    uint32_t *words; /* count * width * height, interleaved, top row first */
} lr_words;

#define LR_WORDS_MAX 16

/* An EXR of the picture's R, G and B as 32-bit floats and of the words; the caller frees *bytes.
 * The texts are as those of lr_encoding. */
lr_status lr_words_encode(const lr_picture *picture, const lr_words *words, const lr_text *texts,
                          uint32_t text_count, unsigned char **bytes, size_t *size,
                          lr_error *error);

/* Reads the UINT channels of these names from an EXR in memory, as the samples of *image, whose
 * bits are the words: count * width * height of them, interleaved. name stands for the file in
 * messages. Fails as lr_image_read does; LR_ERROR_FILE also where a channel is missing or holds
 * floats. */
lr_status lr_words_decode(const unsigned char *bytes, size_t size, const char *name,
                          const char *const *names, uint32_t count, lr_image *image,
                          lr_error *error);

#endif
