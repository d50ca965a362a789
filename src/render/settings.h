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

/* What the pixels depend on beside the scene's own numbers, as files say it, such as "640x480, 4
 * samples, depth 6, seed 0". Sums whose texts differ are never added, so whatever options change
 * the picture belongs in here. size: LR_SETTINGS_TEXT. */
void lr_settings_describe(const lr_settings *settings, const lr_render_options *options, char *text,
                          size_t size);

#endif
