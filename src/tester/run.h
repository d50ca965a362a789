/* Runs cases: makes each picture in a process of its own and judges it. */
#ifndef LR_TESTER_RUN_H
#define LR_TESTER_RUN_H

#include "tester/result.h"

typedef struct lr_run_options {
    const char *program; /* the path of lavaray, for scenes */
    const char *output;  /* the folder for candidates and heat maps */
    const char *device;  /* NULL: what lavaray render takes */
    double timeout;      /* seconds for each case that says nothing else */
    uint32_t jobs;       /* cases at a time; 0: 1 */
    bool fail_fast;      /* start nothing more after the first failure */
    bool update;         /* replace goldens that differ, and write missing ones */
    bool update_missing; /* write missing goldens only */
    bool keep_all;       /* keep candidates of cases that passed, too */
    /* Called with each result as it comes, and with NULL now and then; returning false ends what
     * runs. */
    bool (*progress)(void *user, const lr_case_result *result);
    void *user;
} lr_run_options;

/* Runs the selected cases; results has one entry for each of them, in their order, which the
 * caller frees with lr_case_result_free. LR_ERROR_FILE when the output folder cannot be used,
 * LR_ERROR_INTERRUPTED; what fails in a case is the case's result. */
lr_status lr_run_cases(const lr_case *const *cases, uint32_t count, const lr_run_options *options,
                       lr_case_result *results, lr_error *error);

#endif
