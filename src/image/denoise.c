/* Open Image Denoise, looked for when it is asked for: the few functions of its C interface that
 * are needed are declared here. */
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/status.h"

/* Of oidn.h; the same in versions 1 and 2. */
enum { OIDN_DEVICE_CPU = 1, OIDN_FORMAT_FLOAT3 = 3 };
enum { OIDN_OK = 0, OIDN_OUT_OF_MEMORY = 4, OIDN_CANCELLED = 6 };

typedef struct OIDNDeviceImpl *oidn_device;
typedef struct OIDNFilterImpl *oidn_filter;
typedef bool (*oidn_progress)(void *user, double fraction);

typedef struct oidn_api {
    oidn_device (*new_device)(int type);
    void (*commit_device)(oidn_device);
    void (*release_device)(oidn_device);
    int (*get_device_error)(oidn_device, const char **message);
    int (*get_device_int)(oidn_device, const char *name);
    oidn_filter (*new_filter)(oidn_device, const char *type);
    void (*set_image)(oidn_filter, const char *name, void *pixels, int format, size_t width,
                      size_t height, size_t offset, size_t pixel_stride, size_t row_stride);
    void (*set_bool)(oidn_filter, const char *name, bool value);
    void (*set_progress)(oidn_filter, oidn_progress, void *user);
    void (*commit_filter)(oidn_filter);
    void (*execute_filter)(oidn_filter);
    void (*release_filter)(oidn_filter);
} oidn_api;

struct lr_denoiser {
    oidn_api api;
    oidn_device device;
    char name[64];
};

static const struct {
    size_t offset;
    const char *name, *before_2;
} symbols[] = {
    {offsetof(oidn_api, new_device), "oidnNewDevice", NULL},
    {offsetof(oidn_api, commit_device), "oidnCommitDevice", NULL},
    {offsetof(oidn_api, release_device), "oidnReleaseDevice", NULL},
    {offsetof(oidn_api, get_device_error), "oidnGetDeviceError", NULL},
    {offsetof(oidn_api, get_device_int), "oidnGetDeviceInt", "oidnGetDevice1i"},
    {offsetof(oidn_api, new_filter), "oidnNewFilter", NULL},
    {offsetof(oidn_api, set_image), "oidnSetSharedFilterImage", NULL},
    {offsetof(oidn_api, set_bool), "oidnSetFilterBool", "oidnSetFilter1b"},
    {offsetof(oidn_api, set_progress), "oidnSetFilterProgressMonitorFunction", NULL},
    {offsetof(oidn_api, commit_filter), "oidnCommitFilter", NULL},
    {offsetof(oidn_api, execute_filter), "oidnExecuteFilter", NULL},
    {offsetof(oidn_api, release_filter), "oidnReleaseFilter", NULL},
};

static lr_status load(void **library, lr_error *error)
{
    static const char *const names[] = {"libOpenImageDenoise.so.2", "libOpenImageDenoise.so.1",
                                        "libOpenImageDenoise.so.0"};
    char reason[512] = "";
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        *library = dlopen(names[i], RTLD_NOW | RTLD_LOCAL);
        if (*library)
            return LR_OK;
        /* A library that is there but cannot be loaded is worth more words than one that is not. */
        const char *message = dlerror();
        if (i == 0 || strncmp(message, names[i], strlen(names[i])) != 0)
            snprintf(reason, sizeof reason, "%s", message);
    }
    return lr_fail(error, LR_ERROR_FILE,
                   "Open Image Denoise cannot be loaded (%s): install it, or unpack it from "
                   "openimagedenoise.org and name its folder lib in LD_LIBRARY_PATH",
                   reason);
}

static lr_status find_symbols(void *library, oidn_api *api, lr_error *error)
{
    for (size_t i = 0; i < sizeof symbols / sizeof *symbols; i++) {
        void *found = dlsym(library, symbols[i].name);
        if (!found && symbols[i].before_2)
            found = dlsym(library, symbols[i].before_2);
        if (!found)
            return lr_fail(error, LR_ERROR_FILE,
                           "this libOpenImageDenoise has no function %s: install Open Image "
                           "Denoise 1.0 or newer",
                           symbols[i].name);
        memcpy((char *)api + symbols[i].offset, &found, sizeof found);
    }
    return LR_OK;
}

/* What went wrong since this was last asked, if anything did. */
static lr_status check(const lr_denoiser *denoiser, lr_error *error)
{
    const char *message = NULL;
    int code = denoiser->api.get_device_error(denoiser->device, &message);
    if (code == OIDN_OK)
        return LR_OK;
    if (code == OIDN_CANCELLED)
        return lr_fail(error, LR_ERROR_INTERRUPTED, "interrupted");
    return lr_fail(error, code == OIDN_OUT_OF_MEMORY ? LR_ERROR_MEMORY : LR_ERROR_DEVICE,
                   "Open Image Denoise failed: %s", message ? message : "it does not say why");
}

/* On the CPU: the pixels are in its memory, and every computer has one. */
static lr_status open_device(lr_denoiser *d, lr_error *error)
{
    d->device = d->api.new_device(OIDN_DEVICE_CPU);
    if (!d->device) {
        lr_status status = check(d, error);
        return status ? status
                      : lr_fail(error, LR_ERROR_DEVICE, "Open Image Denoise finds no processor");
    }
    d->api.commit_device(d->device);
    lr_status status = check(d, error);
    if (status)
        return status;
    snprintf(d->name, sizeof d->name, "Open Image Denoise %d.%d.%d",
             d->api.get_device_int(d->device, "versionMajor"),
             d->api.get_device_int(d->device, "versionMinor"),
             d->api.get_device_int(d->device, "versionPatch"));
    return LR_OK;
}

lr_status lr_denoiser_open(lr_denoiser **denoiser, lr_error *error)
{
    *denoiser = lr_alloc(1, sizeof **denoiser);
    if (!*denoiser)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for a denoiser");
    void *library; /* never closed: its threads may still run */
    lr_status status = load(&library, error);
    if (!status)
        status = find_symbols(library, &(*denoiser)->api, error);
    if (!status)
        status = open_device(*denoiser, error);
    if (status) {
        lr_denoiser_close(*denoiser);
        *denoiser = NULL;
    }
    return status;
}

void lr_denoiser_close(lr_denoiser *denoiser)
{
    if (denoiser && denoiser->device)
        denoiser->api.release_device(denoiser->device);
    free(denoiser);
}

const char *lr_denoiser_name(const lr_denoiser *denoiser)
{
    return denoiser->name;
}

static void set_image(const lr_denoiser *d, oidn_filter filter, const char *name,
                      const lr_picture *picture, const float *pixels)
{
    if (pixels)
        d->api.set_image(filter, name, (void *)(uintptr_t)pixels, OIDN_FORMAT_FLOAT3,
                         picture->width, picture->height, 0, 0, 0);
}

static lr_status filter_into(const lr_denoiser *d, const lr_picture *picture, float *pixels,
                             const lr_denoise_options *options, lr_error *error)
{
    oidn_filter filter = d->api.new_filter(d->device, "RT");
    if (filter) {
        set_image(d, filter, "color", picture, picture->pixels);
        set_image(d, filter, "albedo", picture, options->albedo);
        set_image(d, filter, "normal", picture, options->normal);
        set_image(d, filter, "output", picture, pixels);
        d->api.set_bool(filter, "hdr", true);
        if (options->progress)
            d->api.set_progress(filter, options->progress, options->user);
        d->api.commit_filter(filter);
        d->api.execute_filter(filter);
        d->api.release_filter(filter);
    }
    lr_status status = check(d, error);
    return status || filter
               ? status
               : lr_fail(error, LR_ERROR_DEVICE, "Open Image Denoise has no filter RT");
}

lr_status lr_denoiser_run(lr_denoiser *denoiser, lr_picture *picture,
                          const lr_denoise_options *options, lr_error *error)
{
    size_t count = 3 * (size_t)picture->width * picture->height;
    float *pixels = lr_alloc(count, sizeof *pixels);
    if (!pixels)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for a denoised picture");
    lr_status status =
        filter_into(denoiser, picture, pixels, options ? options : &(lr_denoise_options){0}, error);
    if (status) {
        free(pixels);
        return status;
    }
    free(picture->pixels);
    picture->pixels = pixels;
    return LR_OK;
}
