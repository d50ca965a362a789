#include "scene/save_camera.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/file.h"
#include "base/hash.h"
#include "scene/camera.h"
#include "scene/import.h"
#include "scene/nff.h"
#include "scene/node.h"

#define SHOWN "%.400s"

/* Whether the camera has a text of ours to go into. */
static lr_status check_kind(const char *path, lr_error *error)
{
    struct stat info;
    if (strcmp(path, "-") == 0)
        return lr_fail(error, LR_ERROR_FILE,
                       "the scene came from standard input, so its camera cannot be saved: open it "
                       "as a file");
    if (lr_import_knows(path) || lr_nff_is_path(path))
        return lr_fail(error, LR_ERROR_FILE,
                       SHOWN ": cameras are saved in the scene language alone: make a scene of it "
                             "with `lavaray convert`",
                       path);
    if (stat(path, &info) == 0 && !S_ISREG(info.st_mode))
        return lr_fail(error, LR_ERROR_FILE,
                       SHOWN ": is not a regular file, so the camera cannot be saved in it", path);
    return LR_OK;
}

lr_status lr_scene_save_camera(const char *path, uint32_t index, const lr_camera *camera,
                               char sha256[65], lr_error *error)
{
    char *text, *edited = NULL, hash[65];
    size_t length, edited_length = 0;
    if (!lr_camera_usable(camera))
        return lr_fail(error, LR_ERROR_ARGUMENT, SHOWN ": a scene cannot have this camera", path);
    lr_status status = check_kind(path, error);
    if (!status)
        status = lr_file_read(path, LR_TEXT_MAX, &text, &length, error);
    if (status)
        return status;
    lr_hash_bytes(text, length, hash);
    if (strcmp(hash, sha256) != 0)
        status = lr_fail(error, LR_ERROR_FILE,
                         SHOWN ": has changed since it was read, so the camera was not saved: load "
                               "it again first",
                         path);
    if (!status)
        status = lr_camera_edit(text, length, path, index, camera, &edited, &edited_length, error);
    bool changed = !status && (edited_length != length || memcmp(edited, text, length) != 0);
    if (changed)
        status = lr_file_write(path, edited, edited_length, error);
    if (changed && !status)
        lr_hash_bytes(edited, edited_length, sha256);
    free(edited);
    free(text);
    return status;
}
