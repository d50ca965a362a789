#include "image/image_internal.h"

#include <OpenEXR/openexr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

enum { ZIP_LEVEL = 4 }; /* OpenEXR's own choice: higher ones take long for little */

typedef struct exr_output {
    const image_exr *exr;
    exr_context_t context;
    image_buffer file;
    void **changed; /* by source: room for the rows of a chunk, where they are not written as they
                       are; else NULL */
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

static size_t component_count(const image_exr_source *source)
{
    return source->letters[0] ? strlen(source->letters) : 1;
}

enum { CHANNEL_NAME = 32 };

static void name_channel(const image_exr_source *source, size_t component, char name[CHANNEL_NAME])
{
    if (source->letters[0])
        snprintf(name, CHANNEL_NAME, "%s%s%c", source->name, source->name[0] ? "." : "",
                 source->letters[component]);
    else
        snprintf(name, CHANNEL_NAME, "%s", source->name);
}

/* Makes room for the rows of a chunk of the sources that are adjusted. */
static exr_result_t reserve_rows(exr_output *output, int32_t lines)
{
    const image_exr *exr = output->exr;
    for (uint32_t i = 0; i < exr->source_count; i++) {
        if (!exr->sources[i].adjusted)
            continue;
        output->changed[i] = lr_alloc(3 * (size_t)exr->width, (size_t)lines * sizeof(float));
        if (!output->changed[i])
            return EXR_ERR_OUT_OF_MEMORY;
    }
    return EXR_ERR_SUCCESS;
}

static exr_result_t add_channels(const exr_output *output, const image_exr_source *source)
{
    static const exr_pixel_type_t types[] = {
        [IMAGE_EXR_FLOAT] = EXR_PIXEL_FLOAT,
        [IMAGE_EXR_HALF] = EXR_PIXEL_HALF,
        [IMAGE_EXR_UINT] = EXR_PIXEL_UINT,
    };
    exr_result_t code = EXR_ERR_SUCCESS;
    for (size_t i = 0; i < component_count(source) && code == EXR_ERR_SUCCESS; i++) {
        char name[CHANNEL_NAME];
        name_channel(source, i, name);
        code = exr_add_channel(
            output->context, 0, name, types[source->type],
            source->light ? EXR_PERCEPTUALLY_LOGARITHMIC : EXR_PERCEPTUALLY_LINEAR, 1, 1);
    }
    return code;
}

/* The windows begin at the origin. */
static exr_result_t write_header(const exr_output *output)
{
    const image_exr *exr = output->exr;
    int part;
    exr_result_t code = exr_add_part(output->context, NULL, EXR_STORAGE_SCANLINE, &part);
    if (code == EXR_ERR_SUCCESS)
        code = exr_initialize_required_attr_simple(output->context, 0, (int32_t)exr->width,
                                                   (int32_t)exr->height, EXR_COMPRESSION_ZIP);
    for (uint32_t i = 0; i < exr->source_count && code == EXR_ERR_SUCCESS; i++)
        code = add_channels(output, &exr->sources[i]);
    for (uint32_t i = 0; i < exr->text_count && code == EXR_ERR_SUCCESS; i++)
        code = exr_attr_set_string(output->context, 0, exr->texts[i].key, exr->texts[i].value);
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

/* Adjusts the rows of a chunk, which are floats in threes, into `changed`. */
static void change_rows(const exr_output *output, const image_exr_source *source,
                        const exr_chunk_info_t *chunk, void *changed)
{
    size_t row = 3 * (size_t)output->exr->width;
    const float *in = (const float *)source->samples + (size_t)chunk->start_y * row;
    float *floats = changed;
    uint16_t *halves = changed;
    for (size_t i = 0; i < row * (size_t)chunk->height; i += 3) {
        float pixel[3];
        image_adjust(output->exr->encoder, in + i, pixel);
        for (int k = 0; k < 3; k++)
            if (source->type == IMAGE_EXR_HALF)
                halves[i + k] = image_half(pixel[k]);
            else
                floats[i + k] = pixel[k];
    }
}

/* Tells the pipeline's channels, which are in an order of their own, where their samples are. */
static void place_channels(const exr_output *output, uint32_t number,
                           exr_encode_pipeline_t *pipeline)
{
    const image_exr_source *source = &output->exr->sources[number];
    size_t sample = source->type == IMAGE_EXR_HALF ? 2 : 4, stride = source->stride;
    const unsigned char *rows = source->samples;
    rows += (size_t)pipeline->chunk.start_y * output->exr->width * stride;
    if (source->adjusted) {
        change_rows(output, source, &pipeline->chunk, output->changed[number]);
        rows = output->changed[number];
        stride = 3 * sample;
    }
    for (size_t i = 0; i < component_count(source); i++) {
        char name[CHANNEL_NAME];
        name_channel(source, i, name);
        for (int k = 0; k < pipeline->channel_count; k++) {
            exr_coding_channel_info_t *channel = &pipeline->channels[k];
            if (strcmp(channel->channel_name, name) != 0)
                continue;
            channel->encode_from_ptr = rows + i * sample;
            channel->user_pixel_stride = (int32_t)stride;
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
    for (uint32_t i = 0; i < output->exr->source_count; i++)
        place_channels(output, i, &pipeline);
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
    int32_t lines = 0;
    exr_result_t code = write_header(output);
    if (code == EXR_ERR_SUCCESS)
        code = exr_get_scanlines_per_chunk(output->context, 0, &lines);
    if (code == EXR_ERR_SUCCESS)
        code = reserve_rows(output, lines);
    for (int64_t y = 0; y < output->exr->height && code == EXR_ERR_SUCCESS; y += lines) {
        exr_chunk_info_t chunk = {0};
        code = exr_write_scanline_chunk_info(output->context, 0, (int)y, &chunk);
        if (code == EXR_ERR_SUCCESS)
            code = write_chunk(output, &chunk);
    }
    return code;
}

static exr_result_t write_all(exr_output *output)
{
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = on_error;
    setup.user_data = output;
    setup.write_fn = on_write;
    setup.zip_level = output->exr->zip_level;
    exr_result_t code = exr_start_write(&output->context, "EXR", EXR_WRITE_FILE_DIRECTLY, &setup);
    if (code != EXR_ERR_SUCCESS)
        return code;
    code = write_file(output);
    /* Also writes the table of chunks. */
    exr_result_t finished = exr_finish(&output->context);
    return code == EXR_ERR_SUCCESS ? finished : code;
}

lr_status image_exr_write(const image_exr *exr, unsigned char **bytes, size_t *size,
                          lr_error *error)
{
    exr_output output = {.exr = exr, .changed = lr_alloc(exr->source_count, sizeof(void *))};
    *bytes = NULL;
    *size = 0;
    if (exr->width > INT32_MAX / 16 || exr->height > INT32_MAX) {
        free(output.changed);
        return lr_fail(error, LR_ERROR_ARGUMENT, "an EXR of %s%u x %u pixels is too large",
                       exr->what, exr->width, exr->height);
    }
    exr_result_t code = output.changed ? write_all(&output) : EXR_ERR_OUT_OF_MEMORY;
    for (uint32_t i = 0; output.changed && i < exr->source_count; i++)
        free(output.changed[i]);
    free(output.changed);
    if (code == EXR_ERR_SUCCESS) {
        *bytes = output.file.bytes;
        *size = output.file.size;
        return LR_OK;
    }
    free(output.file.bytes);
    bool out_of_memory = code == EXR_ERR_OUT_OF_MEMORY || !output.reason[0];
    return lr_fail(error, out_of_memory ? LR_ERROR_MEMORY : LR_ERROR_ARGUMENT,
                   "an EXR of %s%u x %u pixels cannot be made: %s", exr->what, exr->width,
                   exr->height,
                   output.reason[0] ? output.reason : exr_get_default_error_message(code));
}

/* The picture as R, G and B in the default layer, as other programs expect it, and the layers. */
lr_status image_encode_exr(const image_encoder *encoder, unsigned char **bytes, size_t *size,
                           lr_error *error)
{
    const lr_picture *picture = encoder->picture;
    const lr_encoding *encoding = encoder->encoding;
    image_exr_source *sources = lr_alloc(encoding->layer_count + 1, sizeof *sources);
    if (!sources)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for an EXR of %u x %u pixels",
                       picture->width, picture->height);
    sources[0] = (image_exr_source){
        .name = "",
        .letters = "RGB",
        .type = encoding->half ? IMAGE_EXR_HALF : IMAGE_EXR_FLOAT,
        .samples = picture->pixels,
        .stride = 3 * sizeof(float),
        .light = true,
        .adjusted = true,
    };
    for (uint32_t i = 0; i < encoding->layer_count; i++) {
        const lr_layer *layer = &encoding->layers[i];
        image_exr_source *source = &sources[i + 1];
        *source = (image_exr_source){
            .name = layer->name,
            .letters = layer->channels,
            .type = layer->integers ? IMAGE_EXR_UINT : IMAGE_EXR_FLOAT,
            .samples = layer->samples,
            .light = layer->light,
            .adjusted = layer->light,
        };
        source->stride = component_count(source) * sizeof(float);
    }
    image_exr exr = {
        .width = picture->width,
        .height = picture->height,
        .sources = sources,
        .source_count = encoding->layer_count + 1,
        .texts = encoding->texts,
        .text_count = encoding->text_count,
        .encoder = encoder,
        .zip_level = ZIP_LEVEL,
        .what = "",
    };
    lr_status status = image_exr_write(&exr, bytes, size, error);
    free(sources);
    return status;
}
