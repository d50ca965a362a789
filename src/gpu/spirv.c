#include "gpu/spirv_internal.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    MAGIC = 0x07230203,
    MAGIC_SWAPPED = 0x03022307,
    MODULE_WORDS_LIMIT = 1 << 26,

    OP_UNDEF = 1,
    OP_SOURCE_CONTINUED = 2,
    OP_SOURCE = 3,
    OP_SOURCE_EXTENSION = 4,
    OP_NAME = 5,
    OP_MEMBER_NAME = 6,
    OP_STRING = 7,
    OP_EXTENSION = 10,
    OP_EXT_INST_IMPORT = 11,
    OP_MEMORY_MODEL = 14,
    OP_ENTRY_POINT = 15,
    OP_EXECUTION_MODE = 16,
    OP_CAPABILITY = 17,
    OP_CONSTANT_NULL = 46,
    OP_FUNCTION = 54,
    OP_FUNCTION_END = 56,
    OP_LOAD = 61,
    OP_DECORATE = 71,
    OP_MEMBER_DECORATE = 72,
    OP_DECORATION_GROUP = 73,
    OP_GROUP_DECORATE = 74,
    OP_GROUP_MEMBER_DECORATE = 75,
    OP_F_NEGATE = 127,
    OP_F_ADD = 129,
    OP_F_SUB = 131,
    OP_F_MUL = 133,
    OP_F_DIV = 136,
    OP_F_REM = 140,
    OP_F_MOD = 141,
    OP_VECTOR_TIMES_SCALAR = 142,
    OP_DOT = 148,
    OP_MODULE_PROCESSED = 330,
    OP_EXECUTION_MODE_ID = 331,
    OP_DECORATE_ID = 332,
    OP_DECORATE_STRING = 5632,
    OP_MEMBER_DECORATE_STRING = 5633,

    DECORATION_RELAXED_PRECISION = 0,
    DECORATION_BUILT_IN = 11,
    BUILT_IN_SUBGROUP_SIZE = 36,
    BUILT_IN_SUBGROUP_INVOCATION = 41,
};

void lr_spirv_free(lr_spirv *module)
{
    free(module->words);
    *module = (lr_spirv){0};
}

static lr_status check_tiling(const uint32_t *words, size_t count, lr_error *error)
{
    if (!words || count < SPIRV_HEADER_WORDS)
        return lr_fail(error, LR_ERROR_ARGUMENT,
                       "not a SPIR-V module: %zu words, fewer than the header has", count);
    if (words[0] == MAGIC_SWAPPED)
        return lr_fail(error, LR_ERROR_ARGUMENT,
                       "the SPIR-V module has the byte order of another machine");
    if (words[0] != MAGIC)
        return lr_fail(error, LR_ERROR_ARGUMENT, "not a SPIR-V module: it starts with 0x%08" PRIx32,
                       words[0]);
    if (count > MODULE_WORDS_LIMIT)
        return lr_fail(error, LR_ERROR_ARGUMENT, "SPIR-V module of %zu words; the limit is %d",
                       count, MODULE_WORDS_LIMIT);
    if (words[3] == 0 || words[3] > SPIRV_BOUND_LIMIT)
        return lr_fail(error, LR_ERROR_ARGUMENT,
                       "invalid SPIR-V module: id bound %" PRIu32 ", expected 1 to %d", words[3],
                       SPIRV_BOUND_LIMIT);
    size_t at = SPIRV_HEADER_WORDS;
    while (at < count) {
        uint32_t length = spirv_length(words[at]);
        if (length == 0)
            return lr_fail(error, LR_ERROR_ARGUMENT,
                           "invalid SPIR-V module: an instruction of length 0 at word %zu", at);
        if (length > count - at)
            return lr_fail(error, LR_ERROR_ARGUMENT,
                           "truncated SPIR-V module: the instruction at word %zu has %" PRIu32
                           " words, but only %zu are left",
                           at, length, count - at);
        at += length;
    }
    return LR_OK;
}

/* The smallest length of an instruction whose operands this file reads; 1 for all others. */
static uint32_t least_length(uint32_t opcode)
{
    switch (opcode) {
    case OP_CAPABILITY:
    case OP_EXTENSION:
        return 2;
    case OP_NAME:
    case OP_EXECUTION_MODE:
    case OP_DECORATE:
        return 3;
    case OP_ENTRY_POINT:
        return 4;
    case OP_FUNCTION:
        return 5;
    default:
        return spirv_is_float_arithmetic(opcode) ? 4 : 1;
    }
}

/* Where in the instruction the id stands that this file uses as an array index; 0 for none. */
static uint32_t id_position(uint32_t opcode)
{
    switch (opcode) {
    case OP_NAME:
    case OP_DECORATE:
    case OP_EXECUTION_MODE:
        return 1;
    case OP_ENTRY_POINT:
    case OP_FUNCTION:
        return 2;
    default:
        return spirv_is_float_arithmetic(opcode) ? 2 : 0;
    }
}

lr_status spirv_index_create(spirv_index *index, const uint32_t *words, size_t count,
                             lr_error *error)
{
    *index = (spirv_index){0};
    lr_status status = check_tiling(words, count, error);
    if (status != LR_OK)
        return status;
    index->bound = words[3];
    index->names = calloc(index->bound, sizeof *index->names);
    index->no_contraction = calloc(index->bound, sizeof *index->no_contraction);
    if (!index->names || !index->no_contraction)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for a SPIR-V module");
    SPIRV_EACH(at, words, count)
    {
        uint32_t opcode = spirv_opcode(words[at]);
        if (spirv_length(words[at]) < least_length(opcode))
            return lr_fail(error, LR_ERROR_ARGUMENT,
                           "invalid SPIR-V module: the instruction at word %zu is too short", at);
        uint32_t position = id_position(opcode);
        if (position == 0)
            continue;
        uint32_t id = words[at + position];
        if (id == 0 || id >= index->bound)
            return lr_fail(error, LR_ERROR_ARGUMENT,
                           "invalid SPIR-V module: id %" PRIu32
                           " at word %zu is outside the bound %" PRIu32,
                           id, at, index->bound);
        if (opcode == OP_NAME)
            index->names[id] = (uint32_t)at;
        if (opcode == OP_DECORATE && words[at + 2] == SPIRV_DECORATION_NO_CONTRACTION)
            index->no_contraction[id] = true;
    }
    return LR_OK;
}

void spirv_index_free(spirv_index *index)
{
    free(index->names);
    free(index->no_contraction);
    *index = (spirv_index){0};
}

void spirv_string(const uint32_t *words, size_t first, size_t end, char *text, size_t size)
{
    size_t length = 0;
    for (size_t at = first; at < end; at++)
        for (int shift = 0; shift < 32 && length + 1 < size; shift += 8) {
            char c = (char)(words[at] >> shift & 0xff);
            if (c == 0)
                goto done;
            text[length++] = c;
        }
done:
    text[length] = 0;
}

void spirv_function_name(const spirv_index *index, const uint32_t *words, uint32_t id, char *text,
                         size_t size)
{
    uint32_t at = index->names[id];
    text[0] = 0;
    if (at)
        spirv_string(words, at + 2, at + spirv_length(words[at]), text, size);
    text[strcspn(text, "(")] = 0; /* glslang appends the parameter types: "ex_dot(vf3;vf3;" */
    if (!text[0])
        snprintf(text, size, "%%%" PRIu32, id);
}

bool spirv_is_float_arithmetic(uint32_t opcode)
{
    switch (opcode) {
    case OP_F_NEGATE:
    case OP_F_ADD:
    case OP_F_SUB:
    case OP_F_MUL:
    case OP_F_DIV:
    case OP_F_REM:
    case OP_F_MOD:
        return true;
    default:
        return opcode >= OP_VECTOR_TIMES_SCALAR && opcode <= OP_DOT; /* and matrix products */
    }
}

/* The specification's logical layout of a module, as far as insertions need it. */
enum section { CAPABILITIES, EXTENSIONS, IMPORTS, ENTRY_POINTS, MODES, NAMES, ANNOTATIONS, BODY };

static enum section section_of(uint32_t opcode)
{
    switch (opcode) {
    case OP_CAPABILITY:
        return CAPABILITIES;
    case OP_EXTENSION:
        return EXTENSIONS;
    case OP_EXT_INST_IMPORT:
    case OP_MEMORY_MODEL:
        return IMPORTS;
    case OP_ENTRY_POINT:
        return ENTRY_POINTS;
    case OP_EXECUTION_MODE:
    case OP_EXECUTION_MODE_ID:
        return MODES;
    case OP_STRING:
    case OP_SOURCE:
    case OP_SOURCE_CONTINUED:
    case OP_SOURCE_EXTENSION:
    case OP_NAME:
    case OP_MEMBER_NAME:
    case OP_MODULE_PROCESSED:
        return NAMES;
    case OP_DECORATE:
    case OP_MEMBER_DECORATE:
    case OP_DECORATION_GROUP:
    case OP_GROUP_DECORATE:
    case OP_GROUP_MEMBER_DECORATE:
    case OP_DECORATE_ID:
    case OP_DECORATE_STRING:
    case OP_MEMBER_DECORATE_STRING:
        return ANNOTATIONS;
    default:
        return BODY;
    }
}

/* The first word behind a section. */
static size_t section_end(const uint32_t *words, size_t count, enum section section)
{
    SPIRV_EACH(at, words, count)
    {
        if (section_of(spirv_opcode(words[at])) > section)
            return at;
    }
    return count;
}

static lr_status copy_with_room(const uint32_t *words, size_t count, size_t extra, lr_spirv *out,
                                lr_error *error)
{
    *out = (lr_spirv){.words = malloc((count + extra) * sizeof *words)};
    if (!out->words)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for a SPIR-V module");
    memcpy(out->words, words, count * sizeof *words);
    out->count = count;
    return LR_OK;
}

/* Inserts one instruction behind a section; the caller has made room for it. */
static void insert(lr_spirv *module, enum section section, const uint32_t *instruction)
{
    size_t length = spirv_length(instruction[0]);
    size_t at = section_end(module->words, module->count, section);
    memmove(module->words + at + length, module->words + at,
            (module->count - at) * sizeof *instruction);
    memcpy(module->words + at, instruction, length * sizeof *instruction);
    module->count += length;
}

/* glslang calls gl_SubgroupSize and gl_SubgroupInvocationID mediump and so decorates them, and
 * loads of them, RelaxedPrecision. They are small integers: nothing is lost by taking that back. */
static lr_status drop_relaxed_builtins(lr_spirv *module, uint32_t bound, lr_error *error)
{
    bool *subgroup = calloc(bound, sizeof *subgroup); /* by id */
    if (!subgroup)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for a SPIR-V module");
    SPIRV_EACH(at, module->words, module->count)
    {
        const uint32_t *w = module->words + at;
        uint32_t opcode = spirv_opcode(w[0]), length = spirv_length(w[0]);
        if (opcode == OP_DECORATE && length > 3 && w[2] == DECORATION_BUILT_IN)
            subgroup[w[1]] |=
                w[3] == BUILT_IN_SUBGROUP_SIZE || w[3] == BUILT_IN_SUBGROUP_INVOCATION;
        if (opcode == OP_LOAD && length > 3 && w[2] < bound && w[3] < bound)
            subgroup[w[2]] |= subgroup[w[3]];
    }
    size_t kept = SPIRV_HEADER_WORDS;
    for (size_t at = SPIRV_HEADER_WORDS, length; at < module->count; at += length) {
        uint32_t *w = module->words + at;
        length = spirv_length(w[0]);
        if (spirv_opcode(w[0]) == OP_DECORATE && w[2] == DECORATION_RELAXED_PRECISION &&
            subgroup[w[1]])
            continue;
        memmove(module->words + kept, w, length * sizeof *w);
        kept += length;
    }
    module->count = kept;
    free(subgroup);
    return LR_OK;
}

lr_status lr_spirv_decorate(const uint32_t *words, size_t count, lr_spirv *out, lr_error *error)
{
    *out = (lr_spirv){0};
    spirv_index index;
    lr_status status = spirv_index_create(&index, words, count, error);
    if (status != LR_OK)
        goto done;
    status = copy_with_room(words, count, 3 * (size_t)index.bound, out, error);
    if (status != LR_OK)
        goto done;
    size_t place = section_end(words, count, ANNOTATIONS), added = 0;
    SPIRV_EACH(at, words, count)
    {
        uint32_t opcode = spirv_opcode(words[at]);
        if (spirv_is_float_arithmetic(opcode)) {
            uint32_t id = words[at + 2];
            if (index.no_contraction[id])
                continue;
            index.no_contraction[id] = true;
            uint32_t *decoration = out->words + place + added;
            decoration[0] = 3u << 16 | OP_DECORATE;
            decoration[1] = id;
            decoration[2] = SPIRV_DECORATION_NO_CONTRACTION;
            added += 3;
        }
    }
    memcpy(out->words + place + added, words + place, (count - place) * sizeof *words);
    out->count = count + added;
    status = drop_relaxed_builtins(out, index.bound, error);
done:
    spirv_index_free(&index);
    return status;
}

void lr_spirv_define(lr_spirv *module)
{
    SPIRV_EACH(at, module->words, module->count)
    {
        uint32_t opcode = spirv_opcode(module->words[at]);
        if (opcode == OP_FUNCTION)
            break;
        if (opcode == OP_UNDEF)
            module->words[at] = 3u << 16 | OP_CONSTANT_NULL;
    }
}

static bool has_instruction(const lr_spirv *module, const uint32_t *instruction)
{
    size_t length = spirv_length(instruction[0]);
    SPIRV_EACH(at, module->words, module->count)
    {
        if (module->words[at] == instruction[0] &&
            memcmp(module->words + at, instruction, length * sizeof *instruction) == 0)
            return true;
    }
    return false;
}

static void insert_once(lr_spirv *module, enum section section, const uint32_t *instruction)
{
    if (!has_instruction(module, instruction))
        insert(module, section, instruction);
}

lr_status lr_spirv_add_modes(const uint32_t *words, size_t count, const lr_spirv_modes *modes,
                             lr_spirv *out, lr_error *error)
{
    *out = (lr_spirv){0};
    if (modes->denorm_preserve && modes->denorm_flush_to_zero)
        return lr_fail(error, LR_ERROR_ARGUMENT,
                       "denormals cannot be both preserved and flushed to zero");
    const struct {
        bool wanted;
        uint32_t capability, mode;
    } table[] = {
        {modes->denorm_preserve, 4464, 4459},
        {modes->denorm_flush_to_zero, 4465, 4460},
        {modes->signed_zero_inf_nan, 4466, 4461},
        {modes->rounding_rte, 4467, 4462},
    };
    const size_t table_size = sizeof table / sizeof *table;
    static const char extension_name[24] = "SPV_KHR_float_controls";
    uint32_t extension[7] = {7u << 16 | OP_EXTENSION};
    for (size_t i = 0; i < sizeof extension_name; i++)
        extension[1 + i / 4] |= (uint32_t)(unsigned char)extension_name[i] << i % 4 * 8;

    spirv_index index;
    size_t entries = 0;
    lr_status status = spirv_index_create(&index, words, count, error);
    if (status != LR_OK)
        goto done;
    SPIRV_EACH(at, words, count)
    {
        entries += spirv_opcode(words[at]) == OP_ENTRY_POINT;
    }
    status = copy_with_room(words, count, table_size * (2 + 4 * entries) + 7, out, error);
    if (status != LR_OK)
        goto done;
    for (size_t i = 0; i < table_size; i++) {
        if (!table[i].wanted)
            continue;
        insert_once(out, CAPABILITIES, (uint32_t[]){2u << 16 | OP_CAPABILITY, table[i].capability});
        insert_once(out, EXTENSIONS, extension);
        SPIRV_EACH(at, words, count)
        {
            if (spirv_opcode(words[at]) == OP_ENTRY_POINT)
                insert_once(
                    out, MODES,
                    (uint32_t[]){4u << 16 | OP_EXECUTION_MODE, words[at + 2], table[i].mode, 32});
        }
    }
done:
    spirv_index_free(&index);
    return status;
}
