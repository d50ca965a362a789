/* lr_judge in a process of its own, with a time limit: pictures come from other programs, and one
 * that crashes a decoder or needs all memory must fail its case alone. */
#ifndef LR_TESTER_TRIAL_H
#define LR_TESTER_TRIAL_H

#include "tester/process.h"
#include "tester/result.h"

/* Zeroed is none. */
typedef struct lr_trial {
    struct lr_verdict *verdict; /* memory that both processes see */
} lr_trial;

/* Starts judging the picture at candidate; `difference` is as for lr_judge. Poll the process, then
 * call lr_trial_finish. */
lr_status lr_trial_start(lr_trial *trial, lr_process *process, const char *candidate,
                         const char *difference, const lr_case *item, double limit,
                         lr_error *error);

/* Once the process has ended: fills the result as lr_judge would; broken and `crashed` when the
 * process did not come to a verdict. Frees what the trial holds. */
void lr_trial_finish(lr_trial *trial, const lr_process *process, lr_case_result *result);

#endif
