// Where a ray crosses a surface at a hole of its picture, it does not cross it: -1 in place of the
// distance.
#ifndef HOLE_GLSL
#define HOLE_GLSL

#include "intersect.glsl"
#include "texture.glsl"
#include "uv.glsl"

vec2 flat_crossing(vec2 crossing, gpu_flat f, vec3 o, vec3 d)
{
    uint material = load_object_ids(f.object).x;
    bool hole = cut_out(material, flat_uv(f, o + d * crossing.x));
    return mix(crossing, miss, bvec2(hole));
}

// Spheres and planes.
vec2 projected_crossings(vec2 crossing, uint object, vec3 o, vec3 d)
{
    uint material = load_object_ids(object).x;
    for (uint k = 0u;;) {
        bool hole = cut_out(material, planar_uv(object, o + d * crossing.x));
        crossing = vec2(crossing.y, mix(crossing.x, -1.0, hole));
        k++;
        if (k >= 2u)
            break;
    }
    return crossing;
}

vec2 solid_crossings(vec2 crossing, gpu_solid s, bool box, vec3 o, vec3 d)
{
    uint material = load_object_ids(s.object).x;
    for (uint k = 0u;;) {
        vec3 p = o + d * crossing.x, own = solid_point(s, p);
        vec2 on_face = box_uv(own, box_face_normal(own)), projected = planar_uv(s.object, p);
        bool hole = cut_out(material, mix(projected, on_face, bvec2(box)));
        crossing = vec2(crossing.y, mix(crossing.x, -1.0, hole));
        k++;
        if (k >= 2u)
            break;
    }
    return crossing;
}

#endif
