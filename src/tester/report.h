/* Reports on the results of cases: JSON, JUnit's XML, and one HTML page that holds everything. */
#ifndef LR_TESTER_REPORT_H
#define LR_TESTER_REPORT_H

#include "tester/result.h"

#include <time.h>

typedef enum lr_embed {
    LR_EMBED_FAILED, /* the pictures of cases that failed */
    LR_EMBED_ALL
} lr_embed;

typedef struct lr_results {
    const lr_case_result *results;
    uint32_t count;
    const char *title;        /* the folder, as the user called it */
    const char *const *words; /* of the command line that runs the same tests, NULL at the end */
    time_t started;
    double seconds;
    const char *cpu; /* the processor, for people */
} lr_results;

uint32_t lr_results_count(const lr_results *results, lr_outcome outcome);
uint32_t lr_results_failures(const lr_results *results);

/* The command line that runs a case again; with `accept` the one that makes its picture the golden.
 * The caller frees it; NULL when memory is out. */
char *lr_results_command(const lr_results *results, const lr_case_result *result, bool accept);

/* The three reports as text, which the caller frees; NULL when memory is out. */
char *lr_results_json(const lr_results *results);
char *lr_results_junit(const lr_results *results);
char *lr_results_html(const lr_results *results, lr_embed embed);

/* ---- Between the files of the reports ------------------------------------------------------ */

struct json_t;

/* The results as JSON; NULL when memory is out. */
struct json_t *lr_results_object(const lr_results *results);

/* The picture at path for the page: {src, width, height, maxval} and, where browsers do not show
 * the file's own values, {values}; NULL when it cannot be read. */
struct json_t *lr_embed_picture(const char *path);

#endif
