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
    image_buffer file;
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
    if (!image_buffer_write(&output->file, output->file.size, data, size))
        png_error(png, "out of memory");
}

static void on_flush(png_structp png)
{
    (void)png;
}

/* tEXt is Latin-1, so what is not ASCII goes into iTXt. */
static void add_text(png_output *output, const lr_text *text)
{
    bool ascii = true;
    for (const char *c = text->value; *c; c++)
        ascii = ascii && (unsigned char)*c < 128;
    png_text chunk = {
        .compression = ascii ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE,
        .key = (char *)text->key,
        .text = (char *)text->value,
    };
    png_set_text(output->png, output->info, &chunk, 1);
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
    if (encoder->encoding->transfer == LR_TRANSFER_SRGB) {
        png_set_sRGB(output->png, output->info, PNG_sRGB_INTENT_PERCEPTUAL);
        png_set_gAMA_fixed(output->png, output->info, 45455);
    } else {
        png_set_gAMA_fixed(output->png, output->info, 100000);
    }
    for (uint32_t i = 0; i < encoder->encoding->text_count; i++)
        add_text(output, &encoder->encoding->texts[i]);
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
        *bytes = output.file.bytes;
        *size = output.file.size;
        return LR_OK;
    }
    free(output.file.bytes);
    return lr_fail(error, LR_ERROR_MEMORY, "a PNG of %u x %u pixels cannot be made: %s",
                   picture->width, picture->height, output.reason);
}
