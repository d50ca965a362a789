#include "cli/cli.h"
#include "cli/output.h"
#include "cli/progress.h"
#include "cli/test_view.h"
#include "base/file.h"
#include "base/memory.h"
#include "tester/listing.h"
#include "tester/process.h"
#include "tester/run.h"
#include "tester/text.h"

#include <errno.h>
#include <limits.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct values {
    const char *pattern, *shard, *output, *settings, *device;
    const char *reference, *candidate;
    const char *junit, *json, *report;
    int64_t jobs;   /* 0: not given */
    double timeout; /* seconds, 0: not given */
    bool update, update_missing, ci, fail_fast, embed_all, list, quiet;
} values;

#define AT(member) .offset = offsetof(values, member)

static const option options[] = {
    {.name = "only",
     .letter = 'k',
     .kind = OPTION_TEXT,
     AT(pattern),
     .value = "PATTERN",
     .help = "only the case of this name, or all that match it as a\n"
             "glob (*, ?, [abc]), or else all that hold it",
     .also = "filter|case|name|grep|match"},
    {.name = "update",
     .kind = OPTION_FLAG,
     AT(update),
     .help = "make the candidates of failing and missing cases the\ngoldens",
     .also = "accept|bless"},
    {.name = "update-missing",
     .kind = OPTION_FLAG,
     AT(update_missing),
     .help = "write goldens that are missing; leave the others"},
    {.name = "ci",
     .kind = OPTION_FLAG,
     AT(ci),
     .help = "never write a golden: refuse --update and\n--update-missing"},
    {.name = "output",
     .letter = 'o',
     .kind = OPTION_TEXT,
     AT(output),
     .value = "DIR",
     .help = "where candidates and differences of failing cases are\n"
             "left; default: lavaray-test"},
    {.name = "report",
     .kind = OPTION_TEXT,
     AT(report),
     .value = "FILE",
     .help = "write a page that shows everything, for a browser",
     .also = "html"},
    {.name = "junit",
     .kind = OPTION_TEXT,
     AT(junit),
     .value = "FILE",
     .help = "write JUnit's XML; \"-\" is standard output",
     .also = "xml"},
    {.name = "json",
     .kind = OPTION_TEXT,
     AT(json),
     .value = "FILE",
     .help = "write JSON; \"-\" is standard output"},
    {.name = "embed-all",
     .kind = OPTION_FLAG,
     AT(embed_all),
     .help =
         "the page holds the pictures of cases that passed, too,\nand their candidates are kept"},
    {.name = "jobs",
     .letter = 'j',
     .kind = OPTION_INTEGER,
     AT(jobs),
     .value = "N",
     .min = 1,
     .max = 256,
     .help = "cases at a time; default: the number of processors"},
    {.name = "shard",
     .kind = OPTION_TEXT,
     AT(shard),
     .value = "I/N",
     .help = "the I-th of N parts of the cases, I from 1"},
    {.name = "fail-fast",
     .kind = OPTION_FLAG,
     AT(fail_fast),
     .help = "start no more cases after the first that fails"},
    {.name = "timeout",
     .kind = OPTION_REAL,
     AT(timeout),
     .value = "SECONDS",
     .min = 0,
     .max = 86400,
     .help = "for each case that does not say otherwise; default: 300"},
    {.name = "device",
     .kind = OPTION_TEXT,
     AT(device),
     .value = "WHICH",
     .help = "as for lavaray render"},
    {.name = "settings",
     .kind = OPTION_TEXT,
     AT(settings),
     .value = "FILE",
     .help = "instead of DIR/tests.yaml",
     .also = "config"},
    {.name = "reference",
     .kind = OPTION_TEXT,
     AT(reference),
     .value = "DIR",
     .help = "compare two folders of pictures: this one and ...",
     .also = "golden|expected"},
    {.name = "candidate",
     .kind = OPTION_TEXT,
     AT(candidate),
     .value = "DIR",
     .help = "... this one; nothing is rendered",
     .also = "actual|test"},
    {.name = "list",
     .kind = OPTION_FLAG,
     AT(list),
     .help = "print the names of the cases and run none"},
    {.name = "quiet",
     .letter = 'q',
     .kind = OPTION_FLAG,
     AT(quiet),
     .help = "say nothing of cases that pass"},
};

/* ---- What is to be done -------------------------------------------------------------------- */

static int check_values(const command *self, const values *v, const char *folder)
{
    if (!v->reference != !v->candidate) {
        return wrong_usage(self, "--reference and --candidate go together");
    }
    if (folder && v->reference) {
        return wrong_usage(self, "either a folder of tests, or --reference and --candidate");
    }
    if (!folder && !v->reference) {
        return wrong_usage(self, "which tests? Give their folder");
    }
    if (v->ci && (v->update || v->update_missing)) {
        return wrong_usage(self, "--ci never writes goldens; leave out --update");
    }
    if (v->update && v->update_missing) {
        return wrong_usage(self, "--update includes --update-missing; give one of them");
    }
    const char *reports[] = {v->junit, v->json, v->report};
    int to_stdout = 0;
    for (int i = 0; i < 3; i++) {
        to_stdout += reports[i] && strcmp(reports[i], "-") == 0;
    }
    return to_stdout > 1 ? wrong_usage(self, "only one report can have standard output")
                         : EXIT_FINE;
}

/* Whether all reports can be written; creates their folders. */
static int check_reports(const values *v)
{
    const char *reports[] = {v->junit, v->json, v->report};
    int code = EXIT_FINE;
    for (int i = 0; i < 3 && code == EXIT_FINE; i++) {
        lr_error error = {0};
        if (reports[i]) {
            lr_status status = lr_make_folders(reports[i], &error);
            code = status == LR_OK ? check_writable(reports[i]) : report_failure(&error);
        }
    }
    return code;
}

/* "2/5": 1 and 5. */
static bool parse_shard(const char *text, uint32_t *index, uint32_t *count)
{
    unsigned i, n;
    char end;
    if (text[0] < '1' || text[0] > '9' || sscanf(text, "%6u/%6u%c", &i, &n, &end) != 2 || i > n) {
        return false;
    }
    *index = i - 1;
    *count = n;
    return true;
}

/* The cases of the pattern, and of them those of the shard; NULL after printing what is wrong. */
static const lr_case **select_cases(const values *v, const lr_suite *suite, uint32_t *count,
                                    int *code)
{
    uint32_t shard = 0, shards = 1, matching = 0;
    *count = 0;
    if (v->shard && !parse_shard(v->shard, &shard, &shards)) {
        print_error("--shard must be I/N with I from 1 to N, such as 2/5, not '%.100s'", v->shard);
        *code = EXIT_USAGE;
        return NULL;
    }
    const lr_case **cases = lr_alloc(suite->count, sizeof *cases);
    if (!cases) {
        print_error("out of memory");
        *code = EXIT_DEVICE;
        return NULL;
    }
    for (uint32_t i = 0; i < suite->count; i++) {
        const lr_case *item = &suite->cases[i];
        if (v->pattern && !lr_suite_selects(suite, item, v->pattern)) {
            continue;
        }
        if (matching++ % shards == shard) {
            cases[(*count)++] = item;
        }
    }
    if (matching == 0) {
        print_error("no case matches '%.100s'; lavaray test --list shows their names", v->pattern);
        *code = EXIT_USAGE;
        free(cases);
        return NULL;
    }
    return cases; /* a shard may be empty when there are more shards than cases */
}

/* The path of this very program. */
static bool find_self(char path[PATH_MAX])
{
    ssize_t length = readlink("/proc/self/exe", path, PATH_MAX - 1);
    if (length <= 0) {
        print_error("cannot find my own program: /proc/self/exe: %s", strerror(errno));
        return false;
    }
    path[length] = 0;
    return true;
}

/* "AMD EPYC 7B13, 2 processors" */
static void describe_cpu(char *text, size_t size)
{
    char line[256], model[200] = "unknown processor";
    FILE *file = fopen("/proc/cpuinfo", "r");
    while (file && fgets(line, sizeof line, file)) {
        const char *value = strchr(line, ':');
        if (strncmp(line, "model name", 10) == 0 && value) {
            snprintf(model, sizeof model, "%.*s", (int)strcspn(value + 2, "\n"), value + 2);
            break;
        }
    }
    if (file) {
        fclose(file);
    }
    long count = sysconf(_SC_NPROCESSORS_ONLN);
    snprintf(text, size, "%s, %ld processor%s", model, count, count == 1 ? "" : "s");
}

/* The folder as the user calls it; of "." and the like the name that it has. */
static const char *title_of(const char *folder, char path[PATH_MAX])
{
    if (folder[strspn(folder, "./")] || !realpath(folder, path)) {
        return folder;
    }
    const char *slash = strrchr(path, '/');
    return slash && slash[1] ? slash + 1 : path;
}

/* The command line that runs the same tests; `words` has room for 16. */
static void repeat_words(const values *v, const char *folder, char timeout[32], const char **words)
{
    size_t n = 0;
    words[n++] = "lavaray";
    words[n++] = "test";
    const char *flags[][2] = {
        {"--reference", v->reference}, {"--candidate", v->candidate}, {"--settings", v->settings},
        {"--device", v->device},       {"--output", v->output},
    };
    if (folder) {
        words[n++] = folder;
    }
    for (size_t i = 0; i < sizeof flags / sizeof *flags; i++) {
        if (flags[i][1]) {
            words[n++] = flags[i][0];
            words[n++] = flags[i][1];
        }
    }
    if (v->timeout > 0) {
        snprintf(timeout, 32, "%g", v->timeout);
        words[n++] = "--timeout";
        words[n++] = timeout;
    }
    words[n] = NULL;
}

/* ---- Doing it ------------------------------------------------------------------------------ */

static bool on_progress(void *user, const lr_case_result *result)
{
    if (result) {
        test_view_result(user, result);
    }
    return !interrupted();
}

/* Takes over the text, which is NULL when memory was out. */
static int write_report(const char *path, char *text)
{
    lr_error error = {0};
    lr_status status = LR_OK;
    if (!text) {
        print_error("%s: out of memory for this report", path);
        return EXIT_DEVICE;
    }
    if (strcmp(path, "-") == 0) {
        fputs(text, stdout); /* main checks standard output at the end */
    } else {
        status = lr_make_folders(path, &error); /* the output folder may have been empty, so gone */
        if (status == LR_OK) {
            status = lr_file_write(path, text, strlen(text), &error);
        }
    }
    free(text);
    return status == LR_OK ? EXIT_FINE : report_failure(&error);
}

static int write_reports(const values *v, const lr_results *results)
{
    int codes[3] = {EXIT_FINE, EXIT_FINE, EXIT_FINE};
    if (v->junit) {
        codes[0] = write_report(v->junit, lr_results_junit(results));
    }
    if (v->json) {
        codes[1] = write_report(v->json, lr_results_json(results));
    }
    if (v->report) {
        lr_embed embed = v->embed_all ? LR_EMBED_ALL : LR_EMBED_FAILED;
        codes[2] = write_report(v->report, lr_results_html(results, embed));
    }
    return codes[0] ? codes[0] : codes[1] ? codes[1] : codes[2];
}

static int run_cases(const values *v, const char *folder, const lr_case *const *cases,
                     uint32_t count)
{
    char program[PATH_MAX], title[PATH_MAX], cpu[300], timeout[32];
    const char *words[16];
    if (!find_self(program)) {
        return EXIT_DEVICE;
    }
    lr_case_result *results = lr_alloc(count, sizeof *results);
    if (!results) {
        print_error("out of memory");
        return EXIT_DEVICE;
    }
    long processors = sysconf(_SC_NPROCESSORS_ONLN);
    bool to_stdout = (v->junit && !strcmp(v->junit, "-")) || (v->json && !strcmp(v->json, "-")) ||
                     (v->report && !strcmp(v->report, "-"));
    test_view view;
    test_view_start(&view, to_stdout, v->quiet, cases, count);
    lr_run_options run_options = {
        .program = program,
        .output = v->output ? v->output : "lavaray-test",
        .device = v->device,
        .timeout = v->timeout > 0 ? v->timeout : 300,
        .jobs = v->jobs          ? (uint32_t)v->jobs
                : processors > 0 ? (uint32_t)processors
                                 : 1,
        .fail_fast = v->fail_fast,
        .update = v->update,
        .update_missing = v->update_missing,
        .keep_all = v->embed_all,
        .progress = on_progress,
        .user = &view,
    };
    describe_cpu(cpu, sizeof cpu);
    repeat_words(v, folder, timeout, words);
    lr_results all = {.results = results,
                      .count = count,
                      .words = words,
                      .cpu = cpu,
                      .title = title_of(folder ? folder : v->candidate, title),
                      .started = time(NULL)};
    catch_interrupts();
    lr_error error = {0};
    double start = lr_clock();
    lr_status status = lr_run_cases(cases, count, &run_options, results, &error);
    all.seconds = lr_clock() - start;
    int code;
    if (status == LR_OK || status == LR_ERROR_INTERRUPTED) {
        test_view_summary(&view, &all, run_options.output);
        code = write_reports(v, &all);
        if (status == LR_ERROR_INTERRUPTED) {
            print_error("interrupted");
            code = EXIT_INTERRUPTED;
        } else if (code == EXIT_FINE && lr_results_failures(&all)) {
            code = EXIT_DIFFERENT;
        }
    } else {
        code = report_failure(&error);
    }
    for (uint32_t i = 0; i < count; i++) {
        lr_case_result_free(&results[i]);
    }
    free(results);
    return code;
}

static int run(const command *self, int argc, char **argv)
{
    values v = {0};
    int operands;
    parse_result parsed = options_parse(self, argc, argv, &v, &operands);
    if (parsed != PARSE_OK) {
        return (int)parsed;
    }
    const char *folder = operands ? argv[0] : NULL;
    int code = check_values(self, &v, folder);
    if (code != EXIT_FINE) {
        return code;
    }
    lr_suite_desc desc = {.folder = folder,
                          .reference = v.reference,
                          .candidate = v.candidate,
                          .settings = v.settings};
    lr_suite *suite;
    lr_error error = {0};
    char *report;
    if (lr_suite_load(&desc, &suite, &report, &error) != LR_OK) {
        if (report) {
            fputs(report, stderr);
            free(report);
            return EXIT_SCENE;
        }
        return report_failure(&error);
    }
    for (uint32_t i = 0; i < suite->orphan_count; i++) {
        char *path = lr_clean_text(suite->orphans[i], strlen(suite->orphans[i]));
        print_warning("%s belongs to no case", path ? path : "a golden");
        free(path);
    }
    uint32_t count;
    const lr_case **cases = select_cases(&v, suite, &count, &code);
    if (cases && v.list) {
        for (uint32_t i = 0; i < count; i++) {
            puts(cases[i]->name);
        }
    } else if (cases) {
        code = check_reports(&v);
        code = code == EXIT_FINE ? run_cases(&v, folder, cases, count) : code;
    }
    free(cases);
    lr_suite_free(suite);
    return code;
}

const command command_test = {
    .name = "test",
    .operands = "DIR",
    .summary = "compare pictures of scenes with goldens",
    .details =
        "Renders DIR/scenes/*.yaml, or runs the commands of DIR/tests.yaml, and compares the\n"
        "pictures with DIR/golden: exactly, unless tests.yaml gives other metrics. Each case runs\n"
        "in a process of its own, with a time limit. Exit code 0: all passed; 1: some did not.\n"
        "docs/test.md describes the folder and the keys of tests.yaml.",
    .examples = "  lavaray test tests/images\n"
                "  lavaray test tests/images -k sphere --update\n"
                "  lavaray test tests/images --ci --junit junit.xml --report report.html\n"
                "  lavaray test --reference golden --candidate rendered --report report.html",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .min_operands = 0,
    .max_operands = 1,
    .run = run,
};
