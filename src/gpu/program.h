/* Kernels: a layout of bindings that several programs share, the programs, and the sets of buffers
 * that they work on. */
#ifndef LR_GPU_PROGRAM_H
#define LR_GPU_PROGRAM_H

#include "gpu/buffer.h"

#define LR_BINDINGS_MAX 16

typedef struct lr_layout {
    VkDescriptorSetLayout set;
    VkPipelineLayout pipeline;
    VkDescriptorPool pool;
    VkDescriptorType types[LR_BINDINGS_MAX];
    uint32_t binding_count;
    uint32_t push_size;
} lr_layout;

typedef struct lr_layout_desc {
    const VkDescriptorType *types; /* binding i has types[i] */
    uint32_t binding_count;
    uint32_t push_size; /* bytes of push constants */
    uint32_t set_count; /* how many sets lr_set_create may make */
} lr_layout_desc;

lr_status lr_layout_create(lr_device *device, const lr_layout_desc *desc, lr_layout *layout,
                           lr_error *error);
void lr_layout_destroy(lr_device *device, lr_layout *layout);

/* A descriptor set with buffers[i] at binding i. It lives as long as the layout. */
lr_status lr_set_create(lr_device *device, const lr_layout *layout, const lr_buffer *const *buffers,
                        VkDescriptorSet *set, lr_error *error);
/* Puts other buffers into a set that no unfinished command uses. */
void lr_set_write(lr_device *device, const lr_layout *layout, const lr_buffer *const *buffers,
                  VkDescriptorSet set);

typedef struct lr_program_desc {
    const uint32_t
        *words; /* decorated SPIR-V; specialised here, and the device's float modes added */
    size_t word_count;
    const uint32_t *constants; /* specialisation constant i has the value constants[i] */
    uint32_t constant_count;
} lr_program_desc;

lr_status lr_program_create(lr_device *device, const lr_layout *layout, const lr_program_desc *desc,
                            VkPipeline *program, lr_error *error);

#define LR_PROGRAM_CONSTANTS_MAX 128

/* The same from those that the device keeps: compiled only if no program of these words and
 * constants was asked for before, or so many others since. Words stay as they are as long as the
 * device, and always come with a layout of the same bindings. The caller gives it back. */
lr_status lr_program_take(lr_device *device, const lr_layout *layout, const lr_program_desc *desc,
                          VkPipeline *program, lr_error *error);
void lr_program_give_back(lr_device *device, VkPipeline program);

#endif
