/* Reading scenes: what lr_scene_load and lr_scene_parse share. */
#ifndef LR_SCENE_LOAD_H
#define LR_SCENE_LOAD_H

#include "scene/scene.h"

/* lr_scene_parse with options, which may be NULL. */
lr_status lr_scene_parse_with(const char *text, size_t length, const char *name,
                              const lr_load_options *options, lr_scene **scene, char **report,
                              lr_error *error);

/* Reads a moment of a scene that is retold: what its files brought is taken over, whatever has
 * become of them since, and cameras stand still. Returns as the above. */
lr_status lr_scene_read_moment(const lr_scene *scene, double frame, lr_scene **moment,
                               char **report, lr_error *error);

#endif
