/* Files that are written: checked before the work, and never left half done. */
#ifndef LR_CLI_OUTPUT_H
#define LR_CLI_OUTPUT_H

#include <stdbool.h>

/* Whether path can be written at all, so that a long render does not end in an error that was
 * there from the start. Returns an exit_code, having printed what is wrong. */
int check_writable(const char *path);

/* Whether both paths name the same existing file. */
bool same_file(const char *a, const char *b);

/* Writes text and a newline; a regular file is replaced only when its successor is complete.
 * Returns an exit_code. */
int write_text_file(const char *path, const char *text);

#endif
