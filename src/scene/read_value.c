/* Single values: numbers, booleans, vectors, colours. */
#ifndef _GNU_SOURCE
#define _GNU_SOURCE /* strtod_l */
#endif
#include "scene/read.h"

#include "scene/color.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *lr_node_describe(const lr_node *node, char buffer[LR_SHOWN_MAX + 32])
{
    char shown[LR_SHOWN_MAX];
    switch (node->kind) {
    case LR_NODE_EMPTY:
        return strcpy(buffer, "empty");
    case LR_NODE_PLAIN:
        snprintf(buffer, LR_SHOWN_MAX + 32, "%s", lr_shown(shown, node->text, node->count));
        return buffer;
    case LR_NODE_QUOTED:
        snprintf(buffer, LR_SHOWN_MAX + 32, "the text \"%s\"",
                 lr_shown(shown, node->text, node->count));
        return buffer;
    case LR_NODE_LIST:
        if (node->count == 0)
            return strcpy(buffer, "an empty list");
        snprintf(buffer, LR_SHOWN_MAX + 32, "a list of %u", node->count);
        return buffer;
    case LR_NODE_MAP:
        return strcpy(buffer, "a mapping");
    }
    return buffer;
}

/* `radius:1` as a value: text with a known key before the colon. */
static bool is_missing_space(const lr_reader *reader, const lr_node *node)
{
    const char *colon = node->kind == LR_NODE_PLAIN ? strchr(node->text, ':') : NULL;
    char word[32];
    if (!colon || !colon[1] || (size_t)(colon - node->text) >= sizeof word)
        return false;
    memcpy(word, node->text, (size_t)(colon - node->text));
    word[colon - node->text] = '\0';
    return reader->report->language->knows_key(word);
}

void lr_report_type(lr_reader *reader, const lr_node *node, const char *what, const char *expected)
{
    lr_report *report = reader->report;
    if (!lr_report_has_room(report)) {
        report->dropped++;
        return;
    }
    size_t digits;
    size_t hash =
        node->kind == LR_NODE_EMPTY ? lr_hex_comment(report, node->offset, &digits) : SIZE_MAX;
    char described[LR_SHOWN_MAX + 32];
    if (hash != SIZE_MAX)
        lr_report_add(report, hash,
                      "%s is empty, because an unquoted # starts a comment; quote the colour: "
                      "\"%.*s\"",
                      what, (int)digits + 1, report->text + hash);
    else if (is_missing_space(reader, node))
        lr_report_add(report, node->offset,
                      "%s is the text \"%s\", expected %s; put a space after the colon", what,
                      lr_node_describe(node, described), expected);
    else
        lr_report_add(report, node->offset, "%s is %s, expected %s", what,
                      lr_node_describe(node, described), expected);
}

void lr_report_unknown(lr_reader *reader, const lr_node *node, const char *message,
                       const lr_nearest *nearest)
{
    if (nearest->best)
        lr_report_add(reader->report, node->offset, "%s; did you mean \"%s\"?", message,
                      nearest->best);
    else
        lr_report_add(reader->report, node->offset, "%s", message);
}

/* ---- Numbers ------------------------------------------------------------------------------- */

typedef enum number_form { NOT_A_NUMBER, DECIMAL, OCTAL, HEXADECIMAL, NOT_FINITE } number_form;

static size_t count_digits(const char *text)
{
    return strspn(text, "0123456789");
}

/* The form that the YAML 1.2 core schema gives the text. */
static number_form classify(const char *text)
{
    if (strncmp(text, "0o", 2) == 0 && text[2])
        return strspn(text + 2, "01234567") == strlen(text + 2) ? OCTAL : NOT_A_NUMBER;
    if (strncmp(text, "0x", 2) == 0 && text[2])
        return strspn(text + 2, "0123456789abcdefABCDEF") == strlen(text + 2) ? HEXADECIMAL
                                                                              : NOT_A_NUMBER;
    const char *c = text + (*text == '+' || *text == '-');
    if (!strcmp(c, ".inf") || !strcmp(c, ".Inf") || !strcmp(c, ".INF") || !strcmp(text, ".nan") ||
        !strcmp(text, ".NaN") || !strcmp(text, ".NAN"))
        return NOT_FINITE;
    size_t whole = count_digits(c), fraction = 0;
    c += whole;
    if (*c == '.') {
        fraction = count_digits(++c);
        c += fraction;
    }
    if (whole + fraction == 0)
        return NOT_A_NUMBER;
    if (*c == 'e' || *c == 'E') {
        c++;
        c += *c == '+' || *c == '-';
        size_t exponent = count_digits(c);
        if (exponent == 0)
            return NOT_A_NUMBER;
        c += exponent;
    }
    return *c ? NOT_A_NUMBER : DECIMAL;
}

#define NUMBER_TEXT_MAX 256

/* The number a plain text is; false when it is none. An overflow gives infinity. */
static bool parse_number(const lr_reader *reader, const lr_node *node, double *value)
{
    if (node->count > NUMBER_TEXT_MAX || strlen(node->text) != node->count)
        return false;
    number_form form = classify(node->text);
    if (form == NOT_A_NUMBER)
        return false;
    if (form == NOT_FINITE) {
        *value = INFINITY;
    } else if (form == DECIMAL) {
        *value = strtod_l(node->text, NULL, reader->locale);
    } else {
        int base = form == OCTAL ? 8 : 16;
        *value = 0;
        for (const char *c = node->text + 2; *c; c++)
            *value =
                *value * base + (isdigit((unsigned char)*c) ? *c - '0' : tolower(*c) - 'a' + 10);
    }
    return true;
}

/* Why a text that is meant as a number is none, when that is plain; else NULL. */
static const char *number_advice(const lr_reader *reader, const lr_node *node)
{
    double value;
    if (node->kind == LR_NODE_QUOTED)
        return parse_number(reader, node, &value) ? "remove the quotes" : NULL;
    if (node->count > NUMBER_TEXT_MAX)
        return NULL;
    char stripped[NUMBER_TEXT_MAX + 1];
    size_t length = 0;
    for (const char *c = node->text; *c; c++)
        if (*c != '_')
            stripped[length++] = *c;
    stripped[length] = '\0';
    if (length < node->count && classify(stripped) != NOT_A_NUMBER)
        return "numbers have no underscores in YAML 1.2";
    char *comma = strchr(stripped, ',');
    if (comma) {
        *comma = '.';
        if (classify(stripped) != NOT_A_NUMBER)
            return "decimals begin with a point, not a comma";
    }
    return NULL;
}

bool lr_read_number(lr_reader *reader, const lr_node *node, const lr_field *field, const char *what,
                    double *value)
{
    char expected[LR_EXPECTED_MAX], described[LR_SHOWN_MAX + 32];
    const lr_node *keys = field->type == LR_FIELD_INTEGER ? NULL : lr_keys_of(reader, node);
    if (keys)
        return lr_read_keys(reader, keys, field, what, lr_read_number, 1, value);
    lr_field scalar = *field; /* a component of a vector or colour expects a number */
    if (scalar.type != LR_FIELD_INTEGER)
        scalar.type = LR_FIELD_NUMBER;
    /* Every failure names the key, what stands there, and the range; the type's own message comes
     * before that of the range. */
    double number;
    if (node->kind != LR_NODE_PLAIN || !parse_number(reader, node, &number)) {
        bool text = node->kind == LR_NODE_PLAIN || node->kind == LR_NODE_QUOTED;
        const char *advice = text ? number_advice(reader, node) : NULL;
        lr_field_expected(&scalar, expected);
        if (advice)
            lr_report_add(reader->report, node->offset, "%s is %s, expected %s; %s", what,
                          lr_node_describe(node, described), expected, advice);
        else
            lr_report_type(reader, node, what, expected);
        return false;
    }
    if (!isfinite(number)) {
        lr_report_add(reader->report, node->offset, "%s is %s, which is not finite, expected %s",
                      what, lr_node_describe(node, described),
                      lr_field_expected(&scalar, expected));
        return false;
    }
    bool too_low = number < field->minimum || (field->flags & LR_ABOVE && number <= field->minimum);
    bool too_high =
        number > field->maximum || (field->flags & LR_BELOW && number >= field->maximum);
    bool broken = field->type == LR_FIELD_INTEGER && number != floor(number);
    if (too_low || too_high || broken) {
        lr_report_add(reader->report, node->offset, "%s is %s, expected %s", what,
                      lr_node_describe(node, described), lr_field_expected(&scalar, expected));
        return false;
    }
    *value = number == 0 ? 0 : number; /* -0 means 0 */
    return true;
}

static bool read_boolean(lr_reader *reader, const lr_node *node, const lr_field *field, bool *value)
{
    static const char *const words[] = {"true", "True", "TRUE", "false", "False", "FALSE"};
    if (node->kind == LR_NODE_PLAIN)
        for (int i = 0; i < 6; i++)
            if (strcmp(node->text, words[i]) == 0) {
                *value = i < 3;
                return true;
            }
    /* Booleans of YAML 1.1, which many files still have. */
    static const char *const old[] = {"yes", "no", "on", "off", "y", "n"};
    for (int i = 0; i < 6 && node->kind == LR_NODE_PLAIN; i++)
        if (strcasecmp(node->text, old[i]) == 0) {
            lr_report_add(reader->report, node->offset,
                          "%s is %s, which is only text in YAML 1.2, expected true or false",
                          field->name, node->text);
            return false;
        }
    lr_report_type(reader, node, field->name, "true or false");
    return false;
}

static bool read_choice(lr_reader *reader, const lr_node *node, const lr_field *field,
                        uint32_t *value)
{
    char expected[LR_EXPECTED_MAX];
    lr_field_expected(field, expected);
    if (node->kind == LR_NODE_PLAIN || node->kind == LR_NODE_QUOTED) {
        lr_nearest nearest = {.text = node->text, .length = node->count};
        for (uint32_t i = 0; field->choices[i]; i++) {
            if (strcmp(node->text, field->choices[i]) == 0) {
                *value = i;
                return true;
            }
            lr_nearest_offer(&nearest, field->choices[i]);
        }
        char message[LR_SHOWN_MAX * 2], described[LR_SHOWN_MAX + 32];
        snprintf(message, sizeof message, "%s is %s, expected %s", field->name,
                 lr_node_describe(node, described), expected);
        lr_report_unknown(reader, node, message, &nearest);
        return false;
    }
    lr_report_type(reader, node, field->name, expected);
    return false;
}

static bool read_text(lr_reader *reader, const lr_node *node, const lr_field *field,
                      const char **value)
{
    bool scalar = node->kind == LR_NODE_PLAIN || node->kind == LR_NODE_QUOTED;
    if (!scalar || node->count == 0 || strlen(node->text) != node->count) {
        char expected[LR_EXPECTED_MAX];
        lr_report_type(reader, node, field->name, lr_field_expected(field, expected));
        return false;
    }
    *value = node->text;
    return true;
}

/* Three numbers, named what.x or what[0] in messages by their letter. */
static bool read_triple(lr_reader *reader, const lr_node *node, const lr_field *field,
                        const char *what, const char *letters, lr_vec3 *vector)
{
    char expected[LR_EXPECTED_MAX];
    if (node->kind != LR_NODE_LIST || node->count != 3) {
        lr_report_type(reader, node, what, lr_field_expected(field, expected));
        return false;
    }
    double values[3];
    bool good = true;
    for (int i = 0; i < 3; i++) {
        char name[64];
        snprintf(name, sizeof name, "%c of %s", letters[i], what);
        good &= lr_read_number(reader, node->items[i], field, name, &values[i]);
    }
    if (good)
        *vector = (lr_vec3){values[0], values[1], values[2]};
    return good;
}

static bool read_xyz(lr_reader *reader, const lr_node *node, const lr_field *field,
                     const char *what, double *values)
{
    lr_vec3 read;
    if (!read_triple(reader, node, field, what, "xyz", &read))
        return false;
    memcpy(values, &read, sizeof read);
    return true;
}

/* A triple, or its keys. */
static bool read_moving_xyz(lr_reader *reader, const lr_node *node, const lr_field *field,
                            lr_vec3 *vector)
{
    const lr_node *keys = lr_keys_of(reader, node);
    return keys ? lr_read_keys(reader, keys, field, field->name, read_xyz, 3, &vector->x)
                : read_xyz(reader, node, field, field->name, &vector->x);
}

static bool read_vector(lr_reader *reader, const lr_node *node, const lr_field *field,
                        lr_vec3 *vector)
{
    lr_vec3 read;
    if (!read_moving_xyz(reader, node, field, &read))
        return false;
    bool zero = read.x == 0 && read.y == 0 && read.z == 0;
    if (field->flags & LR_NONZERO && zero) {
        lr_report_add(reader->report, node->offset,
                      "%s is [0, 0, 0], expected a direction, not all 0", field->name);
        return false;
    }
    *vector = read;
    return true;
}

/* Three factors, or one for all. */
static bool read_factors(lr_reader *reader, const lr_node *node, const lr_field *field,
                         const char *what, double *factors)
{
    if (node->kind == LR_NODE_LIST)
        return read_xyz(reader, node, field, what, factors);
    if (node->kind != LR_NODE_PLAIN) {
        char expected[LR_EXPECTED_MAX];
        lr_report_type(reader, node, what, lr_field_expected(field, expected));
        return false;
    }
    if (!lr_read_number(reader, node, field, what, factors))
        return false;
    factors[1] = factors[2] = factors[0];
    return true;
}

static bool read_scale(lr_reader *reader, const lr_node *node, const lr_field *field,
                       lr_vec3 *vector)
{
    lr_vec3 read;
    const lr_node *keys = lr_keys_of(reader, node);
    bool good = keys ? lr_read_keys(reader, keys, field, field->name, read_factors, 3, &read.x)
                     : read_factors(reader, node, field, field->name, &read.x);
    if (!good)
        return false;
    double least = fmin(fabs(read.x), fmin(fabs(read.y), fabs(read.z)));
    if (least < LR_LENGTH_MIN) {
        lr_report_add(reader->report, node->offset,
                      "%s has a factor of 0, which leaves nothing of the object, expected at "
                      "least %g",
                      field->name, LR_LENGTH_MIN);
        return false;
    }
    *vector = read;
    return true;
}

static bool read_rotate(lr_reader *reader, const lr_node *node, const lr_field *field,
                        lr_transform *transform)
{
    if (node->kind == LR_NODE_MAP && !lr_keys_of(reader, node)) {
        lr_rotation_draft draft;
        lr_given given;
        if (!lr_read_record(reader, node, node, &lr_rotation_record, &draft, &given))
            return false;
        *transform = lr_transform_rotate(draft.axis, draft.angle);
        return true;
    }
    lr_vec3 angles;
    if (!read_moving_xyz(reader, node, field, &angles))
        return false;
    /* About x first, so it stands rightmost in the product. */
    lr_transform x = lr_transform_rotate((lr_vec3){1, 0, 0}, angles.x);
    lr_transform y = lr_transform_rotate((lr_vec3){0, 1, 0}, angles.y);
    lr_transform z = lr_transform_rotate((lr_vec3){0, 0, 1}, angles.z);
    *transform = lr_transform_multiply(z, lr_transform_multiply(y, x));
    return true;
}

static bool read_matrix(lr_reader *reader, const lr_node *node, const lr_field *field,
                        lr_transform *matrix)
{
    bool good = node->kind == LR_NODE_LIST && node->count == 3;
    for (int i = 0; good && i < 3; i++)
        good = node->items[i]->kind == LR_NODE_LIST && node->items[i]->count == 4;
    if (!good) {
        char expected[LR_EXPECTED_MAX];
        lr_report_type(reader, node, field->name, lr_field_expected(field, expected));
        return false;
    }
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++) {
            char name[64];
            snprintf(name, sizeof name, "number %d of row %d of %s", j + 1, i + 1, field->name);
            good &= lr_read_number(reader, node->items[i]->items[j], field, name, &matrix->m[i][j]);
        }
    return good;
}

/* ---- Colours ------------------------------------------------------------------------------- */

static bool read_rgb(lr_reader *reader, const lr_node *node, const lr_field *field,
                     const char *what, double *values)
{
    lr_color color;
    if (!lr_read_color(reader, node, field, what, &color))
        return false;
    memcpy(values, &color, sizeof color);
    return true;
}

bool lr_read_color(lr_reader *reader, const lr_node *node, const lr_field *field, const char *what,
                   lr_color *color)
{
    const lr_node *keys = lr_keys_of(reader, node);
    if (keys)
        return lr_read_keys(reader, keys, field, what, read_rgb, 3, &color->x);
    char expected[LR_EXPECTED_MAX], message[LR_SHOWN_MAX * 2 + LR_EXPECTED_MAX];
    char described[LR_SHOWN_MAX + 32];
    lr_field as_color = *field;
    as_color.type = LR_FIELD_COLOR;
    lr_field_expected(&as_color, expected);
    if (node->kind == LR_NODE_LIST)
        return read_triple(reader, node, &as_color, what, "rgb", color);
    if (node->kind != LR_NODE_PLAIN && node->kind != LR_NODE_QUOTED) {
        lr_report_type(reader, node, what, expected);
        return false;
    }
    /* What begins like a number is meant as one and gets a number's messages. */
    const char *text = node->text;
    if (node->kind == LR_NODE_PLAIN && (strchr("+-.", text[0]) || isdigit((unsigned char)*text))) {
        double grey;
        if (!lr_read_number(reader, node, &as_color, what, &grey))
            return false;
        *color = (lr_color){grey, grey, grey};
        return true;
    }
    if (lr_color_from_text(text, node->count, color))
        return true;
    lr_node_describe(node, described);
    if (is_missing_space(reader, node)) {
        lr_report_type(reader, node, what, expected);
        return false;
    }
    if (number_advice(reader, node))
        return lr_read_number(reader, node, &as_color, what, &(double){0});
    if (text[0] == '#')
        snprintf(message, sizeof message, "%s is %s, expected # and 3 or 6 hexadecimal digits",
                 what, described);
    else
        snprintf(message, sizeof message, "%s is %s, expected %s", what, described, expected);
    lr_nearest nearest = {.text = text, .length = node->count};
    lr_color_offer_names(&nearest);
    lr_report_unknown(reader, node, message, &nearest);
    return false;
}

bool lr_read_colors(lr_reader *reader, const lr_node *node, const lr_field *field,
                    lr_color colors[2])
{
    if (node->kind != LR_NODE_LIST || node->count != 2) {
        char expected[LR_EXPECTED_MAX];
        lr_field pair = *field;
        pair.type = LR_FIELD_COLORS;
        lr_report_type(reader, node, field->name, lr_field_expected(&pair, expected));
        return false;
    }
    bool good = true;
    for (int i = 0; i < 2; i++) {
        char what[64];
        snprintf(what, sizeof what, "%s colour of %s", i ? "the second" : "the first", field->name);
        good &= lr_read_color(reader, node->items[i], field, what, &colors[i]);
    }
    return good;
}

bool lr_read_value(lr_reader *reader, const lr_node *node, const lr_field *field, void *out)
{
    double number;
    switch (field->type) {
    case LR_FIELD_NUMBER:
        return lr_read_number(reader, node, field, field->name, out);
    case LR_FIELD_INTEGER:
        if (!lr_read_number(reader, node, field, field->name, &number))
            return false;
        *(uint32_t *)out = number < 0 ? (uint32_t)(int32_t)number : (uint32_t)number;
        return true;
    case LR_FIELD_BOOLEAN:
        return read_boolean(reader, node, field, out);
    case LR_FIELD_CHOICE:
        return read_choice(reader, node, field, out);
    case LR_FIELD_VECTOR:
        return read_vector(reader, node, field, out);
    case LR_FIELD_COLOR:
        return lr_read_color(reader, node, field, field->name, out);
    case LR_FIELD_COLORS:
        return lr_read_colors(reader, node, field, out);
    case LR_FIELD_SCALE:
        return read_scale(reader, node, field, out);
    case LR_FIELD_ROTATE:
        return read_rotate(reader, node, field, out);
    case LR_FIELD_MATRIX:
        return read_matrix(reader, node, field, out);
    case LR_FIELD_TEXT:
        return read_text(reader, node, field, out);
    default:
        return true;
    }
}
