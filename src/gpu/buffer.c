#include "gpu/buffer.h"

#include <string.h>

#include "gpu/commands.h"

/* Bytes that travel at once. */
#define STAGING_MAX ((size_t)16 << 20)

static const VkBufferUsageFlags transfers =
    VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;

/* The first memory type that has all the wanted properties, preferring one with `better` too. */
static uint32_t find_memory(const lr_device *device, uint32_t allowed, VkMemoryPropertyFlags wanted,
                            VkMemoryPropertyFlags better)
{
    for (int pass = 0; pass < 2; pass++) {
        VkMemoryPropertyFlags flags = pass == 0 ? wanted | better : wanted;
        for (uint32_t i = 0; i < device->memory.memoryTypeCount; i++)
            if ((allowed & 1u << i) &&
                (device->memory.memoryTypes[i].propertyFlags & flags) == flags)
                return i;
    }
    return UINT32_MAX;
}

static lr_status check_limits(const lr_device *device, lr_buffer_kind kind, VkDeviceSize size,
                              const char *what, lr_error *error)
{
    const char *limit = NULL;
    unsigned long long most = 0;
    if (kind == LR_BUFFER_UNIFORM) {
        limit = "maxUniformBufferRange";
        most = device->limits.maxUniformBufferRange;
    } else if (kind == LR_BUFFER_TEXEL && size / 16 <= device->limits.maxTexelBufferElements) {
        return LR_OK; /* beyond maxStorageBufferRange it is a texel buffer only */
    } else if (kind != LR_BUFFER_HOST) {
        limit = "maxStorageBufferRange";
        most = device->limits.maxStorageBufferRange;
    }
    if (limit && size > most)
        return lr_fail(error, LR_ERROR_MEMORY,
                       "%s needs %llu bytes on the device, over its limit %s of %llu", what,
                       (unsigned long long)size, limit, most);
    return LR_OK;
}

lr_status lr_buffer_create(lr_device *device, lr_buffer_kind kind, VkDeviceSize size,
                           const char *what, lr_buffer *buffer, lr_error *error)
{
    *buffer = (lr_buffer){.size = size};
    lr_status status = check_limits(device, kind, size, what, error);
    if (status)
        return status;
    lr_vk *vk = &device->vk;
    VkBufferUsageFlags usage = transfers;
    if (kind == LR_BUFFER_UNIFORM)
        usage |= VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT;
    if (kind == LR_BUFFER_TEXEL)
        usage |= VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
    if (kind == LR_BUFFER_STORAGE || kind == LR_BUFFER_TEXEL)
        usage |= VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
    VkBufferCreateInfo desc = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = size, .usage = usage};
    LR_VK(vk, vkCreateBuffer, device->handle, &desc, NULL, &buffer->handle);

    VkMemoryRequirements needs;
    vk->vkGetBufferMemoryRequirements(device->handle, buffer->handle, &needs);
    bool host = kind == LR_BUFFER_HOST;
    uint32_t type = find_memory(
        device, needs.memoryTypeBits,
        host ? VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT : 0,
        host ? VK_MEMORY_PROPERTY_HOST_CACHED_BIT : VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    if (type == UINT32_MAX) {
        status = lr_fail(error, LR_ERROR_DEVICE, "the device has no memory for %s", what);
        goto fail;
    }
    const VkMemoryPropertyFlags direct =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    buffer->direct = (device->memory.memoryTypes[type].propertyFlags & direct) == direct;
    VkMemoryAllocateInfo allocate = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
        .allocationSize = needs.size,
        .memoryTypeIndex = type,
    };
    LR_VK(vk, vkAllocateMemory, device->handle, &allocate, NULL, &buffer->memory);
    LR_VK(vk, vkBindBufferMemory, device->handle, buffer->handle, buffer->memory, 0);
    if (host)
        LR_VK(vk, vkMapMemory, device->handle, buffer->memory, 0, VK_WHOLE_SIZE, 0,
              &buffer->mapped);
    if (kind == LR_BUFFER_TEXEL && size / 16 <= device->limits.maxTexelBufferElements) {
        VkBufferViewCreateInfo view = {
            .sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
            .buffer = buffer->handle,
            .format = VK_FORMAT_R32G32B32A32_UINT,
            .range = VK_WHOLE_SIZE,
        };
        LR_VK(vk, vkCreateBufferView, device->handle, &view, NULL, &buffer->view);
    }
    return LR_OK;
fail:
    lr_buffer_destroy(device, buffer);
    return status;
}

void lr_buffer_destroy(lr_device *device, lr_buffer *buffer)
{
    lr_vk *vk = &device->vk;
    if (buffer->view)
        vk->vkDestroyBufferView(device->handle, buffer->view, NULL);
    if (buffer->handle)
        vk->vkDestroyBuffer(device->handle, buffer->handle, NULL);
    if (buffer->memory)
        vk->vkFreeMemory(device->handle, buffer->memory, NULL);
    *buffer = (lr_buffer){0};
}

static lr_status write_direct(lr_device *device, lr_buffer *buffer, const void *bytes, size_t size,
                              lr_error *error)
{
    lr_status status = LR_OK;
    lr_vk *vk = &device->vk;
    void *mapped;
    LR_VK(vk, vkMapMemory, device->handle, buffer->memory, 0, VK_WHOLE_SIZE, 0, &mapped);
    memcpy(mapped, bytes, size);
    vk->vkUnmapMemory(device->handle, buffer->memory);
fail:
    return status;
}

lr_status lr_buffer_upload(lr_device *device, lr_buffer *buffer, const void *bytes, size_t size,
                           lr_error *error)
{
    if (buffer->direct)
        return write_direct(device, buffer, bytes, size, error);
    lr_buffer staging;
    size_t piece = size < STAGING_MAX ? size : STAGING_MAX;
    lr_status status =
        lr_buffer_create(device, LR_BUFFER_HOST, piece, "an upload", &staging, error);
    for (size_t done = 0; done < size && !status; done += piece) {
        size_t count = size - done < piece ? size - done : piece;
        memcpy(staging.mapped, (const char *)bytes + done, count);
        status = lr_commands_begin(device, error);
        if (status)
            break;
        lr_commands_copy_to(device, &staging, buffer, done, count);
        status = lr_commands_finish(device, error);
    }
    lr_buffer_destroy(device, &staging);
    return status;
}
