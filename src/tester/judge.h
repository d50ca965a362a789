/* The comparison of a case's picture with its golden. */
#ifndef LR_TESTER_JUDGE_H
#define LR_TESTER_JUDGE_H

#include "tester/result.h"

/* Compares the picture at `candidate` with the case's golden and fills result's outcome (passed,
 * differs, missing, broken) and what belongs to it. A heat map is written to `difference` when they
 * differ. */
void lr_judge(const char *candidate, const char *difference, lr_case_result *result);

/* The case has no picture that could be judged. */
void lr_judge_broken(lr_case_result *result, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Fills the stamp from the texts of the picture. */
void lr_stamp_read(const lr_image *image, lr_stamp *stamp);

#endif
