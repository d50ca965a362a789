#include "tester/judge.h"

#include "base/memory.h"
#include "image/image.h"
#include "tester/listing.h"
#include "tester/text.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

const char *lr_outcome_name(lr_outcome outcome)
{
    static const char *const names[LR_OUTCOME_COUNT] = {
        [LR_OUTCOME_NOT_RUN] = "not run", [LR_OUTCOME_PASSED] = "passed",
        [LR_OUTCOME_UPDATED] = "updated", [LR_OUTCOME_ADDED] = "added",
        [LR_OUTCOME_DIFFERS] = "differs", [LR_OUTCOME_MISSING] = "missing",
        [LR_OUTCOME_BROKEN] = "broken",
    };
    return names[outcome];
}

bool lr_outcome_failed(lr_outcome outcome)
{
    return outcome >= LR_OUTCOME_DIFFERS;
}

void lr_case_result_free(lr_case_result *result)
{
    free(result->message);
    free(result->cause);
    free(result->staleness);
    free(result->output);
    free(result->command);
    free(result->candidate);
    free(result->difference);
    free(result->device);
    free(result->driver);
    lr_compare_result_free(&result->compare);
    *result = (lr_case_result){0};
}

static void copy_text(const lr_image *image, const char *key, char *out, size_t size)
{
    const char *value = lr_image_find_text(image, key);
    snprintf(out, size, "%s", value ? value : "");
}

void lr_stamp_read(const lr_image *image, lr_stamp *stamp)
{
    copy_text(image, LR_STAMP_SOFTWARE, stamp->software, sizeof stamp->software);
    copy_text(image, LR_STAMP_SCENE, stamp->scene, sizeof stamp->scene);
    copy_text(image, LR_STAMP_SETTINGS, stamp->settings, sizeof stamp->settings);
    copy_text(image, LR_STAMP_PIXELS, stamp->pixels, sizeof stamp->pixels);
}

/* Whether the scene or the renderer changed; NULL when the pictures do not say. */
static char *tell_staleness(const lr_stamp *golden, const lr_stamp *now)
{
    if (!now->scene[0])
        return NULL;
    if (!golden->scene[0])
        return lr_format_text("The golden does not say which scene it was made from.");
    if (strcmp(golden->scene, now->scene) != 0)
        return lr_format_text("The golden is stale: the scene has changed since %s made it.",
                              golden->software);
    if (strcmp(golden->settings, now->settings) != 0)
        return lr_format_text("The golden is stale: its settings were %s; now they are %s.",
                              golden->settings, now->settings);
    if (strcmp(golden->pixels, now->pixels) == 0)
        return lr_format_text("Scene, settings and linear pixels are those of the golden: its file "
                              "was edited, or the encoding has changed.");
    return lr_format_text(
        "The scene is unchanged since %s made the golden: the renderer%s.", golden->software,
        strcmp(golden->software, now->software) == 0 ? " gives other pixels" : " has changed");
}

/* "flip-mean 0.0213, limit 0.01" of all metrics that failed. */
static char *tell_metrics(const lr_compare_result *c)
{
    char text[1024] = "";
    size_t used = 0;
    for (int i = 0; i < LR_METRIC_COUNT && used < sizeof text; i++) {
        const lr_metric_result *m = &c->metrics[i];
        if (!m->measured || m->pass)
            continue;
        const char *between = used ? "; " : "";
        size_t room = sizeof text - used;
        const char *name = lr_metric_name((lr_metric)i);
        if (i == LR_METRIC_EXACT)
            used += (size_t)snprintf(text + used, room, "%s%llu of %llu pixels differ (%.3g %%)",
                                     between, (unsigned long long)m->pixels,
                                     (unsigned long long)c->compared, m->value);
        else if (i == LR_METRIC_ABS || i == LR_METRIC_REL)
            used += (size_t)snprintf(text + used, room,
                                     "%s%.3g %% of the pixels beyond %s %.6g, allowed %.6g %%",
                                     between, m->value, name, m->limit, m->allowed);
        else
            used += (size_t)snprintf(
                text + used, room, "%s%s is %.6g, %s %.6g", between, name, m->value,
                lr_metric_at_least((lr_metric)i) ? "at least" : "at most", m->limit);
    }
    return lr_format_text("%s", text);
}

/* The heat map beside the candidate; without one the report does as well. */
static void write_map(const lr_image *reference, const char *path, lr_case_result *result)
{
    lr_picture map = {0};
    lr_encoding encoding = {.format = LR_FORMAT_PNG};
    lr_error ignored;
    if (!result->compare.map || lr_make_folders(path, &ignored) != LR_OK)
        return;
    if (lr_compare_heat_map(reference, &result->compare, &map, &ignored) == LR_OK &&
        lr_picture_write(&map, path, &encoding, &ignored) == LR_OK)
        result->difference = lr_string_copy(path, strlen(path));
    lr_picture_free(&map);
}

void lr_judge_broken(lr_case_result *result, const char *format, ...)
{
    char message[1200];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    result->outcome = LR_OUTCOME_BROKEN;
    result->message = lr_string_copy(message, strlen(message));
}

static void tell_difference(const lr_image *reference, const char *difference,
                            lr_case_result *result)
{
    const lr_compare_result *c = &result->compare;
    char cause[1024];
    result->outcome = LR_OUTCOME_DIFFERS;
    if (!c->same_size) {
        result->message = lr_format_text("the picture is %ux%u, its golden %ux%u", c->test_width,
                                         c->test_height, c->width, c->height);
    } else {
        result->message = tell_metrics(c);
        lr_compare_describe(c, cause, sizeof cause);
        if (cause[0])
            result->cause = lr_format_text("%s", cause);
        write_map(reference, difference, result);
    }
    result->staleness = tell_staleness(&result->golden_stamp, &result->candidate_stamp);
}

/* Both pictures are readable. */
static void compare(const lr_image *reference, const lr_image *test, const lr_image *mask,
                    const char *difference, lr_case_result *result)
{
    lr_compare_options options = result->item->settings.compare;
    lr_error error = {0};
    options.map = options.explain = true;
    options.mask = mask;
    lr_stamp_read(reference, &result->golden_stamp);
    if (lr_compare(reference, test, &options, &result->compare, &error) != LR_OK) {
        lr_judge_broken(result, "%s", error.message);
        return;
    }
    result->compared = true;
    result->outcome = LR_OUTCOME_PASSED;
    if (!result->compare.pass)
        tell_difference(reference, difference, result);
    free(result->compare.map);
    result->compare.map = NULL;
}

void lr_judge(const char *candidate, const char *difference, lr_case_result *result)
{
    const lr_case *item = result->item;
    lr_image reference = {0}, test = {0}, mask = {0};
    lr_error error = {0};
    lr_status status = lr_image_read(candidate, &test, &error);
    if (status != LR_OK)
        goto broken;
    result->readable = true;
    lr_stamp_read(&test, &result->candidate_stamp);
    if (access(item->golden, F_OK) != 0) {
        result->outcome = LR_OUTCOME_MISSING;
        result->message = lr_format_text("there is no golden %s", item->golden);
        goto done;
    }
    status = lr_image_read(item->golden, &reference, &error);
    if (status == LR_OK && item->mask)
        status = lr_image_read(item->mask, &mask, &error);
    if (status != LR_OK)
        goto broken;
    compare(&reference, &test, item->mask ? &mask : NULL, difference, result);
    goto done;
broken:
    lr_judge_broken(result, "%s", error.message);
done:
    lr_image_free(&reference);
    lr_image_free(&test);
    lr_image_free(&mask);
}
