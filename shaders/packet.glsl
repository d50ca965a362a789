// Rays that go through a tree together: RAYS of each invocation and, if that is more than one, those of
// all invocations of its batch. The kernel defines RAYS before it includes this: 1 where every
// invocation goes its own way, more where a subgroup is one batch, so that a packet's control flow is
// uniform and what it loads is shared.
#ifndef PACKET_GLSL
#define PACKET_GLSL

#include "batch.glsl"
#include "intersect.glsl"
#include "mesh.glsl"
#include "scene_data.glsl"

const bool joint = RAYS > 1;

// Runs what follows for each ray k of the invocation, without a loop at run time.
#define EACH_RAY [[unroll]] for (uint k = 0u; k < uint(RAYS); k++)

vec3 ray_o[RAYS], ray_d[RAYS];
float ray_inv_a[RAYS]; // 1 / (d . d)
// The distance within which a ray still looks for hits; -1: it is done.
float ray_limit[RAYS];

// Ray k of the invocation in the work of a dispatch: neighbouring invocations have neighbouring rays.
uint packet_index(uint k)
{
    uint invocation = queue_index(), lane = joint ? batch_lane() : 0u;
    return (invocation - lane) * uint(RAYS) + k * (joint ? uint(LR_BATCH) : 1u) + lane;
}

int joint_min(int x)
{
    if (joint) {
        x = min(x, int(neighbour(uint(x), 1u)));
        x = min(x, int(neighbour(uint(x), 2u)));
        x = min(x, int(neighbour(uint(x), 4u)));
    }
    return x;
}

// Rows that all rays of a packet want: each invocation loads one of them. `rows` <= LR_BATCH.
uvec4 hold_rows(uint at, uint rows)
{
    uvec4 held = uvec4(0u);
    if (joint)
        held = scene_row(at + min(batch_lane(), rows - 1u));
    return held;
}

// Row at + i of those.
uvec4 held_row(uvec4 held, uint at, uint i)
{
    uvec4 row;
    if (joint) {
        uint lane = batch_begin() + i;
        row = uvec4(share(held.x, lane), share(held.y, lane), share(held.z, lane),
                    share(held.w, lane));
    } else {
        row = scene_row(at + i);
    }
    return row;
}

gpu_sphere joint_sphere(uint i)
{
    uint at = frame.spheres.base + 2u * i;
    uvec4 held = hold_rows(at, 2u);
    return sphere_of(held_row(held, at, 0u), held_row(held, at, 1u));
}

gpu_flat joint_flat(uint i)
{
    uint at = frame.flats.base + 4u * i;
    uvec4 held = hold_rows(at, 4u);
    return flat_of(held_row(held, at, 0u), held_row(held, at, 1u), held_row(held, at, 2u),
                   held_row(held, at, 3u));
}

gpu_solid joint_solid(uint i)
{
    uint at = frame.solids.base + 5u * i;
    uvec4 held = hold_rows(at, 5u);
    return solid_of(held_row(held, at, 0u), held_row(held, at, 1u), held_row(held, at, 2u),
                    held_row(held, at, 3u), held_row(held, at, 4u));
}

gpu_triangle joint_triangle(uint i)
{
    uint at = frame.triangles.base + 3u * i;
    uvec4 held = hold_rows(at, 3u);
    return triangle_of(held_row(held, at, 0u), held_row(held, at, 1u), held_row(held, at, 2u));
}

gpu_node joint_node(uint at)
{
    uvec4 held = hold_rows(at, 4u);
    uvec4 a = held_row(held, at, 0u), b = held_row(held, at, 1u);
    uvec4 c = held_row(held, at, 2u), d = held_row(held, at, 3u);
    return gpu_node(uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), b.w, uintBitsToFloat(c.xyz),
                    c.w, uintBitsToFloat(d.xyz), d.w);
}

#endif
