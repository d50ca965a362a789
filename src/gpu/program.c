#include "gpu/program.h"

#include <string.h>

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
