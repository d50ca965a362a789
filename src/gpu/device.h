/* A Vulkan device opened for compute: one queue, one command buffer, one fence. Everything in
 * src/gpu works on it from one thread at a time, and knows nothing of scenes. */
#ifndef LR_GPU_DEVICE_H
#define LR_GPU_DEVICE_H

#include "gpu/spirv.h"
#include "gpu/vulkan.h"

struct lr_device {
    lr_vk vk;
    VkInstance instance;
    VkDebugUtilsMessengerEXT messenger;
    VkPhysicalDevice physical;
    VkPhysicalDeviceLimits limits;
    VkPhysicalDeviceMemoryProperties memory;
    VkDevice handle;
    uint32_t queue_family;
    VkQueue queue;
    VkCommandPool command_pool;
    VkCommandBuffer commands;
    VkFence fence;
    lr_spirv_modes modes; /* float-control modes that the device offers */
    lr_device_info info;
    uint32_t shuffle_size; /* invocations of a compute subgroup if they can shuffle, else 1 */
    bool exact;            /* passed the arithmetic self-test */
    double open_seconds;
    uint32_t message_count; /* validation messages */
    char first_message[1024];
};

/* Seconds on a clock that only goes forward. */
double lr_now(void);

/* Seconds that all threads of the process have computed, those of a software driver with them. */
double lr_cpu_now(void);

#endif
