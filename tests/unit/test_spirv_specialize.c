/* The real kernels, specialised: valid, within the exact rules, and without what was ruled out.
 * That they still compute the same is tested on the device. */
#include "unit/spirv_compile.h"

#include "gpu_layout.h"
#include "camera.spv.h"
#include "path_loop.spv.h"
#include "shade.spv.h"
#include "trace.spv.h"

enum {
    OP_NAME = 5,
    OP_CONSTANT_TRUE = 41,
    OP_CONSTANT_FALSE = 42,
    OP_SPEC_CONSTANT_TRUE = 48,
    OP_SPEC_CONSTANT_FALSE = 49,
    OP_SPEC_CONSTANT = 50,
    OP_SPEC_CONSTANT_OP = 52,
    OP_FUNCTION = 54,
    OP_DECORATE = 71,
    OP_BRANCH_CONDITIONAL = 250,
    OP_ACCESS_CHAIN = 65,
    DECORATION_SPEC_ID = 1,
    DECORATION_BINDING = 33,
    IDS_MAX = 131072,
};

static const struct {
    const char *name;
    const uint32_t *words;
    size_t count;
} kernels[] = {
    {"trace", trace_spv, sizeof trace_spv / 4},
    {"shade", shade_spv, sizeof shade_spv / 4},
    {"camera", camera_spv, sizeof camera_spv / 4},
    {"path_loop", path_loop_spv, sizeof path_loop_spv / 4},
};
enum { KERNEL_COUNT = sizeof kernels / sizeof *kernels };

#define EACH(at, m) for (size_t at = 5; at < (m)->count; at += (m)->words[at] >> 16)

static lr_spirv specialize(int kernel, const uint32_t constants[LR_SPEC_COUNT])
{
    lr_spirv module;
    lr_error error = {0};
    if (lr_spirv_specialize(kernels[kernel].words, kernels[kernel].count, constants, LR_SPEC_COUNT,
                            &module, &error))
        fail_msg("%s: %s", kernels[kernel].name, error.message);
    return module;
}

/* Whether the module has a function whose name begins so. */
/* No specialisation constant is left, and no branch whose condition is known. */
static void check_folded(const lr_spirv *module)
{
    static bool known[IDS_MAX];
    memset(known, 0, sizeof known);
    assert_true(module->words[3] <= IDS_MAX);
    EACH(at, module)
    {
        const uint32_t *w = &module->words[at];
        switch (w[0] & 0xFFFF) {
        case OP_SPEC_CONSTANT_TRUE:
        case OP_SPEC_CONSTANT_FALSE:
        case OP_SPEC_CONSTANT:
        case OP_SPEC_CONSTANT_OP:
            fail_msg("a specialisation constant is left");
            break;
        case OP_DECORATE:
            assert_int_not_equal(w[2], DECORATION_SPEC_ID);
            break;
        case OP_CONSTANT_TRUE:
        case OP_CONSTANT_FALSE:
            known[w[2]] = true;
            break;
        case OP_BRANCH_CONDITIONAL:
            assert_false(known[w[1]]);
            break;
        default:
            break;
        }
    }
}

static void check_module(int kernel, const uint32_t constants[LR_SPEC_COUNT])
{
    lr_spirv module = specialize(kernel, constants);
    lr_error error = {0};
    check_folded(&module);
    assert_true(module.count <= kernels[kernel].count);
    assert_true(spirv_is_valid(module.words, module.count));
    if (lr_spirv_check(module.words, module.count, &error))
        fail_msg("%s: %s", kernels[kernel].name, error.message);
    lr_spirv_free(&module);
}

static void test_all_and_none(void **state)
{
    (void)state;
    for (int kernel = 0; kernel < KERNEL_COUNT; kernel++) {
        uint32_t all[LR_SPEC_COUNT], none[LR_SPEC_COUNT] = {0};
        for (int i = 0; i < LR_SPEC_COUNT; i++)
            all[i] = 1;
        check_module(kernel, all);
        check_module(kernel, none);
        lr_spirv full = specialize(kernel, all), empty = specialize(kernel, none);
        assert_true(empty.count < full.count);
        lr_spirv_free(&full);
        lr_spirv_free(&empty);
    }
}

static void test_each_alone_and_missing(void **state)
{
    (void)state;
    for (int kernel = 0; kernel < KERNEL_COUNT; kernel++)
        for (int one = 0; one < LR_SPEC_COUNT; one++) {
            uint32_t constants[LR_SPEC_COUNT];
            for (uint32_t alone = 0; alone < 2; alone++) {
                for (int i = 0; i < LR_SPEC_COUNT; i++)
                    constants[i] = (i == one) == alone;
                check_module(kernel, constants);
            }
        }
}

static void test_random_choices(void **state)
{
    (void)state;
    uint32_t bits = 1;
    for (int round = 0; round < 60; round++) {
        uint32_t constants[LR_SPEC_COUNT];
        for (int i = 0; i < LR_SPEC_COUNT; i++) {
            bits = bits * 747796405u + 2891336453u;
            constants[i] = bits >> 31;
        }
        check_module(round % KERNEL_COUNT, constants);
    }
}

/* Words that a part of a kernel takes at least, when all others are there. */
static void test_what_is_ruled_out_is_gone(void **state)
{
    (void)state;
    const struct {
        int constant, kernel;
        size_t words;
    } parts[] = {
        {LR_SPEC_SPHERES, 0, 500},  {LR_SPEC_ELLIPSOIDS, 0, 400}, {LR_SPEC_PLANES, 0, 400},
        {LR_SPEC_FLATS, 0, 500},    {LR_SPEC_BOXES, 0, 400},      {LR_SPEC_CONES, 0, 1000},
        {LR_SPEC_BOXES, 1, 500},    {LR_SPEC_SPHERES, 1, 500},    {LR_SPEC_MEDIA, 1, 1000},
        {LR_SPEC_FRESNEL, 1, 300},  {LR_SPEC_SPECULAR, 1, 500},   {LR_SPEC_PATTERNS, 1, 1000},
        {LR_SPEC_SCATTER, 1, 2000}, {LR_SPEC_TEXTURES, 1, 1000},  {LR_SPEC_FOG, 1, 100},
        {LR_SPEC_EXPLAIN, 0, 500},  {LR_SPEC_EXPLAIN, 1, 2000},
    };
    uint32_t constants[LR_SPEC_COUNT];
    for (int i = 0; i < LR_SPEC_COUNT; i++)
        constants[i] = i != LR_SPEC_INSPECT; /* which shows no light */
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        constants[LR_SPEC_TREES] = 0;
        lr_spirv with = specialize(parts[i].kernel, constants);
        constants[parts[i].constant] = 0;
        lr_spirv without = specialize(parts[i].kernel, constants);
        constants[parts[i].constant] = 1;
        if (without.count + parts[i].words > with.count)
            fail_msg("constant %d takes %zu words only", parts[i].constant,
                     with.count - without.count);
        lr_spirv_free(&with);
        lr_spirv_free(&without);
    }
}

/* Of what notes rays nothing is left in kernels that make pictures. */
static void test_pictures_have_no_notes(void **state)
{
    (void)state;
    for (int kernel = 0; kernel < KERNEL_COUNT; kernel++)
        for (uint32_t explains = 0; explains < 2; explains++) {
            uint32_t constants[LR_SPEC_COUNT], notes = 0, uses = 0;
            for (int i = 0; i < LR_SPEC_COUNT; i++)
                constants[i] = i != LR_SPEC_EXPLAIN || explains;
            lr_spirv module = specialize(kernel, constants);
            EACH(at, &module)
            {
                const uint32_t *w = &module.words[at];
                if ((w[0] & 0xFFFF) == OP_DECORATE && w[2] == DECORATION_BINDING &&
                    w[3] == LR_BIND_NOTES)
                    notes = w[1];
                uses += (w[0] & 0xFFFF) == OP_ACCESS_CHAIN && notes && w[3] == notes;
            }
            bool noting = explains && (kernels[kernel].words == trace_spv ||
                                       kernels[kernel].words == shade_spv);
            assert_int_equal(uses > 0, noting);
            lr_spirv_free(&module);
        }
}

/* Of what stands behind `if (number > k)` each is there that the number reaches. */
static void test_numbers(void **state)
{
    (void)state;
    uint32_t constants[LR_SPEC_COUNT] = {[LR_SPEC_FEW] = 1, [LR_SPEC_FLATS] = 1};
    size_t before = 0, first = 0;
    for (uint32_t flats = 0; flats <= LR_FEW_FLATS + 1; flats++) {
        constants[LR_SPEC_FEW_FLATS] = flats;
        check_module(3, constants);
        lr_spirv module = specialize(3, constants);
        size_t more = module.count - before;
        before = module.count;
        lr_spirv_free(&module);
        first = flats == 1 ? more : first;
        if (flats > 1 && flats <= LR_FEW_FLATS)
            assert_true(more > first / 2 && more < 2 * first);
        if (flats > LR_FEW_FLATS)
            assert_int_equal(more, 0);
    }
    assert_true(first > 300);
}

/* Constants that are not given keep what the module says. */
static void test_defaults(void **state)
{
    (void)state;
    uint32_t defaults[LR_SPEC_COUNT];
    for (int i = 0; i < LR_SPEC_COUNT; i++)
        defaults[i] = i != LR_SPEC_EXPLAIN;
    defaults[LR_SPEC_FEW_PLANES] = LR_FEW_PLANES;
    defaults[LR_SPEC_FEW_SPHERES] = LR_FEW_SPHERES;
    defaults[LR_SPEC_FEW_FLATS] = LR_FEW_FLATS;
    defaults[LR_SPEC_FEW_SOLIDS] = LR_FEW_SOLIDS;
    lr_spirv given = specialize(0, defaults), left;
    assert_int_equal(lr_spirv_specialize(trace_spv, sizeof trace_spv / 4, NULL, 0, &left, NULL),
                     LR_OK);
    assert_int_equal(given.count, left.count);
    assert_memory_equal(given.words, left.words, 4 * given.count);
    lr_spirv_free(&given);
    lr_spirv_free(&left);
}

/* A module that ends within an instruction is refused; in a copy of its own, so that a sanitizer
 * sees reads past its end. */
static void test_truncated(void **state)
{
    (void)state;
    uint32_t constants[LR_SPEC_COUNT] = {0};
    size_t next = 5;
    for (size_t count = 0; count < 2000; count++) {
        bool whole = count == next;
        if (whole)
            next += shade_spv[next] >> 16;
        uint32_t *words = malloc(count ? 4 * count : 1);
        memcpy(words, shade_spv, 4 * count);
        lr_spirv module;
        lr_error error = {0};
        lr_status status =
            lr_spirv_specialize(words, count, constants, LR_SPEC_COUNT, &module, &error);
        if (!whole) {
            assert_int_equal(status, LR_ERROR_ARGUMENT);
            assert_true(error.message[0]);
            assert_null(module.words);
        }
        lr_spirv_free(&module);
        free(words);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_all_and_none),
        cmocka_unit_test(test_each_alone_and_missing),
        cmocka_unit_test(test_random_choices),
        cmocka_unit_test(test_what_is_ruled_out_is_gone),
        cmocka_unit_test(test_pictures_have_no_notes),
        cmocka_unit_test(test_numbers),
        cmocka_unit_test(test_defaults),
        cmocka_unit_test(test_truncated),
    };
    return cmocka_run_group_tests(tests, spirv_setup, spirv_teardown);
}
