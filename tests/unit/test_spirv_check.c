/* Each rule of the whitelist against a shader that breaks it, and all that is allowed in one. */
#include "unit/spirv_compile.h"

typedef struct violation {
    const char *rule, *instruction, *body;
    const char *globals;  /* extensions and declarations in front, or NULL */
    uint32_t from, to;    /* opcodes: what GLSL cannot say is put in place of what it can */
    bool is_module_scope; /* the message has no function to name */
} violation;

#define EXTENDED(name, body)                                                                       \
    {                                                                                              \
        "built-in", "GLSL.std.450 " name, body, NULL, 0, 0, false                                  \
    }
#define FLOAT16 "#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require"
#define ATOMIC_FLOAT "#extension GL_EXT_shader_atomic_float : require"
#define SUBGROUP "#extension GL_KHR_shader_subgroup_arithmetic : require"

static const violation violations[] = {
    {.rule = "division", .instruction = "OpFDiv", .body = "f[i] = a.x / b.x;"},
    {.rule = "division", .instruction = "OpFDiv", .body = "f[i] = (a / b).x;"},
    {.rule = "remainder", .instruction = "OpFMod", .body = "f[i] = mod(a.x, b.x);"},
    {"remainder", "OpFRem", "f[i] = mod(a.x, b.x);", NULL, 141, 140, false},
    {.rule = "dot", .instruction = "OpDot", .body = "f[i] = dot(a, b);"},
    {.rule = "matrix",
     .instruction = "OpMatrixTimesVector",
     .body = "f[i] = (mat3(a, b, a) * b).x;"},
    {.rule = "matrix",
     .instruction = "OpVectorTimesMatrix",
     .body = "f[i] = (b * mat3(a, b, a)).x;"},
    {.rule = "matrix",
     .instruction = "OpMatrixTimesMatrix",
     .body = "f[i] = (mat3(a, b, a) * mat3(b, b, a))[0].x;"},
    {.rule = "matrix",
     .instruction = "OpMatrixTimesScalar",
     .body = "f[i] = (mat3(a, b, a) * b.x)[0].x;"},
    {.rule = "matrix", .instruction = "OpOuterProduct", .body = "f[i] = outerProduct(a, b)[0].x;"},
    {.rule = "matrix",
     .instruction = "OpTranspose",
     .body = "f[i] = transpose(mat3(a, b, a))[0].x;"},
    {.rule = "nan-test", .instruction = "OpIsNan", .body = "f[i] = isnan(a.x) ? 1.0 : 0.0;"},
    {.rule = "nan-test", .instruction = "OpIsInf", .body = "f[i] = isinf(a.x) ? 1.0 : 0.0;"},
    EXTENDED("Sqrt", "f[i] = sqrt(a.x);"),
    EXTENDED("InverseSqrt", "f[i] = inversesqrt(a.x);"),
    EXTENDED("Normalize", "f[i] = normalize(a).x;"),
    EXTENDED("Length", "f[i] = length(a);"),
    EXTENDED("Distance", "f[i] = distance(a, b);"),
    EXTENDED("Cross", "f[i] = cross(a, b).x;"),
    EXTENDED("Reflect", "f[i] = reflect(a, b).x;"),
    EXTENDED("Refract", "f[i] = refract(a, b, 1.5).x;"),
    EXTENDED("FaceForward", "f[i] = faceforward(a, b, a).x;"),
    EXTENDED("Pow", "f[i] = pow(a.x, b.x);"),
    EXTENDED("Exp", "f[i] = exp(a.x);"),
    EXTENDED("Exp2", "f[i] = exp2(a.x);"),
    EXTENDED("Log", "f[i] = log(a.x);"),
    EXTENDED("Log2", "f[i] = log2(a.x);"),
    EXTENDED("Sin", "f[i] = sin(a.x);"),
    EXTENDED("Cos", "f[i] = cos(a.x);"),
    EXTENDED("Tan", "f[i] = tan(a.x);"),
    EXTENDED("Acos", "f[i] = acos(a.x);"),
    EXTENDED("Atan2", "f[i] = atan(a.x, b.x);"),
    EXTENDED("FMix", "f[i] = mix(a.x, b.x, 0.5);"),
    EXTENDED("Fma", "f[i] = fma(a.x, b.x, a.y);"),
    EXTENDED("Round", "f[i] = round(a.x);"),
    EXTENDED("RoundEven", "f[i] = roundEven(a.x);"),
    EXTENDED("Fract", "f[i] = fract(a.x);"),
    EXTENDED("FSign", "f[i] = sign(a.x);"),
    EXTENDED("Step", "f[i] = step(a.x, b.x);"),
    EXTENDED("SmoothStep", "f[i] = smoothstep(a.x, b.x, a.y);"),
    EXTENDED("Ldexp", "f[i] = ldexp(a.x, 3);"),
    EXTENDED("Modf", "float w; f[i] = modf(a.x, w);"),
    EXTENDED("Radians", "f[i] = radians(a.x);"),
    EXTENDED("PackHalf2x16", "u[i] = packHalf2x16(a.xy);"),
    EXTENDED("UnpackUnorm4x8", "f[i] = unpackUnorm4x8(u[i]).x;"),
    {.rule = "sampling",
     .instruction = "OpImageSampleExplicitLod",
     .body = "f[i] = textureLod(picture, a.xy, 0.0).x;"},
    {.rule = "sampling",
     .instruction = "OpImageGather",
     .body = "f[i] = textureGather(picture, a.xy).x;"},
    {.rule = "image-buffer",
     .instruction = "OpImageFetch",
     .body = "f[i] = texelFetch(picture, ivec2(1), 0).x;"},
    {.rule = "image-buffer",
     .instruction = "OpImageRead",
     .body = "f[i] = imageLoad(pixels, ivec2(1)).x;"},
    {.rule = "whitelist",
     .instruction = "opcode 99",
     .body = "imageStore(pixels, ivec2(1), vec4(1));"},
    {"derivative", "OpDPdx", "f[i] = -a.x;", NULL, 127, 207, false},
    {"derivative", "OpFwidthCoarse", "f[i] = -a.x;", NULL, 127, 215, false},
    {.rule = "signed-division", .instruction = "OpSDiv", .body = "s[i] = s[i] / 3;"},
    {.rule = "signed-division", .instruction = "OpSMod", .body = "s[i] = s[i] % 3;"},
    {"signed-division", "OpSRem", "s[i] = s[i] % 3;", NULL, 139, 138, false},
    {.rule = "divisor", .instruction = "OpUDiv", .body = "u[i] = u[i] / u[0];"},
    {.rule = "divisor", .instruction = "OpUMod", .body = "u[i] = u[i] % u[0];"},
    {.rule = "divisor", .instruction = "OpUDiv", .body = "u[i] = u[i] / SPEC;"},
    {.rule = "divisor", .instruction = "OpUMod", .body = "u[i] = u[i] % 0u;"},
    {.rule = "divisor",
     .instruction = "OpUDiv",
     .body = "uvec2 v = uvec2(u[i]) / uvec2(3u, 0u); u[i] = v.x + v.y;"},
    {.rule = "divisor",
     .instruction = "OpUDiv",
     .body = "u[i] = K;",
     .globals = "layout(constant_id = 7) const uint D = 3; const uint K = 9u / D;",
     .is_module_scope = true},
    {.rule = "shift-amount", .instruction = "OpShiftLeftLogical", .body = "u[i] = 1u << u[0];"},
    {.rule = "shift-amount", .instruction = "OpShiftRightLogical", .body = "u[i] = u[i] >> SPEC;"},
    {.rule = "shift-amount",
     .instruction = "OpShiftRightArithmetic",
     .body = "s[i] = s[i] >> s[0];"},
    {.rule = "shift-amount", .instruction = "OpShiftLeftLogical", .body = "u[i] = u[0] << 32;"},
    {.rule = "shift-amount", .instruction = "OpShiftLeftLogical", .body = "u[i] = u[0] << -1;"},
    {.rule = "shift-amount",
     .instruction = "OpShiftLeftLogical",
     .body = "u[i] = 1u << (u[0] & 32u);"},
    {.rule = "shift-amount",
     .instruction = "OpShiftLeftLogical",
     .body = "u[i] = 1u << (u[0] & u[1]);"},
    {.rule = "shift-amount",
     .instruction = "OpShiftLeftLogical",
     .body = "u[i] = (uvec2(1u) << uvec2(u[0], 3u)).x;"},
    {.rule = "shift-amount",
     .instruction = "OpShiftLeftLogical",
     .body = "u[i] = (uvec2(u[0]) << uvec2(3u, 40u)).x;"},
    {.rule = "shift-amount",
     .instruction = "OpShiftLeftLogical",
     .body = "u[i] = (uvec2(u[0]) << (uvec2(u[1]) & uvec2(31u, 63u))).x;"},
    {.rule = "shift-amount",
     .instruction = "OpShiftLeftLogical",
     .body = "u[i] = uint(uint16_t(u[0]) << uint16_t(16));",
     .globals = "#extension GL_EXT_shader_explicit_arithmetic_types_int16 : require"},
    {.rule = "float-width",
     .instruction = "OpTypeFloat",
     .body = "f[i] = float(float16_t(1.0) * float16_t(i));",
     .globals = FLOAT16,
     .is_module_scope = true},
    {.rule = "float-width",
     .instruction = "OpTypeFloat",
     .body = "f[i] = double(a.x) > 1.0 ? 1.0 : 0.0;",
     .is_module_scope = true},
    {"float-width", "OpQuantizeToF16", "f[i] = -a.x;", NULL, 127, 116, false},
    {"float-width", "OpFConvert", "f[i] = -a.x;", NULL, 127, 115, false},
    {.rule = "relaxed-precision",
     .instruction = "RelaxedPrecision",
     .body = "mediump float x = a.x; f[i] = x * x;",
     .is_module_scope = true},
    {.rule = "relaxed-precision",
     .instruction = "RelaxedPrecision",
     .body = "f[i] = x[i];",
     .globals = "layout(std430, binding = 9) buffer X { mediump float x[]; };",
     .is_module_scope = true},
    {.rule = "float-atomic",
     .instruction = "OpAtomicFAddEXT",
     .body = "atomicAdd(f[0], a.x);",
     .globals = ATOMIC_FLOAT},
    {.rule = "float-atomic",
     .instruction = "OpAtomicExchange",
     .body = "f[i] = atomicExchange(f[0], a.x);",
     .globals = ATOMIC_FLOAT},
    {.rule = "float-atomic",
     .instruction = "OpAtomicLoad",
     .body = "f[i] = atomicLoad(f[0], 1, 64, 2);",
     .globals = ATOMIC_FLOAT "\n#extension GL_KHR_memory_scope_semantics : require"},
    {.rule = "float-atomic",
     .instruction = "OpAtomicStore",
     .body = "atomicStore(f[0], a.x, 1, 64, 4);",
     .globals = ATOMIC_FLOAT "\n#extension GL_KHR_memory_scope_semantics : require"},
    {.rule = "float-reduction",
     .instruction = "OpGroupNonUniformFAdd",
     .body = "f[i] = subgroupAdd(a.x);",
     .globals = SUBGROUP},
    {.rule = "float-reduction",
     .instruction = "OpGroupNonUniformFMax",
     .body = "f[i] = subgroupMax(a.x);",
     .globals = SUBGROUP},
    {.rule = "float-spec-constant",
     .instruction = "OpSpecConstantOp OpSelect",
     .body = "f[i] = K;",
     .globals = "layout(constant_id = 7) const bool Q = true; const float K = Q ? 1.0 : 3.0;",
     .is_module_scope = true},
    {.rule = "undefined",
     .instruction = "OpUndef",
     .body = "f[i] = lacking(a.x);",
     .globals = "float lacking(float x) { if (x > 1.0) return 1.0; }"},
    {"whitelist", "opcode 4321", "f[i] = -a.x;", NULL, 127, 4321, false},
    {.rule = "decoration",
     .instruction = "OpDecorate",
     .body = "f[i] = -a.x;",
     .from = 42,
     .is_module_scope = true},
};

static lr_spirv compile_snippet(const char *globals, const char *body)
{
    char source[4096];
    snprintf(source, sizeof source, SPIRV_TEMPLATE, globals ? globals : "", body);
    return spirv_compile(source);
}

static void replace_opcode(lr_spirv *module, uint32_t from, uint32_t to)
{
    for (size_t at = 5; at < module->count; at += module->words[at] >> 16)
        if ((module->words[at] & 0xffff) == from)
            module->words[at] = (module->words[at] & 0xffff0000) | to;
}

static void replace_decoration(lr_spirv *module, uint32_t from, uint32_t to)
{
    for (size_t at = 5; at < module->count; at += module->words[at] >> 16)
        if ((module->words[at] & 0xffff) == 71 && module->words[at + 2] == from)
            module->words[at + 2] = to;
}

static void test_violations(void **state)
{
    (void)state;
    unsigned wrong = 0;
    for (size_t i = 0; i < sizeof violations / sizeof *violations; i++) {
        const violation *v = &violations[i];
        lr_spirv compiled = compile_snippet(v->globals, v->body), decorated;
        lr_error error = {0};
        char rule[64];
        assert_int_equal(lr_spirv_decorate(compiled.words, compiled.count, &decorated, &error),
                         LR_OK);
        if (v->to)
            replace_opcode(&decorated, v->from, v->to);
        else if (v->from)
            replace_decoration(&decorated, v->from, 40); /* FPFastMathMode */
        lr_status status = lr_spirv_check(decorated.words, decorated.count, &error);
        snprintf(rule, sizeof rule, "the rule \"%s\"", v->rule);
        bool right = status == LR_ERROR_ARGUMENT && strstr(error.message, v->instruction) &&
                     strstr(error.message, rule) &&
                     strstr(error.message, v->is_module_scope ? "at module scope" : "in function ");
        if (right && !v->is_module_scope && !strstr(v->body, "lacking"))
            right = strstr(error.message, "in function shade:") != NULL;
        if (!right) {
            print_error("%s\n  expected %s, %s\n  got \"%s\"\n", v->body, v->instruction, v->rule,
                        error.message);
            wrong++;
        }
        lr_spirv_free(&compiled);
        lr_spirv_free(&decorated);
    }
    assert_int_equal(wrong, 0);
}

static void test_missing_no_contraction(void **state)
{
    (void)state;
    static const char *const bodies[][2] = {
        {"OpFAdd", "f[i] = a.x + b.x;"},
        {"OpFSub", "f[i] = (a - b).x;"},
        {"OpFMul", "f[i] = a.x * b.x;"},
        {"OpFNegate", "f[i] = -a.x;"},
        {"OpFMul", "f[i] = a.x * b.x > 1.0 ? 1.0 : 0.0;"},
        {"OpVectorTimesScalar", "f[i] = (a * b.x).x;"},
    };
    for (size_t i = 0; i < sizeof bodies / sizeof *bodies; i++) {
        lr_spirv module = compile_snippet(NULL, bodies[i][1]), decorated;
        lr_error error = {0};
        char expected[128];
        snprintf(expected, sizeof expected, "in function shade: %s breaks the rule \"contraction\"",
                 bodies[i][0]);
        assert_int_equal(lr_spirv_check(module.words, module.count, &error), LR_ERROR_ARGUMENT);
        if (!strstr(error.message, expected))
            fail_msg("%s: %s", bodies[i][1], error.message);
        assert_int_equal(lr_spirv_decorate(module.words, module.count, &decorated, NULL), LR_OK);
        assert_int_equal(lr_spirv_check(decorated.words, decorated.count, NULL), LR_OK);
        lr_spirv_free(&module);
        lr_spirv_free(&decorated);
    }
}

static const char *const allowed_globals =
    "#extension GL_KHR_shader_subgroup_ballot : require\n"
    "#extension GL_KHR_shader_subgroup_shuffle : require\n"
    "#extension GL_KHR_shader_subgroup_arithmetic : require\n"
    "#extension GL_KHR_shader_subgroup_vote : require\n"
    "#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require\n"
    "shared uint cell[64];\n"
    "struct pair { vec3 p; uint n; };\n"
    "layout(std430, binding = 8) buffer P { pair pairs[]; };\n"
    "layout(binding = 9, r32f) uniform imageBuffer stored;\n"
    "layout(constant_id = 5) const uint MASK = 7;\n"
    "const uint DOUBLED = MASK * 2u + (MASK >> 3) + MASK / 5u;\n"
    "float twice(float x) { return x + x; }\n";

static const char *const allowed_body =
    "vec3 c = a * 2.0 + b - a * b; c = -c;"
    "c = abs(c); c = floor(c); c = ceil(c); c = trunc(c); c = min(c, a); c = max(c, b);"
    "c = clamp(c, 0.0, 1.0);"
    "if (c.x < a.x && c.y >= b.y || c.z == a.z || c.x != b.x) c.xy = c.yx;"
    "int k = int(c.x); uint n = uint(c.y); c.z = float(k) + float(n);"
    "n = floatBitsToUint(c.x); c.x = uintBitsToFloat(n ^ 1u);"
    "k = min(k, 3); k = max(k, -3); k = clamp(k, -2, 2); k = abs(k);"
    "n = min(n, 9u); n = max(n, 1u); n = clamp(n, 2u, 8u);"
    "k = findLSB(n) + findMSB(n) + findMSB(k) + bitCount(n);"
    "n = bitfieldReverse(n); n = bitfieldExtract(n, 3, 4); n = bitfieldInsert(n, 5u, 3, 4);"
    "n = n / 3u + n % 7u; uvec2 v = uvec2(n) / uvec2(3u, 5u); n = v.x;"
    "n = n << 31; n = n >> (n & 31u); n = n << (n & 7u); k = k >> (3 & k); k = -k;"
    "v = v << 4; v = v >> uvec2(3u, 31u); v = v << (v & 15u); v = v >> (n & 31u); v = v / 3u;"
    "uint64_t w = uint64_t(n) << 31; n = uint(w / 10ul);"
    "uint low, high; umulExtended(n, 77u, high, low); n = uaddCarry(low, high, low) + low;"
    "n = usubBorrow(n, high, low) + low; int hi, lo; imulExtended(k, 3, hi, lo); k = hi + lo;"
    "for (int j = 0; j < 4; j++) { if (j == k) continue; if (n == 0u) break; n++; }"
    "while (n > 5u) n -= 2u; do { n++; } while (n < 3u);"
    "switch (k) { case 0: n = 1u; break; case 1: n = 2u; default: n += 3u; }"
    "vec4 t = texelFetch(texels, int(n & 3u)) + imageLoad(stored, k);"
    "c += t.xyz; c[n & 1u] = t.w; n += u.length() + uint(textureSize(texels));"
    "cell[i & 63u] = n; barrier(); memoryBarrierShared(); n = cell[(i + 1u) & 63u];"
    "n += atomicAdd(u[0], 1u) + atomicMin(u[1], n) + atomicOr(u[2], 4u);"
    "n += atomicExchange(u[3], n) + atomicCompSwap(u[4], 1u, n); k += atomicMax(s[0], k);"
    "uvec4 ballot = subgroupBallot(n > 3u); n += subgroupBallotBitCount(ballot);"
    "n = subgroupAdd(n) + subgroupExclusiveAdd(1u) + subgroupMin(n);"
    "c.x = subgroupShuffle(c.x, 3u); if (subgroupElect()) n++; if (subgroupAny(n == 1u)) n--;"
    "pair q = pairs[i]; q.p = c; pairs[i] = q; bvec3 m = lessThan(a, b);"
    "if (any(m) && !all(m) && all(not(m))) c = mix(a, b, m);"
    "f[i] = twice(c.x) + (m.x ? c.y : c.z); u[i] = n + MASK + DOUBLED; s[i] = k & ~3 | 1;";

static void test_allowed(void **state)
{
    (void)state;
    lr_spirv module = compile_snippet(allowed_globals, allowed_body), decorated;
    lr_error error = {0};
    assert_int_equal(lr_spirv_decorate(module.words, module.count, &decorated, &error), LR_OK);
    if (lr_spirv_check(decorated.words, decorated.count, &error) != LR_OK)
        fail_msg("%s", error.message);
    assert_true(spirv_is_valid(decorated.words, decorated.count));
    lr_spirv_free(&module);
    lr_spirv_free(&decorated);
}

static void test_names(void **state)
{
    (void)state;
    lr_spirv module = compile_snippet(NULL, "f[i] = a.x / b.x;");
    replace_opcode(&module, 5, 0); /* OpName to something that is no name */
    for (size_t at = 5; at < module.count; at += module.words[at] >> 16)
        if ((module.words[at] & 0xffff) == 0)
            module.words[at] = (module.words[at] & 0xffff0000) | 330; /* OpModuleProcessed */
    lr_error error = {0};
    assert_int_equal(lr_spirv_check(module.words, module.count, &error), LR_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "in function %"));
    lr_spirv_free(&module);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_violations),
        cmocka_unit_test(test_missing_no_contraction),
        cmocka_unit_test(test_allowed),
        cmocka_unit_test(test_names),
    };
    return cmocka_run_group_tests(tests, spirv_setup, spirv_teardown);
}
