#include "gpu/program.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* Programs without a user that are kept: those of some pictures with all their layers. */
#define IDLE_MAX 48

lr_status lr_layout_create(lr_device *device, const lr_layout_desc *desc, lr_layout *layout,
                           lr_error *error)
{
    lr_status status = LR_OK;
    lr_vk *vk = &device->vk;
    *layout = (lr_layout){.binding_count = desc->binding_count, .push_size = desc->push_size};
    VkDescriptorSetLayoutBinding bindings[LR_BINDINGS_MAX];
    VkDescriptorPoolSize sizes[LR_BINDINGS_MAX];
    for (uint32_t i = 0; i < desc->binding_count; i++) {
        layout->types[i] = desc->types[i];
        bindings[i] = (VkDescriptorSetLayoutBinding){
            .binding = i,
            .descriptorType = desc->types[i],
            .descriptorCount = 1,
            .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT,
        };
        sizes[i] = (VkDescriptorPoolSize){desc->types[i], desc->set_count};
    }
    VkDescriptorSetLayoutCreateInfo set = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = desc->binding_count,
        .pBindings = bindings,
    };
    LR_VK(vk, vkCreateDescriptorSetLayout, device->handle, &set, NULL, &layout->set);
    VkPushConstantRange push = {VK_SHADER_STAGE_COMPUTE_BIT, 0, desc->push_size};
    VkPipelineLayoutCreateInfo pipeline = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .setLayoutCount = 1,
        .pSetLayouts = &layout->set,
        .pushConstantRangeCount = desc->push_size > 0,
        .pPushConstantRanges = &push,
    };
    LR_VK(vk, vkCreatePipelineLayout, device->handle, &pipeline, NULL, &layout->pipeline);
    VkDescriptorPoolCreateInfo pool = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
        .maxSets = desc->set_count,
        .poolSizeCount = desc->binding_count,
        .pPoolSizes = sizes,
    };
    LR_VK(vk, vkCreateDescriptorPool, device->handle, &pool, NULL, &layout->pool);
    return LR_OK;
fail:
    lr_layout_destroy(device, layout);
    return status;
}

void lr_layout_destroy(lr_device *device, lr_layout *layout)
{
    lr_vk *vk = &device->vk;
    if (layout->pool)
        vk->vkDestroyDescriptorPool(device->handle, layout->pool, NULL);
    if (layout->pipeline)
        vk->vkDestroyPipelineLayout(device->handle, layout->pipeline, NULL);
    if (layout->set)
        vk->vkDestroyDescriptorSetLayout(device->handle, layout->set, NULL);
    *layout = (lr_layout){0};
}

lr_status lr_set_create(lr_device *device, const lr_layout *layout, const lr_buffer *const *buffers,
                        VkDescriptorSet *set, lr_error *error)
{
    lr_status status = LR_OK;
    lr_vk *vk = &device->vk;
    VkDescriptorSetAllocateInfo allocate = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
        .descriptorPool = layout->pool,
        .descriptorSetCount = 1,
        .pSetLayouts = &layout->set,
    };
    LR_VK(vk, vkAllocateDescriptorSets, device->handle, &allocate, set);
    lr_set_write(device, layout, buffers, *set);
fail:
    return status;
}

void lr_set_write(lr_device *device, const lr_layout *layout, const lr_buffer *const *buffers,
                  VkDescriptorSet set)
{
    VkDescriptorBufferInfo infos[LR_BINDINGS_MAX];
    VkWriteDescriptorSet writes[LR_BINDINGS_MAX];
    for (uint32_t i = 0; i < layout->binding_count; i++) {
        infos[i] = (VkDescriptorBufferInfo){buffers[i]->handle, 0, VK_WHOLE_SIZE};
        writes[i] = (VkWriteDescriptorSet){
            .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
            .dstSet = set,
            .dstBinding = i,
            .descriptorCount = 1,
            .descriptorType = layout->types[i],
            .pBufferInfo = &infos[i],
            .pTexelBufferView = &buffers[i]->view,
        };
    }
    device->vk.vkUpdateDescriptorSets(device->handle, layout->binding_count, writes, 0, NULL);
}

lr_status lr_program_create(lr_device *device, const lr_layout *layout, const lr_program_desc *desc,
                            VkPipeline *program, lr_error *error)
{
    lr_vk *vk = &device->vk;
    VkShaderModule module = VK_NULL_HANDLE;
    lr_spirv special = {0}, code = {0};
    lr_status status = lr_spirv_specialize(desc->words, desc->word_count, desc->constants,
                                           desc->constant_count, &special, error);
    if (!status)
        status = lr_spirv_add_modes(special.words, special.count, &device->modes, &code, error);
    lr_spirv_free(&special);
    if (status)
        return status;
    VkShaderModuleCreateInfo module_desc = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
        .codeSize = 4 * code.count,
        .pCode = code.words,
    };
    LR_VK(vk, vkCreateShaderModule, device->handle, &module_desc, NULL, &module);
    VkComputePipelineCreateInfo pipeline = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = module,
                  .pName = "main"},
        .layout = layout->pipeline,
    };
    LR_VK(vk, vkCreateComputePipelines, device->handle, VK_NULL_HANDLE, 1, &pipeline, NULL,
          program);
fail:
    if (module)
        vk->vkDestroyShaderModule(device->handle, module, NULL);
    lr_spirv_free(&code);
    return status;
}

/* ---- Kept programs ------------------------------------------------------------------------ */

typedef struct lr_kept_program {
    const uint32_t *words;
    uint32_t constants[LR_PROGRAM_CONSTANTS_MAX];
    uint32_t constant_count;
    VkPipeline program;
    uint32_t users;
    uint64_t taken; /* device->programs_taken when it was last */
} lr_kept_program;

static lr_kept_program *find_program(const lr_device *device, const lr_program_desc *desc)
{
    size_t size = desc->constant_count * sizeof *desc->constants;
    for (uint32_t i = 0; i < device->program_count; i++) {
        lr_kept_program *kept = &device->programs[i];
        if (kept->words == desc->words && kept->constant_count == desc->constant_count &&
            memcmp(kept->constants, desc->constants, size) == 0)
            return kept;
    }
    return NULL;
}

static lr_status add_program(lr_device *device, const lr_layout *layout,
                             const lr_program_desc *desc, lr_kept_program **added, lr_error *error)
{
    assert(desc->constant_count <= LR_PROGRAM_CONSTANTS_MAX);
    if (!lr_array_reserve((void **)&device->programs, device->program_count,
                          &device->program_capacity, sizeof *device->programs))
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for programs");
    lr_kept_program *kept = &device->programs[device->program_count];
    *kept = (lr_kept_program){.words = desc->words, .constant_count = desc->constant_count};
    memcpy(kept->constants, desc->constants, desc->constant_count * sizeof *desc->constants);
    lr_status status = lr_program_create(device, layout, desc, &kept->program, error);
    if (status)
        return status;
    device->program_count++;
    *added = kept;
    return LR_OK;
}

lr_status lr_program_take(lr_device *device, const lr_layout *layout, const lr_program_desc *desc,
                          VkPipeline *program, lr_error *error)
{
    lr_kept_program *kept = find_program(device, desc);
    lr_status status = kept ? LR_OK : add_program(device, layout, desc, &kept, error);
    if (status)
        return status;
    kept->users++;
    kept->taken = ++device->programs_taken;
    *program = kept->program;
    return LR_OK;
}

/* Destroys the program without users that was not taken for the longest time, if they are many. */
static void drop_oldest(lr_device *device)
{
    uint32_t idle = 0;
    lr_kept_program *oldest = NULL;
    for (uint32_t i = 0; i < device->program_count; i++) {
        lr_kept_program *kept = &device->programs[i];
        if (kept->users)
            continue;
        idle++;
        if (!oldest || kept->taken < oldest->taken)
            oldest = kept;
    }
    if (idle <= IDLE_MAX)
        return;
    device->vk.vkDestroyPipeline(device->handle, oldest->program, NULL);
    *oldest = device->programs[--device->program_count];
}

void lr_program_give_back(lr_device *device, VkPipeline program)
{
    for (uint32_t i = 0; i < device->program_count; i++)
        if (device->programs[i].program == program)
            device->programs[i].users--;
    drop_oldest(device);
}

void lr_device_drop_programs(lr_device *device)
{
    for (uint32_t i = 0; i < device->program_count; i++)
        device->vk.vkDestroyPipeline(device->handle, device->programs[i].program, NULL);
    free(device->programs);
    device->programs = NULL;
    device->program_count = device->program_capacity = 0;
}
