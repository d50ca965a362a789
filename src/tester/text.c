#ifndef _GNU_SOURCE
#define _GNU_SOURCE /* vasprintf */
#endif
#include "tester/text.h"

#include "base/memory.h"
#include "scene/report.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

char *lr_format_text(const char *format, ...)
{
    char *text = NULL;
    va_list arguments;
    va_start(arguments, format);
    int length = vasprintf(&text, format, arguments);
    va_end(arguments);
    return length < 0 ? NULL : text;
}

static bool is_printable(const unsigned char *c, size_t size)
{
    if (size == 1)
        return (c[0] >= 0x20 && c[0] != 0x7F) || c[0] == '\n' || c[0] == '\t';
    bool control = c[0] == 0xC2 && c[1] < 0xA0;
    bool none = size == 3 && c[0] == 0xEF && c[1] == 0xBF && c[2] >= 0xBE; /* U+FFFE, U+FFFF */
    return size > 1 && !control && !none;
}

/* The length of a terminal's control sequence at text, such as that of a colour; 0: it is none. */
static size_t escape_length(const char *text, size_t length)
{
    if (length < 3 || text[0] != 0x1B || text[1] != '[')
        return 0;
    size_t i = 2;
    while (i < length && text[i] >= 0x20 && text[i] < 0x40)
        i++;
    return i < length && text[i] >= 0x40 && text[i] < 0x7F ? i + 1 : 0;
}

char *lr_clean_text(const char *text, size_t length)
{
    char *clean = lr_alloc(length + 1, 1);
    size_t used = 0;
    for (size_t i = 0; clean && i < length;) {
        size_t size = escape_length(text + i, length - i);
        if (size) {
            i += size;
            continue;
        }
        size = lr_utf8_length(text + i, length - i);
        if (is_printable((const unsigned char *)text + i, size)) {
            memcpy(clean + used, text + i, size);
            used += size;
        } else {
            clean[used++] = '?';
        }
        i += size ? size : 1;
    }
    return clean;
}

char *lr_shell_text(const char *const *words)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                "_-./=:,+@%";
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out)
        return NULL;
    for (size_t i = 0; words[i]; i++) {
        fputs(i ? " " : "", out);
        if (words[i][0] && strspn(words[i], plain) == strlen(words[i])) {
            fputs(words[i], out);
            continue;
        }
        fputc('\'', out);
        for (const char *c = words[i]; *c; c++)
            if (*c == '\'')
                fputs("'\\''", out);
            else
                fputc(*c, out);
        fputc('\'', out);
    }
    if (fclose(out) == 0)
        return text;
    free(text);
    return NULL;
}

char *lr_base64(const unsigned char *bytes, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    char *text = size < SIZE_MAX / 2 ? lr_alloc((size + 2) / 3 * 4 + 1, 1) : NULL;
    char *out = text;
    for (size_t i = 0; text && i < size; i += 3) {
        size_t left = size - i;
        unsigned group = (unsigned)bytes[i] << 16 | (left > 1 ? (unsigned)bytes[i + 1] << 8 : 0) |
                         (left > 2 ? bytes[i + 2] : 0);
        *out++ = digits[group >> 18];
        *out++ = digits[group >> 12 & 63];
        *out++ = left > 1 ? digits[group >> 6 & 63] : '=';
        *out++ = left > 2 ? digits[group & 63] : '=';
    }
    return text;
}
