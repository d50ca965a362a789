#include "scene/path.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/file.h"
#include "base/memory.h"

/* Of a path in a message, so that a long one leaves room for the reason. */
#define SHOWN "%.400s"

char *lr_path_join(const char *base_file, const char *relative)
{
    const char *slash = strrchr(base_file, '/');
    size_t folder = slash && relative[0] != '/' ? (size_t)(slash + 1 - base_file) : 0;
    size_t length = strlen(relative);
    char *path = lr_alloc(folder + length + 1, 1);
    if (path) {
        memcpy(path, base_file, folder);
        memcpy(path + folder, relative, length);
    }
    return path;
}

static bool is_below(const char *path, const char *folder)
{
    size_t length = strlen(folder);
    while (length > 0 && folder[length - 1] == '/') /* the root */
        length--;
    return strncmp(path, folder, length) == 0 && path[length] == '/';
}

/* Whether `path` lies below the folder of base_file once all links are followed. */
static lr_status check_place(const char *base_file, const char *path, const char *relative,
                             lr_error *error)
{
    lr_status status = LR_ERROR_MEMORY;
    char *joined = lr_path_join(base_file, "."), *folder = NULL, *real = NULL;
    if (!joined)
        goto done;
    folder = realpath(joined, NULL);
    real = realpath(path, NULL);
    if (!folder || !real)
        status = lr_fail(error, LR_ERROR_FILE, SHOWN ": %s", real ? joined : path, strerror(errno));
    else if (is_below(real, folder))
        status = LR_OK;
    else
        status = lr_fail(error, LR_ERROR_FILE,
                         SHOWN " lies outside of the folder of " SHOWN
                               "; copy it there or allow it with --allow-path",
                         relative, base_file);
done:
    free(joined);
    free(folder);
    free(real);
    return status;
}

bool lr_file_list_put(lr_file_list *list, const char *path, const lr_file_stamp *stamp)
{
    for (uint32_t i = 0; i < list->count; i++)
        if (strcmp(list->files[i].path, path) == 0)
            return true;
    if (list->count == LR_FILES_MAX)
        return true;
    char *copy = lr_string_copy(path, strlen(path));
    if (!copy || !lr_array_reserve((void **)&list->files, list->count, &list->capacity,
                                   sizeof *list->files)) {
        free(copy);
        return false;
    }
    list->files[list->count++] = (lr_file){copy, *stamp};
    return true;
}

bool lr_file_list_add(const lr_load_options *options, const char *path)
{
    if (!options || !options->files)
        return true;
    lr_file_stamp stamp = lr_file_stamp_of(path);
    return lr_file_list_put(options->files, path, &stamp);
}

void lr_file_list_free(lr_file_list *list)
{
    for (uint32_t i = 0; i < list->count; i++)
        free(list->files[i].path);
    free(list->files);
    *list = (lr_file_list){0};
}

lr_status lr_path_resolve(const char *base_file, const char *relative,
                          const lr_load_options *options, char **path, lr_error *error)
{
    bool allow_outside = options->allow_path;
    struct stat info;
    *path = NULL;
    if (relative[0] == 0)
        return lr_fail(error, LR_ERROR_FILE, "the name of a file is empty");
    char *joined = lr_path_join(base_file, relative);
    bool reachable = allow_outside || relative[0] != '/';
    if (!joined || (reachable && !lr_file_list_add(options, joined))) {
        free(joined);
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for the name of a file");
    }
    lr_status status = LR_OK;
    /* Before anything is said of what lies outside, such as whether it exists. */
    if (!reachable)
        status = lr_fail(error, LR_ERROR_FILE,
                         SHOWN " is an absolute path; write it as seen from the folder of " SHOWN
                               " or allow it with --allow-path",
                         relative, base_file);
    else if (!allow_outside)
        status = check_place(base_file, joined, relative, error);
    if (!status && stat(joined, &info) != 0)
        status = lr_fail(error, LR_ERROR_FILE, SHOWN ": %s", joined, strerror(errno));
    else if (!status && !S_ISREG(info.st_mode)) /* a pipe could keep the reader waiting */
        status = lr_fail(error, LR_ERROR_FILE, SHOWN ": is not a regular file", joined);
    if (status)
        free(joined);
    else
        *path = joined;
    return status;
}
