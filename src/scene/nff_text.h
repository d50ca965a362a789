/* The words and numbers of an NFF text. */
#ifndef LR_SCENE_NFF_TEXT_H
#define LR_SCENE_NFF_TEXT_H

#include "scene/report.h"

#include <locale.h>

typedef struct lr_nff_word {
    const char *text;
    size_t length; /* 0 at the end of the text */
    uint32_t line; /* from 1 */
    bool leads;    /* it is the first of its line */
} lr_nff_word;

typedef struct lr_nff_text {
    lr_report *report;
    locale_t locale;  /* "C", whatever the program chose */
    lr_nff_word word; /* the next one */
} lr_nff_text;

/* What a number means in messages, and its range. */
typedef struct lr_nff_number {
    const char *name;
    double low, high;
} lr_nff_number;

/* Puts the text's first word into text->word; report and locale are set. */
void lr_nff_start(lr_nff_text *text);

/* Steps to the next word, over white space and comments. */
void lr_nff_step(lr_nff_text *text);
bool lr_nff_word_is(const lr_nff_word *word, const char *expected);

/* Whether the next word begins as a number does. */
bool lr_nff_at_number(const lr_nff_text *text);

/* Adds an error at the next word. */
void lr_nff_report(lr_nff_text *text, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Reads `count` numbers, which belong to `owner` ("sphere"). False after reporting the first that
 * is missing, none, or out of its range. */
bool lr_nff_read_numbers(lr_nff_text *text, const char *owner, const lr_nff_number *numbers,
                         uint32_t count, double *values);

#endif
