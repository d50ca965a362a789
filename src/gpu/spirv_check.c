#include "gpu/spirv_internal.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gpu/spirv_grammar.h"

#define LENGTH(array) (sizeof(array) / sizeof *(array))

enum {
    OP_EXT_INST_IMPORT = 11,
    OP_TYPE_INT = 21,
    OP_TYPE_FLOAT = 22,
    OP_TYPE_VECTOR = 23,
    OP_TYPE_IMAGE = 25,
    OP_CONSTANT = 43,
    OP_CONSTANT_COMPOSITE = 44,
    OP_CONSTANT_NULL = 46,
    OP_COMPOSITE_CONSTRUCT = 80,
    OP_BITWISE_AND = 199,
    OP_ATOMIC_STORE = 228,

    DECORATION_RELAXED_PRECISION = 0,
    DIM_BUFFER = 5,
};

/* RowMajor and its kin place data in memory; the others name resources or restrict access. */
static const uint32_t allowed_decorations[] = {
    1 /* SpecId */,       2 /* Block */,          3 /* BufferBlock */,   4 /* RowMajor */,
    5 /* ColMajor */,     6 /* ArrayStride */,    7 /* MatrixStride */,  11 /* BuiltIn */,
    19 /* Restrict */,    20 /* Aliased */,       21 /* Volatile */,     23 /* Coherent */,
    24 /* NonWritable */, 25 /* NonReadable */,   33 /* Binding */,      34 /* DescriptorSet */,
    35 /* Offset */,      42 /* NoContraction */, 5300 /* NonUniform */,
};

static const uint32_t allowed_modes[] = {
    17 /* LocalSize */,
    38 /* LocalSizeId */,
    4459 /* DenormPreserve */,
    4460 /* DenormFlushToZero */,
    4461 /* SignedZeroInfNanPreserve */,
    4462 /* RoundingModeRTE */,
};

typedef struct checker {
    const uint32_t *words;
    size_t count;
    spirv_index index;
    uint32_t *definitions; /* by id: where the instruction stands whose result it is, 0: unknown */
    char function[64];     /* that is being walked; "" at module scope */
    lr_error *error;
} checker;

static lr_status refuse(const checker *c, const char *instruction, const spirv_rule *rule)
{
    return lr_fail(c->error, LR_ERROR_ARGUMENT, "%s%s: %s breaks the rule \"%s\": %s",
                   c->function[0] ? "in function " : "at module scope",
                   c->function[0] ? c->function : "", instruction, rule->name, rule->text);
}

static bool contains(const uint32_t *values, size_t count, uint32_t value)
{
    for (size_t i = 0; i < count; i++)
        if (values[i] == value)
            return true;
    return false;
}

static const spirv_operation *find_operation(uint32_t opcode)
{
    size_t low = 0, high = LENGTH(spirv_operations);
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (spirv_operations[middle].opcode < opcode)
            low = middle + 1;
        else
            high = middle;
    }
    if (low < LENGTH(spirv_operations) && spirv_operations[low].opcode == opcode)
        return &spirv_operations[low];
    return NULL;
}

/* The instruction that defines an id; all zero, which is no instruction that anything looks for,
 * when there is none. */
static const uint32_t *definition(const checker *c, uint32_t id)
{
    static const uint32_t none[16];
    return id < c->index.bound && c->definitions[id] ? c->words + c->definitions[id] : none;
}

/* A type without its vector. */
static const uint32_t *scalar_type(const checker *c, uint32_t type)
{
    const uint32_t *defined = definition(c, type);
    return spirv_opcode(*defined) == OP_TYPE_VECTOR ? definition(c, defined[2]) : defined;
}

static bool is_float_type(const checker *c, uint32_t type)
{
    return spirv_opcode(*scalar_type(c, type)) == OP_TYPE_FLOAT;
}

/* Reads an instruction's operands as its line of the table describes them and records its result.
 */
static lr_status index_operands(checker *c, size_t at, const spirv_operation *operation)
{
    size_t end = at + spirv_length(c->words[at]), word = at + 1;
    for (const char *kind = operation->operands; *kind != '~';) {
        if (word == end && (*kind == 0 || *kind == '*'))
            return LR_OK;
        if (word == end || *kind == 0)
            return lr_fail(c->error, LR_ERROR_ARGUMENT,
                           "invalid SPIR-V module: %s at word %zu has %s operands", operation->name,
                           at, word == end ? "too few" : "too many");
        uint32_t id = c->words[word];
        if (*kind != '#' && (id == 0 || id >= c->index.bound))
            return lr_fail(c->error, LR_ERROR_ARGUMENT,
                           "invalid SPIR-V module: %s at word %zu has an id outside the bound: "
                           "%" PRIu32,
                           operation->name, at, id);
        if (*kind == 'r') {
            if (c->definitions[id])
                return lr_fail(c->error, LR_ERROR_ARGUMENT,
                               "invalid SPIR-V module: %s at word %zu defines id %" PRIu32
                               " a second time",
                               operation->name, at, id);
            c->definitions[id] = (uint32_t)at;
        }
        word++;
        kind += *kind != '*';
    }
    return LR_OK;
}

static bool is_composite(const uint32_t *instruction)
{
    uint32_t opcode = spirv_opcode(*instruction);
    return opcode == OP_CONSTANT_COMPOSITE || opcode == OP_COMPOSITE_CONSTRUCT;
}

/* Whether every component of an integer constant lies in least .. most. A specialization constant
 * is not a constant here: its value is not known yet. */
static bool constant_in(const checker *c, uint32_t id, uint32_t least, uint32_t most)
{
    const uint32_t *defined = definition(c, id);
    uint32_t length = spirv_length(*defined);
    switch (spirv_opcode(*defined)) {
    case OP_CONSTANT_NULL:
        return least == 0;
    case OP_CONSTANT:
        for (uint32_t i = 4; i < length; i++) /* the high word of a 64-bit value */
            if (defined[i] != 0)
                return most == UINT32_MAX;
        return defined[3] >= least && defined[3] <= most;
    case OP_CONSTANT_COMPOSITE:
    case OP_COMPOSITE_CONSTRUCT: /* glslang's form of a scalar constant spread over a vector */
        for (uint32_t i = 3; i < length; i++)
            if (is_composite(definition(c, defined[i])) || !constant_in(c, defined[i], least, most))
                return false;
        return length > 3;
    default:
        return false;
    }
}

static bool is_shift_amount(const checker *c, uint32_t id, uint32_t most)
{
    const uint32_t *defined = definition(c, id);
    switch (spirv_opcode(*defined)) {
    case OP_BITWISE_AND:
        return constant_in(c, defined[3], 0, most) || constant_in(c, defined[4], 0, most);
    case OP_COMPOSITE_CONSTRUCT: /* a vector shifted by one scalar amount */
        for (uint32_t i = 3; i < spirv_length(*defined); i++)
            if (is_composite(definition(c, defined[i])) || !is_shift_amount(c, defined[i], most))
                return false;
        return spirv_length(*defined) > 3;
    default:
        return constant_in(c, id, 0, most);
    }
}

/* The operands of OpUDiv, OpUMod and the shifts, also those inside OpSpecConstantOp. */
static lr_status check_right_operand(const checker *c, const spirv_operation *operation,
                                     uint32_t type, uint32_t right)
{
    if (operation->kind == KIND_UNSIGNED_DIVISION)
        return constant_in(c, right, 1, UINT32_MAX) ? LR_OK
                                                    : refuse(c, operation->name, &rule_divisor);
    const uint32_t *scalar = scalar_type(c, type);
    uint32_t width = spirv_opcode(*scalar) == OP_TYPE_INT ? scalar[2] : 0;
    uint32_t most = width < 32 ? width - 1 : 31;
    if (width == 0 || !is_shift_amount(c, right, most))
        return refuse(c, operation->name, &rule_shift);
    return LR_OK;
}

static lr_status check_spec_op(const checker *c, size_t at)
{
    const uint32_t *word = c->words + at;
    const spirv_operation *inner = find_operation(word[3]);
    char name[64];
    snprintf(name, sizeof name, "OpSpecConstantOp %s", inner ? inner->name : "?");
    if (!inner)
        return refuse(c, name, &rule_whitelist);
    if (is_float_type(c, word[1]) || inner->kind == KIND_ARITHMETIC)
        return refuse(c, name, &rule_spec_float);
    if (inner->kind == KIND_INTEGER)
        return LR_OK;
    if (inner->kind == KIND_UNSIGNED_DIVISION || inner->kind == KIND_SHIFT)
        return spirv_length(*word) == 6 ? check_right_operand(c, inner, word[1], word[5])
                                        : refuse(c, name, &rule_whitelist);
    return refuse(c, name, inner->rule ? inner->rule : &rule_whitelist);
}

static lr_status check_ext_inst(const checker *c, size_t at)
{
    const uint32_t *set = definition(c, c->words[at + 3]);
    uint32_t number = c->words[at + 4];
    char name[128] = "";
    if (spirv_opcode(*set) == OP_EXT_INST_IMPORT)
        spirv_string(set, 2, spirv_length(*set), name, 64);
    if (strncmp(name, "NonSemantic.", 12) == 0)
        return LR_OK;
    bool known = strcmp(name, "GLSL.std.450") == 0;
    const spirv_extended *extended = known && number < LENGTH(spirv_glsl) && spirv_glsl[number].name
                                         ? &spirv_glsl[number]
                                         : NULL;
    if (extended && extended->allowed)
        return LR_OK;
    size_t length = strlen(name);
    if (extended)
        snprintf(name + length, sizeof name - length, " %s", extended->name);
    else
        snprintf(name + length, sizeof name - length, " instruction %" PRIu32, number);
    return refuse(c, name, known ? &rule_builtin : &rule_instruction_set);
}

static lr_status check_decoration(const checker *c, const char *name, uint32_t decoration)
{
    if (contains(allowed_decorations, LENGTH(allowed_decorations), decoration))
        return LR_OK;
    if (decoration == DECORATION_RELAXED_PRECISION)
        return refuse(c, "RelaxedPrecision", &rule_relaxed);
    char text[64];
    snprintf(text, sizeof text, "%s %" PRIu32, name, decoration);
    return refuse(c, text, &rule_decoration);
}

/* The type of the value that an id stands for, 0 when it has none. */
static uint32_t value_type(const checker *c, uint32_t id)
{
    const uint32_t *defined = definition(c, id);
    const spirv_operation *operation = find_operation(spirv_opcode(*defined));
    return operation && operation->operands[0] == 't' ? defined[1] : 0;
}

static lr_status check_image_read(const checker *c, size_t at, const char *name)
{
    const uint32_t *image = definition(c, value_type(c, c->words[at + 3]));
    if (spirv_opcode(*image) == OP_TYPE_IMAGE && image[3] == DIM_BUFFER)
        return LR_OK;
    return refuse(c, name, &rule_image_buffer);
}

static lr_status check_instruction(checker *c, size_t at)
{
    const uint32_t *word = c->words + at;
    const spirv_operation *operation = find_operation(spirv_opcode(*word));
    if (!operation) {
        char name[32];
        snprintf(name, sizeof name, "opcode %" PRIu32, spirv_opcode(*word));
        return refuse(c, name, &rule_whitelist);
    }
    const char *name = operation->name;
    switch (operation->kind) {
    case KIND_ALLOWED:
    case KIND_INTEGER:
        if (operation->opcode == OP_ATOMIC_STORE && is_float_type(c, value_type(c, word[4])))
            return refuse(c, name, &rule_float_atomic);
        return LR_OK;
    case KIND_ARITHMETIC:
        return c->index.no_contraction[word[2]] ? LR_OK : refuse(c, name, &rule_contraction);
    case KIND_UNSIGNED_DIVISION:
    case KIND_SHIFT:
        return check_right_operand(c, operation, word[1], word[4]);
    case KIND_ATOMIC:
        return is_float_type(c, word[1]) ? refuse(c, name, &rule_float_atomic) : LR_OK;
    case KIND_IMAGE_READ:
        return check_image_read(c, at, name);
    case KIND_FLOAT_TYPE:
        return word[2] == 32 && spirv_length(*word) == 3 ? LR_OK
                                                         : refuse(c, name, &rule_float_width);
    case KIND_SPEC_OP:
        return check_spec_op(c, at);
    case KIND_EXT_INST:
        return check_ext_inst(c, at);
    case KIND_DECORATION:
        return check_decoration(c, name, word[2]);
    case KIND_MEMBER_DECORATION:
        return check_decoration(c, name, word[3]);
    case KIND_MODE:
        return contains(allowed_modes, LENGTH(allowed_modes), word[2])
                   ? LR_OK
                   : refuse(c, name, &rule_mode);
    case KIND_FUNCTION:
        spirv_function_name(&c->index, c->words, word[2], c->function, sizeof c->function);
        return LR_OK;
    case KIND_FUNCTION_END:
        c->function[0] = 0;
        return LR_OK;
    case KIND_REFUSED:
        break;
    }
    return refuse(c, name, operation->rule);
}

lr_status lr_spirv_check(const uint32_t *words, size_t count, lr_error *error)
{
    checker c = {.words = words, .count = count, .error = error};
    lr_status status = spirv_index_create(&c.index, words, count, error);
    if (status != LR_OK)
        goto done;
    c.definitions = calloc(c.index.bound, sizeof *c.definitions);
    if (!c.definitions) {
        status = lr_fail(error, LR_ERROR_MEMORY, "out of memory for a SPIR-V module");
        goto done;
    }
    SPIRV_EACH(at, words, count)
    {
        const spirv_operation *operation = find_operation(spirv_opcode(words[at]));
        if (operation && (status = index_operands(&c, at, operation)) != LR_OK)
            goto done;
    }
    SPIRV_EACH(at, words, count)
    {
        if ((status = check_instruction(&c, at)) != LR_OK)
            goto done;
    }
done:
    free(c.definitions);
    spirv_index_free(&c.index);
    return status;
}
