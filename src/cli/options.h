/* Command lines: one table per command says which flags it takes, and gives the parser, the error
 * messages and the help text. */
#ifndef LR_CLI_OPTIONS_H
#define LR_CLI_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cli/exit_codes.h"

struct command;

typedef enum option_kind {
    OPTION_FLAG,      /* bool, true when given */
    OPTION_TEXT,      /* const char * */
    OPTION_INTEGER,   /* int64_t within min..max */
    OPTION_REAL,      /* double within min..max */
    OPTION_SIZE,      /* option_size, each within min..max: 640x480 */
    OPTION_POINT,     /* option_point, each at most max: 320,240 */
    OPTION_RECTANGLE, /* option_rectangle, each within min..max: 10,20,64,48 */
    OPTION_RANGE,     /* option_range, each within min..max: 0-15, or one number */
    OPTION_CHOICE,    /* const char *, one of choices */
    OPTION_BYTES,     /* int64_t, at least min: 512M, 1.5G, 4096 */
    OPTION_DURATION,  /* double, seconds, up to max: 500ms, 60s, 10m, 2h */
    OPTION_REPEATED,  /* option_texts: a text, any number of times up to OPTION_REPEATED_MAX */
} option_kind;

typedef struct option_size {
    uint32_t width, height;
} option_size;

typedef struct option_point {
    uint32_t x, y;
    bool given;
} option_point;

typedef struct option_rectangle {
    uint32_t x, y, width, height;
} option_rectangle;

typedef struct option_range {
    uint32_t first, last; /* last >= first */
    bool given;
} option_range;

enum { OPTION_REPEATED_MAX = 64 };

typedef struct option_texts {
    const char *items[OPTION_REPEATED_MAX];
    unsigned count;
} option_texts;

typedef struct option {
    const char *name; /* without the dashes */
    char letter;      /* short form, 0 for none */
    option_kind kind;
    size_t offset;       /* of the value in the command's own struct, which holds the defaults */
    const char *value;   /* what stands for the value in help, such as "N" */
    const char *help;    /* may hold several lines */
    int64_t min, max;    /* OPTION_INTEGER, OPTION_REAL, OPTION_SIZE, ..._POINT, ..._RECTANGLE,
                            ..._RANGE */
    const char *choices; /* OPTION_CHOICE: "srgb|linear" */
    const char *also;    /* other names people try, "a|b": suggested, not accepted */
    bool for_tests;      /* listed last in help */
} option;

/* But for PARSE_OK they are exit codes. */
typedef enum parse_result {
    PARSE_OK = -1,
    PARSE_HELP = EXIT_FINE,
    PARSE_ERROR = EXIT_USAGE,
} parse_result;

/* Parses the arguments behind the command's name into values. The operands are moved to the front
 * of argv and counted in *operand_count. PARSE_HELP: --help was given and printed. PARSE_ERROR: one
 * line was printed. */
parse_result options_parse(const struct command *self, int argc, char **argv, void *values,
                           int *operand_count);

void options_print_help(const struct command *self);

/* "X,Y,W,H", each size at least 1, everything at most max. */
bool parse_rectangle(const char *text, int64_t max, option_rectangle *rectangle);

/* The name that is nearest to a mistyped one, NULL when none is near. best starts as NULL and
 * *distance as UINT_MAX; call it for each candidate and pass its result on. */
const char *nearest_name(const char *typed, const char *candidate, const char *best,
                         unsigned *distance);

#endif
