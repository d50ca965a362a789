#include "cli/devices.h"

#include "cli/cli.h"
#include "cli/json.h"
#include "cli/self_test.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct values {
    bool json, self_test;
} values;

static const option options[] = {
    {.name = "json",
     .kind = OPTION_FLAG,
     .offset = offsetof(values, json),
     .help = "print the list as JSON"},
    {.name = "self-test",
     .kind = OPTION_FLAG,
     .offset = offsetof(values, self_test),
     .help = "render a few built-in scenes on each usable device and\n"
             "compare their hashes with the known ones; exit code 1\n"
             "when one differs",
     .also = "test"},
};

static lr_status open_device(const char *select, lr_device **device, lr_error *error)
{
    lr_device_desc desc = {.select = select, .validation = validation_wanted()};
    return lr_device_open(&desc, device, error);
}

static void try_device(device_entry *entry, uint32_t index)
{
    if (!entry->info.usable) {
        snprintf(entry->trouble, sizeof entry->trouble, "%s", entry->info.missing);
        return;
    }
    char select[16];
    snprintf(select, sizeof select, "%u", (unsigned)index);
    lr_device *device = NULL;
    lr_error error = {0};
    if (open_device(select, &device, &error) == LR_OK) {
        entry->opened = true;
        entry->exact = lr_device_is_exact(device);
    } else {
        snprintf(entry->trouble, sizeof entry->trouble, "%s", error.message);
    }
    lr_device_close(device);
}

/* Two devices of one kind cannot be told apart here; the first of them is marked. */
static void mark_automatic(device_entry *entries, uint32_t count)
{
    lr_device *device = NULL;
    if (open_device("auto", &device, NULL) != LR_OK) {
        return;
    }
    const lr_device_info *info = lr_device_get_info(device);
    for (uint32_t i = 0; i < count; i++) {
        if (entries[i].opened && strcmp(entries[i].info.name, info->name) == 0 &&
            strcmp(entries[i].info.driver, info->driver) == 0) {
            entries[i].automatic = true;
            break;
        }
    }
    lr_device_close(device);
}

lr_status survey_devices(device_entry **entries, uint32_t *count, lr_error *error)
{
    lr_device_info *infos = NULL;
    *entries = NULL;
    *count = 0;
    lr_status status = lr_device_list(&infos, count, error);
    if (status != LR_OK) {
        return status;
    }
    *entries = calloc(*count ? *count : 1, sizeof **entries);
    if (!*entries) {
        free(infos);
        *error = (lr_error){.status = LR_ERROR_MEMORY, .message = "out of memory"};
        return LR_ERROR_MEMORY;
    }
    for (uint32_t i = 0; i < *count; i++) {
        (*entries)[i].info = infos[i];
        try_device(&(*entries)[i], i);
    }
    free(infos);
    mark_automatic(*entries, *count);
    return LR_OK;
}

const char *describe_usability(const device_entry *entry)
{
    if (!entry->opened) {
        return entry->trouble;
    }
    return entry->exact ? "usable, exact" : "usable, but fails the arithmetic self-test: not exact";
}

static void print_list(const device_entry *entries, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        const device_entry *e = &entries[i];
        printf("%u  %s  %s  Vulkan %s  %s  %s%s%s\n", (unsigned)i, e->info.name, e->info.driver,
               format_version(e->info.api_version).text, e->info.software ? "software" : "GPU",
               e->opened ? "" : "not usable: ", describe_usability(e),
               e->automatic ? "  (taken by --device auto)" : "");
    }
}

static int print_json(const device_entry *entries, uint32_t count)
{
    json_t *list = json_array();
    for (uint32_t i = 0; i < count; i++) {
        const device_entry *e = &entries[i];
        json_array_append_new(
            list, json_pack("{s:i, s:s, s:s, s:s, s:b, s:b, s:b, s:b, s:s}", "index", (int)i,
                            "name", e->info.name, "driver", e->info.driver, "api_version",
                            format_version(e->info.api_version).text, "software", e->info.software,
                            "usable", e->opened, "exact", e->opened && e->exact, "auto",
                            e->automatic, "missing", e->opened ? "" : e->trouble));
    }
    return write_json(list, "-");
}

static int run(const command *self, int argc, char **argv)
{
    values v = {0};
    int operands;
    parse_result parsed = options_parse(self, argc, argv, &v, &operands);
    if (parsed != PARSE_OK) {
        return (int)parsed;
    }
    if (v.json && v.self_test) {
        print_error("--json and --self-test do not go together; see lavaray devices --help");
        return EXIT_USAGE;
    }
    lr_error error = {0};
    device_entry *entries;
    uint32_t count;
    lr_status status = survey_devices(&entries, &count, &error);
    if (status != LR_OK) {
        error.status = status;
        return report_failure(&error);
    }
    int code = EXIT_DEVICE; /* until one is found usable */
    for (uint32_t i = 0; i < count; i++) {
        code = entries[i].opened ? EXIT_FINE : code;
    }
    if (v.json) {
        int printed = print_json(entries, count);
        code = printed == EXIT_FINE ? code : printed;
    } else {
        print_list(entries, count);
    }
    for (uint32_t i = 0; v.self_test && i < count; i++) {
        if (entries[i].opened) {
            int result = run_self_test(i);
            code = result > code ? result : code;
        }
    }
    free(entries);
    return code;
}

const command command_devices = {
    .name = "devices",
    .operands = "",
    .summary = "list the Vulkan devices and whether lavaray can use them",
    .details = "Lists the Vulkan devices, one line each: index, name, driver, Vulkan version,\n"
               "GPU or software, whether lavaray can use it and what is missing, and whether its\n"
               "arithmetic is exact. An exact device renders the same bytes as every other exact\n"
               "device. Exit code 4 when no device is usable.",
    .examples = "  lavaray devices\n"
                "  lavaray devices --self-test",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .run = run,
};
