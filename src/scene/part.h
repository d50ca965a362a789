/* What was made of a file, shared by the scenes that hold it: an edited scene takes the meshes and
 * textures of files that are still the same from the scene before. A part never changes, and the
 * last scene that lets go of it frees it, on whatever thread. */
#ifndef LR_SCENE_PART_H
#define LR_SCENE_PART_H

#include "base/status.h"
#include "scene/bounds.h"
#include "scene/build.h"

#include <stdatomic.h>

typedef struct lr_part {
    atomic_uint users;
    lr_file_list files; /* as they were looked for; the first is the one that was named */
    bool allow_path;
    lr_scene *content; /* one texture, or all that a mesh file brings, by its own indices */
    lr_bounds *bounds; /* of each mesh of the content */
} lr_part;

/* Takes over the content and the list, which is then empty, also on failure. One user; NULL when
 * memory is out. */
lr_part *lr_part_create(lr_scene *content, lr_file_list *files, bool allow_path);
void lr_part_release(lr_part *part);

/* The scene's part of the file at `path`; NULL: there is none. */
lr_part *lr_part_of(const lr_scene *scene, const char *path);

/* The part of the file at `path` in one of the builder's donors, if all of its files are still the
 * same: NULL, or one user more. */
lr_part *lr_part_find(const lr_scene_builder *builder, const char *path, bool allow_path);

/* Hands the caller's use of the part to the scene, also on failure. False when memory is out. */
bool lr_scene_add_part(lr_scene_builder *builder, lr_part *part);

/* Adds the part's textures, materials, meshes and notes to the scene, which has to hold the part as
 * long as it has them. Those of its textures that have files are loaded again if these have
 * changed. LR_ERROR_FILE, and nothing added, when that fails or the scene would have too much of
 * something. */
lr_status lr_part_place(lr_scene_builder *builder, const lr_part *part, lr_error *error);

#endif
