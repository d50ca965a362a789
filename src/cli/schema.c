#include "cli/cli.h"

#include <stdio.h>
#include <stdlib.h>

static int run(const command *self, int argc, char **argv)
{
    int operands;
    parse_result parsed = options_parse(self, argc, argv, NULL, &operands);
    if (parsed != PARSE_OK) {
        return (int)parsed;
    }
    char *schema = lr_scene_schema();
    if (!schema) {
        print_error("out of memory");
        return EXIT_DEVICE;
    }
    fputs(schema, stdout);
    free(schema);
    return EXIT_FINE;
}

const command command_schema = {
    .name = "schema",
    .operands = "",
    .summary = "print the JSON Schema of the scene language",
    .details = "Prints the JSON Schema of the scene language. Editors that know YAML schemas use\n"
               "it to complete keys and to mark errors.",
    .examples = "  lavaray schema > lavaray.schema.json",
    .run = run,
};
