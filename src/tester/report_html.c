/* The page: report.html, with the results and the pictures in the place of its mark. */
#include "tester/report.h"

#include "base/file.h"
#include "base/memory.h"
#include "image/image.h"
#include "report.html.h"
#include "tester/text.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MARK "@DATA@"

enum {
    PICTURE_BYTES_MAX = 1 << 30,
    /* Beyond these the values of each pixel would make the page heavy: it shows 8-bit ones. */
    VALUES_WIDTH_MAX = 4096,
    VALUES_PIXELS_MAX = 1 << 20,
};

static json_t *data_url(const unsigned char *bytes, size_t size)
{
    char *text = lr_base64(bytes, size);
    char *url = text ? lr_format_text("data:image/png;base64,%s", text) : NULL;
    json_t *json = url ? json_string(url) : NULL;
    free(text);
    free(url);
    return json;
}

/* A PNG of the picture, sRGB with 8 bits, as a URL. */
static json_t *picture_url(const lr_picture *picture)
{
    lr_encoding encoding = {.format = LR_FORMAT_PNG, .maxval = 255};
    unsigned char *bytes = NULL;
    size_t size;
    lr_error ignored;
    json_t *url = NULL;
    if (lr_picture_encode(picture, &encoding, &bytes, &size, &ignored) == LR_OK)
        url = data_url(bytes, size);
    free(bytes);
    return url;
}

static float sample(const lr_image *image, size_t pixel, uint32_t channel)
{
    uint32_t from = image->channels >= 3 ? channel : 0;
    return image->samples[pixel * image->channels + from];
}

static float srgb_to_linear(float v)
{
    return v <= 0.04045f ? v / 12.92f : powf((v + 0.055f) / 1.055f, 2.4f);
}

/* What the picture looks like. */
static json_t *shown_url(const lr_image *image)
{
    size_t count = (size_t)image->width * image->height;
    lr_picture picture = {image->width, image->height, lr_alloc(count, 3 * sizeof(float))};
    json_t *url = NULL;
    for (size_t i = 0; picture.pixels && i < 3 * count; i++) {
        float value = sample(image, i / 3, (uint32_t)(i % 3));
        picture.pixels[i] = image->maxval ? srgb_to_linear(value) : value;
    }
    if (picture.pixels)
        url = picture_url(&picture);
    lr_picture_free(&picture);
    return url;
}

/* The values themselves: the twelve bytes of each pixel's three floats, little-endian, are four
 * pixels of a picture four times as wide, which browsers decode without loss. Integers are times
 * maxval. */
static json_t *values_url(const lr_image *image)
{
    size_t count = (size_t)image->width * image->height;
    lr_picture picture = {4 * image->width, image->height, lr_alloc(count, 12 * sizeof(float))};
    lr_curve curve = {0};
    lr_error ignored;
    json_t *url = NULL;
    if (picture.pixels && lr_curve_create(&curve, LR_TRANSFER_SRGB, 255, &ignored) == LR_OK) {
        for (size_t i = 0; i < 3 * count; i++) {
            float value = sample(image, i / 3, (uint32_t)(i % 3));
            value = image->maxval ? roundf(value * (float)image->maxval) : value;
            uint32_t bits;
            memcpy(&bits, &value, sizeof bits);
            for (int k = 0; k < 4; k++) {
                uint32_t byte = bits >> 8 * k & 255;
                picture.pixels[4 * i + (size_t)k] = byte ? curve.thresholds[byte - 1] : 0;
            }
        }
        url = picture_url(&picture);
    }
    lr_curve_free(&curve);
    lr_picture_free(&picture);
    return url;
}

json_t *lr_embed_picture(const char *path)
{
    static const unsigned char png[] = {0x89, 'P', 'N', 'G'};
    char *bytes = NULL;
    size_t size;
    lr_error ignored;
    lr_image image = {0};
    json_t *object = NULL;
    if (lr_file_read(path, PICTURE_BYTES_MAX, &bytes, &size, &ignored) != LR_OK ||
        lr_image_decode((unsigned char *)bytes, size, path, &image, &ignored) != LR_OK)
        goto done;
    object = json_pack("{s:i, s:i, s:i}", "width", (int)image.width, "height", (int)image.height,
                       "maxval", (int)image.maxval);
    bool is_png = size > sizeof png && memcmp(bytes, png, sizeof png) == 0;
    json_object_set_new(object, "src",
                        is_png ? data_url((unsigned char *)bytes, size) : shown_url(&image));
    bool small = image.width <= VALUES_WIDTH_MAX &&
                 (uint64_t)image.width * image.height <= VALUES_PIXELS_MAX;
    if (image.maxval != 255 && small)
        json_object_set_new(object, "values", values_url(&image));
done:
    lr_image_free(&image);
    free(bytes);
    return object;
}

static void embed_case(json_t *cases, uint32_t index, const lr_case_result *r)
{
    json_t *pictures = json_object();
    const struct {
        const char *key, *path;
    } all[] = {
        {"reference", r->outcome == LR_OUTCOME_MISSING ? NULL : r->item->golden},
        {"candidate", r->candidate},
        {"difference", r->difference},
    };
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        json_t *picture = all[i].path ? lr_embed_picture(all[i].path) : NULL;
        if (picture)
            json_object_set_new(pictures, all[i].key, picture);
    }
    json_object_set_new(json_array_get(cases, index), "pictures", pictures);
}

char *lr_results_html(const lr_results *results, lr_embed embed)
{
    json_t *object = lr_results_object(results);
    json_t *cases = json_object_get(object, "cases");
    for (uint32_t i = 0; i < results->count; i++)
        if (!results->results[i].crashed &&
            (embed == LR_EMBED_ALL || lr_outcome_failed(results->results[i].outcome)))
            embed_case(cases, i, &results->results[i]);
    char *data = json_dumps(object, JSON_COMPACT | JSON_ENSURE_ASCII);
    json_decref(object);
    const char *page = (const char *)report_html;
    const char *mark = strstr(page, MARK);
    char *text = NULL;
    size_t size = 0;
    FILE *out = data && mark ? open_memstream(&text, &size) : NULL;
    if (out) {
        fwrite(page, 1, (size_t)(mark - page), out);
        /* Nothing in the data may end the script that holds it. */
        for (const char *c = data; *c; c++)
            if (*c == '<')
                fputs("\\u003c", out);
            else
                fputc(*c, out);
        fputs(mark + strlen(MARK), out);
        if (fclose(out) != 0) {
            free(text);
            text = NULL;
        }
    }
    free(data);
    return text;
}
