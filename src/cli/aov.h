/* The layers that a render writes beside its picture: --aov. */
#ifndef LR_CLI_AOV_H
#define LR_CLI_AOV_H

#include "cli/cli.h"

/* Reads "albedo,normal", "all": a bit 1 << lr_aov for each. Returns an exit_code, having printed
 * what is wrong. */
int parse_aovs(const command *self, const char *text, uint32_t *wanted);

#endif
