#include "cli/json.h"

#include "cli/cli.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"

int write_json(json_t *json, const char *path)
{
    char *dumped = json ? json_dumps(json, JSON_INDENT(2)) : NULL;
    size_t length = dumped ? strlen(dumped) : 0;
    char *text = dumped ? realloc(dumped, length + 2) : NULL;
    json_decref(json);
    if (!text) {
        free(dumped);
        print_error("%s: cannot be written: the results cannot be expressed as JSON", path);
        return EXIT_DEVICE;
    }
    memcpy(text + length, "\n", 2);
    int code = EXIT_FINE;
    if (strcmp(path, "-") == 0) {
        fputs(text, stdout); /* main checks standard output at the end */
    } else {
        lr_error error = {0};
        error.status = lr_file_write(path, text, strlen(text), &error);
        code = error.status == LR_OK ? EXIT_FINE : report_failure(&error);
    }
    free(text);
    return code;
}
