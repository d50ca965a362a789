#include "image/image_internal.h"

#include <OpenEXR/openexr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

enum { ZIP_LEVEL = 4 }; /* OpenEXR's own choice: higher ones take long for little */

/* The picture, or a layer. */
typedef struct exr_source {
    const char *name; /* "" of the picture */
    const char *letters;
    size_t components; /* of a pixel: as many as there are letters, or 1 */
    exr_pixel_type_t type;
    const unsigned char *samples; /* as they are in memory */
    void *changed; /* room for the rows of a chunk, where they are not written as they are */
} exr_source;

typedef struct exr_output {
    const image_encoder *encoder;
    exr_context_t context;
    image_buffer file;
    exr_source *sources; /* the picture first */
    uint32_t source_count;
    exr_result_t (*compress)(exr_encode_pipeline_t *);
    char reason[128]; /* the library's, the first one */
} exr_output;

static void on_error(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)code;
    void *user = NULL;
    if (!context || exr_get_user_data(context, &user) != EXR_ERR_SUCCESS || !user)
        return;
    exr_output *output = user;
    if (!output->reason[0])
        snprintf(output->reason, sizeof output->reason, "%s", message);
}

static int64_t on_write(exr_const_context_t context, void *user, const void *bytes, uint64_t size,
                        uint64_t offset, exr_stream_error_func_ptr_t error_cb)
{
    exr_output *output = user;
    if (image_buffer_write(&output->file, offset, bytes, size))
        return (int64_t)size;
    error_cb(context, EXR_ERR_OUT_OF_MEMORY, "out of memory");
    return -1;
}

uint16_t image_half(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    uint32_t sign = bits >> 16 & 0x8000, magnitude = bits & 0x7fffffff;
    if (magnitude > 0x7f800000) /* NaN stays one, whatever bits are cut off */
        return (uint16_t)(sign | 0x7e00 | (magnitude >> 13 & 0x3ff));
    if (magnitude == 0x7f800000)
        return (uint16_t)(sign | 0x7c00);
    if (magnitude > 0x477fe000)
        return (uint16_t)(sign | 0x7bff);
    if (magnitude < 0x38800000) {
        /* Subnormal halves count in 2^-24; at 2^23 floats have whole steps. */
        float steps = (value < 0 ? -value : value) * 0x1p24f + 0x1p23f;
        memcpy(&bits, &steps, sizeof bits);
        return (uint16_t)(sign | (bits - 0x4b000000));
    }
    magnitude += 0xfff + (magnitude >> 13 & 1);
    return (uint16_t)(sign | (magnitude - 0x38000000) >> 13);
}

static size_t sample_size(const exr_source *source)
{
    return source->type == EXR_PIXEL_HALF ? 2 : 4;
}

enum { CHANNEL_NAME = 32 };

static void name_channel(const exr_source *source, size_t component, char name[CHANNEL_NAME])
{
    if (source->letters[0])
        snprintf(name, CHANNEL_NAME, "%s%s%c", source->name, source->name[0] ? "." : "",
                 source->letters[component]);
    else
        snprintf(name, CHANNEL_NAME, "%s", source->name);
}

/* Fills the sources: the picture as R, G and B in the default layer, as other programs expect it,
 * and the layers. */
static exr_result_t list_sources(exr_output *output)
{
    const lr_encoding *encoding = output->encoder->encoding;
    output->source_count = encoding->layer_count + 1;
    output->sources = lr_alloc(output->source_count, sizeof *output->sources);
    if (!output->sources)
        return EXR_ERR_OUT_OF_MEMORY;
    output->sources[0] = (exr_source){
        .name = "",
        .letters = "RGB",
        .components = 3,
        .type = encoding->half ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT,
        .samples = (const unsigned char *)output->encoder->picture->pixels,
    };
    for (uint32_t i = 0; i < encoding->layer_count; i++) {
        const lr_layer *layer = &encoding->layers[i];
        output->sources[i + 1] = (exr_source){
            .name = layer->name,
            .letters = layer->channels,
            .components = layer->channels[0] ? strlen(layer->channels) : 1,
            .type = layer->integers ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT,
            .samples = layer->samples,
        };
    }
    return EXR_ERR_SUCCESS;
}

/* Makes room for the rows of a chunk of those that are light. */
static exr_result_t reserve_rows(exr_output *output, int32_t lines)
{
    const lr_encoding *encoding = output->encoder->encoding;
    for (uint32_t i = 0; i < output->source_count; i++) {
        if (i > 0 && !encoding->layers[i - 1].light)
            continue;
        exr_source *source = &output->sources[i];
        source->changed =
            lr_alloc(3 * (size_t)output->encoder->picture->width, (size_t)lines * sizeof(float));
        if (!source->changed)
            return EXR_ERR_OUT_OF_MEMORY;
    }
    return EXR_ERR_SUCCESS;
}

static exr_result_t add_channels(const exr_output *output, const exr_source *source, bool light)
{
    exr_result_t code = EXR_ERR_SUCCESS;
    for (size_t i = 0; i < source->components && code == EXR_ERR_SUCCESS; i++) {
        char name[CHANNEL_NAME];
        name_channel(source, i, name);
        code =
            exr_add_channel(output->context, 0, name, source->type,
                            light ? EXR_PERCEPTUALLY_LOGARITHMIC : EXR_PERCEPTUALLY_LINEAR, 1, 1);
    }
    return code;
}

/* The windows begin at the origin. */
static exr_result_t write_header(const exr_output *output)
{
    const lr_picture *picture = output->encoder->picture;
    const lr_encoding *encoding = output->encoder->encoding;
    int part;
    exr_result_t code = exr_add_part(output->context, NULL, EXR_STORAGE_SCANLINE, &part);
    if (code == EXR_ERR_SUCCESS)
        code = exr_initialize_required_attr_simple(output->context, 0, (int32_t)picture->width,
                                                   (int32_t)picture->height, EXR_COMPRESSION_ZIP);
    for (uint32_t i = 0; i < output->source_count && code == EXR_ERR_SUCCESS; i++)
        code = add_channels(output, &output->sources[i], i == 0 || encoding->layers[i - 1].light);
    for (uint32_t i = 0; i < encoding->text_count && code == EXR_ERR_SUCCESS; i++)
        code = exr_attr_set_string(output->context, 0, encoding->texts[i].key,
                                   encoding->texts[i].value);
    return code == EXR_ERR_SUCCESS ? exr_write_header(output->context) : code;
}

/* A chunk as large as its pixels is read as uncompressed, and OpenEXRCore 3.1 lets one be written
 * that is compressed to just that size. */
static exr_result_t compress(exr_encode_pipeline_t *pipeline)
{
    const exr_output *output = pipeline->encoding_user_data;
    exr_result_t code = output->compress(pipeline);
    if (code == EXR_ERR_SUCCESS && pipeline->compressed_bytes == pipeline->packed_bytes)
        memcpy(pipeline->compressed_buffer, pipeline->packed_buffer, pipeline->packed_bytes);
    return code;
}

/* The rows of a chunk as they are to be written. */
static const unsigned char *chunk_rows(const exr_output *output, const exr_source *source,
                                       const exr_chunk_info_t *chunk)
{
    size_t row = source->components * output->encoder->picture->width;
    const unsigned char *rows = source->samples + (size_t)chunk->start_y * row * sizeof(float);
    if (!source->changed)
        return rows;
    const float *in = (const float *)(const void *)rows;
    float *floats = source->changed;
    uint16_t *halves = source->changed;
    for (size_t i = 0; i < row * (size_t)chunk->height; i += 3) {
        float pixel[3];
        image_adjust(output->encoder, in + i, pixel);
        for (int k = 0; k < 3; k++)
            if (source->type == EXR_PIXEL_HALF)
                halves[i + k] = image_half(pixel[k]);
            else
                floats[i + k] = pixel[k];
    }
    return source->changed;
}

/* Tells the pipeline's channels, which are in an order of their own, where their samples are. */
static void place_channels(const exr_output *output, const exr_source *source,
                           exr_encode_pipeline_t *pipeline)
{
    const unsigned char *rows = chunk_rows(output, source, &pipeline->chunk);
    for (size_t i = 0; i < source->components; i++) {
        char name[CHANNEL_NAME];
        name_channel(source, i, name);
        for (int k = 0; k < pipeline->channel_count; k++) {
            exr_coding_channel_info_t *channel = &pipeline->channels[k];
            if (strcmp(channel->channel_name, name) != 0)
                continue;
            channel->encode_from_ptr = rows + i * sample_size(source);
            channel->user_pixel_stride = (int32_t)(source->components * sample_size(source));
            channel->user_line_stride = channel->user_pixel_stride * pipeline->chunk.width;
        }
    }
}

static exr_result_t write_chunk(exr_output *output, const exr_chunk_info_t *chunk)
{
    exr_encode_pipeline_t pipeline = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_result_t code = exr_encoding_initialize(output->context, 0, chunk, &pipeline);
    if (code != EXR_ERR_SUCCESS)
        return code;
    for (uint32_t i = 0; i < output->source_count; i++)
        place_channels(output, &output->sources[i], &pipeline);
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

static exr_result_t write_file(exr_output *output)
{
    const lr_picture *picture = output->encoder->picture;
    int32_t lines = 0;
    exr_result_t code = list_sources(output);
    if (code == EXR_ERR_SUCCESS)
        code = write_header(output);
    if (code == EXR_ERR_SUCCESS)
        code = exr_get_scanlines_per_chunk(output->context, 0, &lines);
    if (code == EXR_ERR_SUCCESS)
        code = reserve_rows(output, lines);
    for (int64_t y = 0; y < picture->height && code == EXR_ERR_SUCCESS; y += lines) {
        exr_chunk_info_t chunk = {0};
        code = exr_write_scanline_chunk_info(output->context, 0, (int)y, &chunk);
        if (code == EXR_ERR_SUCCESS)
            code = write_chunk(output, &chunk);
    }
    return code;
}

lr_status image_encode_exr(const image_encoder *encoder, unsigned char **bytes, size_t *size,
                           lr_error *error)
{
    const lr_picture *picture = encoder->picture;
    exr_output output = {.encoder = encoder};
    if (picture->width > INT32_MAX / 16 || picture->height > INT32_MAX)
        return lr_fail(error, LR_ERROR_ARGUMENT, "an EXR of %u x %u pixels is too large",
                       picture->width, picture->height);
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = on_error;
    setup.user_data = &output;
    setup.write_fn = on_write;
    setup.zip_level = ZIP_LEVEL;
    exr_result_t code = exr_start_write(&output.context, "EXR", EXR_WRITE_FILE_DIRECTLY, &setup);
    if (code == EXR_ERR_SUCCESS) {
        code = write_file(&output);
        /* Also writes the table of chunks. */
        exr_result_t finished = exr_finish(&output.context);
        code = code == EXR_ERR_SUCCESS ? finished : code;
    }
    for (uint32_t i = 0; output.sources && i < output.source_count; i++)
        free(output.sources[i].changed);
    free(output.sources);
    if (code == EXR_ERR_SUCCESS) {
        *bytes = output.file.bytes;
        *size = output.file.size;
        return LR_OK;
    }
    free(output.file.bytes);
    bool out_of_memory = code == EXR_ERR_OUT_OF_MEMORY || !output.reason[0];
    return lr_fail(error, out_of_memory ? LR_ERROR_MEMORY : LR_ERROR_ARGUMENT,
                   "an EXR of %u x %u pixels cannot be made: %s", picture->width, picture->height,
                   output.reason[0] ? output.reason : exr_get_default_error_message(code));
}
