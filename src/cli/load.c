#include "cli/load.h"

#include "cli/progress.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool update(void *user, const char *what, double fraction)
{
    (void)what; /* the phase has its name already */
    return user ? progress_update(user, fraction) : !interrupted();
}

static void print_report(const char *report)
{
    size_t length = strlen(report);
    fputs(report, stderr);
    if (length == 0 || report[length - 1] != '\n') {
        fputc('\n', stderr);
    }
}

int load_scene(const char *path, const load_values *values, bool quiet, lr_scene **scene,
               struct progress *bar)
{
    lr_error error = {0};
    char *report = NULL;
    const lr_load_options options = {
        .allow_path = values->allow_path,
        .max_triangles = (uint64_t)values->max_triangles,
        .max_memory = (uint64_t)values->max_memory,
        .progress = update,
        .user = bar,
        .files = values->files,
        .previous = values->previous,
        .frame = (double)values->frame,
    };
    lr_status status = lr_scene_load(path, &options, scene, &report, &error);
    int code = EXIT_FINE;
    if (status == LR_OK) {
        lr_scene_info info;
        lr_scene_get_info(*scene, &info);
        if (!quiet && info.note_count > 0) {
            progress_clear(bar);
            for (uint32_t i = 0; i < info.note_count; i++) {
                print_warning("note: %s", info.notes[i]);
            }
        }
        return EXIT_FINE;
    }
    progress_clear(bar);
    if (report) {
        print_report(report);
        code = EXIT_SCENE;
    } else {
        error.status = status;
        code = report_failure(&error);
    }
    free(report);
    return code;
}
