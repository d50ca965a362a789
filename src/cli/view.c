#include "cli/cli.h"
#include "cli/load.h"
#include "cli/picture.h"
#include "cli/progress.h"
#include "preview/preview.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>

typedef struct values {
    const char *screenshot, *events;
    double exposure; /* NaN: not given */
    picture_values picture;
    load_values load;
    bool quiet;
} values;

#define AT(member) .offset = offsetof(values, member)

static const option options[] = {
    PICTURE_OPTIONS(values),
    {.name = "exposure",
     .kind = OPTION_REAL,
     AT(exposure),
     .value = "EV",
     .min = -64,
     .max = 64,
     .help = "stops, -64 to 64; default: the scene's"},
    {.name = "screenshot",
     .kind = OPTION_TEXT,
     AT(screenshot),
     .value = "FILE",
     .help = "the name of screenshots, .png, .ppm, .pfm or .exr;\n"
             "FILE-1, FILE-2 ... follow, none is replaced;\n"
             "default: as the scene is called, .png, here",
     .also = "output|o"},
    LOAD_OPTIONS(values),
    {.name = "quiet",
     .letter = 'q',
     .kind = OPTION_FLAG,
     AT(quiet),
     .help = "no progress and no notes: only warnings and errors",
     .also = "silent"},
    {.name = "events",
     .kind = OPTION_TEXT,
     AT(events),
     .value = "FILE",
     .help = "log what is shown when",
     .for_tests = true},
};

static bool stop_wanted(void)
{
    return interrupted();
}

static void print_line(const char *text)
{
    fputs(text, stdout);
    fflush(stdout);
}

static lr_preview_options make_options(const values *v, const char *path)
{
    return (lr_preview_options){
        .path = path,
        .load = {.allow_path = v->load.allow_path,
                 .max_triangles = (uint64_t)v->load.max_triangles,
                 .max_memory = (uint64_t)v->load.max_memory,
                 .frame = (double)v->load.frame},
        .device = {.select = v->picture.device, .validation = validation_wanted()},
        .render = picture_options(&v->picture),
        .has_exposure = !isnan(v->exposure),
        .exposure = v->exposure,
        .screenshot = v->screenshot,
        .interrupted = stop_wanted,
        .events = v->events ? fopen(v->events, "we") : NULL,
        .print = print_line,
    };
}

static int check_values(const command *self, const values *v, const char *path)
{
    lr_format format;
    if (path[0] == '-' && path[1] == '\0')
        return wrong_usage(self, "view follows a file, and standard input is none");
    if (v->screenshot && !lr_format_from_path(v->screenshot, &format))
        return wrong_usage(self, "the name of screenshots must end in .png, .ppm, .pfm or .exr");
    return EXIT_FINE;
}

static int show(values *v, const char *path)
{
    lr_preview_options preview = make_options(v, path);
    lr_scene *scene = NULL;
    lr_file_list files = {0};
    v->load.files = &files;
    lr_error error = {0};
    progress p;
    progress_start(&p, v->quiet);
    progress_phase(&p, "reading scene");
    int code = load_scene(path, &v->load, v->quiet, &scene, &p);
    progress_clear(&p);
    if (code == EXIT_FINE && !v->quiet) {
        lr_scene_info info;
        lr_scene_get_info(scene, &info);
        if (info.tone != LR_TONE_NONE || info.white != 0)
            print_warning("note: the window shows light without the scene's tone map and white "
                          "balance");
    }
    if (code == EXIT_FINE && interrupted()) {
        lr_scene_destroy(scene);
        print_error("interrupted");
        code = EXIT_INTERRUPTED;
    } else if (code == EXIT_FINE) {
        lr_status status = lr_preview_run(scene, &files, &preview, &error);
        error.status = status;
        if (status != LR_OK)
            code = report_failure(&error);
    }
    if (preview.events)
        fclose(preview.events);
    lr_file_list_free(&files);
    return code;
}

static int run(const command *self, int argc, char **argv)
{
    values v = {.picture = PICTURE_DEFAULTS, .exposure = NAN};
    int operands;
    parse_result parsed = options_parse(self, argc, argv, &v, &operands);
    if (parsed != PARSE_OK)
        return (int)parsed;
    int code = check_values(self, &v, argv[0]);
    if (code != EXIT_FINE)
        return code;
    lr_error error = {0};
    lr_status status = lr_preview_open(&error);
    if (status != LR_OK)
        return report_failure(&error);
    catch_interrupts();
    code = show(&v, argv[0]);
    lr_preview_close();
    return code;
}

const command command_view = {
    .name = "view",
    .operands = "SCENE",
    .summary = "show a scene in a window that follows its file",
    .details = "Opens a window that shows SCENE, coarse at once and then finer and finer, until\n"
               "it is the picture that lavaray render makes. The camera moves with the mouse,\n"
               "and the picture follows SCENE and the files that it names as they are edited.\n"
               "h in the window shows all keys.",
    .examples = "  lavaray view scenes/showcase.yaml\n"
                "  lavaray view model.glb --size 1280x720 --spp 64 --device gpu",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .min_operands = 1,
    .max_operands = 1,
    .run = run,
};
