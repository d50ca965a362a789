/* A camera into the file of its scene. */
#ifndef LR_SCENE_SAVE_CAMERA_H
#define LR_SCENE_SAVE_CAMERA_H

#include "base/status.h"
#include "scene/scene.h"

/* Writes from, to, up and fov of the scene's camera number `index` into the scene file at `path`;
 * all other bytes stay, and so do numbers that are right already. A key that is not there is added,
 * in the style of its neighbours, if its default would be wrong. sha256 is that of the text as it
 * was read, and becomes that of the text written. The file is replaced as a whole, or left alone:
 * LR_ERROR_FILE when it cannot be read or written, has changed since, or is of another kind than
 * the scene language; LR_ERROR_SCENE when the camera cannot be changed without another part of the
 * scene; LR_ERROR_ARGUMENT when a scene cannot have the camera. */
lr_status lr_scene_save_camera(const char *path, uint32_t index, const lr_camera *camera,
                               char sha256[65], lr_error *error);

/* The same on a text in memory, which must be a scene's. *edited is the new text, NUL-terminated
 * behind *edited_length bytes; the caller frees it. `name` stands for the text in messages. */
lr_status lr_camera_edit(const char *text, size_t length, const char *name, uint32_t index,
                         const lr_camera *camera, char **edited, size_t *edited_length,
                         lr_error *error);

#endif
