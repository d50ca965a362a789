#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
// One ray against one primitive and its bounding ball: bit 0, the exact test hits ahead of the
// origin; bit 1, the ball makes the primitive a candidate.
#include "gpu_layout.h"
#include "candidates.glsl"
#include "intersect.glsl"

layout(local_size_x = LR_GROUP_SIZE) in;

struct ray_and_primitive {
    uvec4 origin; // .w: which list it is of, from 0 for spheres
    uvec4 direction;
    uvec4 ball;
    uvec4 rows[5]; // the primitive's record
};

layout(std430, set = 0, binding = 0) readonly buffer InBlock { ray_and_primitive given[]; };
layout(std430, set = 0, binding = 1) writeonly buffer OutBlock { uint found[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x, kind = given[i].origin.w;
    vec3 o = uintBitsToFloat(given[i].origin.xyz), d = uintBitsToFloat(given[i].direction.xyz);
    vec4 a = uintBitsToFloat(given[i].rows[0]), b = uintBitsToFloat(given[i].rows[1]);
    vec4 c = uintBitsToFloat(given[i].rows[2]);
    uvec4 e = given[i].rows[3], f = given[i].rows[4];
    vec2 crossing = miss;
    if (kind == 0u)
        crossing = intersect_sphere(o, d, ex_rcp(ex_dot(d, d)),
                                    gpu_sphere(a.xyz, a.w, b.x, 0u, 0u, 0u));
    if (kind == 1u)
        crossing = intersect_flat(o, d, gpu_flat(a.xyz, a.w, b.xyz, b.w, c.xyz, c.w, e.x, e.y, 0u, 0u));
    if (kind >= 2u) {
        gpu_solid s = gpu_solid(a, b, c, uintBitsToFloat(e.x), uintBitsToFloat(e.y), e.z, e.w,
                                uintBitsToFloat(f.x), uintBitsToFloat(f.y), 0u, 0u);
        vec3 so = solid_point(s, o), sd = solid_direction(s, d);
        if (kind == 2u)
            crossing = intersect_ellipsoid(so, sd);
        if (kind == 3u)
            crossing = intersect_box(so, sd);
        if (kind == 4u)
            crossing = intersect_cone(so, sd, s);
    }
    bool hit = crossing.x > 0.0 || crossing.y > 0.0;
    found[i] = (hit ? 1u : 0u) | (may_hit(uintBitsToFloat(given[i].ball), o, d) ? 2u : 0u);
}
