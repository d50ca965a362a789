/* A scene's numbers as one hash. */
#ifndef LR_SCENE_FINGERPRINT_H
#define LR_SCENE_FINGERPRINT_H

#include "scene/scene.h"

/* SHA-256 over all that shapes the picture, in the order of docs/info.md, as 64 hexadecimal digits.
 */
void lr_scene_hash(const lr_scene *scene, char hash[65]);

#endif
