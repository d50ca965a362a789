#include "gpu/device.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <time.h>

#include "base/memory.h"
#include "gpu/self_test.h"

#define DEVICES_MAX 64
#define EXTENSIONS_MAX 512
#define INSTANCE_EXTENSIONS_MAX 16

/* What each stage needs beyond what Vulkan guarantees; render/wavefront_setup.c binds as many. */
#define STORAGE_BUFFERS_NEEDED 10
#define GROUP_SIZE_NEEDED 64

double lr_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double lr_cpu_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                 VkDebugUtilsMessageTypeFlagsEXT type,
                                                 const VkDebugUtilsMessengerCallbackDataEXT *data,
                                                 void *user)
{
    (void)severity, (void)type;
    lr_device *device = user;
    if (device->message_count++ == 0)
        snprintf(device->first_message, sizeof device->first_message, "%s", data->pMessage);
    return VK_FALSE;
}

static bool has_layer(const lr_vk *vk, const char *name)
{
    VkLayerProperties layers[128];
    uint32_t count = 128;
    if (vk->vkEnumerateInstanceLayerProperties(&count, layers) < 0)
        return false;
    for (uint32_t i = 0; i < count; i++)
        if (!strcmp(layers[i].layerName, name))
            return true;
    return false;
}

static lr_status create_instance(lr_device *device, bool validation, lr_error *error)
{
    lr_status status = lr_vk_load(&device->vk, error);
    if (status)
        return status;
    const char *layer = "VK_LAYER_KHRONOS_validation";
    if (validation && !has_layer(&device->vk, layer))
        return lr_fail(error, LR_ERROR_DEVICE,
                       "validation was asked for, but the layer %s is not installed; it comes with "
                       "the package vulkan-validationlayers",
                       layer);
    VkDebugUtilsMessengerCreateInfoEXT messenger = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        .pfnUserCallback = on_message,
        .pUserData = device,
    };
    VkValidationFeatureEnableEXT enable =
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkValidationFeaturesEXT features = {
        .sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
        .pNext = &messenger,
        .enabledValidationFeatureCount = 1,
        .pEnabledValidationFeatures = &enable,
    };
    const char *extensions[INSTANCE_EXTENSIONS_MAX + 1];
    uint32_t extension_count = 0;
    const lr_window_system *window = device->window;
    for (uint32_t i = 0; window && i < window->extension_count; i++)
        if (extension_count < INSTANCE_EXTENSIONS_MAX)
            extensions[extension_count++] = window->extensions[i];
    if (validation)
        extensions[extension_count++] = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    VkApplicationInfo application = {
        .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
        .pApplicationName = "lavaray",
        .apiVersion = VK_API_VERSION_1_2,
    };
    VkInstanceCreateInfo desc = {
        .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
        .pNext = validation ? &features : NULL,
        .pApplicationInfo = &application,
        .enabledLayerCount = validation,
        .ppEnabledLayerNames = &layer,
        .enabledExtensionCount = extension_count,
        .ppEnabledExtensionNames = extensions,
    };
    LR_VK(&device->vk, vkCreateInstance, &desc, NULL, &device->instance);
    status = lr_vk_load_instance(&device->vk, device->instance, error);
    if (!status && validation)
        LR_VK(&device->vk, vkCreateDebugUtilsMessengerEXT, device->instance, &messenger, NULL,
              &device->messenger);
fail:
    return status;
}

static lr_status enumerate(lr_device *device, VkPhysicalDevice physical[DEVICES_MAX],
                           uint32_t *count, lr_error *error)
{
    *count = DEVICES_MAX;
    VkResult result = device->vk.vkEnumeratePhysicalDevices(device->instance, count, physical);
    if (result != VK_SUCCESS && result != VK_INCOMPLETE)
        return lr_vk_fail(error, "vkEnumeratePhysicalDevices", result);
    if (*count == 0)
        return lr_fail(error, LR_ERROR_DEVICE,
                       "the Vulkan drivers offer no device; the package mesa-vulkan-drivers brings "
                       "one that needs no GPU");
    return LR_OK;
}

static bool has_extension(const lr_vk *vk, VkPhysicalDevice physical, const char *name)
{
    VkExtensionProperties extensions[EXTENSIONS_MAX];
    uint32_t count = EXTENSIONS_MAX;
    if (vk->vkEnumerateDeviceExtensionProperties(physical, NULL, &count, extensions) < 0)
        return false;
    for (uint32_t i = 0; i < count; i++)
        if (!strcmp(extensions[i].extensionName, name))
            return true;
    return false;
}

/* The first family that computes and, where there is a window, can show pictures in it. */
static uint32_t find_queue_family(const lr_device *device, VkPhysicalDevice physical)
{
    const lr_vk *vk = &device->vk;
    const lr_window_system *window = device->window;
    VkQueueFamilyProperties families[32];
    uint32_t count = 32;
    vk->vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families);
    for (uint32_t i = 0; i < count; i++)
        if ((families[i].queueFlags & VK_QUEUE_COMPUTE_BIT) &&
            (!window || window->can_present(device->instance, physical, i)))
            return i;
    return UINT32_MAX;
}

/* Fills in all that is known of a physical device before it is opened. */
static void describe(const lr_device *device, VkPhysicalDevice physical, lr_device_info *info,
                     VkPhysicalDeviceLimits *limits, lr_spirv_modes *modes)
{
    const lr_vk *vk = &device->vk;
    VkPhysicalDeviceFloatControlsProperties floats = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FLOAT_CONTROLS_PROPERTIES};
    VkPhysicalDeviceDriverProperties driver = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES, .pNext = &floats};
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &driver};
    vk->vkGetPhysicalDeviceProperties2(physical, &properties);
    const VkPhysicalDeviceProperties *p = &properties.properties;
    *info = (lr_device_info){
        .api_version = p->apiVersion,
        .software = p->deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU,
    };
    snprintf(info->name, sizeof info->name, "%s", p->deviceName);
    if (driver.driverName[0])
        snprintf(info->driver, sizeof info->driver, "%.120s %.120s", driver.driverName,
                 driver.driverInfo);
    else
        snprintf(info->driver, sizeof info->driver, "driver %u", p->driverVersion);
    if (p->apiVersion < VK_API_VERSION_1_1)
        snprintf(info->missing, sizeof info->missing, "Vulkan 1.1");
    else if (find_queue_family(device, physical) == UINT32_MAX)
        snprintf(info->missing, sizeof info->missing, "a compute queue%s",
                 device->window ? " that shows pictures in windows" : "");
    else if (p->limits.maxPerStageDescriptorStorageBuffers < STORAGE_BUFFERS_NEEDED)
        snprintf(info->missing, sizeof info->missing, "%d storage buffers a stage (it has %u)",
                 STORAGE_BUFFERS_NEEDED, p->limits.maxPerStageDescriptorStorageBuffers);
    else if (p->limits.maxComputeWorkGroupInvocations < GROUP_SIZE_NEEDED)
        snprintf(info->missing, sizeof info->missing, "workgroups of %d invocations",
                 GROUP_SIZE_NEEDED);
    info->usable = !info->missing[0];

    *limits = p->limits;
    bool controls = p->apiVersion >= VK_API_VERSION_1_2 ||
                    has_extension(vk, physical, VK_KHR_SHADER_FLOAT_CONTROLS_EXTENSION_NAME);
    *modes = (lr_spirv_modes){
        .rounding_rte = controls && floats.shaderRoundingModeRTEFloat32,
        .signed_zero_inf_nan = controls && floats.shaderSignedZeroInfNanPreserveFloat32,
        .denorm_preserve = controls && floats.shaderDenormPreserveFloat32,
        .denorm_flush_to_zero = controls && floats.shaderDenormFlushToZeroFloat32 &&
                                !floats.shaderDenormPreserveFloat32,
    };
}

lr_status lr_device_list(lr_device_info **devices, uint32_t *count, lr_error *error)
{
    *devices = NULL;
    *count = 0;
    lr_device *probe = lr_alloc(1, sizeof *probe);
    if (!probe)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory");
    VkPhysicalDevice physical[DEVICES_MAX];
    uint32_t found = 0;
    lr_status status = create_instance(probe, false, error);
    if (!status)
        status = enumerate(probe, physical, &found, error);
    if (!status) {
        *devices = lr_alloc(found, sizeof **devices);
        if (!*devices)
            status = lr_fail(error, LR_ERROR_MEMORY, "out of memory");
    }
    for (uint32_t i = 0; !status && i < found; i++)
        describe(probe, physical[i], &(*devices)[i], &probe->limits, &probe->modes);
    if (!status)
        *count = found;
    lr_device_close(probe);
    return status;
}

/* Whether the device suits what --device asked for. */
static bool matches(const char *select, const lr_device_info *info, uint32_t index)
{
    if (!strcmp(select, "auto"))
        return true;
    if (!strcmp(select, "cpu"))
        return info->software;
    if (!strcmp(select, "gpu"))
        return !info->software;
    char *end;
    unsigned long number = strtoul(select, &end, 10);
    if (*select && !*end)
        return number == index;
    size_t length = strlen(select);
    for (const char *at = info->name; *at; at++)
        if (!strncasecmp(at, select, length))
            return true;
    return false;
}

/* A discrete GPU is preferred to another GPU, and any GPU to a CPU; then the driver's order. */
static int preference(const lr_vk *vk, VkPhysicalDevice physical)
{
    VkPhysicalDeviceProperties2 properties = {.sType =
                                                  VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    vk->vkGetPhysicalDeviceProperties2(physical, &properties);
    switch (properties.properties.deviceType) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return 3;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return 1;
    default:
        return 2;
    }
}

static lr_status choose(lr_device *device, const char *select, lr_error *error)
{
    VkPhysicalDevice physical[DEVICES_MAX];
    uint32_t count;
    lr_status status = enumerate(device, physical, &count, error);
    if (status)
        return status;
    int best = 0;
    char unusable[512] = "";
    for (uint32_t i = 0; i < count; i++) {
        lr_device_info info;
        VkPhysicalDeviceLimits limits;
        lr_spirv_modes modes;
        describe(device, physical[i], &info, &limits, &modes);
        if (!matches(select, &info, i))
            continue;
        if (!info.usable) {
            snprintf(unusable, sizeof unusable, "; %.200s lacks %.200s", info.name, info.missing);
            continue;
        }
        int rank = preference(&device->vk, physical[i]);
        if (rank > best) {
            best = rank;
            device->physical = physical[i];
            device->info = info;
            device->limits = limits;
            device->modes = modes;
        }
    }
    if (!best)
        return lr_fail(error, LR_ERROR_DEVICE,
                       "no usable Vulkan device matches '%s' among %u%s; `lavaray devices` lists "
                       "them",
                       select, count, unusable);
    return LR_OK;
}

static uint32_t get_shuffle_size(const lr_vk *vk, VkPhysicalDevice physical)
{
    VkPhysicalDeviceSubgroupProperties subgroup = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &subgroup};
    vk->vkGetPhysicalDeviceProperties2(physical, &properties);
    bool shuffles = (subgroup.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) &&
                    (subgroup.supportedOperations & VK_SUBGROUP_FEATURE_SHUFFLE_BIT);
    return shuffles ? subgroup.subgroupSize : 1;
}

static lr_status create_device(lr_device *device, lr_error *error)
{
    lr_status status = LR_OK;
    lr_vk *vk = &device->vk;
    device->queue_family = find_queue_family(device, device->physical);
    device->shuffle_size = get_shuffle_size(vk, device->physical);
    vk->vkGetPhysicalDeviceMemoryProperties(device->physical, &device->memory);
    float priority = 1;
    VkDeviceQueueCreateInfo queue = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
        .queueFamilyIndex = device->queue_family,
        .queueCount = 1,
        .pQueuePriorities = &priority,
    };
    VkPhysicalDeviceFeatures features = {.robustBufferAccess = VK_TRUE};
    const char *extensions[2];
    uint32_t extension_count = 0;
    if (device->info.api_version < VK_API_VERSION_1_2 &&
        has_extension(vk, device->physical, VK_KHR_SHADER_FLOAT_CONTROLS_EXTENSION_NAME))
        extensions[extension_count++] = VK_KHR_SHADER_FLOAT_CONTROLS_EXTENSION_NAME;
    if (device->window)
        extensions[extension_count++] = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    VkDeviceCreateInfo desc = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
        .queueCreateInfoCount = 1,
        .pQueueCreateInfos = &queue,
        .enabledExtensionCount = extension_count,
        .ppEnabledExtensionNames = extensions,
        .pEnabledFeatures = &features,
    };
    LR_VK(vk, vkCreateDevice, device->physical, &desc, NULL, &device->handle);
    status = lr_vk_load_device(vk, device->handle, error);
    if (!status && device->window)
        status = lr_vk_load_window(vk, device->instance, device->handle, error);
    if (status)
        goto fail;
    vk->vkGetDeviceQueue(device->handle, device->queue_family, 0, &device->queue);
    VkCommandPoolCreateInfo pool = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
        .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
        .queueFamilyIndex = device->queue_family,
    };
    LR_VK(vk, vkCreateCommandPool, device->handle, &pool, NULL, &device->command_pool);
    VkCommandBufferAllocateInfo allocate = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = device->command_pool,
        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
        .commandBufferCount = 1,
    };
    LR_VK(vk, vkAllocateCommandBuffers, device->handle, &allocate, &device->commands);
    VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    LR_VK(vk, vkCreateFence, device->handle, &fence, NULL, &device->fence);
fail:
    return status;
}

lr_status lr_device_open(const lr_device_desc *desc, lr_device **out, lr_error *error)
{
    return lr_device_open_window(desc, NULL, out, error);
}

lr_status lr_device_open_window(const lr_device_desc *desc, const lr_window_system *window,
                                lr_device **out, lr_error *error)
{
    *out = NULL;
    double start = lr_now();
    lr_device *device = lr_alloc(1, sizeof *device);
    if (!device)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory");
    device->window = window;
    lr_status status = create_instance(device, desc->validation, error);
    if (!status)
        status = choose(device, desc->select ? desc->select : "auto", error);
    if (!status)
        status = create_device(device, error);
    if (!status)
        status = lr_self_test(device, &device->exact, error);
    if (status) {
        lr_device_close(device);
        return status;
    }
    device->open_seconds = lr_now() - start;
    *out = device;
    return LR_OK;
}

void lr_device_end(lr_device *device)
{
    lr_vk *vk = &device->vk;
    if (!device->handle || !vk->vkDestroyDevice)
        return;
    vk->vkDeviceWaitIdle(device->handle);
    lr_device_drop_programs(device);
    vk->vkDestroyFence(device->handle, device->fence, NULL);
    vk->vkDestroyCommandPool(device->handle, device->command_pool, NULL);
    vk->vkDestroyDevice(device->handle, NULL);
    device->handle = VK_NULL_HANDLE;
}

void lr_device_close(lr_device *device)
{
    if (!device)
        return;
    lr_vk *vk = &device->vk;
    lr_device_end(device);
    if (device->messenger)
        vk->vkDestroyDebugUtilsMessengerEXT(device->instance, device->messenger, NULL);
    if (device->instance && vk->vkDestroyInstance)
        vk->vkDestroyInstance(device->instance, NULL);
    free(device);
}

const lr_device_info *lr_device_get_info(const lr_device *device)
{
    return &device->info;
}

bool lr_device_is_exact(const lr_device *device)
{
    return device->exact;
}

uint32_t lr_device_validation_messages(const lr_device *device, char *text, size_t size)
{
    if (text && size)
        snprintf(text, size, "%s", device->first_message);
    return device->message_count;
}
