#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
// Rays from inside a closed mesh to its vertices and edges, against the triangles around those: how
// many meet none of them, with the test as it is, and with its products fused as by fma.
#include "gpu_layout.h"
#include "triangle.glsl"

layout(local_size_x = LR_GROUP_SIZE) in;

#define RING 32 /* triangles at most around an edge and its ends */
#define ROUNDS 64

struct edge {
    vec4 from;  // .w: triangles around it
    vec4 to;    // .w: how far from `center` rays start, at most
    vec4 center; // .w: how far from 0 the corners are, at most
    vec4 corners[3 * RING];
};

layout(std430, set = 0, binding = 0) readonly buffer InBlock { edge edges[]; };
layout(std430, set = 0, binding = 1) writeonly buffer OutBlock { uvec4 found[]; }; // of an invocation's

// The product's rounding error (Dekker, 1971).
float product_error(float x, float y)
{
    float cx = 4097.0 * x, cy = 4097.0 * y;
    float hx = cx - (cx - x), hy = cy - (cy - y), lx = x - hx, ly = y - hy;
    return ((hx * hy - x * y) + hx * ly + lx * hy) + lx * ly;
}

// fma(p.x, q.y, -(p.y * q.x)), but for a second rounding.
float fused_side(vec3 p, vec3 q)
{
    return (p.x * q.y - p.y * q.x) + product_error(p.x, q.y);
}

bool fused_hit(vec3 o, sheared_ray ray, gpu_triangle f)
{
    vec3 a = shear_point(ray, f.a - o), b = shear_point(ray, f.b - o), c = shear_point(ray, f.c - o);
    vec3 side = vec3(fused_side(c, b), fused_side(a, c), fused_side(b, a));
    bool under = side.x < 0.0 || side.y < 0.0 || side.z < 0.0;
    bool over = side.x > 0.0 || side.y > 0.0 || side.z > 0.0;
    return under != over;
}

float unit(inout uint state)
{
    state = state * 747796405u + 2891336453u;
    uint word = ((state >> (((state >> 28) + 4u) & 31u)) ^ state) * 277803737u;
    return float(((word >> 22) ^ word) >> 8) * 5.9604644775390625e-8;
}

void main()
{
    uint which = gl_WorkGroupID.x, state = gl_GlobalInvocationID.x * 9781u + 5u;
    vec3 from = edges[which].from.xyz, to = edges[which].to.xyz, center = edges[which].center.xyz;
    float reach = edges[which].to.w;
    float extent = edges[which].center.w;
    uint count = uint(edges[which].from.w), lost = 0u, lost_fused = 0u;
    for (uint round = 0u;;) {
        vec3 jump = vec3(unit(state), unit(state), unit(state)) * 2.0 - 1.0;
        float along = unit(state);
        along = (round & 3u) == 0u ? 0.0 : along;
        vec3 o = center + jump * reach;
        vec3 d = from + (to - from) * along - o;
        if ((round & 1u) != 0u)
            d = ex_normalize(d);
        sheared_ray ray = shear_ray(d);
        vec3 inverse = vec3(ex_rcp(away_from_zero(d.x)), ex_rcp(away_from_zero(d.y)),
                            ex_rcp(away_from_zero(d.z)));
        vec3 slack = 0.5 * LR_BOX_SLACK * extent * abs(inverse); // as the kernels have it
        bool met = false, met_fused = false;
        for (uint i = 0u;;) {
            gpu_triangle f = gpu_triangle(edges[which].corners[3u * i].xyz, 0u,
                                          edges[which].corners[3u * i + 1u].xyz, 0u,
                                          edges[which].corners[3u * i + 2u].xyz, 0u);
            met = met || t_in_box(intersect_triangle(o, ray, f).t, o, inverse, slack, f) > 0.0;
            met_fused = met_fused || fused_hit(o, ray, f);
            i++;
            if (i >= count)
                break;
        }
        lost += met ? 0u : 1u;
        lost_fused += met_fused ? 0u : 1u;
        round++;
        if (round >= uint(ROUNDS))
            break;
    }
    found[gl_GlobalInvocationID.x] = uvec4(lost, lost_fused, ROUNDS, 0u);
}
