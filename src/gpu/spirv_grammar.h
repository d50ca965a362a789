/* The whitelist of spirv_check.c: one line per instruction that may, or must not, appear.
 *
 * `operands` describes the words behind the first: t result type, r result, i id, # literal,
 * * the rest are ids, ~ the rest is optional and not looked at. */
#ifndef LR_GPU_SPIRV_GRAMMAR_H
#define LR_GPU_SPIRV_GRAMMAR_H

#include <stdint.h>

typedef struct spirv_rule {
    const char *name, *text;
} spirv_rule;

#define RULE(symbol, name, text) static const spirv_rule symbol = {name, text}

RULE(rule_contraction, "contraction", "a float operation that lacks NoContraction may be fused");
RULE(rule_division, "division",
     "float division is rounded as the driver likes; use shaders/exact.glsl");
RULE(rule_remainder, "remainder",
     "float remainders are rounded as the driver likes; use floor and products");
RULE(rule_dot, "dot", "dot() is rounded as the driver likes; write out the sum of products");
RULE(rule_matrix, "matrix",
     "matrix operations are rounded as the driver likes; write out the sums of products");
RULE(rule_nan, "nan-test", "tests for NaN and infinity may be compiled away; test the bits");
RULE(rule_builtin, "built-in",
     "this built-in has driver-defined precision; use shaders/exact.glsl");
RULE(rule_instruction_set, "instruction-set", "only GLSL.std.450 and debug information are known");
RULE(rule_sampling, "sampling", "texture filtering has driver-defined precision");
RULE(rule_image_buffer, "image-buffer", "only buffers may be read as images");
RULE(rule_derivative, "derivative", "derivatives have driver-defined precision");
RULE(rule_signed_division, "signed-division",
     "drivers differ on negative operands; use unsigned values, shifts or & masks");
RULE(rule_divisor, "divisor",
     "the divisor must be a constant other than 0 (a specialization constant may become 0)");
RULE(rule_shift, "shift-amount",
     "the amount must be a constant below the width, or be masked in place: x << (n & 31u)");
RULE(rule_float_width, "float-width", "floats have 32 bits");
RULE(rule_relaxed, "relaxed-precision", "mediump and lowp let the driver choose the precision");
RULE(rule_float_atomic, "float-atomic",
     "atomics on floats depend on the order of threads; add fixed-point integers");
RULE(rule_float_reduction, "float-reduction",
     "reductions of floats depend on the order of threads");
RULE(rule_spec_float, "float-spec-constant",
     "expressions of float specialization constants are folded as the driver likes");
RULE(rule_undefined, "undefined", "an undefined value may be anything; initialize the variable");
RULE(rule_decoration, "decoration", "this decoration is not known to keep results exact");
RULE(rule_mode, "execution-mode", "this execution mode is not known to keep results exact");
RULE(rule_whitelist, "whitelist", "this instruction is not known to give exact results");

#undef RULE

typedef enum spirv_kind {
    KIND_ALLOWED,
    KIND_INTEGER, /* allowed, also inside OpSpecConstantOp */
    KIND_ARITHMETIC,
    KIND_UNSIGNED_DIVISION,
    KIND_SHIFT,
    KIND_ATOMIC,
    KIND_IMAGE_READ,
    KIND_FLOAT_TYPE,
    KIND_SPEC_OP,
    KIND_EXT_INST,
    KIND_DECORATION,
    KIND_MEMBER_DECORATION,
    KIND_MODE,
    KIND_FUNCTION,
    KIND_FUNCTION_END,
    KIND_REFUSED,
} spirv_kind;

typedef struct spirv_operation {
    uint16_t opcode;
    const char *name, *operands;
    spirv_kind kind;
    const spirv_rule *rule; /* that a refused instruction breaks */
} spirv_operation;

#define ALLOWED(opcode, name, operands)                                                            \
    {                                                                                              \
        opcode, "Op" name, operands, KIND_ALLOWED, NULL                                            \
    }
#define INTEGER(opcode, name, operands)                                                            \
    {                                                                                              \
        opcode, "Op" name, operands, KIND_INTEGER, NULL                                            \
    }
#define SPECIAL(opcode, name, operands, kind)                                                      \
    {                                                                                              \
        opcode, "Op" name, operands, kind, NULL                                                    \
    }
#define REFUSED(opcode, name, rule)                                                                \
    {                                                                                              \
        opcode, "Op" name, "~", KIND_REFUSED, &rule                                                \
    }

/* In ascending order of opcodes. */
static const spirv_operation spirv_operations[] = {
    ALLOWED(0, "Nop", ""),
    REFUSED(1, "Undef", rule_undefined),
    ALLOWED(2, "SourceContinued", "~"),
    ALLOWED(3, "Source", "##~"),
    ALLOWED(4, "SourceExtension", "~"),
    ALLOWED(5, "Name", "i~"),
    ALLOWED(6, "MemberName", "i#~"),
    ALLOWED(7, "String", "r~"),
    ALLOWED(8, "Line", "i##"),
    ALLOWED(10, "Extension", "~"),
    ALLOWED(11, "ExtInstImport", "r#~"),
    SPECIAL(12, "ExtInst", "tri#*", KIND_EXT_INST),
    ALLOWED(14, "MemoryModel", "##"),
    ALLOWED(15, "EntryPoint", "#i#~"),
    SPECIAL(16, "ExecutionMode", "i#~", KIND_MODE),
    ALLOWED(17, "Capability", "#"),
    ALLOWED(19, "TypeVoid", "r"),
    ALLOWED(20, "TypeBool", "r"),
    ALLOWED(21, "TypeInt", "r##"),
    SPECIAL(22, "TypeFloat", "r#~", KIND_FLOAT_TYPE),
    ALLOWED(23, "TypeVector", "ri#"),
    ALLOWED(24, "TypeMatrix", "ri#"),
    ALLOWED(25, "TypeImage", "ri######~"),
    ALLOWED(26, "TypeSampler", "r"),
    ALLOWED(27, "TypeSampledImage", "ri"),
    ALLOWED(28, "TypeArray", "rii"),
    ALLOWED(29, "TypeRuntimeArray", "ri"),
    ALLOWED(30, "TypeStruct", "r*"),
    ALLOWED(32, "TypePointer", "r#i"),
    ALLOWED(33, "TypeFunction", "ri*"),
    ALLOWED(41, "ConstantTrue", "tr"),
    ALLOWED(42, "ConstantFalse", "tr"),
    ALLOWED(43, "Constant", "tr#~"),
    ALLOWED(44, "ConstantComposite", "tr*"),
    ALLOWED(46, "ConstantNull", "tr"),
    ALLOWED(48, "SpecConstantTrue", "tr"),
    ALLOWED(49, "SpecConstantFalse", "tr"),
    ALLOWED(50, "SpecConstant", "tr#~"),
    ALLOWED(51, "SpecConstantComposite", "tr*"),
    SPECIAL(52, "SpecConstantOp", "tr#~", KIND_SPEC_OP),
    SPECIAL(54, "Function", "tr#i", KIND_FUNCTION),
    ALLOWED(55, "FunctionParameter", "tr"),
    SPECIAL(56, "FunctionEnd", "", KIND_FUNCTION_END),
    ALLOWED(57, "FunctionCall", "tri*"),
    ALLOWED(59, "Variable", "tr#*"),
    ALLOWED(61, "Load", "tri~"),
    ALLOWED(62, "Store", "ii~"),
    ALLOWED(63, "CopyMemory", "ii~"),
    ALLOWED(65, "AccessChain", "tri*"),
    ALLOWED(66, "InBoundsAccessChain", "tri*"),
    ALLOWED(68, "ArrayLength", "tri#"),
    SPECIAL(71, "Decorate", "i#~", KIND_DECORATION),
    SPECIAL(72, "MemberDecorate", "i##~", KIND_MEMBER_DECORATION),
    ALLOWED(77, "VectorExtractDynamic", "trii"),
    ALLOWED(78, "VectorInsertDynamic", "triii"),
    INTEGER(79, "VectorShuffle", "trii~"),
    ALLOWED(80, "CompositeConstruct", "tr*"),
    INTEGER(81, "CompositeExtract", "tri~"),
    INTEGER(82, "CompositeInsert", "trii~"),
    ALLOWED(83, "CopyObject", "tri"),
    REFUSED(84, "Transpose", rule_matrix),
    REFUSED(86, "SampledImage", rule_sampling),
    REFUSED(87, "ImageSampleImplicitLod", rule_sampling),
    REFUSED(88, "ImageSampleExplicitLod", rule_sampling),
    REFUSED(89, "ImageSampleDrefImplicitLod", rule_sampling),
    REFUSED(90, "ImageSampleDrefExplicitLod", rule_sampling),
    REFUSED(91, "ImageSampleProjImplicitLod", rule_sampling),
    REFUSED(92, "ImageSampleProjExplicitLod", rule_sampling),
    REFUSED(93, "ImageSampleProjDrefImplicitLod", rule_sampling),
    REFUSED(94, "ImageSampleProjDrefExplicitLod", rule_sampling),
    SPECIAL(95, "ImageFetch", "trii~", KIND_IMAGE_READ),
    REFUSED(96, "ImageGather", rule_sampling),
    REFUSED(97, "ImageDrefGather", rule_sampling),
    SPECIAL(98, "ImageRead", "trii~", KIND_IMAGE_READ),
    ALLOWED(100, "Image", "tri"),
    SPECIAL(104, "ImageQuerySize", "tri", KIND_IMAGE_READ),
    ALLOWED(109, "ConvertFToU", "tri"),
    ALLOWED(110, "ConvertFToS", "tri"),
    ALLOWED(111, "ConvertSToF", "tri"),
    ALLOWED(112, "ConvertUToF", "tri"),
    INTEGER(113, "UConvert", "tri"),
    INTEGER(114, "SConvert", "tri"),
    REFUSED(115, "FConvert", rule_float_width),
    REFUSED(116, "QuantizeToF16", rule_float_width),
    ALLOWED(124, "Bitcast", "tri"),
    INTEGER(126, "SNegate", "tri"),
    SPECIAL(127, "FNegate", "tri", KIND_ARITHMETIC),
    INTEGER(128, "IAdd", "trii"),
    SPECIAL(129, "FAdd", "trii", KIND_ARITHMETIC),
    INTEGER(130, "ISub", "trii"),
    SPECIAL(131, "FSub", "trii", KIND_ARITHMETIC),
    INTEGER(132, "IMul", "trii"),
    SPECIAL(133, "FMul", "trii", KIND_ARITHMETIC),
    SPECIAL(134, "UDiv", "trii", KIND_UNSIGNED_DIVISION),
    REFUSED(135, "SDiv", rule_signed_division),
    REFUSED(136, "FDiv", rule_division),
    SPECIAL(137, "UMod", "trii", KIND_UNSIGNED_DIVISION),
    REFUSED(138, "SRem", rule_signed_division),
    REFUSED(139, "SMod", rule_signed_division),
    REFUSED(140, "FRem", rule_remainder),
    REFUSED(141, "FMod", rule_remainder),
    SPECIAL(142, "VectorTimesScalar", "trii", KIND_ARITHMETIC),
    REFUSED(143, "MatrixTimesScalar", rule_matrix),
    REFUSED(144, "VectorTimesMatrix", rule_matrix),
    REFUSED(145, "MatrixTimesVector", rule_matrix),
    REFUSED(146, "MatrixTimesMatrix", rule_matrix),
    REFUSED(147, "OuterProduct", rule_matrix),
    REFUSED(148, "Dot", rule_dot),
    ALLOWED(149, "IAddCarry", "trii"),
    ALLOWED(150, "ISubBorrow", "trii"),
    ALLOWED(151, "UMulExtended", "trii"),
    ALLOWED(152, "SMulExtended", "trii"),
    ALLOWED(154, "Any", "tri"),
    ALLOWED(155, "All", "tri"),
    REFUSED(156, "IsNan", rule_nan),
    REFUSED(157, "IsInf", rule_nan),
    REFUSED(158, "IsFinite", rule_nan),
    REFUSED(159, "IsNormal", rule_nan),
    REFUSED(160, "SignBitSet", rule_nan),
    REFUSED(161, "LessOrGreater", rule_nan),
    REFUSED(162, "Ordered", rule_nan),
    REFUSED(163, "Unordered", rule_nan),
    INTEGER(164, "LogicalEqual", "trii"),
    INTEGER(165, "LogicalNotEqual", "trii"),
    INTEGER(166, "LogicalOr", "trii"),
    INTEGER(167, "LogicalAnd", "trii"),
    INTEGER(168, "LogicalNot", "tri"),
    INTEGER(169, "Select", "triii"),
    INTEGER(170, "IEqual", "trii"),
    INTEGER(171, "INotEqual", "trii"),
    INTEGER(172, "UGreaterThan", "trii"),
    INTEGER(173, "SGreaterThan", "trii"),
    INTEGER(174, "UGreaterThanEqual", "trii"),
    INTEGER(175, "SGreaterThanEqual", "trii"),
    INTEGER(176, "ULessThan", "trii"),
    INTEGER(177, "SLessThan", "trii"),
    INTEGER(178, "ULessThanEqual", "trii"),
    INTEGER(179, "SLessThanEqual", "trii"),
    ALLOWED(180, "FOrdEqual", "trii"),
    ALLOWED(181, "FUnordEqual", "trii"),
    ALLOWED(182, "FOrdNotEqual", "trii"),
    ALLOWED(183, "FUnordNotEqual", "trii"),
    ALLOWED(184, "FOrdLessThan", "trii"),
    ALLOWED(185, "FUnordLessThan", "trii"),
    ALLOWED(186, "FOrdGreaterThan", "trii"),
    ALLOWED(187, "FUnordGreaterThan", "trii"),
    ALLOWED(188, "FOrdLessThanEqual", "trii"),
    ALLOWED(189, "FUnordLessThanEqual", "trii"),
    ALLOWED(190, "FOrdGreaterThanEqual", "trii"),
    ALLOWED(191, "FUnordGreaterThanEqual", "trii"),
    SPECIAL(194, "ShiftRightLogical", "trii", KIND_SHIFT),
    SPECIAL(195, "ShiftRightArithmetic", "trii", KIND_SHIFT),
    SPECIAL(196, "ShiftLeftLogical", "trii", KIND_SHIFT),
    INTEGER(197, "BitwiseOr", "trii"),
    INTEGER(198, "BitwiseXor", "trii"),
    INTEGER(199, "BitwiseAnd", "trii"),
    INTEGER(200, "Not", "tri"),
    ALLOWED(201, "BitFieldInsert", "triiii"),
    ALLOWED(202, "BitFieldSExtract", "triii"),
    ALLOWED(203, "BitFieldUExtract", "triii"),
    ALLOWED(204, "BitReverse", "tri"),
    ALLOWED(205, "BitCount", "tri"),
    REFUSED(207, "DPdx", rule_derivative),
    REFUSED(208, "DPdy", rule_derivative),
    REFUSED(209, "Fwidth", rule_derivative),
    REFUSED(210, "DPdxFine", rule_derivative),
    REFUSED(211, "DPdyFine", rule_derivative),
    REFUSED(212, "FwidthFine", rule_derivative),
    REFUSED(213, "DPdxCoarse", rule_derivative),
    REFUSED(214, "DPdyCoarse", rule_derivative),
    REFUSED(215, "FwidthCoarse", rule_derivative),
    ALLOWED(224, "ControlBarrier", "iii"),
    ALLOWED(225, "MemoryBarrier", "ii"),
    SPECIAL(227, "AtomicLoad", "triii", KIND_ATOMIC),
    ALLOWED(228, "AtomicStore", "iiii"),
    SPECIAL(229, "AtomicExchange", "triiii", KIND_ATOMIC),
    SPECIAL(230, "AtomicCompareExchange", "triiiiii", KIND_ATOMIC),
    SPECIAL(232, "AtomicIIncrement", "triii", KIND_ATOMIC),
    SPECIAL(233, "AtomicIDecrement", "triii", KIND_ATOMIC),
    SPECIAL(234, "AtomicIAdd", "triiii", KIND_ATOMIC),
    SPECIAL(235, "AtomicISub", "triiii", KIND_ATOMIC),
    SPECIAL(236, "AtomicSMin", "triiii", KIND_ATOMIC),
    SPECIAL(237, "AtomicUMin", "triiii", KIND_ATOMIC),
    SPECIAL(238, "AtomicSMax", "triiii", KIND_ATOMIC),
    SPECIAL(239, "AtomicUMax", "triiii", KIND_ATOMIC),
    SPECIAL(240, "AtomicAnd", "triiii", KIND_ATOMIC),
    SPECIAL(241, "AtomicOr", "triiii", KIND_ATOMIC),
    SPECIAL(242, "AtomicXor", "triiii", KIND_ATOMIC),
    ALLOWED(245, "Phi", "tr*"),
    ALLOWED(246, "LoopMerge", "ii#~"),
    ALLOWED(247, "SelectionMerge", "i#"),
    ALLOWED(248, "Label", "r"),
    ALLOWED(249, "Branch", "i"),
    ALLOWED(250, "BranchConditional", "iii~"),
    ALLOWED(251, "Switch", "ii~"),
    ALLOWED(253, "Return", ""),
    ALLOWED(254, "ReturnValue", "i"),
    ALLOWED(255, "Unreachable", ""),
    ALLOWED(317, "NoLine", ""),
    ALLOWED(330, "ModuleProcessed", "~"),
    ALLOWED(333, "GroupNonUniformElect", "tri"),
    ALLOWED(334, "GroupNonUniformAll", "trii"),
    ALLOWED(335, "GroupNonUniformAny", "trii"),
    ALLOWED(336, "GroupNonUniformAllEqual", "trii"),
    ALLOWED(337, "GroupNonUniformBroadcast", "triii"),
    ALLOWED(338, "GroupNonUniformBroadcastFirst", "trii"),
    ALLOWED(339, "GroupNonUniformBallot", "trii"),
    ALLOWED(340, "GroupNonUniformInverseBallot", "trii"),
    ALLOWED(341, "GroupNonUniformBallotBitExtract", "triii"),
    ALLOWED(342, "GroupNonUniformBallotBitCount", "tri#i"),
    ALLOWED(343, "GroupNonUniformBallotFindLSB", "trii"),
    ALLOWED(344, "GroupNonUniformBallotFindMSB", "trii"),
    ALLOWED(345, "GroupNonUniformShuffle", "triii"),
    ALLOWED(346, "GroupNonUniformShuffleXor", "triii"),
    ALLOWED(347, "GroupNonUniformShuffleUp", "triii"),
    ALLOWED(348, "GroupNonUniformShuffleDown", "triii"),
    ALLOWED(349, "GroupNonUniformIAdd", "tri#i~"),
    REFUSED(350, "GroupNonUniformFAdd", rule_float_reduction),
    ALLOWED(351, "GroupNonUniformIMul", "tri#i~"),
    REFUSED(352, "GroupNonUniformFMul", rule_float_reduction),
    ALLOWED(353, "GroupNonUniformSMin", "tri#i~"),
    ALLOWED(354, "GroupNonUniformUMin", "tri#i~"),
    REFUSED(355, "GroupNonUniformFMin", rule_float_reduction),
    ALLOWED(356, "GroupNonUniformSMax", "tri#i~"),
    ALLOWED(357, "GroupNonUniformUMax", "tri#i~"),
    REFUSED(358, "GroupNonUniformFMax", rule_float_reduction),
    ALLOWED(359, "GroupNonUniformBitwiseAnd", "tri#i~"),
    ALLOWED(360, "GroupNonUniformBitwiseOr", "tri#i~"),
    ALLOWED(361, "GroupNonUniformBitwiseXor", "tri#i~"),
    ALLOWED(362, "GroupNonUniformLogicalAnd", "tri#i~"),
    ALLOWED(363, "GroupNonUniformLogicalOr", "tri#i~"),
    ALLOWED(364, "GroupNonUniformLogicalXor", "tri#i~"),
    ALLOWED(400, "CopyLogical", "tri"),
    REFUSED(5614, "AtomicFMinEXT", rule_float_atomic),
    REFUSED(5615, "AtomicFMaxEXT", rule_float_atomic),
    REFUSED(6035, "AtomicFAddEXT", rule_float_atomic),
};

#undef ALLOWED
#undef INTEGER
#undef SPECIAL
#undef REFUSED

typedef struct spirv_extended {
    const char *name;
    bool allowed;
} spirv_extended;

/* GLSL.std.450 by instruction number. Round, RoundEven and FSign stay out: the first may round
 * halves either way, and none of them is needed. */
static const spirv_extended spirv_glsl[] = {
    [1] = {"Round", false},
    [2] = {"RoundEven", false},
    [3] = {"Trunc", true},
    [4] = {"FAbs", true},
    [5] = {"SAbs", true},
    [6] = {"FSign", false},
    [7] = {"SSign", false},
    [8] = {"Floor", true},
    [9] = {"Ceil", true},
    [10] = {"Fract", false},
    [11] = {"Radians", false},
    [12] = {"Degrees", false},
    [13] = {"Sin", false},
    [14] = {"Cos", false},
    [15] = {"Tan", false},
    [16] = {"Asin", false},
    [17] = {"Acos", false},
    [18] = {"Atan", false},
    [19] = {"Sinh", false},
    [20] = {"Cosh", false},
    [21] = {"Tanh", false},
    [22] = {"Asinh", false},
    [23] = {"Acosh", false},
    [24] = {"Atanh", false},
    [25] = {"Atan2", false},
    [26] = {"Pow", false},
    [27] = {"Exp", false},
    [28] = {"Log", false},
    [29] = {"Exp2", false},
    [30] = {"Log2", false},
    [31] = {"Sqrt", false},
    [32] = {"InverseSqrt", false},
    [33] = {"Determinant", false},
    [34] = {"MatrixInverse", false},
    [35] = {"Modf", false},
    [36] = {"ModfStruct", false},
    [37] = {"FMin", true},
    [38] = {"UMin", true},
    [39] = {"SMin", true},
    [40] = {"FMax", true},
    [41] = {"UMax", true},
    [42] = {"SMax", true},
    [43] = {"FClamp", true},
    [44] = {"UClamp", true},
    [45] = {"SClamp", true},
    [46] = {"FMix", false},
    [48] = {"Step", false},
    [49] = {"SmoothStep", false},
    [50] = {"Fma", false},
    [51] = {"Frexp", false},
    [52] = {"FrexpStruct", false},
    [53] = {"Ldexp", false},
    [54] = {"PackSnorm4x8", false},
    [55] = {"PackUnorm4x8", false},
    [56] = {"PackSnorm2x16", false},
    [57] = {"PackUnorm2x16", false},
    [58] = {"PackHalf2x16", false},
    [59] = {"PackDouble2x32", false},
    [60] = {"UnpackSnorm2x16", false},
    [61] = {"UnpackUnorm2x16", false},
    [62] = {"UnpackHalf2x16", false},
    [63] = {"UnpackSnorm4x8", false},
    [64] = {"UnpackUnorm4x8", false},
    [65] = {"UnpackDouble2x32", false},
    [66] = {"Length", false},
    [67] = {"Distance", false},
    [68] = {"Cross", false},
    [69] = {"Normalize", false},
    [70] = {"FaceForward", false},
    [71] = {"Reflect", false},
    [72] = {"Refract", false},
    [73] = {"FindILsb", true},
    [74] = {"FindSMsb", true},
    [75] = {"FindUMsb", true},
    [76] = {"InterpolateAtCentroid", false},
    [77] = {"InterpolateAtSample", false},
    [78] = {"InterpolateAtOffset", false},
    [79] = {"NMin", false},
    [80] = {"NMax", false},
    [81] = {"NClamp", false},
};

#endif
