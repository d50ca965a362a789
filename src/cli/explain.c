#include "cli/explain_print.h"
#include "cli/load.h"
#include "cli/picture.h"
#include "cli/progress.h"

#include <math.h>

typedef struct values {
    option_point pixel;
    int64_t sample;
    picture_values picture;
    load_values load;
    bool json;
} values;

static const option options[] = {
    {.name = "pixel",
     .kind = OPTION_POINT,
     .offset = offsetof(values, pixel),
     .value = "X,Y",
     .max = 32767,
     .help = "which, from the picture's top left corner, 0,0",
     .also = "at|xy"},
    {.name = "sample",
     .kind = OPTION_INTEGER,
     .offset = offsetof(values, sample),
     .value = "K",
     .min = 0,
     .max = 65535,
     .help = "which of the pixel's samples; default: 0, the first"},
    {.name = "json", .kind = OPTION_FLAG, .offset = offsetof(values, json), .help = "print JSON"},
    PICTURE_OPTIONS(values),
    LOAD_OPTIONS(values),
};

double explained_light(uint64_t steps)
{
    return ldexp((double)steps, -36);
}

static int explain(const values *v, const char *path, const lr_scene *scene, lr_device *device,
                   progress *p)
{
    lr_error error = {0};
    lr_explanation explanation;
    lr_render_options render_options = picture_options(&v->picture);
    render_options.progress = progress_update;
    render_options.user = p;
    progress_phase(p, "tracing");
    lr_status status = lr_explain(device, scene, &render_options, v->pixel.x, v->pixel.y,
                                  (uint32_t)v->sample, &explanation, &error);
    progress_clear(p);
    if (status != LR_OK) {
        error.status = status;
        return report_failure(&error);
    }
    int code = check_validation(device, EXIT_FINE);
    const explained_pixel pixel = {path, v->picture.camera, scene, &explanation};
    if (code == EXIT_FINE && !lr_device_is_exact(device)) {
        print_warning("%s fails the arithmetic self-test: other devices may find other numbers",
                      lr_device_get_info(device)->name);
    }
    if (code == EXIT_FINE && v->json) {
        code = print_explanation_json(&pixel);
    } else if (code == EXIT_FINE) {
        print_explanation(&pixel);
    }
    lr_explanation_free(&explanation);
    return code;
}

static int run(const command *self, int argc, char **argv)
{
    values v = {.picture = PICTURE_DEFAULTS};
    int operands;
    parse_result parsed = options_parse(self, argc, argv, &v, &operands);
    if (parsed != PARSE_OK) {
        return (int)parsed;
    }
    if (!v.pixel.given) {
        return wrong_usage(self, "which pixel? Give --pixel X,Y");
    }
    catch_interrupts();
    progress p;
    progress_start(&p, false);
    progress_phase(&p, "reading scene");
    lr_scene *scene = NULL;
    lr_device *device = NULL;
    int code = load_scene(argv[0], &v.load, true, &scene, &p);
    if (code != EXIT_FINE) {
        return code;
    }
    progress_phase(&p, "opening device");
    lr_error error = {0};
    lr_device_desc desc = {.select = v.picture.device, .validation = validation_wanted()};
    error.status = lr_device_open(&desc, &device, &error);
    if (error.status == LR_OK) {
        code = explain(&v, argv[0], scene, device, &p);
    } else {
        progress_clear(&p);
        code = report_failure(&error);
    }
    lr_device_close(device);
    lr_scene_destroy(scene);
    return code;
}

const command command_explain = {
    .name = "explain",
    .operands = "SCENE --pixel X,Y",
    .summary = "tell how a pixel came by its colour: the tree of its rays",
    .details = "Traces one pixel of SCENE again and prints the tree of its rays: what each meets\n"
               "and where, which lights reach that point and what shadows it from the others,\n"
               "where rays are reflected and refracted, and the light that each brings. One\n"
               "sample is told in detail, and the sum of all. The same kernels on the same\n"
               "device make the picture, so the numbers are the picture's own.",
    .examples = "  lavaray explain scenes/sheet.yaml --pixel 320,240\n"
                "  lavaray explain scenes/refraction.yaml --pixel 400,250 --spp 1 --depth 2\n"
                "  lavaray explain room.glb --pixel 10,20 --sample 3 --json",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .min_operands = 1,
    .max_operands = 1,
    .run = run,
};
