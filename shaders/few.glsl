// The nearest hit, and what stands in the way of light, in scenes of few primitives: every ray tests all
// of them, and their records are loaded once for a batch. All invocations must call these together.
#ifndef FEW_GLSL
#define FEW_GLSL

#include "batch.glsl"

const bool joint = has_shuffle;

#include "hole.glsl"
#include "joint.glsl"
#include "obstacle.glsl"
#include "trace.glsl"

// The records of two primitives of a list, whose four first rows are enough: a batch loads both at once.
struct two_records {
    uvec4 held; // by invocation
    uint first, second; // rows
};

two_records hold_two(gpu_list list, uint i, uint rows)
{
    uint first = list.base + rows * i, second = list.base + rows * min(i + 1u, list.end - 1u);
    uint lane = batch_lane();
    uvec4 held = uvec4(0u);
    if (joint)
        held = scene_row((lane < 4u ? first : second) + (lane & 3u));
    return two_records(held, first, second);
}

uvec4 row_of_two(two_records two, uint which, uint i)
{
    uvec4 row;
    if (joint) {
        uint lane = batch_begin() + 4u * which + i;
        row = uvec4(share(two.held.x, lane), share(two.held.y, lane), share(two.held.z, lane),
                    share(two.held.w, lane));
    } else {
        row = scene_row((which == 0u ? two.first : two.second) + i);
    }
    return row;
}

gpu_flat flat_of_two(two_records two, uint which)
{
    return flat_of(row_of_two(two, which, 0u), row_of_two(two, which, 1u), row_of_two(two, which, 2u),
                   row_of_two(two, which, 3u));
}

// Not of cones, which need a fifth row.
gpu_solid solid_of_two(two_records two, uint which)
{
    return solid_of(row_of_two(two, which, 0u), row_of_two(two, which, 1u), row_of_two(two, which, 2u),
                    row_of_two(two, which, 3u), uvec4(0u));
}

// Runs `test` on each primitive i of a list, or on i and the one behind it, if any: so the last may be
// tested twice. Loops end at their bottom, as in trace.glsl.
#define FOR_ALL(has, list, step, test)                                                             \
    if (has)                                                                                       \
        for (uint i = list.begin;;) {                                                              \
            test;                                                                                  \
            i += step;                                                                             \
            if (i >= hidden(list.end))                                                             \
                break;                                                                             \
        }

void nearer_plane(inout nearest_hit best, uint i, vec3 o, vec3 d)
{
    gpu_plane p = joint_plane(i);
    keep_nearer(best, intersect_plane(o, d, p.normal, p.offset), i, p.object);
}

void nearer_sphere(inout nearest_hit best, uint i, vec3 o, vec3 d, float inv_a)
{
    gpu_sphere s = joint_sphere(i);
    keep_nearer(best, intersect_sphere(o, d, inv_a, s), i, s.object);
}

void nearer_flats(inout nearest_hit best, uint i, vec3 o, vec3 d)
{
    two_records two = hold_two(frame.flats, i, 4u);
    gpu_flat a = flat_of_two(two, 0u), b = flat_of_two(two, 1u);
    keep_nearer(best, intersect_flat(o, d, a), i, a.object);
    keep_nearer(best, intersect_flat(o, d, b), i + 1u, b.object);
}

void nearer_cone(inout nearest_hit best, uint i, vec3 o, vec3 d)
{
    gpu_solid s = joint_solid(i);
    keep_nearer(best, intersect_solid(o, d, s, i), i, s.object);
}

void nearer_solids(inout nearest_hit best, uint i, vec3 o, vec3 d)
{
    two_records two = hold_two(frame.solids, i, 5u);
    gpu_solid a = solid_of_two(two, 0u), b = solid_of_two(two, 1u);
    keep_nearer(best, intersect_solid(o, d, a, i), i, a.object);
    keep_nearer(best, intersect_solid(o, d, b, i + 1u), i + 1u, b.object);
}

nearest_hit nearest_of_few(vec3 o, vec3 d)
{
    nearest_hit best = nearest_hit(LR_T_MAX, LR_PRIMITIVE_NONE, 0xFFFFFFFFu);
    float inv_a = ex_rcp(ex_dot(d, d));
    FOR_ALL(has_planes, frame.planes, 1u, nearer_plane(best, i, o, d))
    FOR_ALL(has_spheres, frame.spheres, 1u, nearer_sphere(best, i, o, d, inv_a))
    FOR_ALL(has_flats, frame.flats, 2u, nearer_flats(best, i, o, d))
    FOR_ALL(has_solids && has_cones, frame.solids, 1u, nearer_cone(best, i, o, d))
    FOR_ALL(has_solids && !has_cones, frame.solids, 2u, nearer_solids(best, i, o, d))
    return best;
}

bool plane_blocks(uint i, vec3 o, vec3 d, float t_max)
{
    gpu_plane p = joint_plane(i);
    vec2 crossing = intersect_plane(o, d, p.normal, p.offset);
    if (has_cutouts)
        crossing = projected_crossings(crossing, p.object, o, d);
    return crosses(crossing, t_max) && (p.flags & LR_FLAG_SHADOW) != 0u;
}

bool sphere_blocks(uint i, vec3 o, vec3 d, float inv_a, float t_max)
{
    gpu_sphere s = joint_sphere(i);
    vec2 crossing = intersect_sphere(o, d, inv_a, s);
    if (has_cutouts)
        crossing = projected_crossings(crossing, s.object, o, d);
    return crosses(crossing, t_max) && (s.flags & LR_FLAG_SHADOW) != 0u;
}

bool flat_blocks(gpu_flat f, vec3 o, vec3 d, float t_max)
{
    vec2 crossing = intersect_flat(o, d, f);
    if (has_cutouts)
        crossing = flat_crossing(crossing, f, o, d);
    return crosses(crossing, t_max) && (f.flags & LR_FLAG_SHADOW) != 0u;
}

bool flats_block(uint i, vec3 o, vec3 d, float t_max)
{
    two_records two = hold_two(frame.flats, i, 4u);
    bool a = flat_blocks(flat_of_two(two, 0u), o, d, t_max);
    bool b = flat_blocks(flat_of_two(two, 1u), o, d, t_max);
    return a || b;
}

bool solid_blocks(gpu_solid s, uint i, vec3 o, vec3 d, float t_max)
{
    vec2 crossing = intersect_solid(o, d, s, i);
    if (has_cutouts)
        crossing = solid_crossings(crossing, s, has_boxes && is_in(frame.boxes, i), o, d);
    return crosses(crossing, t_max) && (s.flags & LR_FLAG_SHADOW) != 0u;
}

bool solids_block(uint i, vec3 o, vec3 d, float t_max)
{
    two_records two = hold_two(frame.solids, i, 5u);
    bool a = solid_blocks(solid_of_two(two, 0u), i, o, d, t_max);
    bool b = solid_blocks(solid_of_two(two, 1u), i + 1u, o, d, t_max);
    return a || b;
}

// Whether something is in the way that casts shadows, up to t_max.
bool few_block(vec3 o, vec3 d, float t_max)
{
    bool blocked = false;
    float inv_a = ex_rcp(ex_dot(d, d));
    FOR_ALL(has_planes, frame.planes, 1u, blocked = plane_blocks(i, o, d, t_max) || blocked)
    FOR_ALL(has_spheres, frame.spheres, 1u, blocked = sphere_blocks(i, o, d, inv_a, t_max) || blocked)
    FOR_ALL(has_flats, frame.flats, 2u, blocked = flats_block(i, o, d, t_max) || blocked)
    FOR_ALL(has_solids && has_cones, frame.solids, 1u,
            blocked = solid_blocks(joint_solid(i), i, o, d, t_max) || blocked)
    FOR_ALL(has_solids && !has_cones, frame.solids, 2u,
            blocked = solids_block(i, o, d, t_max) || blocked)
    return blocked;
}

#endif
