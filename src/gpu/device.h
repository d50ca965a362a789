/* A Vulkan device opened for compute: one queue, one command buffer, one fence. Everything in
 * src/gpu works on it from one thread at a time, and knows nothing of scenes. */
#ifndef LR_GPU_DEVICE_H
#define LR_GPU_DEVICE_H

#include "gpu/spirv.h"
#include "gpu/vulkan.h"

/* Where a device is to show pictures. The functions may be called from any thread. */
typedef struct lr_window_system {
    const char *const *extensions; /* of the instance */
    uint32_t extension_count;
    bool (*can_present)(VkInstance instance, VkPhysicalDevice physical, uint32_t queue_family);
    VkResult (*create_surface)(void *window, VkInstance instance, VkSurfaceKHR *surface);
    void *window;
} lr_window_system;

struct lr_kept_program; /* program.c */

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
    const lr_window_system *window; /* NULL: none */
    bool exact;                     /* passed the arithmetic self-test */
    double open_seconds;
    struct lr_kept_program *programs; /* kept for those who take the same again */
    uint32_t program_count, program_capacity;
    uint64_t programs_taken; /* so far */
    uint32_t message_count;  /* validation messages */
    char first_message[1024];
};

/* lr_device_open for a device that can show pictures there; `window` must outlive it. */
lr_status lr_device_open_window(const lr_device_desc *desc, const lr_window_system *window,
                                lr_device **device, lr_error *error);

/* The first half of lr_device_close, after which the device can only be asked for the validation
 * messages: those about what was not destroyed are then among them. */
void lr_device_end(lr_device *device);

/* program.c: destroys the programs that are kept. */
void lr_device_drop_programs(lr_device *device);

/* Seconds on a clock that only goes forward. */
double lr_now(void);

/* Seconds that all threads of the process have computed, those of a software driver with them. */
double lr_cpu_now(void);

#endif
