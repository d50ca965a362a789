/* Several frames of a scene as several pictures. */
#ifndef LR_CLI_FRAMES_H
#define LR_CLI_FRAMES_H

#include "cli/cli.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define FRAME_MAX 999999

typedef struct frame_range {
    uint32_t first, last;
} frame_range;

/* "A-B", or "A" for a single frame; false when it is neither. */
bool frames_parse(const char *text, frame_range *range);

/* Whether a name holds exactly one %d, %4d or %04d, for the number of the frame, and %% for any
 * other percent sign. */
bool frames_named(const char *pattern);

/* The name of a frame's file; false when it does not fit. `pattern` is as frames_named wants it. */
bool frames_path(const char *pattern, uint32_t frame, char *path, size_t size);

/* Whether --frames TEXT means some, and the first and the last can be written to the output in that
 * format; others can then, too. Prints what is wrong; returns an exit_code. */
int check_frames(const command *self, const char *text, const char *output, lr_format format);

#endif
