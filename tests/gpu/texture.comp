#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
// Looks up textures: a row of rays_in holds u, v, the texture's row and a material.
#include "gpu_layout.h"
#include "texture.glsl"

layout(local_size_x = LR_GROUP_SIZE) in;

void main()
{
    load_uniforms();
    uint i = gl_GlobalInvocationID.x;
    uvec4 given = rays_in[i];
    vec2 uv = uintBitsToFloat(given.xy);
    uvec4 found = floatBitsToUint(texture_at(given.z, uv));
    film[5u * i] = found.x;
    film[5u * i + 1u] = found.y;
    film[5u * i + 2u] = found.z;
    film[5u * i + 3u] = found.w;
    film[5u * i + 4u] = uint(cut_out(given.w, uv));
}
