#include "cli/load.h"
#include "cli/output.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct values {
    load_values load;
    bool quiet;
} values;

static const option options[] = {
    LOAD_OPTIONS(values),
    {.name = "quiet",
     .letter = 'q',
     .kind = OPTION_FLAG,
     .offset = offsetof(values, quiet),
     .help = "print errors only, not what is left out"},
};

/* Each line as a message of its own. */
static void print_notes(const char *path, const char *notes)
{
    while (*notes) {
        int length = (int)strcspn(notes, "\n");
        print_warning("%s: %.*s", path, length, notes);
        notes += length + (notes[length] == '\n');
    }
}

static int convert(const lr_scene *scene, const char *path, lr_scene_format format, bool quiet)
{
    lr_error error = {0};
    char *notes = NULL;
    if (lr_scene_write(scene, path, format, &notes, &error) != LR_OK) {
        return report_failure(&error);
    }
    if (notes && !quiet) {
        print_notes(path, notes);
    }
    free(notes);
    return EXIT_FINE;
}

static int run(const command *self, int argc, char **argv)
{
    values v = {0};
    int operands;
    parse_result parsed = options_parse(self, argc, argv, &v, &operands);
    if (parsed != PARSE_OK) {
        return (int)parsed;
    }
    const char *from = argv[0], *to = argv[1];
    lr_scene_format format;
    if (!lr_scene_format_from_path(to, &format)) {
        return wrong_usage(self, "OUT must end in .yaml, .pov, .dat or .tac");
    }
    if (same_file(from, to)) {
        return wrong_usage(self, "OUT would replace the scene that is read");
    }
    int code = check_writable(to);
    lr_scene *scene = NULL;
    if (code == EXIT_FINE) {
        code = load_scene(from, &v.load, v.quiet, &scene, NULL);
    }
    if (code == EXIT_FINE) {
        code = convert(scene, to, format, v.quiet);
    }
    lr_scene_destroy(scene);
    return code;
}

const command command_convert = {
    .name = "convert",
    .operands = "IN OUT",
    .summary = "write a scene in another language",
    .details =
        "Reads the scene IN (\"-\" is standard input) and writes it to OUT, in the language\n"
        "that OUT's ending names: .yaml is lavaray's own, .pov POV-Ray 3.7's, .dat and\n"
        ".tac Tachyon's. Meshes of a .yaml become binary PLY files beside it, pictures\n"
        "are copied there. What the language cannot say is told, with how often it is\n"
        "there. Needs no Vulkan.",
    .examples = "  lavaray convert gears.nff gears.yaml\n"
                "  lavaray convert scene.yaml scene.pov",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .min_operands = 2,
    .max_operands = 2,
    .run = run,
};
