#ifndef _GNU_SOURCE
#define _GNU_SOURCE /* MAP_ANONYMOUS */
#endif
#include "tester/trial.h"

#include "base/memory.h"
#include "tester/judge.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>

typedef struct lr_verdict {
    lr_outcome outcome;
    bool readable, compared;
    lr_compare_result compare;
    lr_stamp golden_stamp, candidate_stamp;
    char message[2048], cause[1024], staleness[2048], difference[PATH_MAX]; /* "": none */
} lr_verdict;

typedef struct judging {
    const char *candidate, *difference;
    const lr_case *item;
    lr_verdict *verdict;
} judging;

static void put_text(char *to, size_t size, const char *text)
{
    snprintf(to, size, "%s", text ? text : "");
}

/* In the new process. */
static int work(void *user)
{
    const judging *j = user;
    lr_case_result result = {.item = j->item};
    lr_verdict *v = j->verdict;
    lr_judge(j->candidate, j->difference, &result);
    v->readable = result.readable;
    v->compared = result.compared;
    v->compare = result.compare;
    v->golden_stamp = result.golden_stamp;
    v->candidate_stamp = result.candidate_stamp;
    put_text(v->message, sizeof v->message, result.message);
    put_text(v->cause, sizeof v->cause, result.cause);
    put_text(v->staleness, sizeof v->staleness, result.staleness);
    put_text(v->difference, sizeof v->difference, result.difference);
    v->outcome = result.outcome;
    return 0;
}

static void release(lr_trial *trial)
{
    if (trial->verdict)
        munmap(trial->verdict, sizeof *trial->verdict);
    *trial = (lr_trial){0};
}

lr_status lr_trial_start(lr_trial *trial, lr_process *process, const char *candidate,
                         const char *difference, const lr_case *item, double limit, lr_error *error)
{
    *trial = (lr_trial){0};
    void *shared = mmap(NULL, sizeof *trial->verdict, PROT_READ | PROT_WRITE,
                        MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED)
        return lr_fail(error, LR_ERROR_MEMORY, "cannot compare: %s", strerror(errno));
    trial->verdict = shared;
    judging j = {candidate, difference, item, trial->verdict};
    lr_status status = lr_process_fork(process, work, &j, limit, error);
    if (status != LR_OK)
        release(trial);
    return status;
}

static char *take_text(const char *text)
{
    return text[0] ? lr_string_copy(text, strlen(text)) : NULL;
}

void lr_trial_finish(lr_trial *trial, const lr_process *process, lr_case_result *result)
{
    const lr_verdict *v = trial->verdict;
    result->crashed = true;
    if (process->timed_out)
        lr_judge_broken(result, "comparing the pictures was ended after the time limit of %g s",
                        process->limit);
    else if (WIFSIGNALED(process->status))
        lr_judge_broken(result, "comparing the pictures ended by signal %d (%s)",
                        WTERMSIG(process->status), strsignal(WTERMSIG(process->status)));
    else if (WEXITSTATUS(process->status) != 0)
        lr_judge_broken(result, "comparing the pictures ended with exit code %d",
                        WEXITSTATUS(process->status));
    else
        result->crashed = false;
    if (!result->crashed) {
        result->outcome = v->outcome;
        result->readable = v->readable;
        result->compared = v->compared;
        result->compare = v->compare;
        result->golden_stamp = v->golden_stamp;
        result->candidate_stamp = v->candidate_stamp;
        result->message = take_text(v->message);
        result->cause = take_text(v->cause);
        result->staleness = take_text(v->staleness);
        result->difference = take_text(v->difference);
    }
    release(trial);
}
