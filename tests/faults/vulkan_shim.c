/* A Vulkan loader that passes everything on to the real one, except that chosen calls fail. Of any
 * number of threads; of one driver.
 *
 * LAVARAY_REAL_VULKAN  path of the real loader
 * LAVARAY_FAULT        "vkAllocateMemory:3:-2": the third call returns VkResult -2, without being
 *                      passed on; "vkQueueSubmit:2+:-4": so do all from the second on;
 *                      "vkQueuePresentKHR:3/:-4": each third. VK_SUBOPTIMAL_KHR is what a call
 *                      returns that is passed on and succeeds
 * LAVARAY_FAULT_LOG    a file that gets "NAME COUNT" for each wrapped function that was called, and
 *                      "NAME unwrapped" for each function that was asked for but is not wrapped
 *
 * Loaded under the name libvulkan.so.1, so it must not have symbols of that library beyond
 * vkGetInstanceProcAddr. */
#include <dlfcn.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define VK_NO_PROTOTYPES
#include <vulkan/vulkan.h>

/* vulkan_xcb.h without the headers of XCB. */
typedef VkResult(VKAPI_PTR *PFN_vkCreateXcbSurfaceKHR)(VkInstance, const void *,
                                                       const VkAllocationCallbacks *,
                                                       VkSurfaceKHR *);

/* Name, parameters, arguments: all functions that return a VkResult and that a compute program may
 * call, or one that shows pictures in a window. */
#define WRAPPED(X)                                                                                 \
    X(vkCreateInstance,                                                                            \
      (const VkInstanceCreateInfo *a, const VkAllocationCallbacks *b, VkInstance *c), (a, b, c))   \
    X(vkEnumerateInstanceVersion, (uint32_t * a), (a))                                             \
    X(vkEnumerateInstanceLayerProperties, (uint32_t * a, VkLayerProperties * b), (a, b))           \
    X(vkEnumerateInstanceExtensionProperties,                                                      \
      (const char *a, uint32_t *b, VkExtensionProperties *c), (a, b, c))                           \
    X(vkEnumeratePhysicalDevices, (VkInstance a, uint32_t * b, VkPhysicalDevice * c), (a, b, c))   \
    X(vkEnumerateDeviceExtensionProperties,                                                        \
      (VkPhysicalDevice a, const char *b, uint32_t *c, VkExtensionProperties *d), (a, b, c, d))    \
    X(vkCreateDevice,                                                                              \
      (VkPhysicalDevice a, const VkDeviceCreateInfo *b, const VkAllocationCallbacks *c,            \
       VkDevice *d),                                                                               \
      (a, b, c, d))                                                                                \
    X(vkCreateDebugUtilsMessengerEXT,                                                              \
      (VkInstance a, const VkDebugUtilsMessengerCreateInfoEXT *b, const VkAllocationCallbacks *c,  \
       VkDebugUtilsMessengerEXT *d),                                                               \
      (a, b, c, d))                                                                                \
    X(vkDeviceWaitIdle, (VkDevice a), (a))                                                         \
    X(vkQueueWaitIdle, (VkQueue a), (a))                                                           \
    X(vkCreateBuffer,                                                                              \
      (VkDevice a, const VkBufferCreateInfo *b, const VkAllocationCallbacks *c, VkBuffer *d),      \
      (a, b, c, d))                                                                                \
    X(vkAllocateMemory,                                                                            \
      (VkDevice a, const VkMemoryAllocateInfo *b, const VkAllocationCallbacks *c,                  \
       VkDeviceMemory *d),                                                                         \
      (a, b, c, d))                                                                                \
    X(vkBindBufferMemory, (VkDevice a, VkBuffer b, VkDeviceMemory c, VkDeviceSize d),              \
      (a, b, c, d))                                                                                \
    X(vkMapMemory,                                                                                 \
      (VkDevice a, VkDeviceMemory b, VkDeviceSize c, VkDeviceSize d, VkMemoryMapFlags e,           \
       void **f),                                                                                  \
      (a, b, c, d, e, f))                                                                          \
    X(vkFlushMappedMemoryRanges, (VkDevice a, uint32_t b, const VkMappedMemoryRange *c),           \
      (a, b, c))                                                                                   \
    X(vkInvalidateMappedMemoryRanges, (VkDevice a, uint32_t b, const VkMappedMemoryRange *c),      \
      (a, b, c))                                                                                   \
    X(vkCreateBufferView,                                                                          \
      (VkDevice a, const VkBufferViewCreateInfo *b, const VkAllocationCallbacks *c,                \
       VkBufferView *d),                                                                           \
      (a, b, c, d))                                                                                \
    X(vkCreateShaderModule,                                                                        \
      (VkDevice a, const VkShaderModuleCreateInfo *b, const VkAllocationCallbacks *c,              \
       VkShaderModule *d),                                                                         \
      (a, b, c, d))                                                                                \
    X(vkCreateDescriptorSetLayout,                                                                 \
      (VkDevice a, const VkDescriptorSetLayoutCreateInfo *b, const VkAllocationCallbacks *c,       \
       VkDescriptorSetLayout *d),                                                                  \
      (a, b, c, d))                                                                                \
    X(vkCreateDescriptorPool,                                                                      \
      (VkDevice a, const VkDescriptorPoolCreateInfo *b, const VkAllocationCallbacks *c,            \
       VkDescriptorPool *d),                                                                       \
      (a, b, c, d))                                                                                \
    X(vkResetDescriptorPool, (VkDevice a, VkDescriptorPool b, VkDescriptorPoolResetFlags c),       \
      (a, b, c))                                                                                   \
    X(vkAllocateDescriptorSets,                                                                    \
      (VkDevice a, const VkDescriptorSetAllocateInfo *b, VkDescriptorSet *c), (a, b, c))           \
    X(vkCreatePipelineLayout,                                                                      \
      (VkDevice a, const VkPipelineLayoutCreateInfo *b, const VkAllocationCallbacks *c,            \
       VkPipelineLayout *d),                                                                       \
      (a, b, c, d))                                                                                \
    X(vkCreatePipelineCache,                                                                       \
      (VkDevice a, const VkPipelineCacheCreateInfo *b, const VkAllocationCallbacks *c,             \
       VkPipelineCache *d),                                                                        \
      (a, b, c, d))                                                                                \
    X(vkCreateComputePipelines,                                                                    \
      (VkDevice a, VkPipelineCache b, uint32_t c, const VkComputePipelineCreateInfo *d,            \
       const VkAllocationCallbacks *e, VkPipeline *f),                                             \
      (a, b, c, d, e, f))                                                                          \
    X(vkCreateCommandPool,                                                                         \
      (VkDevice a, const VkCommandPoolCreateInfo *b, const VkAllocationCallbacks *c,               \
       VkCommandPool *d),                                                                          \
      (a, b, c, d))                                                                                \
    X(vkResetCommandPool, (VkDevice a, VkCommandPool b, VkCommandPoolResetFlags c), (a, b, c))     \
    X(vkAllocateCommandBuffers,                                                                    \
      (VkDevice a, const VkCommandBufferAllocateInfo *b, VkCommandBuffer *c), (a, b, c))           \
    X(vkBeginCommandBuffer, (VkCommandBuffer a, const VkCommandBufferBeginInfo *b), (a, b))        \
    X(vkEndCommandBuffer, (VkCommandBuffer a), (a))                                                \
    X(vkResetCommandBuffer, (VkCommandBuffer a, VkCommandBufferResetFlags b), (a, b))              \
    X(vkCreateFence,                                                                               \
      (VkDevice a, const VkFenceCreateInfo *b, const VkAllocationCallbacks *c, VkFence *d),        \
      (a, b, c, d))                                                                                \
    X(vkResetFences, (VkDevice a, uint32_t b, const VkFence *c), (a, b, c))                        \
    X(vkGetFenceStatus, (VkDevice a, VkFence b), (a, b))                                           \
    X(vkWaitForFences, (VkDevice a, uint32_t b, const VkFence *c, VkBool32 d, uint64_t e),         \
      (a, b, c, d, e))                                                                             \
    X(vkQueueSubmit, (VkQueue a, uint32_t b, const VkSubmitInfo *c, VkFence d), (a, b, c, d))      \
    X(vkCreateXcbSurfaceKHR,                                                                       \
      (VkInstance a, const void *b, const VkAllocationCallbacks *c, VkSurfaceKHR *d),              \
      (a, b, c, d))                                                                                \
    X(vkGetPhysicalDeviceSurfaceSupportKHR,                                                        \
      (VkPhysicalDevice a, uint32_t b, VkSurfaceKHR c, VkBool32 * d), (a, b, c, d))                \
    X(vkGetPhysicalDeviceSurfaceCapabilitiesKHR,                                                   \
      (VkPhysicalDevice a, VkSurfaceKHR b, VkSurfaceCapabilitiesKHR * c), (a, b, c))               \
    X(vkGetPhysicalDeviceSurfaceFormatsKHR,                                                        \
      (VkPhysicalDevice a, VkSurfaceKHR b, uint32_t * c, VkSurfaceFormatKHR * d), (a, b, c, d))    \
    X(vkGetPhysicalDeviceSurfacePresentModesKHR,                                                   \
      (VkPhysicalDevice a, VkSurfaceKHR b, uint32_t * c, VkPresentModeKHR * d), (a, b, c, d))      \
    X(vkCreateSwapchainKHR,                                                                        \
      (VkDevice a, const VkSwapchainCreateInfoKHR *b, const VkAllocationCallbacks *c,              \
       VkSwapchainKHR *d),                                                                         \
      (a, b, c, d))                                                                                \
    X(vkGetSwapchainImagesKHR, (VkDevice a, VkSwapchainKHR b, uint32_t * c, VkImage * d),          \
      (a, b, c, d))                                                                                \
    X(vkAcquireNextImageKHR,                                                                       \
      (VkDevice a, VkSwapchainKHR b, uint64_t c, VkSemaphore d, VkFence e, uint32_t * f),          \
      (a, b, c, d, e, f))                                                                          \
    X(vkQueuePresentKHR, (VkQueue a, const VkPresentInfoKHR *b), (a, b))

#define X(name, parameters, arguments) INDEX_##name,
typedef enum wrapped_index { WRAPPED(X) WRAPPED_COUNT } wrapped_index;
#undef X

#define X(name, parameters, arguments) #name,
static const char *const names[WRAPPED_COUNT] = {WRAPPED(X)};
#undef X

static PFN_vkVoidFunction real_functions[WRAPPED_COUNT];
static atomic_uint calls[WRAPPED_COUNT];
static PFN_vkGetInstanceProcAddr real_instance;
static PFN_vkGetDeviceProcAddr real_device;
static FILE *log_file;

/* What this call is to return; VK_SUCCESS: whatever it does. */
static VkResult fault_of(wrapped_index index)
{
    unsigned call = atomic_fetch_add(&calls[index], 1) + 1;
    const char *fault = getenv("LAVARAY_FAULT");
    size_t length = strlen(names[index]);
    if (!fault || strncmp(fault, names[index], length) != 0 || fault[length] != ':') {
        return VK_SUCCESS;
    }
    char *end;
    unsigned long number = strtoul(fault + length + 1, &end, 10);
    char which = *end;
    bool fails = which == '+' ? call >= number : which == '/' ? call % number == 0 : call == number;
    return fails ? (VkResult)strtol(end + (which != ':') + 1, NULL, 10) : VK_SUCCESS;
}

#define X(name, parameters, arguments)                                                             \
    static VKAPI_ATTR VkResult VKAPI_CALL shim_##name parameters                                   \
    {                                                                                              \
        VkResult fault = fault_of(INDEX_##name);                                                   \
        if (fault != VK_SUCCESS && fault != VK_SUBOPTIMAL_KHR) {                                   \
            return fault;                                                                          \
        }                                                                                          \
        VkResult real = ((PFN_##name)real_functions[INDEX_##name])arguments;                       \
        return real == VK_SUCCESS ? fault : real;                                                  \
    }
WRAPPED(X)
#undef X

#define X(name, parameters, arguments) (PFN_vkVoidFunction) shim_##name,
static const PFN_vkVoidFunction shims[WRAPPED_COUNT] = {WRAPPED(X)};
#undef X

static PFN_vkVoidFunction wrap(const char *name, PFN_vkVoidFunction found)
{
    for (int i = 0; found && i < WRAPPED_COUNT; i++) {
        if (strcmp(name, names[i]) == 0) {
            real_functions[i] = found;
            return shims[i];
        }
    }
    if (found && log_file) {
        fprintf(log_file, "%s unwrapped\n", name);
    }
    return found;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL device_proc(VkDevice device, const char *name)
{
    return wrap(name, real_device(device, name));
}

static void write_log(void)
{
    for (int i = 0; i < WRAPPED_COUNT; i++) {
        if (calls[i]) {
            fprintf(log_file, "%s %u\n", names[i], calls[i]);
        }
    }
    fclose(log_file);
}

static void start(void)
{
    const char *path = getenv("LAVARAY_REAL_VULKAN"), *log_path = getenv("LAVARAY_FAULT_LOG");
    void *loader = path ? dlopen(path, RTLD_NOW | RTLD_LOCAL) : NULL;
    if (!loader) {
        fprintf(stderr, "vulkan_shim: LAVARAY_REAL_VULKAN: %s\n", path ? dlerror() : "not set");
        abort();
    }
    *(void **)&real_instance = dlsym(loader, "vkGetInstanceProcAddr");
    log_file = log_path ? fopen(log_path, "w") : NULL;
    if (log_file) {
        atexit(write_log);
    }
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vkGetInstanceProcAddr(VkInstance instance,
                                                               const char *name);

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vkGetInstanceProcAddr(VkInstance instance,
                                                               const char *name)
{
    if (!real_instance) {
        start();
    }
    PFN_vkVoidFunction found = real_instance(instance, name);
    if (strcmp(name, "vkGetDeviceProcAddr") == 0) {
        real_device = (PFN_vkGetDeviceProcAddr)found;
        return found ? (PFN_vkVoidFunction)device_proc : NULL;
    }
    return wrap(name, found);
}
