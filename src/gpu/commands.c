#include "gpu/commands.h"

/* A dispatch is meant to take a tenth of a second; this long without an answer is a hang. */
#define TIMEOUT_NANOSECONDS 120000000000ull

lr_status lr_commands_begin(lr_device *device, lr_error *error)
{
    lr_status status = LR_OK;
    VkCommandBufferBeginInfo begin = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
        .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
    };
    LR_VK(&device->vk, vkBeginCommandBuffer, device->commands, &begin);
fail:
    return status;
}

static void bind(lr_device *device, const lr_layout *layout, VkPipeline program,
                 VkDescriptorSet set, const void *push)
{
    lr_vk *vk = &device->vk;
    vk->vkCmdBindPipeline(device->commands, VK_PIPELINE_BIND_POINT_COMPUTE, program);
    vk->vkCmdBindDescriptorSets(device->commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout->pipeline,
                                0, 1, &set, 0, NULL);
    if (layout->push_size)
        vk->vkCmdPushConstants(device->commands, layout->pipeline, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                               layout->push_size, push);
}

void lr_commands_dispatch(lr_device *device, const lr_layout *layout, VkPipeline program,
                          VkDescriptorSet set, const void *push, uint32_t x, uint32_t y, uint32_t z)
{
    bind(device, layout, program, set, push);
    device->vk.vkCmdDispatch(device->commands, x, y, z);
}

void lr_commands_dispatch_indirect(lr_device *device, const lr_layout *layout, VkPipeline program,
                                   VkDescriptorSet set, const void *push, const lr_buffer *counts,
                                   VkDeviceSize offset)
{
    bind(device, layout, program, set, push);
    device->vk.vkCmdDispatchIndirect(device->commands, counts->handle, offset);
}

void lr_commands_barrier(lr_device *device)
{
    VkMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
        .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
        .dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT |
                         VK_ACCESS_UNIFORM_READ_BIT | VK_ACCESS_INDIRECT_COMMAND_READ_BIT |
                         VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT |
                         VK_ACCESS_HOST_READ_BIT,
    };
    VkPipelineStageFlags work =
        VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    device->vk.vkCmdPipelineBarrier(device->commands, work,
                                    work | VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT |
                                        VK_PIPELINE_STAGE_HOST_BIT,
                                    0, 1, &barrier, 0, NULL, 0, NULL);
}

void lr_commands_copy(lr_device *device, const lr_buffer *from, const lr_buffer *to,
                      VkDeviceSize size)
{
    lr_commands_copy_to(device, from, to, 0, size);
}

void lr_commands_copy_to(lr_device *device, const lr_buffer *from, const lr_buffer *to,
                         VkDeviceSize offset, VkDeviceSize size)
{
    VkBufferCopy region = {.dstOffset = offset, .size = size};
    device->vk.vkCmdCopyBuffer(device->commands, from->handle, to->handle, 1, &region);
}

void lr_commands_zero(lr_device *device, const lr_buffer *buffer, VkDeviceSize size)
{
    device->vk.vkCmdFillBuffer(device->commands, buffer->handle, 0, size, 0);
}

void lr_commands_write(lr_device *device, const lr_buffer *buffer, VkDeviceSize offset,
                       const void *bytes, VkDeviceSize size)
{
    device->vk.vkCmdUpdateBuffer(device->commands, buffer->handle, offset, size, bytes);
}

lr_status lr_commands_finish(lr_device *device, lr_error *error)
{
    lr_status status = LR_OK;
    lr_vk *vk = &device->vk;
    lr_commands_barrier(device);
    LR_VK(vk, vkEndCommandBuffer, device->commands);
    VkSubmitInfo submit = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
        .commandBufferCount = 1,
        .pCommandBuffers = &device->commands,
    };
    LR_VK(vk, vkQueueSubmit, device->queue, 1, &submit, device->fence);
    VkResult waited =
        vk->vkWaitForFences(device->handle, 1, &device->fence, VK_TRUE, TIMEOUT_NANOSECONDS);
    if (waited != VK_SUCCESS) {
        /* The work may still run: nothing that it uses may be freed before it has ended. */
        vk->vkDeviceWaitIdle(device->handle);
        return lr_vk_fail(error, "vkWaitForFences", waited);
    }
    LR_VK(vk, vkResetFences, device->handle, 1, &device->fence);
fail:
    return status;
}
