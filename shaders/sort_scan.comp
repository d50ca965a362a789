#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
// From how many shadow rays end in each cell to where each cell's begin in their order. One workgroup a
// segment; every invocation takes a run of cells.
#include "gpu_layout.h"
#include "bindings.glsl"

layout(local_size_x = LR_GROUP_SIZE) in;

shared uint totals[LR_GROUP_SIZE];

void main()
{
    load_uniforms();
    const uint run = LR_CELLS / uint(LR_GROUP_SIZE);
    uint lane = gl_LocalInvocationIndex;
    uint first = gl_WorkGroupID.x * LR_CELLS + lane * run;
    uint total = 0u;
    for (uint i = 0u; i < run; i++)
        total += cells[first + i];
    totals[lane] = total;
    barrier();
    uint begin = 0u;
    for (uint i = 0u; i < uint(LR_GROUP_SIZE); i++)
        begin += i < lane ? totals[i] : 0u;
    for (uint i = 0u; i < run; i++) {
        uint count = cells[first + i];
        cells[first + i] = begin;
        begin += count;
    }
}
