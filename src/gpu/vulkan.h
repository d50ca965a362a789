/* The Vulkan functions that lavaray uses, loaded at run time: a machine without a Vulkan loader can
 * then still be told what it lacks. */
#ifndef LR_GPU_VULKAN_H
#define LR_GPU_VULKAN_H

#define VK_NO_PROTOTYPES
#include <vulkan/vulkan.h>

#include "base/status.h"

/* Functions found without an instance. */
#define LR_VK_GLOBAL(X)                                                                            \
    X(vkCreateInstance)                                                                            \
    X(vkEnumerateInstanceVersion)                                                                  \
    X(vkEnumerateInstanceLayerProperties)                                                          \
    X(vkEnumerateInstanceExtensionProperties)

/* Functions found through the instance. */
#define LR_VK_INSTANCE(X)                                                                          \
    X(vkDestroyInstance)                                                                           \
    X(vkEnumeratePhysicalDevices)                                                                  \
    X(vkGetPhysicalDeviceProperties2)                                                              \
    X(vkGetPhysicalDeviceFeatures)                                                                 \
    X(vkGetPhysicalDeviceMemoryProperties)                                                         \
    X(vkGetPhysicalDeviceQueueFamilyProperties)                                                    \
    X(vkEnumerateDeviceExtensionProperties)                                                        \
    X(vkCreateDevice)                                                                              \
    X(vkGetDeviceProcAddr)

/* Functions found through the device. */
#define LR_VK_DEVICE(X)                                                                            \
    X(vkDestroyDevice)                                                                             \
    X(vkGetDeviceQueue)                                                                            \
    X(vkDeviceWaitIdle)                                                                            \
    X(vkCreateBuffer)                                                                              \
    X(vkDestroyBuffer)                                                                             \
    X(vkGetBufferMemoryRequirements)                                                               \
    X(vkAllocateMemory)                                                                            \
    X(vkFreeMemory)                                                                                \
    X(vkBindBufferMemory)                                                                          \
    X(vkMapMemory)                                                                                 \
    X(vkUnmapMemory)                                                                               \
    X(vkCreateBufferView)                                                                          \
    X(vkDestroyBufferView)                                                                         \
    X(vkCreateShaderModule)                                                                        \
    X(vkDestroyShaderModule)                                                                       \
    X(vkCreateDescriptorSetLayout)                                                                 \
    X(vkDestroyDescriptorSetLayout)                                                                \
    X(vkCreateDescriptorPool)                                                                      \
    X(vkDestroyDescriptorPool)                                                                     \
    X(vkAllocateDescriptorSets)                                                                    \
    X(vkUpdateDescriptorSets)                                                                      \
    X(vkCreatePipelineLayout)                                                                      \
    X(vkDestroyPipelineLayout)                                                                     \
    X(vkCreateComputePipelines)                                                                    \
    X(vkDestroyPipeline)                                                                           \
    X(vkCreateCommandPool)                                                                         \
    X(vkDestroyCommandPool)                                                                        \
    X(vkAllocateCommandBuffers)                                                                    \
    X(vkBeginCommandBuffer)                                                                        \
    X(vkEndCommandBuffer)                                                                          \
    X(vkCmdBindPipeline)                                                                           \
    X(vkCmdBindDescriptorSets)                                                                     \
    X(vkCmdPushConstants)                                                                          \
    X(vkCmdDispatch)                                                                               \
    X(vkCmdDispatchIndirect)                                                                       \
    X(vkCmdPipelineBarrier)                                                                        \
    X(vkCmdCopyBuffer)                                                                             \
    X(vkCmdCopyBufferToImage)                                                                      \
    X(vkCmdFillBuffer)                                                                             \
    X(vkCmdUpdateBuffer)                                                                           \
    X(vkCreateFence)                                                                               \
    X(vkDestroyFence)                                                                              \
    X(vkResetFences)                                                                               \
    X(vkWaitForFences)                                                                             \
    X(vkQueueSubmit)

/* Functions of devices that show pictures in windows. */
#define LR_VK_WINDOW_INSTANCE(X)                                                                   \
    X(vkDestroySurfaceKHR)                                                                         \
    X(vkGetPhysicalDeviceSurfaceSupportKHR)                                                        \
    X(vkGetPhysicalDeviceSurfaceCapabilitiesKHR)                                                   \
    X(vkGetPhysicalDeviceSurfaceFormatsKHR)                                                        \
    X(vkGetPhysicalDeviceSurfacePresentModesKHR)
#define LR_VK_WINDOW_DEVICE(X)                                                                     \
    X(vkCreateSwapchainKHR)                                                                        \
    X(vkDestroySwapchainKHR)                                                                       \
    X(vkGetSwapchainImagesKHR)                                                                     \
    X(vkAcquireNextImageKHR)                                                                       \
    X(vkQueuePresentKHR)

typedef struct lr_vk {
    PFN_vkGetInstanceProcAddr vkGetInstanceProcAddr;
#define X(name) PFN_##name name;
    LR_VK_GLOBAL(X)
    LR_VK_INSTANCE(X)
    LR_VK_DEVICE(X)
    LR_VK_WINDOW_INSTANCE(X)
    LR_VK_WINDOW_DEVICE(X)
#undef X
    /* Only with VK_EXT_debug_utils. */
    PFN_vkCreateDebugUtilsMessengerEXT vkCreateDebugUtilsMessengerEXT;
    PFN_vkDestroyDebugUtilsMessengerEXT vkDestroyDebugUtilsMessengerEXT;
} lr_vk;

/* Opens the Vulkan loader, once per process, and finds the global functions. */
lr_status lr_vk_load(lr_vk *vk, lr_error *error);
lr_status lr_vk_load_instance(lr_vk *vk, VkInstance instance, lr_error *error);
lr_status lr_vk_load_device(lr_vk *vk, VkDevice device, lr_error *error);
/* The functions of windows, where instance and device have the extensions for them. */
lr_status lr_vk_load_window(lr_vk *vk, VkInstance instance, VkDevice device, lr_error *error);

/* Records that the Vulkan function `call` returned `result`. */
lr_status lr_vk_fail(lr_error *error, const char *call, VkResult result);

/* Calls a Vulkan function through `vk`; on failure records it and jumps to the label fail. Expects
 * an lr_error *error and an lr_status status in scope. */
#define LR_VK(vk, function, ...)                                                                   \
    do {                                                                                           \
        VkResult lr_vk_result = (vk)->function(__VA_ARGS__);                                       \
        if (lr_vk_result != VK_SUCCESS) {                                                          \
            status = lr_vk_fail(error, #function, lr_vk_result);                                   \
            goto fail;                                                                             \
        }                                                                                          \
    } while (0)

#endif
