/* What a scene is while the shutter of a camera is open. */
#ifndef LR_SCENE_MOMENT_H
#define LR_SCENE_MOMENT_H

#include "scene/node.h"
#include "scene/scene.h"

/* Whether anything beside the camera moves meanwhile, so that its picture is made of the scene's
 * moments. A camera that moves alone is known by how it opens and closes its shutter. */
bool lr_scene_blurs(const lr_scene *scene, const lr_camera *camera);
bool lr_scene_blurs_any(const lr_scene *scene); /* ... of any of its cameras */

/* Reads the scene as it is in a frame from its own to one later, with files as they were when it
 * was read; its cameras stand still. For scenes that blur. LR_ERROR_SCENE: the text is none then.
 */
lr_status lr_scene_at(const lr_scene *scene, double frame, lr_scene **moment, lr_error *error);

/* What moments are read from: a text, for messages; its nodes; and how it was read. */
typedef struct lr_retold {
    char *text;
    size_t length;
    lr_tree tree;
    lr_load_options options;
} lr_retold;

/* Keeps that of a scene that has been read from the report's text. Takes over the tree, which is
 * empty then. False when memory is out. */
bool lr_scene_retell(lr_scene *scene, const lr_report *report, const lr_load_options *options,
                     lr_tree *tree);
void lr_retold_free(lr_retold *retold); /* NULL is accepted */

#endif
