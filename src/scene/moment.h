/* What a scene is while the shutter of a camera is open. */
#ifndef LR_SCENE_MOMENT_H
#define LR_SCENE_MOMENT_H

#include "scene/scene.h"

/* Whether anything beside the camera moves meanwhile, so that its picture is made of the scene's
 * moments. A camera that moves alone is known by how it opens and closes its shutter. */
bool lr_scene_blurs(const lr_scene *scene, const lr_camera *camera);
bool lr_scene_blurs_any(const lr_scene *scene); /* ... of any of its cameras */

/* Reads the scene as it is in a frame from its own to one later, with files as they were when it
 * was read; its cameras stand still. For scenes that blur. LR_ERROR_SCENE: the text is none then.
 */
lr_status lr_scene_at(const lr_scene *scene, double frame, lr_scene **moment, lr_error *error);

/* Keeps of a scene's text what the above needs. False when memory is out. */
bool lr_scene_keep_text(lr_scene *scene, const char *text, size_t length,
                        const lr_load_options *options);

#endif
