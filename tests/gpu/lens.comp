#version 450
#extension GL_GOOGLE_include_directive : require
// Runs one function of lens.glsl on many inputs.
#include "gpu_layout.h"
#include "lens.glsl"

layout(local_size_x = LR_GROUP_SIZE) in;

layout(push_constant) uniform WhichBlock { uint which; };
layout(std430, set = 0, binding = 0) readonly buffer InBlock { vec4 given[]; };
layout(std430, set = 0, binding = 1) writeonly buffer OutBlock { vec2 found[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    vec4 a = given[i];
    vec2 result = vec2(0.0);
    if (which == 0u)
        result = disk_point(a.xy);
    else if (which == 1u)
        result = polygon_point(a.xy, a.z, 0.2, a.w);
    else if (which == 2u)
        result = vec2(tent_offset(a.x), tent_offset(a.y));
    else
        result = vec2(blackman_harris_offset(a.x), blackman_harris_offset(a.y));
    found[i] = result;
}
