/* Decorating modules, declaring modes, modules that are broken, and the build's embed_shader. */
#include "unit/spirv_compile.h"

enum { NO_CONTRACTION = 42, OP_DECORATE = 71 };

static lr_spirv compile_snippet(const char *globals, const char *body)
{
    char source[4096];
    snprintf(source, sizeof source, SPIRV_TEMPLATE, globals, body);
    return spirv_compile(source);
}

/* The number of NoContraction decorations; fails when an id has two. */
static unsigned count_decorations(const lr_spirv *module)
{
    unsigned found = 0;
    for (size_t at = 5; at < module->count; at += module->words[at] >> 16) {
        const uint32_t *word = module->words + at;
        if ((*word & 0xffff) != OP_DECORATE || word[2] != NO_CONTRACTION)
            continue;
        assert_int_equal(spirv_count(module, (uint32_t[]){OP_DECORATE, word[1], NO_CONTRACTION}, 3),
                         1);
        found++;
    }
    return found;
}

static lr_spirv decorate(const lr_spirv *module)
{
    lr_spirv decorated;
    lr_error error = {0};
    if (lr_spirv_decorate(module->words, module->count, &decorated, &error) != LR_OK)
        fail_msg("%s", error.message);
    return decorated;
}

static void test_decorate(void **state)
{
    (void)state;
    /* One of each: add, subtract, multiply, negate, vector times scalar. */
    lr_spirv module = compile_snippet("", "f[i] = a.x + b.x * a.y - (-b.y) + (a * b.z).x;");
    assert_int_equal(count_decorations(&module), 0);
    lr_spirv once = decorate(&module), twice = decorate(&once);
    assert_int_equal(count_decorations(&once), 6);
    assert_int_equal(once.count, module.count + 3 * 6);
    assert_int_equal(twice.count, once.count);
    assert_memory_equal(twice.words, once.words, once.count * sizeof *once.words);
    assert_true(spirv_is_valid(once.words, once.count));
    assert_int_equal(lr_spirv_check(once.words, once.count, NULL), LR_OK);
    lr_spirv_free(&module);
    lr_spirv_free(&once);
    lr_spirv_free(&twice);
}

/* What the check refuses is decorated all the same: the two do not rely on each other. */
static void test_decorate_refused(void **state)
{
    (void)state;
    lr_spirv module = compile_snippet(
        "", "f[i] = a.x / b.x + dot(a, b) + (mat3(a, b, a) * b).x + mod(a.y, b.y);");
    lr_spirv decorated = decorate(&module);
    assert_int_equal(count_decorations(&decorated), 7);
    lr_spirv_free(&module);
    lr_spirv_free(&decorated);
}

static void test_precise(void **state)
{
    (void)state;
    lr_spirv module = compile_snippet(
        "", "precise float x = a.x * b.x + a.y; f[i] = x; f[i + 1] = a.z * b.z + b.y;");
    unsigned before = count_decorations(&module);
    lr_spirv decorated = decorate(&module);
    assert_int_equal(before, 2);
    assert_int_equal(count_decorations(&decorated), 4);
    assert_true(spirv_is_valid(decorated.words, decorated.count));
    lr_spirv_free(&module);
    lr_spirv_free(&decorated);
}

/* Functions, conditions and stores alike. */
static void test_functions(void **state)
{
    (void)state;
    lr_spirv module = compile_snippet("bool test(vec3 a) { return a.x * a.y + a.z > 0; }",
                                      "f[i] = test(a) ? 1.0 : -a.x;");
    lr_spirv decorated = decorate(&module);
    assert_int_equal(count_decorations(&decorated), 3);
    assert_int_equal(lr_spirv_check(decorated.words, decorated.count, NULL), LR_OK);
    lr_spirv_free(&module);
    lr_spirv_free(&decorated);
}

static void check_modes(const lr_spirv *module, const lr_spirv_modes *modes, unsigned entries)
{
    static const struct {
        uint32_t capability, mode;
    } table[] = {{4464, 4459}, {4465, 4460}, {4466, 4461}, {4467, 4462}};
    const bool wanted[] = {modes->denorm_preserve, modes->denorm_flush_to_zero,
                           modes->signed_zero_inf_nan, modes->rounding_rte};
    bool any = false;
    for (size_t i = 0; i < 4; i++) {
        unsigned found = 0;
        for (size_t at = 5; at < module->count; at += module->words[at] >> 16)
            found += (module->words[at] & 0xffff) == 16 && module->words[at + 2] == table[i].mode &&
                     module->words[at + 3] == 32;
        assert_int_equal(found, wanted[i] ? entries : 0);
        assert_int_equal(spirv_count(module, (uint32_t[]){17, table[i].capability}, 2), wanted[i]);
        any = any || wanted[i];
    }
    static const char name[24] = "SPV_KHR_float_controls";
    uint32_t extension[7] = {10};
    memcpy(extension + 1, name, sizeof name); /* the tests run on little-endian machines */
    assert_int_equal(spirv_count(module, extension, 7), any);
}

static lr_spirv add_modes(const lr_spirv *module, const lr_spirv_modes *modes)
{
    lr_spirv changed;
    lr_error error = {0};
    if (lr_spirv_add_modes(module->words, module->count, modes, &changed, &error) != LR_OK)
        fail_msg("%s", error.message);
    return changed;
}

static void test_modes(void **state)
{
    (void)state;
    lr_spirv module = compile_snippet("", "f[i] = a.x * b.x;"), decorated = decorate(&module);
    for (unsigned bits = 0; bits < 16; bits++) {
        lr_spirv_modes modes = {bits & 1, bits & 2, bits & 4, bits & 8};
        if (modes.denorm_preserve && modes.denorm_flush_to_zero) {
            lr_spirv none;
            assert_int_equal(
                lr_spirv_add_modes(decorated.words, decorated.count, &modes, &none, NULL),
                LR_ERROR_ARGUMENT);
            assert_null(none.words);
            continue;
        }
        lr_spirv changed = add_modes(&decorated, &modes), again = add_modes(&changed, &modes);
        check_modes(&changed, &modes, 1);
        assert_int_equal(again.count, changed.count);
        assert_memory_equal(again.words, changed.words, changed.count * sizeof *changed.words);
        assert_true(spirv_is_valid(changed.words, changed.count));
        assert_int_equal(lr_spirv_check(changed.words, changed.count, NULL), LR_OK);
        lr_spirv_free(&changed);
        lr_spirv_free(&again);
    }
    lr_spirv_free(&module);
    lr_spirv_free(&decorated);
}

static void test_modes_of_two_entry_points(void **state)
{
    (void)state;
    static const char *const assembly = "OpCapability Shader\n"
                                        "OpMemoryModel Logical GLSL450\n"
                                        "OpEntryPoint GLCompute %first \"first\"\n"
                                        "OpEntryPoint GLCompute %second \"second\"\n"
                                        "OpExecutionMode %first LocalSize 1 1 1\n"
                                        "OpExecutionMode %second LocalSize 1 1 1\n"
                                        "%void = OpTypeVoid\n"
                                        "%type = OpTypeFunction %void\n"
                                        "%first = OpFunction %void None %type\n"
                                        "%a = OpLabel\n"
                                        "OpReturn\n"
                                        "OpFunctionEnd\n"
                                        "%second = OpFunction %void None %type\n"
                                        "%b = OpLabel\n"
                                        "OpReturn\n"
                                        "OpFunctionEnd\n";
    if (!spirv_has_tool("spirv-as"))
        skip();
    char command[512];
    const char *in = spirv_path("two.spvasm"), *out = spirv_path("two.spv");
    assert_int_equal(lr_file_write(in, assembly, strlen(assembly), NULL), LR_OK);
    snprintf(command, sizeof command, "spirv-as --target-env spv1.3 -o %s %s", out, in);
    assert_int_equal(system(command), 0);
    lr_spirv_modes modes = {.rounding_rte = true, .signed_zero_inf_nan = true};
    lr_spirv module = spirv_load(out), changed = add_modes(&module, &modes);
    check_modes(&changed, &modes, 2);
    assert_true(spirv_is_valid(changed.words, changed.count));
    lr_spirv_free(&module);
    lr_spirv_free(&changed);
}

/* Runs everything on a copy of exactly the module's size, so that a sanitizer sees any read behind
 * it. Whatever is returned, success comes with a module and failure with a message. */
static void survive(const uint32_t *words, size_t count)
{
    uint32_t *copy = malloc(count ? count * sizeof *words : 1);
    if (count)
        memcpy(copy, words, count * sizeof *words);
    lr_spirv_modes modes = {.rounding_rte = true, .denorm_preserve = true};
    lr_spirv out;
    lr_error error = {0};
    bool good = lr_spirv_decorate(copy, count, &out, &error) == LR_OK;
    assert_true(good == (out.words != NULL) && good == (error.message[0] == 0));
    lr_spirv_free(&out);
    error = (lr_error){0};
    good = lr_spirv_add_modes(copy, count, &modes, &out, &error) == LR_OK;
    assert_true(good == (out.words != NULL) && good == (error.message[0] == 0));
    lr_spirv_free(&out);
    error = (lr_error){0};
    good = lr_spirv_check(copy, count, &error) == LR_OK;
    assert_true(good == (error.message[0] == 0));
    free(copy);
}

static uint32_t random_word(uint32_t *seed)
{
    *seed = *seed * 747796405u + 2891336453u;
    uint32_t word = ((*seed >> (*seed >> 28) >> 4) ^ *seed) * 277803737u;
    return word >> 22 ^ word;
}

static void test_corruption(void **state)
{
    (void)state;
    lr_spirv module = compile_snippet(
        "bool test(vec3 a) { return a.x * a.y + a.z > 0; }",
        "for (int k = 0; k < 3; k++) f[i] += max(a.x, b[k]) * 2.0;"
        "u[i] = (u[0] << (u[1] & 31u)) + u[2] / 3u + atomicAdd(u[3], 1u) + (SPEC >> 2);"
        "f[i] += texelFetch(texels, 3).x; if (test(a)) s[0] = int(a.x);");
    lr_spirv decorated = decorate(&module);
    size_t count = decorated.count;
    for (size_t cut = 0; cut < count; cut++)
        survive(decorated.words, cut);

    uint32_t seed = 1;
    uint32_t *changed = malloc(count * sizeof *changed);
    for (int round = 0; round < 20000; round++) {
        memcpy(changed, decorated.words, count * sizeof *changed);
        for (uint32_t change = random_word(&seed) % 4 + 1; change > 0; change--) {
            uint32_t *word = &changed[random_word(&seed) % count], value = random_word(&seed);
            switch (random_word(&seed) % 4) {
            case 0:
                *word = value;
                break;
            case 1:
                *word = value % (2 * decorated.words[3]);
                break;
            case 2:
                *word ^= 1u << (value & 31);
                break;
            default: /* the opcode or the length alone */
                *word = value & 1 ? (*word & 0xffff0000) | (value >> 8 & 511)
                                  : (*word & 0xffff) | (value >> 8 & 7) << 16;
            }
        }
        if (changed[3] < 1 << 16) /* the bound decides how much memory each round touches */
            survive(changed, count);
    }
    free(changed);
    lr_spirv_free(&module);
    lr_spirv_free(&decorated);
}

static void expect_malformed(const uint32_t *words, size_t count, const char *expected)
{
    lr_error error = {0};
    assert_int_equal(lr_spirv_check(words, count, &error), LR_ERROR_ARGUMENT);
    if (!strstr(error.message, expected))
        fail_msg("expected \"%s\", got \"%s\"", expected, error.message);
    survive(words, count);
}

static void test_malformed(void **state)
{
    (void)state;
    enum { MAGIC = 0x07230203, FNEGATE = 4 << 16 | 127, NAME = 3 << 16 | 5 };
    expect_malformed(NULL, 0, "fewer than the header");
    expect_malformed((uint32_t[]){MAGIC, 0x10300, 0, 9}, 4, "fewer than the header");
    expect_malformed((uint32_t[]){0x03022307, 0x10300, 0, 9, 0}, 5, "byte order");
    expect_malformed((uint32_t[]){0x464c457f, 0x10300, 0, 9, 0}, 5, "starts with 0x464c457f");
    expect_malformed((uint32_t[]){MAGIC, 0x10300, 0, 0, 0}, 5, "id bound 0");
    expect_malformed((uint32_t[]){MAGIC, 0x10300, 0, 0xffffffff, 0}, 5, "id bound 4294967295");
    expect_malformed((uint32_t[]){MAGIC, 0x10300, 0, 9, 0, 0}, 6, "length 0");
    expect_malformed((uint32_t[]){MAGIC, 0x10300, 0, 9, 0, FNEGATE, 1, 2}, 8, "truncated");
    expect_malformed((uint32_t[]){MAGIC, 0x10300, 0, 9, 0, FNEGATE, 1, 9, 3}, 9, "bound");
    expect_malformed((uint32_t[]){MAGIC, 0x10300, 0, 9, 0, FNEGATE, 1, 2, 9}, 9, "bound");
    expect_malformed((uint32_t[]){MAGIC, 0x10300, 0, 9, 0, NAME, 0, 0}, 8, "bound");
    expect_malformed((uint32_t[]){MAGIC, 0x10300, 0, 9, 0, 1 << 16 | 129}, 6, "too short");
    expect_malformed((uint32_t[]){MAGIC, 0x10300, 0, 9, 0, 4 << 16 | 19, 1, 2, 3}, 9, "too many");
    expect_malformed((uint32_t[]){MAGIC, 0x10300, 0, 9, 0, 2 << 16 | 21, 1}, 7, "too few");
    expect_malformed((uint32_t[]){MAGIC, 0x10300, 0, 9, 0, 2 << 16 | 19, 1, 2 << 16 | 20, 1}, 9,
                     "second time");

    /* Results that share an id do not overflow the room for decorations. */
    uint32_t same[5 + 4 * 100] = {MAGIC, 0x10300, 0, 3, 0};
    for (size_t at = 5; at < sizeof same / sizeof *same; at += 4)
        memcpy(same + at, (uint32_t[]){FNEGATE, 1, 2, 1}, 16);
    lr_spirv module = {same, sizeof same / sizeof *same}, decorated = decorate(&module);
    assert_int_equal(decorated.count, module.count + 3);
    lr_spirv_free(&decorated);
}

static int embed(const char *arguments)
{
    char command[512];
    snprintf(command, sizeof command, "%s/embed_shader %s >%s/said 2>&1", BINARY_DIR, arguments,
             spirv_folder);
    return system(command);
}

static void read_text(const char *path, char **text)
{
    size_t size;
    if (lr_file_read(path, 1 << 24, text, &size, NULL) != LR_OK)
        fail_msg("%s cannot be read", path);
}

static void test_embed_shader(void **state)
{
    (void)state;
    if (access(BINARY_DIR "/embed_shader", X_OK) != 0) {
        print_message("embed_shader is not built\n");
        skip();
    }
    char arguments[384];
    lr_spirv module = compile_snippet("", "f[i] = a.x * b.x;"), decorated = decorate(&module);
    assert_int_equal(lr_file_write(spirv_path("good.spv"), module.words, module.count * 4, NULL),
                     LR_OK);
    for (int i = 0; i < 2; i++) {
        snprintf(arguments, sizeof arguments, "%s/good.spv good_spv %s/%d.h", spirv_folder,
                 spirv_folder, i);
        assert_int_equal(embed(arguments), 0);
    }
    char *first, *second, *said;
    read_text(spirv_path("0.h"), &first);
    read_text(spirv_path("1.h"), &second);
    assert_string_equal(first, second);
    char *at = strstr(first, "static const uint32_t good_spv[] = {");
    assert_non_null(at);
    assert_non_null(strstr(first, "#include <stdint.h>"));
    at = strchr(at, '{') + 1;
    for (size_t i = 0; i < decorated.count; i++, at = strchr(at, ',') + 1)
        assert_int_equal(strtoul(at, &at, 16), decorated.words[i]);
    assert_null(strchr(at, ','));
    free(first);
    free(second);

    /* Undecorated, the same module does not pass the check. */
    snprintf(arguments, sizeof arguments, "--check %s/good.spv", spirv_folder);
    assert_int_not_equal(embed(arguments), 0);
    assert_int_equal(
        lr_file_write(spirv_path("good.spv"), decorated.words, decorated.count * 4, NULL), LR_OK);
    assert_int_equal(embed(arguments), 0);
    lr_spirv_free(&module);
    lr_spirv_free(&decorated);

    module = compile_snippet("", "f[i] = sqrt(a.x);");
    assert_int_equal(lr_file_write(spirv_path("bad.spv"), module.words, module.count * 4 - 2, NULL),
                     LR_OK);
    snprintf(arguments, sizeof arguments, "%s/bad.spv bad_spv %s/bad.h", spirv_folder,
             spirv_folder);
    assert_int_not_equal(embed(arguments), 0); /* half a word at the end */
    assert_int_equal(lr_file_write(spirv_path("bad.spv"), module.words, module.count * 4, NULL),
                     LR_OK);
    assert_int_not_equal(embed(arguments), 0);
    assert_int_not_equal(access(spirv_path("bad.h"), F_OK), 0);
    read_text(spirv_path("said"), &said);
    assert_non_null(strstr(said, "bad.spv: in function shade: GLSL.std.450 Sqrt breaks the rule"));
    free(said);
    lr_spirv_free(&module);
    assert_int_not_equal(embed("--check /nonexistent.spv"), 0);
    assert_int_not_equal(embed(""), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_decorate),     cmocka_unit_test(test_decorate_refused),
        cmocka_unit_test(test_precise),      cmocka_unit_test(test_functions),
        cmocka_unit_test(test_modes),        cmocka_unit_test(test_modes_of_two_entry_points),
        cmocka_unit_test(test_malformed),    cmocka_unit_test(test_corruption),
        cmocka_unit_test(test_embed_shader),
    };
    return cmocka_run_group_tests(tests, spirv_setup, spirv_teardown);
}
