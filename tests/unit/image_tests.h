/* What the tests of picture readers share. */
#ifndef LR_TESTS_IMAGE_TESTS_H
#define LR_TESTS_IMAGE_TESTS_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "image/read.h"

#define BYTES(text) (const unsigned char *)(text), sizeof(text) - 1

static inline lr_image decode_bytes(const unsigned char *bytes, size_t size)
{
    lr_image image;
    lr_error error = {0};
    if (lr_image_decode(bytes, size, "file", &image, &error) != LR_OK)
        fail_msg("%s", error.message);
    return image;
}

/* The file must read as this shape; samples are channels * width * height of them. */
static inline void expect_image(const unsigned char *bytes, size_t size, uint32_t width,
                                uint32_t height, uint32_t channels, uint32_t maxval,
                                const float *samples)
{
    lr_image image = decode_bytes(bytes, size);
    assert_int_equal(image.width, width);
    assert_int_equal(image.height, height);
    assert_int_equal(image.channels, channels);
    assert_int_equal(image.maxval, maxval);
    for (size_t i = 0; i < (size_t)channels * width * height; i++)
        if (image.samples[i] != samples[i])
            fail_msg("sample %zu is %.9g, not %.9g", i, (double)image.samples[i],
                     (double)samples[i]);
    lr_image_free(&image);
    assert_null(image.samples);
}

/* The file must be refused with these words. The copy is as large as the file, so that a sanitizer
 * sees a read behind its end. */
static inline void expect_failure(const unsigned char *bytes, size_t size, const char *words)
{
    lr_image image;
    lr_error error = {0};
    unsigned char *copy = calloc(size ? size : 1, 1);
    memcpy(copy, bytes, size);
    lr_status status = lr_image_decode(copy, size, "dir/file", &image, &error);
    free(copy);
    if (status != LR_ERROR_FILE)
        fail_msg("status %d (%s) of %zu bytes, expected \"%s\"", (int)status, error.message, size,
                 words);
    if (!strstr(error.message, words) || strncmp(error.message, "dir/file: ", 10) != 0)
        fail_msg("%zu bytes: expected \"%s\", got \"%s\"", size, words, error.message);
    assert_null(image.samples);
    assert_null(image.texts);
}

/* Every shorter file is refused, those with at least `header` bytes as truncated. */
static inline void expect_truncations(const unsigned char *bytes, size_t size, size_t header)
{
    lr_image image = decode_bytes(bytes, size);
    lr_image_free(&image);
    for (size_t kept = 0; kept < size; kept++)
        expect_failure(bytes, kept, kept < header ? "" : "truncated: the file ends after ");
}

#endif
