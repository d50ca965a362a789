/* Hostile and huge texts: each gets a clear error, in little time and memory. */
#include "scene_tests.h"

/* A growing text for inputs that are made by repetition. */
typedef struct buffer {
    char *text;
    size_t length;
} buffer;

static buffer repeat(const char *before, const char *piece, size_t count, const char *after)
{
    size_t size = strlen(piece);
    buffer b = {malloc(strlen(before) + size * count + strlen(after) + 1), strlen(before)};
    assert_non_null(b.text);
    memcpy(b.text, before, b.length);
    for (size_t i = 0; i < count; i++, b.length += size)
        memcpy(b.text + b.length, piece, size);
    memcpy(b.text + b.length, after, strlen(after) + 1);
    b.length += strlen(after);
    return b;
}

static void expect_in(buffer b, const char *fragment)
{
    char *report = parse_bad(b.text, b.length);
    if (!strstr(report, fragment))
        print_error("expected: %s\ngot:\n%.2000s\n", fragment, report);
    assert_non_null(strstr(report, fragment));
    assert_true(strlen(report) < 100 * 1500);
    free(report);
    free(b.text);
}

static void test_bytes(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        size_t length;
        const char *expected;
    } rows[] = {
        {"", 0, "s.yaml:1:1: the file holds no scene"},
        {"# only\n", 7, "s.yaml:1:1: the file holds no scene"},
        {"- 1\n", 4, "s.yaml:1:1: the scene is a list of 1, expected a mapping"},
        {"5\n", 2, "s.yaml:1:1: the scene is 5, expected a mapping"},
        {"~\n", 2, "s.yaml:1:1: the scene is empty, expected a mapping"},
        {"a: \0b\n", 6, "s.yaml:1:4: a NUL byte, expected text in UTF-8\n    1 | a: \\x00b\n"},
        {"a: \xFF\n", 5, "s.yaml:1:4: byte \\xFF is not UTF-8"},
        {"a: \xC0\x80\n", 6, "s.yaml:1:4: byte \\xC0 is not UTF-8"},
        {"a: \xED\xA0\x80\n", 7, "s.yaml:1:4: byte \\xED is not UTF-8"},
        {"a: \xE2\x82", 5, "s.yaml:1:4: byte \\xE2 is not UTF-8"},
        {"a: \x1B[0m\n", 8, "s.yaml:1:4: control character \\x1B, expected text"},
        {"\xFF\xFE"
         "a\0",
         4, "s.yaml:1:1: byte \\xFF is not UTF-8"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        /* An exact copy, so that a sanitizer sees reads past the end. */
        char *copy = malloc(rows[i].length ? rows[i].length : 1);
        memcpy(copy, rows[i].text, rows[i].length);
        char *report = parse_bad(copy, rows[i].length);
        if (!strstr(report, rows[i].expected))
            print_error("expected: %s\ngot:\n%s\n", rows[i].expected, report);
        assert_non_null(strstr(report, rows[i].expected));
        free(report);
        free(copy);
    }
}

static void test_nesting(void **state)
{
    (void)state;
    const char *expected = "lists and mappings nest more than 128 levels deep";
    expect_in(repeat("", "[", 100000, ""), expected);
    expect_in(repeat("", "{a: ", 100000, ""), expected);
    expect_in(repeat("", "- ", 100000, "x"), expected);
    expect_in(repeat("", "? ", 100000, ""), expected);
    expect_in(repeat("camera: {}\nobjects:\n- ", "group: {objects: [{", 33, ""), "");
    buffer b = repeat("camera: {}\nobjects: [", "group: {objects: [", 33, "sphere: {}");
    b.text = realloc(b.text, b.length + 33 * 2 + 3);
    for (int i = 0; i < 33; i++, b.length += 2)
        memcpy(b.text + b.length, "]}", 3);
    memcpy(b.text + b.length++, "]", 2);
    expect_in(b, "groups nest more than 32 deep");
}

static void test_sizes(void **state)
{
    (void)state;
    expect_in(repeat("a: ", "x", 100000000, ""), "more than the limit of 16777216 (16 MiB)");
    expect_in(repeat("a: ", "x", 16000000, "\n"), "s.yaml:1:1: unknown key \"a\"");
    expect_in(repeat("[", "1,", 7000000, "]"), "more than 500000 commas and brackets on one line");
    expect_in(repeat("", "- 1\n", 1100000, ""), "the scene has more than 1000000 values");
    expect_in(repeat("camera: {}\nobjects:\n", "- sphere: {}\n", 100001, ""),
              "s.yaml:100003:3: more than 100000 objects");
    expect_in(repeat("lights:\n", "- directional: {direction: [0, -1, 0]}\n", 257, ""),
              "257 lights, expected at most 256");
    expect_in(repeat("camera: {}\nobjects:\n- sphere: {radius: ", "1", 300, "}\n"),
              "expected a number from 1e-20 to 1e12");
}

static void test_bombs(void **state)
{
    (void)state;
    const char *text = "a: &a [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n"
                       "b: &b [*a, *a, *a, *a, *a, *a, *a, *a, *a, *a]\n"
                       "c: &c [*b, *b, *b, *b, *b, *b, *b, *b, *b, *b]\n"
                       "d: &d [*c, *c, *c, *c, *c, *c, *c, *c, *c, *c]\n"
                       "e: &e [*d, *d, *d, *d, *d, *d, *d, *d, *d, *d]\n"
                       "f: &f [*e, *e, *e, *e, *e, *e, *e, *e, *e, *e]\n"
                       "g: &g [*f, *f, *f, *f, *f, *f, *f, *f, *f, *f]\n";
    assert_true(reports(text, "s.yaml:6:7: aliases expand this to more than 1000000 values"));
    /* Within the cap on values, over the cap on objects. */
    assert_true(
        reports("camera: {}\nobjects:\n"
                "- group: &a {objects: [{sphere: {}}, {sphere: {}}, {sphere: {}}]}\n"
                "- group: &b {objects: [{group: *a}, {group: *a}, {group: *a}, {group: *a},\n"
                "    {group: *a}, {group: *a}, {group: *a}, {group: *a}, {group: *a}]}\n"
                "- group: &c {objects: [{group: *b}, {group: *b}, {group: *b}, {group: *b},\n"
                "    {group: *b}, {group: *b}, {group: *b}, {group: *b}, {group: *b}]}\n"
                "- group: &d {objects: [{group: *c}, {group: *c}, {group: *c}, {group: *c},\n"
                "    {group: *c}, {group: *c}, {group: *c}, {group: *c}, {group: *c}]}\n"
                "- group: &e {objects: [{group: *d}, {group: *d}, {group: *d}, {group: *d}]}\n"
                "- group: &f {objects: [{group: *e}, {group: *e}, {group: *e}, {group: *e}]}\n"
                "- group: {objects: [{group: *f}, {group: *f}]}\n",
                "more than 100000 objects"));
}

/* libfyaml leaks the text of a quoted scalar of many pieces; a sanitizer watches here. */
static void test_many_pieces(void **state)
{
    (void)state;
    expect_in(repeat("'", "''", 1000, "': 1\n"), "s.yaml:1:1: unknown key \"'''''");
    expect_in(repeat("\"", "\\x41", 1000, "\": 1\n"), "s.yaml:1:1: unknown key \"AAAAA");
}

/* Many names, wrong and right, do not take quadratic time. */
static void test_many_names(void **state)
{
    (void)state;
    size_t size = 3000000, used = 0;
    char *text = malloc(size);
    used += (size_t)snprintf(text, size, "camera: {}\nmaterials:\n");
    for (int i = 0; i < 60000; i++)
        used += (size_t)snprintf(text + used, size - used, "  m%d: {}\n", i);
    used += (size_t)snprintf(text + used, size - used, "objects:\n");
    for (int i = 0; i < 8000; i++)
        used += (size_t)snprintf(text + used, size - used, "- sphere: {material: m%d}\n", i * 8);
    char *report = parse_bad(text, used);
    assert_non_null(strstr(report, "unknown material \"m60000\""));
    assert_non_null(strstr(report, "\n... and 400 more errors\n"));
    free(report);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bytes),       cmocka_unit_test(test_nesting),
        cmocka_unit_test(test_sizes),       cmocka_unit_test(test_bombs),
        cmocka_unit_test(test_many_pieces), cmocka_unit_test(test_many_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
