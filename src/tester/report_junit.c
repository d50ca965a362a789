/* JUnit's XML, as Jenkins, GitLab and GitHub's actions read it. */
#include "tester/report.h"
#include "tester/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void put_escaped(FILE *out, const char *text)
{
    char *clean = lr_clean_text(text, strlen(text));
    for (const char *c = clean ? clean : ""; *c; c++) {
        switch (*c) {
        case '&':
            fputs("&amp;", out);
            break;
        case '<':
            fputs("&lt;", out);
            break;
        case '>':
            fputs("&gt;", out);
            break;
        case '"':
            fputs("&quot;", out);
            break;
        case '\n':
            fputs("&#10;", out); /* a parser turns a line break in an attribute into a space */
            break;
        default:
            fputc(*c, out);
        }
    }
    free(clean);
}

static void put_attribute(FILE *out, const char *name, const char *value)
{
    fprintf(out, " %s=\"", name);
    put_escaped(out, value);
    fputc('"', out);
}

static void put_line(FILE *out, const char *label, const char *text)
{
    if (!text)
        return;
    put_escaped(out, label);
    put_escaped(out, text);
    fputc('\n', out);
}

static void put_failure(FILE *out, const lr_results *results, const lr_case_result *r)
{
    const char *element = r->outcome == LR_OUTCOME_BROKEN ? "error" : "failure";
    char *accept = r->readable ? lr_results_command(results, r, true) : NULL;
    fprintf(out, "\n      <%s", element);
    put_attribute(out, "message", r->message ? r->message : lr_outcome_name(r->outcome));
    put_attribute(out, "type", lr_outcome_name(r->outcome));
    fputc('>', out);
    put_line(out, "", r->message);
    put_line(out, "", r->cause);
    put_line(out, "", r->staleness);
    put_line(out, "golden: ", r->item->golden);
    put_line(out, "candidate: ", r->candidate);
    put_line(out, "difference: ", r->difference);
    put_line(out, "command: ", r->command);
    put_line(out, "accept: ", accept);
    put_line(out, "output:\n", r->output);
    fprintf(out, "</%s>\n    ", element);
    free(accept);
}

static void put_case(FILE *out, const lr_results *results, const lr_case_result *r)
{
    fputs("    <testcase", out);
    put_attribute(out, "classname", results->title);
    put_attribute(out, "name", r->item->name);
    fprintf(out, " time=\"%.3f\">", r->seconds);
    if (lr_outcome_failed(r->outcome))
        put_failure(out, results, r);
    else if (r->outcome == LR_OUTCOME_NOT_RUN)
        fputs("<skipped message=\"not run\"/>", out);
    fputs("</testcase>\n", out);
}

char *lr_results_junit(const lr_results *r)
{
    char *text = NULL, started[32] = "";
    size_t size = 0;
    struct tm utc;
    FILE *out = open_memstream(&text, &size);
    if (!out)
        return NULL;
    if (gmtime_r(&r->started, &utc))
        strftime(started, sizeof started, "%Y-%m-%dT%H:%M:%S", &utc);
    unsigned errors = lr_results_count(r, LR_OUTCOME_BROKEN);
    unsigned failures = lr_results_failures(r) - errors;
    char totals[160];
    snprintf(totals, sizeof totals, "tests=\"%u\" failures=\"%u\" errors=\"%u\"", r->count,
             failures, errors);
    fprintf(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites %s time=\"%.3f\">\n",
            totals, r->seconds);
    fputs("  <testsuite", out);
    put_attribute(out, "name", r->title);
    fprintf(out, " %s skipped=\"%u\" time=\"%.3f\" timestamp=\"%s\">\n", totals,
            lr_results_count(r, LR_OUTCOME_NOT_RUN), r->seconds, started);
    for (uint32_t i = 0; i < r->count; i++)
        put_case(out, r, &r->results[i]);
    fputs("  </testsuite>\n</testsuites>\n", out);
    if (fclose(out) == 0)
        return text;
    free(text);
    return NULL;
}
