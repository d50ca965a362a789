/* Where the files lie that a scene names. */
#ifndef LR_SCENE_PATH_H
#define LR_SCENE_PATH_H

#include "base/status.h"

/* `relative` behind the folder of base_file; NULL when memory is out. */
char *lr_path_join(const char *base_file, const char *relative);

/* Finds the regular file that `relative` names as seen from the folder of base_file, and leaves a
 * path to it in *path, which the caller frees. Unless options->allow_path, the file must lie in
 * that folder or below it, symbolic links followed. The path goes into options->files, if only the
 * file could be put there. LR_ERROR_FILE with the cause and the remedy; LR_ERROR_MEMORY. */
lr_status lr_path_resolve(const char *base_file, const char *relative,
                          const lr_load_options *options, char **path, lr_error *error);

/* Adds a file, unless it is there or the list is full. False when memory is out. */
bool lr_file_list_put(lr_file_list *list, const char *path, const lr_file_stamp *stamp);

/* Adds the file as it is now to the options' list, if that is wished for. False when memory is out.
 */
bool lr_file_list_add(const lr_load_options *options, const char *path);

#endif
