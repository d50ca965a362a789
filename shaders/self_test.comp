#version 450
#extension GL_GOOGLE_include_directive : require
// Checks on the device what the exact promise rests on: + - * rounded to nearest, not contracted,
// and conversions. src/gpu/self_test.c computes the same and compares.
#include "gpu_layout.h"

layout(local_size_x = LR_GROUP_SIZE) in;

layout(std430, set = 0, binding = 0) readonly buffer InBlock { gpu_self_test_in given[]; };
layout(std430, set = 0, binding = 1) writeonly buffer OutBlock { gpu_self_test_out found[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    float a = given[i].a, b = given[i].b, c = given[i].c;
    uint n = given[i].n;
    float product_sum = a * b + c;
    float sum_product = c - a * b;
    vec3 scaled = vec3(a, b, c) * c + vec3(b, c, a);
    found[i] = gpu_self_test_out(floatBitsToUint(a + b), floatBitsToUint(a - b),
                                 floatBitsToUint(a * b), floatBitsToUint(product_sum),
                                 floatBitsToUint(sum_product), floatBitsToUint(scaled.y),
                                 floatBitsToUint(float(n & 0x00FFFFFFu)),
                                 uint(int(floor(clamp(a * 1024.0, -1.0e9, 1.0e9)))));
}
