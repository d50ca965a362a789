#include "cli/cli.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NAME_MAX_LENGTH = 40, HELP_COLUMN = 24 };

/* Optimal string alignment distance: insertions, deletions, substitutions and swaps of neighbours
 * cost one each. */
static unsigned edit_distance(const char *a, const char *b)
{
    size_t a_length = strlen(a), b_length = strlen(b);
    if (a_length > NAME_MAX_LENGTH || b_length > NAME_MAX_LENGTH) {
        return UINT_MAX;
    }
    unsigned cost[NAME_MAX_LENGTH + 1][NAME_MAX_LENGTH + 1];
    for (size_t i = 0; i <= a_length; i++) {
        for (size_t j = 0; j <= b_length; j++) {
            if (i == 0 || j == 0) {
                cost[i][j] = (unsigned)(i + j);
                continue;
            }
            unsigned best = cost[i - 1][j - 1] + (a[i - 1] != b[j - 1]);
            unsigned removed = cost[i - 1][j] + 1, inserted = cost[i][j - 1] + 1;
            best = removed < best ? removed : best;
            best = inserted < best ? inserted : best;
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                unsigned swapped = cost[i - 2][j - 2] + 1;
                best = swapped < best ? swapped : best;
            }
            cost[i][j] = best;
        }
    }
    return cost[a_length][b_length];
}

const char *nearest_name(const char *typed, const char *candidate, const char *best,
                         unsigned *distance)
{
    size_t length = strlen(typed);
    unsigned d = edit_distance(typed, candidate);
    if (length >= 2 && strncmp(typed, candidate, length) == 0) {
        d = 1; /* an abbreviation */
    }
    if (d <= 1 + length / 3 && d < *distance) {
        *distance = d;
        return candidate;
    }
    return best;
}

/* Whether text is one of the words of "a|b|c"; length is of text. */
static bool in_list(const char *list, const char *text, size_t length)
{
    while (list && *list) {
        size_t word = strcspn(list, "|");
        if (word == length && strncmp(list, text, length) == 0) {
            return true;
        }
        list += word + (list[word] == '|');
    }
    return false;
}

static parse_result usage_error(const command *self, const char *what, const char *name,
                                const char *rest)
{
    print_error("%s%s%s; see lavaray %s --help", what, name, rest, self->name);
    return PARSE_ERROR;
}

static parse_result unknown_option(const command *self, const char *argument, size_t length)
{
    char typed[NAME_MAX_LENGTH + 1];
    snprintf(typed, sizeof typed, "%.*s", (int)(length < INT_MAX ? length : INT_MAX), argument);
    const char *name = typed + strspn(typed, "-");
    const char *best = NULL;
    unsigned distance = UINT_MAX;
    for (unsigned i = 0; i < self->option_count; i++) {
        const option *o = &self->options[i];
        best = nearest_name(name, o->name, best, &distance);
        for (const char *also = o->also ? o->also : ""; *also;) {
            char word[NAME_MAX_LENGTH];
            int size = (int)strcspn(also, "|");
            snprintf(word, sizeof word, "%.*s", size, also);
            best = nearest_name(name, word, NULL, &distance) ? o->name : best;
            also += size + (also[size] == '|');
        }
    }
    best = best ? best : nearest_name(name, "help", NULL, &distance);
    char rest[NAME_MAX_LENGTH + 40] = "'";
    if (best) {
        snprintf(rest, sizeof rest, "', did you mean --%s?", best);
    }
    return usage_error(self, "unknown flag '", typed, rest);
}

static bool parse_integer(const char *text, const char **end, int64_t min, int64_t max,
                          int64_t *value)
{
    const char *digits = text + (*text == '-');
    if (*digits < '0' || *digits > '9') {
        return false; /* strtoll would take spaces and a plus sign */
    }
    char *stop;
    errno = 0;
    long long parsed = strtoll(text, &stop, 10);
    *end = stop;
    *value = parsed;
    return errno == 0 && parsed >= min && parsed <= max;
}

/* `count` integers with separators[i] behind the i-th; the first two of four may be min - 1. */
static bool parse_integers(const char *text, const char *separators, unsigned count,
                           const int64_t *min, int64_t max, uint32_t *values)
{
    for (unsigned i = 0; i < count; i++) {
        int64_t value;
        if (!parse_integer(text, &text, min[i], max, &value)) {
            return false;
        }
        values[i] = (uint32_t)value;
        if (*text != separators[i]) {
            return false;
        }
        text += *text != '\0';
    }
    return true;
}

bool parse_rectangle(const char *text, int64_t max, option_rectangle *rectangle)
{
    int64_t low[4] = {0, 0, 1, 1};
    uint32_t v[4] = {0};
    bool good = parse_integers(text, ",,,", 4, low, max, v);
    *rectangle = (option_rectangle){v[0], v[1], v[2], v[3]};
    return good;
}

static bool parse_range(const char *text, int64_t min, int64_t max, option_range *range)
{
    int64_t low[2] = {min, min};
    uint32_t ends[2] = {0};
    bool good = strchr(text, '-') ? parse_integers(text, "-", 2, low, max, ends)
                                  : parse_integers(text, "", 1, low, max, ends);
    *range = (option_range){ends[0], strchr(text, '-') ? ends[1] : ends[0], true};
    return good && range->first <= range->last;
}

/* "4096", "512M", "1.5G": bytes, in units of 1024. */
static bool parse_bytes(const char *text, int64_t min, int64_t *bytes)
{
    static const char units[] = "KMGT";
    char *end;
    double value = strtod(text, &end);
    if (end == text || strspn(text, "0123456789.") != (size_t)(end - text))
        return false;
    const char *unit = *end ? strchr(units, *end & ~0x20) : NULL;
    if (*end && (!unit || end[1] != '\0'))
        return false;
    for (long i = unit ? unit - units : -1; i >= 0; i--)
        value *= 1024;
    *bytes = value <= 9e18 ? (int64_t)value : 0;
    return *bytes >= min;
}

/* "500ms", "60s", "1.5m", "2h": seconds. */
static bool parse_duration(const char *text, int64_t max, double *seconds)
{
    static const struct {
        const char *name;
        double seconds;
    } units[] = {{"ms", 1e-3}, {"s", 1}, {"m", 60}, {"min", 60}, {"h", 3600}};
    char *end;
    double value = strtod(text, &end);
    if (end == text || strspn(text, "0123456789.") != (size_t)(end - text)) {
        return false;
    }
    for (size_t i = 0; i < sizeof units / sizeof *units; i++) {
        if (strcmp(end, units[i].name) == 0) {
            *seconds = value * units[i].seconds;
            return *seconds > 0 && *seconds <= (double)max;
        }
    }
    return false;
}

static parse_result store_value(const command *self, const option *o, const char *text,
                                void *values)
{
    char *target = (char *)values + o->offset;
    char expected[200];
    long long min = o->min, max = o->max;
    bool good = false;
    switch (o->kind) {
    case OPTION_FLAG:
        *(bool *)target = true;
        return PARSE_OK;
    case OPTION_TEXT:
        *(const char **)target = text;
        good = *text != '\0';
        snprintf(expected, sizeof expected, "a text that is not empty");
        break;
    case OPTION_REPEATED: {
        option_texts *texts = (option_texts *)target;
        if (texts->count == OPTION_REPEATED_MAX) {
            print_error("--%s is given more than %d times; see lavaray %s --help", o->name,
                        OPTION_REPEATED_MAX, self->name);
            return PARSE_ERROR;
        }
        good = *text != '\0';
        snprintf(expected, sizeof expected, "a text that is not empty");
        texts->items[texts->count++] = text;
        break;
    }
    case OPTION_CHOICE:
        *(const char **)target = text;
        good = in_list(o->choices, text, strlen(text)) && *text != '\0';
        snprintf(expected, sizeof expected, "%s", o->choices);
        break;
    case OPTION_INTEGER: {
        const char *end = text;
        good = parse_integer(text, &end, o->min, o->max, (int64_t *)target) && *end == '\0';
        snprintf(expected, sizeof expected, "a whole number from %lld to %lld", min, max);
        break;
    }
    case OPTION_BYTES:
        good = parse_bytes(text, o->min, (int64_t *)target);
        snprintf(expected, sizeof expected, "a size of at least %lld bytes, such as 512M or 8G",
                 min);
        break;
    case OPTION_DURATION:
        good = parse_duration(text, o->max, (double *)target);
        snprintf(expected, sizeof expected, "a time such as 500ms, 60s, 10m or 2h");
        break;
    case OPTION_REAL: {
        char *end;
        double value = strtod(text, &end);
        bool decimal = strspn(text, "+-.0123456789eE") == strlen(text) && end != text;
        good = decimal && *end == '\0' && value >= (double)o->min && value <= (double)o->max;
        *(double *)target = value;
        snprintf(expected, sizeof expected, "a number from %lld to %lld", min, max);
        break;
    }
    case OPTION_SIZE: {
        int64_t low[2] = {o->min, o->min};
        uint32_t size[2] = {0};
        good = parse_integers(text, "x", 2, low, o->max, size);
        *(option_size *)target = (option_size){size[0], size[1]};
        snprintf(expected, sizeof expected, "%s such as 640x480, each from %lld to %lld", o->value,
                 min, max);
        break;
    }
    case OPTION_POINT: {
        int64_t low[2] = {0, 0};
        uint32_t at[2] = {0};
        good = parse_integers(text, ",", 2, low, o->max, at);
        *(option_point *)target = (option_point){at[0], at[1], true};
        snprintf(expected, sizeof expected, "%s in pixels such as 320,240, each from 0 to %lld",
                 o->value, max);
        break;
    }
    case OPTION_RANGE:
        good = parse_range(text, o->min, o->max, (option_range *)target);
        snprintf(expected, sizeof expected, "%s such as 0-15, from %lld to %lld", o->value, min,
                 max);
        break;
    case OPTION_RECTANGLE:
        good = parse_rectangle(text, o->max, (option_rectangle *)target);
        snprintf(expected, sizeof expected,
                 "%s in pixels such as 10,20,64,48, sizes from %lld to %lld", o->value, min, max);
        break;
    }
    if (!good) {
        print_error("--%s must be %s, not '%.100s'; see lavaray %s --help", o->name, expected, text,
                    self->name);
        return PARSE_ERROR;
    }
    return PARSE_OK;
}

/* The option that argument names, NULL for none. *value is what is attached to it (behind "=" or
 * directly behind a letter) or NULL; *length is the length of the name as typed. */
static const option *find_option(const command *self, const char *argument, const char **value,
                                 size_t *length)
{
    bool is_long = argument[1] == '-';
    const char *name = argument + (is_long ? 2 : 1);
    size_t name_length = is_long ? strcspn(name, "=") : 1;
    *length = (size_t)(name - argument) + name_length;
    *value = NULL;
    if (argument[*length] != '\0') {
        *value = argument + *length + (argument[*length] == '=');
    }
    for (unsigned i = 0; i < self->option_count; i++) {
        const option *o = &self->options[i];
        bool same = is_long ? in_list(o->name, name, name_length) : o->letter == *name;
        if (same && *name) {
            return o;
        }
    }
    return NULL;
}

static parse_result check_operands(const command *self, int count, char **operands)
{
    bool scenes = strncmp(self->operands, "SCENE", 5) == 0;
    if (count < self->min_operands && self->min_operands == 1 && scenes) {
        return usage_error(self, "no scene given", "", "");
    }
    if (count < self->min_operands) {
        return usage_error(self, "expected ", self->operands, "");
    }
    if (self->max_operands == 0 && count > 0) {
        return usage_error(self, "unexpected '", operands[0], "'");
    }
    if (count > self->max_operands && self->max_operands > 1) {
        return usage_error(self, "'", operands[self->max_operands], "' is one too many");
    }
    if (count > self->max_operands) {
        return usage_error(self, "one scene at a time, '", operands[self->max_operands],
                           "' is one too many");
    }
    return PARSE_OK;
}

parse_result options_parse(const command *self, int argc, char **argv, void *values,
                           int *operand_count)
{
    uint64_t seen = 0;
    int operands = 0;
    bool only_operands = false;
    for (int i = 0; i < argc; i++) {
        char *argument = argv[i];
        if (only_operands || argument[0] != '-' || argument[1] == '\0') {
            argv[operands++] = argument;
            continue;
        }
        if (strcmp(argument, "--") == 0) {
            only_operands = true;
            continue;
        }
        if (strcmp(argument, "--help") == 0 || strcmp(argument, "-h") == 0) {
            options_print_help(self);
            return PARSE_HELP;
        }
        const char *value;
        size_t length;
        const option *o = find_option(self, argument, &value, &length);
        if (!o) {
            return unknown_option(self, argument, argument[1] == '-' ? length : strlen(argument));
        }
        uint64_t bit = UINT64_C(1) << (o - self->options);
        if (seen & bit && o->kind != OPTION_REPEATED) {
            return usage_error(self, "--", o->name, " is given twice");
        }
        seen |= bit;
        if (o->kind == OPTION_FLAG) {
            if (value) {
                return usage_error(self, "--", o->name, " takes no value");
            }
        } else if (!value) {
            /* "-o --spp 4" is a forgotten value; "--output=--spp" still says the odd name. */
            if (i + 1 == argc || strncmp(argv[i + 1], "--", 2) == 0) {
                return usage_error(self, "--", o->name, " needs a value");
            }
            value = argv[++i];
        }
        if (store_value(self, o, value, values) != PARSE_OK) {
            return PARSE_ERROR;
        }
    }
    *operand_count = operands;
    return check_operands(self, operands, argv);
}

static void print_option(const option *o)
{
    char left[80];
    snprintf(left, sizeof left, "%c%c%s --%s%s%s", o->letter ? '-' : ' ',
             o->letter ? o->letter : ' ', o->letter ? "," : " ", o->name, o->value ? " " : "",
             o->value ? o->value : "");
    if (strlen(left) + 2 > HELP_COLUMN) {
        printf("  %s\n  %*s", left, HELP_COLUMN, "");
    } else {
        printf("  %-*s", HELP_COLUMN, left);
    }
    for (const char *c = o->help; *c; c++) {
        putchar(*c);
        if (*c == '\n') {
            printf("  %*s", HELP_COLUMN, "");
        }
    }
    putchar('\n');
}

void options_print_help(const command *self)
{
    printf("Usage: lavaray %s%s%s%s\n\n%s\n", self->name, *self->operands ? " " : "",
           self->operands, self->option_count ? " [FLAGS]" : "", self->details);
    bool tests = false;
    printf("\nFlags, in any order:\n");
    for (unsigned i = 0; i < self->option_count; i++) {
        if (self->options[i].for_tests) {
            tests = true;
        } else {
            print_option(&self->options[i]);
        }
    }
    printf("  %-*s%s\n", HELP_COLUMN, "-h, --help", "print this text");
    if (*self->examples) {
        printf("\nExamples:\n%s\n", self->examples);
    }
    if (tests) {
        printf("\nFor tests: the picture does not depend on these:\n");
        for (unsigned i = 0; i < self->option_count; i++) {
            if (self->options[i].for_tests) {
                print_option(&self->options[i]);
            }
        }
    }
}
