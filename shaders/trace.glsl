// The trace interface, all that kernels call: the nearest hit of a ray, and what stands between a
// point and a light. All invocations of a subgroup must call these two together.
#ifndef TRACE_GLSL
#define TRACE_GLSL

#include "intersect.glsl"

struct nearest_hit {
    float t;
    uint kind; // LR_PRIMITIVE_*
    uint index;
    uint object;
};

// Keeps the crossing if it is in front and nearer; on equal distance the smaller object wins, so
// that the order of the lists cannot matter.
void keep_nearer(inout nearest_hit best, vec2 crossing, uint kind, uint index, uint object)
{
    float t = crossing.x > 0.0 ? crossing.x : crossing.y;
    if (t > 0.0 && (t < best.t || (t == best.t && object < best.object)))
        best = nearest_hit(t, kind, index, object);
}

// Runs `body` for each primitive p, number i, of one kind's list from `begin` to `end`.
#define FOR_EACH(kind, load, begin, end, body)                                                     \
    {                                                                                              \
        uint stop = hidden(end);                                                                   \
        for (uint first = begin; first < stop; first += batch_size()) {                            \
            uint mine = batch_index(first, stop);                                                  \
            kind held = load;                                                                      \
            uint batch = min(batch_size(), stop - first);                                          \
            for (uint lane = 0u; lane < batch; lane++) {                                           \
                uint i = first + lane;                                                             \
                kind p = share(held, lane);                                                        \
                body;                                                                              \
            }                                                                                      \
        }                                                                                          \
    }

nearest_hit trace_nearest(vec3 o, vec3 d)
{
    nearest_hit best = nearest_hit(LR_T_MAX, LR_PRIMITIVE_NONE, 0u, 0xFFFFFFFFu);
    float inv_a = ex_rcp(ex_dot(d, d));
    if (has_spheres)
        FOR_EACH(gpu_sphere, load_sphere(mine), 0u, frame.spheres.count,
                 keep_nearer(best, intersect_sphere(o, d, inv_a, p), LR_PRIMITIVE_SPHERE, i,
                             p.object))
    if (has_ellipsoids)
        FOR_EACH(gpu_solid, load_solid(frame.ellipsoids.first, mine), 0u, frame.ellipsoids.count,
                 keep_nearer(best, intersect_ellipsoid(o, d, p), LR_PRIMITIVE_ELLIPSOID, i,
                             p.object))
    if (has_planes)
        FOR_EACH(gpu_plane, load_plane(mine), 0u, frame.planes.count,
                 keep_nearer(best, intersect_plane(o, d, p.normal, p.offset), LR_PRIMITIVE_PLANE, i,
                             p.object))
    if (has_flats)
        FOR_EACH(gpu_flat, load_flat(mine), 0u, frame.flats.count,
                 keep_nearer(best, intersect_flat(o, d, p), LR_PRIMITIVE_FLAT, i,
                             p.object))
    if (has_boxes)
        FOR_EACH(gpu_solid, load_solid(frame.boxes.first, mine), 0u, frame.boxes.count,
                 keep_nearer(best, intersect_box(o, d, p), LR_PRIMITIVE_BOX, i,
                             p.object))
    if (has_cones)
        FOR_EACH(gpu_solid, load_solid(frame.cones.first, mine), 0u, frame.cones.count,
                 keep_nearer(best, intersect_cone(o, d, p), LR_PRIMITIVE_CONE, i,
                             p.object))
    return best;
}

// The outward unit normal where the ray hit, and the position, moved onto the surface where that is
// cheap. `reach` is the size of the numbers that the position was computed from: its error, and so
// the offset of secondary rays, is proportional to it.
void surface_at(nearest_hit hit, vec3 o, vec3 d, out vec3 position, out vec3 normal,
                out float reach)
{
    position = o + d * hit.t;
    normal = vec3(0.0, 1.0, 0.0);
    vec3 a = abs(position);
    reach = max(max(a.x, a.y), a.z);
    if (has_spheres && hit.kind == LR_PRIMITIVE_SPHERE) {
        gpu_sphere s = load_sphere(hit.index);
        normal = ex_normalize((position - s.center) * s.inv_radius);
        position = s.center + normal * s.radius;
        vec3 c = abs(s.center);
        reach = max(max(c.x, c.y), max(c.z, s.radius));
    }
    if (has_planes && hit.kind == LR_PRIMITIVE_PLANE) {
        gpu_plane p = load_plane(hit.index);
        normal = p.normal;
        position = position + normal * (p.offset - ex_dot(normal, position));
        reach = max(reach, abs(p.offset));
    }
    if (has_flats && hit.kind == LR_PRIMITIVE_FLAT) {
        gpu_flat f = load_flat(hit.index);
        normal = f.normal;
        position = position + normal * (f.offset - ex_dot(normal, position));
        reach = max(reach, abs(f.offset));
    }
    if (has_ellipsoids && hit.kind == LR_PRIMITIVE_ELLIPSOID) {
        gpu_solid s = load_solid(frame.ellipsoids.first, hit.index);
        normal = solid_normal(s, solid_point(s, position));
        reach = max(reach, hit.t);
    }
    if (has_boxes && hit.kind == LR_PRIMITIVE_BOX) {
        gpu_solid s = load_solid(frame.boxes.first, hit.index);
        normal = solid_normal(s, box_face_normal(solid_point(s, position)));
        reach = max(reach, hit.t);
    }
    if (has_cones && hit.kind == LR_PRIMITIVE_CONE) {
        gpu_solid s = load_solid(frame.cones.first, hit.index);
        normal = solid_normal(s, cone_surface_normal(s, solid_point(s, position)));
        reach = max(reach, hit.t);
    }
}

bool crosses(vec2 crossing, float t_max)
{
    return (crossing.x > 0.0 && crossing.x < t_max) || (crossing.y > 0.0 && crossing.y < t_max);
}

// Adds what one transparent object takes from the light: its transmit colour once per surface, and
// its absorption over the length inside. As optical depth in integers, so no order matters.
void tint(inout uvec3 depth, vec2 crossing, float t_max, uint object)
{
    bool first = crossing.x > 0.0 && crossing.x < t_max;
    bool second = crossing.y > 0.0 && crossing.y < t_max;
    uint surfaces = (first ? 1u : 0u) + (second ? 1u : 0u);
    uvec3 add = load_object_shadow(object) * surfaces;
    if (has_absorption && surfaces != 0u) {
        uvec3 ids = load_object_ids(object);
        float inside = max(min(crossing.y, t_max) - max(crossing.x, 0.0), 0.0);
        vec3 optical = min(load_medium(ids.z).absorption * inside, vec3(40.0));
        add += (ids.y & LR_FLAG_SOLID) != 0u ? uvec3(optical * LR_SHADOW_UNIT) : uvec3(0u);
    }
    depth = min(depth + add, uvec3(LR_SHADOW_OPAQUE));
}

// The optical depth of what stands between o and the light at t_max: -log2 of what is left of each
// channel in LR_SHADOW_UNIT; LR_SHADOW_OPAQUE when nothing is.
uvec3 trace_shadow(vec3 o, vec3 d, float t_max)
{
    uvec3 depth = uvec3(0u);
    bool blocked = false;
    float inv_a = ex_rcp(ex_dot(d, d));
    if (has_spheres)
        FOR_EACH(gpu_sphere, load_sphere(mine), 0u, frame.spheres.opaque,
                 blocked = crosses(intersect_sphere(o, d, inv_a, p), t_max) || blocked)
    if (has_ellipsoids)
        FOR_EACH(gpu_solid, load_solid(frame.ellipsoids.first, mine), 0u, frame.ellipsoids.opaque,
                 blocked = crosses(intersect_ellipsoid(o, d, p), t_max) || blocked)
    if (has_planes)
        FOR_EACH(gpu_plane, load_plane(mine), 0u, frame.planes.opaque,
                 blocked = crosses(intersect_plane(o, d, p.normal, p.offset), t_max) || blocked)
    if (has_flats)
        FOR_EACH(gpu_flat, load_flat(mine), 0u, frame.flats.opaque,
                 blocked = crosses(intersect_flat(o, d, p), t_max) || blocked)
    if (has_boxes)
        FOR_EACH(gpu_solid, load_solid(frame.boxes.first, mine), 0u, frame.boxes.opaque,
                 blocked = crosses(intersect_box(o, d, p), t_max) || blocked)
    if (has_cones)
        FOR_EACH(gpu_solid, load_solid(frame.cones.first, mine), 0u, frame.cones.opaque,
                 blocked = crosses(intersect_cone(o, d, p), t_max) || blocked)
    if (has_transparent && has_spheres)
        FOR_EACH(gpu_sphere, load_sphere(mine), frame.spheres.opaque, frame.spheres.casters,
                 tint(depth, intersect_sphere(o, d, inv_a, p), t_max, p.object))
    if (has_transparent && has_ellipsoids)
        FOR_EACH(gpu_solid, load_solid(frame.ellipsoids.first, mine), frame.ellipsoids.opaque, frame.ellipsoids.casters,
                 tint(depth, intersect_ellipsoid(o, d, p), t_max, p.object))
    if (has_transparent && has_planes)
        FOR_EACH(gpu_plane, load_plane(mine), frame.planes.opaque, frame.planes.casters,
                 tint(depth, intersect_plane(o, d, p.normal, p.offset), t_max, p.object))
    if (has_transparent && has_flats)
        FOR_EACH(gpu_flat, load_flat(mine), frame.flats.opaque, frame.flats.casters,
                 tint(depth, intersect_flat(o, d, p), t_max, p.object))
    if (has_transparent && has_boxes)
        FOR_EACH(gpu_solid, load_solid(frame.boxes.first, mine), frame.boxes.opaque, frame.boxes.casters,
                 tint(depth, intersect_box(o, d, p), t_max, p.object))
    if (has_transparent && has_cones)
        FOR_EACH(gpu_solid, load_solid(frame.cones.first, mine), frame.cones.opaque, frame.cones.casters,
                 tint(depth, intersect_cone(o, d, p), t_max, p.object))
    return blocked ? uvec3(LR_SHADOW_OPAQUE) : depth;
}

#endif
