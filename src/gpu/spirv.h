/* SPIR-V modules as the exact rules need them (docs/exact.md): every float operation decorated
 * NoContraction, the float-control modes declared, and nothing outside the whitelist in them.
 * Works on plain word arrays and knows nothing of Vulkan. */
#ifndef LR_GPU_SPIRV_H
#define LR_GPU_SPIRV_H

#include "base/status.h"

typedef struct lr_spirv {
    uint32_t *words; /* owned; freed with lr_spirv_free */
    size_t count;
} lr_spirv;

void lr_spirv_free(lr_spirv *module);

/* Copies the module `words` into *out with NoContraction added to every float arithmetic
 * instruction that lacks it. LR_ERROR_ARGUMENT when words is no valid module. */
lr_status lr_spirv_decorate(const uint32_t *words, size_t count, lr_spirv *out, lr_error *error);

/* Makes the undefined values that an optimiser left at module scope zeros: it joins the ways into a
 * loop with them where a variable gets its value inside. */
void lr_spirv_define(lr_spirv *module);

/* Copies a module that this project built into *out with its boolean specialisation constants fixed
 * (the one with SpecId i to constants[i] != 0) and without the branches that they rule out. */
lr_status lr_spirv_specialize(const uint32_t *words, size_t count, const uint32_t *constants,
                              uint32_t constant_count, lr_spirv *out, lr_error *error);

typedef struct lr_spirv_modes {
    bool rounding_rte;         /* RoundingModeRTE 32 */
    bool signed_zero_inf_nan;  /* SignedZeroInfNanPreserve 32 */
    bool denorm_preserve;      /* DenormPreserve 32 */
    bool denorm_flush_to_zero; /* DenormFlushToZero 32; not with denorm_preserve */
} lr_spirv_modes;

/* Copies the module into *out with the float-control execution modes (and their capabilities and
 * the SPV_KHR_float_controls extension) declared for every entry point. */
lr_status lr_spirv_add_modes(const uint32_t *words, size_t count, const lr_spirv_modes *modes,
                             lr_spirv *out, lr_error *error);

/* Walks the module against the whitelist. LR_OK, or LR_ERROR_ARGUMENT with a message that names
 * the function, the instruction and the rule it breaks. */
lr_status lr_spirv_check(const uint32_t *words, size_t count, lr_error *error);

#endif
