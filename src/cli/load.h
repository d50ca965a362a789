/* Reading scenes, with the flags that all the commands share that do so. */
#ifndef LR_CLI_LOAD_H
#define LR_CLI_LOAD_H

#include <stddef.h>

#include "cli/cli.h"

struct progress;

/* A member of a command's values. */
typedef struct load_values {
    bool allow_path;
    int64_t max_triangles, max_memory; /* 0: not given */
    int64_t frame;
    lr_file_list *files; /* of lr_load_options, as is the next */
    const lr_scene *previous;
} load_values;

/* The lines of the table; `type` has a member `load` of the above. */
#define LOAD_OPTIONS(type)                                                                         \
    {.name = "allow-path",                                                                         \
     .kind = OPTION_FLAG,                                                                          \
     .offset = offsetof(type, load.allow_path),                                                    \
     .help = "scenes and models may name files outside of their own\n"                             \
             "folder",                                                                             \
     .also = "allow-paths|unsafe"},                                                                \
        {.name = "max-triangles",                                                                  \
         .kind = OPTION_INTEGER,                                                                   \
         .offset = offsetof(type, load.max_triangles),                                             \
         .value = "N",                                                                             \
         .min = 1,                                                                                 \
         .max = 1000000000,                                                                        \
         .help = "refuse models with more; default: 100000000"},                                   \
        {.name = "frame",                                                                          \
         .kind = OPTION_INTEGER,                                                                   \
         .offset = offsetof(type, load.frame),                                                     \
         .value = "N",                                                                             \
         .min = 0,                                                                                 \
         .max = 999999,                                                                            \
         .help = "of scenes whose values have keys; default: 0",                                   \
         .also = "at"},                                                                            \
    {                                                                                              \
        .name = "max-memory", .kind = OPTION_BYTES, .offset = offsetof(type, load.max_memory),     \
        .value = "SIZE", .min = 1 << 20,                                                           \
        .help = "refuse models that need more to be read, such as 512M;\n"                         \
                "default: 8G",                                                                     \
        .also = "memory"                                                                           \
    }

/* Loads a scene or prints all that is wrong with it, after clearing the progress bar (which may be
 * NULL); prints what of models is not shown unless quiet. Returns an exit_code. */
int load_scene(const char *path, const load_values *values, bool quiet, lr_scene **scene,
               struct progress *bar);

#endif
