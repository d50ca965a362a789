/* A comparison's outcome as text and as JSON. */
#ifndef LR_CLI_COMPARE_REPORT_H
#define LR_CLI_COMPARE_REPORT_H

#include <jansson.h>

#include "compare/compare.h"

/* Several lines on standard output. */
void print_comparison(const lr_compare_result *result, const char *reference, const char *test);

/* NULL when memory is out. */
json_t *comparison_json(const lr_compare_result *result, const char *reference, const char *test);

#endif
