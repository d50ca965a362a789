/* The errors of one text: gathered by position, written out with the source line. */
#ifndef LR_SCENE_REPORT_H
#define LR_SCENE_REPORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define LR_REPORT_MAX 100 /* errors that are written out; the rest is counted */

typedef struct lr_problem {
    size_t offset; /* in bytes from the start of the text */
    char *message;
} lr_problem;

/* What a text is about, for messages: the scene language, or the settings of test cases. */
typedef struct lr_language {
    const char *subject;  /* "scene" */
    const char *examples; /* keys of the top level: "camera and objects" */
    const char *relief;   /* what to do about one that is too large */
    bool (*knows_key)(const char *name);
} lr_language;

/* The text, its name and language belong to the caller and outlive the report. */
typedef struct lr_report {
    const lr_language *language;
    const char *name;
    const char *text;
    size_t length;
    lr_problem problems[LR_REPORT_MAX];
    uint32_t count;
    uint64_t dropped;
    bool no_memory;   /* a message or another part of the reader could not be allocated */
    bool interrupted; /* the progress callback asked to stop */
} lr_report;

/* Adds an error at a byte offset. The same message at the same place counts once: a node that is
 * reached through several aliases is wrong once. */
void lr_report_add(lr_report *report, size_t offset, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Whether the message of one more error would still be kept; lets callers skip dear suggestions. */
bool lr_report_has_room(const lr_report *report);
bool lr_report_failed(const lr_report *report);

/* All errors in the order of the text, each as `name:line:column: message`, the source line and a
 * caret; the caller frees it. NULL when memory is out. */
char *lr_report_text(lr_report *report);
void lr_report_free(lr_report *report);

/* Writes length bytes of text into buffer, safe to print: control characters and broken UTF-8 as
 * \xNN, and cut with "..." after about 40 characters. Returns buffer. */
#define LR_SHOWN_MAX 200
const char *lr_shown(char buffer[LR_SHOWN_MAX], const char *text, size_t length);

/* The bytes of the well-formed UTF-8 sequence at text, 0 when it is broken. */
size_t lr_utf8_length(const char *text, size_t length);

#endif
