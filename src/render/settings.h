/* What a caller asks for and what the scene says, as one. */
#ifndef LR_RENDER_SETTINGS_H
#define LR_RENDER_SETTINGS_H

#include "render/pack.h"

/* Completes the options by the scene's values. LR_ERROR_ARGUMENT names what is out of range; a name
 * that no camera has is one. */
/* Samples a pixel where neither scene nor caller names a number. */
uint32_t lr_default_samples(lr_integrator integrator);

lr_status lr_settle(const lr_scene *scene, const lr_render_options *options, lr_settings *settings,
                    lr_error *error);

#endif
