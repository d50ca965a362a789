/* Reading scenes: what lr_scene_load and lr_scene_parse share. */
#ifndef LR_SCENE_LOAD_H
#define LR_SCENE_LOAD_H

#include "scene/scene.h"

/* lr_scene_parse with options, which may be NULL. */
lr_status lr_scene_parse_with(const char *text, size_t length, const char *name,
                              const lr_load_options *options, lr_scene **scene, char **report,
                              lr_error *error);

/* The same for a moment of options->previous: what its files brought is taken over, whatever has
 * become of them since, and cameras stand still. */
lr_status lr_scene_parse_moment(const char *text, size_t length, const char *name,
                                const lr_load_options *options, lr_scene **scene, char **report,
                                lr_error *error);

#endif
