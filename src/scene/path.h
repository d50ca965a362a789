/* Where the files lie that a scene names. */
#ifndef LR_SCENE_PATH_H
#define LR_SCENE_PATH_H

#include "base/status.h"

/* Finds the regular file that `relative` names as seen from the folder of base_file, and leaves a
 * path to it in *path, which the caller frees. Unless allow_outside, the file must lie in that
 * folder or below it, symbolic links followed. LR_ERROR_FILE with the cause and the remedy;
 * LR_ERROR_MEMORY. */
lr_status lr_path_resolve(const char *base_file, const char *relative, bool allow_outside,
                          char **path, lr_error *error);

#endif
