/* Several frames of a scene as several pictures. */
#ifndef LR_CLI_FRAMES_H
#define LR_CLI_FRAMES_H

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

#endif
