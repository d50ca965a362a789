#include "render/display.h"

#include <string.h>

#include "base/exact.h"
#include "display.spv.h"
#include "gpu/commands.h"
#include "gpu_layout.h"
#include "render/film.h"

enum { BIND_FILM, BIND_SHADES, BIND_PALETTE, BIND_OVERLAY, BIND_CANVAS, BIND_COUNT };

/* Black, blue, red, yellow, white at even distances: they rise in lightness all along. */
static uint32_t palette_color(uint32_t index)
{
    static const uint8_t knots[][3] = {{0, 0, 4},     {66, 10, 104},  {147, 38, 103},
                                       {221, 81, 58}, {252, 165, 10}, {252, 255, 164}};
    const uint32_t last = sizeof knots / sizeof *knots - 1, top = LR_SHADES - 1;
    uint32_t knot = index * last / top;
    knot = knot < last ? knot : last - 1;
    uint32_t part = index * last - knot * top, color = 0;
    for (int channel = 0; channel < 3; channel++) {
        uint32_t value = knots[knot][channel] * (top - part) + knots[knot + 1][channel] * part;
        color = color << 8 | (value + top / 2) / top;
    }
    return color;
}

/* Drivers compile a kernel when it first runs: here on one black pixel. */
static lr_status warm_up(lr_display *d, lr_error *error)
{
    lr_buffer film = {0};
    lr_status status =
        lr_buffer_create(d->device, LR_BUFFER_STORAGE, 4 * LR_FILM_WORDS, "the film", &film, error);
    if (!status)
        status = lr_commands_begin(d->device, error);
    if (!status) {
        lr_commands_zero(d->device, &film, film.size);
        lr_display_record(d, &film, &(lr_look){0});
        status = lr_commands_finish(d->device, error);
    }
    lr_buffer_destroy(d->device, &film);
    return status;
}

lr_status lr_display_create(lr_device *device, lr_display *display, lr_error *error)
{
    *display = (lr_display){.device = device};
    VkDescriptorType types[BIND_COUNT];
    for (int i = 0; i < BIND_COUNT; i++)
        types[i] = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    lr_layout_desc layout = {types, BIND_COUNT, sizeof(struct gpu_display), 1};
    lr_program_desc program = {.words = display_spv, .word_count = sizeof display_spv / 4};
    uint32_t colors[LR_SHADES];
    for (uint32_t i = 0; i < LR_SHADES; i++)
        colors[i] = palette_color(i);
    lr_status status = lr_curve_create(&display->srgb, LR_TRANSFER_SRGB, LR_SHADES - 1, error);
    if (!status)
        status = lr_curve_create(&display->linear, LR_TRANSFER_LINEAR, LR_SHADES - 1, error);
    if (!status)
        status = lr_layout_create(device, &layout, &display->layout, error);
    if (!status)
        status = lr_program_create(device, &display->layout, &program, &display->program, error);
    if (!status)
        status = lr_buffer_create(device, LR_BUFFER_STORAGE, 2 * sizeof(struct gpu_shades),
                                  "shades", &display->shades, error);
    if (!status)
        status = lr_buffer_create(device, LR_BUFFER_STORAGE, sizeof colors, "the palette",
                                  &display->palette, error);
    if (!status)
        status = lr_buffer_upload(device, &display->palette, colors, sizeof colors, error);
    if (!status)
        status = lr_display_resize(display, 1, 1, error);
    if (!status) {
        /* Whatever: the film takes its place before it is used. */
        const lr_buffer *buffers[BIND_COUNT] = {&display->canvas, &display->shades,
                                                &display->palette, &display->overlay,
                                                &display->canvas};
        status = lr_set_create(device, &display->layout, buffers, &display->set, error);
    }
    if (!status)
        status = warm_up(display, error);
    if (status)
        lr_display_destroy(display);
    return status;
}

static void drop_pictures(lr_display *d)
{
    lr_buffer_destroy(d->device, &d->overlay);
    lr_buffer_destroy(d->device, &d->overlay_host);
    lr_buffer_destroy(d->device, &d->canvas);
    d->width = d->height = 0;
    d->has_overlay = false;
}

void lr_display_destroy(lr_display *display)
{
    lr_display *d = display;
    if (!d->device)
        return;
    drop_pictures(d);
    lr_buffer_destroy(d->device, &d->shades);
    lr_buffer_destroy(d->device, &d->palette);
    if (d->program)
        d->device->vk.vkDestroyPipeline(d->device->handle, d->program, NULL);
    lr_layout_destroy(d->device, &d->layout);
    lr_curve_free(&d->srgb);
    lr_curve_free(&d->linear);
    *d = (lr_display){0};
}

lr_status lr_display_resize(lr_display *display, uint32_t width, uint32_t height, lr_error *error)
{
    lr_display *d = display;
    if (width == d->width && height == d->height)
        return LR_OK;
    drop_pictures(d);
    VkDeviceSize size = 4ull * width * height;
    const char *what = "the window's picture";
    lr_status status =
        lr_buffer_create(d->device, LR_BUFFER_STORAGE, size, what, &d->canvas, error);
    if (!status)
        status = lr_buffer_create(d->device, LR_BUFFER_STORAGE, size, what, &d->overlay, error);
    if (!status)
        status = lr_buffer_create(d->device, LR_BUFFER_HOST, size, what, &d->overlay_host, error);
    if (!status) {
        d->width = width;
        d->height = height;
    }
    return status;
}

lr_status lr_display_set_overlay(lr_display *display, const uint32_t *pixels, lr_error *error)
{
    lr_display *d = display;
    d->has_overlay = pixels != NULL;
    if (!pixels)
        return LR_OK;
    size_t size = 4 * (size_t)d->width * d->height;
    memcpy(d->overlay_host.mapped, pixels, size);
    lr_status status = lr_commands_begin(d->device, error);
    if (status)
        return status;
    lr_commands_copy(d->device, &d->overlay_host, &d->overlay, size);
    return lr_commands_finish(d->device, error);
}

/* The least sum that has at least this shade; 2^64 - 1 also where there is none, which is as good:
 * no sum that has not overflowed comes near it. */
static uint64_t find_step(const lr_curve *curve, uint32_t shade, uint32_t samples, double scale,
                          uint64_t from)
{
    uint64_t below = from, reached = UINT64_MAX;
    while (below < reached) {
        uint64_t middle = below + (reached - below) / 2;
        float value = lr_exposed(lr_film_mean(middle, samples), scale);
        if (lr_curve_encode(curve, value) >= shade)
            reached = middle;
        else
            below = middle + 1;
    }
    return reached;
}

/* Sums are in the bucket from this one on: the inverse of sum_bucket in display.comp. */
static uint64_t bucket_start(uint32_t bucket)
{
    const uint32_t size = 1 << LR_BUCKET_BITS;
    uint32_t by = bucket < 2 * size ? 0 : bucket / size - 1;
    return (uint64_t)(bucket - by * size) << by;
}

static void fill_shades(const lr_curve *curve, uint32_t samples, double scale,
                        struct gpu_shades *out)
{
    uint64_t steps[LR_SHADES], step = 0;
    samples = samples ? samples : 1;
    for (uint32_t i = 0; i < LR_SHADES; i++) {
        step = i < LR_SHADES - 1 ? find_step(curve, i + 1, samples, scale, step) : UINT64_MAX;
        steps[i] = step;
        out->steps_low[i] = (uint32_t)step;
        out->steps_high[i] = (uint32_t)(step >> 32);
    }
    uint32_t reached = 0;
    for (uint32_t bucket = 0; bucket < LR_BUCKETS; bucket++) {
        while (reached < LR_SHADES - 1 && steps[reached] <= bucket_start(bucket))
            reached++;
        out->starts[bucket] = reached;
    }
    out->overflow = lr_curve_encode(curve, lr_exposed(lr_film_overflow(samples), scale));
}

void lr_display_record(lr_display *display, const lr_buffer *film, const lr_look *look)
{
    lr_display *d = display;
    double scale = look->linear ? 1 : lr_exp2(look->exposure);
    const lr_curve *curve = look->linear ? &d->linear : &d->srgb;
    const uint32_t samples[2] = {look->samples, look->others};
    for (int i = 0; i < 2; i++) {
        struct gpu_shades shades = {0};
        fill_shades(curve, samples[i], scale, &shades);
        lr_commands_write(d->device, &d->shades, i * sizeof shades, &shades, sizeof shades);
    }
    const lr_buffer *buffers[BIND_COUNT] = {film, &d->shades, &d->palette, &d->overlay, &d->canvas};
    lr_set_write(d->device, &d->layout, buffers, d->set);
    struct gpu_display work = {
        .width = d->width,
        .height = d->height,
        .samples = look->samples,
        .blue_first = look->blue_first,
        .overlay = d->has_overlay,
        .palette = look->palette,
        .coarse = look->coarse,
    };
    lr_commands_barrier(d->device);
    lr_commands_dispatch(d->device, &d->layout, d->program, d->set, &work,
                         (d->width + LR_GROUP_SIZE - 1) / LR_GROUP_SIZE, d->height, 1);
    lr_commands_barrier(d->device);
}
