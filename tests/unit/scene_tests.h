/* Shared by the tests of the scene language. */
#ifndef LR_SCENE_TESTS_H
#define LR_SCENE_TESTS_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "scene/scene.h"

/* cmocka 1.1.5 compares floats only. */
#define assert_near(value, expected, tolerance)                                                    \
    do {                                                                                           \
        double value_ = (value), expected_ = (expected);                                           \
        if (!(fabs(value_ - expected_) <= (tolerance)))                                            \
            fail_msg("%s is %.17g, expected %.17g", #value, value_, expected_);                    \
    } while (0)

/* Parses text that must be a scene; prints the report when it is not. */
static inline lr_scene *parse_good(const char *text)
{
    lr_scene *scene = NULL;
    char *report = NULL;
    lr_error error = {0};
    lr_status status = lr_scene_parse(text, strlen(text), "s.yaml", &scene, &report, &error);
    if (status != LR_OK)
        print_error("%s\n%s\n", error.message, report ? report : "");
    free(report);
    assert_int_equal(status, LR_OK);
    assert_non_null(scene);
    return scene;
}

/* Parses text that must not be a scene and returns the report. Not inlined, because gcc 12 would
 * then warn of a dangling pointer that there is not. */
__attribute__((noinline, unused)) static char *parse_bad(const char *text, size_t length)
{
    lr_scene *scene = NULL;
    char *report = NULL;
    lr_error error = {0};
    lr_status status = lr_scene_parse(text, length, "s.yaml", &scene, &report, &error);
    if (status != LR_ERROR_SCENE)
        print_error("accepted: %.200s\n", text);
    assert_int_equal(status, LR_ERROR_SCENE);
    assert_int_equal(error.status, LR_ERROR_SCENE);
    assert_null(scene);
    assert_non_null(report);
    return report;
}

/* Whether the report about the text holds the fragment; prints both when it does not. */
static inline bool reports(const char *text, const char *fragment)
{
    char *report = parse_bad(text, strlen(text));
    bool found = strstr(report, fragment) != NULL;
    if (!found)
        print_error("for:\n%s\nexpected: %s\ngot:\n%s\n", text, fragment, report);
    free(report);
    return found;
}

#endif
