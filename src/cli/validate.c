#include "cli/load.h"

#include <limits.h>
#include <stddef.h>
#include <stdio.h>

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
     .help = "print errors only"},
};

static const char *plural(uint32_t count)
{
    return count == 1 ? "" : "s";
}

static int run(const command *self, int argc, char **argv)
{
    values v = {0};
    int operands;
    parse_result parsed = options_parse(self, argc, argv, &v, &operands);
    if (parsed != PARSE_OK) {
        return (int)parsed;
    }
    int code = EXIT_FINE;
    for (int i = 0; i < operands; i++) {
        lr_scene *scene = NULL;
        int result = load_scene(argv[i], &v.load, v.quiet, &scene, NULL);
        code = result > code ? result : code;
        if (result == EXIT_FINE && !v.quiet) {
            lr_scene_info info;
            lr_scene_get_info(scene, &info);
            printf("%s: ok, %u object%s, %u light%s, %u material%s, %u camera%s", argv[i],
                   (unsigned)info.objects, plural(info.objects), (unsigned)info.lights,
                   plural(info.lights), (unsigned)info.materials, plural(info.materials),
                   (unsigned)info.cameras, plural(info.cameras));
            if (info.meshes > 0) {
                printf(", %u mesh%s, %llu triangle%s", (unsigned)info.meshes,
                       info.meshes == 1 ? "" : "es", (unsigned long long)info.triangles,
                       info.triangles == 1 ? "" : "s");
            }
            putchar('\n');
        }
        lr_scene_destroy(scene);
    }
    return code;
}

const command command_validate = {
    .name = "validate",
    .operands = "SCENE...",
    .summary = "check scenes and print all their errors, rendering nothing",
    .details = "Reads each SCENE (\"-\" is standard input) and prints all that is wrong with it,\n"
               "with line and column. Needs no Vulkan. Exit code 3 when a scene is invalid, 5\n"
               "when one cannot be read.",
    .examples = "  lavaray validate scenes/*.yaml\n"
                "  lavaray validate -q - < scene.yaml",
    .options = options,
    .option_count = sizeof options / sizeof *options,
    .min_operands = 1,
    .max_operands = INT_MAX,
    .run = run,
};
