/* The netpbm formats P1 to P6 (https://netpbm.sourceforge.net/doc/: pbm, pgm, ppm). */
#include "image/read_internal.h"

typedef struct pnm_input {
    image_header header; /* at the raster, once the header is read */
    bool plain, bitmap;
    uint32_t maxval;
} pnm_input;

static lr_status read_header(pnm_input *pnm, lr_image *image, lr_error *error)
{
    const image_file *file = pnm->header.file;
    char kind = (char)file->bytes[1];
    pnm->plain = kind <= '3';
    pnm->bitmap = kind == '1' || kind == '4';
    pnm->maxval = 1;
    pnm->header.at = 2;

    uint32_t width, height;
    lr_status status = image_header_number(&pnm->header, "the width", UINT32_MAX, &width, error);
    if (status == LR_OK)
        status = image_header_number(&pnm->header, "the height", UINT32_MAX, &height, error);
    if (status == LR_OK && !pnm->bitmap)
        status = image_header_number(&pnm->header, "the maximum value", 65535, &pnm->maxval, error);
    if (status != LR_OK)
        return status;
    if (pnm->maxval == 0)
        return image_corrupt(file, error, "the maximum value is 0; expected 1 to 65535");
    image->maxval = pnm->maxval;
    return image_set_size(file, image, width, height, kind == '3' || kind == '6' ? 3 : 1, error);
}

static lr_status above_maxval(const pnm_input *pnm, uint32_t value, uint32_t row, lr_error *error)
{
    return image_corrupt(pnm->header.file, error, "sample %u in row %u is above the maximum %u",
                         value, row, pnm->maxval);
}

static lr_status read_plain_sample(pnm_input *pnm, uint32_t *value, lr_error *error)
{
    if (!pnm->bitmap)
        return image_header_number(&pnm->header, "a sample", 65535, value, error);
    int character;
    do
        character = image_header_character(&pnm->header);
    while (image_is_space(character)); /* the digits need none between them */
    if (character < 0)
        return image_truncated(pnm->header.file, error, "before a pixel");
    if (character != '0' && character != '1')
        return image_corrupt(pnm->header.file, error, "byte 0x%02x at %zu in place of a pixel",
                             (unsigned)character, pnm->header.at - 1);
    *value = character == '0';
    return LR_OK;
}

static lr_status read_plain(pnm_input *pnm, lr_image *image, lr_error *error)
{
    const image_file *file = pnm->header.file;
    size_t row_count = (size_t)image->channels * image->width, count = row_count * image->height;
    /* Before the memory is taken: a number needs a digit and, but for the last, a space. */
    size_t least = pnm->bitmap ? count : 2 * count - 1;
    if (file->size - pnm->header.at < least)
        return image_truncated(file, error, "%ux%u pixels need at least %zu", image->width,
                               image->height, pnm->header.at + least);
    lr_status status = image_allocate(file, image, error);
    for (size_t i = 0; i < count && status == LR_OK; i++) {
        uint32_t value = 0;
        status = read_plain_sample(pnm, &value, error);
        if (status == LR_OK && value > pnm->maxval)
            status = above_maxval(pnm, value, (uint32_t)(i / row_count), error);
        image->samples[i] = (float)value / (float)pnm->maxval;
    }
    return status;
}

static lr_status read_raw_row(const pnm_input *pnm, const unsigned char *in, size_t count,
                              uint32_t row, float *out, lr_error *error)
{
    uint32_t largest = 0;
    for (size_t i = 0; i < count; i++) {
        uint32_t value = pnm->bitmap         ? ~in[i / 8] >> (7 - i % 8) & 1u
                         : pnm->maxval < 256 ? in[i]
                                             : in[2 * i] * 256u + in[2 * i + 1];
        largest = value > largest ? value : largest;
        out[i] = (float)value / (float)pnm->maxval;
    }
    return largest <= pnm->maxval ? LR_OK : above_maxval(pnm, largest, row, error);
}

static lr_status read_raw(pnm_input *pnm, lr_image *image, lr_error *error)
{
    const image_file *file = pnm->header.file;
    size_t count = (size_t)image->channels * image->width;
    size_t row_size = pnm->bitmap ? (count + 7) / 8 : pnm->maxval < 256 ? count : 2 * count;
    size_t size = row_size * image->height;
    if (file->size - pnm->header.at < size)
        return image_truncated(file, error, "%ux%u pixels need %zu", image->width, image->height,
                               pnm->header.at + size);
    lr_status status = image_allocate(file, image, error);
    const unsigned char *raster = file->bytes + pnm->header.at;
    for (uint32_t y = 0; y < image->height && status == LR_OK; y++)
        status =
            read_raw_row(pnm, raster + y * row_size, count, y, image->samples + y * count, error);
    return status;
}

lr_status image_read_pnm(const image_file *file, lr_image *image, lr_error *error)
{
    pnm_input pnm = {.header = {.file = file}};
    lr_status status = read_header(&pnm, image, error);
    if (status != LR_OK)
        return status;
    return pnm.plain ? read_plain(&pnm, image, error) : read_raw(&pnm, image, error);
}
