/* What spirv.c and spirv_check.c share: safe iteration over a module's instructions. */
#ifndef LR_GPU_SPIRV_INTERNAL_H
#define LR_GPU_SPIRV_INTERNAL_H

#include "gpu/spirv.h"

enum {
    SPIRV_HEADER_WORDS = 5,
    SPIRV_BOUND_LIMIT = 4194304, /* "Universal limits" of the SPIR-V specification */
    SPIRV_DECORATION_NO_CONTRACTION = 42,
};

/* Iterates over a module that spirv_index_create accepted. */
#define SPIRV_EACH(at, words, count)                                                               \
    for (size_t at = SPIRV_HEADER_WORDS; at < (count); at += spirv_length((words)[at]))

static inline uint32_t spirv_opcode(uint32_t word)
{
    return word & 0xffff;
}

static inline uint32_t spirv_length(uint32_t word)
{
    return word >> 16;
}

typedef struct spirv_index {
    uint32_t bound;       /* ids are 1 .. bound - 1 */
    uint32_t *names;      /* by id: where its OpName stands, 0 for none */
    bool *no_contraction; /* by id: decorated NoContraction */
} spirv_index;

/* Checks the header and that the instructions tile the words exactly, then indexes names and
 * NoContraction decorations. Freed with spirv_index_free, also after a failure. */
lr_status spirv_index_create(spirv_index *index, const uint32_t *words, size_t count,
                             lr_error *error);
void spirv_index_free(spirv_index *index);

/* The literal string in words first .. end - 1, cut to fit the buffer. */
void spirv_string(const uint32_t *words, size_t first, size_t end, char *text, size_t size);

/* The name of a function as written in the source, or "%id" when the module has no name for it. */
void spirv_function_name(const spirv_index *index, const uint32_t *words, uint32_t id, char *text,
                         size_t size);

/* Whether a function may use contracted arithmetic. */

/* Whether the instruction's result depends on how floats are rounded. */
bool spirv_is_float_arithmetic(uint32_t opcode);

#endif
