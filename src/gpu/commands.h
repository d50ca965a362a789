/* Recording and running work on the device's one command buffer. Between begin and finish, commands
 * run in order only where a barrier stands between them. */
#ifndef LR_GPU_COMMANDS_H
#define LR_GPU_COMMANDS_H

#include "gpu/program.h"

lr_status lr_commands_begin(lr_device *device, lr_error *error);

void lr_commands_dispatch(lr_device *device, const lr_layout *layout, VkPipeline program,
                          VkDescriptorSet set, const void *push, uint32_t x, uint32_t y,
                          uint32_t z);

/* Takes the workgroup counts from three words at `offset` bytes into `counts`. */
void lr_commands_dispatch_indirect(lr_device *device, const lr_layout *layout, VkPipeline program,
                                   VkDescriptorSet set, const void *push, const lr_buffer *counts,
                                   VkDeviceSize offset);

/* Everything before is complete and visible to everything after, the host included. */
void lr_commands_barrier(lr_device *device);

void lr_commands_copy(lr_device *device, const lr_buffer *from, const lr_buffer *to,
                      VkDeviceSize size);
/* The same to `offset` bytes behind the start of `to`. */
void lr_commands_copy_to(lr_device *device, const lr_buffer *from, const lr_buffer *to,
                         VkDeviceSize offset, VkDeviceSize size);
void lr_commands_zero(lr_device *device, const lr_buffer *buffer, VkDeviceSize size);

/* Writes at most 64 KiB at `offset`, taken when the command is recorded. */
void lr_commands_write(lr_device *device, const lr_buffer *buffer, VkDeviceSize offset,
                       const void *bytes, VkDeviceSize size);

/* Submits what was recorded and waits until it is done. */
lr_status lr_commands_finish(lr_device *device, lr_error *error);

#endif
