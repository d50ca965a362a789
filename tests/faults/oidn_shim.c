/* Stands in for Open Image Denoise: checks how it is used, and fails as LAVARAY_FAULT_OIDN says:
 * device, hardware, filter, memory, or wait, until progress is told to stop. What it makes of a
 * picture is half of color + albedo + 2 normal. SHIM_VERSION is 1 or 2; SHIM_INCOMPLETE leaves a
 * function out. */
#define _GNU_SOURCE
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef bool (*progress)(void *user, double fraction);

/* The device is the filter: there is one of each. */
typedef struct shim {
    int error;
    const char *message;
    bool committed, filter_committed, hdr, has_albedo;
    float *color, *albedo, *normal, *output;
    size_t width, height;
    progress monitor;
    void *user;
} shim;

static shim only;

static bool fault(const char *name)
{
    const char *wanted = getenv("LAVARAY_FAULT_OIDN");
    return wanted && strcmp(wanted, name) == 0;
}

static void fail(int error, const char *message)
{
    if (!only.error) {
        only.error = error;
        only.message = message;
    }
}

static void misuse(bool wrong, const char *message)
{
    if (wrong)
        fail(3, message);
}

#define EXPORT(type) __attribute__((visibility("default"))) type

EXPORT(shim *) oidnNewDevice(int type);
EXPORT(void) oidnCommitDevice(shim *device);
EXPORT(void) oidnReleaseDevice(shim *device);
EXPORT(int) oidnGetDeviceError(shim *device, const char **message);
EXPORT(shim *) oidnNewFilter(shim *device, const char *type);
EXPORT(void)
oidnSetSharedFilterImage(shim *filter, const char *name, void *pixels, int format, size_t width,
                         size_t height, size_t offset, size_t pixel_stride, size_t row_stride);
EXPORT(void) oidnSetFilterProgressMonitorFunction(shim *filter, progress monitor, void *user);
EXPORT(void) oidnCommitFilter(shim *filter);
EXPORT(void) oidnExecuteFilter(shim *filter);
EXPORT(void) oidnReleaseFilter(shim *filter);
#if SHIM_VERSION == 1
#define oidnGetDeviceInt oidnGetDevice1i
#define oidnSetFilterBool oidnSetFilter1b
#endif
EXPORT(int) oidnGetDeviceInt(shim *device, const char *name);
EXPORT(void) oidnSetFilterBool(shim *filter, const char *name, bool value);

shim *oidnNewDevice(int type)
{
    only = (shim){0};
    misuse(type != 1, "not the CPU's device");
    if (!fault("device"))
        return &only;
    fail(2, "no such device");
    return NULL;
}

void oidnCommitDevice(shim *device)
{
    device->committed = true;
    if (fault("hardware"))
        fail(5, "SSE4.1 support is required at minimum");
}

void oidnReleaseDevice(shim *device)
{
    misuse(!device, "no device released");
}

/* NULL asks for the error of a device that could not be made. */
int oidnGetDeviceError(shim *device, const char **message)
{
    (void)device;
    int error = only.error;
    *message = only.message;
    only.error = 0;
    return error;
}

int oidnGetDeviceInt(shim *device, const char *name)
{
    misuse(!device->committed, "the device is not committed");
    return strcmp(name, "versionMajor") == 0   ? SHIM_VERSION
           : strcmp(name, "versionMinor") == 0 ? 7
           : strcmp(name, "versionPatch") == 0 ? 8
                                               : -1;
}

shim *oidnNewFilter(shim *device, const char *type)
{
    misuse(!device->committed, "the device is not committed");
    misuse(strcmp(type, "RT") != 0, "unknown filter");
    device->color = device->albedo = device->normal = device->output = NULL;
    device->hdr = device->filter_committed = false;
    device->monitor = NULL;
    return fault("filter") ? NULL : device;
}

void oidnSetSharedFilterImage(shim *filter, const char *name, void *pixels, int format,
                              size_t width, size_t height, size_t offset, size_t pixel_stride,
                              size_t row_stride)
{
    misuse(format != 3 || offset || pixel_stride || row_stride, "not packed floats");
    misuse(filter->color && (width != filter->width || height != filter->height), "sizes differ");
    filter->width = width;
    filter->height = height;
    if (strcmp(name, "color") == 0)
        filter->color = pixels;
    else if (strcmp(name, "albedo") == 0)
        filter->albedo = pixels;
    else if (strcmp(name, "normal") == 0)
        filter->normal = pixels;
    else if (strcmp(name, "output") == 0)
        filter->output = pixels;
    else
        fail(2, "unknown image");
}

void oidnSetFilterBool(shim *filter, const char *name, bool value)
{
    misuse(strcmp(name, "hdr") != 0, "unknown switch");
    filter->hdr = value;
}

void oidnSetFilterProgressMonitorFunction(shim *filter, progress monitor, void *user)
{
    filter->monitor = monitor;
    filter->user = user;
}

void oidnCommitFilter(shim *filter)
{
    filter->filter_committed = true;
}

#ifndef SHIM_INCOMPLETE
void oidnExecuteFilter(shim *filter)
{
    misuse(!filter->filter_committed || !filter->hdr || !filter->color || !filter->output,
           "the filter is not ready");
    misuse(filter->normal && !filter->albedo, "normals without albedo");
    if (fault("memory"))
        fail(4, "out of memory");
    for (int i = 0; i < 1000 && fault("wait") && !only.error; i++) {
        usleep(10000);
        if (!filter->monitor || !filter->monitor(filter->user, i / 1000.0))
            fail(6, "execution was cancelled");
    }
    if (filter->monitor && !filter->monitor(filter->user, 1))
        fail(6, "execution was cancelled");
    for (size_t i = 0; i < 3 * filter->width * filter->height && !only.error; i++)
        filter->output[i] = (filter->color[i] + (filter->albedo ? filter->albedo[i] : 0) +
                             2 * (filter->normal ? filter->normal[i] : 0)) /
                            2;
}
#endif

void oidnReleaseFilter(shim *filter)
{
    misuse(!filter, "no filter released");
}
