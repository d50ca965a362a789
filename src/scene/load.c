/* Scene files by their endings. */
#include "scene/load.h"

#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "scene/import.h"
#include "scene/nff.h"
#include "scene/node.h"
#include "scene/path.h"

lr_status lr_scene_load(const char *path, const lr_load_options *options, lr_scene **scene,
                        char **report, lr_error *error)
{
    char *text;
    size_t length;
    *scene = NULL;
    *report = NULL;
    if (strcmp(path, "-") != 0 && !lr_file_list_add(options, path))
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for the name of the scene");
    if (lr_import_knows(path))
        return lr_import_scene(path, options, scene, error);
    bool nff = lr_nff_is_path(path);
    lr_status status =
        lr_file_read(path, nff ? LR_NFF_TEXT_MAX : LR_TEXT_MAX, &text, &length, error);
    if (status != LR_OK)
        return status;
    const char *name = strcmp(path, "-") == 0 ? "<stdin>" : path;
    status = nff ? lr_nff_read(text, length, name, scene, report, error)
                 : lr_scene_parse_with(text, length, name, options, scene, report, error);
    free(text);
    return status;
}
