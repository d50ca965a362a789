/* Radiance pictures (G. Ward, "Real Pixels", Graphics Gems II; the Radiance reference manual,
 * "Picture file format"): three mantissas and an exponent a pixel, rows from top to bottom. */
#include "image/read_internal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

enum { LEAST_PLANAR = 8, MOST_PLANAR = 32767 }; /* the widths that rows of planes can have */

typedef struct hdr_input {
    const image_file *file;
    size_t at;
    unsigned char *row; /* 4 bytes a pixel: red, green, blue, exponent */
    float scales[256];  /* of the mantissas, by exponent */
} hdr_input;

/* The next line without its end, false when the file ends before that. */
static bool read_line(hdr_input *hdr, const char **line, size_t *length)
{
    const char *start = (const char *)hdr->file->bytes + hdr->at;
    const char *end = memchr(start, '\n', hdr->file->size - hdr->at);
    if (!end)
        return false;
    hdr->at += (size_t)(end - start) + 1;
    *line = start;
    *length = (size_t)(end - start);
    return true;
}

static lr_status read_variables(hdr_input *hdr, lr_image *image, lr_error *error)
{
    static const char xyze[] = "FORMAT=32-bit_rle_xyze";
    const char *line;
    size_t length;
    do {
        if (!read_line(hdr, &line, &length))
            return image_truncated(hdr->file, error, "within the header");
        if (length >= sizeof xyze - 1 && memcmp(line, xyze, sizeof xyze - 1) == 0)
            return lr_fail(error, LR_ERROR_FILE,
                           "%.500s: holds XYZ colours; convert it with ra_xyze -r",
                           hdr->file->name);
        const char *equals = memchr(line, '=', length);
        size_t key_length = equals ? (size_t)(equals - line) : 0;
        if (key_length == 0 || line[0] == '#')
            continue;
        lr_status status = image_add_text(hdr->file, image, line, key_length, equals + 1,
                                          length - key_length - 1, error);
        if (status != LR_OK)
            return status;
    } while (length > 0);
    return LR_OK;
}

static lr_status read_resolution(hdr_input *hdr, lr_image *image, lr_error *error)
{
    const char *line;
    size_t length;
    if (!read_line(hdr, &line, &length))
        return image_truncated(hdr->file, error, "within the header");
    char text[64], extra;
    unsigned long long width, height;
    snprintf(text, sizeof text, "%.*s", length < sizeof text ? (int)length : 0, line);
    /* 10 digits cannot overflow the numbers. */
    if (sscanf(text, "-Y %10llu +X %10llu %c", &height, &width, &extra) != 2)
        return image_corrupt(hdr->file, error,
                             "the resolution line is \"%s\"; expected \"-Y HEIGHT +X WIDTH\"",
                             text);
    if (width > UINT32_MAX || height > UINT32_MAX)
        return image_corrupt(hdr->file, error, "the size is %llu x %llu", width, height);
    return image_set_size(hdr->file, image, (uint32_t)width, (uint32_t)height, 3, error);
}

static lr_status row_truncated(const hdr_input *hdr, const lr_image *image, uint32_t y,
                               lr_error *error)
{
    return image_truncated(hdr->file, error, "in row %u of %u", y, image->height);
}

/* A row of four planes, each as runs: a count above 128 repeats the next byte, another copies as
 * many. */
static lr_status read_planes(hdr_input *hdr, const lr_image *image, uint32_t y, lr_error *error)
{
    const unsigned char *bytes = hdr->file->bytes;
    hdr->at += 4;
    for (uint32_t plane = 0; plane < 4; plane++)
        for (uint32_t x = 0; x < image->width;) {
            if (hdr->at == hdr->file->size)
                return row_truncated(hdr, image, y, error);
            uint32_t count = bytes[hdr->at++];
            bool repeat = count > 128;
            count -= repeat ? 128 : 0;
            if (count == 0 || count > image->width - x)
                return image_corrupt(hdr->file, error, "a run of %u pixels in row %u", count, y);
            if (hdr->file->size - hdr->at < (repeat ? 1 : count))
                return row_truncated(hdr, image, y, error);
            for (uint32_t i = 0; i < count; i++, x++)
                hdr->row[4 * x + plane] = bytes[repeat ? hdr->at : hdr->at + i];
            hdr->at += repeat ? 1 : count;
        }
    return LR_OK;
}

/* A row of whole pixels. 1 1 1 n repeats the one before n times; in n of several such in sequence
 * each counts 256 times as much as the one before. */
static lr_status read_pixels(hdr_input *hdr, const lr_image *image, uint32_t y, lr_error *error)
{
    unsigned shift = 0;
    for (uint32_t x = 0; x < image->width;) {
        if (hdr->file->size - hdr->at < 4)
            return row_truncated(hdr, image, y, error);
        const unsigned char *pixel = hdr->file->bytes + hdr->at;
        unsigned char *out = hdr->row + 4 * (size_t)x;
        hdr->at += 4;
        if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
            memcpy(out, pixel, 4);
            shift = 0;
            x++;
            continue;
        }
        uint64_t count = (uint64_t)pixel[3] << shift;
        if (x == 0 || shift > 24 || count > image->width - x)
            return image_corrupt(hdr->file, error, "a run of pixels that does not fit in row %u",
                                 y);
        for (uint64_t i = 0; i < 4 * count; i++)
            out[i] = out[(int64_t)(i % 4) - 4];
        shift += 8;
        x += (uint32_t)count;
    }
    return LR_OK;
}

static lr_status read_row(hdr_input *hdr, const lr_image *image, uint32_t y, lr_error *error)
{
    const unsigned char *start = hdr->file->bytes + hdr->at;
    bool planes = image->width >= LEAST_PLANAR && image->width <= MOST_PLANAR &&
                  hdr->file->size - hdr->at >= 4 && start[0] == 2 && start[1] == 2 &&
                  start[2] < 128;
    if (!planes)
        return read_pixels(hdr, image, y, error);
    uint32_t width = start[2] * 256u + start[3];
    if (width != image->width)
        return image_corrupt(hdr->file, error, "row %u has %u pixels, not %u", y, width,
                             image->width);
    return read_planes(hdr, image, y, error);
}

static lr_status read_raster(hdr_input *hdr, lr_image *image, lr_error *error)
{
    size_t left = hdr->file->size - hdr->at;
    /* Before the memory is taken: the shortest row is one pixel. */
    if (left / 4 < image->height)
        return image_truncated(hdr->file, error, "%u rows need at least %llu", image->height,
                               hdr->at + 4ull * image->height);
    lr_status status = image_allocate(hdr->file, image, error);
    if (status != LR_OK)
        return status;
    hdr->row = lr_alloc(image->width, 4);
    if (!hdr->row)
        return lr_fail(error, LR_ERROR_MEMORY, "%.500s: out of memory", hdr->file->name);
    /* The exponent is of 1/256ths, biased by 128; 0 means black. */
    for (int exponent = 1; exponent < 256; exponent++)
        hdr->scales[exponent] = ldexpf(1, exponent - 136);
    float *out = image->samples;
    for (uint32_t y = 0; y < image->height && status == LR_OK; y++) {
        status = read_row(hdr, image, y, error);
        for (uint32_t x = 0; x < image->width; x++)
            for (int i = 0; i < 3; i++)
                *out++ = hdr->row[4 * x + i] * hdr->scales[hdr->row[4 * x + 3]];
    }
    free(hdr->row);
    return status;
}

lr_status image_read_hdr(const image_file *file, lr_image *image, lr_error *error)
{
    hdr_input hdr = {.file = file};
    lr_status status = read_variables(&hdr, image, error);
    if (status == LR_OK)
        status = read_resolution(&hdr, image, error);
    return status == LR_OK ? read_raster(&hdr, image, error) : status;
}
