#include "cli/cli.h"
#include "cli/devices.h"

#include <dirent.h>
#include <dlfcn.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <jansson.h>

typedef struct findings {
    unsigned manifests, good_drivers;
} findings;

static void say(const char *mark, const char *format, ...) __attribute__((format(printf, 2, 3)));

static void say(const char *mark, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    printf("%-8s", mark);
    vprintf(format, arguments);
    putchar('\n');
    va_end(arguments);
}

/* The library that a driver manifest names, as the loader would look for it: a path in it is
 * relative to the manifest, a bare name is searched for. */
static bool driver_library(const char *manifest, char *library, size_t size)
{
    json_error_t error;
    json_t *json = json_load_file(manifest, 0, &error);
    const char *path =
        json_string_value(json_object_get(json_object_get(json, "ICD"), "library_path"));
    if (!path) {
        say("wrong", "%s: %s", manifest, json ? "names no library_path" : error.text);
        json_decref(json);
        return false;
    }
    const char *slash = strrchr(manifest, '/');
    int written = strchr(path, '/') && path[0] != '/' && slash
                      ? snprintf(library, size, "%.*s/%s", (int)(slash - manifest), manifest, path)
                      : snprintf(library, size, "%s", path);
    json_decref(json);
    return written > 0 && (size_t)written < size;
}

static void check_manifest(const char *manifest, findings *f)
{
    char library[PATH_MAX];
    f->manifests++;
    if (!driver_library(manifest, library, sizeof library)) {
        return;
    }
    void *handle = dlopen(library, RTLD_LAZY | RTLD_LOCAL);
    if (!handle) {
        say("wrong", "driver %s: %s", manifest, dlerror());
        return;
    }
    dlclose(handle);
    f->good_drivers++;
    say("ok", "driver %s", manifest);
}

static int compare_names(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/* All *.json of a folder, in the order of their names. */
static void check_folder(const char *folder, findings *f)
{
    DIR *directory = opendir(folder);
    if (!directory) {
        return;
    }
    enum { MANIFESTS_MAX = 64 };
    char *names[MANIFESTS_MAX];
    size_t count = 0;
    struct dirent *entry;
    while (count < MANIFESTS_MAX && (entry = readdir(directory))) {
        size_t length = strlen(entry->d_name);
        if (length > 5 && strcmp(entry->d_name + length - 5, ".json") == 0) {
            names[count] = strdup(entry->d_name);
            count += names[count] != NULL;
        }
    }
    closedir(directory);
    qsort(names, count, sizeof *names, compare_names);
    for (size_t i = 0; i < count; i++) {
        char manifest[PATH_MAX];
        if (snprintf(manifest, sizeof manifest, "%s/%s", folder, names[i]) < PATH_MAX) {
            check_manifest(manifest, f);
        }
        free(names[i]);
    }
}

/* Calls visit for each part of a colon-separated list, with suffix behind it. */
static void for_each_path(const char *list, const char *suffix,
                          void (*visit)(const char *, findings *), findings *f)
{
    while (*list) {
        size_t length = strcspn(list, ":");
        char path[PATH_MAX];
        int written = snprintf(path, sizeof path, "%.*s%s", (int)length, list, suffix);
        if (length > 0 && written > 0 && written < PATH_MAX) {
            visit(path, f);
        }
        list += length + (list[length] == ':');
    }
}

static void check_named(const char *path, findings *f)
{
    struct stat status;
    if (stat(path, &status) != 0) {
        say("missing", "%s: there is no such driver file", path);
    } else if (S_ISDIR(status.st_mode)) {
        check_folder(path, f);
    } else {
        check_manifest(path, f);
    }
}

static const char *environment(const char *name, const char *fallback)
{
    const char *value = getenv(name);
    return value && *value ? value : fallback;
}

/* The places where the Vulkan loader looks for drivers. */
static void check_drivers(findings *f)
{
    static const char *const variables[] = {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"};
    for (int i = 0; i < 2; i++) {
        const char *value = environment(variables[i], NULL);
        if (value) {
            say("note", "%s is set to %s: no other drivers are looked for", variables[i], value);
            for_each_path(value, "", check_named, f);
            return;
        }
    }
    static const char suffix[] = "/vulkan/icd.d";
    const char *home = environment("HOME", "/nonexistent");
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%s/.config", home);
    for_each_path(environment("XDG_CONFIG_HOME", path), suffix, check_folder, f);
    for_each_path(environment("XDG_CONFIG_DIRS", "/etc/xdg"), suffix, check_folder, f);
    for_each_path("/etc", suffix, check_folder, f);
    snprintf(path, sizeof path, "%s/.local/share", home);
    for_each_path(environment("XDG_DATA_HOME", path), suffix, check_folder, f);
    for_each_path(environment("XDG_DATA_DIRS", "/usr/local/share:/usr/share"), suffix, check_folder,
                  f);
    const char *added = environment("VK_ADD_DRIVER_FILES", NULL);
    if (added) {
        for_each_path(added, "", check_named, f);
    }
}

static bool check_loader(void)
{
    void *loader = dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL);
    if (!loader) {
        say("missing", "the Vulkan loader: %s", dlerror());
        say("", "Debian package: libvulkan1");
        return false;
    }
    bool good = dlsym(loader, "vkGetInstanceProcAddr") != NULL;
    if (good) {
        say("ok", "the Vulkan loader libvulkan.so.1");
    } else {
        say("wrong", "libvulkan.so.1 is no Vulkan loader: it has no vkGetInstanceProcAddr");
    }
    dlclose(loader);
    return good;
}

static bool check_devices(void)
{
    lr_error error = {0};
    device_entry *entries;
    uint32_t count;
    if (survey_devices(&entries, &count, &error) != LR_OK) {
        say("wrong", "%s", error.message);
        return false;
    }
    const char *automatic = NULL;
    for (uint32_t i = 0; i < count; i++) {
        const device_entry *e = &entries[i];
        say(e->opened ? "ok" : "wrong", "device %u, %s (%s): %s", (unsigned)i, e->info.name,
            e->info.software ? "software" : "GPU", describe_usability(e));
        automatic = e->automatic ? e->info.name : automatic;
    }
    if (automatic) {
        say("ok", "lavaray render uses %s", automatic);
    } else if (count == 0) {
        say("missing", "the drivers offer no device");
    } else {
        say("missing", "none of the devices is usable");
    }
    bool usable = automatic != NULL;
    free(entries);
    return usable;
}

static int run(const command *self, int argc, char **argv)
{
    int operands;
    parse_result parsed = options_parse(self, argc, argv, NULL, &operands);
    if (parsed != PARSE_OK) {
        return (int)parsed;
    }
    say("ok", "lavaray %s", LR_VERSION);
    findings f = {0};
    bool good = check_loader();
    check_drivers(&f);
    if (f.manifests == 0) {
        say("missing", "a Vulkan driver: no driver file was found");
    }
    if (f.good_drivers == 0) {
        say("", "Debian package: mesa-vulkan-drivers (has a software renderer, too)");
    }
    /* Without a driver file of its own, a device can still come from an unusual loader. */
    good = good && check_devices();
    if (!good && f.good_drivers > 0) {
        say("", "Debian package with a software renderer that works anywhere: mesa-vulkan-drivers");
    }
    puts(good ? "A render will work." : "A render will not work.");
    return good ? EXIT_FINE : EXIT_DEVICE;
}

const command command_doctor = {
    .name = "doctor",
    .operands = "",
    .summary = "check whether renders can work here, and say what to install",
    .details = "Checks the Vulkan loader, the drivers and the devices, and names the Debian\n"
               "package for what is missing. Exit code 0 when a render would work, 4 otherwise.",
    .examples = "  lavaray doctor",
    .run = run,
};
