// Records that all invocations of a batch want, loaded together where `joint`, which is to be there
// already: each invocation loads a row, and they share them by shuffles.
#ifndef JOINT_GLSL
#define JOINT_GLSL

#include "batch.glsl"
#include "mesh.glsl"
#include "scene_data.glsl"

// Rows that all invocations want: each loads one of them. `rows` <= LR_BATCH.
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

gpu_plane joint_plane(uint i)
{
    uint at = frame.planes.base + 2u * i;
    uvec4 held = hold_rows(at, 2u);
    return plane_of(held_row(held, at, 0u), held_row(held, at, 1u));
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
