/* The film as a window shows it: each pixel has the very bytes of the PNG or PPM that the same film
 * would be written to. */
#ifndef LR_RENDER_DISPLAY_H
#define LR_RENDER_DISPLAY_H

#include "gpu/program.h"
#include "image/image.h"

typedef struct lr_display {
    lr_device *device;
    lr_layout layout;
    VkDescriptorSet set;
    VkPipeline program;
    lr_curve srgb, linear;
    lr_buffer shades, palette;
    lr_buffer overlay, overlay_host, canvas; /* width * height words */
    uint32_t width, height;
    bool has_overlay;
} lr_display;

/* How the film is looked at. */
typedef struct lr_look {
    double exposure;          /* in stops */
    uint32_t samples, others; /* that pixels have: so many, or so many */
    uint32_t coarse;          /* 1: all of them have; else pixels between those that have */
    bool linear;              /* the values are shades, 0 to 1, whatever the exposure */
    bool palette;             /* red is shown by a colour of the palette */
    bool blue_first;          /* see lr_swapchain */
} lr_look;

lr_status lr_display_create(lr_device *device, lr_display *display, lr_error *error);
void lr_display_destroy(lr_display *display);

/* Makes room for pictures of this size; the overlay is gone then. */
lr_status lr_display_resize(lr_display *display, uint32_t width, uint32_t height, lr_error *error);

/* Lays width * height pixels, 0xAARRGGBB with premultiplied alpha, over the picture; NULL: none. */
lr_status lr_display_set_overlay(lr_display *display, const uint32_t *pixels, lr_error *error);

/* Makes the picture of a film of width * height pixels; it is then in display->canvas. Recorded
 * between lr_commands_begin and lr_commands_finish. */
void lr_display_record(lr_display *display, const lr_buffer *film, const lr_look *look);

#endif
