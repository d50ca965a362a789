#include "tester/settings.h"

#include "base/memory.h"
#include "scene/read.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const lr_test_formats[] = {"png", "exr", "pfm", "ppm", "pgm", "hdr", NULL};

#define MEMBER(member) .offset = offsetof(lr_case_settings, member)
#define RANGE(low, high) .minimum = (low), .maximum = (high)
#define TIMEOUT_MAX 86400 /* seconds */

static const lr_field case_fields[] = {
    {"scene", LR_FIELD_TEXT, 0, MEMBER(scene), .derived = "the path of a scene"},
    {"run", LR_FIELD_TEXTS, .flags = 0},
    {"args", LR_FIELD_TEXTS, .flags = 0},
    {"size", LR_FIELD_TEXT, 0, MEMBER(size), .derived = "width and height such as 640x480"},
    {"samples", LR_FIELD_INTEGER, 0, RANGE(1, 65536), MEMBER(samples)},
    {"depth", LR_FIELD_INTEGER, 0, RANGE(0, 64), MEMBER(depth)},
    {"seed", LR_FIELD_INTEGER, 0, RANGE(0, 4294967295.0), MEMBER(seed)},
    {"device", LR_FIELD_TEXT, 0, MEMBER(device), .derived = "auto, cpu, gpu, or a device's name"},
    {"timeout", LR_FIELD_NUMBER, LR_ABOVE, RANGE(0, TIMEOUT_MAX), MEMBER(timeout)},
    {"format", LR_FIELD_CHOICE, 0, MEMBER(format), .choices = lr_test_formats},
    {"compare", LR_FIELD_MAPPING, .flags = 0},
};
static const lr_record case_record = {
    .name = "the case", .fields = case_fields, .count = sizeof case_fields / sizeof *case_fields};

static const lr_field top_fields[] = {
    {"defaults", LR_FIELD_RECORD, .record = &case_record},
    {"cases", LR_FIELD_MAPPING, .flags = 0},
};
static const lr_record top_record = {
    .name = "the tests", .fields = top_fields, .count = sizeof top_fields / sizeof *top_fields};

static bool knows_key(const char *name)
{
    size_t length = strlen(name);
    return lr_field_find(&case_record, name, length) || lr_field_find(&top_record, name, length);
}

const lr_language lr_settings_language = {
    .subject = "tests file",
    .examples = "defaults and cases",
    .relief = "split the tests into several folders",
    .knows_key = knows_key,
};

/* ---- Parts of a case ----------------------------------------------------------------------- */

typedef struct context {
    lr_settings *settings;
    lr_reader reader;
} context;

static void wrong(context *c, const lr_node *node, const char *message)
{
    lr_report_add(c->reader.report, node->offset, "%s", message);
}

static bool is_text(const lr_node *node)
{
    return (node->kind == LR_NODE_PLAIN || node->kind == LR_NODE_QUOTED) &&
           strlen(node->text) == node->count;
}

/* A list of texts; NULL after reporting, or when memory is out. */
static const char *const *read_texts(context *c, const lr_node *node, const char *what,
                                     const char *expected, uint32_t *count)
{
    lr_settings *s = c->settings;
    if (node->kind != LR_NODE_LIST || node->count == 0) {
        lr_report_type(&c->reader, node, what, expected);
        return NULL;
    }
    bool good = true;
    for (uint32_t i = 0; i < node->count; i++) {
        const lr_node *item = node->items[i];
        if (is_text(item))
            continue;
        good = false;
        if (item->kind == LR_NODE_MAP)
            wrong(c, item, "braces without quotes are a mapping, expected quotes: \"{output}\"");
        else
            lr_report_type(&c->reader, item, "this item", "a text; put quotes around an empty one");
    }
    if (!good)
        return NULL;
    const char **texts = lr_alloc(node->count, sizeof *texts);
    if (!texts ||
        !lr_array_reserve((void **)&s->lists, s->list_count, &s->list_capacity, sizeof *s->lists)) {
        free(texts);
        c->reader.report->no_memory = true;
        return NULL;
    }
    s->lists[s->list_count++] = texts;
    for (uint32_t i = 0; i < node->count; i++)
        texts[i] = node->items[i]->text;
    *count = node->count;
    return texts;
}

static void read_run(context *c, const lr_node *node, lr_case_settings *settings)
{
    settings->run = read_texts(c, node, "run", "a command such as [python3, draw.py, \"{output}\"]",
                               &settings->run_count);
    for (uint32_t i = 0; settings->run && i < settings->run_count; i++)
        if (strstr(settings->run[i], "{output}"))
            return;
    if (settings->run)
        wrong(c, node,
              "run never says \"{output}\", the path that the command must write its picture to");
}

static bool is_size(const char *text)
{
    unsigned width, height;
    char end;
    return sscanf(text, "%5ux%5u%c", &width, &height, &end) == 2 && width >= 1 && height >= 1 &&
           width <= 32768 && height <= 32768 && text[0] >= '1' && text[0] <= '9';
}

/* [x, y, width, height] */
static bool read_rectangle(context *c, const lr_node *node, lr_rectangle *rectangle)
{
    static const char *const names[] = {"x", "y", "width", "height"};
    uint32_t values[4];
    if (node->kind != LR_NODE_LIST || node->count != 4) {
        lr_report_type(&c->reader, node, "this rectangle", "[x, y, width, height] in pixels");
        return false;
    }
    for (int i = 0; i < 4; i++) {
        lr_field field = {names[i], LR_FIELD_INTEGER, 0, RANGE(i < 2 ? 0 : 1, 1 << 28)};
        if (!lr_read_value(&c->reader, node->items[i], &field, &values[i]))
            return false;
    }
    *rectangle = (lr_rectangle){values[0], values[1], values[2], values[3]};
    return true;
}

static void read_ignored(context *c, const lr_node *node, lr_compare_options *options)
{
    if (node->kind != LR_NODE_LIST || node->count == 0 || node->count > LR_IGNORED_MAX) {
        lr_report_type(&c->reader, node, "ignore",
                       "a list of at most 64 rectangles such as [[x, y, width, height]]");
        return;
    }
    for (uint32_t i = 0; i < node->count; i++)
        if (read_rectangle(c, node->items[i], &options->ignored[i]))
            options->ignored_count = i + 1;
}

/* Keys of `compare` beside the metrics' own names. */
static const char *const compare_keys[] = {"abs-percent", "rel-percent", "ppd", "mask", "ignore"};
enum { COMPARE_KEYS = sizeof compare_keys / sizeof *compare_keys };

static bool is_compare_key(const char *name)
{
    bool found = false;
    for (int i = 0; i < COMPARE_KEYS; i++)
        found |= strcmp(name, compare_keys[i]) == 0;
    for (int i = 0; i < LR_METRIC_COUNT; i++)
        found |= strcmp(name, lr_metric_name((lr_metric)i)) == 0;
    return found;
}

static void report_compare_key(context *c, const lr_node *key)
{
    char shown[LR_SHOWN_MAX], message[LR_SHOWN_MAX + 128];
    lr_nearest nearest = {.text = key->text, .length = key->count};
    for (int i = 0; i < LR_METRIC_COUNT; i++)
        lr_nearest_offer(&nearest, lr_metric_name((lr_metric)i));
    for (int i = 0; i < COMPARE_KEYS; i++)
        lr_nearest_offer(&nearest, compare_keys[i]);
    snprintf(message, sizeof message, "unknown metric \"%s\"%s",
             lr_shown(shown, key->text, key->count),
             nearest.best ? "" : "; lavaray compare --help lists them");
    lr_report_unknown(&c->reader, key, message, &nearest);
}

static void read_metric(context *c, const lr_node *key, const lr_node *value,
                        lr_case_settings *settings)
{
    lr_error error = {0};
    if (strcmp(key->text, lr_metric_name(LR_METRIC_NOISE)) == 0) {
        wrong(c, key,
              "noise needs variances or halves, which cases do not have; see lavaray "
              "compare --help");
    } else if (!is_text(value)) {
        lr_report_type(&c->reader, value, key->text, "a limit");
    } else if (lr_compare_set(&settings->compare, key->text, value->text, &error) != LR_OK) {
        lr_report_add(c->reader.report, value->offset, "%s: %s", key->text, error.message);
    }
}

static void read_compare(context *c, const lr_node *node, lr_case_settings *settings)
{
    settings->compare = (lr_compare_options){0};
    settings->mask = NULL;
    if (node->kind != LR_NODE_MAP) {
        lr_report_type(&c->reader, node, "compare",
                       "metrics and their limits such as {flip-mean: 0.01}");
        return;
    }
    for (uint32_t i = 0; i < node->count; i++) {
        const lr_node *key = lr_map_key(node, i), *value = lr_map_value(node, i);
        lr_field mask = {"mask", LR_FIELD_TEXT, 0, .derived = "the path of a picture"};
        if (!is_compare_key(key->text))
            report_compare_key(c, key);
        else if (strcmp(key->text, "ignore") == 0)
            read_ignored(c, value, &settings->compare);
        else if (strcmp(key->text, "mask") == 0)
            lr_read_value(&c->reader, value, &mask, &settings->mask);
        else
            read_metric(c, key, value, settings);
    }
}

/* ---- Cases --------------------------------------------------------------------------------- */

/* Reads a mapping of settings over those in *settings, which are the defaults. */
static void read_case(context *c, const lr_node *node, lr_case_settings *settings)
{
    lr_case_settings read = *settings;
    lr_case_settings own;
    lr_given given;
    lr_read_record(&c->reader, node, node, &case_record, &own, &given);
#define TAKE(member)                                                                               \
    if (lr_given_value(&given, &case_record, #member))                                             \
    read.member = own.member
    TAKE(scene);
    TAKE(size);
    TAKE(device);
    TAKE(timeout);
    TAKE(format);
    TAKE(samples);
    TAKE(depth);
    TAKE(seed);
#undef TAKE
    read.has_format |= lr_given_value(&given, &case_record, "format") != NULL;
    read.has_samples |= lr_given_value(&given, &case_record, "samples") != NULL;
    read.has_depth |= lr_given_value(&given, &case_record, "depth") != NULL;
    read.has_seed |= lr_given_value(&given, &case_record, "seed") != NULL;
    const lr_node *size = lr_given_value(&given, &case_record, "size");
    if (size && is_text(size) && !is_size(size->text))
        lr_report_type(&c->reader, size, "size",
                       "width and height from 1 to 32768, such as 640x480");
    const lr_node *run = lr_given_value(&given, &case_record, "run");
    const lr_node *args = lr_given_value(&given, &case_record, "args");
    const lr_node *compare = lr_given_value(&given, &case_record, "compare");
    read.has_run |= run != NULL;
    if (run)
        read_run(c, run, &read);
    if (args)
        read.args = read_texts(c, args, "args", "a list of flags such as [--exposure, \"1\"]",
                               &read.args_count);
    if (compare)
        read_compare(c, compare, &read);
    *settings = read;
}

/* Names become paths below the golden and output folders, and stay there. */
static bool is_name(const lr_node *key)
{
    if (!is_text(key) || key->count == 0 || key->count > 200 || key->text[0] == '/')
        return false;
    for (const char *part = key->text; part; part = strchr(part, '/')) {
        part += *part == '/';
        if (part[0] == '.' || part[0] == '/' || part[0] == 0)
            return false;
    }
    for (const char *c = key->text; *c; c++)
        if ((unsigned char)*c < 0x20)
            return false;
    return true;
}

static void read_named(context *c, const lr_node *key, const lr_node *value)
{
    lr_settings *s = c->settings;
    if (!is_name(key)) {
        wrong(c, key,
              "this cannot be a case's name, expected at most 200 characters, no part of "
              "it empty or beginning with a dot");
        return;
    }
    if (!lr_array_reserve((void **)&s->cases, s->count, &s->capacity, sizeof *s->cases)) {
        c->reader.report->no_memory = true;
        return;
    }
    lr_named_settings *item = &s->cases[s->count++];
    *item = (lr_named_settings){key->text, key->offset, s->defaults};
    if (value->kind != LR_NODE_EMPTY) /* a name alone takes the defaults */
        read_case(c, value, &item->settings);
}

static void read_top(context *c, const lr_node *root)
{
    lr_given given;
    char nothing; /* both keys are structure */
    lr_read_record(&c->reader, root, root, &top_record, &nothing, &given);
    const lr_node *defaults = lr_given_value(&given, &top_record, "defaults");
    const lr_node *cases = lr_given_value(&given, &top_record, "cases");
    if (defaults) {
        read_case(c, defaults, &c->settings->defaults);
        if (c->settings->defaults.scene)
            wrong(c, defaults, "a scene cannot be the default of all cases");
    }
    if (cases && cases->kind != LR_NODE_MAP) {
        lr_report_type(&c->reader, cases, "cases",
                       "a mapping of names to settings such as `ball: {samples: 4}`");
        return;
    }
    for (uint32_t i = 0; cases && i < cases->count; i++)
        read_named(c, lr_map_key(cases, i), lr_map_value(cases, i));
}

void lr_settings_read(lr_settings *settings, lr_report *report)
{
    context c = {.settings = settings, .reader = {.report = report}};
    if (!lr_text_check(report))
        return;
    lr_tree_read(&settings->tree, report);
    c.reader.locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (!c.reader.locale) {
        report->no_memory = true;
        return;
    }
    if (settings->tree.root)
        read_top(&c, settings->tree.root);
    freelocale(c.reader.locale);
}

void lr_settings_free(lr_settings *settings)
{
    for (uint32_t i = 0; i < settings->list_count; i++)
        free(settings->lists[i]);
    free(settings->lists);
    free(settings->cases);
    lr_tree_free(&settings->tree);
    *settings = (lr_settings){0};
}
