/* lr_explain for pictures of any camera. */
#ifndef LR_RENDER_EXPLAIN_H
#define LR_RENDER_EXPLAIN_H

#include "render/pack.h"

/* As lr_explain, with settings that are complete; of the options only those count that tell how the
 * work is cut up, and `progress`. */
lr_status lr_explain_picture(lr_device *device, const lr_scene *scene, const lr_settings *settings,
                             const lr_render_options *options, uint32_t x, uint32_t y,
                             uint32_t sample, lr_explanation *explanation, lr_error *error);

#endif
