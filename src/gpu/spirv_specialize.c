/* Specialisation on the host. Drivers are allowed to fold specialisation constants, but one that
 * does not compiles every branch of every kernel: SwiftShader took minutes and gigabytes for what
 * takes it a second once the branches that a scene does not need are gone (docs/drivers.md). */
#include "gpu/spirv_internal.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

enum {
    OP_NAME = 5,
    OP_MEMBER_NAME = 6,
    OP_LINE = 8,
    OP_ENTRY_POINT = 15,
    OP_CAPABILITY = 17,
    OP_CONSTANT_TRUE = 41,
    OP_CONSTANT_FALSE = 42,
    OP_CONSTANT = 43,
    OP_SPEC_CONSTANT_TRUE = 48,
    OP_SPEC_CONSTANT_FALSE = 49,
    OP_SPEC_CONSTANT = 50,
    OP_SPEC_CONSTANT_OP = 52,
    OP_FUNCTION = 54,
    OP_FUNCTION_END = 56,
    OP_FUNCTION_CALL = 57,
    OP_STORE = 62,
    OP_COPY_MEMORY = 63,
    OP_DECORATE = 71,
    OP_MEMBER_DECORATE = 72,
    OP_IMAGE_WRITE = 99,
    OP_LOGICAL_OR = 166,
    OP_LOGICAL_AND = 167,
    OP_LOGICAL_NOT = 168,
    OP_U_GREATER_THAN = 172,
    OP_CONTROL_BARRIER = 224,
    OP_MEMORY_BARRIER = 225,
    OP_ATOMIC_STORE = 228,
    OP_PHI = 245,
    OP_LOOP_MERGE = 246,
    OP_SELECTION_MERGE = 247,
    OP_LABEL = 248,
    OP_BRANCH = 249,
    OP_BRANCH_CONDITIONAL = 250,
    OP_SWITCH = 251,
    OP_GROUP_NON_UNIFORM_SHUFFLE = 345,
    DECORATION_SPEC_ID = 1,
    CAPABILITY_SHUFFLE = 65,
};

typedef enum truth { UNKNOWN, FALSE, TRUE } truth;

typedef struct folding {
    const uint32_t *words;
    size_t count;
    uint32_t bound;
    uint32_t *spec_ids;    /* by id: 1 + its SpecId, 0 for none */
    unsigned char *truths; /* by id: what is known of a bool */
    uint64_t *values;      /* by id: 1 + the word that it is, 0 where that is not known */
    bool *reachable;       /* by label */
    uint32_t *ends;        /* by label: where its terminator stands */
    bool *live;            /* by function: some entry point calls it */
    bool shuffles;         /* the code that is left shuffles within subgroups */
    bool *removed;         /* by id: defined in a block that is gone */
    const uint32_t *constants;
    uint32_t constant_count;
} folding;

static const uint32_t *at(const folding *f, size_t word)
{
    return &f->words[word];
}

/* The branch that a block's terminator takes for certain: a label, or 0 when it is not known. */
static uint32_t taken_branch(const folding *f, size_t terminator)
{
    const uint32_t *w = at(f, terminator);
    if (spirv_opcode(w[0]) != OP_BRANCH_CONDITIONAL || f->truths[w[1]] == UNKNOWN)
        return 0;
    return f->truths[w[1]] == TRUE ? w[2] : w[3];
}

static bool branches_to(const folding *f, uint32_t from, uint32_t to)
{
    if (!f->reachable[from] || !f->ends[from])
        return false;
    const uint32_t *w = at(f, f->ends[from]);
    uint32_t taken = taken_branch(f, f->ends[from]);
    if (taken)
        return taken == to;
    switch (spirv_opcode(w[0])) {
    case OP_BRANCH:
        return w[1] == to;
    case OP_BRANCH_CONDITIONAL:
        return w[2] == to || w[3] == to;
    default:
        return true;
    }
}

static truth fold_phi(const folding *f, const uint32_t *w, uint32_t label)
{
    truth result = UNKNOWN;
    for (uint32_t i = 3; i + 1 < spirv_length(w[0]); i += 2) {
        if (!branches_to(f, w[i + 1], label))
            continue;
        truth incoming = f->truths[w[i]];
        if (incoming == UNKNOWN || (result != UNKNOWN && result != incoming))
            return UNKNOWN;
        result = incoming;
    }
    return result;
}

static truth fold_logic(uint32_t opcode, truth a, truth b)
{
    switch (opcode) {
    case OP_LOGICAL_NOT:
        return a == UNKNOWN ? UNKNOWN : (a == TRUE ? FALSE : TRUE);
    case OP_LOGICAL_AND:
        return a == FALSE || b == FALSE ? FALSE : (a == TRUE && b == TRUE ? TRUE : UNKNOWN);
    case OP_LOGICAL_OR:
        return a == TRUE || b == TRUE ? TRUE : (a == FALSE && b == FALSE ? FALSE : UNKNOWN);
    default:
        return UNKNOWN;
    }
}

/* a > b, of two numbers without sign, by id. */
static truth fold_greater(const folding *f, uint32_t a, uint32_t b)
{
    if (!f->values[a] || !f->values[b])
        return UNKNOWN;
    return f->values[a] > f->values[b] ? TRUE : FALSE;
}

/* 1 + the value of a constant of one word. */
static uint64_t fold_constant(const folding *f, const uint32_t *w)
{
    uint32_t spec = f->spec_ids[w[2]];
    bool given = spec && spec - 1 < f->constant_count;
    return 1 + (uint64_t)(given ? f->constants[spec - 1] : w[3]);
}

static truth fold(const folding *f, const uint32_t *w, uint32_t label)
{
    uint32_t length = spirv_length(w[0]), opcode = spirv_opcode(w[0]);
    switch (opcode) {
    case OP_U_GREATER_THAN:
        return fold_greater(f, w[3], w[4]);
    case OP_CONSTANT_TRUE:
        return TRUE;
    case OP_CONSTANT_FALSE:
        return FALSE;
    case OP_SPEC_CONSTANT_TRUE:
    case OP_SPEC_CONSTANT_FALSE: {
        uint32_t spec = f->spec_ids[w[2]];
        bool value = opcode == OP_SPEC_CONSTANT_TRUE;
        if (spec && spec - 1 < f->constant_count)
            value = f->constants[spec - 1] != 0;
        return value ? TRUE : FALSE;
    }
    case OP_SPEC_CONSTANT_OP: /* the operation in word 3, then its operands */
        if (w[3] == OP_U_GREATER_THAN)
            return fold_greater(f, w[4], w[5]);
        return fold_logic(w[3], length > 4 ? f->truths[w[4]] : UNKNOWN,
                          length > 5 ? f->truths[w[5]] : UNKNOWN);
    case OP_PHI:
        return fold_phi(f, w, label);
    default:
        return fold_logic(opcode, length > 3 ? f->truths[w[3]] : UNKNOWN,
                          length > 4 ? f->truths[w[4]] : UNKNOWN);
    }
}

/* Blocks stand behind those that dominate them, so one pass in order finds all that matters. */
static void find_reachable(folding *f)
{
    uint32_t label = 0;
    bool entry = false;
    SPIRV_EACH(word, f->words, f->count)
    {
        const uint32_t *w = at(f, word);
        switch (spirv_opcode(w[0])) {
        case OP_DECORATE:
            if (w[2] == DECORATION_SPEC_ID)
                f->spec_ids[w[1]] = w[3] + 1;
            break;
        case OP_FUNCTION:
            entry = true;
            break;
        case OP_LABEL:
            label = w[1];
            f->reachable[label] |= entry;
            entry = false;
            break;
        case OP_LOGICAL_OR:
        case OP_LOGICAL_AND:
        case OP_LOGICAL_NOT:
        case OP_PHI:
        case OP_CONSTANT_TRUE:
        case OP_CONSTANT_FALSE:
        case OP_SPEC_CONSTANT_TRUE:
        case OP_SPEC_CONSTANT_FALSE:
        case OP_SPEC_CONSTANT_OP:
        case OP_U_GREATER_THAN:
            f->truths[w[2]] = fold(f, w, label);
            break;
        case OP_CONSTANT:
        case OP_SPEC_CONSTANT:
            if (spirv_length(w[0]) == 4)
                f->values[w[2]] = fold_constant(f, w);
            break;
        case OP_LOOP_MERGE:
            f->reachable[w[1]] |= f->reachable[label];
            f->reachable[w[2]] |= f->reachable[label];
            break;
        case OP_SELECTION_MERGE: {
            /* With a known branch the construct dissolves, and its merge block must earn its place
             * by a branch that reaches it. */
            bool dissolves = taken_branch(f, word + spirv_length(w[0])) != 0;
            f->reachable[w[1]] |= f->reachable[label] && !dissolves;
            break;
        }
        case OP_BRANCH:
            f->ends[label] = (uint32_t)word;
            f->reachable[w[1]] |= f->reachable[label];
            break;
        case OP_BRANCH_CONDITIONAL: {
            f->ends[label] = (uint32_t)word;
            uint32_t taken = taken_branch(f, word);
            f->reachable[w[2]] |= f->reachable[label] && (!taken || taken == w[2]);
            f->reachable[w[3]] |= f->reachable[label] && (!taken || taken == w[3]);
            break;
        }
        case OP_SWITCH:
            f->ends[label] = (uint32_t)word;
            for (uint32_t i = 2; i < spirv_length(w[0]); i += 2)
                f->reachable[w[i]] |= f->reachable[label];
            break;
        default:
            break;
        }
    }
}

/* Emits one instruction of a reachable block, folded. Returns the words written. */
static size_t emit(const folding *f, size_t word, uint32_t label, uint32_t *out)
{
    const uint32_t *w = at(f, word);
    uint32_t length = spirv_length(w[0]), opcode = spirv_opcode(w[0]), taken;
    switch (opcode) {
    case OP_SELECTION_MERGE:
        if (taken_branch(f, word + length))
            return 0;
        break;
    case OP_BRANCH_CONDITIONAL:
        taken = taken_branch(f, word);
        if (!taken)
            break;
        out[0] = 2u << 16 | OP_BRANCH;
        out[1] = taken;
        return 2;
    case OP_PHI: {
        size_t written = 3;
        memcpy(out, w, 3 * sizeof *out);
        for (uint32_t i = 3; i + 1 < length; i += 2) {
            if (!branches_to(f, w[i + 1], label))
                continue;
            out[written++] = w[i];
            out[written++] = w[i + 1];
        }
        out[0] = (uint32_t)written << 16 | OP_PHI;
        return written;
    }
    case OP_SPEC_CONSTANT:
        if (!f->values[w[2]])
            break;
        out[0] = 4u << 16 | OP_CONSTANT;
        out[1] = w[1];
        out[2] = w[2];
        out[3] = (uint32_t)(f->values[w[2]] - 1);
        return 4;
    case OP_SPEC_CONSTANT_TRUE:
    case OP_SPEC_CONSTANT_FALSE:
    case OP_SPEC_CONSTANT_OP:
        if (f->truths[w[2]] == UNKNOWN)
            break;
        out[0] = 3u << 16 | (f->truths[w[2]] == TRUE ? OP_CONSTANT_TRUE : OP_CONSTANT_FALSE);
        out[1] = w[1];
        out[2] = w[2];
        return 3;
    default:
        break;
    }
    memcpy(out, w, length * sizeof *out);
    return length;
}

/* Walks the instructions that are left: *function and *label are where `word` stands, and the
 * result tells whether it is in a block or function that is gone. */
static bool is_gone(const folding *f, size_t word, uint32_t *function, uint32_t *label)
{
    const uint32_t *w = at(f, word);
    switch (spirv_opcode(w[0])) {
    case OP_FUNCTION:
        *function = w[2];
        *label = 0;
        break;
    case OP_LABEL:
        *label = w[1];
        break;
    case OP_FUNCTION_END: {
        bool gone = !f->live[*function];
        *function = *label = 0;
        return gone;
    }
    default:
        break;
    }
    return *function && (!f->live[*function] || (*label && !f->reachable[*label]));
}

/* Functions that are called, directly or not, from the blocks that are left. */
static void find_live(folding *f)
{
    bool more = true;
    while (more) {
        more = false;
        uint32_t function = 0, label = 0;
        SPIRV_EACH(word, f->words, f->count)
        {
            const uint32_t *w = at(f, word);
            uint32_t opcode = spirv_opcode(w[0]), used = 0;
            if (opcode == OP_ENTRY_POINT)
                used = w[2];
            else if (!is_gone(f, word, &function, &label) && opcode == OP_FUNCTION_CALL)
                used = w[3];
            if (used && !f->live[used])
                f->live[used] = more = true;
        }
    }
}

/* The id that an instruction of a function defines, 0 for none. */
static uint32_t result_of(const uint32_t *w)
{
    switch (spirv_opcode(w[0])) {
    case OP_LABEL:
        return w[1];
    case OP_LINE:
    case OP_STORE:
    case OP_COPY_MEMORY:
    case OP_IMAGE_WRITE:
    case OP_CONTROL_BARRIER:
    case OP_MEMORY_BARRIER:
    case OP_ATOMIC_STORE:
    case OP_LOOP_MERGE:
    case OP_SELECTION_MERGE:
    case OP_BRANCH_CONDITIONAL:
    case OP_SWITCH:
        return 0;
    default: /* behind the result's type; what else has no result is shorter */
        return spirv_length(w[0]) > 2 ? w[2] : 0;
    }
}

/* Names and decorations of ids that are gone must go too. */
static void find_removed(folding *f)
{
    uint32_t function = 0, label = 0;
    SPIRV_EACH(word, f->words, f->count)
    {
        bool gone = is_gone(f, word, &function, &label);
        uint32_t id = gone ? result_of(at(f, word)) : 0;
        f->shuffles |= !gone && spirv_opcode(f->words[word]) == OP_GROUP_NON_UNIFORM_SHUFFLE;
        if (id && id < f->bound)
            f->removed[id] = true;
    }
}

lr_status lr_spirv_specialize(const uint32_t *words, size_t count, const uint32_t *constants,
                              uint32_t constant_count, lr_spirv *out, lr_error *error)
{
    *out = (lr_spirv){0};
    spirv_index index;
    lr_status status = spirv_index_create(&index, words, count, error);
    uint32_t bound = index.bound;
    spirv_index_free(&index);
    if (status)
        return status;
    folding f = {
        .words = words,
        .count = count,
        .bound = bound,
        .spec_ids = lr_alloc(bound, sizeof *f.spec_ids),
        .truths = lr_alloc(bound, sizeof *f.truths),
        .values = lr_alloc(bound, sizeof *f.values),
        .reachable = lr_alloc(bound, sizeof *f.reachable),
        .ends = lr_alloc(bound, sizeof *f.ends),
        .live = lr_alloc(bound, sizeof *f.live),
        .removed = lr_alloc(bound, sizeof *f.removed),
        .constants = constants,
        .constant_count = constant_count,
    };
    out->words = lr_alloc(count, sizeof *out->words);
    if (!f.spec_ids || !f.truths || !f.values || !f.reachable || !f.ends || !f.live || !f.removed ||
        !out->words) {
        status = lr_fail(error, LR_ERROR_MEMORY, "out of memory for a SPIR-V module");
        goto done;
    }
    find_reachable(&f);
    find_live(&f);
    find_removed(&f);
    memcpy(out->words, words, SPIRV_HEADER_WORDS * sizeof *words);
    out->count = SPIRV_HEADER_WORDS;
    uint32_t function = 0, label = 0;
    SPIRV_EACH(word, words, count)
    {
        uint32_t opcode = spirv_opcode(words[word]);
        if (is_gone(&f, word, &function, &label))
            continue;
        bool annotates = opcode == OP_NAME || opcode == OP_MEMBER_NAME || opcode == OP_DECORATE ||
                         opcode == OP_MEMBER_DECORATE;
        if (annotates && f.removed[words[word + 1]])
            continue;
        if (opcode == OP_DECORATE && words[word + 2] == DECORATION_SPEC_ID)
            continue;
        /* A device without shuffles must not see the capability either. */
        if (opcode == OP_CAPABILITY && words[word + 1] == CAPABILITY_SHUFFLE && !f.shuffles)
            continue;
        out->count += emit(&f, word, label, out->words + out->count);
    }
done:
    free(f.spec_ids);
    free(f.truths);
    free(f.values);
    free(f.reachable);
    free(f.ends);
    free(f.live);
    free(f.removed);
    if (status)
        lr_spirv_free(out);
    return status;
}
