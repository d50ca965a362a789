/* A look at all Vulkan devices, for `devices` and `doctor`. */
#ifndef LR_CLI_DEVICES_H
#define LR_CLI_DEVICES_H

#include "lavaray.h"

typedef struct device_entry {
    lr_device_info info;
    bool opened;        /* lavaray can work with it */
    bool exact;         /* it passes the arithmetic self-test; meaningful when opened */
    bool automatic;     /* what --device auto takes */
    char trouble[1024]; /* why it is not opened */
} device_entry;

/* Lists the devices and opens each one. The caller frees *entries. An error as lr_device_list's. */
lr_status survey_devices(device_entry **entries, uint32_t *count, lr_error *error);

/* "usable, exact", or what is wrong. */
const char *describe_usability(const device_entry *entry);

#endif
