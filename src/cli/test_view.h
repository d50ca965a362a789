/* What `lavaray test` shows while it runs. */
#ifndef LR_CLI_TEST_VIEW_H
#define LR_CLI_TEST_VIEW_H

#include "tester/report.h"

#include <stdio.h>

typedef struct test_view {
    FILE *out;
    bool color;
    bool quiet;     /* only what failed */
    int name_width; /* columns */
} test_view;

/* Writes to standard output, or to standard error when a report goes there. */
void test_view_start(test_view *view, bool to_stderr, bool quiet, const lr_case *const *cases,
                     uint32_t count);

/* A result, as soon as it is there. */
void test_view_result(const test_view *view, const lr_case_result *result);

/* The last lines; output is the folder of the candidates. */
void test_view_summary(const test_view *view, const lr_results *results, const char *output);

#endif
