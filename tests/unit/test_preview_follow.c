/* Files that others edit, with real files and real events. Times are generous: only what must not
 * happen, and what comes later than it may, fails. */
#include <dirent.h>
#include <fcntl.h>
#include <poll.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/stat.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/file.h"
#include "preview/follow.h"
#include "temporary_folder.h"

/* Seconds: how long nothing is waited for, and how long something. */
#define NEVER 0.25
#define SOON 5.0

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

static void sleep_ms(long ms)
{
    nanosleep(&(struct timespec){ms / 1000, ms % 1000 * 1000000}, NULL);
}

/* Waits like a window does; whether a change was told within the time. */
static bool changes(lr_follow *follow, double seconds)
{
    double end = now() + seconds;
    for (;;) {
        if (lr_follow_changed(follow, now()))
            return true;
        double left = end - now(), wait = lr_follow_wait(follow, now());
        if (left <= 0)
            return false;
        wait = wait < 0 || wait > left ? left : wait;
        struct pollfd fd = {.fd = lr_follow_descriptor(follow), .events = POLLIN};
        poll(&fd, 1, (int)(wait * 1000) + 1);
    }
}

static char *in_folder(const char *name)
{
    static char paths[8][256];
    static unsigned next;
    char *path = paths[next++ % 8];
    snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    return path;
}

/* In place, as some editors write. */
static void put(const char *name, const char *text)
{
    FILE *file = fopen(in_folder(name), "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

/* Beside it and renamed, as others do. */
static void replace(const char *name, const char *text)
{
    put("beside~", text);
    assert_int_equal(rename(in_folder("beside~"), in_folder(name)), 0);
}

static void list_file(lr_file_list *list, const char *path)
{
    list->files = realloc(list->files, (list->count + 1) * sizeof *list->files);
    list->files[list->count++] = (lr_file){strdup(path), lr_file_stamp_of(path)};
}

/* Follows up to two files of the folder, which have rested. */
static lr_follow *follow_files(const char *first, const char *second)
{
    lr_file_list list = {0};
    sleep_ms(25);
    list_file(&list, in_folder(first));
    if (second)
        list_file(&list, in_folder(second));
    lr_follow *follow = lr_follow_create();
    assert_non_null(follow);
    assert_true(lr_follow_files(follow, &list));
    lr_file_list_free(&list);
    assert_false(changes(follow, 0.05));
    return follow;
}

static void test_edits(void **state)
{
    (void)state;
    put("a.yaml", "1");
    put("other", "1");
    lr_follow *follow = follow_files("a.yaml", NULL);
    assert_true(lr_follow_wait(follow, now()) < 0);
    put("a.yaml", "22");
    assert_true(changes(follow, SOON));
    assert_false(changes(follow, NEVER));
    put("a.yaml", "33"); /* the same size */
    assert_true(changes(follow, SOON));
    replace("a.yaml", "44");
    assert_true(changes(follow, SOON));
    unlink(in_folder("a.yaml"));
    assert_true(changes(follow, SOON));
    assert_false(changes(follow, NEVER));
    put("a.yaml", "55");
    assert_true(changes(follow, SOON));
    /* Looking at it, its permissions, and its neighbours are no edits. */
    sleep_ms(25);
    (void)changes(follow, 0.1);
    size_t size;
    char *text;
    assert_int_equal(lr_file_read(in_folder("a.yaml"), 100, &text, &size, NULL), LR_OK);
    free(text);
    assert_int_equal(chmod(in_folder("a.yaml"), 0600), 0);
    put("other", "2");
    put(".a.yaml.swp", "2");
    assert_false(changes(follow, NEVER));
    assert_true(lr_follow_wait(follow, now()) < 0);
    lr_follow_destroy(follow);
}

/* An edit between reading the file and following it. */
static void test_edit_before(void **state)
{
    (void)state;
    put("a.yaml", "1");
    sleep_ms(25);
    lr_file_list list = {0};
    list_file(&list, in_folder("a.yaml"));
    put("a.yaml", "2");
    lr_follow *follow = lr_follow_create();
    assert_true(lr_follow_files(follow, &list));
    assert_true(lr_follow_wait(follow, now()) == 0);
    assert_true(changes(follow, SOON));
    /* The list of before once more, as after loading what is there now. */
    sleep_ms(25);
    list.files[0].stamp = lr_file_stamp_of(in_folder("a.yaml"));
    assert_true(lr_follow_files(follow, &list));
    assert_false(changes(follow, NEVER));
    lr_file_list_free(&list);
    lr_follow_destroy(follow);
}

static void test_missing(void **state)
{
    (void)state;
    put("a.yaml", "1");
    lr_follow *follow = follow_files("a.yaml", "sub/sub/b.png");
    assert_int_equal(mkdir(in_folder("sub"), 0700), 0);
    assert_int_equal(mkdir(in_folder("sub/sub"), 0700), 0);
    assert_false(changes(follow, NEVER));
    put("sub/sub/b.png", "1");
    assert_true(changes(follow, SOON));
    sleep_ms(25);
    (void)changes(follow, 0.1);
    /* The folder goes and comes again. */
    unlink(in_folder("sub/sub/b.png"));
    rmdir(in_folder("sub/sub"));
    assert_true(changes(follow, SOON));
    assert_false(changes(follow, NEVER));
    assert_int_equal(mkdir(in_folder("sub/sub"), 0700), 0);
    put("sub/sub/b.png", "2");
    assert_true(changes(follow, SOON));
    /* A folder further up is renamed, and comes back. */
    sleep_ms(25);
    (void)changes(follow, 0.1);
    assert_int_equal(rename(in_folder("sub"), in_folder("old")), 0);
    assert_true(changes(follow, SOON));
    assert_int_equal(rename(in_folder("old"), in_folder("sub")), 0);
    assert_true(changes(follow, SOON));
    lr_follow_destroy(follow);
}

static void test_links(void **state)
{
    (void)state;
    mkdir(in_folder("v1"), 0700);
    mkdir(in_folder("v2"), 0700);
    put("v1/s.yaml", "1");
    put("v2/s.yaml", "2");
    assert_int_equal(symlink("v1", in_folder("current")), 0);
    assert_int_equal(symlink("current/s.yaml", in_folder("link.yaml")), 0);
    lr_follow *follow = follow_files("link.yaml", NULL);
    put("v2/s.yaml", "22");
    assert_false(changes(follow, NEVER));
    put("v1/s.yaml", "11");
    assert_true(changes(follow, SOON));
    /* A link in the middle is swapped. */
    assert_int_equal(symlink("v2", in_folder("next")), 0);
    assert_int_equal(rename(in_folder("next"), in_folder("current")), 0);
    assert_true(changes(follow, SOON));
    sleep_ms(25);
    (void)changes(follow, 0.1);
    put("v1/s.yaml", "111");
    assert_false(changes(follow, NEVER));
    put("v2/s.yaml", "222");
    assert_true(changes(follow, SOON));
    /* And the one in front. */
    assert_int_equal(symlink(in_folder("v1/s.yaml"), in_folder("next")), 0);
    assert_int_equal(rename(in_folder("next"), in_folder("link.yaml")), 0);
    assert_true(changes(follow, SOON));
    /* In a circle: no file, no hang. */
    assert_int_equal(symlink("link.yaml", in_folder("next")), 0);
    assert_int_equal(rename(in_folder("next"), in_folder("link.yaml")), 0);
    assert_true(changes(follow, SOON));
    put("x.yaml", "1");
    assert_int_equal(rename(in_folder("x.yaml"), in_folder("link.yaml")), 0);
    assert_true(changes(follow, SOON));
    lr_follow_destroy(follow);
}

static void test_own_write(void **state)
{
    (void)state;
    put("a.yaml", "1");
    lr_follow *follow = follow_files("a.yaml", NULL);
    assert_int_equal(lr_file_write(in_folder("a.yaml"), "22", 2, NULL), LR_OK);
    lr_follow_forget_own_write(follow, in_folder("a.yaml"));
    assert_false(changes(follow, NEVER));
    replace("a.yaml", "33");
    assert_true(changes(follow, SOON));
    lr_follow_destroy(follow);
}

/* A burst is one change, told after it or, if it does not end, all the same. Here the times are the
 * test's own. */
static void test_bursts(void **state)
{
    (void)state;
    put("a.yaml", "1");
    lr_follow *follow = follow_files("a.yaml", NULL);
    double t = 1e6;
    for (int i = 0; i < 10; i++) { /* every 15 ms */
        put("a.yaml", i % 2 ? "1" : "22");
        assert_false(lr_follow_changed(follow, t + i * 0.015));
    }
    double last = t + 9 * 0.015, wait = lr_follow_wait(follow, last);
    assert_true(wait > 0.0299 && wait < 0.0301);
    assert_false(lr_follow_changed(follow, last + 0.029));
    assert_true(lr_follow_changed(follow, last + 0.031));
    t += 10;
    int told = 0;
    for (int i = 0; i < 100; i++) { /* every 10 ms for a second */
        put("a.yaml", i % 2 ? "1" : "22");
        told += lr_follow_changed(follow, t + i * 0.01);
    }
    assert_in_range(told, 4, 5);
    lr_follow_destroy(follow);
}

/* A hundred edits by all means, faster than they are told: the last one is not lost. */
static void test_many_edits(void **state)
{
    (void)state;
    put("a.yaml", "0");
    lr_follow *follow = follow_files("a.yaml", "b.png");
    int told = 0;
    for (int i = 1; i <= 100; i++) {
        char text[8];
        snprintf(text, sizeof text, "%d", i);
        if (i % 3 == 0)
            unlink(in_folder("a.yaml"));
        (i % 2 ? put : replace)(i % 5 ? "a.yaml" : "b.png", text);
        told += changes(follow, i % 10 * 0.01);
    }
    told += changes(follow, SOON);
    assert_in_range(told, 20, 200);
    sleep_ms(25);
    (void)changes(follow, 0.1);
    assert_false(changes(follow, NEVER));
    replace("a.yaml", "the last");
    assert_true(changes(follow, SOON));
    lr_follow_destroy(follow);
}

/* More events than the queue holds. */
static void test_overflow(void **state)
{
    (void)state;
    put("a.yaml", "0");
    lr_follow *follow = follow_files("a.yaml", NULL);
    FILE *file = fopen("/proc/sys/fs/inotify/max_queued_events", "r");
    long limit = 16384;
    if (file) {
        assert_int_equal(fscanf(file, "%ld", &limit), 1);
        fclose(file);
    }
    if (limit > 100000)
        limit = 100000;
    char x[256], y[256];
    strcpy(x, in_folder("x"));
    strcpy(y, in_folder("y"));
    put("x", "");
    for (long i = 0; i < limit / 4 + 10; i++) {
        rename(x, y);
        rename(y, x);
    }
    put("a.yaml", "after all of them");
    assert_true(changes(follow, SOON));
    lr_follow_destroy(follow);
}

/* Without inotify the files are looked at from time to time. */
static void test_polling(void **state)
{
    (void)state;
    put("a.yaml", "0");
    struct rlimit before, none;
    assert_int_equal(getrlimit(RLIMIT_NOFILE, &before), 0);
    none = (struct rlimit){0, before.rlim_max};
    lr_file_list list = {0};
    sleep_ms(25);
    list_file(&list, in_folder("a.yaml"));
    setrlimit(RLIMIT_NOFILE, &none);
    lr_follow *follow = lr_follow_create();
    setrlimit(RLIMIT_NOFILE, &before);
    assert_int_equal(lr_follow_descriptor(follow), -1);
    assert_true(lr_follow_files(follow, &list));
    lr_file_list_free(&list);
    assert_false(changes(follow, 0.1));
    double wait = lr_follow_wait(follow, now());
    assert_true(wait > 0 && wait <= 0.5);
    replace("a.yaml", "1");
    assert_true(changes(follow, SOON));
    unlink(in_folder("a.yaml"));
    assert_true(changes(follow, SOON));
    lr_follow_destroy(follow);
}

static unsigned open_files(void)
{
    unsigned count = 0;
    DIR *directory = opendir("/proc/self/fd");
    while (directory && readdir(directory))
        count++;
    closedir(directory);
    return count;
}

/* Neither descriptors nor watches are left behind. */
static void test_leaks(void **state)
{
    (void)state;
    put("a.yaml", "0");
    unsigned before = open_files();
    lr_follow *follow = follow_files("a.yaml", NULL);
    unsigned watched = 0;
    for (int i = 0; i < 300; i++) {
        char name[32], path[64], line[256];
        snprintf(name, sizeof name, "f%d", i);
        assert_int_equal(mkdir(in_folder(name), 0700), 0);
        lr_file_list list = {0};
        strcat(name, "/a");
        list_file(&list, in_folder(name));
        assert_true(lr_follow_files(follow, &list));
        lr_file_list_free(&list);
        assert_int_equal(open_files(), before + 1);
        if (i % 50 != 0)
            continue;
        snprintf(path, sizeof path, "/proc/self/fdinfo/%d", lr_follow_descriptor(follow));
        FILE *info = fopen(path, "r");
        unsigned watches = 0;
        while (info && fgets(line, sizeof line, info))
            watches += strncmp(line, "inotify ", 8) == 0;
        fclose(info);
        assert_true(watches > 0 && (watched == 0 || watches == watched));
        watched = watches;
    }
    lr_follow_destroy(follow);
    lr_follow_destroy(NULL);
    assert_int_equal(open_files(), before);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_edits),      cmocka_unit_test(test_edit_before),
        cmocka_unit_test(test_missing),    cmocka_unit_test(test_links),
        cmocka_unit_test(test_own_write),  cmocka_unit_test(test_bursts),
        cmocka_unit_test(test_many_edits), cmocka_unit_test(test_overflow),
        cmocka_unit_test(test_polling),    cmocka_unit_test(test_leaks),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
