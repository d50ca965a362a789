#include "cli/compare_report.h"

#include <math.h>
#include <stdio.h>

enum { LISTED_MAX = 3 }; /* regions in the text; the JSON has all that were kept */

static const char *const channel_names[4][4] = {
    {"grey"}, {"grey", "alpha"}, {"red", "green", "blue"}, {"red", "green", "blue", "alpha"}};

static bool is_share(int metric)
{
    return metric == LR_METRIC_EXACT || metric == LR_METRIC_ABS || metric == LR_METRIC_REL;
}

static void print_metric(const lr_compare_result *r, int metric)
{
    const lr_metric_result *m = &r->metrics[metric];
    char value[64], limit[64];
    unsigned long long pixels = m->pixels;
    if (metric == LR_METRIC_EXACT) {
        snprintf(value, sizeof value, "%llu pixel%s (%.3g %%)", pixels, pixels == 1 ? "" : "s",
                 m->value);
        snprintf(limit, sizeof limit, "none may differ");
    } else if (is_share(metric)) {
        snprintf(value, sizeof value, "%llu pixel%s (%.3g %%)", pixels, pixels == 1 ? "" : "s",
                 m->value);
        snprintf(limit, sizeof limit, "at most %g %% beyond %.4g", m->allowed, m->limit);
    } else {
        snprintf(value, sizeof value, "%.6g", m->value);
        snprintf(limit, sizeof limit, "at %s %.6g",
                 lr_metric_at_least((lr_metric)metric) ? "least" : "most", m->limit);
    }
    printf("  %-4s  %-10s %-24s %s\n", m->pass ? "ok" : "FAIL", lr_metric_name((lr_metric)metric),
           value, limit);
}

static void print_samples(const double *samples, uint32_t count)
{
    for (uint32_t c = 0; c < count; c++)
        printf("%s%.6g", c ? " " : "", samples[c]);
}

static void print_places(const lr_compare_result *r)
{
    printf("  first difference at %u,%u: ", r->first_x, r->first_y);
    print_samples(r->first_test, r->channels);
    printf(" instead of ");
    print_samples(r->first_reference, r->channels);
    printf("\n  largest at %u,%u: %.4g in %s\n", r->max_x, r->max_y, r->max_difference,
           channel_names[r->channels - 1][r->max_channel]);
    if (r->region_count == 0)
        return;
    printf("  %llu region%s differ%s%s\n", (unsigned long long)r->region_count,
           r->region_count == 1 ? "" : "s", r->region_count == 1 ? "s" : "",
           r->region_count > 1 ? ", the worst first:" : ":");
    for (uint32_t i = 0; i < r->regions_kept && i < LISTED_MAX; i++) {
        const lr_region *region = &r->regions[i];
        printf("    %u x %u pixels at %u,%u, centre %.0f,%.0f, %llu differ\n", region->box.width,
               region->box.height, region->box.x, region->box.y, region->center_x, region->center_y,
               (unsigned long long)region->pixels);
    }
}

void print_comparison(const lr_compare_result *r, const char *reference, const char *test)
{
    char text[512];
    printf("%s: %s and %s",
           !r->pass       ? "DIFFERENT"
           : r->different ? "within limits"
                          : "same",
           reference, test);
    if (r->same_size)
        printf(", %u x %u pixels", r->width, r->height);
    putchar('\n');
    lr_compare_describe(r, text, sizeof text);
    if (*text)
        printf("  %s\n", text);
    for (int i = 0; i < LR_METRIC_COUNT; i++)
        if (r->metrics[i].measured)
            print_metric(r, i);
    if (r->different)
        print_places(r);
    if (r->same_size && r->compared < (uint64_t)r->width * r->height)
        printf("  %llu pixels are masked or ignored\n",
               (unsigned long long)((uint64_t)r->width * r->height - r->compared));
    if (r->converted)
        printf("  the float picture was sRGB-encoded to compare it with the integer one\n");
    if (r->non_finite)
        printf("  %llu differing pixels are infinite or not a number\n",
               (unsigned long long)r->non_finite);
}

/* JSON has no infinity and no NaN. */
static json_t *number(double x)
{
    return isfinite(x) ? json_real(x) : json_null();
}

static json_t *numbers(const double *x, uint32_t count)
{
    json_t *array = json_array();
    for (uint32_t i = 0; i < count; i++)
        json_array_append_new(array, number(x[i]));
    return array;
}

static json_t *metrics_json(const lr_compare_result *r)
{
    json_t *metrics = json_object();
    for (int i = 0; i < LR_METRIC_COUNT; i++) {
        const lr_metric_result *m = &r->metrics[i];
        if (!m->measured)
            continue;
        json_t *one = json_pack("{s:b, s:o}", "pass", m->pass, "value", number(m->value));
        if (i != LR_METRIC_EXACT)
            json_object_set_new(one, "limit", number(m->limit));
        if (is_share(i)) {
            json_object_set_new(one, "pixels", json_integer((json_int_t)m->pixels));
            json_object_set_new(one, "allowed_percent", number(m->allowed));
        }
        json_object_set_new(metrics, lr_metric_name((lr_metric)i), one);
    }
    return metrics;
}

static json_t *regions_json(const lr_compare_result *r)
{
    json_t *list = json_array();
    for (uint32_t i = 0; i < r->regions_kept; i++) {
        const lr_region *region = &r->regions[i];
        json_array_append_new(
            list, json_pack("{s:I, s:I, s:I, s:I, s:I, s:[f,f], s:[I,I], s:o, s:o}", "x",
                            (json_int_t)region->box.x, "y", (json_int_t)region->box.y, "width",
                            (json_int_t)region->box.width, "height", (json_int_t)region->box.height,
                            "pixels", (json_int_t)region->pixels, "center", region->center_x,
                            region->center_y, "worst_pixel", (json_int_t)region->worst_x,
                            (json_int_t)region->worst_y, "worst", number(region->worst), "total",
                            number(region->total)));
    }
    return json_pack("{s:I, s:o}", "count", (json_int_t)r->region_count, "largest", list);
}

static json_t *cause_json(const lr_compare_result *r)
{
    char text[512];
    lr_compare_describe(r, text, sizeof text);
    json_t *cause = json_pack("{s:s, s:f, s:s}", "name", lr_cause_name(r->cause), "confidence",
                              r->confidence, "description", text);
    if (r->cause == LR_CAUSE_SHIFT)
        json_object_set_new(cause, "shift", json_pack("[i,i]", (int)r->dx, (int)r->dy));
    if (r->cause == LR_CAUSE_COLOR) {
        json_object_set_new(cause, "gain", numbers(r->gain, 3));
        json_object_set_new(cause, "offset", numbers(r->offset, 3));
        json_object_set_new(cause, "gamma", number(r->gamma));
    }
    return cause;
}

static json_t *noise_json(const lr_compare_result *r)
{
    const lr_rectangle *box = &r->noise_box;
    return json_pack("{s:I, s:I, s:I, s:I, s:o}", "x", (json_int_t)box->x, "y", (json_int_t)box->y,
                     "width", (json_int_t)box->width, "height", (json_int_t)box->height,
                     "standard_deviations", number(r->noise_z));
}

static json_t *difference_json(const lr_compare_result *r)
{
    return json_pack(
        "{s:{s:[I,I], s:o, s:o}, s:{s:[I,I], s:s, s:o}}", "first", "pixel", (json_int_t)r->first_x,
        (json_int_t)r->first_y, "reference", numbers(r->first_reference, r->channels), "test",
        numbers(r->first_test, r->channels), "largest", "pixel", (json_int_t)r->max_x,
        (json_int_t)r->max_y, "channel", channel_names[r->channels - 1][r->max_channel],
        "difference", number(r->max_difference));
}

json_t *comparison_json(const lr_compare_result *r, const char *reference, const char *test)
{
    json_t *json =
        json_pack("{s:s, s:b, s:b, s:o*, s:o*, s:[I,I], s:[I,I]}", "version", LR_VERSION, "pass",
                  r->pass, "same_size", r->same_size, "reference", json_string(reference), "test",
                  json_string(test), "size", (json_int_t)r->width, (json_int_t)r->height,
                  "test_size", (json_int_t)r->test_width, (json_int_t)r->test_height);
    json_t *cause = cause_json(r);
    if (!json || !cause) {
        json_decref(json);
        json_decref(cause);
        return NULL;
    }
    json_object_set_new(json, "cause", cause);
    if (!r->same_size)
        return json;
    json_object_set_new(json, "metrics", metrics_json(r));
    json_object_set_new(json, "compared_pixels", json_integer((json_int_t)r->compared));
    json_object_set_new(json, "different_pixels", json_integer((json_int_t)r->different_pixels));
    json_object_set_new(json, "non_finite_pixels", json_integer((json_int_t)r->non_finite));
    if (r->metrics[LR_METRIC_NOISE].measured)
        json_object_set_new(json, "noise", noise_json(r));
    json_object_set_new(json, "converted", json_boolean(r->converted));
    if (r->different) {
        json_object_set_new(json, "difference", difference_json(r));
        json_object_set_new(json, "regions", regions_json(r));
    }
    return json;
}
