/* A comparison's outcome in plain English. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "compare/compare_internal.h"

typedef struct writer {
    char *text;
    size_t size, used;
} writer;

static void write(writer *w, const char *format, ...) __attribute__((format(printf, 2, 3)));

static void write(writer *w, const char *format, ...)
{
    if (w->used >= w->size)
        return;
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(w->text + w->used, w->size - w->used, format, arguments);
    va_end(arguments);
    w->used += length > 0 ? (size_t)length : 0;
}

static void write_shift(writer *w, const lr_compare_result *r)
{
    int x = r->dx < 0 ? -r->dx : r->dx, y = r->dy < 0 ? -r->dy : r->dy;
    write(w, "The whole picture moved by ");
    if (x)
        write(w, "%d pixel%s to the %s", x, x == 1 ? "" : "s", r->dx < 0 ? "left" : "right");
    if (x && y)
        write(w, " and ");
    if (y)
        write(w, "%d pixel%s %s", y, y == 1 ? "" : "s", r->dy < 0 ? "up" : "down");
    write(w, ".");
}

static void write_color(writer *w, const lr_compare_result *r)
{
    double least = fmin(r->gain[0], fmin(r->gain[1], r->gain[2]));
    double most = fmax(r->gain[0], fmax(r->gain[1], r->gain[2]));
    bool offset = false;
    for (int c = 0; c < 3; c++)
        offset |= fabs(r->offset[c]) > 0.004;
    bool grey = most - least<0.02, gamma = fabs(r->gamma - 1)> 0.02;
    if (gamma && grey && !offset && fabs(most - 1) < 0.05)
        write(w, "The whole picture has another gamma: the reference to the power of %.2f.",
              r->gamma);
    else if (!gamma && grey && !offset)
        write(w, "The whole picture is %.3g %% %s.", 100 * fabs(most - 1),
              most < 1 ? "darker" : "brighter");
    else if (!gamma && grey)
        write(w, "The whole picture has another contrast: %.2f times the reference %+.3f.", most,
              (r->offset[0] + r->offset[1] + r->offset[2]) / 3);
    else
        write(w,
              "The whole picture has other colours: red, green, blue times %.2f, %.2f, %.2f"
              " plus %.3f, %.3f, %.3f, gamma %.2f.",
              r->gain[0], r->gain[1], r->gain[2], r->offset[0], r->offset[1], r->offset[2],
              r->gamma);
}

static void write_mirror(writer *w, const lr_compare_result *r)
{
    write(w, "The picture is %s.",
          r->dx && r->dy ? "turned upside down"
          : r->dx        ? "mirrored left to right"
                         : "mirrored top to bottom");
}

static void write_local(writer *w, const lr_compare_result *r)
{
    const lr_region *region = &r->regions[0];
    if (r->different_pixels == 1)
        write(w, "One pixel differs, at %u,%u.", r->first_x, r->first_y);
    else if (r->region_count == 1)
        write(w, "One place differs: %u x %u pixels at %u,%u.", region->box.width,
              region->box.height, region->box.x, region->box.y);
    else if (r->region_count > 1)
        write(w,
              "%llu places differ, the worst with %u x %u pixels at %u,%u; the rest is the same.",
              (unsigned long long)r->region_count, region->box.width, region->box.height,
              region->box.x, region->box.y);
    else
        write(w, "Small parts differ, within the limits.");
}

static void write_cause(writer *w, const lr_compare_result *r)
{
    static const char channels[] = {'R', 'G', 'B'};
    switch (r->cause) {
    case LR_CAUSE_SHIFT:
        write_shift(w, r);
        break;
    case LR_CAUSE_MIRROR:
        write_mirror(w, r);
        break;
    case LR_CAUSE_COLOR:
        write_color(w, r);
        break;
    case LR_CAUSE_LOCAL:
        write_local(w, r);
        break;
    case LR_CAUSE_CHANNELS:
        write(w, "Channels changed places: R, G, B are the reference's %c, %c, %c.",
              channels[r->order[0]], channels[r->order[1]], channels[r->order[2]]);
        break;
    case LR_CAUSE_ALPHA:
        write(w, "Only alpha differs, the colours are the same.");
        break;
    case LR_CAUSE_ROUNDING:
        write(w, "Values are rounded otherwise, to a step or to fewer levels.");
        break;
    case LR_CAUSE_NOISE:
        if (r->metrics[LR_METRIC_NOISE].pass)
            write(w, "The pictures' noise explains all that differs.");
        else
            write(w, "Uncorrelated noise all over the picture.");
        break;
    case LR_CAUSE_BLUR:
        write(w, "The picture is blurred.");
        break;
    case LR_CAUSE_SHARPEN:
        write(w, "The picture is sharpened.");
        break;
    case LR_CAUSE_BLOCKS:
        write(w, "Blocks of 8 x 8 pixels: a JPEG or another lossy codec.");
        break;
    case LR_CAUSE_EDGES:
        write(w, "Only edges differ, as by other antialiasing or a movement below a pixel.");
        break;
    case LR_CAUSE_NONE:
    case LR_CAUSE_UNKNOWN:
    case LR_CAUSE_COUNT:
        write(w, "The pictures differ in many places, for no single cause.");
        break;
    }
}

void lr_compare_describe(const lr_compare_result *result, char *text, size_t size)
{
    writer w = {.text = text, .size = size};
    if (size > 0)
        *text = '\0';
    if (!result->same_size)
        write(&w, "The sizes differ: the reference has %u x %u pixels, the test %u x %u.",
              result->width, result->height, result->test_width, result->test_height);
    else if (result->cause != LR_CAUSE_NONE)
        write_cause(&w, result);
    const lr_metric_result *noise = &result->metrics[LR_METRIC_NOISE];
    if (noise->measured && !noise->pass)
        write(&w, " The noise does not explain %u x %u pixels at %u,%u: %.3g standard deviations.",
              result->noise_box.width, result->noise_box.height, result->noise_box.x,
              result->noise_box.y, result->noise_z);
}
