#version 450
#extension GL_GOOGLE_include_directive : require
// Runs one function of exact.glsl on many inputs.
#include "gpu_layout.h"
#include "exact.glsl"

layout(local_size_x = LR_GROUP_SIZE) in;

layout(push_constant) uniform WhichBlock { uint which; };
layout(std430, set = 0, binding = 0) readonly buffer InBlock { vec4 given[]; };
layout(std430, set = 0, binding = 1) writeonly buffer OutBlock { vec4 found[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    vec4 a = given[2u * i], b = given[2u * i + 1u];
    vec4 result = vec4(0.0);
    if (which == 0u)
        result.x = ex_rcp(a.x);
    else if (which == 1u)
        result.x = ex_div(a.x, b.x);
    else if (which == 2u)
        result.x = ex_rsqrt(a.x);
    else if (which == 3u)
        result.x = ex_sqrt(a.x);
    else if (which == 4u)
        result.x = ex_log2(a.x);
    else if (which == 5u)
        result.x = ex_exp2(a.x);
    else if (which == 6u)
        result.x = ex_pow(a.x, b.x);
    else if (which == 7u)
        result = vec4(ex_normalize(a.xyz), ex_length(a.xyz));
    else if (which == 8u)
        result = vec4(ex_cross(a.xyz, b.xyz), ex_dot(a.xyz, b.xyz));
    else if (which == 9u)
        result.xyz = ex_mix(a.xyz, b.xyz, b.w);
    else if (which == 10u)
        result.xy = ex_cos_sin_turns(a.x);
    else if (which == 11u)
        result.x = ex_angle_turns(a.y, a.x);
    else
        result.x = ex_is_finite(a.xxx) ? 1.0 : 0.0;
    found[i] = result;
}
