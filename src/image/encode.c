#include "image/image_internal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/exact.h"
#include "base/memory.h"

#define EXPOSURE_LIMIT 200.0f /* stops; float32 spans 277 */

float lr_exposed(float value, double scale)
{
    return scale == 1 ? value : (float)(value * scale);
}

void image_adjust(const image_encoder *encoder, const float in[3], float out[3])
{
    const image_encoder *e = encoder;
    if (!e->balanced && e->tone.kind == LR_TONE_NONE) {
        for (int i = 0; i < 3; i++)
            out[i] = lr_exposed(in[i], e->scale);
        return;
    }
    lr_vec3 light = {in[0] * e->scale, in[1] * e->scale, in[2] * e->scale};
    if (e->balanced)
        light = lr_transform_vector(&e->balance, light);
    light = image_tone_apply(&e->tone, light);
    out[0] = (float)light.x;
    out[1] = (float)light.y;
    out[2] = (float)light.z;
}

bool image_buffer_write(image_buffer *buffer, size_t offset, const void *bytes, size_t size)
{
    if (size > SIZE_MAX - offset)
        return false;
    size_t end = offset + size;
    if (end > buffer->capacity) {
        size_t capacity = buffer->capacity ? buffer->capacity : 65536;
        while (capacity < end && capacity <= SIZE_MAX / 2)
            capacity *= 2;
        unsigned char *grown = capacity < end ? NULL : realloc(buffer->bytes, capacity);
        if (!grown)
            return false;
        buffer->bytes = grown;
        buffer->capacity = capacity;
    }
    if (offset > buffer->size)
        memset(buffer->bytes + buffer->size, 0, offset - buffer->size);
    memcpy(buffer->bytes + offset, bytes, size);
    buffer->size = end > buffer->size ? end : buffer->size;
    return true;
}

void image_encode_row(const image_encoder *encoder, uint32_t row, unsigned char *out)
{
    size_t count = 3 * (size_t)encoder->picture->width;
    const float *in = encoder->picture->pixels + row * count;
    for (size_t i = 0; i < count; i += 3) {
        float pixel[3];
        image_adjust(encoder, in + i, pixel);
        for (int k = 0; k < 3; k++) {
            uint32_t value = lr_curve_encode(&encoder->curve, pixel[k]);
            if (encoder->sample_size == 2)
                *out++ = (unsigned char)(value >> 8);
            *out++ = (unsigned char)value;
        }
    }
}

/* Allocates a header and room for the raster behind it; *raster points there. */
static lr_status begin_file(const image_encoder *encoder, const char *magic, const char *last_line,
                            size_t sample_size, unsigned char **bytes, size_t *size,
                            unsigned char **raster, lr_error *error)
{
    const lr_picture *picture = encoder->picture;
    char header[64];
    int header_size = snprintf(header, sizeof header, "%s\n%u %u\n%s\n", magic, picture->width,
                               picture->height, last_line);
    /* The pixels are in memory with 4 bytes a sample, so only the header can overflow the sum. */
    size_t raster_size = 3 * sample_size * picture->width * picture->height;
    if (raster_size <= SIZE_MAX - sizeof header)
        *bytes = malloc(raster_size + (size_t)header_size);
    if (!*bytes)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for a picture of %u x %u pixels",
                       picture->width, picture->height);
    memcpy(*bytes, header, (size_t)header_size);
    *size = raster_size + (size_t)header_size;
    *raster = *bytes + header_size;
    return LR_OK;
}

static lr_status encode_ppm(const image_encoder *encoder, unsigned char **bytes, size_t *size,
                            lr_error *error)
{
    char maxval[16];
    unsigned char *raster;
    snprintf(maxval, sizeof maxval, "%u", encoder->curve.maxval);
    lr_status status =
        begin_file(encoder, "P6", maxval, encoder->sample_size, bytes, size, &raster, error);
    if (status != LR_OK)
        return status;
    size_t row_size = 3 * (size_t)encoder->picture->width * encoder->sample_size;
    for (uint32_t y = 0; y < encoder->picture->height; y++)
        image_encode_row(encoder, y, raster + y * row_size);
    return LR_OK;
}

static unsigned char *put_float(unsigned char *out, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (int shift = 0; shift < 32; shift += 8)
        *out++ = (unsigned char)(bits >> shift);
    return out;
}

/* PFM puts the bottom row first, and a negative scale says little-endian. */
static lr_status encode_pfm(const image_encoder *encoder, unsigned char **bytes, size_t *size,
                            lr_error *error)
{
    unsigned char *out;
    lr_status status = begin_file(encoder, "PF", "-1.0", 4, bytes, size, &out, error);
    if (status != LR_OK)
        return status;
    size_t count = 3 * (size_t)encoder->picture->width;
    for (uint32_t y = encoder->picture->height; y-- > 0;)
        for (size_t i = 0; i < count; i += 3) {
            float pixel[3];
            image_adjust(encoder, encoder->picture->pixels + y * count + i, pixel);
            for (int k = 0; k < 3; k++)
                out = put_float(out, pixel[k]);
        }
    return LR_OK;
}

/* A name that PNG and EXR both take. */
static bool is_key(const char *key)
{
    size_t length = strlen(key);
    for (size_t i = 0; i < length; i++)
        if (key[i] <= ' ' || key[i] > '~')
            return false;
    return length >= 1 && length <= 31;
}

/* Of EXR's channels too, one of which a layer without letters is: R, G, B, A and Y are the
 * picture's. */
static bool is_layer(const lr_layer *layer)
{
    size_t letters = strlen(layer->channels), length = strlen(layer->name);
    bool good = is_key(layer->name) && length >= 2 && length <= 29 && !strchr(layer->name, '.');
    for (size_t i = 0; i < letters; i++) {
        char letter[2] = {layer->channels[i]};
        good &= is_key(letter) && letter[0] != '.' && !strchr(layer->channels + i + 1, letter[0]);
    }
    return good && (!layer->light || (strcmp(layer->channels, "RGB") == 0 && !layer->integers));
}

static lr_status check_layers(const lr_encoding *encoding, lr_error *error)
{
    if (encoding->layer_count && encoding->format != LR_FORMAT_EXR)
        return lr_fail(error, LR_ERROR_ARGUMENT, "only EXR files have layers");
    for (uint32_t i = 0; i < encoding->layer_count; i++) {
        const lr_layer *layer = &encoding->layers[i];
        bool good = is_layer(layer);
        for (uint32_t k = 0; k < i; k++)
            good &= strcmp(layer->name, encoding->layers[k].name) != 0;
        if (!good)
            return lr_fail(error, LR_ERROR_ARGUMENT,
                           "a layer '%s' with channels '%s' is not possible, or there are two",
                           layer->name, layer->channels);
    }
    return LR_OK;
}

static lr_status check(const lr_picture *picture, const lr_encoding *encoding, uint32_t maxval,
                       lr_error *error)
{
    if (!picture->pixels || picture->width == 0 || picture->height == 0)
        return lr_fail(error, LR_ERROR_ARGUMENT, "the picture is empty (%u x %u pixels)",
                       picture->width, picture->height);
    if (picture->width > SIZE_MAX / 12 / picture->height)
        return lr_fail(error, LR_ERROR_ARGUMENT, "a picture of %u x %u pixels is too large",
                       picture->width, picture->height);
    if (!(encoding->exposure >= -EXPOSURE_LIMIT && encoding->exposure <= EXPOSURE_LIMIT))
        return lr_fail(error, LR_ERROR_ARGUMENT, "exposure is %g stops; expected -%g to %g",
                       (double)encoding->exposure, (double)EXPOSURE_LIMIT, (double)EXPOSURE_LIMIT);
    if (encoding->white != 0 &&
        !(encoding->white >= LR_WHITE_MIN && encoding->white <= LR_WHITE_MAX))
        return lr_fail(error, LR_ERROR_ARGUMENT, "white is %g K; expected %d to %d",
                       (double)encoding->white, LR_WHITE_MIN, LR_WHITE_MAX);
    for (uint32_t i = 0; i < encoding->text_count; i++)
        if (!is_key(encoding->texts[i].key))
            return lr_fail(
                error, LR_ERROR_ARGUMENT,
                "the key '%s' of a text is not 1 to 31 printable ASCII characters without spaces",
                encoding->texts[i].key);
    if (encoding->format == LR_FORMAT_PNG && maxval != 255 && maxval != 65535)
        return lr_fail(error, LR_ERROR_ARGUMENT,
                       "maxval is %u, but PNG samples have 8 or 16 bits; expected 255 or 65535",
                       maxval);
    return check_layers(encoding, error);
}

lr_status lr_picture_encode(const lr_picture *picture, const lr_encoding *encoding,
                            unsigned char **bytes, size_t *size, lr_error *error)
{
    *bytes = NULL;
    *size = 0;
    uint32_t maxval = encoding->maxval ? encoding->maxval : 255;
    lr_status status = check(picture, encoding, maxval, error);
    if (status != LR_OK)
        return status;
    image_encoder encoder = {
        .picture = picture,
        .encoding = encoding,
        .scale = lr_exp2(encoding->exposure),
        .sample_size = maxval < 256 ? 1 : 2,
        .balanced = encoding->white != 0,
    };
    if (encoder.balanced)
        encoder.balance = image_white_balance(encoding->white);
    if (encoding->format == LR_FORMAT_PFM)
        return encode_pfm(&encoder, bytes, size, error);
    if (encoding->format == LR_FORMAT_EXR)
        return image_encode_exr(&encoder, bytes, size, error);
    status = image_tone_create(&encoder.tone, encoding->tone, error);
    if (status == LR_OK)
        status = lr_curve_create(&encoder.curve, encoding->transfer, maxval, error);
    if (status != LR_OK)
        goto done;
    switch (encoding->format) {
    case LR_FORMAT_PPM:
        status = encode_ppm(&encoder, bytes, size, error);
        break;
    case LR_FORMAT_PNG:
        status = image_encode_png(&encoder, bytes, size, error);
        break;
    default:
        status =
            lr_fail(error, LR_ERROR_ARGUMENT, "unknown image format %d", (int)encoding->format);
    }
done:
    lr_curve_free(&encoder.curve);
    image_tone_free(&encoder.tone);
    return status;
}
