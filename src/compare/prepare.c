/* Two pictures into one layout, and which of their pixels count. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "compare/approx.h"
#include "compare/compare_internal.h"

static bool has_alpha(const lr_image *image)
{
    return image->channels == 2 || image->channels == 4;
}

static bool is_opaque(const lr_image *image)
{
    size_t count = (size_t)image->width * image->height;
    if (!has_alpha(image))
        return true;
    for (size_t i = 1; i <= count; i++)
        if (image->samples[i * image->channels - 1] != 1)
            return false;
    return true;
}

/* The sRGB curve (IEC 61966-2-1). */
static float encode(float linear)
{
    float x = approx_min(approx_max(linear, 0), 1);
    return x <= 0.0031308f ? 12.92f * x : 1.055f * approx_power(x, 1 / 2.4f) - 0.055f;
}

/* A copy with the pair's stride; alpha, when there is room for it, stays or becomes 1. */
static float *convert(const lr_image *image, const compare_pair *pair, bool to_srgb)
{
    size_t count = (size_t)image->width * image->height;
    float *copy = lr_alloc(count * pair->stride, sizeof *copy);
    if (!copy)
        return NULL;
    uint32_t step = image->channels >= 3, alpha = image->channels - 1;
    for (size_t i = 0; i < count; i++) {
        const float *in = image->samples + i * image->channels;
        float *out = copy + i * pair->stride;
        for (uint32_t c = 0; c < pair->colors; c++)
            out[c] = to_srgb ? encode(in[c * step]) : in[c * step];
        if (pair->stride > pair->colors)
            out[pair->colors] = has_alpha(image) ? in[alpha] : 1;
    }
    return copy;
}

static lr_status out_of_memory(lr_error *error)
{
    return lr_fail(error, LR_ERROR_MEMORY, "out of memory for the comparison");
}

static lr_status lay_out(const lr_image *reference, const lr_image *test, compare_pair *pair,
                         lr_error *error)
{
    bool reference_linear = reference->maxval == 0, test_linear = test->maxval == 0;
    pair->converted = reference_linear != test_linear;
    pair->linear = reference_linear && test_linear;
    pair->maxval = reference->maxval == test->maxval ? reference->maxval : 0;
    pair->colors = reference->channels >= 3 || test->channels >= 3 ? 3 : 1;
    pair->alpha = !is_opaque(reference) || !is_opaque(test);
    pair->stride =
        reference->channels == test->channels ? reference->channels : pair->colors + pair->alpha;
    pair->reference = reference->samples;
    pair->test = test->samples;
    const lr_image *images[2] = {reference, test};
    const float **samples[2] = {&pair->reference, &pair->test};
    for (int i = 0; i < 2; i++) {
        bool to_srgb = pair->converted && images[i]->maxval == 0;
        if (!to_srgb && images[i]->channels == pair->stride)
            continue;
        *samples[i] = pair->owned[i] = convert(images[i], pair, to_srgb);
        if (!pair->owned[i])
            return out_of_memory(error);
    }
    return LR_OK;
}

static bool is_ignored(const lr_compare_options *options, uint32_t x, uint32_t y)
{
    for (uint32_t i = 0; i < options->ignored_count; i++) {
        const lr_rectangle *r = &options->ignored[i];
        if (x >= r->x && y >= r->y && x - r->x < r->width && y - r->y < r->height)
            return true;
    }
    return false;
}

static bool is_white(const lr_image *mask, size_t pixel)
{
    const float *sample = mask->samples + pixel * mask->channels;
    double luma = mask->channels >= 3 ? 0.2126 * sample[0] + 0.7152 * sample[1] + 0.0722 * sample[2]
                                      : sample[0];
    return luma >= 0.5;
}

/* Finds the pixels to compare and makes the others the same in both pictures. */
static lr_status exclude(const lr_compare_options *options, compare_pair *pair, lr_error *error)
{
    const lr_image *mask = options->mask;
    size_t count = (size_t)pair->width * pair->height, size = pair->stride * sizeof(float);
    pair->compared = count;
    if (!mask && options->ignored_count == 0)
        return LR_OK;
    if (mask && (mask->width != pair->width || mask->height != pair->height))
        return lr_fail(error, LR_ERROR_ARGUMENT,
                       "the mask has %u x %u pixels, the reference %u x %u; they must be the same",
                       mask->width, mask->height, pair->width, pair->height);
    pair->used = lr_alloc(count, 1);
    if (pair->used && !pair->owned[1]) {
        pair->owned[1] = lr_alloc(count, size);
        if (pair->owned[1])
            memcpy(pair->owned[1], pair->test, count * size);
        pair->test = pair->owned[1];
    }
    if (!pair->used || !pair->owned[1])
        return out_of_memory(error);
    for (uint32_t y = 0; y < pair->height; y++)
        for (uint32_t x = 0; x < pair->width; x++) {
            size_t i = (size_t)y * pair->width + x;
            pair->used[i] = (!mask || is_white(mask, i)) && !is_ignored(options, x, y);
            if (pair->used[i])
                continue;
            pair->compared--;
            memcpy(pair->owned[1] + i * pair->stride, pair->reference + i * pair->stride, size);
        }
    if (pair->compared == 0) /* a test that can never fail, such as one with its mask inverted */
        return lr_fail(error, LR_ERROR_ARGUMENT,
                       "nothing is left to compare: all pixels are masked or ignored");
    return LR_OK;
}

static double find_peak(const compare_pair *pair)
{
    size_t count = (size_t)pair->width * pair->height;
    float peak = 1;
    for (size_t i = 0; pair->linear && i < count; i++)
        for (uint32_t c = 0; c < pair->colors; c++) {
            float value = pair->reference[i * pair->stride + c];
            peak = value > peak && value <= 3.4028235e38f ? value : peak;
        }
    return peak;
}

lr_status compare_prepare(const lr_image *reference, const lr_image *test,
                          const lr_compare_options *options, compare_pair *pair, lr_error *error)
{
    *pair = (compare_pair){.width = reference->width, .height = reference->height};
    lr_status status = lay_out(reference, test, pair, error);
    if (status == LR_OK)
        status = exclude(options, pair, error);
    if (status == LR_OK)
        pair->peak = find_peak(pair);
    return status;
}

void compare_release(compare_pair *pair)
{
    free(pair->owned[0]);
    free(pair->owned[1]);
    free(pair->used);
    *pair = (compare_pair){0};
}

bool compare_same_row(const compare_pair *pair, uint32_t y)
{
    size_t row = (size_t)pair->width * pair->stride;
    return memcmp(pair->reference + y * row, pair->test + y * row, row * sizeof(float)) == 0;
}
