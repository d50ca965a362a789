#include "scene/report.h"

#include "base/memory.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define EXCERPT_COLUMNS 100
#define TAB_COLUMNS 4

bool lr_report_has_room(const lr_report *report)
{
    return report->count < LR_REPORT_MAX;
}

bool lr_report_failed(const lr_report *report)
{
    return report->count > 0 || report->no_memory || report->interrupted;
}

void lr_report_add(lr_report *report, size_t offset, const char *format, ...)
{
    if (!lr_report_has_room(report)) {
        report->dropped++;
        return;
    }
    char message[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    if (offset > report->length)
        offset = report->length;
    for (uint32_t i = 0; i < report->count; i++)
        if (report->problems[i].offset == offset &&
            strcmp(report->problems[i].message, message) == 0)
            return;
    char *copy = lr_string_copy(message, strlen(message));
    if (!copy) {
        report->no_memory = true;
        return;
    }
    report->problems[report->count++] = (lr_problem){offset, copy};
}

void lr_report_free(lr_report *report)
{
    for (uint32_t i = 0; i < report->count; i++)
        free(report->problems[i].message);
    report->count = 0;
}

size_t lr_utf8_length(const char *text, size_t length)
{
    const unsigned char *c = (const unsigned char *)text;
    if (length == 0)
        return 0;
    if (c[0] < 0x80)
        return 1;
    size_t size = c[0] >= 0xF0 ? 4 : c[0] >= 0xE0 ? 3 : 2;
    if (c[0] < 0xC2 || c[0] > 0xF4 || length < size)
        return 0;
    for (size_t i = 1; i < size; i++)
        if ((c[i] & 0xC0) != 0x80)
            return 0;
    /* Overlong forms, surrogates and code points above U+10FFFF. */
    if ((c[0] == 0xE0 && c[1] < 0xA0) || (c[0] == 0xED && c[1] > 0x9F) ||
        (c[0] == 0xF0 && c[1] < 0x90) || (c[0] == 0xF4 && c[1] > 0x8F))
        return 0;
    return size;
}

/* One character as it may be printed, 1 to 4 columns wide. Advances *position. */
static int show_character(char out[8], const char *text, size_t length, size_t *position)
{
    unsigned char first = (unsigned char)text[*position];
    size_t size = lr_utf8_length(text + *position, length - *position);
    bool c1_control = size == 2 && first == 0xC2 && (unsigned char)text[*position + 1] < 0xA0;
    /* Escape sequences in a scene must not reach a terminal. */
    if (size == 0 || first < 0x20 || first == 0x7F || c1_control) {
        snprintf(out, 8, "\\x%02X", first);
        *position += 1;
        return 4;
    }
    memcpy(out, text + *position, size);
    out[size] = '\0';
    *position += size;
    return 1;
}

const char *lr_shown(char buffer[LR_SHOWN_MAX], const char *text, size_t length)
{
    size_t used = 0, position = 0;
    int columns = 0;
    while (position < length && columns < 40) {
        char piece[8];
        columns += show_character(piece, text, length, &position);
        size_t size = strlen(piece);
        memcpy(buffer + used, piece, size);
        used += size;
    }
    memcpy(buffer + used, position < length ? "..." : "", position < length ? 4 : 1);
    return buffer;
}

static bool is_break(char c)
{
    return c == '\n' || c == '\r';
}

static bool is_continuation(char c)
{
    return ((unsigned char)c & 0xC0) == 0x80;
}

/* By place; at one place by text, so that the order does not depend on qsort. */
static int compare_problems(const void *a, const void *b)
{
    const lr_problem *left = a, *right = b;
    if (left->offset != right->offset)
        return left->offset < right->offset ? -1 : 1;
    return strcmp(left->message, right->message);
}

/* Where a problem stands; moved forward only, so that a long text is scanned once. */
typedef struct cursor {
    size_t offset, line_start;
    uint32_t line, column; /* from 1; column in characters */
} cursor;

static void cursor_advance(cursor *at, const lr_report *report, size_t offset)
{
    for (; at->offset < offset; at->offset++) {
        char c = report->text[at->offset];
        bool crlf =
            c == '\r' && at->offset + 1 < report->length && report->text[at->offset + 1] == '\n';
        if (is_break(c) && !crlf) {
            at->line++;
            at->column = 1;
            at->line_start = at->offset + 1;
        } else if (!is_continuation(c)) {
            at->column++;
        }
    }
}

/* The source line and the caret below it, cut to EXCERPT_COLUMNS around the caret. */
static void write_excerpt(FILE *out, const lr_report *report, const cursor *at)
{
    size_t begin = at->line_start;
    if (at->offset - begin > EXCERPT_COLUMNS * 2 / 3) {
        begin = at->offset - EXCERPT_COLUMNS * 2 / 3 + 8;
        while (begin < at->offset && is_continuation(report->text[begin]))
            begin++;
    }
    const char *left = begin > at->line_start ? "..." : "";
    fprintf(out, "%5u | %s", at->line, left);
    int columns = (int)strlen(left), caret = -1;
    size_t position = begin;
    while (position < report->length && !is_break(report->text[position]) &&
           columns < EXCERPT_COLUMNS) {
        if (position >= at->offset && caret < 0)
            caret = columns;
        if (report->text[position] == '\t') {
            int width = TAB_COLUMNS - columns % TAB_COLUMNS;
            fprintf(out, "%*s", width, "");
            columns += width;
            position++;
            continue;
        }
        char piece[8];
        columns += show_character(piece, report->text, report->length, &position);
        fputs(piece, out);
    }
    bool cut = position < report->length && !is_break(report->text[position]);
    if (caret < 0)
        caret = columns;
    fprintf(out, "%s\n      | %*s^\n", cut ? "..." : "", caret, "");
}

char *lr_report_text(lr_report *report)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out)
        return NULL;
    qsort(report->problems, report->count, sizeof report->problems[0], compare_problems);
    /* A byte order mark is not a column. */
    bool mark = report->length >= 3 && memcmp(report->text, "\xEF\xBB\xBF", 3) == 0;
    cursor at = {.offset = mark ? 3 : 0, .line_start = mark ? 3 : 0, .line = 1, .column = 1};
    for (uint32_t i = 0; i < report->count; i++) {
        cursor_advance(&at, report, report->problems[i].offset);
        fprintf(out, "%s:%u:%u: %s\n", report->name, at.line, at.column,
                report->problems[i].message);
        write_excerpt(out, report, &at);
    }
    if (report->dropped)
        fprintf(out, "... and %llu more errors\n", (unsigned long long)report->dropped);
    if (fclose(out) != 0) {
        free(text);
        return NULL;
    }
    return text;
}
