#include "preview/follow.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include "base/file.h"
#include "base/memory.h"

/* Seconds. */
#define QUIET 0.03
#define LONGEST 0.2
#define POLL_EVERY 0.5

#define LINKS_MAX 40 /* as the kernel follows */

#define GONE (IN_DELETE_SELF | IN_MOVE_SELF | IN_IGNORED | IN_UNMOUNT)
#define FOLDER_EVENTS (IN_DELETE_SELF | IN_MOVE_SELF | IN_ONLYDIR)
#define NAME_EVENTS                                                                                \
    (IN_CLOSE_WRITE | IN_MOVED_TO | IN_MOVED_FROM | IN_CREATE | IN_DELETE | FOLDER_EVENTS)

/* A name in a folder, on the way to one of the files; "" for a folder on the way. */
typedef struct watch {
    int folder; /* inotify's number */
    char *name;
} watch;

typedef struct watches {
    watch *items;
    uint32_t count, capacity;
} watches;

struct lr_follow {
    int descriptor; /* -1: inotify is not to be had */
    lr_file_list files;
    watches watches;
    bool stirred; /* something happened that has not been looked at */
    double first_stir, last_stir;
    bool polling;
    double next_poll;
};

/* ---- Watching ------------------------------------------------------------------------------ */

static void free_watches(watches *w)
{
    for (uint32_t i = 0; i < w->count; i++)
        free(w->items[i].name);
    free(w->items);
    *w = (watches){0};
}

static bool has_folder(const watches *w, int folder)
{
    for (uint32_t i = 0; i < w->count; i++)
        if (w->items[i].folder == folder)
            return true;
    return false;
}

static bool has_name(const watches *w, int folder, const char *name)
{
    for (uint32_t i = 0; i < w->count; i++)
        if (w->items[i].folder == folder && strcmp(w->items[i].name, name) == 0)
            return true;
    return false;
}

/* Whether others than this kernel may change what is in the folder: statfs(2) has the numbers. */
static bool is_remote(const char *folder)
{
    static const unsigned long kinds[] = {
        0x6969,     /* NFS */
        0x517B,     /* SMB */
        0xFF534D42, /* CIFS */
        0xFE534D42, /* SMB 2 */
        0x65735546, /* FUSE, such as sshfs */
        0x01021997, /* 9P */
        0x00C36400, /* Ceph */
        0x5346414F, /* AFS */
        0x786F4256, /* VirtualBox */
    };
    struct statfs info;
    if (statfs(folder, &info) != 0)
        return true;
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if ((unsigned long)info.f_type == kinds[i])
            return true;
    return false;
}

/* Both kinds of events may be wanted of a folder, so new ones are added to those of before. */
static void add_watch(lr_follow *f, const char *folder, const char *name, uint32_t events)
{
    int number =
        f->descriptor < 0 ? -1 : inotify_add_watch(f->descriptor, folder, events | IN_MASK_ADD);
    /* Folders on the way may be closed to the reader. */
    if (events == NAME_EVENTS && (number < 0 || is_remote(folder)))
        f->polling = true;
    if (number < 0 || has_name(&f->watches, number, name))
        return;
    char *copy = lr_string_copy(name, strlen(name));
    if (copy && lr_array_reserve((void **)&f->watches.items, f->watches.count, &f->watches.capacity,
                                 sizeof *f->watches.items)) {
        f->watches.items[f->watches.count++] = (watch){number, copy};
    } else {
        free(copy);
        f->polling = true;
    }
}

/* A path that is gone through from the root. */
typedef struct walk {
    char done[PATH_MAX]; /* a folder, all links in it followed */
    char rest[PATH_MAX]; /* as seen from there */
} walk;

static bool start_walk(walk *w, const char *path)
{
    char here[PATH_MAX] = "";
    if (path[0] != '/' && !getcwd(here, sizeof here))
        return false;
    strcpy(w->done, "/");
    int length = snprintf(w->rest, sizeof w->rest, "%s/%s", here, path);
    return length > 0 && (size_t)length < sizeof w->rest;
}

/* Takes the next name off the rest; false at its end. */
static bool next_name(walk *w, char name[NAME_MAX + 1])
{
    const char *start = w->rest + strspn(w->rest, "/");
    size_t length = strcspn(start, "/");
    if (length == 0 || length > NAME_MAX)
        return false;
    memcpy(name, start, length);
    name[length] = 0;
    start += length;
    start += strspn(start, "/");
    memmove(w->rest, start, strlen(start) + 1);
    return true;
}

static void go_up(walk *w)
{
    char *slash = strrchr(w->done, '/');
    slash[slash == w->done] = 0;
}

static bool join(char out[PATH_MAX], const char *folder, const char *name)
{
    const char *slash = folder[0] && strcmp(folder, "/") != 0 ? "/" : "";
    int length = snprintf(out, PATH_MAX, "%s%s%s", folder, slash, name);
    return length > 0 && length < PATH_MAX;
}

/* Puts the link's target in front of the rest. */
static bool enter_link(walk *w, const char *link)
{
    char target[PATH_MAX], rest[PATH_MAX];
    ssize_t length = readlink(link, target, sizeof target - 1);
    if (length <= 0)
        return false;
    target[length] = 0;
    if (target[0] == '/')
        strcpy(w->done, "/");
    strcpy(rest, w->rest);
    strcpy(w->rest, target);
    return !rest[0] || join(w->rest, target, rest);
}

/* Watches the file's name in its folder, each link and folder on the way to it, and where the way
 * ends early, the name that is missing. */
static void watch_path(lr_follow *f, const char *path)
{
    walk w;
    char name[NAME_MAX + 1], full[PATH_MAX];
    bool good = start_walk(&w, path);
    for (int links = 0; good && next_name(&w, name);) {
        struct stat info;
        if (strcmp(name, ".") == 0)
            continue;
        if (strcmp(name, "..") == 0) {
            go_up(&w);
            continue;
        }
        good = join(full, w.done, name);
        bool there = good && lstat(full, &info) == 0;
        bool link = there && S_ISLNK(info.st_mode);
        if (!there || link || !w.rest[0])
            add_watch(f, w.done, name, NAME_EVENTS);
        if (!there)
            return;
        if (link) {
            good = ++links <= LINKS_MAX && enter_link(&w, full);
        } else if (w.rest[0]) {
            strcpy(w.done, full);
            add_watch(f, full, "", FOLDER_EVENTS);
        }
    }
    if (!good)
        f->polling = true;
}

/* Whatever was watched before and is not now is let go only afterwards, so nothing is missed. */
static void watch_all(lr_follow *f)
{
    watches before = f->watches;
    f->watches = (watches){0};
    f->polling = false;
    for (uint32_t i = 0; i < f->files.count; i++)
        watch_path(f, f->files.files[i].path);
    for (uint32_t i = 0; i < before.count; i++)
        if (!has_folder(&f->watches, before.items[i].folder))
            inotify_rm_watch(f->descriptor, before.items[i].folder); /* may be gone already */
    free_watches(&before);
}

/* ---- Events -------------------------------------------------------------------------------- */

static bool matters(const lr_follow *f, const struct inotify_event *event)
{
    if (event->mask & IN_Q_OVERFLOW)
        return true;
    if (event->mask & GONE)
        return has_folder(&f->watches, event->wd);
    return event->len > 0 && has_name(&f->watches, event->wd, event->name);
}

static void read_events(lr_follow *f, double now)
{
    _Alignas(struct inotify_event) char buffer[16384];
    for (;;) {
        ssize_t size = f->descriptor < 0 ? 0 : read(f->descriptor, buffer, sizeof buffer);
        if (size < 0 && errno == EINTR)
            continue;
        if (size <= 0)
            return;
        for (ssize_t at = 0; at < size;) {
            const struct inotify_event *event = (const void *)(buffer + at);
            at += (ssize_t)(sizeof *event + event->len);
            if (!matters(f, event))
                continue;
            if (!f->stirred)
                f->first_stir = now;
            f->stirred = true;
            f->last_stir = now;
        }
    }
}

/* ---- The interface ------------------------------------------------------------------------- */

lr_follow *lr_follow_create(void)
{
    lr_follow *f = lr_alloc(1, sizeof *f);
    if (f)
        f->descriptor = inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
    return f;
}

void lr_follow_destroy(lr_follow *f)
{
    if (!f)
        return;
    if (f->descriptor >= 0)
        close(f->descriptor);
    lr_file_list_free(&f->files);
    free_watches(&f->watches);
    free(f);
}

bool lr_follow_files(lr_follow *f, const lr_file_list *files)
{
    lr_file_list copy = {.files = lr_alloc(files->count, sizeof *copy.files)};
    bool good = copy.files != NULL;
    for (; good && copy.count < files->count; copy.count++) {
        lr_file *file = &copy.files[copy.count];
        *file = files->files[copy.count];
        file->path = lr_string_copy(file->path, strlen(file->path));
        good = file->path != NULL;
    }
    if (!good) {
        lr_file_list_free(&copy);
        return false;
    }
    lr_file_list_free(&f->files);
    f->files = copy;
    watch_all(f);
    /* They may have changed since they were read: to be looked at at once. */
    f->stirred = true;
    f->first_stir = f->last_stir = -1e300;
    return true;
}

int lr_follow_descriptor(const lr_follow *f)
{
    return f->descriptor;
}

static double due(const lr_follow *f)
{
    double quiet = f->last_stir + QUIET, longest = f->first_stir + LONGEST;
    return quiet < longest ? quiet : longest;
}

double lr_follow_wait(const lr_follow *f, double now)
{
    if (!f->stirred && !f->polling)
        return -1;
    double until = f->stirred ? due(f) : f->next_poll;
    if (f->stirred && f->polling && f->next_poll < until)
        until = f->next_poll;
    return until > now ? until - now : 0;
}

bool lr_follow_changed(lr_follow *f, double now)
{
    read_events(f, now);
    bool look = (f->stirred && now >= due(f)) || (f->polling && now >= f->next_poll);
    if (!look)
        return false;
    f->stirred = false;
    f->next_poll = now + POLL_EVERY;
    watch_all(f);
    bool changed = false;
    for (uint32_t i = 0; i < f->files.count; i++) {
        lr_file *file = &f->files.files[i];
        lr_file_stamp stamp = lr_file_stamp_of(file->path);
        changed |= !lr_file_is_same(&file->stamp, &stamp);
        file->stamp = stamp;
    }
    return changed;
}

void lr_follow_forget_own_write(lr_follow *f, const char *path)
{
    for (uint32_t i = 0; i < f->files.count; i++) {
        lr_file *file = &f->files.files[i];
        if (strcmp(file->path, path) != 0)
            continue;
        file->stamp = lr_file_stamp_of(path);
        file->stamp.young = false; /* it is known what is in it */
    }
}
