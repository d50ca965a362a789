#include "tester/listing.h"

#include "base/memory.h"
#include "tester/text.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

enum { DEPTH_MAX = 32 }; /* of folders in folders */

char *lr_join_path(const char *folder, const char *name)
{
    size_t length = strlen(folder);
    if (!name[0])
        return lr_string_copy(folder, length);
    if (name[0] == '/' || strcmp(folder, ".") == 0)
        return lr_string_copy(name, strlen(name));
    return lr_format_text("%s%s%s", folder, length && folder[length - 1] == '/' ? "" : "/", name);
}

size_t lr_stem_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *dot = strrchr(slash ? slash : path, '.');
    return dot && dot != path ? (size_t)(dot - path) : strlen(path);
}

bool lr_is_folder(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

bool lr_is_file(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISREG(status.st_mode);
}

static bool has_ending(const char *name, const char *const *endings)
{
    size_t stem = lr_stem_length(name);
    for (; *endings; endings++)
        if (name[stem] == '.' && strcasecmp(name + stem + 1, *endings) == 0)
            return true;
    return false;
}

static lr_status out_of_memory(lr_error *error)
{
    return lr_fail(error, LR_ERROR_MEMORY, "out of memory for the list of files");
}

static lr_status add(lr_listing *listing, char *path, lr_error *error)
{
    if (!lr_array_reserve((void **)&listing->paths, listing->count, &listing->capacity,
                          sizeof *listing->paths)) {
        free(path);
        return out_of_memory(error);
    }
    listing->paths[listing->count++] = path;
    return LR_OK;
}

/* `below` is the path from the listed folder to this one, "" or ending in a slash. */
static lr_status walk(lr_listing *listing, const char *folder, const char *below,
                      const char *const *endings, int depth, lr_error *error)
{
    char *path = lr_join_path(folder, below);
    if (!path)
        return out_of_memory(error);
    DIR *stream = opendir(path);
    if (!stream) {
        lr_fail(error, LR_ERROR_FILE, "%.500s: %s", path, strerror(errno));
        free(path);
        return LR_ERROR_FILE;
    }
    lr_status status = LR_OK;
    const struct dirent *entry;
    while (status == LR_OK && (entry = readdir(stream)) != NULL) {
        if (entry->d_name[0] == '.')
            continue;
        struct stat info, link;
        char *name = lr_format_text("%s%s", below, entry->d_name);
        if (!name) {
            status = out_of_memory(error);
        } else if (fstatat(dirfd(stream), entry->d_name, &info, 0) != 0 ||
                   fstatat(dirfd(stream), entry->d_name, &link, AT_SYMLINK_NOFOLLOW) != 0) {
            free(name); /* a link to nowhere */
        } else if (S_ISDIR(link.st_mode) && depth > 0) {
            char *inner = lr_format_text("%s/", name);
            status = inner ? walk(listing, folder, inner, endings, depth - 1, error)
                           : out_of_memory(error);
            free(inner);
            free(name);
        } else if (S_ISREG(info.st_mode) && has_ending(entry->d_name, endings)) {
            status = add(listing, name, error);
        } else {
            free(name);
        }
    }
    closedir(stream);
    free(path);
    return status;
}

static int compare_paths(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

lr_status lr_listing_read(lr_listing *listing, const char *folder, const char *const *endings,
                          bool deep, lr_error *error)
{
    *listing = (lr_listing){0};
    lr_status status = walk(listing, folder, "", endings, deep ? DEPTH_MAX : 0, error);
    if (status != LR_OK)
        lr_listing_free(listing);
    else if (listing->count)
        qsort(listing->paths, listing->count, sizeof *listing->paths, compare_paths);
    return status;
}

void lr_listing_free(lr_listing *listing)
{
    for (uint32_t i = 0; i < listing->count; i++)
        free(listing->paths[i]);
    free(listing->paths);
    *listing = (lr_listing){0};
}

lr_status lr_make_folders(const char *path, lr_error *error)
{
    char *folder = lr_string_copy(path, strlen(path));
    if (!folder)
        return out_of_memory(error);
    lr_status status = LR_OK;
    for (char *slash = strchr(folder + 1, '/'); status == LR_OK && slash;
         slash = strchr(slash + 1, '/')) {
        *slash = 0;
        if (mkdir(folder, 0777) != 0 && errno != EEXIST)
            status = lr_fail(error, LR_ERROR_FILE, "%.500s: cannot create this folder: %s", folder,
                             strerror(errno));
        *slash = '/';
    }
    free(folder);
    return status;
}

static void remove_at(int parent, const char *name)
{
    int fd = openat(parent, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    DIR *stream = fd >= 0 ? fdopendir(fd) : NULL;
    if (!stream) {
        if (fd >= 0)
            close(fd);
        unlinkat(parent, name, 0);
        return;
    }
    const struct dirent *entry;
    while ((entry = readdir(stream)) != NULL)
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0)
            remove_at(fd, entry->d_name);
    closedir(stream);
    unlinkat(parent, name, AT_REMOVEDIR);
}

void lr_remove_tree(const char *folder)
{
    remove_at(AT_FDCWD, folder);
}
