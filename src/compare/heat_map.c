/* The picture of a comparison: errors in colours over the dimmed reference, frames around the
 * regions unless they are many, and a scale. Colours are sRGB-encoded until the end. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "compare/approx.h"
#include "compare/compare_internal.h"
#include "compare/heat_font.h"

enum {
    SCALE_MIN_WIDTH = 96, /* narrower pictures get no scale */
    BAR_HEIGHT = 8,
    MARGIN = 6,
    FRAME_GAP = 3, /* pixels between a region and its frame */
};

typedef struct canvas {
    lr_picture *picture;
    uint32_t zoom; /* pixels to a dot of the scale's letters */
} canvas;

typedef struct color {
    float rgb[3];
} color;

static const color white = {{1, 1, 1}}, frame_color = {{0.3f, 1, 0.5f}};

static void put(const canvas *c, int64_t x, int64_t y, color value)
{
    const lr_picture *p = c->picture;
    if (x >= 0 && y >= 0 && x < p->width && y < p->height)
        memcpy(p->pixels + 3 * ((size_t)y * p->width + (size_t)x), value.rgb, sizeof value.rgb);
}

static color mix(color a, color b, float t)
{
    color m;
    for (int i = 0; i < 3; i++)
        m.rgb[i] = a.rgb[i] + (b.rgb[i] - a.rgb[i]) * t;
    return m;
}

/* From 0 to 1: violet, magenta, orange, yellow, nearly white; lighter all the way, so that it can
 * be read without colours too. */
static color ramp(float t)
{
    static const color stops[] = {{{0.30f, 0.15f, 0.75f}},
                                  {{0.70f, 0.15f, 0.65f}},
                                  {{0.95f, 0.35f, 0.25f}},
                                  {{1, 0.75f, 0.20f}},
                                  {{1, 1, 0.85f}}};
    float place = approx_min(approx_max(t, 0), 1) * 4;
    int i = place < 4 ? (int)place : 3;
    return mix(stops[i], stops[i + 1], place - (float)i);
}

/* The reference's luma, dimmed. */
static float backdrop(const lr_image *image, size_t pixel)
{
    const float *s = image->samples + pixel * image->channels;
    float luma = image->channels >= 3 ? 0.2126f * s[0] + 0.7152f * s[1] + 0.0722f * s[2] : s[0];
    luma = approx_min(approx_max(luma, 0), 1e15f);
    if (image->maxval == 0)
        luma = approx_power(luma / (1 + luma), 1 / 2.2f);
    return 0.04f + 0.3f * luma;
}

/* The next of 1, 2, 5, 10, 20, 50 ... or their tenths that is not below x. */
static double round_up(double x)
{
    double step = 1;
    while (step < x && step < 1e300)
        step *= 10;
    while (step / 10 >= x && step > 1e-300)
        step /= 10;
    return step / 5 >= x ? step / 5 : step / 2 >= x ? step / 2 : step;
}

static void draw_errors(const canvas *c, const lr_image *reference, const lr_compare_result *result,
                        float scale)
{
    for (uint32_t y = 0; y < result->height; y++)
        for (uint32_t x = 0; x < result->width; x++) {
            size_t i = (size_t)y * result->width + x;
            float grey = backdrop(reference, i), error = result->map[i];
            color pixel = {{grey, grey, grey}};
            if (error < 0 && (x + y) % 8 < 2)
                pixel = (color){{0.1f, 0.25f, 0.3f}}; /* hatched: not compared */
            float t = approx_min(error, scale) / scale;
            if (t > 0.002f)
                pixel = mix(pixel, ramp(t), approx_min(0.3f + 12 * t, 1));
            put(c, x, y, pixel);
        }
}

static void draw_frame(const canvas *c, lr_rectangle box, int64_t gap)
{
    int64_t left = (int64_t)box.x - gap, right = (int64_t)box.x + box.width - 1 + gap;
    int64_t top = (int64_t)box.y - gap, bottom = (int64_t)box.y + box.height - 1 + gap;
    for (int64_t x = left; x <= right; x++) {
        put(c, x, top, frame_color);
        put(c, x, bottom, frame_color);
    }
    for (int64_t y = top; y <= bottom; y++) {
        put(c, left, y, frame_color);
        put(c, right, y, frame_color);
    }
}

/* As thick as the letters; many frames would hide more than they show. */
static void draw_frames(const canvas *c, const lr_compare_result *result)
{
    for (uint32_t i = 0; i < result->region_count && result->region_count <= LR_REGIONS_MAX; i++)
        for (uint32_t line = 0; line < c->zoom; line++)
            draw_frame(c, result->regions[i].box, FRAME_GAP * c->zoom + line);
}

static uint32_t text_width(const canvas *c, const char *text)
{
    return (uint32_t)strlen(text) * (HEAT_FONT_WIDTH + 1) * c->zoom;
}

static void draw_text(const canvas *c, int64_t x, int64_t y, const char *text)
{
    for (; *text; text++, x += (HEAT_FONT_WIDTH + 1) * c->zoom)
        for (uint32_t i = 0; i < HEAT_FONT_WIDTH * HEAT_FONT_HEIGHT * c->zoom * c->zoom; i++) {
            uint32_t u = i % (HEAT_FONT_WIDTH * c->zoom), v = i / (HEAT_FONT_WIDTH * c->zoom);
            if (heat_font_dot(*text, u / c->zoom, v / c->zoom))
                put(c, x + u, y + v, white);
        }
}

/* A bar of all colours, its numbers below, and what they are. */
static void draw_scale(const canvas *c, const lr_compare_result *result, double scale)
{
    uint32_t margin = MARGIN * c->zoom, width = result->width - 2 * margin;
    uint32_t top = result->height + margin, bottom = top + BAR_HEIGHT * c->zoom;
    for (uint32_t y = top; y < bottom; y++)
        for (uint32_t x = 0; x < width; x++)
            put(c, margin + x, y, ramp((float)x / (float)(width - 1)));
    uint32_t line = bottom + margin / 2;
    char number[32];
    snprintf(number, sizeof number, "%g", scale);
    draw_text(c, margin, line, "0");
    draw_text(c, margin + (int64_t)width - text_width(c, number) + c->zoom, line, number);
    if (width > 5 * text_width(c, number)) {
        snprintf(number, sizeof number, "%g", scale / 2);
        draw_text(c, margin + (int64_t)(width - text_width(c, number)) / 2, line, number);
    }
    draw_text(c, margin + (int64_t)(width - text_width(c, result->map_name)) / 2,
              line + (HEAT_FONT_HEIGHT + 2) * c->zoom, result->map_name);
}

/* The inverse of the sRGB curve: pictures are linear. */
static void make_linear(lr_picture *picture)
{
    size_t count = 3 * (size_t)picture->width * picture->height;
    for (size_t i = 0; i < count; i++) {
        float x = picture->pixels[i];
        picture->pixels[i] = x <= 0.04045f ? x / 12.92f : approx_power((x + 0.055f) / 1.055f, 2.4f);
    }
}

lr_status lr_compare_heat_map(const lr_image *reference, const lr_compare_result *result,
                              lr_picture *picture, lr_error *error)
{
    *picture = (lr_picture){.width = result->width, .height = result->height};
    if (!result->map)
        return lr_fail(error, LR_ERROR_ARGUMENT, "the comparison kept no map");
    canvas c = {.picture = picture, .zoom = 1 + result->width / 1000};
    bool has_scale = result->width >= SCALE_MIN_WIDTH && result->height < UINT32_MAX / 2;
    if (has_scale)
        picture->height += (BAR_HEIGHT + 3 * MARGIN + 2 * HEAT_FONT_HEIGHT + 2) * c.zoom;
    picture->pixels = lr_alloc((size_t)picture->width * picture->height, 3 * sizeof(float));
    if (!picture->pixels)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for the heat map");
    size_t count = (size_t)result->width * result->height;
    float largest = 0;
    for (size_t i = 0; i < count; i++)
        if (result->map[i] > largest && result->map[i] <= 3.4e38f)
            largest = result->map[i];
    double scale = largest > 0 ? round_up((double)largest) : 1;
    draw_errors(&c, reference, result, (float)scale);
    draw_frames(&c, result);
    if (has_scale) {
        /* Frames do not reach into the scale. */
        memset(picture->pixels + 3 * count, 0,
               3 * sizeof(float) * (picture->height - result->height) * picture->width);
        draw_scale(&c, result, scale);
    }
    make_linear(picture);
    return LR_OK;
}

lr_status lr_compare_error_map(const lr_compare_result *result, lr_picture *picture,
                               lr_error *error)
{
    size_t count = (size_t)result->width * result->height;
    *picture = (lr_picture){.width = result->width, .height = result->height};
    picture->pixels = result->map ? lr_alloc(count, 3 * sizeof(float)) : NULL;
    if (!picture->pixels)
        return lr_fail(error, result->map ? LR_ERROR_MEMORY : LR_ERROR_ARGUMENT,
                       result->map ? "out of memory for the map of errors"
                                   : "the comparison kept no map");
    for (size_t i = 0; i < 3 * count; i++)
        picture->pixels[i] = result->map[i / 3];
    return LR_OK;
}
