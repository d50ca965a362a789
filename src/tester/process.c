#ifndef _GNU_SOURCE
#define _GNU_SOURCE /* pipe2 */
#endif
#include "tester/process.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define GRACE 2.0 /* seconds between the request to end and the end */

extern char **environ;

double lr_clock(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* 0 or the errno of what failed. */
static int spawn(pid_t *pid, const char *const *argv, int output)
{
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    sigset_t none, defaults;
    sigemptyset(&none);
    sigemptyset(&defaults);
    sigaddset(&defaults, SIGPIPE); /* which main ignores */
    int failed = posix_spawn_file_actions_init(&actions);
    if (failed)
        return failed;
    failed = posix_spawnattr_init(&attributes);
    if (failed) {
        posix_spawn_file_actions_destroy(&actions);
        return failed;
    }
    if (!failed)
        failed = posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    if (!failed)
        failed = posix_spawn_file_actions_adddup2(&actions, output, 1);
    if (!failed)
        failed = posix_spawn_file_actions_adddup2(&actions, output, 2);
    if (!failed)
        failed = posix_spawnattr_setflags(
            &attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
    if (!failed)
        failed = posix_spawnattr_setpgroup(&attributes, 0);
    if (!failed)
        failed = posix_spawnattr_setsigdefault(&attributes, &defaults);
    if (!failed)
        failed = posix_spawnattr_setsigmask(&attributes, &none);
    if (!failed)
        failed = posix_spawnp(pid, argv[0], &actions, &attributes, (char *const *)argv, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    return failed;
}

/* Makes a pipe of which `process` reads one end; returns the other, -1 with errno set. */
static int open_pipe(lr_process *process, double limit)
{
    int ends[2];
    *process = (lr_process){.pipe = -1, .limit = limit, .start = lr_clock()};
    if (pipe2(ends, O_CLOEXEC) != 0)
        return -1;
    fcntl(ends[0], F_SETFL, O_NONBLOCK);
    process->pipe = ends[0];
    return ends[1];
}

static void close_pipe(lr_process *p)
{
    if (p->pipe >= 0)
        close(p->pipe);
    p->pipe = -1;
}

lr_status lr_process_start(lr_process *process, const char *const *argv, double limit,
                           lr_error *error)
{
    int output = open_pipe(process, limit);
    int failed = output < 0 ? errno : spawn(&process->pid, argv, output);
    if (output >= 0)
        close(output);
    if (!failed)
        return LR_OK;
    close_pipe(process);
    process->pid = 0;
    return lr_fail(error, LR_ERROR_FILE, "cannot start %.300s: %s", argv[0], strerror(failed));
}

/* What spawn() does for commands: a group, no input, output to the pipe, no handlers of ours. */
static void settle_child(int output)
{
    static const int handled[] = {SIGINT, SIGTERM, SIGHUP, SIGPIPE};
    setpgid(0, 0);
    for (size_t i = 0; i < sizeof handled / sizeof *handled; i++)
        signal(handled[i], SIG_DFL);
    int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (nothing < 0 || dup2(nothing, 0) < 0 || dup2(output, 1) < 0 || dup2(output, 2) < 0)
        _exit(127);
}

lr_status lr_process_fork(lr_process *process, int (*work)(void *user), void *user, double limit,
                          lr_error *error)
{
    int output = open_pipe(process, limit);
    pid_t pid = output < 0 ? -1 : fork();
    if (pid == 0) {
        settle_child(output);
        _exit(work(user)); /* buffers of stdio are the parent's */
    }
    int failed = errno;
    if (output >= 0)
        close(output);
    if (pid < 0) {
        close_pipe(process);
        return lr_fail(error, LR_ERROR_FILE, "cannot start a process: %s", strerror(failed));
    }
    setpgid(pid, pid); /* whoever comes first: signals go to the group */
    process->pid = pid;
    return LR_OK;
}

void lr_process_wait(lr_process *const *processes, size_t count, double seconds)
{
    enum { WATCHED_MAX = 256 };
    struct pollfd watched[WATCHED_MAX];
    nfds_t used = 0;
    for (size_t i = 0; i < count && used < WATCHED_MAX; i++)
        if (processes[i]->pid && processes[i]->pipe >= 0)
            watched[used++] = (struct pollfd){.fd = processes[i]->pipe, .events = POLLIN};
    poll(watched, used, (int)(1000 * seconds)); /* a signal ends it early, which is right */
}

/* Keeps the end of what was written. */
static void keep(lr_process *p, const char *bytes, size_t size)
{
    size_t room = LR_TAIL_MAX - p->tail_length;
    if (size > room) {
        size_t dropped = size - room;
        memmove(p->tail, p->tail + dropped, p->tail_length - dropped);
        p->tail_length -= dropped;
        p->tail_cut = true;
    }
    memcpy(p->tail + p->tail_length, bytes, size);
    p->tail_length += size;
    p->tail[p->tail_length] = 0;
}

static void drain(lr_process *p)
{
    char bytes[LR_TAIL_MAX / 2]; /* so that keep() never drops more than there is */
    /* As much as fits a pipe: a command that never stops writing must not hold the tester. */
    for (int i = 0; i < 32 && p->pipe >= 0; i++) {
        ssize_t got = read(p->pipe, bytes, sizeof bytes);
        if (got > 0)
            keep(p, bytes, (size_t)got);
        else if (got < 0 && errno == EAGAIN)
            return;
        else if (got == 0 || errno != EINTR)
            close_pipe(p);
    }
}

static void signal_group(lr_process *p, int number)
{
    kill(-p->pid, number);
    p->killed = lr_clock();
}

/* Whether it has ended, without reaping it: until then its group's number is not used again. */
static bool has_ended(const lr_process *p)
{
    siginfo_t info = {0};
    int failed = waitid(P_PID, (id_t)p->pid, &info, WEXITED | WNOHANG | WNOWAIT);
    return (failed != 0 && errno == ECHILD) || (failed == 0 && info.si_pid == p->pid);
}

/* Ends what it left running, and takes its status. */
static void reap(lr_process *p)
{
    kill(-p->pid, SIGKILL);
    while (waitpid(p->pid, &p->status, 0) < 0 && errno == EINTR)
        continue;
    drain(p);
    close_pipe(p);
    p->pid = 0;
    p->seconds = lr_clock() - p->start;
}

bool lr_process_poll(lr_process *p)
{
    bool was_open = p->pipe >= 0;
    drain(p);
    bool ended = has_ended(p);
    if (!ended && was_open && p->pipe < 0) {
        /* The last act of most commands is to close their output. */
        nanosleep(&(struct timespec){.tv_nsec = 2000000}, NULL);
        ended = has_ended(p);
    }
    if (ended) {
        reap(p);
        return true;
    }
    double now = lr_clock();
    if (!p->killed && now - p->start > p->limit) {
        p->timed_out = true;
        signal_group(p, SIGTERM);
    } else if (p->killed && now - p->killed > GRACE) {
        signal_group(p, SIGKILL);
    }
    return false;
}

void lr_process_end(lr_process *p)
{
    if (p->pid && !p->killed)
        signal_group(p, SIGTERM);
}
