#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
// Samples light sources: three rows of rays_in hold a position and a choice; two random numbers, how
// far it is to what is met there and the object; its normal. Then asks how likely that was. And what is
// seen of the background in the direction of that normal, and how likely that is.
#include "gpu_layout.h"
#include "emitter.glsl"

layout(local_size_x = LR_GROUP_SIZE) in;

uint at = 0u;

void put(float x)
{
    film[at] = floatBitsToUint(x);
    at++;
}

void main()
{
    load_uniforms();
    uint i = gl_GlobalInvocationID.x;
    vec4 a = uintBitsToFloat(rays_in[3u * i]);
    uvec4 b = rays_in[3u * i + 1u];
    vec3 normal = uintBitsToFloat(rays_in[3u * i + 2u]).xyz;
    light_sample s = sample_light_at(a.xyz, a.w, uintBitsToFloat(b.xy));
    at = 13u * i;
    put(s.wi.x);
    put(s.wi.y);
    put(s.wi.z);
    put(s.t_max);
    put(s.value.x);
    put(s.value.y);
    put(s.value.z);
    put(s.pdf);
    put(emitter_pdf(b.w, a.xyz, s.wi, uintBitsToFloat(b.z), normal));
    vec3 seen = environment(normal);
    put(seen.x);
    put(seen.y);
    put(seen.z);
    put(environment_pdf(normal));
}
