/* JPEG by stb_image. The library reads on behind the end of a file as if zeros followed, and
 * version 2.27 writes beyond its tables of codes when a file gives too many of them. So a walk over
 * the markers, which finds the same ones as the library's, comes first. */
#include "image/read_internal.h"

#include <limits.h>
#include <stdlib.h>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
/* Version 2.27 uses tables that a file never gave. Of zeros they are harmless, and the same each
 * time.
 */
#define STBI_MALLOC(size) calloc(1, size)
#define STBI_REALLOC(memory, size) realloc(memory, size)
#define STBI_FREE(memory) free(memory)
#define STBI_NO_SIMD /* one set of arithmetic on all processors */
#include <stb/stb_image.h>

enum {
    MARKER_CODES = 0xC4,
    MARKER_END = 0xD9,
    MARKER_SCAN = 0xDA,
    /* A few bytes can ask for one more pass over all pixels; encoders write about ten. */
    SCANS_LIMIT = 100,
};

/* Of a marker that stands alone within the coded pixels, or of a byte that is no marker. */
static bool is_part_of_scan(unsigned char code)
{
    return code == 0x00 || code == 0x01 || code == 0xFF || (code >= 0xD0 && code <= 0xD8);
}

/* A segment of code tables: for each its number, how many codes it has of 1 to 16 bits, and a byte
 * for each code. */
static lr_status check_codes(const image_file *file, size_t at, size_t end, lr_error *error)
{
    while (end - at >= 17) {
        size_t codes = 0;
        for (size_t i = 1; i <= 16; i++)
            codes += file->bytes[at + i];
        if (codes > 256)
            return image_corrupt(file, error, "the table at %zu has %zu codes", at, codes);
        if (codes > end - at - 17)
            break;
        at += 17 + codes;
    }
    return at == end ? LR_OK
                     : image_corrupt(file, error, "the segment that ends at %zu is cut short", end);
}

static lr_status check_markers(const image_file *file, lr_error *error)
{
    const unsigned char *bytes = file->bytes;
    unsigned scans = 0;
    for (size_t at = 2; file->size - at >= 2;) {
        if (bytes[at] != 0xFF || is_part_of_scan(bytes[at + 1])) {
            at++;
            continue;
        }
        if (bytes[at + 1] == MARKER_END)
            return LR_OK;
        if (file->size - at < 4)
            break;
        if (bytes[at + 1] == MARKER_SCAN && ++scans > SCANS_LIMIT)
            return image_corrupt(file, error, "more than %d passes over the pixels", SCANS_LIMIT);
        size_t length = bytes[at + 2] * 256u + bytes[at + 3];
        if (length < 2)
            return image_corrupt(file, error, "the segment at %zu has a length of %zu", at, length);
        if (length > file->size - at - 2)
            return image_truncated(file, error, "the segment at %zu needs %zu", at,
                                   at + 2 + length);
        lr_status status = LR_OK;
        if (bytes[at + 1] == MARKER_CODES)
            status = check_codes(file, at + 4, at + 2 + length, error);
        if (status != LR_OK)
            return status;
        at += 2 + length;
    }
    return image_truncated(file, error, "before the marker of its end");
}

lr_status image_read_jpeg(const image_file *file, lr_image *image, lr_error *error)
{
    int width, height, channels;
    if (file->size > INT_MAX)
        return image_corrupt(file, error, "more than %d bytes", INT_MAX);
    lr_status status = check_markers(file, error);
    if (status != LR_OK)
        return status;
    int size = (int)file->size;
    if (!stbi_info_from_memory(file->bytes, size, &width, &height, &channels))
        return image_corrupt(file, error, "%s", stbi_failure_reason());
    status =
        image_set_size(file, image, (uint32_t)width, (uint32_t)height, (uint32_t)channels, error);
    if (status != LR_OK)
        return status;
    unsigned char *raster =
        stbi_load_from_memory(file->bytes, size, &width, &height, &channels, channels);
    if (!raster)
        return image_corrupt(file, error, "%s", stbi_failure_reason());
    image->maxval = 255;
    status = image_allocate(file, image, error);
    size_t count = (size_t)image->channels * image->width * image->height;
    for (size_t i = 0; status == LR_OK && i < count; i++)
        image->samples[i] = (float)raster[i] / 255;
    stbi_image_free(raster);
    return status;
}
