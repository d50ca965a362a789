/* What materials are made of: which keys belong to which model, metals by name, and what the
 * classic shading shows of all but the classic model. */
#ifndef LR_SCENE_MODELS_H
#define LR_SCENE_MODELS_H

#include "scene/scene.h"

extern const char *const lr_model_names[], *const lr_metal_names[]; /* end with NULL */

/* Whether materials of the model have the key, one of lr_material_record. */
bool lr_model_has_key(lr_model model, const char *key);

/* Models that let light through unless told otherwise. */
bool lr_model_is_glass(lr_model model);

/* The refractive index of a metal but LR_METAL_NONE. */
void lr_metal_index(lr_metal metal, lr_color *eta, lr_color *k);

/* What a metal of the refractive index reflects straight back. */
lr_color lr_metal_facing(lr_color eta, lr_color k);

/* Fills in the fields of the classic shading of a material whose others are complete; `color` and
 * `transmit` keep what they are. */
void lr_approximate(lr_material *material);

/* The same of a mix, whose parts are complete, along with all that says what it encloses: that is
 * what the part encloses that lets light through. Its colour is the weight's pattern in the colours
 * of both parts, averaged, and so are all other shares with the weight's mean. */
void lr_approximate_mix(const lr_scene *scene, lr_material *material);

#endif
