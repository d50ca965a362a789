#include "cli/cli.h"
#include "cli/compare_report.h"
#include "cli/json.h"
#include "cli/output.h"

#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "compare/compare.h"

typedef struct values {
    bool exact, quiet;
    const char *limits[LR_METRIC_COUNT];
    const char *abs_percent, *rel_percent, *ppd;
    const char *mask, *reference_variance, *test_variance, *reference_half, *test_half;
    option_texts ignored;
    const char *diff, *json;
} values;

#define AT(member) .offset = offsetof(values, member)

static const option options[] = {
    {.name = "exact",
     .kind = OPTION_FLAG,
     AT(exact),
     .help = "no pixel may differ; the default when no metric is\ngiven"},
#define X(id, metric, stands, text)                                                                \
    {.name = metric,                                                                               \
     .kind = OPTION_TEXT,                                                                          \
     .offset = offsetof(values, limits) + LR_METRIC_##id * sizeof(const char *),                   \
     .value = stands,                                                                              \
     .help = text,                                                                                 \
     .also = LR_METRIC_##id == LR_METRIC_ABS       ? "fail"                                        \
             : LR_METRIC_##id == LR_METRIC_MAX_ABS ? "hardfail|hard-fail"                          \
                                                   : NULL},
    LR_LIMITS(X)
#undef X
        {.name = "abs-percent",
         .kind = OPTION_TEXT,
         AT(abs_percent),
         .value = "P",
         .help = "of the pixels that --abs lets pass all the same;\ndefault: 0",
         .also = "failpercent|fail-percent"},
    {.name = "rel-percent",
     .kind = OPTION_TEXT,
     AT(rel_percent),
     .value = "P",
     .help = "... that --rel lets pass"},
    {.name = "ppd",
     .kind = OPTION_TEXT,
     AT(ppd),
     .value = "N",
     .help = "pixels per degree of the eye, for FLIP; default: 67,\n"
             "a 4K screen of 0.7 m seen from 0.7 m"},
    {.name = "mask",
     .kind = OPTION_TEXT,
     AT(mask),
     .value = "FILE",
     .help = "a picture of the same size: white is compared, black\nis not"},
    {.name = "ignore",
     .kind = OPTION_REPEATED,
     AT(ignored),
     .value = "X,Y,W,H",
     .help = "leave out this rectangle, in pixels from the top left\n"
             "corner; may be given many times",
     .also = "exclude"},
    {.name = "reference-variance",
     .kind = OPTION_TEXT,
     AT(reference_variance),
     .value = "FILE",
     .help = "for --noise: a float picture of each pixel's variance,\n"
             "that of its mean and not of one sample"},
    {.name = "test-variance",
     .kind = OPTION_TEXT,
     AT(test_variance),
     .value = "FILE",
     .help = "the same for TEST; a picture without one is taken to\nhave no noise",
     .also = "variance"},
    {.name = "reference-half",
     .kind = OPTION_TEXT,
     AT(reference_half),
     .value = "FILE",
     .help = "for --noise: a second REF of as many samples and\nanother seed"},
    {.name = "test-half",
     .kind = OPTION_TEXT,
     AT(test_half),
     .value = "FILE",
     .help = "a second TEST",
     .also = "halves|half"},
    {.name = "diff",
     .letter = 'd',
     .kind = OPTION_TEXT,
     AT(diff),
     .value = "FILE",
     .help = "write a heat map (.png, .ppm), or with .pfm the error\n"
             "of each pixel, -1 where nothing is compared",
     .also = "output|heat-map|map"},
    {.name = "json",
     .kind = OPTION_TEXT,
     AT(json),
     .value = "FILE",
     .help = "write the results as JSON; \"-\" is standard output,\n"
             "instead of the summary"},
    {.name = "quiet",
     .letter = 'q',
     .kind = OPTION_FLAG,
     AT(quiet),
     .help = "no summary: the exit code tells"},
};

static int set(const command *self, lr_compare_options *to, const char *name, const char *value)
{
    lr_error error = {0};
    if (value && lr_compare_set(to, name, value, &error) != LR_OK) {
        print_error("--%s: %s; see lavaray %s --help", name, error.message, self->name);
        return EXIT_USAGE;
    }
    return EXIT_FINE;
}

static int set_limits(const command *self, const values *v, lr_compare_options *to)
{
    to->wanted[LR_METRIC_EXACT] = v->exact;
    int code = EXIT_FINE;
    for (int i = 0; i < LR_METRIC_COUNT && code == EXIT_FINE; i++)
        code = set(self, to, lr_metric_name((lr_metric)i), v->limits[i]);
    const struct {
        const char *name, *value;
    } others[] = {
        {"abs-percent", v->abs_percent}, {"rel-percent", v->rel_percent}, {"ppd", v->ppd}};
    for (int i = 0; i < 3 && code == EXIT_FINE; i++)
        code = set(self, to, others[i].name, others[i].value);
    for (unsigned i = 0; i < v->ignored.count && code == EXIT_FINE; i++) {
        option_rectangle r;
        if (!parse_rectangle(v->ignored.items[i], UINT32_MAX, &r)) {
            print_error("--ignore must be X,Y,W,H in pixels such as 10,20,64,48, not '%.100s';"
                        " see lavaray compare --help",
                        v->ignored.items[i]);
            return EXIT_USAGE;
        }
        to->ignored[to->ignored_count++] = (lr_rectangle){r.x, r.y, r.width, r.height};
    }
    return code;
}

static int check_values(const command *self, const values *v, const lr_compare_options *to)
{
    if ((v->abs_percent && !to->wanted[LR_METRIC_ABS]) ||
        (v->rel_percent && !to->wanted[LR_METRIC_REL])) {
        return wrong_usage(self, "--abs-percent goes with --abs, and --rel-percent with --rel");
    }
    bool variances = v->reference_variance || v->test_variance;
    bool halves = v->reference_half || v->test_half;
    if (to->wanted[LR_METRIC_NOISE] != (variances || halves)) {
        return wrong_usage(self, "--noise goes with variances or halves of the pictures");
    }
    if (variances && halves) {
        return wrong_usage(self, "variances and halves do not go together");
    }
    if (halves && !(v->reference_half && v->test_half)) {
        return wrong_usage(self, "both --reference-half and --test-half are needed");
    }
    lr_format format;
    if (v->diff && (!lr_format_from_path(v->diff, &format) || strcmp(v->diff, "-") == 0)) {
        print_error("%s: the name must end in .png, .ppm or .pfm; see lavaray compare --help",
                    v->diff);
        return EXIT_USAGE;
    }
    return EXIT_FINE;
}

/* The pictures of a comparison; a path that is NULL is not given. */
enum {
    REFERENCE,
    TEST,
    MASK,
    REFERENCE_VARIANCE,
    TEST_VARIANCE,
    REFERENCE_HALF,
    TEST_HALF,
    INPUTS
};

static int check_files(const command *self, const values *v, const char *const *paths)
{
    const char *const outputs[] = {v->diff, v->json};
    int from_stdin = 0;
    for (int i = 0; i < INPUTS; i++) {
        from_stdin += paths[i] && strcmp(paths[i], "-") == 0;
        for (int k = 0; k < 2 && paths[i]; k++)
            if (outputs[k] && strcmp(outputs[k], "-") != 0 && same_file(outputs[k], paths[i]))
                return wrong_usage(self, "an output would replace a picture that is compared");
    }
    if (from_stdin > 1) {
        return wrong_usage(self, "only one picture can come from standard input");
    }
    if (v->diff && v->json && strcmp(v->diff, v->json) == 0) {
        return wrong_usage(self, "the heat map and the JSON have the same name");
    }
    int code = v->diff ? check_writable(v->diff) : EXIT_FINE;
    return code == EXIT_FINE && v->json ? check_writable(v->json) : code;
}

static int read_inputs(const char *const *paths, lr_image *images, lr_compare_options *to)
{
    const lr_image **const places[INPUTS] = {
        [MASK] = &to->mask,
        [REFERENCE_VARIANCE] = &to->reference_variance,
        [TEST_VARIANCE] = &to->test_variance,
        [REFERENCE_HALF] = &to->reference_half,
        [TEST_HALF] = &to->test_half,
    };
    for (int i = 0; i < INPUTS; i++) {
        lr_error error = {0};
        if (!paths[i])
            continue;
        error.status = lr_image_read(paths[i], &images[i], &error);
        if (error.status != LR_OK)
            return report_failure(&error);
        if (places[i])
            *places[i] = &images[i];
    }
    return EXIT_FINE;
}

/* What goes with the reference has its size; that of the test is compared. */
static int check_sizes(const char *const *paths, const lr_image *images)
{
    const lr_image *reference = &images[REFERENCE];
    for (int i = MASK; i < INPUTS; i++) {
        if (!paths[i] ||
            (images[i].width == reference->width && images[i].height == reference->height))
            continue;
        print_error("%s: has %u x %u pixels, but %s has %u x %u; they must be the same", paths[i],
                    images[i].width, images[i].height, paths[REFERENCE], reference->width,
                    reference->height);
        return EXIT_USAGE;
    }
    return EXIT_FINE;
}

/* The errors themselves, in all three channels. */
static lr_status write_errors(const lr_compare_result *result, const char *path, lr_error *error)
{
    lr_encoding encoding = {.format = LR_FORMAT_PFM};
    lr_picture picture = {.width = result->width, .height = result->height};
    lr_status status = lr_compare_error_map(result, &picture, error);
    if (status == LR_OK)
        status = lr_picture_write(&picture, path, &encoding, error);
    lr_picture_free(&picture);
    return status;
}

static int write_diff(const char *path, const lr_image *reference, const lr_compare_result *result)
{
    lr_encoding encoding = {0};
    lr_error error = {0};
    lr_picture picture = {0};
    lr_format_from_path(path, &encoding.format);
    if (encoding.format == LR_FORMAT_PFM) {
        error.status = write_errors(result, path, &error);
    } else {
        error.status = lr_compare_heat_map(reference, result, &picture, &error);
        if (error.status == LR_OK)
            error.status = lr_picture_write(&picture, path, &encoding, &error);
        lr_picture_free(&picture);
    }
    return error.status == LR_OK ? EXIT_FINE : report_failure(&error);
}

static int compare(const values *v, const char *const *paths, const lr_image *images,
                   const lr_compare_options *to)
{
    lr_compare_result result;
    lr_error error = {0};
    error.status = lr_compare(&images[REFERENCE], &images[TEST], to, &result, &error);
    if (error.status != LR_OK)
        return report_failure(&error);
    int code = EXIT_FINE;
    if (v->diff && result.same_size)
        code = write_diff(v->diff, &images[REFERENCE], &result);
    else if (v->diff)
        print_warning("%s: not written, the pictures have different sizes", v->diff);
    if (v->json && code == EXIT_FINE)
        code = write_json(comparison_json(&result, paths[REFERENCE], paths[TEST]), v->json);
    if (!v->quiet && !(v->json && strcmp(v->json, "-") == 0))
        print_comparison(&result, paths[REFERENCE], paths[TEST]);
    code = code == EXIT_FINE && !result.pass ? EXIT_DIFFERENT : code;
    lr_compare_result_free(&result);
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
    const char *const paths[INPUTS] = {
        argv[0],         argv[1],          v.mask,     v.reference_variance,
        v.test_variance, v.reference_half, v.test_half};
    lr_compare_options to = {.map = v.diff, .explain = !v.quiet || v.json || v.diff};
    int code = set_limits(self, &v, &to);
    if (code == EXIT_FINE)
        code = check_values(self, &v, &to);
    if (code == EXIT_FINE)
        code = check_files(self, &v, paths);
    if (code != EXIT_FINE) {
        return code;
    }
    lr_image images[INPUTS] = {0};
    code = read_inputs(paths, images, &to);
    if (code == EXIT_FINE) {
        code = check_sizes(paths, images);
    }
    if (code == EXIT_FINE) {
        code = compare(&v, paths, images, &to);
    }
    for (int i = 0; i < INPUTS; i++) {
        lr_image_free(&images[i]);
    }
    return code;
}

const command command_compare = {
    .name = "compare",
    .operands = "REF TEST",
    .summary = "compare two pictures: how much they differ, where and why",
    .details = "Compares the picture TEST with the reference REF (PNM, PNG, PFM, EXR, HDR, JPEG;\n"
               "\"-\" is standard input) by any set of metrics; all given must be within their\n"
               "limits. Exit code 0 when they are, 1 when one is not or the sizes differ, 2 when\n"
               "the command line is wrong, 5 when a picture cannot be read. Errors are of\n"
               "samples as stored, white being 1; docs/compare.md tells each metric's formula.",
    .examples = "  lavaray compare golden.png new.png\n"
                "  lavaray compare golden.png new.png --abs 2/255 --abs-percent 0.1 --max-abs 0.1\n"
                "  lavaray compare golden.exr new.exr --flip-mean 0.02 --diff diff.png\n"
                "  lavaray compare a.png b.png --rmse 0.01 --ignore 0,0,120,16 --json -\n"
                "  lavaray compare a1.pfm b1.pfm --noise 0.01 --reference-half a2.pfm\n"
                "      --test-half b2.pfm",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .min_operands = 2,
    .max_operands = 2,
    .run = run,
};
