/* tests.yaml: settings for all cases and for single ones. */
#ifndef LR_TESTER_SETTINGS_H
#define LR_TESTER_SETTINGS_H

#include "scene/node.h"
#include "tester/suite.h"

/* One of `cases`. */
typedef struct lr_named_settings {
    const char *name;
    uint32_t offset; /* of the name in the text, for errors that are found later */
    lr_case_settings settings;
} lr_named_settings;

/* Zeroed are the settings of no file. */
typedef struct lr_settings {
    lr_case_settings defaults;
    lr_named_settings *cases; /* in the order of the text */
    uint32_t count, capacity;
    lr_tree tree;
    void **lists; /* allocations of run and args */
    uint32_t list_count, list_capacity;
} lr_settings;

/* Reads the report's text into zeroed settings. What is wrong goes to the report. */
void lr_settings_read(lr_settings *settings, lr_report *report);
void lr_settings_free(lr_settings *settings);

extern const lr_language lr_settings_language;

#endif
