/* What the files that explain pixels share. */
#ifndef LR_RENDER_EXPLAIN_INTERNAL_H
#define LR_RENDER_EXPLAIN_INTERNAL_H

#include "render/pack.h"

/* Makes the tree of one sample from what the kernels noted: fills the explanation's arrays and
 * sample_steps. */
lr_status lr_explain_tree(const struct gpu_notes *notes, const lr_scene *scene,
                          const lr_packed_scene *packed, lr_explanation *explanation,
                          lr_error *error);

#endif
