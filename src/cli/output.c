#include "cli/output.h"

#include "cli/cli.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool folder_of(const char *path, char *folder, size_t size)
{
    const char *slash = strrchr(path, '/');
    int length = slash ? (int)(slash - path) : 0;
    int written = slash == path ? snprintf(folder, size, "/")
                  : slash       ? snprintf(folder, size, "%.*s", length, path)
                                : snprintf(folder, size, ".");
    return written > 0 && (size_t)written < size;
}

int check_writable(const char *path)
{
    char folder[PATH_MAX];
    char resolved[PATH_MAX];
    struct stat status;
    if (strcmp(path, "-") == 0) {
        return EXIT_FINE;
    }
    /* A link is followed, so the folder that matters is that of its target. */
    const char *target = realpath(path, resolved) ? resolved : path;
    if (!folder_of(target, folder, sizeof folder)) {
        print_error("%s: the path is too long", path);
        return EXIT_FILE;
    }
    if (stat(path, &status) == 0) {
        if (S_ISDIR(status.st_mode)) {
            print_error("%s: cannot write: it is a folder", path);
            return EXIT_FILE;
        }
        if (!S_ISREG(status.st_mode)) { /* a device or pipe is written in its place */
            if (access(path, W_OK) != 0) {
                print_error("%s: cannot write: %s", path, strerror(errno));
                return EXIT_FILE;
            }
            return EXIT_FINE;
        }
    }
    if (stat(folder, &status) != 0) {
        print_error("%s: cannot write: folder %s: %s", path, folder, strerror(errno));
        return EXIT_FILE;
    }
    if (!S_ISDIR(status.st_mode)) {
        print_error("%s: cannot write: %s is not a folder", path, folder);
        return EXIT_FILE;
    }
    if (access(folder, W_OK | X_OK) != 0) {
        print_error("%s: cannot write: folder %s: %s", path, folder, strerror(errno));
        return EXIT_FILE;
    }
    return EXIT_FINE;
}

bool same_file(const char *a, const char *b)
{
    struct stat sa, sb;
    return stat(a, &sa) == 0 && stat(b, &sb) == 0 && S_ISREG(sa.st_mode) &&
           sa.st_dev == sb.st_dev && sa.st_ino == sb.st_ino;
}

int check_names(const command *self, const char *output, const char *stats, const char *checkpoint,
                const char *scene)
{
    if (strcmp(output, "-") == 0 && stats && strcmp(stats, "-") == 0) {
        return wrong_usage(self, "-o - and --stats - cannot both have standard output");
    }
    if (same_file(output, scene) || (stats && same_file(stats, scene)) ||
        (checkpoint && same_file(checkpoint, scene))) {
        return wrong_usage(self, "the output would replace the scene");
    }
    if (stats && strcmp(stats, output) == 0) {
        return wrong_usage(self, "the picture and the statistics have the same name");
    }
    if (checkpoint &&
        (strcmp(checkpoint, output) == 0 || (stats && strcmp(checkpoint, stats) == 0) ||
         same_file(checkpoint, output))) {
        return wrong_usage(self, "the checkpoint needs a name of its own");
    }
    if (checkpoint && strcmp(checkpoint, "-") == 0) {
        return wrong_usage(self, "--checkpoint needs a file, not standard output");
    }
    return EXIT_FINE;
}
