/* Test cases: what is in a folder of scenes and goldens, or in two folders of pictures, and what
 * tests.yaml says about it. docs/test.md describes the layout. */
#ifndef LR_TESTER_SUITE_H
#define LR_TESTER_SUITE_H

#include "compare/compare.h"

/* How a case makes its picture and how that is compared. Texts live as long as the suite. */
typedef struct lr_case_settings {
    const char *scene;  /* as given, relative to the suite's folder; NULL: the one of its name */
    const char *size;   /* "640x480"; NULL: as the scene says */
    const char *device; /* NULL: the tester's default */
    const char *mask;   /* relative to the suite's folder, NULL: none */
    uint32_t format;    /* index in lr_test_formats */
    uint32_t samples, depth, seed;
    bool has_run, has_format, has_samples, has_depth, has_seed;
    double timeout;          /* seconds; 0: the tester's default */
    const char *const *run;  /* the command that makes the picture; NULL: lavaray render */
    const char *const *args; /* more flags for lavaray render */
    uint32_t run_count, args_count;
    lr_compare_options compare; /* without its pictures */
} lr_case_settings;

/* The endings of goldens, without the dot; NULL behind the last. */
extern const char *const lr_test_formats[];

typedef struct lr_case {
    char *name;
    char *scene;     /* path; NULL: none */
    char *golden;    /* path of the golden, whether it exists or not */
    char *candidate; /* path of a picture that is there already; NULL: a command makes it */
    char *mask;      /* path, NULL: none */
    lr_case_settings settings;
} lr_case;

typedef struct lr_suite_desc {
    const char *folder;    /* of scenes and goldens, or ... */
    const char *reference; /* ... two folders of pictures */
    const char *candidate;
    const char *settings; /* NULL: tests.yaml of `folder`, or of `reference`, if there is one */
} lr_suite_desc;

typedef struct lr_suite {
    const char *folder; /* what paths in the settings are relative to */
    lr_case *cases;     /* by name */
    uint32_t count;
    char **orphans; /* paths of goldens that belong to no case */
    uint32_t orphan_count;
    struct lr_suite_store *store; /* what the settings point into */
} lr_suite;

/* Finds all cases. On LR_ERROR_SCENE *report tells what is wrong with the settings, as that of
 * lr_scene_load; the caller frees it. Texts of the descriptor outlive the suite. */
lr_status lr_suite_load(const lr_suite_desc *desc, lr_suite **suite, char **report,
                        lr_error *error);
void lr_suite_free(lr_suite *suite);

/* Whether the pattern selects the case: it is the name, or when no case has it as its name, a glob
 * if it holds * ? or [, else a part of the name. */
bool lr_suite_selects(const lr_suite *suite, const lr_case *item, const char *pattern);

#endif
