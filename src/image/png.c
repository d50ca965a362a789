#include "image/image_internal.h"

#include <png.h>
#include <stdlib.h>
#include <string.h>

/* Everything the writer allocates stands here, not in locals: libpng reports errors by longjmp. */
typedef struct png_output {
    const image_encoder *encoder;
    png_structp png;
    png_infop info;
    unsigned char *row;
    unsigned char *bytes;
    size_t size, capacity;
    char reason[128];
} png_output;

static void on_error(png_structp png, png_const_charp message)
{
    png_output *output = png_get_error_ptr(png);
    strncpy(output->reason, message, sizeof output->reason - 1);
    png_longjmp(png, 1);
}

/* libpng prints warnings unless it is given somewhere else to put them. */
static void on_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

static void on_data(png_structp png, png_bytep data, size_t size)
{
    png_output *output = png_get_io_ptr(png);
    if (size > output->capacity - output->size) {
        size_t capacity = output->capacity ? output->capacity : 65536;
        while (capacity - output->size < size) {
            if (capacity > SIZE_MAX / 2)
                png_error(png, "out of memory");
            capacity *= 2;
        }
        unsigned char *grown = realloc(output->bytes, capacity);
        if (!grown)
            png_error(png, "out of memory");
        output->bytes = grown;
        output->capacity = capacity;
    }
    memcpy(output->bytes + output->size, data, size);
    output->size += size;
}

static void on_flush(png_structp png)
{
    (void)png;
}

static bool encode(png_output *output)
{
    const image_encoder *encoder = output->encoder;
    const lr_picture *picture = encoder->picture;
    if (setjmp(png_jmpbuf(output->png)))
        return false;
    png_set_write_fn(output->png, output, on_data, on_flush);
    png_set_user_limits(output->png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_IHDR(output->png, output->info, picture->width, picture->height,
                 (int)encoder->sample_size * 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (encoder->transfer == LR_TRANSFER_SRGB) {
        png_set_sRGB(output->png, output->info, PNG_sRGB_INTENT_PERCEPTUAL);
        png_set_gAMA_fixed(output->png, output->info, 45455);
    } else {
        png_set_gAMA_fixed(output->png, output->info, 100000);
    }
    png_write_info(output->png, output->info);
    for (uint32_t y = 0; y < picture->height; y++) {
        image_encode_row(encoder, y, output->row);
        png_write_row(output->png, output->row);
    }
    png_write_end(output->png, NULL);
    return true;
}

lr_status image_encode_png(const image_encoder *encoder, unsigned char **bytes, size_t *size,
                           lr_error *error)
{
    png_output output = {.encoder = encoder, .reason = "out of memory"};
    const lr_picture *picture = encoder->picture;
    bool done = false;
    output.row = malloc(3 * (size_t)picture->width * encoder->sample_size);
    output.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &output, on_error, on_warning);
    if (output.png)
        output.info = png_create_info_struct(output.png);
    if (output.row && output.info)
        done = encode(&output);
    png_destroy_write_struct(&output.png, &output.info);
    free(output.row);
    if (done) {
        *bytes = output.bytes;
        *size = output.size;
        return LR_OK;
    }
    free(output.bytes);
    return lr_fail(error, LR_ERROR_MEMORY, "a PNG of %u x %u pixels cannot be made: %s",
                   picture->width, picture->height, output.reason);
}
