#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
// Gives each shadow ray of a segment its place in the order of the cells.
#include "gpu_layout.h"
#include "bindings.glsl"
#include "cell.glsl"
#include "shadow_queue.glsl"

layout(local_size_x = LR_GROUP_SIZE) in;

void main()
{
    load_uniforms();
    uint i = queue_index(), segment = work.light;
    if (i < work.count) {
        vec3 origin = load_shadow_ray(segment * work.shadow_room + i).origin;
        uint place = atomicAdd(cells[segment * LR_CELLS + cell_of(origin)], 1u);
        shadow_order[segment * work.shadow_room + min(place, work.shadow_room - 1u)] = i;
    }
}
