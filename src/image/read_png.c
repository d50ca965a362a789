#include "image/read_internal.h"

#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

enum {
    SIGNATURE = 8,
    CHUNK_FRAME = 12,      /* length, type and checksum */
    CHUNK_LIMIT = 8 << 20, /* bytes */
    TEXT_LIMIT = 128,
};

/* Everything the reader allocates stands here, not in locals: libpng reports errors by longjmp. */
typedef struct png_input {
    const image_file *file;
    size_t at;
    lr_image *image;
    lr_error *error;
    png_structp png;
    png_infop info;
    unsigned char *raster;
    size_t row_size;
    char reason[128], warning[128]; /* libpng's, the last ones */
} png_input;

static void on_error(png_structp png, png_const_charp message)
{
    png_input *input = png_get_error_ptr(png);
    snprintf(input->reason, sizeof input->reason, "%s", message);
    png_longjmp(png, 1);
}

/* Warnings often say what the error that follows means. */
static void on_warning(png_structp png, png_const_charp message)
{
    png_input *input = png_get_error_ptr(png);
    snprintf(input->warning, sizeof input->warning, "%s", message);
}

static void on_read(png_structp png, png_bytep out, size_t size)
{
    png_input *input = png_get_io_ptr(png);
    if (size > input->file->size - input->at)
        png_error(png, "the file ends");
    memcpy(out, input->file->bytes + input->at, size);
    input->at += size;
}

/* Asks for whole samples of 8 or 16 bits, RGB in place of palettes and alpha in place of a
 * transparent colour, and sets the picture's shape to what that gives. */
static lr_status choose_samples(png_input *input)
{
    png_structp png = input->png;
    png_infop info = input->info;
    uint32_t bits = png_get_bit_depth(png, info);
    int type = png_get_color_type(png, info);
    bool alpha = (type & PNG_COLOR_MASK_ALPHA) != 0;
    if (type == PNG_COLOR_TYPE_PALETTE) {
        png_set_palette_to_rgb(png);
        bits = 8;
    } else if (bits < 8) {
        png_set_expand_gray_1_2_4_to_8(png);
    }
    if (png_get_valid(png, info, PNG_INFO_tRNS)) {
        png_set_tRNS_to_alpha(png);
        alpha = true;
    }
    input->image->maxval = (1u << bits) - 1;
    return image_set_size(input->file, input->image, png_get_image_width(png, info),
                          png_get_image_height(png, info),
                          (type & PNG_COLOR_MASK_COLOR ? 3 : 1) + alpha, input->error);
}

static void convert(const png_input *input, bool wide)
{
    lr_image *image = input->image;
    size_t count = (size_t)image->channels * image->width;
    for (uint32_t y = 0; y < image->height; y++) {
        const unsigned char *in = input->raster + y * input->row_size;
        float *out = image->samples + y * count;
        for (size_t i = 0; i < count; i++)
            out[i] = wide ? (float)(in[2 * i] * 256 + in[2 * i + 1]) / 65535 : (float)in[i] / 255;
    }
}

static lr_status keep_texts(png_input *input)
{
    png_textp texts;
    int count;
    lr_status status = LR_OK;
    png_get_text(input->png, input->info, &texts, &count);
    for (int i = 0; i < count && status == LR_OK; i++) {
        size_t length = texts[i].compression >= PNG_ITXT_COMPRESSION_NONE ? texts[i].itxt_length
                                                                          : texts[i].text_length;
        status = image_add_text(input->file, input->image, texts[i].key, strlen(texts[i].key),
                                texts[i].text, length, input->error);
    }
    return status;
}

/* Walks along the chunks to the last one. libpng would allocate what a chunk claims to hold. */
static lr_status check_chunks(const image_file *file, lr_error *error)
{
    for (size_t at = SIGNATURE;;) {
        if (file->size - at < CHUNK_FRAME)
            return image_truncated(file, error, "before the chunk IEND");
        const unsigned char *chunk = file->bytes + at;
        uint32_t length = png_get_uint_32(chunk);
        if (length > file->size - at - CHUNK_FRAME)
            return image_truncated(file, error, "the chunk at %zu needs %llu", at,
                                   at + CHUNK_FRAME + (unsigned long long)length);
        if (memcmp(chunk + 4, "IEND", 4) == 0)
            return LR_OK;
        at += CHUNK_FRAME + length;
    }
}

static lr_status say_failure(const png_input *input)
{
    if (input->warning[0])
        return image_corrupt(input->file, input->error, "%s: %s", input->reason, input->warning);
    return image_corrupt(input->file, input->error, "%s", input->reason);
}

static lr_status decode(png_input *input)
{
    lr_image *image = input->image;
    if (setjmp(png_jmpbuf(input->png)))
        return say_failure(input);
    png_set_read_fn(input->png, input, on_read);
    png_set_user_limits(input->png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    /* Compressed texts unfold a thousandfold. */
    png_set_chunk_malloc_max(input->png, CHUNK_LIMIT);
    png_set_chunk_cache_max(input->png, TEXT_LIMIT);
    png_read_info(input->png, input->info);
    lr_status status = choose_samples(input);
    if (status != LR_OK)
        return status;
    int passes = png_set_interlace_handling(input->png);
    png_read_update_info(input->png, input->info);
    if (png_get_channels(input->png, input->info) != image->channels)
        return image_corrupt(input->file, input->error, "the kind of pixels is unclear");
    status = image_allocate(input->file, image, input->error);
    if (status != LR_OK)
        return status;
    input->row_size = png_get_rowbytes(input->png, input->info);
    input->raster = lr_alloc(image->height, input->row_size);
    if (!input->raster)
        return lr_fail(input->error, LR_ERROR_MEMORY, "%.500s: out of memory", input->file->name);
    for (int pass = 0; pass < passes; pass++)
        for (uint32_t y = 0; y < image->height; y++)
            png_read_row(input->png, input->raster + y * input->row_size, NULL);
    png_read_end(input->png, input->info);
    convert(input, png_get_bit_depth(input->png, input->info) == 16);
    return keep_texts(input);
}

lr_status image_read_png(const image_file *file, lr_image *image, lr_error *error)
{
    png_input input = {.file = file, .image = image, .error = error};
    lr_status status = check_chunks(file, error);
    if (status != LR_OK)
        return status;
    input.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &input, on_error, on_warning);
    if (input.png)
        input.info = png_create_info_struct(input.png);
    if (input.info)
        status = decode(&input);
    else
        status = lr_fail(error, LR_ERROR_MEMORY, "%.500s: out of memory", file->name);
    png_destroy_read_struct(&input.png, &input.info, NULL);
    free(input.raster);
    return status;
}
