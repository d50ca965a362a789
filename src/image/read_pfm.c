/* PFM (http://www.pauldebevec.com/Research/HDR/PFM/): floats, the bottom row first. */
#define _GNU_SOURCE /* strtod_l */
#include "image/read_internal.h"

#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The scale: its sign is the byte order. Its absolute value is left alone, as programs disagree on
 * whether samples are to be multiplied by it or divided. */
static lr_status read_scale(image_header *header, double *scale, lr_error *error)
{
    char text[64];
    size_t length = 0;
    int character;
    do
        character = image_header_character(header);
    while (image_is_space(character));
    for (; character >= 0 && !image_is_space(character) && length < sizeof text - 1;
         character = image_header_character(header))
        text[length++] = (char)character;
    text[length] = 0;
    if (character < 0)
        return image_truncated(header->file, error, "within the header");

    locale_t locale = newlocale(LC_ALL_MASK, "C", NULL); /* for the decimal point */
    char *end = text;
    *scale = 0;
    if (locale) {
        *scale = strtod_l(text, &end, locale);
        freelocale(locale);
    }
    bool decimal = image_is_space(character) && strspn(text, "+-.0123456789eE") == length &&
                   end == text + length;
    if (!decimal || (float)*scale == 0 || !isfinite((float)*scale))
        return image_corrupt(header->file, error,
                             "the scale must be a number that is not 0, such as -1.0");
    return LR_OK;
}

static float read_float(const unsigned char *in, bool little_endian)
{
    uint32_t bits = 0;
    for (int i = 0; i < 4; i++)
        bits |= (uint32_t)in[i] << 8 * (little_endian ? i : 3 - i);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

lr_status image_read_pfm(const image_file *file, lr_image *image, lr_error *error)
{
    image_header header = {file, 2};
    uint32_t width, height, channels = file->bytes[1] == 'F' ? 3 : 1;
    double scale = 0;
    lr_status status = image_header_number(&header, "the width", UINT32_MAX, &width, error);
    if (status == LR_OK)
        status = image_header_number(&header, "the height", UINT32_MAX, &height, error);
    if (status == LR_OK)
        status = read_scale(&header, &scale, error);
    if (status == LR_OK)
        status = image_set_size(file, image, width, height, channels, error);
    if (status != LR_OK)
        return status;

    size_t count = (size_t)channels * width, size = 4 * count * height;
    if (file->size - header.at < size)
        return image_truncated(file, error, "%ux%u pixels need %zu", width, height,
                               header.at + size);
    status = image_allocate(file, image, error);
    if (status != LR_OK)
        return status;
    const unsigned char *in = file->bytes + header.at;
    for (uint32_t y = height; y-- > 0;)
        for (size_t i = 0; i < count; i++, in += 4)
            image->samples[y * count + i] = read_float(in, scale < 0);
    return LR_OK;
}
