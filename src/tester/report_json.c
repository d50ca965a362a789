#include "tester/report.h"
#include "tester/text.h"

#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

uint32_t lr_results_count(const lr_results *r, lr_outcome outcome)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < r->count; i++)
        count += r->results[i].outcome == outcome;
    return count;
}

uint32_t lr_results_failures(const lr_results *r)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < r->count; i++)
        count += lr_outcome_failed(r->results[i].outcome);
    return count;
}

char *lr_results_command(const lr_results *r, const lr_case_result *result, bool accept)
{
    enum { WORDS_MAX = 32 };
    const char *words[WORDS_MAX + 4];
    size_t count = 0;
    for (; r->words[count] && count < WORDS_MAX; count++)
        words[count] = r->words[count];
    words[count++] = "-k";
    words[count++] = result->item->name;
    if (accept)
        words[count++] = "--update";
    words[count] = NULL;
    return lr_shell_text(words);
}

/* Paths and outputs of other programs need not be UTF-8, but JSON is. */
static json_t *text_json(const char *text)
{
    char *clean = text ? lr_clean_text(text, strlen(text)) : NULL;
    json_t *json = clean ? json_string(clean) : NULL;
    free(clean);
    return json;
}

static void put_text(json_t *object, const char *key, const char *text)
{
    if (text && *text)
        json_object_set_new(object, key, text_json(text));
}

/* JSON has no infinity; such a value is left out. */
static void put_number(json_t *object, const char *key, double value)
{
    if (isfinite(value))
        json_object_set_new(object, key, json_real(value));
}

static void put_count(json_t *object, const char *key, uint64_t value)
{
    json_object_set_new(object, key, json_integer((json_int_t)value));
}

static json_t *metrics_json(const lr_compare_result *c)
{
    json_t *list = json_array();
    for (int i = 0; i < LR_METRIC_COUNT; i++) {
        const lr_metric_result *m = &c->metrics[i];
        if (!m->measured)
            continue;
        json_t *metric = json_object();
        bool counts = i == LR_METRIC_EXACT || i == LR_METRIC_ABS || i == LR_METRIC_REL;
        put_text(metric, "name", lr_metric_name((lr_metric)i));
        put_number(metric, "value", m->value);
        if (i != LR_METRIC_EXACT)
            put_number(metric, "limit", m->limit);
        if (counts) {
            put_count(metric, "pixels", m->pixels);
            put_number(metric, "allowed_percent", m->allowed);
        }
        json_object_set_new(metric, "at_least", json_boolean(lr_metric_at_least((lr_metric)i)));
        json_object_set_new(metric, "pass", json_boolean(m->pass));
        json_array_append_new(list, metric);
    }
    return list;
}

static json_t *regions_json(const lr_compare_result *c)
{
    json_t *list = json_array();
    for (uint32_t i = 0; i < c->regions_kept; i++) {
        const lr_region *r = &c->regions[i];
        json_t *region =
            json_pack("{s:i, s:i, s:i, s:i, s:I, s:[i, i]}", "x", (int)r->box.x, "y", (int)r->box.y,
                      "width", (int)r->box.width, "height", (int)r->box.height, "pixels",
                      (json_int_t)r->pixels, "worst_at", (int)r->worst_x, (int)r->worst_y);
        put_number(region, "worst", r->worst);
        json_array_append_new(list, region);
    }
    return list;
}

static json_t *compare_json(const lr_compare_result *c)
{
    json_t *object = json_object();
    json_object_set_new(object, "size", json_pack("[i, i]", (int)c->width, (int)c->height));
    json_object_set_new(object, "candidate_size",
                        json_pack("[i, i]", (int)c->test_width, (int)c->test_height));
    if (!c->same_size)
        return object;
    json_object_set_new(object, "metrics", metrics_json(c));
    put_count(object, "compared", c->compared);
    put_count(object, "different_pixels", c->different_pixels);
    put_number(object, "max_difference", c->max_difference);
    if (c->different) {
        put_text(object, "cause", lr_cause_name(c->cause));
        put_count(object, "region_count", c->region_count);
        json_object_set_new(object, "regions", regions_json(c));
    }
    return object;
}

static json_t *stamp_json(const lr_stamp *stamp)
{
    json_t *object = json_object();
    put_text(object, "software", stamp->software);
    put_text(object, "scene_sha256", stamp->scene);
    put_text(object, "settings", stamp->settings);
    put_text(object, "pixels_sha256", stamp->pixels);
    return object;
}

static void put_command(json_t *object, const char *key, char *command)
{
    put_text(object, key, command);
    free(command);
}

static json_t *case_json(const lr_results *results, const lr_case_result *r)
{
    json_t *object = json_object();
    put_text(object, "name", r->item->name);
    put_text(object, "outcome", lr_outcome_name(r->outcome));
    json_object_set_new(object, "failed", json_boolean(lr_outcome_failed(r->outcome)));
    put_number(object, "seconds", r->seconds);
    put_text(object, "message", r->message);
    put_text(object, "cause", r->cause);
    put_text(object, "staleness", r->staleness);
    put_text(object, "output", r->output);
    put_text(object, "scene", r->item->scene);
    put_text(object, "golden", r->item->golden);
    put_text(object, "candidate", r->candidate);
    put_text(object, "difference", r->difference);
    put_text(object, "command", r->command);
    put_command(object, "rerun", lr_results_command(results, r, false));
    if (lr_outcome_failed(r->outcome) && r->readable)
        put_command(object, "accept", lr_results_command(results, r, true));
    put_text(object, "device", r->device);
    put_text(object, "driver", r->driver);
    if (r->compared)
        json_object_set_new(object, "compare", compare_json(&r->compare));
    json_object_set_new(object, "golden_stamp", stamp_json(&r->golden_stamp));
    json_object_set_new(object, "candidate_stamp", stamp_json(&r->candidate_stamp));
    return object;
}

static json_t *counts_json(const lr_results *r)
{
    json_t *object = json_object();
    for (int i = 0; i < LR_OUTCOME_COUNT; i++)
        put_count(object, lr_outcome_name((lr_outcome)i), lr_results_count(r, (lr_outcome)i));
    return object;
}

json_t *lr_results_object(const lr_results *r)
{
    char started[32] = "";
    struct tm utc;
    if (gmtime_r(&r->started, &utc))
        strftime(started, sizeof started, "%Y-%m-%dT%H:%M:%SZ", &utc);
    json_t *object = json_object();
    json_t *cases = json_array();
    put_text(object, "version", LR_VERSION);
    put_text(object, "title", r->title);
    put_command(object, "command", lr_shell_text(r->words));
    put_text(object, "started", started);
    put_number(object, "seconds", r->seconds);
    put_text(object, "cpu", r->cpu);
    json_object_set_new(object, "counts", counts_json(r));
    put_count(object, "failures", lr_results_failures(r));
    for (uint32_t i = 0; i < r->count; i++)
        json_array_append_new(cases, case_json(r, &r->results[i]));
    json_object_set_new(object, "cases", cases);
    return object;
}

char *lr_results_json(const lr_results *results)
{
    json_t *object = lr_results_object(results);
    char *dumped = object ? json_dumps(object, JSON_INDENT(2)) : NULL;
    char *text = dumped ? lr_format_text("%s\n", dumped) : NULL;
    free(dumped);
    json_decref(object);
    return text;
}
