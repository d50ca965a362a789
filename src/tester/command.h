/* The command that makes a case's picture. */
#ifndef LR_TESTER_COMMAND_H
#define LR_TESTER_COMMAND_H

#include "tester/run.h"

typedef struct lr_command {
    char **words; /* NULL behind the last */
    uint32_t count, capacity;
} lr_command;

/* lavaray render for a scene, or the case's own command with {output}, {scene} and {name} filled
 * in. stats is where lavaray render puts its statistics, NULL for none. False when memory is out;
 * the command is then empty. */
bool lr_command_make(lr_command *command, const lr_case *item, const lr_run_options *options,
                     const char *program, const char *output, const char *stats);
void lr_command_free(lr_command *command);

#endif
