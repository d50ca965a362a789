#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/memory.h"

enum {
    TRANSFER_LIMIT = 1 << 30, /* Linux moves at most 2 GiB per call */
    TEMPORARY_NAMES = 1000,
    LINKS_LIMIT = 40, /* as the kernel follows */
};

/* Of a path in a message, so that a long one leaves room for the reason. */
#define SHOWN "%.500s"

static const char *shown(const char *path, const char *standard_stream)
{
    return strcmp(path, "-") == 0 ? standard_stream : path;
}

/* ---- Reading ------------------------------------------------------------------------------ */

static lr_status too_large(const char *name, size_t limit, lr_error *error)
{
    return lr_fail(error, LR_ERROR_FILE, SHOWN ": larger than the limit of %zu bytes", name, limit);
}

static lr_status read_all(int fd, const char *name, size_t limit, size_t expected, char **bytes,
                          size_t *size, lr_error *error)
{
    size_t used = 0, capacity = expected < 65536 ? 65536 : expected;
    char *buffer = lr_alloc_large(capacity + 1, 1);
    while (buffer) {
        size_t room = capacity - used < TRANSFER_LIMIT ? capacity - used : TRANSFER_LIMIT;
        ssize_t got = room ? read(fd, buffer + used, room) : 0;
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0) {
            lr_fail(error, LR_ERROR_FILE, SHOWN ": %s", name, strerror(errno));
            free(buffer);
            return LR_ERROR_FILE;
        }
        used += (size_t)got;
        if (used > limit) {
            free(buffer);
            return too_large(name, limit, error);
        }
        if (room && got == 0) {
            buffer[used] = 0;
            *bytes = buffer;
            *size = used;
            return LR_OK;
        }
        if (used == capacity) {
            if (capacity > SIZE_MAX / 2 - 1)
                break;
            capacity *= 2;
            char *grown = realloc(buffer, capacity + 1);
            if (!grown)
                break;
            buffer = grown;
        }
    }
    free(buffer);
    return lr_fail(error, LR_ERROR_MEMORY, SHOWN ": out of memory after %zu bytes", name, used);
}

lr_status lr_file_read(const char *path, size_t limit, char **bytes, size_t *size, lr_error *error)
{
    *bytes = NULL;
    *size = 0;
    bool is_standard = strcmp(path, "-") == 0;
    const char *name = shown(path, "standard input");
    int fd = is_standard ? STDIN_FILENO : open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY);
    if (fd < 0)
        return lr_fail(error, LR_ERROR_FILE, SHOWN ": %s", name, strerror(errno));
    struct stat info;
    lr_status status;
    size_t expected = 0;
    if (fstat(fd, &info) != 0) {
        status = lr_fail(error, LR_ERROR_FILE, SHOWN ": %s", name, strerror(errno));
    } else if (S_ISDIR(info.st_mode)) {
        status = lr_fail(error, LR_ERROR_FILE, SHOWN ": is a folder, not a file", name);
    } else if (S_ISREG(info.st_mode) && !is_standard && (uintmax_t)info.st_size > limit) {
        status = too_large(name, limit, error);
    } else {
        /* One byte more than the size, so that the end is seen without growing the buffer. */
        if (S_ISREG(info.st_mode) && (uintmax_t)info.st_size <= limit)
            expected = (size_t)info.st_size + 1;
        status = read_all(fd, name, limit, expected, bytes, size, error);
    }
    if (!is_standard)
        close(fd);
    return status;
}

/* ---- States -------------------------------------------------------------------------------- */

#define NANOSECONDS 1000000000

/* The clocks of file systems tick up to every 10 ms. */
#define YOUNG (20 * 1000000)

static int64_t nanoseconds(struct timespec time)
{
    return (int64_t)time.tv_sec * NANOSECONDS + time.tv_nsec;
}

lr_file_stamp lr_file_stamp_of(const char *path)
{
    struct stat info;
    struct timespec now;
    if (stat(path, &info) != 0)
        return (lr_file_stamp){0};
    clock_gettime(CLOCK_REALTIME, &now);
    int64_t modified = nanoseconds(info.st_mtim), age = nanoseconds(now) - modified;
    return (lr_file_stamp){.device = info.st_dev,
                           .inode = info.st_ino,
                           .size = (uint64_t)info.st_size,
                           .modified = modified,
                           /* Other machines' clocks may be ahead by any time. */
                           .young = age < YOUNG && age > -YOUNG};
}

bool lr_file_is_same(const lr_file_stamp *earlier, const lr_file_stamp *later)
{
    return !earlier->young && earlier->device == later->device && earlier->inode == later->inode &&
           earlier->size == later->size && earlier->modified == later->modified;
}

/* ---- Writing ------------------------------------------------------------------------------ */

static lr_status write_failure(const char *name, int reason, lr_error *error)
{
    const char *remedy = "";
    if (reason == EPIPE)
        remedy = ": the program that reads it has ended";
    else if (reason == ENOSPC)
        remedy = ": free some space or write elsewhere";
    else if (reason == EBADF)
        remedy = ": it is closed or not open for writing";
    return lr_fail(error, LR_ERROR_FILE, SHOWN ": %s%s", name, strerror(reason), remedy);
}

/* 0 or the errno of the failure. */
static int write_all(int fd, const char *bytes, size_t size)
{
    while (size > 0) {
        ssize_t done = write(fd, bytes, size < TRANSFER_LIMIT ? size : TRANSFER_LIMIT);
        if (done < 0 && errno == EINTR)
            continue;
        if (done < 0)
            return errno;
        if (done == 0)
            return EIO;
        bytes += done;
        size -= (size_t)done;
    }
    return 0;
}

/* The file descriptor that a path such as /dev/stdout or /dev/fd/3 stands for, -1 for other paths.
 * Such a path is written through the descriptor: opening it would truncate or overwrite a file that
 * the shell opened for appending. */
static int descriptor_of(const char *path)
{
    static const char *const folders[] = {"/dev/fd/", "/proc/self/fd/"};
    if (strcmp(path, "-") == 0 || strcmp(path, "/dev/stdout") == 0)
        return STDOUT_FILENO;
    if (strcmp(path, "/dev/stderr") == 0)
        return STDERR_FILENO;
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++) {
        size_t length = strlen(folders[i]);
        if (strncmp(path, folders[i], length) != 0)
            continue;
        const char *digits = path + length;
        size_t digit_count = strspn(digits, "0123456789");
        if (digit_count > 0 && digit_count < 9 && digits[digit_count] == 0)
            return atoi(digits);
    }
    return -1;
}

/* The length of a path up to and with its last slash. */
static size_t folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

/* Follows symbolic links in the last component, also where the last one's target does not exist
 * yet. False with errno set when they cannot be followed. */
static bool follow_links(char path[PATH_MAX])
{
    for (int i = 0; i < LINKS_LIMIT; i++) {
        struct stat info;
        if (descriptor_of(path) >= 0 || lstat(path, &info) != 0 || !S_ISLNK(info.st_mode))
            return true;
        char target[PATH_MAX];
        ssize_t length = readlink(path, target, sizeof target - 1);
        if (length < 0)
            return false;
        target[length] = 0;
        size_t kept = target[0] == '/' ? 0 : folder_length(path);
        if (kept + (size_t)length >= PATH_MAX) {
            errno = ENAMETOOLONG;
            return false;
        }
        memcpy(path + kept, target, (size_t)length + 1);
    }
    errno = ELOOP;
    return false;
}

static lr_status create_failure(const char *path, const char *target, int reason, lr_error *error)
{
    size_t length = folder_length(target);
    char folder[256];
    snprintf(folder, sizeof folder, "%.*s", length ? (int)length : 1, length ? target : ".");
    const char *remedy = NULL;
    switch (reason) {
    case ENOENT:
        remedy = "the folder does not exist; create it first";
        break;
    case ENOTDIR:
        remedy = "this is not a folder";
        break;
    case EACCES:
    case EPERM:
        remedy = "no permission to create files in this folder";
        break;
    }
    if (remedy)
        return lr_fail(error, LR_ERROR_FILE, SHOWN ": %s: %s: %s", path, strerror(reason), folder,
                       remedy);
    return write_failure(path, reason, error);
}

/* Opens a new file beside the target; the kernel applies the umask to it. */
static int create_temporary(const char *target, char temporary[PATH_MAX])
{
    int folder = (int)folder_length(target);
    for (int i = 0; i < TEMPORARY_NAMES; i++) {
        int length = snprintf(temporary, PATH_MAX, "%.*s.lavaray-%ld-%d.tmp", folder, target,
                              (long)getpid(), i);
        if (length >= PATH_MAX) {
            errno = ENAMETOOLONG;
            return -1;
        }
        int fd = open(temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666);
        if (fd >= 0 || errno != EEXIST)
            return fd;
    }
    return -1;
}

/* Gives the new file the old one's owner, where that is allowed, and its permissions. */
static int copy_permissions(int fd, const struct stat *old)
{
    mode_t mode = old->st_mode & 07777;
    if (fchown(fd, old->st_uid, old->st_gid) != 0)
        mode &= 0777; /* set-id bits would now speak of another owner */
    return fchmod(fd, mode) == 0 ? 0 : errno;
}

/* Makes the rename itself durable; a file system that cannot do that keeps the file all the same.
 */
static void flush_folder(const char *target)
{
    char folder[PATH_MAX];
    size_t length = folder_length(target);
    snprintf(folder, sizeof folder, "%.*s", length ? (int)length : 1, length ? target : ".");
    int fd = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd >= 0) {
        fsync(fd);
        close(fd);
    }
}

static lr_status replace(const char *path, const char *target, const struct stat *old,
                         const void *bytes, size_t size, lr_error *error)
{
    char temporary[PATH_MAX];
    if (old && access(target, W_OK) != 0)
        return write_failure(path, errno, error);
    int fd = create_temporary(target, temporary);
    if (fd < 0)
        return create_failure(path, target, errno, error);
    int reason = old ? copy_permissions(fd, old) : 0;
    if (reason == 0)
        reason = write_all(fd, bytes, size);
    if (reason == 0 && fsync(fd) != 0 && errno != EINVAL && errno != ENOSYS)
        reason = errno;
    if (close(fd) != 0 && reason == 0 && errno != EINTR)
        reason = errno;
    if (reason == 0 && rename(temporary, target) != 0)
        reason = errno;
    if (reason != 0) {
        unlink(temporary);
        return write_failure(path, reason, error);
    }
    flush_folder(target);
    return LR_OK;
}

static lr_status write_directly(const char *path, const char *target, const void *bytes,
                                size_t size, lr_error *error)
{
    int fd = open(target, O_WRONLY | O_CLOEXEC | O_NOCTTY);
    if (fd < 0)
        return write_failure(path, errno, error);
    int reason = write_all(fd, bytes, size);
    if (close(fd) != 0 && reason == 0 && errno != EINTR)
        reason = errno;
    return reason == 0 ? LR_OK : write_failure(path, reason, error);
}

lr_status lr_file_write(const char *path, const void *bytes, size_t size, lr_error *error)
{
    char target[PATH_MAX];
    if (path[0] == 0)
        return lr_fail(error, LR_ERROR_FILE, "the name of the output file is empty");
    if (strlen(path) >= sizeof target)
        return write_failure(path, ENAMETOOLONG, error);
    memcpy(target, path, strlen(path) + 1);
    if (!follow_links(target))
        return write_failure(path, errno, error);

    int descriptor = descriptor_of(target);
    if (descriptor >= 0) {
        int reason = write_all(descriptor, bytes, size);
        return reason == 0 ? LR_OK : write_failure(shown(path, "standard output"), reason, error);
    }
    struct stat info;
    bool exists = stat(target, &info) == 0;
    if (!exists && errno != ENOENT)
        return create_failure(path, target, errno, error);
    const char *last = target + folder_length(target);
    if ((exists && S_ISDIR(info.st_mode)) || last[0] == 0)
        return lr_fail(error, LR_ERROR_FILE, SHOWN ": names a folder; add a file name", path);
    if (exists && !S_ISREG(info.st_mode))
        return write_directly(path, target, bytes, size, error);
    return replace(path, target, exists ? &info : NULL, bytes, size, error);
}
