/* Files that will be written, checked before the work. */
#ifndef LR_CLI_OUTPUT_H
#define LR_CLI_OUTPUT_H

#include "cli/cli.h"

#include <stdbool.h>

/* Whether path can be written at all, so that a long render does not end in an error that was
 * there from the start. Returns an exit_code, having printed what is wrong. */
int check_writable(const char *path);

/* Whether both paths name the same existing file. */
bool same_file(const char *a, const char *b);

/* Whether no file would replace another: the picture, and statistics and checkpoint, which may be
 * NULL. Prints what is wrong; returns an exit_code. */
int check_names(const command *self, const char *output, const char *stats, const char *checkpoint,
                const char *scene);

#endif
