// The nearest hit, and what stands in the way of light, in scenes of few primitives: every ray tests all
// of them, and their records stay in registers.
#ifndef FEW_GLSL
#define FEW_GLSL

#include "hole.glsl"
#include "obstacle.glsl"
#include "scene_data.glsl"
#include "trace.glsl"

// To be called before all branches of main.
void hold_records()
{
#define HOLD_PLANE(k)                                                                              \
    held_planes[k] = plane_of(scene_rows[work.plane_rows + 2u * (k)],                                \
                              scene_rows[work.plane_rows + 2u * (k) + 1u]);
#define HOLD_SPHERE(k)                                                                             \
    held_spheres[k] = sphere_of(scene_rows[work.sphere_rows + 2u * (k)],                             \
                                scene_rows[work.sphere_rows + 2u * (k) + 1u]);
#define HOLD_FLAT(k)                                                                               \
    held_flats[k] = flat_of(scene_rows[work.flat_rows + 4u * (k)],                                   \
                            scene_rows[work.flat_rows + 4u * (k) + 1u],                              \
                            scene_rows[work.flat_rows + 4u * (k) + 2u],                              \
                            scene_rows[work.flat_rows + 4u * (k) + 3u]);
#define HOLD_SOLID(k)                                                                              \
    held_solids[k] = solid_of(scene_rows[work.solid_rows + 5u * (k)],                                \
                              scene_rows[work.solid_rows + 5u * (k) + 1u],                           \
                              scene_rows[work.solid_rows + 5u * (k) + 2u],                           \
                              scene_rows[work.solid_rows + 5u * (k) + 3u],                           \
                              scene_rows[work.solid_rows + 5u * (k) + 4u]);
    if (has_few) {
        EACH_HELD_PLANE(HOLD_PLANE)
        EACH_HELD_SPHERE(HOLD_SPHERE)
        EACH_HELD_FLAT(HOLD_FLAT)
        EACH_HELD_SOLID(HOLD_SOLID)
    }
}

nearest_hit nearest_of_few(vec3 o, vec3 d)
{
    nearest_hit best = nearest_hit(LR_T_MAX, LR_PRIMITIVE_NONE, 0xFFFFFFFFu);
    float inv_a = ex_rcp(ex_dot(d, d));
    uint first_solid = hidden(frame.solids.begin);
#define NEARER_PLANE(k)                                                                            \
    keep_nearer(best, intersect_plane(o, d, held_planes[k].normal, held_planes[k].offset),         \
                frame.planes.begin + k, held_planes[k].object);
#define NEARER_SPHERE(k)                                                                           \
    keep_nearer(best, intersect_sphere(o, d, inv_a, held_spheres[k]), frame.spheres.begin + k,     \
                held_spheres[k].object);
#define NEARER_FLAT(k)                                                                             \
    keep_nearer(best, intersect_flat(o, d, held_flats[k]), frame.flats.begin + k,                  \
                held_flats[k].object);
#define NEARER_SOLID(k)                                                                            \
    keep_nearer(best, intersect_solid(o, d, held_solids[k], first_solid + k), first_solid + k,      \
                held_solids[k].object);
    EACH_HELD_PLANE(NEARER_PLANE)
    EACH_HELD_SPHERE(NEARER_SPHERE)
    EACH_HELD_FLAT(NEARER_FLAT)
    EACH_HELD_SOLID(NEARER_SOLID)
    return best;
}

bool plane_blocks(gpu_plane p, vec3 o, vec3 d, float t_max)
{
    vec2 crossing = intersect_plane(o, d, p.normal, p.offset);
    if (has_cutouts)
        crossing = projected_crossings(crossing, p.object, o, d);
    return crosses(crossing, t_max) && (p.flags & LR_FLAG_SHADOW) != 0u;
}

bool sphere_blocks(gpu_sphere s, vec3 o, vec3 d, float inv_a, float t_max)
{
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

bool solid_blocks(gpu_solid s, uint i, vec3 o, vec3 d, float t_max)
{
    vec2 crossing = intersect_solid(o, d, s, i);
    if (has_cutouts)
        crossing = solid_crossings(crossing, s, has_boxes && is_in(frame.boxes, i), o, d);
    return crosses(crossing, t_max) && (s.flags & LR_FLAG_SHADOW) != 0u;
}

// Whether something is in the way that casts shadows, up to t_max.
bool few_block(vec3 o, vec3 d, float t_max)
{
    bool blocked = false;
    float inv_a = ex_rcp(ex_dot(d, d));
    uint first_solid = hidden(frame.solids.begin);
#define PLANE_BLOCKS(k) blocked = plane_blocks(held_planes[k], o, d, t_max) || blocked;
#define SPHERE_BLOCKS(k) blocked = sphere_blocks(held_spheres[k], o, d, inv_a, t_max) || blocked;
#define FLAT_BLOCKS(k) blocked = flat_blocks(held_flats[k], o, d, t_max) || blocked;
#define SOLID_BLOCKS(k)                                                                            \
    blocked = solid_blocks(held_solids[k], first_solid + k, o, d, t_max) || blocked;
    EACH_HELD_PLANE(PLANE_BLOCKS)
    EACH_HELD_SPHERE(SPHERE_BLOCKS)
    EACH_HELD_FLAT(FLAT_BLOCKS)
    EACH_HELD_SOLID(SOLID_BLOCKS)
    return blocked;
}

#endif
