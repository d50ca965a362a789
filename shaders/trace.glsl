// The trace interface, all that kernels call: the nearest hit of a ray, and what stands between a
// point and a light.
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

nearest_hit trace_nearest(vec3 o, vec3 d)
{
    nearest_hit best = nearest_hit(LR_T_MAX, LR_PRIMITIVE_NONE, 0u, 0xFFFFFFFFu);
    float inv_a = ex_rcp(ex_dot(d, d));
    if (has_spheres)
        for (uint i = 0u; i < frame.spheres.count; i++) {
            gpu_sphere s = load_sphere(i);
            keep_nearer(best, intersect_sphere(o, d, inv_a, s), LR_PRIMITIVE_SPHERE, i, s.object);
        }
    if (has_ellipsoids)
        for (uint i = 0u; i < frame.ellipsoids.count; i++) {
            gpu_solid s = load_solid(frame.ellipsoids.first, i);
            keep_nearer(best, intersect_ellipsoid(o, d, s), LR_PRIMITIVE_ELLIPSOID, i, s.object);
        }
    if (has_planes)
        for (uint i = 0u; i < frame.planes.count; i++) {
            gpu_plane p = load_plane(i);
            keep_nearer(best, intersect_plane(o, d, p.normal, p.offset), LR_PRIMITIVE_PLANE, i,
                        p.object);
        }
    if (has_flats)
        for (uint i = 0u; i < frame.flats.count; i++) {
            gpu_flat f = load_flat(i);
            keep_nearer(best, intersect_flat(o, d, f), LR_PRIMITIVE_FLAT, i, f.object);
        }
    if (has_boxes)
        for (uint i = 0u; i < frame.boxes.count; i++) {
            gpu_solid s = load_solid(frame.boxes.first, i);
            keep_nearer(best, intersect_box(o, d, s), LR_PRIMITIVE_BOX, i, s.object);
        }
    if (has_cones)
        for (uint i = 0u; i < frame.cones.count; i++) {
            gpu_solid s = load_solid(frame.cones.first, i);
            keep_nearer(best, intersect_cone(o, d, s), LR_PRIMITIVE_CONE, i, s.object);
        }
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
        for (uint i = 0u; i < frame.spheres.opaque && !blocked; i++)
            blocked = crosses(intersect_sphere(o, d, inv_a, load_sphere(i)), t_max);
    if (has_ellipsoids)
        for (uint i = 0u; i < frame.ellipsoids.opaque && !blocked; i++)
            blocked = crosses(intersect_ellipsoid(o, d, load_solid(frame.ellipsoids.first, i)), t_max);
    if (has_planes)
        for (uint i = 0u; i < frame.planes.opaque && !blocked; i++) {
            gpu_plane p = load_plane(i);
            blocked = crosses(intersect_plane(o, d, p.normal, p.offset), t_max);
        }
    if (has_flats)
        for (uint i = 0u; i < frame.flats.opaque && !blocked; i++)
            blocked = crosses(intersect_flat(o, d, load_flat(i)), t_max);
    if (has_boxes)
        for (uint i = 0u; i < frame.boxes.opaque && !blocked; i++)
            blocked = crosses(intersect_box(o, d, load_solid(frame.boxes.first, i)), t_max);
    if (has_cones)
        for (uint i = 0u; i < frame.cones.opaque && !blocked; i++)
            blocked = crosses(intersect_cone(o, d, load_solid(frame.cones.first, i)), t_max);

    if (has_transparent && has_spheres)
        for (uint i = frame.spheres.opaque; i < frame.spheres.casters; i++) {
            gpu_sphere s = load_sphere(i);
            tint(depth, intersect_sphere(o, d, inv_a, s), t_max, s.object);
        }
    if (has_transparent && has_ellipsoids)
        for (uint i = frame.ellipsoids.opaque; i < frame.ellipsoids.casters; i++) {
            gpu_solid s = load_solid(frame.ellipsoids.first, i);
            tint(depth, intersect_ellipsoid(o, d, s), t_max, s.object);
        }
    if (has_transparent && has_planes)
        for (uint i = frame.planes.opaque; i < frame.planes.casters; i++) {
            gpu_plane p = load_plane(i);
            tint(depth, intersect_plane(o, d, p.normal, p.offset), t_max, p.object);
        }
    if (has_transparent && has_flats)
        for (uint i = frame.flats.opaque; i < frame.flats.casters; i++) {
            gpu_flat f = load_flat(i);
            tint(depth, intersect_flat(o, d, f), t_max, f.object);
        }
    if (has_transparent && has_boxes)
        for (uint i = frame.boxes.opaque; i < frame.boxes.casters; i++) {
            gpu_solid s = load_solid(frame.boxes.first, i);
            tint(depth, intersect_box(o, d, s), t_max, s.object);
        }
    if (has_transparent && has_cones)
        for (uint i = frame.cones.opaque; i < frame.cones.casters; i++) {
            gpu_solid s = load_solid(frame.cones.first, i);
            tint(depth, intersect_cone(o, d, s), t_max, s.object);
        }
    return blocked ? uvec3(LR_SHADOW_OPAQUE) : depth;
}

#endif
