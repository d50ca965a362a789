#ifndef _GNU_SOURCE
#define _GNU_SOURCE /* strtod_l */
#endif
#include "scene/nff_text.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/keys.h"

#define NUMBER_TEXT_MAX 256

static bool is_space(char c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static void find_word(lr_nff_text *text, const char *at, bool leads)
{
    const char *end = text->report->text + text->report->length;
    uint32_t line = text->word.line;
    for (; at < end && (is_space(*at) || *at == '#'); at++) {
        if (*at == '#')
            while (at + 1 < end && at[1] != '\n' && at[1] != '\r')
                at++;
        bool crlf = *at == '\r' && at + 1 < end && at[1] == '\n';
        if (*at == '\n' || (*at == '\r' && !crlf)) {
            line++;
            leads = true;
        }
    }
    const char *begin = at;
    while (at < end && !is_space(*at) && *at != '#')
        at++;
    text->word = (lr_nff_word){begin, (size_t)(at - begin), line, leads};
}

void lr_nff_start(lr_nff_text *text)
{
    const lr_report *report = text->report;
    bool mark = report->length >= 3 && memcmp(report->text, "\xEF\xBB\xBF", 3) == 0;
    text->word.line = 1;
    find_word(text, report->text + (mark ? 3 : 0), true);
}

void lr_nff_step(lr_nff_text *text)
{
    find_word(text, text->word.text + text->word.length, false);
}

bool lr_nff_word_is(const lr_nff_word *word, const char *expected)
{
    return word->length == strlen(expected) && memcmp(word->text, expected, word->length) == 0;
}

bool lr_nff_at_number(const lr_nff_text *text)
{
    const lr_nff_word *word = &text->word;
    return word->length > 0 && (is_digit(*word->text) || strchr("+-.", *word->text) != NULL);
}

void lr_nff_report(lr_nff_text *text, const char *format, ...)
{
    lr_report *report = text->report;
    if (!lr_report_has_room(report)) {
        report->dropped++;
        return;
    }
    char message[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    lr_report_add(report, (size_t)(text->word.text - report->text), "%s", message);
}

/* A decimal number, split: digits * 10^exponent. */
typedef struct decimal {
    uint64_t digits;
    int exponent;
    bool exact; /* all its digits are there, and it needs no more than a double's powers of ten */
    bool negative;
} decimal;

/* False when the word is no decimal number. */
static bool split(const lr_nff_word *word, decimal *d)
{
    const char *c = word->text, *end = c + word->length;
    uint32_t count = 0;
    *d = (decimal){.negative = *c == '-'};
    c += *c == '-' || *c == '+';
    int scale = 0;
    for (bool fraction = false; c < end && (is_digit(*c) || (*c == '.' && !fraction)); c++) {
        if (*c == '.') {
            fraction = true;
            continue;
        }
        d->digits = count < 18 ? d->digits * 10 + (uint64_t)(*c - '0') : d->digits;
        count++;
        scale -= fraction;
    }
    if (count == 0)
        return false;
    int exponent = 0;
    if (c < end && (*c == 'e' || *c == 'E')) {
        bool minus = c + 1 < end && c[1] == '-';
        c += 1 + (c + 1 < end && (c[1] == '-' || c[1] == '+'));
        if (c == end)
            return false;
        for (; c < end && is_digit(*c); c++)
            exponent = exponent < 10000 ? exponent * 10 + (*c - '0') : exponent;
        exponent = minus ? -exponent : exponent;
    }
    d->exponent = exponent + scale;
    d->exact = count <= 18 && d->digits <= (uint64_t)1 << 53 && abs(d->exponent) <= 22;
    return c == end;
}

/* Correctly rounded: digits and powers of ten that doubles hold need a single operation (Clinger,
 * "How to read floating point numbers accurately", 1990); the C library reads all others. */
static bool read_number(const lr_nff_text *text, double *value)
{
    static const double powers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                    1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                    1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    const lr_nff_word *word = &text->word;
    decimal d;
    if (word->length == 0 || word->length >= NUMBER_TEXT_MAX || !split(word, &d))
        return false;
    if (d.exact) {
        double digits = (double)d.digits;
        digits = d.exponent < 0 ? digits / powers[-d.exponent] : digits * powers[d.exponent];
        *value = d.negative && digits != 0 ? -digits : digits; /* -0 means 0 */
        return true;
    }
    char copy[NUMBER_TEXT_MAX];
    memcpy(copy, word->text, word->length);
    copy[word->length] = '\0';
    *value = strtod_l(copy, NULL, text->locale) + 0.0;
    return true;
}

static void report_number(lr_nff_text *text, const char *owner, const lr_nff_number *number,
                          bool is_number)
{
    char shown[LR_SHOWN_MAX], low[32], high[32];
    lr_show_number(number->low, low);
    lr_show_number(number->high, high);
    lr_shown(shown, text->word.text, text->word.length);
    if (text->word.length == 0)
        lr_nff_report(text, "the file ends before the %s of the %s, expected a number",
                      number->name, owner);
    else if (is_number)
        lr_nff_report(text, "the %s of the %s is %s, expected a number from %s to %s", number->name,
                      owner, shown, low, high);
    else
        lr_nff_report(text, "%s stands where the %s of the %s should be, expected a number", shown,
                      number->name, owner);
}

bool lr_nff_read_numbers(lr_nff_text *text, const char *owner, const lr_nff_number *numbers,
                         uint32_t count, double *values)
{
    for (uint32_t i = 0; i < count; i++) {
        bool is_number = read_number(text, &values[i]);
        /* Written so that NaN is out of range. */
        if (!is_number || !(values[i] >= numbers[i].low && values[i] <= numbers[i].high)) {
            report_number(text, owner, &numbers[i], is_number);
            return false;
        }
        lr_nff_step(text);
    }
    return true;
}
