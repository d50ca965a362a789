#include "cli/test_view.h"

#include "cli/cli.h"
#include "tester/text.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { NAME_WIDTH_MIN = 16, NAME_WIDTH_MAX = 40, INDENT = 9 };

#define RED "1;31"
#define GREEN "32"
#define YELLOW "33"
#define GREY "2"

void test_view_start(test_view *view, bool to_stderr, bool quiet, const lr_case *const *cases,
                     uint32_t count)
{
    *view = (test_view){.out = to_stderr ? stderr : stdout, .quiet = quiet};
    view->color = stream_has_color(to_stderr ? STDERR_FILENO : STDOUT_FILENO);
    view->name_width = NAME_WIDTH_MIN;
    for (uint32_t i = 0; i < count; i++) {
        size_t length = strlen(cases[i]->name);
        if (length > (size_t)view->name_width && length <= NAME_WIDTH_MAX) {
            view->name_width = (int)length;
        }
    }
}

static void put(const test_view *view, const char *color, const char *text)
{
    if (view->color) {
        fprintf(view->out, "\033[%sm%s\033[0m", color, text);
    } else {
        fputs(text, view->out);
    }
}

static const char *color_of(lr_outcome outcome)
{
    return lr_outcome_failed(outcome)      ? RED
           : outcome == LR_OUTCOME_PASSED  ? GREEN
           : outcome == LR_OUTCOME_NOT_RUN ? GREY
                                           : YELLOW;
}

static void print_line(const test_view *view, const char *label, const char *text)
{
    char *clean = text && *text ? lr_clean_text(text, strlen(text)) : NULL;
    if (clean) {
        fprintf(view->out, "%*s%s%s\n", INDENT, "", label, clean);
    }
    free(clean);
}

/* Several lines, each behind a bar. */
static void print_output(const test_view *view, const char *text)
{
    while (text && *text) {
        size_t length = strcspn(text, "\n");
        fprintf(view->out, "%*s| %.*s\n", INDENT, "", (int)length, text);
        text += length + (text[length] == '\n');
    }
}

void test_view_result(const test_view *view, const lr_case_result *r)
{
    bool failed = lr_outcome_failed(r->outcome);
    if (view->quiet && !failed) {
        return;
    }
    const char *outcome = lr_outcome_name(r->outcome);
    char *name = lr_clean_text(r->item->name, strlen(r->item->name));
    put(view, color_of(r->outcome), outcome);
    fprintf(view->out, "%*s%-*s %6.2f s\n", INDENT - (int)strlen(outcome), "", view->name_width,
            name ? name : "", r->seconds);
    free(name);
    if (failed) {
        print_line(view, "", r->message);
        print_line(view, "", r->cause);
        print_line(view, "", r->staleness);
        if (r->outcome == LR_OUTCOME_BROKEN) {
            print_line(view, "command     ", r->command);
            print_output(view, r->output);
        }
        print_line(view, "golden      ", r->outcome == LR_OUTCOME_DIFFERS ? r->item->golden : NULL);
        print_line(view, "candidate   ", r->candidate);
        print_line(view, "difference  ", r->difference);
    }
    fflush(view->out);
}

static void print_accept(const test_view *view, const lr_results *results, const char *output)
{
    const lr_case_result *first = NULL;
    for (uint32_t i = 0; i < results->count && !first; i++) {
        const lr_case_result *r = &results->results[i];
        first = lr_outcome_failed(r->outcome) && r->readable ? r : NULL;
    }
    if (!first) {
        return;
    }
    char *accept = lr_results_command(results, first, true);
    if (!first->item->candidate) {
        fprintf(view->out, "the candidates are in %s; to accept one that is right:\n", output);
    } else {
        fprintf(view->out, "to make a candidate that is right the reference:\n");
    }
    fprintf(view->out, "  %s\n", accept ? accept : "");
    free(accept);
    if (lr_results_count(results, LR_OUTCOME_MISSING) > 1) {
        char *all = lr_shell_text(results->words);
        fprintf(view->out, "or all that are missing:\n  %s --update-missing\n", all ? all : "");
        free(all);
    }
}

void test_view_summary(const test_view *view, const lr_results *results, const char *output)
{
    /* What needs a look comes last, next to the prompt. */
    static const lr_outcome order[] = {LR_OUTCOME_PASSED,  LR_OUTCOME_UPDATED, LR_OUTCOME_ADDED,
                                       LR_OUTCOME_NOT_RUN, LR_OUTCOME_MISSING, LR_OUTCOME_BROKEN,
                                       LR_OUTCOME_DIFFERS};
    const char *between = "\n";
    for (size_t i = 0; i < sizeof order / sizeof *order; i++) {
        uint32_t count = lr_results_count(results, order[i]);
        if (count) {
            char text[64];
            snprintf(text, sizeof text, "%u %s", (unsigned)count, lr_outcome_name(order[i]));
            fputs(between, view->out);
            put(view, color_of(order[i]), text);
            between = ", ";
        }
    }
    fprintf(view->out, " in %.1f s\n", results->seconds);
    print_accept(view, results, output);
    fflush(view->out);
}
