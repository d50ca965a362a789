/* Textures from picture files: PNG, JPEG, HDR, EXR and whatever else image/read.h knows.
 *
 * Integer samples are rounded to 8 bits (also those of 16) and stand for what the caller says,
 * whatever the file says; a missing alpha is 1. Floating-point samples count as linear and lose
 * their alpha; what is negative or not a number becomes 0 and what is above LR_COLOR_MAX that, with
 * a note in the scene. */
#ifndef LR_SCENE_TEXTURE_H
#define LR_SCENE_TEXTURE_H

#include "base/status.h"
#include "scene/build.h"

#define LR_TEXTURE_SIDE_MAX 16384
#define LR_TEXELS_MAX (1u << 28) /* of all textures of a scene */

/* Adds the picture at path, or finds the texture that an earlier call with the same path, wraps and
 * texels added, and sets *texture to its index. LR_ERROR_FILE with the path and the reason when it
 * cannot be read, is in no known format, cut short or over the limits above; LR_ERROR_MEMORY. */
lr_status lr_texture_load(lr_scene_builder *builder, const char *path, lr_wrap wrap_u,
                          lr_wrap wrap_v, lr_texels texels, uint32_t *texture, lr_error *error);

/* The same of a file in memory, always as a new texture; name stands for it in messages and is not
 * that of a file that is also loaded. */
lr_status lr_texture_decode(lr_scene_builder *builder, const void *bytes, size_t length,
                            const char *name, lr_wrap wrap_u, lr_wrap wrap_v, lr_texels texels,
                            uint32_t *texture, lr_error *error);

/* What the texels of a map stand for. */
lr_texels lr_map_texels(lr_map_kind kind);

/* Adds a texture whose texels belong to a part of the scene. */
lr_status lr_texture_borrow(lr_scene_builder *builder, const lr_texture *from, uint32_t *texture,
                            lr_error *error);

#endif
