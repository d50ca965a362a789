/* Files of other programs: glTF 2.0, OBJ, PLY and STL, read by libassimp. What comes over and how
 * it is shown: docs/import.md. */
#ifndef LR_SCENE_IMPORT_H
#define LR_SCENE_IMPORT_H

#include "base/status.h"
#include "scene/build.h"

/* Whether the path ends like a file that the functions below read. */
bool lr_import_knows(const char *path);

/* A scene from one file, with a camera and lights of its own or made to suit it. */
lr_status lr_import_scene(const char *path, const lr_load_options *options, lr_scene **scene,
                          lr_error *error);

/* Adds the file's meshes, the materials and textures that they use, and one object for each mesh of
 * each node; cameras and lights are left out with a note. `name` is the file as seen from the
 * folder of base_file, in which it and the files that it names must lie unless options->allow_path.
 * On failure the scene is left with parts of the file in it, fit only to be destroyed. */
lr_status lr_import_objects(lr_scene_builder *builder, const char *base_file, const char *name,
                            const lr_load_options *options, lr_error *error);

/* Whether the meshes of both scenes together are within the options' limits. */
bool lr_import_fits(const lr_scene *scene, const lr_scene *more, const lr_load_options *options);

#endif
