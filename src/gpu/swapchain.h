/* Pictures shown in a window: a surface, its images, and the way of a picture's bytes to them, on
 * the device all along. */
#ifndef LR_GPU_SWAPCHAIN_H
#define LR_GPU_SWAPCHAIN_H

#include "gpu/buffer.h"

#define LR_SWAPCHAIN_IMAGES 8

typedef struct lr_swapchain {
    VkSurfaceKHR surface;
    VkSwapchainKHR handle; /* null while the window has no area */
    VkImage images[LR_SWAPCHAIN_IMAGES];
    uint32_t image_count;
    uint32_t width, height;             /* in pixels; of pictures that are shown */
    uint32_t asked_width, asked_height; /* of lr_swapchain_fit */
    bool blue_first; /* a pixel's bytes are blue, green, red, unused; else red comes first */
    bool stale;      /* it no longer suits its window */
    VkFence acquired;
} lr_swapchain;

/* Fits the images to the window, whose size in pixels is width x height as far as the surface does
 * not know better. Call it first on a zeroed lr_swapchain, and later when the window's size has
 * changed or the swapchain is stale. A window without area leaves `handle` null. */
lr_status lr_swapchain_fit(lr_device *device, lr_swapchain *swapchain, uint32_t width,
                           uint32_t height, lr_error *error);
void lr_swapchain_destroy(lr_device *device, lr_swapchain *swapchain);

/* Takes an image that is free. When none is, or the swapchain has become stale, *image is
 * UINT32_MAX.
 */
lr_status lr_swapchain_acquire(lr_device *device, lr_swapchain *swapchain, uint32_t *image,
                               lr_error *error);

/* Records, between lr_commands_begin and lr_commands_finish, the copy of width x height pixels of 4
 * bytes, top row first, into the image. */
void lr_swapchain_copy(lr_device *device, const lr_swapchain *swapchain, const lr_buffer *pixels,
                       uint32_t image);

/* Shows the image after lr_commands_finish. *shown is false when the swapchain has become stale
 * before that. */
lr_status lr_swapchain_present(lr_device *device, lr_swapchain *swapchain, uint32_t image,
                               bool *shown, lr_error *error);

#endif
