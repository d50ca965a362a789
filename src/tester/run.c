#include "tester/run.h"

#include "base/file.h"
#include "base/memory.h"
#include "tester/command.h"
#include "tester/judge.h"
#include "tester/listing.h"
#include "tester/process.h"
#include "tester/text.h"
#include "tester/trial.h"

#include <errno.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { LINES_KEPT = 12, PICTURE_BYTES_MAX = 1 << 30, STATS_BYTES_MAX = 1 << 20 };

#define TICK 0.02 /* seconds between two looks at what runs */

/* A place where one case at a time runs. */
typedef struct slot {
    lr_process process;     /* the command, then the comparison */
    lr_case_result *result; /* NULL: the slot is free */
    char *folder;           /* for the command alone, in the work folder */
    char *output, *stats;   /* the files that the command writes there */
    bool comparing;
    lr_trial trial;
    char *candidate, *difference; /* while comparing */
} slot;

typedef struct runner {
    const lr_run_options *options;
    char *work; /* a folder in the output folder */
    slot *slots;
    uint32_t slot_count, running;
    bool stopping, interrupted; /* no more cases are started; what runs is ended */
} runner;

/* ---- Folders ------------------------------------------------------------------------------- */

static char *kept_path(const runner *r, const char *kind, const lr_case *item, const char *ending)
{
    return lr_format_text("%s/%s/%s%s", r->options->output, kind, item->name, ending);
}

/* ".png" of the golden, so that the candidate is in the same format; "" for two folders, whose
 * cases' names have the ending already. */
static const char *ending_of(const lr_case *item)
{
    return item->candidate ? "" : item->golden + lr_stem_length(item->golden);
}

/* Removes a file that an earlier run left, and the folders that it leaves empty. */
static void remove_kept(const runner *r, char *path)
{
    /* Where nothing was, another case may just be making the folder for its own. */
    if (!path || unlink(path) != 0)
        return;
    size_t top = strlen(r->options->output);
    for (char *slash = strrchr(path, '/'); slash && slash > path + top;
         slash = strrchr(path, '/')) {
        *slash = 0;
        if (rmdir(path) != 0)
            return;
    }
}

static void forget_earlier(const runner *r, const lr_case *item)
{
    char *difference = kept_path(r, "difference", item, ".png");
    remove_kept(r, difference);
    free(difference);
    if (item->candidate)
        return;
    char *candidate = kept_path(r, "candidate", item, ending_of(item));
    remove_kept(r, candidate);
    free(candidate);
}

static lr_status make_work_folder(runner *r, lr_error *error)
{
    r->work = lr_format_text("%s/.running-XXXXXX", r->options->output);
    if (!r->work)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory");
    lr_status status = lr_make_folders(r->work, error);
    if (status == LR_OK && !mkdtemp(r->work))
        status = lr_fail(error, LR_ERROR_FILE, "%.500s: cannot write in this folder: %s",
                         r->options->output, strerror(errno));
    return status;
}

/* ---- The end of a case --------------------------------------------------------------------- */

/* The last lines as text that is safe to print. */
static char *clean_tail(const lr_process *p)
{
    size_t begin = p->tail_length;
    while (begin > 0 && p->tail[begin - 1] == '\n')
        begin--;
    size_t end = begin;
    for (int lines = 0; begin > 0 && lines < LINES_KEPT; begin--)
        lines += p->tail[begin - 1] == '\n' && begin < end;
    if (end == 0)
        return NULL;
    begin += begin > 0;
    return lr_clean_text(p->tail + begin, end - begin);
}

static char *copy_json_text(const json_t *object, const char *key)
{
    const char *text = json_string_value(json_object_get(object, key));
    return text ? lr_string_copy(text, strlen(text)) : NULL;
}

/* Which device rendered it. */
static void read_stats(const slot *s)
{
    char *text;
    size_t size;
    lr_error ignored;
    if (lr_file_read(s->stats, STATS_BYTES_MAX, &text, &size, &ignored) != LR_OK)
        return;
    json_t *root = json_loadb(text, size, 0, NULL);
    const json_t *device = json_object_get(root, "device");
    s->result->device = copy_json_text(device, "name");
    s->result->driver = copy_json_text(device, "driver");
    json_decref(root);
    free(text);
}

/* Whether the command did its work; if not, why not is the result's message. */
static bool check_end(const slot *s)
{
    const lr_process *p = &s->process;
    lr_case_result *result = s->result;
    if (p->timed_out)
        lr_judge_broken(result, "ended after the time limit of %g s", p->limit);
    else if (WIFSIGNALED(p->status))
        lr_judge_broken(result, "ended by signal %d (%s)", WTERMSIG(p->status),
                        strsignal(WTERMSIG(p->status)));
    else if (WEXITSTATUS(p->status) != 0)
        lr_judge_broken(result, "the command failed with exit code %d", WEXITSTATUS(p->status));
    else if (!lr_is_file(s->output)) /* nothing, or a folder or pipe */
        lr_judge_broken(result, "the command wrote no picture to %s",
                        result->item->settings.run ? "{output}" : s->output);
    else
        return true;
    return false;
}

/* The golden becomes a copy of the candidate, byte for byte. */
static void accept(const char *candidate, lr_case_result *result, lr_outcome outcome)
{
    const char *golden = result->item->golden;
    char *bytes = NULL;
    size_t size;
    lr_error error = {0};
    lr_status status = lr_file_read(candidate, PICTURE_BYTES_MAX, &bytes, &size, &error);
    if (status == LR_OK)
        status = lr_make_folders(golden, &error);
    if (status == LR_OK)
        status = lr_file_write(golden, bytes, size, &error);
    free(bytes);
    if (status == LR_OK) {
        result->outcome = outcome;
    } else {
        free(result->message);
        lr_judge_broken(result, "%s", error.message);
    }
}

static double limit_of(const runner *r, const lr_case *item)
{
    return item->settings.timeout > 0 ? item->settings.timeout : r->options->timeout;
}

/* Takes over the path of the picture. False when the comparison does not run; the result says why.
 */
static bool start_comparing(const runner *r, slot *s, char *candidate)
{
    const lr_case *item = s->result->item;
    lr_error error = {.message = "out of memory"};
    s->candidate = candidate;
    s->difference = kept_path(r, "difference", item, ".png");
    s->comparing = s->candidate && s->difference &&
                   lr_trial_start(&s->trial, &s->process, s->candidate, s->difference, item,
                                  limit_of(r, item), &error) == LR_OK;
    if (!s->comparing)
        lr_judge_broken(s->result, "%s", error.message);
    return s->comparing;
}

/* Compares the picture that the command wrote, in the place where it stays when it fails. */
static bool compare_output(const runner *r, slot *s)
{
    lr_error error = {.message = "out of memory"};
    char *path = kept_path(r, "candidate", s->result->item, ending_of(s->result->item));
    lr_status status = path ? lr_make_folders(path, &error) : LR_ERROR_MEMORY;
    if (status == LR_OK && rename(s->output, path) != 0)
        status = lr_fail(&error, LR_ERROR_FILE, "%.500s: %s", path, strerror(errno));
    if (status == LR_OK)
        return start_comparing(r, s, path);
    lr_judge_broken(s->result, "%s", error.message);
    free(path);
    return false;
}

/* Makes the picture the golden where that is wanted, and removes what nobody needs. */
static void end_comparing(const runner *r, slot *s)
{
    const lr_run_options *o = r->options;
    lr_case_result *result = s->result;
    lr_trial_finish(&s->trial, &s->process, result);
    if (result->outcome == LR_OUTCOME_MISSING && (o->update || o->update_missing))
        accept(s->candidate, result, LR_OUTCOME_ADDED);
    else if (lr_outcome_failed(result->outcome) && result->readable && o->update)
        accept(s->candidate, result, LR_OUTCOME_UPDATED);
    bool failed = lr_outcome_failed(result->outcome);
    if (!failed && result->difference) {
        remove_kept(r, s->difference);
        free(result->difference);
        result->difference = NULL;
    }
    if (failed || o->keep_all || result->item->candidate) {
        result->candidate = s->candidate;
        s->candidate = NULL;
    } else {
        remove_kept(r, s->candidate);
    }
}

/* After an interrupt, when the comparison has no verdict. */
static void drop_comparison(const runner *r, slot *s)
{
    lr_case_result ignored = {0};
    lr_trial_finish(&s->trial, &s->process, &ignored);
    lr_case_result_free(&ignored);
    remove_kept(r, s->difference);
    if (!s->result->item->candidate)
        remove_kept(r, s->candidate);
}

static void release(slot *s)
{
    if (s->folder)
        lr_remove_tree(s->folder);
    free(s->folder);
    free(s->output);
    free(s->stats);
    free(s->candidate);
    free(s->difference);
    *s = (slot){0};
}

/* Tells of the result; false when the user wants an end. */
static void announce(runner *r, const lr_case_result *result)
{
    if (r->options->progress && !r->options->progress(r->options->user, result))
        r->interrupted = true;
    if (result && r->options->fail_fast && lr_outcome_failed(result->outcome))
        r->stopping = true;
}

/* The slot's process has ended. */
static void finish(runner *r, slot *s)
{
    lr_case_result *result = s->result;
    result->seconds += s->process.seconds;
    if (r->interrupted && s->comparing) {
        drop_comparison(r, s);
    } else if (s->comparing) {
        end_comparing(r, s);
    } else if (!r->interrupted) {
        result->output = clean_tail(&s->process);
        read_stats(s);
        if (check_end(s) && compare_output(r, s))
            return;
    }
    if (!r->interrupted)
        announce(r, result);
    r->running--;
    release(s);
}

/* ---- The beginning of a case --------------------------------------------------------------- */

/* The command as a person would type it, who has the name of the picture in mind, not our path. */
static char *shown_command(const runner *r, const lr_case *item)
{
    lr_command command;
    const char *slash = strrchr(item->name, '/');
    char *output = lr_format_text("%s%s", slash ? slash + 1 : item->name, ending_of(item));
    char *text = NULL;
    if (output && lr_command_make(&command, item, r->options, "lavaray", output, NULL)) {
        text = lr_shell_text((const char *const *)command.words);
        lr_command_free(&command);
    }
    free(output);
    return text;
}

/* False when the command does not run; the result says why. */
static bool start_command(const runner *r, slot *s)
{
    lr_case_result *result = s->result;
    const lr_case *item = result->item;
    lr_command command = {0};
    lr_error error = {.message = "out of memory"};
    result->command = shown_command(r, item);
    s->folder = lr_format_text("%s/%u", r->work, (unsigned)(s - r->slots));
    s->output = lr_format_text("%s/candidate%s", s->folder ? s->folder : "", ending_of(item));
    s->stats = lr_format_text("%s/stats.json", s->folder ? s->folder : "");
    bool started = s->folder && s->output && s->stats;
    if (started && mkdir(s->folder, 0777) != 0) {
        lr_fail(&error, LR_ERROR_FILE, "%.500s: %s", s->folder, strerror(errno));
        started = false;
    }
    if (started)
        started =
            lr_command_make(&command, item, r->options, r->options->program, s->output, s->stats);
    if (started)
        started = lr_process_start(&s->process, (const char *const *)command.words,
                                   limit_of(r, item), &error) == LR_OK;
    lr_command_free(&command);
    if (!started)
        lr_judge_broken(result, "%s", error.message);
    return started;
}

/* A case of two folders: no command runs. */
static bool start_pair(const runner *r, slot *s)
{
    const char *candidate = s->result->item->candidate;
    if (access(candidate, F_OK) == 0)
        return start_comparing(r, s, lr_string_copy(candidate, strlen(candidate)));
    lr_judge_broken(s->result, "there is no candidate %s", candidate);
    return false;
}

static void start_next(runner *r, lr_case_result *result)
{
    slot *s = r->slots;
    while (s->result)
        s++;
    *s = (slot){.result = result};
    forget_earlier(r, result->item);
    if (result->item->candidate ? start_pair(r, s) : start_command(r, s)) {
        r->running++;
    } else {
        release(s);
        announce(r, result);
    }
}

static void look_after(runner *r)
{
    lr_process *processes[64];
    size_t count = 0;
    for (uint32_t i = 0; i < r->slot_count && count < 64; i++)
        if (r->slots[i].result)
            processes[count++] = &r->slots[i].process;
    lr_process_wait(processes, count, TICK);
    for (uint32_t i = 0; i < r->slot_count; i++) {
        slot *s = &r->slots[i];
        if (s->result && r->interrupted)
            lr_process_end(&s->process);
        if (s->result && lr_process_poll(&s->process))
            finish(r, s);
    }
    announce(r, NULL);
}

lr_status lr_run_cases(const lr_case *const *cases, uint32_t count, const lr_run_options *options,
                       lr_case_result *results, lr_error *error)
{
    runner r = {.options = options, .slot_count = options->jobs ? options->jobs : 1};
    for (uint32_t i = 0; i < count; i++)
        results[i] = (lr_case_result){.item = cases[i]};
    lr_status status = make_work_folder(&r, error);
    if (status != LR_OK) {
        free(r.work);
        return status;
    }
    r.slots = lr_alloc(r.slot_count, sizeof *r.slots);
    if (!r.slots)
        status = lr_fail(error, LR_ERROR_MEMORY, "out of memory");
    uint32_t next = 0;
    while (status == LR_OK && (r.running || (next < count && !r.stopping && !r.interrupted))) {
        bool more = next < count && !r.stopping && !r.interrupted;
        if (more && r.running < r.slot_count)
            start_next(&r, &results[next++]);
        else
            look_after(&r);
    }
    free(r.slots);
    lr_remove_tree(r.work);
    free(r.work);
    rmdir(options->output); /* stays unless it is empty */
    if (status == LR_OK && r.interrupted)
        status = lr_fail(error, LR_ERROR_INTERRUPTED, "interrupted");
    return status;
}
