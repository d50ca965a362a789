#include "gpu/swapchain.h"

#define FORMATS_MAX 128
#define MODES_MAX 16
#define TIMEOUT_NANOSECONDS 10000000000ull

/* Results after which the swapchain, or its surface, is to be made anew. */
static bool is_stale(VkResult result)
{
    return result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_ERROR_SURFACE_LOST_KHR ||
           result == VK_SUBOPTIMAL_KHR;
}

static void note(lr_device *device, lr_swapchain *s, VkResult result)
{
    s->stale = s->stale || is_stale(result);
    if (result == VK_ERROR_SURFACE_LOST_KHR)
        lr_swapchain_destroy(device, s);
}

/* Bytes are copied as they are, so what an sRGB format would do to colours does not matter. */
static bool choose_format(lr_device *device, lr_swapchain *s, VkSurfaceFormatKHR *format)
{
    static const VkFormat known[] = {
        VK_FORMAT_B8G8R8A8_UNORM,
        VK_FORMAT_R8G8B8A8_UNORM,
        VK_FORMAT_B8G8R8A8_SRGB,
        VK_FORMAT_R8G8B8A8_SRGB,
    };
    VkSurfaceFormatKHR formats[FORMATS_MAX];
    uint32_t count = FORMATS_MAX;
    VkResult result = device->vk.vkGetPhysicalDeviceSurfaceFormatsKHR(device->physical, s->surface,
                                                                      &count, formats);
    for (size_t k = 0; result >= 0 && k < sizeof known / sizeof *known; k++)
        for (uint32_t i = 0; i < count; i++)
            if (formats[i].format == known[k] &&
                formats[i].colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) {
                *format = formats[i];
                s->blue_first = k % 2 == 0;
                return true;
            }
    return false;
}

/* Of the ways to show an image the one that waits least, but for torn pictures. */
static VkPresentModeKHR choose_mode(lr_device *device, const lr_swapchain *s)
{
    VkPresentModeKHR modes[MODES_MAX];
    uint32_t count = MODES_MAX;
    VkResult result = device->vk.vkGetPhysicalDeviceSurfacePresentModesKHR(
        device->physical, s->surface, &count, modes);
    for (uint32_t i = 0; result >= 0 && i < count; i++)
        if (modes[i] == VK_PRESENT_MODE_MAILBOX_KHR)
            return modes[i];
    return VK_PRESENT_MODE_FIFO_KHR;
}

static lr_status create_surface(lr_device *device, lr_swapchain *s, lr_error *error)
{
    const lr_window_system *window = device->window;
    lr_status status = LR_OK;
    VkResult result = window->create_surface(window->window, device->instance, &s->surface);
    if (result != VK_SUCCESS)
        return lr_vk_fail(error, "creating the window's surface", result);
    VkBool32 supported = VK_FALSE;
    LR_VK(&device->vk, vkGetPhysicalDeviceSurfaceSupportKHR, device->physical, device->queue_family,
          s->surface, &supported);
    if (!supported)
        return lr_fail(error, LR_ERROR_DEVICE, "%s cannot show pictures in this window",
                       device->info.name);
    VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    LR_VK(&device->vk, vkCreateFence, device->handle, &fence, NULL, &s->acquired);
fail:
    return status;
}

static uint32_t within(uint32_t value, uint32_t least, uint32_t most)
{
    return value < least ? least : value > most ? most : value;
}

static void drop_images(lr_device *device, lr_swapchain *s)
{
    if (s->handle) {
        device->vk.vkDeviceWaitIdle(device->handle);
        device->vk.vkDestroySwapchainKHR(device->handle, s->handle, NULL);
    }
    s->handle = VK_NULL_HANDLE;
    s->image_count = s->width = s->height = 0;
}

static lr_status create_images(lr_device *device, lr_swapchain *s,
                               const VkSurfaceCapabilitiesKHR *can, lr_error *error)
{
    lr_status status = LR_OK;
    lr_vk *vk = &device->vk;
    VkSurfaceFormatKHR format;
    if (!choose_format(device, s, &format) ||
        !(can->supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_DST_BIT))
        return lr_fail(error, LR_ERROR_DEVICE,
                       "%s shows no 8-bit RGB pictures in this window; try another --device",
                       device->info.name);
    uint32_t most = can->maxImageCount ? can->maxImageCount : LR_SWAPCHAIN_IMAGES;
    VkSwapchainKHR old = s->handle;
    VkSwapchainCreateInfoKHR desc = {
        .sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
        .surface = s->surface,
        .minImageCount = within(3, can->minImageCount, most),
        .imageFormat = format.format,
        .imageColorSpace = format.colorSpace,
        .imageExtent = {s->width, s->height},
        .imageArrayLayers = 1,
        .imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT,
        .imageSharingMode = VK_SHARING_MODE_EXCLUSIVE,
        .preTransform = can->currentTransform,
        .compositeAlpha = can->supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                              ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                              : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR,
        .presentMode = choose_mode(device, s),
        .clipped = VK_TRUE,
        .oldSwapchain = old,
    };
    s->handle = VK_NULL_HANDLE;
    VkResult result = vk->vkCreateSwapchainKHR(device->handle, &desc, NULL, &s->handle);
    if (old) {
        vk->vkDeviceWaitIdle(device->handle);
        vk->vkDestroySwapchainKHR(device->handle, old, NULL);
    }
    if (is_stale(result)) { /* the window has changed once more, or gone */
        s->handle = VK_NULL_HANDLE;
        note(device, s, result);
        return LR_OK;
    }
    if (result != VK_SUCCESS) {
        s->handle = VK_NULL_HANDLE;
        return lr_vk_fail(error, "vkCreateSwapchainKHR", result);
    }
    s->image_count = LR_SWAPCHAIN_IMAGES;
    LR_VK(vk, vkGetSwapchainImagesKHR, device->handle, s->handle, &s->image_count, s->images);
fail:
    return status;
}

lr_status lr_swapchain_fit(lr_device *device, lr_swapchain *s, uint32_t width, uint32_t height,
                           lr_error *error)
{
    lr_status status = LR_OK;
    /* Asking the window system costs a round trip. */
    if (s->handle && !s->stale && width == s->asked_width && height == s->asked_height)
        return LR_OK;
    if (!s->surface)
        status = create_surface(device, s, error);
    if (status)
        return status;
    s->asked_width = width;
    s->asked_height = height;
    VkSurfaceCapabilitiesKHR can;
    VkResult result =
        device->vk.vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device->physical, s->surface, &can);
    if (is_stale(result)) {
        note(device, s, result);
        return LR_OK;
    }
    if (result != VK_SUCCESS)
        return lr_vk_fail(error, "vkGetPhysicalDeviceSurfaceCapabilitiesKHR", result);
    if (can.currentExtent.width != UINT32_MAX) {
        width = can.currentExtent.width;
        height = can.currentExtent.height;
    } else if (width > 0 && height > 0) {
        width = within(width, can.minImageExtent.width, can.maxImageExtent.width);
        height = within(height, can.minImageExtent.height, can.maxImageExtent.height);
    }
    if (s->handle && !s->stale && width == s->width && height == s->height)
        return LR_OK;
    s->stale = false;
    if (width == 0 || height == 0) {
        drop_images(device, s);
        return LR_OK;
    }
    s->width = width;
    s->height = height;
    return create_images(device, s, &can, error);
}

void lr_swapchain_destroy(lr_device *device, lr_swapchain *s)
{
    drop_images(device, s);
    if (s->acquired)
        device->vk.vkDestroyFence(device->handle, s->acquired, NULL);
    if (s->surface)
        device->vk.vkDestroySurfaceKHR(device->instance, s->surface, NULL);
    *s = (lr_swapchain){.stale = true};
}

lr_status lr_swapchain_acquire(lr_device *device, lr_swapchain *s, uint32_t *image, lr_error *error)
{
    lr_status status = LR_OK;
    lr_vk *vk = &device->vk;
    uint32_t taken = UINT32_MAX;
    *image = UINT32_MAX;
    VkResult result = vk->vkAcquireNextImageKHR(device->handle, s->handle, 0, VK_NULL_HANDLE,
                                                s->acquired, &taken);
    if (result == VK_NOT_READY || result == VK_TIMEOUT)
        return LR_OK;
    note(device, s, result);
    if (is_stale(result) && result != VK_SUBOPTIMAL_KHR)
        return LR_OK;
    if (result < 0)
        return lr_vk_fail(error, "vkAcquireNextImageKHR", result);
    LR_VK(vk, vkWaitForFences, device->handle, 1, &s->acquired, VK_TRUE, TIMEOUT_NANOSECONDS);
    LR_VK(vk, vkResetFences, device->handle, 1, &s->acquired);
    *image = taken;
fail:
    return status;
}

static void change_layout(lr_device *device, VkImage image, VkImageLayout from, VkImageLayout to,
                          VkAccessFlags written, VkAccessFlags used)
{
    VkImageMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .srcAccessMask = written,
        .dstAccessMask = used,
        .oldLayout = from,
        .newLayout = to,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1},
    };
    device->vk.vkCmdPipelineBarrier(device->commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                                    VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, NULL, 0, NULL, 1,
                                    &barrier);
}

void lr_swapchain_copy(lr_device *device, const lr_swapchain *s, const lr_buffer *pixels,
                       uint32_t image)
{
    VkImageLayout filled = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    change_layout(device, s->images[image], VK_IMAGE_LAYOUT_UNDEFINED, filled, 0,
                  VK_ACCESS_TRANSFER_WRITE_BIT);
    VkBufferImageCopy region = {
        .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
        .imageExtent = {s->width, s->height, 1},
    };
    device->vk.vkCmdCopyBufferToImage(device->commands, pixels->handle, s->images[image], filled, 1,
                                      &region);
    change_layout(device, s->images[image], filled, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
                  VK_ACCESS_TRANSFER_WRITE_BIT, 0);
}

lr_status lr_swapchain_present(lr_device *device, lr_swapchain *s, uint32_t image, bool *shown,
                               lr_error *error)
{
    VkPresentInfoKHR desc = {
        .sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
        .swapchainCount = 1,
        .pSwapchains = &s->handle,
        .pImageIndices = &image,
    };
    VkResult result = device->vk.vkQueuePresentKHR(device->queue, &desc);
    *shown = result >= 0;
    note(device, s, result);
    if (result < 0 && !is_stale(result))
        return lr_vk_fail(error, "vkQueuePresentKHR", result);
    return LR_OK;
}
