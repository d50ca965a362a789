/* Reads with a cap, and writes that leave the old file or the new one, and nothing else. */
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <cmocka.h>

#include "base/file.h"

static char folder[64];

static int setup(void **state)
{
    (void)state;
    signal(SIGPIPE, SIG_IGN); /* as the command line does */
    strcpy(folder, "/tmp/lavaray-file-XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

static int teardown(void **state)
{
    (void)state;
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}

static const char *in_folder(const char *name)
{
    static char paths[4][512];
    static unsigned next;
    char *path = paths[next++ % 4];
    snprintf(path, sizeof paths[0], "%s/%.400s", folder, name);
    return path;
}

static void empty_folder(void)
{
    char command[256];
    snprintf(command, sizeof command, "rm -rf '%s'/* '%s'/.l*", folder, folder);
    assert_int_equal(system(command), 0);
}

static unsigned count_entries(void)
{
    unsigned count = 0;
    DIR *directory = opendir(folder);
    assert_non_null(directory);
    for (struct dirent *entry; (entry = readdir(directory));)
        count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
    closedir(directory);
    return count;
}

static void expect_content(const char *path, const char *expected)
{
    char *bytes;
    size_t size;
    lr_error error = {0};
    if (lr_file_read(path, 1 << 20, &bytes, &size, &error) != LR_OK)
        fail_msg("%s", error.message);
    assert_int_equal(size, strlen(expected));
    assert_string_equal(bytes, expected);
    free(bytes);
}

static void write_text(const char *path, const char *text)
{
    lr_error error = {0};
    if (lr_file_write(path, text, strlen(text), &error) != LR_OK)
        fail_msg("%s", error.message);
}

static void expect_write_failure(const char *path, const char *expected, const char *remedy)
{
    lr_error error = {0};
    assert_int_equal(lr_file_write(path, "text", 4, &error), LR_ERROR_FILE);
    assert_int_equal(error.status, LR_ERROR_FILE);
    if (!strstr(error.message, expected) || !strstr(error.message, remedy))
        fail_msg("expected \"%s\" and \"%s\", got \"%s\"", expected, remedy, error.message);
}

static mode_t mode_of(const char *path)
{
    struct stat info;
    assert_int_equal(lstat(path, &info), 0);
    return info.st_mode & 07777;
}

/* ---- Reading ------------------------------------------------------------------------------ */

static void test_read(void **state)
{
    (void)state;
    empty_folder();
    write_text(in_folder("a"), "some text");
    expect_content(in_folder("a"), "some text");
    write_text(in_folder("a"), "");
    expect_content(in_folder("a"), "");

    size_t size, count = 3000000;
    char *bytes, *large = malloc(count);
    for (size_t i = 0; i < count; i++)
        large[i] = (char)(i * 31 >> 3);
    assert_int_equal(lr_file_write(in_folder("a"), large, count, NULL), LR_OK);
    assert_int_equal(lr_file_read(in_folder("a"), count, &bytes, &size, NULL), LR_OK);
    assert_int_equal(size, count);
    assert_memory_equal(bytes, large, count);
    assert_int_equal(bytes[count], 0);
    free(bytes);
    assert_int_equal(lr_file_read(in_folder("a"), SIZE_MAX, &bytes, &size, NULL), LR_OK);
    free(bytes);
    free(large);
}

static void expect_read_failure(const char *path, size_t limit, const char *expected)
{
    char *bytes = (char *)1;
    size_t size = 1;
    lr_error error = {0};
    assert_int_equal(lr_file_read(path, limit, &bytes, &size, &error), LR_ERROR_FILE);
    assert_null(bytes);
    assert_int_equal(size, 0);
    if (!strstr(error.message, expected) || !strstr(error.message, path))
        fail_msg("expected \"%s\", got \"%s\"", expected, error.message);
}

static void test_read_failures(void **state)
{
    (void)state;
    empty_folder();
    write_text(in_folder("ten"), "0123456789");
    expect_read_failure(in_folder("ten"), 9, "larger than the limit of 9 bytes");
    expect_read_failure(in_folder("none"), 100, "No such file");
    expect_read_failure(in_folder("ten/below"), 100, "Not a directory");
    expect_read_failure(folder, 100, "is a folder");
    expect_read_failure("", 100, "No such file");
    expect_read_failure("/dev/zero", 100000, "larger than the limit of 100000 bytes");
    char *bytes;
    size_t size;
    assert_int_equal(lr_file_read(in_folder("ten"), 10, &bytes, &size, NULL), LR_OK);
    assert_int_equal(size, 10);
    free(bytes);
    /* A file whose size the kernel does not know. */
    assert_int_equal(lr_file_read("/proc/self/status", 1 << 20, &bytes, &size, NULL), LR_OK);
    assert_memory_equal(bytes, "Name:", 5);
    free(bytes);
}

static void test_read_standard_input(void **state)
{
    (void)state;
    int ends[2], saved = dup(STDIN_FILENO);
    char *bytes;
    size_t size;
    for (size_t limit = 9; limit <= 10; limit++) {
        assert_int_equal(pipe(ends), 0);
        assert_int_equal(write(ends[1], "0123456789", 10), 10);
        close(ends[1]);
        dup2(ends[0], STDIN_FILENO);
        close(ends[0]);
        lr_error error = {0};
        lr_status status = lr_file_read("-", limit, &bytes, &size, &error);
        assert_int_equal(status, limit < 10 ? LR_ERROR_FILE : LR_OK);
        if (status == LR_OK)
            assert_string_equal(bytes, "0123456789");
        else
            assert_non_null(strstr(error.message, "standard input: larger"));
        free(bytes);
    }
    dup2(saved, STDIN_FILENO);
    close(saved);
}

/* ---- Writing ------------------------------------------------------------------------------ */

static void test_write_and_replace(void **state)
{
    (void)state;
    empty_folder();
    mode_t old = umask(027);
    write_text(in_folder("a"), "first");
    umask(old);
    assert_int_equal(mode_of(in_folder("a")), 0640);
    write_text(in_folder("a"), "second, and longer");
    expect_content(in_folder("a"), "second, and longer");
    write_text(in_folder("a"), "3");
    expect_content(in_folder("a"), "3");
    assert_int_equal(mode_of(in_folder("a")), 0640);
    assert_int_equal(chmod(in_folder("a"), 0604), 0);
    write_text(in_folder("a"), "4");
    assert_int_equal(mode_of(in_folder("a")), 0604);
    assert_int_equal(count_entries(), 1);
}

/* Whoever has the old file open goes on reading the old file, whole. */
static void test_replace_is_atomic(void **state)
{
    (void)state;
    empty_folder();
    write_text(in_folder("a"), "old content");
    int fd = open(in_folder("a"), O_RDONLY);
    write_text(in_folder("a"), "new");
    char buffer[32] = "";
    assert_int_equal(read(fd, buffer, sizeof buffer - 1), 11);
    assert_string_equal(buffer, "old content");
    close(fd);
}

static void test_relative_path(void **state)
{
    (void)state;
    empty_folder();
    char before[4096];
    assert_non_null(getcwd(before, sizeof before));
    assert_int_equal(chdir(folder), 0);
    write_text("relative", "1");
    write_text("./relative", "2");
    expect_content("relative", "2");
    assert_int_equal(chdir(before), 0);
    assert_int_equal(count_entries(), 1);
}

static void test_symbolic_links(void **state)
{
    (void)state;
    empty_folder();
    struct stat info;
    char target[64];
    assert_int_equal(mkdir(in_folder("sub"), 0755), 0);
    write_text(in_folder("sub/real"), "old");
    assert_int_equal(symlink("sub/real", in_folder("link")), 0);
    assert_int_equal(symlink("link", in_folder("link2")), 0);
    write_text(in_folder("link2"), "new");
    expect_content(in_folder("sub/real"), "new");
    assert_int_equal(lstat(in_folder("link2"), &info), 0);
    assert_true(S_ISLNK(info.st_mode));
    assert_int_equal(readlink(in_folder("link"), target, sizeof target), 8);
    assert_int_equal(lstat(in_folder("sub/real"), &info), 0);
    assert_true(S_ISREG(info.st_mode));

    /* A link that dangles makes its target. */
    assert_int_equal(symlink("sub/made", in_folder("dangling")), 0);
    write_text(in_folder("dangling"), "made");
    expect_content(in_folder("sub/made"), "made");
    assert_int_equal(lstat(in_folder("dangling"), &info), 0);
    assert_true(S_ISLNK(info.st_mode));

    assert_int_equal(symlink("loop", in_folder("loop")), 0);
    expect_write_failure(in_folder("loop"), "Too many levels", "loop");
    assert_int_equal(symlink("/dev/full", in_folder("full")), 0);
    expect_write_failure(in_folder("full"), "No space left", "free some space");
    assert_int_equal(count_entries(), 6);
}

static void test_bad_places(void **state)
{
    (void)state;
    empty_folder();
    write_text(in_folder("file"), "x");
    expect_write_failure(in_folder("none/a.ppm"), "No such file", "does not exist; create it");
    expect_write_failure(in_folder("file/a.ppm"), "Not a directory", "this is not a folder");
    expect_write_failure(folder, "names a folder", folder);
    expect_write_failure(in_folder("none/"), "names a folder", "add a file name");
    expect_write_failure("", "empty", "name");
    expect_write_failure("/proc/lavaray.ppm", "/proc/", "folder");
    expect_write_failure("/proc/version", "/proc/version", "");
    expect_write_failure("/dev/full", "No space left", "/dev/full: ");
    char long_name[5000];
    memset(long_name, 'a', sizeof long_name - 1);
    long_name[sizeof long_name - 1] = 0;
    expect_write_failure(long_name, "File name too long", "");
    long_name[300] = 0;
    expect_write_failure(in_folder(long_name), "File name too long", "");
    assert_int_equal(count_entries(), 1);
    write_text("/dev/null", "nothing is kept");
}

/* As a user without rights; root may write everywhere. */
static void test_no_permission(void **state)
{
    (void)state;
    empty_folder();
    write_text(in_folder("protected"), "old");
    assert_int_equal(chmod(in_folder("protected"), 0444), 0);
    assert_int_equal(mkdir(in_folder("closed"), 0555), 0);
    assert_int_equal(chmod(folder, 0777), 0);
    pid_t child = fork();
    if (child == 0) {
        lr_error error = {0};
        if (geteuid() == 0 && (setgid(65534) != 0 || setuid(65534) != 0))
            _exit(3);
        if (lr_file_write(in_folder("closed/new"), "x", 1, &error) != LR_ERROR_FILE ||
            !strstr(error.message, "no permission to create files in this folder"))
            _exit(1);
        if (lr_file_write(in_folder("protected"), "x", 1, &error) != LR_ERROR_FILE ||
            !strstr(error.message, "Permission denied"))
            _exit(2);
        _exit(0);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(chmod(folder, 0755), 0);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 0);
    expect_content(in_folder("protected"), "old");
    assert_int_equal(count_entries(), 2);
}

/* A write that fails half-way: the limit on file sizes stands in for a full disk. */
static void test_failure_keeps_the_old_file(void **state)
{
    (void)state;
    empty_folder();
    write_text(in_folder("a"), "old");
    size_t size = 1 << 20;
    char *bytes = calloc(size, 1);
    struct rlimit saved, small;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &saved), 0);
    signal(SIGXFSZ, SIG_IGN);
    small = (struct rlimit){4096, saved.rlim_max};
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    lr_error error = {0};
    lr_status replaced = lr_file_write(in_folder("a"), bytes, size, &error);
    lr_status created = lr_file_write(in_folder("b"), bytes, size, NULL);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &saved), 0);
    assert_int_equal(replaced, LR_ERROR_FILE);
    assert_int_equal(created, LR_ERROR_FILE);
    assert_non_null(strstr(error.message, "File too large"));
    expect_content(in_folder("a"), "old");
    assert_int_equal(count_entries(), 1);
    free(bytes);
}

static void test_fifo(void **state)
{
    (void)state;
    empty_folder();
    const char *path = in_folder("fifo");
    assert_int_equal(mkfifo(path, 0600), 0);
    size_t size = 1 << 20; /* more than a pipe holds */
    char *bytes = calloc(size, 1);
    for (int keep_reading = 0; keep_reading < 2; keep_reading++) {
        pid_t reader = fork();
        if (reader == 0) {
            char buffer[65536];
            size_t left = size;
            int fd = open(path, O_RDONLY);
            for (ssize_t got; (got = read(fd, buffer, sizeof buffer)) > 0; left -= (size_t)got)
                if (!keep_reading)
                    _exit(0);
            _exit(left == 0 ? 0 : 1);
        }
        lr_error error = {0};
        lr_status written = lr_file_write(path, bytes, size, &error);
        int status;
        assert_int_equal(waitpid(reader, &status, 0), reader);
        assert_int_equal(status, 0);
        assert_int_equal(written, keep_reading ? LR_OK : LR_ERROR_FILE);
        if (!keep_reading)
            assert_non_null(strstr(error.message, "fifo: Broken pipe: the program that reads"));
    }
    struct stat info;
    assert_int_equal(lstat(path, &info), 0);
    assert_true(S_ISFIFO(info.st_mode));
    assert_int_equal(count_entries(), 1);
    free(bytes);
}

static lr_status write_with_stdout(int fd, const char *path, lr_error *error)
{
    fflush(stdout);
    int saved = dup(STDOUT_FILENO);
    if (fd < 0)
        close(STDOUT_FILENO);
    else
        dup2(fd, STDOUT_FILENO);
    lr_status status = lr_file_write(path, "text", 4, error);
    dup2(saved, STDOUT_FILENO);
    close(saved);
    return status;
}

static void test_standard_output(void **state)
{
    (void)state;
    static const char *const paths[] = {"-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        empty_folder();
        write_text(in_folder("a"), "before ");
        int fd = open(in_folder("a"), O_WRONLY | O_APPEND);
        assert_int_equal(write_with_stdout(fd, paths[i], NULL), LR_OK);
        close(fd);
        expect_content(in_folder("a"), "before text");
        assert_int_equal(count_entries(), 1);

        lr_error error = {0};
        assert_int_equal(write_with_stdout(-1, paths[i], &error), LR_ERROR_FILE);
        assert_non_null(strstr(error.message, "Bad file descriptor: it is closed"));
        fd = open("/dev/full", O_WRONLY);
        assert_int_equal(write_with_stdout(fd, paths[i], &error), LR_ERROR_FILE);
        close(fd);
        assert_non_null(strstr(error.message, "No space left on device"));
        int ends[2];
        assert_int_equal(pipe(ends), 0);
        close(ends[0]);
        assert_int_equal(write_with_stdout(ends[1], paths[i], &error), LR_ERROR_FILE);
        close(ends[1]);
        assert_non_null(strstr(error.message, "Broken pipe"));
        assert_non_null(strstr(error.message, i == 0 ? "standard output: " : paths[i]));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_read),
        cmocka_unit_test(test_read_failures),
        cmocka_unit_test(test_read_standard_input),
        cmocka_unit_test(test_write_and_replace),
        cmocka_unit_test(test_replace_is_atomic),
        cmocka_unit_test(test_relative_path),
        cmocka_unit_test(test_symbolic_links),
        cmocka_unit_test(test_bad_places),
        cmocka_unit_test(test_no_permission),
        cmocka_unit_test(test_failure_keeps_the_old_file),
        cmocka_unit_test(test_fifo),
        cmocka_unit_test(test_standard_output),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
