/* Buffers with memory of their own: on the device, or on the host and mapped for good. */
#ifndef LR_GPU_BUFFER_H
#define LR_GPU_BUFFER_H

#include "gpu/device.h"

typedef struct lr_buffer {
    VkBuffer handle;
    VkDeviceMemory memory;
    VkBufferView view; /* RGBA32UI, only of texel buffers */
    VkDeviceSize size;
    void *mapped; /* only of host buffers */
    bool direct;  /* the host can write its memory, as where host and device have the same */
} lr_buffer;

typedef enum lr_buffer_kind {
    LR_BUFFER_STORAGE, /* device memory: storage, indirect, transfers both ways */
    LR_BUFFER_UNIFORM, /* device memory: uniform block */
    LR_BUFFER_TEXEL,   /* device memory: uniform texel buffer if it has no more elements than
                          that may have, storage if it is no larger than that may be */
    LR_BUFFER_HOST,    /* mapped, coherent memory for transfers */
} lr_buffer_kind;

/* Creates a buffer, its contents undefined. Refuses sizes
 * over the device's limits, naming the limit and `what` the buffer is for. */
lr_status lr_buffer_create(lr_device *device, lr_buffer_kind kind, VkDeviceSize size,
                           const char *what, lr_buffer *buffer, lr_error *error);
void lr_buffer_destroy(lr_device *device, lr_buffer *buffer);

/* Copies size bytes into the start of a device buffer that no work on the device uses, and waits
 * for it. */
lr_status lr_buffer_upload(lr_device *device, lr_buffer *buffer, const void *bytes, size_t size,
                           lr_error *error);

#endif
