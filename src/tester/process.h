/* Commands and work in processes of their own, each with a time limit and its own process group, so
 * that what it started ends with it. */
#ifndef LR_TESTER_PROCESS_H
#define LR_TESTER_PROCESS_H

#include "base/status.h"

#include <sys/types.h>

enum { LR_TAIL_MAX = 8192 };

/* Zeroed is none. */
typedef struct lr_process {
    pid_t pid; /* 0: none is running */
    int pipe;  /* its output, -1 when it was closed */
    double start, limit;
    double killed; /* when it was last sent a signal, 0: never */
    bool timed_out;
    int status;                 /* as waitpid gives it, once it has ended */
    double seconds;             /* that it took */
    char tail[LR_TAIL_MAX + 1]; /* the end of what it wrote to stdout and stderr */
    size_t tail_length;
    bool tail_cut; /* more was written than is kept */
} lr_process;

/* Starts argv (NULL behind the last), found by PATH, with nothing to read. limit is in seconds. */
lr_status lr_process_start(lr_process *process, const char *const *argv, double limit,
                           lr_error *error);

/* Runs work(user) in a copy of this process, which must have no other threads; what it returns is
 * the exit code. */
lr_status lr_process_fork(lr_process *process, int (*work)(void *user), void *user, double limit,
                          lr_error *error);

/* Waits until one of the processes has something to say or `seconds` are over. */
void lr_process_wait(lr_process *const *processes, size_t count, double seconds);

/* Takes what was written and ends a process that is over its limit: first asks it to, two seconds
 * later makes it. True when it has ended and was reaped. */
bool lr_process_poll(lr_process *process);

/* Asks the process and all of its group to end; go on polling it. */
void lr_process_end(lr_process *process);

/* Seconds of a clock that only goes forward. */
double lr_clock(void);

#endif
