/* Texts for people, shells and files. All are the caller's to free, and NULL when memory is out. */
#ifndef LR_TESTER_TEXT_H
#define LR_TESTER_TEXT_H

#include <stddef.h>

/* What printf makes of it. */
char *lr_format_text(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* A copy that is UTF-8 and safe to print: broken sequences and control characters other than line
 * breaks and tabs become question marks, and a terminal's colours are left out. */
char *lr_clean_text(const char *text, size_t length);

/* The words (NULL behind the last) as a POSIX shell takes them. */
char *lr_shell_text(const char *const *words);

char *lr_base64(const unsigned char *bytes, size_t size);

#endif
