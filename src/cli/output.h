/* Files that will be written, checked before the work. */
#ifndef LR_CLI_OUTPUT_H
#define LR_CLI_OUTPUT_H

#include <stdbool.h>

/* Whether path can be written at all, so that a long render does not end in an error that was
 * there from the start. Returns an exit_code, having printed what is wrong. */
int check_writable(const char *path);

/* Whether both paths name the same existing file. */
bool same_file(const char *a, const char *b);

#endif
