#include "image/words.h"

#include <OpenEXR/openexr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/image_internal.h"

enum {
    COLORS = 3,
    ZIP_LEVEL = 1, /* the low words are noise, at which any level fails; the rest is easy */
};

typedef struct words_output {
    const lr_picture *picture;
    const lr_words *words;
    const lr_text *texts;
    uint32_t text_count;
    exr_context_t context;
    image_buffer file;
    exr_result_t (*compress)(exr_encode_pipeline_t *);
    char reason[128]; /* the library's, the first one */
} words_output;

static void on_error(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)code;
    void *user = NULL;
    if (!context || exr_get_user_data(context, &user) != EXR_ERR_SUCCESS || !user)
        return;
    words_output *output = user;
    if (!output->reason[0])
        snprintf(output->reason, sizeof output->reason, "%s", message);
}

static int64_t on_write(exr_const_context_t context, void *user, const void *bytes, uint64_t size,
                        uint64_t offset, exr_stream_error_func_ptr_t error_cb)
{
    words_output *output = user;
    if (image_buffer_write(&output->file, offset, bytes, size))
        return (int64_t)size;
    error_cb(context, EXR_ERR_OUT_OF_MEMORY, "out of memory");
    return -1;
}

static const char *const colors[COLORS] = {"R", "G", "B"};

static exr_result_t write_header(const words_output *output)
{
    const lr_picture *picture = output->picture;
    int part;
    exr_result_t code = exr_add_part(output->context, NULL, EXR_STORAGE_SCANLINE, &part);
    if (code == EXR_ERR_SUCCESS)
        code = exr_initialize_required_attr_simple(output->context, 0, (int32_t)picture->width,
                                                   (int32_t)picture->height, EXR_COMPRESSION_ZIP);
    for (uint32_t i = 0; i < COLORS && code == EXR_ERR_SUCCESS; i++)
        code = exr_add_channel(output->context, 0, colors[i], EXR_PIXEL_FLOAT,
                               EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    for (uint32_t i = 0; i < output->words->count && code == EXR_ERR_SUCCESS; i++)
        code = exr_add_channel(output->context, 0, output->words->names[i], EXR_PIXEL_UINT,
                               EXR_PERCEPTUALLY_LINEAR, 1, 1);
    for (uint32_t i = 0; i < output->text_count && code == EXR_ERR_SUCCESS; i++)
        code =
            exr_attr_set_string(output->context, 0, output->texts[i].key, output->texts[i].value);
    return code == EXR_ERR_SUCCESS ? exr_write_header(output->context) : code;
}

/* As in exr.c: a chunk as large as its pixels is read as uncompressed. */
static exr_result_t compress(exr_encode_pipeline_t *pipeline)
{
    const words_output *output = pipeline->encoding_user_data;
    exr_result_t code = output->compress(pipeline);
    if (code == EXR_ERR_SUCCESS && pipeline->compressed_bytes == pipeline->packed_bytes)
        memcpy(pipeline->compressed_buffer, pipeline->packed_buffer, pipeline->packed_bytes);
    return code;
}

/* Where the samples of a channel of the file lie in row y, and how many words they are apart. */
static const void *find_channel(const words_output *output, const char *name, int32_t y,
                                uint32_t *stride)
{
    const lr_words *words = output->words;
    size_t first = (size_t)y * output->picture->width;
    *stride = COLORS;
    for (uint32_t i = 0; i < COLORS; i++)
        if (!strcmp(name, colors[i]))
            return &output->picture->pixels[first * COLORS + i];
    uint32_t i = 0;
    while (i < words->count - 1 && strcmp(name, words->names[i]) != 0)
        i++;
    *stride = words->count;
    return &words->words[first * words->count + i];
}

static exr_result_t write_chunk(words_output *output, const exr_chunk_info_t *chunk)
{
    exr_encode_pipeline_t pipeline = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_result_t code = exr_encoding_initialize(output->context, 0, chunk, &pipeline);
    for (int i = 0; code == EXR_ERR_SUCCESS && i < pipeline.channel_count; i++) {
        exr_coding_channel_info_t *channel = &pipeline.channels[i];
        uint32_t stride;
        channel->encode_from_ptr =
            find_channel(output, channel->channel_name, chunk->start_y, &stride);
        channel->user_pixel_stride = (int32_t)(stride * sizeof(uint32_t));
        channel->user_line_stride = channel->user_pixel_stride * chunk->width;
    }
    if (code == EXR_ERR_SUCCESS)
        code = exr_encoding_choose_default_routines(output->context, 0, &pipeline);
    if (code == EXR_ERR_SUCCESS) {
        output->compress = pipeline.compress_fn;
        pipeline.encoding_user_data = output;
        pipeline.compress_fn = compress;
        code = exr_encoding_run(output->context, 0, &pipeline);
    }
    exr_encoding_destroy(output->context, &pipeline);
    return code;
}

static exr_result_t write_file(words_output *output)
{
    exr_result_t code = write_header(output);
    int32_t lines = 0;
    if (code == EXR_ERR_SUCCESS)
        code = exr_get_scanlines_per_chunk(output->context, 0, &lines);
    for (int64_t y = 0; code == EXR_ERR_SUCCESS && y < output->picture->height; y += lines) {
        exr_chunk_info_t chunk = {0};
        code = exr_write_scanline_chunk_info(output->context, 0, (int)y, &chunk);
        if (code == EXR_ERR_SUCCESS)
            code = write_chunk(output, &chunk);
    }
    return code;
}

lr_status lr_words_encode(const lr_picture *picture, const lr_words *words, const lr_text *texts,
                          uint32_t text_count, unsigned char **bytes, size_t *size, lr_error *error)
{
    words_output output = {
        .picture = picture, .words = words, .texts = texts, .text_count = text_count};
    *bytes = NULL;
    *size = 0;
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = on_error;
    setup.user_data = &output;
    setup.write_fn = on_write;
    setup.zip_level = ZIP_LEVEL;
    exr_result_t code = exr_start_write(&output.context, "EXR", EXR_WRITE_FILE_DIRECTLY, &setup);
    if (code == EXR_ERR_SUCCESS) {
        code = write_file(&output);
        exr_result_t finished = exr_finish(&output.context);
        code = code == EXR_ERR_SUCCESS ? finished : code;
    }
    if (code == EXR_ERR_SUCCESS) {
        *bytes = output.file.bytes;
        *size = output.file.size;
        return LR_OK;
    }
    free(output.file.bytes);
    bool out_of_memory = code == EXR_ERR_OUT_OF_MEMORY || !output.reason[0];
    return lr_fail(error, out_of_memory ? LR_ERROR_MEMORY : LR_ERROR_ARGUMENT,
                   "an EXR of the sums of %u x %u pixels cannot be made: %s", picture->width,
                   picture->height,
                   output.reason[0] ? output.reason : exr_get_default_error_message(code));
}
