#include "cli/frames.h"

#include "cli/output.h"

#include <ctype.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Reads a number up to FRAME_MAX and moves *text behind it. */
static bool parse_frame(const char **text, uint32_t *frame)
{
    char *end;
    if (!isdigit((unsigned char)**text)) {
        return false;
    }
    unsigned long value = strtoul(*text, &end, 10);
    *text = end;
    *frame = (uint32_t)value;
    return value <= FRAME_MAX;
}

bool frames_parse(const char *text, frame_range *range)
{
    if (!parse_frame(&text, &range->first)) {
        return false;
    }
    range->last = range->first;
    if (*text == '-') {
        text++;
        if (!parse_frame(&text, &range->last)) {
            return false;
        }
    }
    return *text == '\0' && range->first <= range->last;
}

/* The number's mark that begins at the percent sign: its length, and how many digits it asks for; 0
 * when it is none. */
static size_t mark_length(const char *at, bool *zeros, int *digits)
{
    const char *c = at + 1;
    *zeros = *c == '0';
    c += *zeros;
    *digits = isdigit((unsigned char)*c) && *c != '0' ? *c++ - '0' : 0;
    return *c == 'd' ? (size_t)(c + 1 - at) : 0;
}

bool frames_named(const char *pattern)
{
    int marks = 0, digits;
    bool zeros;
    for (const char *c = strchr(pattern, '%'); c; c = strchr(c, '%')) {
        size_t length = mark_length(c, &zeros, &digits);
        marks += length > 0;
        if (length == 0 && c[1] != '%') {
            return false;
        }
        c += length ? length : 2;
    }
    return marks == 1;
}

bool frames_path(const char *pattern, uint32_t frame, char *path, size_t size)
{
    size_t used = 0;
    for (const char *c = pattern; *c && used < size;) {
        bool zeros;
        int digits;
        size_t length = *c == '%' ? mark_length(c, &zeros, &digits) : 0;
        if (length) {
            used += (size_t)snprintf(path + used, size - used, zeros ? "%0*u" : "%*u", digits,
                                     (unsigned)frame);
            c += length;
        } else {
            path[used++] = *c;
            c += *c == '%' ? 2 : 1;
        }
    }
    if (used >= size) {
        return false;
    }
    path[used] = '\0';
    return true;
}

int check_frames(const command *self, const char *text, const char *output, lr_format format)
{
    bool to_stdout = strcmp(output, "-") == 0;
    bool floats = format == LR_FORMAT_PFM || format == LR_FORMAT_EXR;
    frame_range range;
    if (!frames_parse(text, &range)) {
        print_error("--frames must be A-B, such as 0-47, from 0 to %d, not '%.100s'; see lavaray "
                    "render --help",
                    FRAME_MAX, text);
        return EXIT_USAGE;
    }
    if (!to_stdout && !frames_named(output)) {
        return wrong_usage(self, "with --frames the output needs one number: -o frame-%04d.png");
    }
    if (to_stdout && floats) {
        return wrong_usage(self, "frames go to standard output as PPM or PNG");
    }
    char path[PATH_MAX];
    if (!frames_path(output, range.last, path, sizeof path) ||
        !frames_path(output, range.first, path, sizeof path)) {
        print_error("%.100s: the path is too long", output);
        return EXIT_FILE;
    }
    return check_writable(path);
}
