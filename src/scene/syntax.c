/* The text before and after libfyaml: what it is not given, and what its syntax errors most likely
 * mean. */
#include "scene/node.h"

#include "scene/keys.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

static bool report_bad_byte(lr_report *report, size_t offset)
{
    unsigned char byte = (unsigned char)report->text[offset];
    if (byte == 0)
        lr_report_add(report, offset, "a NUL byte, expected text in UTF-8");
    else if (byte < 0x80)
        lr_report_add(report, offset, "control character \\x%02X, expected text", byte);
    else
        lr_report_add(report, offset, "byte \\x%02X is not UTF-8, expected text in UTF-8", byte);
    return false;
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t';
}

/* Whether a tab stands between the colon at `offset` and what may begin a block on the same line.
 */
static bool tab_before_block(const lr_report *report, size_t offset)
{
    const char *text = report->text;
    size_t end = offset + 1;
    bool tab = false;
    for (; end < report->length && is_blank(text[end]); end++)
        tab = tab || text[end] == '\t';
    return tab && end < report->length && text[end] && strchr("-?:>|", text[end]);
}

/* Sizes first: nothing below is worth its time for a text that is refused anyway. */
bool lr_text_check(lr_report *report)
{
    if (report->length > LR_TEXT_MAX) {
        lr_report_add(
            report, 0, "the %s text has %zu bytes, more than the limit of %u (16 MiB); %s",
            report->language->subject, report->length, LR_TEXT_MAX, report->language->relief);
        return false;
    }
    const char *text = report->text;
    size_t flow = 0;
    bool explicit_keys = false;
    for (size_t i = 0; i < report->length;) {
        size_t size = lr_utf8_length(text + i, report->length - i);
        unsigned char c = (unsigned char)text[i];
        if (size == 0 || (c < 0x20 && c != '\t' && c != '\n' && c != '\r') || c == 0x7F)
            return report_bad_byte(report, i);
        if (c == '\n')
            flow = 0;
        /* After a key that follows a question mark, such a tab makes libfyaml free memory twice. */
        if (c == '?' && i + 1 < report->length && isspace((unsigned char)text[i + 1]))
            explicit_keys = true;
        if (explicit_keys && c == ':' && tab_before_block(report, i)) {
            lr_report_add(report, i + 1, "a tab after this colon, expected spaces");
            return false;
        }
        /* A flow collection may turn out to be a key until its line ends, so libfyaml keeps all of
         * the line's tokens, at some 400 bytes each. */
        if ((c == ',' || c == '[' || c == '{') && ++flow > LR_FLOW_LINE_MAX) {
            lr_report_add(report, i, "more than %d commas and brackets on one line; break it up",
                          LR_FLOW_LINE_MAX);
            return false;
        }
        i += size;
    }
    return true;
}

/* ---- Likely causes of a syntax error ------------------------------------------------------- */

typedef struct line {
    size_t start, end; /* without the line break */
} line;

static line line_at(const lr_report *report, size_t offset)
{
    line found = {offset, offset};
    while (found.start > 0 && report->text[found.start - 1] != '\n')
        found.start--;
    while (found.end < report->length && report->text[found.end] != '\n')
        found.end++;
    return found;
}

static bool line_before(const lr_report *report, line *at)
{
    if (at->start == 0)
        return false;
    *at = line_at(report, at->start - 1);
    return true;
}

/* libfyaml gives places of errors as line and column; the report takes offsets. */
static size_t offset_of(const lr_report *report, int line_number, int column)
{
    size_t offset = 0;
    for (int i = 1; i < line_number && offset < report->length; offset++)
        if (report->text[offset] == '\n' ||
            (report->text[offset] == '\r' &&
             (offset + 1 == report->length || report->text[offset + 1] != '\n')))
            i++;
    for (int i = 1; i < column && offset < report->length && report->text[offset] != '\n'; i++) {
        size_t size = lr_utf8_length(report->text + offset, report->length - offset);
        offset += size ? size : 1;
    }
    return offset;
}

size_t lr_hex_comment(const lr_report *report, size_t offset, size_t *digits)
{
    const char *text = report->text;
    for (size_t i = offset; i + 1 < report->length && text[i] != '\n'; i++) {
        if (text[i] == '"' || text[i] == '\'')
            return SIZE_MAX;
        if (text[i] != '#' || (i > 0 && text[i - 1] != ' ' && text[i - 1] != '\t'))
            continue;
        size_t count = 0;
        while (i + 1 + count < report->length && isxdigit((unsigned char)text[i + 1 + count]))
            count++;
        char after = i + 1 + count < report->length ? text[i + 1 + count] : ' ';
        *digits = count;
        return (count == 3 || count == 6) && !isalnum((unsigned char)after) ? i : SIZE_MAX;
    }
    return SIZE_MAX;
}

/* An unquoted colour inside brackets: the comment swallows the closing bracket. */
static bool explain_hex_comment(lr_report *report, line at)
{
    for (int i = 0; i < 4; i++) {
        size_t digits;
        size_t hash = lr_hex_comment(report, at.start, &digits);
        size_t before = hash;
        while (hash != SIZE_MAX && before > at.start &&
               (report->text[before - 1] == ' ' || report->text[before - 1] == '\t'))
            before--;
        char previous = hash != SIZE_MAX && before > at.start ? report->text[before - 1] : 0;
        if (previous == ':' || previous == '[' || previous == ',' || previous == '-') {
            lr_report_add(report, hash,
                          "an unquoted # starts a comment, so the rest of this line is lost; "
                          "quote the colour: \"%.*s\"",
                          (int)digits + 1, report->text + hash);
            return true;
        }
        if (!line_before(report, &at))
            return false;
    }
    return false;
}

/* A tab before the first other character; behind it, and in brackets, tabs are allowed. */
static bool explain_tab(lr_report *report, line at)
{
    for (size_t i = at.start; i < at.end; i++) {
        if (report->text[i] == '\t') {
            lr_report_add(report, i, "a tab indents this line, expected spaces");
            return true;
        }
        if (report->text[i] != ' ')
            return false;
    }
    return false;
}

/* `radius:1` at the start of a line, for a key that exists. */
static bool explain_missing_space(lr_report *report, line at)
{
    size_t i = at.start;
    while (i < at.end && (report->text[i] == ' ' || report->text[i] == '-' ||
                          report->text[i] == '{' || report->text[i] == '['))
        i++;
    size_t begin = i;
    while (i < at.end && (isalnum((unsigned char)report->text[i]) || report->text[i] == '_'))
        i++;
    char word[32];
    size_t length = i - begin;
    if (length == 0 || length >= sizeof word || i + 1 >= at.end || report->text[i] != ':' ||
        isspace((unsigned char)report->text[i + 1]))
        return false;
    memcpy(word, report->text + begin, length);
    word[length] = '\0';
    if (!report->language->knows_key(word))
        return false;
    size_t end = i + 1;
    while (end < at.end && end - i < 24 && !isspace((unsigned char)report->text[end]) &&
           report->text[end] != '}')
        end++;
    char shown[LR_SHOWN_MAX];
    lr_report_add(report, i, "no space after the colon, expected \"%s: %s\"", word,
                  lr_shown(shown, report->text + i + 1, end - i - 1));
    return true;
}

/* A dash with nothing behind it, in a list that is not indented: libfyaml refuses it at the line
 * after. */
static bool explain_empty_item(lr_report *report, line at)
{
    while (line_before(report, &at)) {
        size_t i = at.start;
        while (i < at.end && isspace((unsigned char)report->text[i]))
            i++;
        if (i == at.end || report->text[i] == '#')
            continue;
        size_t dash = i++;
        while (i < at.end && isspace((unsigned char)report->text[i]))
            i++;
        if (report->text[dash] != '-' || (i < at.end && report->text[i] != '#'))
            return false;
        lr_report_add(report, dash, "this item is empty, expected a value after the dash");
        return true;
    }
    return false;
}

/* The innermost bracket that is open at the end, by a scan that knows quotes and comments. */
static bool explain_open_bracket(lr_report *report, size_t end)
{
    size_t open[LR_NESTING_MAX];
    uint32_t depth = 0;
    const char *text = report->text;
    for (size_t i = 0; i < end; i++) {
        char previous = i > 0 ? text[i - 1] : ' ';
        bool begins = isspace((unsigned char)previous) || strchr("[{,:-", previous);
        if (text[i] == '#' && isspace((unsigned char)previous)) {
            while (i < end && text[i] != '\n')
                i++;
        } else if ((text[i] == '"' || text[i] == '\'') && begins) {
            char quote = text[i++];
            while (i < end && text[i] != quote)
                i += text[i] == '\\' && quote == '"' ? 2 : 1;
        } else if (text[i] == '[' || text[i] == '{') {
            if (depth == LR_NESTING_MAX)
                return false;
            open[depth++] = i;
        } else if ((text[i] == ']' || text[i] == '}') && depth > 0) {
            char opening = text[open[depth - 1]];
            if ((opening == '[') != (text[i] == ']'))
                break;
            depth--;
        }
    }
    if (depth == 0)
        return false;
    char opening = text[open[depth - 1]];
    lr_report_add(report, open[depth - 1], "this %c is not closed, expected a %c before the end",
                  opening, opening == '[' ? ']' : '}');
    return true;
}

/* libfyaml's words for common mistakes, and ours. */
static const struct {
    const char *theirs, *ours;
} rewordings[] = {
    {"invalid nested block mapping on the same line",
     "a second \": \" on this line; put the text in quotes or the inner key on its own line"},
    {"did not find expected key",
     "this does not line up with the keys above, expected the same indentation or `key: value`"},
    {"invalid value after mapping", "expected `key: value` here, with a space after the colon"},
    {"invalid multiline plain key",
     "expected `key: value` on one line, with a space after the colon"},
    {"wrongly indented", "this does not line up with the lines above, expected their indentation"},
    {"closing quote", "this text has no closing quote"},
    {"could not find expected", "expected `key: value` here, with a space after the colon"},
};

void lr_syntax_error(lr_report *report, int line_number, int column, const char *message)
{
    size_t offset = offset_of(report, line_number, column);
    line at = line_at(report, offset);
    line before = at;
    bool has_before = line_before(report, &before);
    /* Slips that libfyaml reports in many ways, at or below the line that holds them. */
    if (explain_tab(report, at) || explain_hex_comment(report, at) ||
        explain_missing_space(report, at) || (has_before && explain_missing_space(report, before)))
        return;
    bool about_nothing = strstr(message, "expected node content") != NULL;
    if (about_nothing && explain_empty_item(report, at))
        return;
    bool about_brackets = strstr(message, "flow") || strstr(message, "bracket") || about_nothing;
    if (about_brackets && explain_open_bracket(report, report->length))
        return;
    for (size_t i = 0; i < sizeof rewordings / sizeof rewordings[0]; i++) {
        if (strstr(message, rewordings[i].theirs)) {
            lr_report_add(report, offset, "%s", rewordings[i].ours);
            return;
        }
    }
    char shown[LR_SHOWN_MAX * 2];
    snprintf(shown, sizeof shown, "%s", message);
    lr_report_add(report, offset, "not YAML: %s", shown);
}
