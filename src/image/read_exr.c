/* OpenEXR through its C library, OpenEXRCore. */
#include "image/read_internal.h"

#include <OpenEXR/openexr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/words.h"

typedef struct exr_input {
    const image_file *file;
    lr_image *image;
    lr_error *error;
    exr_context_t context;
    exr_storage_t storage;
    exr_attr_box2i_t data, display; /* windows; the last pixel is inside */
    const char *const *words;       /* NULL, or the channels to read as they are */
    uint32_t word_count;
    int32_t channels[LR_WORDS_MAX]; /* where each of the picture's is in the file's list */
    bool truncated;                 /* the last read went past the end */
    char reason[200];               /* the library's, the first one */
} exr_input;

static void on_error(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)code;
    void *input = NULL;
    if (!context || exr_get_user_data(context, &input) != EXR_ERR_SUCCESS || !input)
        return;
    exr_input *exr = input;
    if (!exr->reason[0])
        snprintf(exr->reason, sizeof exr->reason, "%s", message);
}

static int64_t on_read(exr_const_context_t context, void *user, void *buffer, uint64_t size,
                       uint64_t offset, exr_stream_error_func_ptr_t error_cb)
{
    (void)context;
    (void)error_cb;
    exr_input *exr = user;
    uint64_t left = offset < exr->file->size ? exr->file->size - offset : 0;
    exr->truncated = size > left;
    uint64_t count = size < left ? size : left;
    memcpy(buffer, exr->file->bytes + (offset < exr->file->size ? offset : 0), count);
    return (int64_t)count;
}

/* A size that bounds what the library allocates for the header, and leaves room for its reads to
 * run into the end of the file: that tells truncated files from corrupt ones. */
static int64_t on_size(exr_const_context_t context, void *user)
{
    (void)context;
    const exr_input *exr = user;
    return (int64_t)exr->file->size * 4 + (16 << 20);
}

/* Zeroed, so that what a corrupt file leaves unset is the same every time. */
static void *allocate(size_t size)
{
    return lr_alloc(size, 1);
}

static lr_status say_failure(const exr_input *exr, exr_result_t code, const char *where)
{
    if (code == EXR_ERR_OUT_OF_MEMORY)
        return lr_fail(exr->error, LR_ERROR_MEMORY, "%.500s: out of memory %s", exr->file->name,
                       where);
    if (exr->truncated)
        return image_truncated(exr->file, exr->error, "%s", where);
    return image_corrupt(exr->file, exr->error, "%s: %s", where,
                         exr->reason[0] ? exr->reason : exr_get_default_error_message(code));
}

static lr_status refuse(const exr_input *exr, const char *what)
{
    return lr_fail(exr->error, LR_ERROR_FILE, "%.500s: %s", exr->file->name, what);
}

/* ---- The header --------------------------------------------------------------------------- */

/* The channel of a layer ("" or "NAME."), -1 for none. */
static int32_t find_channel(const exr_attr_chlist_t *list, const char *layer, size_t layer_length,
                            const char *name)
{
    for (int32_t i = 0; i < list->num_channels; i++) {
        const char *entry = list->entries[i].name.str;
        if (strncmp(entry, layer, layer_length) == 0 && strcmp(entry + layer_length, name) == 0)
            return i;
    }
    return -1;
}

/* Finds R G B or Y, and A with them; returns their number, 0 when the layer has neither. */
static uint32_t find_layer(exr_input *exr, const exr_attr_chlist_t *list, const char *layer,
                           size_t length)
{
    static const char *const names[2][3] = {{"R", "G", "B"}, {"Y", NULL, NULL}};
    for (int kind = 0; kind < 2; kind++) {
        uint32_t wanted = kind == 0 ? 3 : 1, found = 0;
        while (found < wanted) {
            int32_t channel = find_channel(list, layer, length, names[kind][found]);
            if (channel < 0)
                break;
            exr->channels[found++] = channel;
        }
        if (found < wanted)
            continue;
        int32_t alpha = find_channel(list, layer, length, "A");
        if (alpha >= 0)
            exr->channels[found++] = alpha;
        return found;
    }
    return 0;
}

/* Finds the channels of whole numbers that are wanted; returns their number, 0 when one is not
 * there. */
static uint32_t find_words(exr_input *exr, const exr_attr_chlist_t *list)
{
    for (uint32_t i = 0; i < exr->word_count; i++) {
        int32_t channel = find_channel(list, "", 0, exr->words[i]);
        if (channel < 0 || list->entries[channel].pixel_type != EXR_PIXEL_UINT)
            return 0;
        exr->channels[i] = channel;
    }
    return exr->word_count;
}

static lr_status choose_channels(exr_input *exr, uint32_t *count)
{
    const exr_attr_chlist_t *list;
    exr_result_t code = exr_get_channels(exr->context, 0, &list);
    if (code != EXR_ERR_SUCCESS)
        return say_failure(exr, code, "within the header");
    *count = exr->words ? find_words(exr, list) : find_layer(exr, list, "", 0);
    if (exr->words && *count == 0)
        return refuse(exr, "holds no sums of a render: these channels are not in it");
    for (int32_t i = 0; i < list->num_channels && *count == 0; i++) {
        const char *name = list->entries[i].name.str, *dot = strrchr(name, '.');
        if (dot)
            *count = find_layer(exr, list, name, (size_t)(dot - name) + 1);
    }
    if (*count == 0)
        return refuse(exr, "has no channels that make a picture: neither R, G and B nor Y");
    if (*count < 3 && find_channel(list, "", 0, "RY") >= 0)
        return refuse(exr, "holds luminance and chroma; convert it to R, G and B");
    for (uint32_t i = 0; i < *count; i++) {
        const exr_attr_chlist_entry_t *entry = &list->entries[exr->channels[i]];
        if (entry->x_sampling != 1 || entry->y_sampling != 1)
            return refuse(exr, "has subsampled channels; convert it to full resolution");
    }
    return LR_OK;
}

static lr_status set_size(const exr_input *exr, exr_attr_box2i_t window, uint32_t channels)
{
    int64_t width = (int64_t)window.max.x - window.min.x + 1;
    int64_t height = (int64_t)window.max.y - window.min.y + 1;
    if (width < 0 || height < 0 || width > UINT32_MAX || height > UINT32_MAX)
        return image_corrupt(exr->file, exr->error, "within the header: a window of %lld x %lld",
                             (long long)width, (long long)height);
    return image_set_size(exr->file, exr->image, (uint32_t)width, (uint32_t)height, channels,
                          exr->error);
}

static lr_status keep_texts(const exr_input *exr)
{
    int32_t count = 0;
    exr_get_attribute_count(exr->context, 0, &count);
    for (int32_t i = 0; i < count; i++) {
        const exr_attribute_t *attribute;
        if (exr_get_attribute_by_index(exr->context, 0, EXR_ATTR_LIST_FILE_ORDER, i, &attribute) !=
                EXR_ERR_SUCCESS ||
            attribute->type != EXR_ATTR_STRING || !attribute->string->str ||
            strcmp(attribute->name, "type") == 0) /* how the pixels are stored */
            continue;
        lr_status status =
            image_add_text(exr->file, exr->image, attribute->name, strlen(attribute->name),
                           attribute->string->str, (size_t)attribute->string->length, exr->error);
        if (status != LR_OK)
            return status;
    }
    return LR_OK;
}

/* OpenEXRCore 3.1 has no DWA decoder, and its B44 decoder gets float channels wrong. */
static lr_status check_compression(const exr_input *exr)
{
    exr_compression_t compression;
    exr_result_t code = exr_get_compression(exr->context, 0, &compression);
    if (code != EXR_ERR_SUCCESS)
        return say_failure(exr, code, "within the header");
    switch (compression) {
    case EXR_COMPRESSION_NONE:
    case EXR_COMPRESSION_RLE:
    case EXR_COMPRESSION_ZIPS:
    case EXR_COMPRESSION_ZIP:
    case EXR_COMPRESSION_PIZ:
    case EXR_COMPRESSION_PXR24:
        return LR_OK;
    default:
        return refuse(exr, "is compressed as B44 or DWA, which are not read; convert it to ZIP");
    }
}

static lr_status read_header(exr_input *exr)
{
    exr_result_t code = exr_get_storage(exr->context, 0, &exr->storage);
    if (code == EXR_ERR_SUCCESS)
        code = exr_get_data_window(exr->context, 0, &exr->data);
    if (code == EXR_ERR_SUCCESS)
        code = exr_get_display_window(exr->context, 0, &exr->display);
    if (code != EXR_ERR_SUCCESS)
        return say_failure(exr, code, "within the header");
    if (exr->storage != EXR_STORAGE_SCANLINE && exr->storage != EXR_STORAGE_TILED)
        return refuse(exr, "is a deep picture; flatten it first");
    uint32_t channels = 0;
    lr_status status = check_compression(exr);
    if (status == LR_OK)
        status = choose_channels(exr, &channels);
    /* The size of the data bounds what the library allocates. */
    if (status == LR_OK)
        status = set_size(exr, exr->data, channels);
    if (status == LR_OK)
        status = set_size(exr, exr->display, channels);
    return status == LR_OK ? keep_texts(exr) : status;
}

/* ---- The pixels --------------------------------------------------------------------------- */

/* Copies what lies inside the display window of a chunk whose first pixel is at (x, y). */
static void copy_chunk(const exr_input *exr, const exr_chunk_info_t *chunk, int64_t x, int64_t y,
                       const float *pixels)
{
    lr_image *image = exr->image;
    int64_t left = x - exr->display.min.x, top = y - exr->display.min.y;
    int64_t first = left < 0 ? -left : 0, end = chunk->width;
    if (end > image->width - left)
        end = image->width - left;
    for (int64_t row = 0; row < chunk->height; row++) {
        if (top + row < 0 || top + row >= image->height || first >= end)
            continue;
        memcpy(image->samples + ((top + row) * image->width + left + first) * image->channels,
               pixels + (row * chunk->width + first) * image->channels,
               (size_t)(end - first) * image->channels * sizeof *pixels);
    }
}

static float half_value(uint16_t half)
{
    uint32_t exponent = half >> 10 & 31, mantissa = half & 1023u, sign = (half & 0x8000u) << 16;
    if (exponent == 0)
        return (sign ? -1.0f : 1.0f) * (float)mantissa * 0x1p-24f;
    uint32_t bits = sign | (exponent == 31 ? 255 : exponent + 112) << 23 | mantissa << 13;
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Of a file's little-endian bytes; a word keeps its bits. */
static float sample_value(const uint8_t *bytes, uint16_t type, bool word)
{
    uint32_t bits = (uint32_t)(bytes[0] | bytes[1] << 8);
    if (type == EXR_PIXEL_HALF)
        return half_value((uint16_t)bits);
    bits |= (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
    float value;
    memcpy(&value, &bits, sizeof value);
    return type == EXR_PIXEL_UINT && !word ? (float)bits : value;
}

/* Takes the channels that have a destination, in place of the library's own functions: those of
 * OpenEXRCore 3.1 for halves write to channels without one and take subsampled ones for full. */
static exr_result_t unpack(exr_decode_pipeline_t *decoder)
{
    const exr_input *exr = decoder->decoding_user_data;
    const exr_chunk_info_t *chunk = &decoder->chunk;
    const uint8_t *in = decoder->unpacked_buffer;
    uint64_t left = chunk->unpacked_size;
    for (int32_t y = 0; y < chunk->height; y++)
        for (int i = 0; i < decoder->channel_count; i++) {
            const exr_coding_channel_info_t *c = &decoder->channels[i];
            size_t width = (size_t)c->width, bytes = (size_t)c->bytes_per_element;
            if (c->y_samples > 1 && (chunk->start_y + y) % c->y_samples != 0)
                continue;
            if (width * bytes > left)
                return EXR_ERR_CORRUPT_CHUNK;
            float *out = (float *)(void *)c->decode_to_ptr;
            if (out)
                out += (size_t)y * (size_t)c->user_line_stride / sizeof *out;
            for (size_t x = 0; out && x < width; x++)
                out[x * (size_t)c->user_pixel_stride / sizeof *out] =
                    sample_value(in + x * bytes, c->data_type, exr->words);
            in += width * bytes;
            left -= width * bytes;
        }
    return EXR_ERR_SUCCESS;
}

static exr_result_t decode_chunk(const exr_input *exr, const exr_chunk_info_t *chunk, float *pixels)
{
    uint32_t channels = exr->image->channels;
    exr_decode_pipeline_t decoder = EXR_DECODE_PIPELINE_INITIALIZER;
    exr_result_t code = exr_decoding_initialize(exr->context, 0, chunk, &decoder);
    if (code == EXR_ERR_SUCCESS) {
        for (uint32_t i = 0; i < channels; i++) {
            exr_coding_channel_info_t *channel = &decoder.channels[exr->channels[i]];
            channel->decode_to_ptr = (uint8_t *)(pixels + i);
            channel->user_data_type = EXR_PIXEL_FLOAT;
            channel->user_bytes_per_element = sizeof *pixels;
            channel->user_pixel_stride = (int32_t)(channels * sizeof *pixels);
            channel->user_line_stride = channel->user_pixel_stride * chunk->width;
        }
        code = exr_decoding_choose_default_routines(exr->context, 0, &decoder);
        if (decoder.unpack_and_convert_fn) /* otherwise the chunk is read into its place */
            decoder.unpack_and_convert_fn = unpack;
        decoder.decoding_user_data = (void *)exr;
    }
    if (code == EXR_ERR_SUCCESS)
        code = exr_decoding_run(exr->context, 0, &decoder);
    exr_decoding_destroy(exr->context, &decoder);
    return code;
}

/* Decodes one chunk, whose first pixel is at (x, y), into the picture. */
static lr_status read_chunk(const exr_input *exr, exr_result_t code, const exr_chunk_info_t *chunk,
                            int64_t x, int64_t y)
{
    float *pixels = NULL;
    if (code == EXR_ERR_SUCCESS) {
        pixels = lr_alloc((size_t)chunk->width * (size_t)chunk->height,
                          exr->image->channels * sizeof *pixels);
        code = pixels ? decode_chunk(exr, chunk, pixels) : EXR_ERR_OUT_OF_MEMORY;
    }
    /* The library takes zeros for the missing end of an uncompressed chunk. */
    if (code == EXR_ERR_SUCCESS && exr->truncated)
        code = EXR_ERR_READ_IO;
    if (code == EXR_ERR_SUCCESS)
        copy_chunk(exr, chunk, x, y, pixels);
    free(pixels);
    if (code == EXR_ERR_SUCCESS)
        return LR_OK;
    char where[80];
    snprintf(where, sizeof where, "in row %lld of %u", (long long)(y - exr->data.min.y),
             (unsigned)(exr->data.max.y - exr->data.min.y) + 1);
    return say_failure(exr, code, where);
}

/* The part of a data window's side that the display shows, in chunks of `step` pixels. */
typedef struct chunk_range {
    int64_t first, end;
} chunk_range;

static chunk_range shown_chunks(int32_t data_min, int32_t data_max, int32_t display_min,
                                int32_t display_max, int32_t step)
{
    int64_t low = display_min > data_min ? (int64_t)display_min - data_min : 0;
    int64_t high = (int64_t)(display_max < data_max ? display_max : data_max) - data_min;
    return high < low ? (chunk_range){0, 0} : (chunk_range){low / step, high / step + 1};
}

static lr_status read_scanlines(const exr_input *exr)
{
    int32_t lines;
    exr_result_t code = exr_get_scanlines_per_chunk(exr->context, 0, &lines);
    if (code != EXR_ERR_SUCCESS || lines < 1)
        return say_failure(exr, code, "within the header");
    chunk_range rows = shown_chunks(exr->data.min.y, exr->data.max.y, exr->display.min.y,
                                    exr->display.max.y, lines);
    lr_status status = LR_OK;
    for (int64_t i = rows.first; i < rows.end && status == LR_OK; i++) {
        exr_chunk_info_t chunk = {0};
        int64_t y = exr->data.min.y + i * lines;
        code = exr_read_scanline_chunk_info(exr->context, 0, (int)y, &chunk);
        status = read_chunk(exr, code, &chunk, exr->data.min.x, y);
    }
    return status;
}

/* Of the full resolution; files with more resolutions hold that one too. */
static lr_status read_tiles(const exr_input *exr)
{
    int32_t width, height;
    exr_result_t code = exr_get_tile_sizes(exr->context, 0, 0, 0, &width, &height);
    if (code != EXR_ERR_SUCCESS || width < 1 || height < 1)
        return say_failure(exr, code, "within the header");
    chunk_range rows = shown_chunks(exr->data.min.y, exr->data.max.y, exr->display.min.y,
                                    exr->display.max.y, height);
    chunk_range columns = shown_chunks(exr->data.min.x, exr->data.max.x, exr->display.min.x,
                                       exr->display.max.x, width);
    lr_status status = LR_OK;
    for (int64_t j = rows.first; j < rows.end; j++)
        for (int64_t i = columns.first; i < columns.end && status == LR_OK; i++) {
            exr_chunk_info_t chunk = {0};
            code = exr_read_tile_chunk_info(exr->context, 0, (int)i, (int)j, 0, 0, &chunk);
            status = read_chunk(exr, code, &chunk, exr->data.min.x + i * width,
                                exr->data.min.y + j * height);
        }
    return status;
}

static lr_status read_file(exr_input *exr)
{
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = on_error;
    setup.alloc_fn = allocate;
    setup.free_fn = free;
    setup.user_data = exr;
    setup.read_fn = on_read;
    setup.size_fn = on_size;
    setup.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    exr_result_t code = exr_start_read(&exr->context, "EXR", &setup);
    if (code != EXR_ERR_SUCCESS)
        return say_failure(exr, code, "within the header");
    lr_status status = read_header(exr);
    if (status == LR_OK)
        status = image_allocate(exr->file, exr->image, exr->error);
    if (status == LR_OK)
        status = exr->storage == EXR_STORAGE_TILED ? read_tiles(exr) : read_scanlines(exr);
    exr_finish(&exr->context);
    return status;
}

lr_status image_read_exr(const image_file *file, lr_image *image, lr_error *error)
{
    exr_input exr = {.file = file, .image = image, .error = error};
    return read_file(&exr);
}

lr_status lr_words_decode(const unsigned char *bytes, size_t size, const char *name,
                          const char *const *names, uint32_t count, lr_image *image,
                          lr_error *error)
{
    const image_file file = {bytes, size, name};
    exr_input exr = {
        .file = &file, .image = image, .error = error, .words = names, .word_count = count};
    *image = (lr_image){0};
    if (size < 4 || memcmp(bytes, "\x76\x2f\x31\x01", 4) != 0)
        return refuse(&exr, "holds no sums of a render: it is no EXR file");
    lr_status status = read_file(&exr);
    if (status)
        lr_image_free(image);
    return status;
}
