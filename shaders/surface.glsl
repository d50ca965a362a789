// The surface at a hit.
#ifndef SURFACE_GLSL
#define SURFACE_GLSL

#include "candidates.glsl"
#include "intersect.glsl"
#include "uv.glsl"

struct surface {
    vec3 position; // moved onto the surface where that is cheap
    float offset;  // how far off the surface a ray must start, metres
    vec3 normal;   // geometric, unit, outward
    uint object;
    vec2 uv; // texture coordinates, in scenes with textures
};

// The error of the position, and so the offset of secondary rays, is proportional to the size of the
// numbers that it was computed from.
surface surface_at(uint primitive, float t, vec3 o, vec3 d)
{
    vec3 position = o + d * t, normal = vec3(0.0, 1.0, 0.0);
    uint object = 0u;
    vec2 uv = vec2(0.0);
    bool planar = has_textures;
    vec3 a = abs(position);
    float reach = max(max(a.x, a.y), a.z);
    if (has_spheres && is_in(frame.spheres, primitive)) {
        gpu_sphere s = load_sphere(primitive);
        object = s.object;
        normal = ex_normalize((position - s.center) * s.inv_radius);
        position = s.center + normal * s.radius;
        vec3 c = abs(s.center);
        reach = max(max(c.x, c.y), max(c.z, s.radius));
    }
    if (has_planes && is_in(frame.planes, primitive)) {
        gpu_plane p = load_plane(primitive);
        object = p.object;
        normal = p.normal;
        position = position + normal * (p.offset - ex_dot(normal, position));
        reach = max(reach, abs(p.offset));
    }
    if (has_flats && is_in(frame.flats, primitive)) {
        gpu_flat f = load_flat(primitive);
        object = f.object;
        normal = f.normal;
        position = position + normal * (f.offset - ex_dot(normal, position));
        reach = max(reach, abs(f.offset));
        if (has_textures)
            uv = flat_uv(f, position);
        planar = false;
    }
    bool ellipsoid = has_ellipsoids && is_in(frame.ellipsoids, primitive);
    bool box = has_boxes && is_in(frame.boxes, primitive);
    bool cone = has_cones && is_in(frame.cones, primitive);
    if (has_solids && (ellipsoid || box || cone)) {
        gpu_solid s = load_solid(primitive);
        object = s.object;
        vec3 p = solid_point(s, position), n = p;
        if (has_boxes)
            n = box ? box_face_normal(p) : n;
        if (has_cones)
            n = cone ? cone_surface_normal(s, p) : n;
        normal = solid_normal(s, n);
        if (has_textures && has_boxes)
            uv = box_uv(p, n);
        planar = planar && !box;
        reach = max(reach, t);
    }
    if (has_textures) {
        vec2 projected = planar_uv(object, position);
        uv = planar ? projected : uv;
    }
    return surface(position, reach * LR_OFFSET, normal, object, uv);
}

#endif
