#include "gpu/vulkan.h"

#include <dlfcn.h>

lr_status lr_vk_load(lr_vk *vk, lr_error *error)
{
    /* Never closed: drivers keep threads and thread-local data that do not survive an unload. */
    void *library = dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL);
    if (!library)
        library = dlopen("libvulkan.so", RTLD_NOW | RTLD_LOCAL);
    if (!library)
        return lr_fail(error, LR_ERROR_DEVICE,
                       "no Vulkan loader: libvulkan.so.1 was not found; install the package "
                       "libvulkan1 (and mesa-vulkan-drivers for a driver that needs no GPU)");
    *(void **)&vk->vkGetInstanceProcAddr = dlsym(library, "vkGetInstanceProcAddr");
    if (!vk->vkGetInstanceProcAddr)
        return lr_fail(error, LR_ERROR_DEVICE,
                       "libvulkan.so.1 is no Vulkan loader: it lacks vkGetInstanceProcAddr");
#define X(name)                                                                                    \
    vk->name = (PFN_##name)vk->vkGetInstanceProcAddr(NULL, #name);                                 \
    if (!vk->name)                                                                                 \
        return lr_fail(error, LR_ERROR_DEVICE, "the Vulkan loader lacks %s (Vulkan 1.1)", #name);
    LR_VK_GLOBAL(X)
#undef X
    return LR_OK;
}

lr_status lr_vk_load_instance(lr_vk *vk, VkInstance instance, lr_error *error)
{
#define X(name)                                                                                    \
    vk->name = (PFN_##name)vk->vkGetInstanceProcAddr(instance, #name);                             \
    if (!vk->name)                                                                                 \
        return lr_fail(error, LR_ERROR_DEVICE, "the Vulkan driver lacks %s", #name);
    LR_VK_INSTANCE(X)
#undef X
    vk->vkCreateDebugUtilsMessengerEXT =
        (PFN_vkCreateDebugUtilsMessengerEXT)vk->vkGetInstanceProcAddr(
            instance, "vkCreateDebugUtilsMessengerEXT");
    vk->vkDestroyDebugUtilsMessengerEXT =
        (PFN_vkDestroyDebugUtilsMessengerEXT)vk->vkGetInstanceProcAddr(
            instance, "vkDestroyDebugUtilsMessengerEXT");
    return LR_OK;
}

lr_status lr_vk_load_device(lr_vk *vk, VkDevice device, lr_error *error)
{
#define X(name)                                                                                    \
    vk->name = (PFN_##name)vk->vkGetDeviceProcAddr(device, #name);                                 \
    if (!vk->name)                                                                                 \
        return lr_fail(error, LR_ERROR_DEVICE, "the Vulkan driver lacks %s", #name);
    LR_VK_DEVICE(X)
#undef X
    return LR_OK;
}

lr_status lr_vk_load_window(lr_vk *vk, VkInstance instance, VkDevice device, lr_error *error)
{
#define X(name)                                                                                    \
    vk->name = (PFN_##name)vk->vkGetInstanceProcAddr(instance, #name);                             \
    if (!vk->name)                                                                                 \
        return lr_fail(error, LR_ERROR_DEVICE, "the Vulkan driver lacks %s", #name);
    LR_VK_WINDOW_INSTANCE(X)
#undef X
#define X(name)                                                                                    \
    vk->name = (PFN_##name)vk->vkGetDeviceProcAddr(device, #name);                                 \
    if (!vk->name)                                                                                 \
        return lr_fail(error, LR_ERROR_DEVICE, "the Vulkan driver lacks %s", #name);
    LR_VK_WINDOW_DEVICE(X)
#undef X
    return LR_OK;
}

static const char *result_name(VkResult result)
{
    switch (result) {
#define CASE(name)                                                                                 \
    case name:                                                                                     \
        return #name;
        CASE(VK_NOT_READY)
        CASE(VK_TIMEOUT)
        CASE(VK_INCOMPLETE)
        CASE(VK_ERROR_OUT_OF_HOST_MEMORY)
        CASE(VK_ERROR_OUT_OF_DEVICE_MEMORY)
        CASE(VK_ERROR_INITIALIZATION_FAILED)
        CASE(VK_ERROR_DEVICE_LOST)
        CASE(VK_ERROR_MEMORY_MAP_FAILED)
        CASE(VK_ERROR_LAYER_NOT_PRESENT)
        CASE(VK_ERROR_EXTENSION_NOT_PRESENT)
        CASE(VK_ERROR_FEATURE_NOT_PRESENT)
        CASE(VK_ERROR_INCOMPATIBLE_DRIVER)
        CASE(VK_ERROR_TOO_MANY_OBJECTS)
        CASE(VK_ERROR_FRAGMENTED_POOL)
        CASE(VK_ERROR_OUT_OF_POOL_MEMORY)
        CASE(VK_ERROR_SURFACE_LOST_KHR)
        CASE(VK_ERROR_OUT_OF_DATE_KHR)
        CASE(VK_ERROR_NATIVE_WINDOW_IN_USE_KHR)
#undef CASE
    default:
        return "an unknown error";
    }
}

lr_status lr_vk_fail(lr_error *error, const char *call, VkResult result)
{
    const char *remedy = "";
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY)
        remedy = ": not enough memory for this picture; try a smaller --size";
    else if (result == VK_ERROR_DEVICE_LOST)
        remedy = ": the device stopped working; try again, or --device cpu";
    else if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
        remedy = ": no Vulkan driver; install the package mesa-vulkan-drivers, or check "
                 "VK_ICD_FILENAMES";
    return lr_fail(error, LR_ERROR_DEVICE, "%s failed with %s (%d)%s", call, result_name(result),
                   (int)result, remedy);
}
