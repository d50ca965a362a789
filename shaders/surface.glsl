// The surface at a hit.
#ifndef SURFACE_GLSL
#define SURFACE_GLSL

#include "candidates.glsl"
#include "intersect.glsl"
#include "mesh.glsl"
#include "triangle.glsl"
#include "uv.glsl"

struct surface {
    vec3 position; // moved onto the surface where that is cheap
    float offset;  // how far off the surface a ray must start, metres
    vec3 normal;   // geometric, unit, outward
    uint object;
    vec3 shading;     // normal to be lit by, unit, on the same side as the geometric one
    vec3 lit_from;    // where shadow rays start, before the offset
    vec3 tint;        // of the mesh's corners, times the material's colour
    vec2 uv; // texture coordinates, in scenes with textures
    uv_growth growth;
};

// On a smooth mesh light must fall as if the surface were curved: shadow rays start at the point where
// the planes that stand on the corners' normals would have it (Hanika, "Hacking the Shadow
// Terminator", Ray Tracing Gems II, 2021), else flat triangles near the terminator shadow themselves.
vec3 curved_point(vec3 p, gpu_triangle f, vec3 weight, vec3 na, vec3 nb, vec3 nc)
{
    vec3 a = p - f.a, b = p - f.b, c = p - f.c;
    float da = min(ex_dot(a, na), 0.0), db = min(ex_dot(b, nb), 0.0), dc = min(ex_dot(c, nc), 0.0);
    return p - (na * (da * weight.x) + nb * (db * weight.y) + nc * (dc * weight.z));
}

// How the texture coordinates grow over a triangle of a mesh, in the world; 0 where its corners do not
// tell.
uv_growth mesh_growth(gpu_instance place, gpu_triangle f, gpu_vertex a, gpu_vertex b, gpu_vertex c)
{
    vec3 e1 = f.b - f.a, e2 = f.c - f.a, longest = max(abs(e1), abs(e2));
    float scale = ex_power_for(longest);
    e1 = e1 * scale;
    e2 = e2 * scale;
    vec3 n = ex_cross(e1, e2);
    float area2 = ex_dot(n, n);
    bool usable = area2 > 1.0e-24;
    float share = ex_rcp(usable ? area2 : 1.0) * scale;
    vec3 along_1 = ex_cross(e2, n) * share, along_2 = ex_cross(n, e1) * share;
    vec3 u = along_1 * (b.u - a.u) + along_2 * (c.u - a.u);
    vec3 v = along_1 * (b.v - a.v) + along_2 * (c.v - a.v);
    return uv_growth(usable ? instance_normal(place, u) : vec3(0.0),
                     usable ? instance_normal(place, v) : vec3(0.0));
}

surface mesh_surface(gpu_hit hit, vec3 o, vec3 d)
{
    gpu_instance place = no_instance;
    if (has_instances)
        place = load_instance(scene_row(frame.objects + 5u * hit.object + 3u).w);
    gpu_triangle f = load_triangle(hit.primitive);
    triangle_hit met = intersect_triangle(instance_point(place, o),
                                          shear_ray(instance_vector(place, d)), f);
    vec3 normal = ex_cross(ex_scale_up(f.b - f.a), ex_scale_up(f.c - f.a));
    vec3 world = ex_normalize(ex_scale_up(instance_normal(place, ex_scale_up(normal))));
    vec3 position = o + d * hit.t, r = abs(position);
    float reach = max(max(r.x, r.y), max(r.z, hit.t));
    surface s = surface(position, reach * LR_OFFSET, world, hit.object, world, position, vec3(1.0),
                        vec2(0.0), no_growth);
    if (has_corners && (f.flags & (LR_FLAG_SMOOTH | LR_FLAG_UV | LR_FLAG_COLORS)) != 0u) {
        uvec4 corners = scene_row(frame.corners + hit.primitive - frame.triangles.begin);
        gpu_vertex a = load_vertex(corners.x), b = load_vertex(corners.y), c = load_vertex(corners.z);
        vec3 w = met.weight;
        s.uv = uv_between(a, b, c, w);
        if (has_relief && (f.flags & LR_FLAG_UV) != 0u)
            s.growth = mesh_growth(place, f, a, b, c);
        if ((f.flags & LR_FLAG_COLORS) != 0u)
            s.tint = unpack_color(a.color) * w.x + unpack_color(b.color) * w.y +
                     unpack_color(c.color) * w.z;
        if ((f.flags & LR_FLAG_SMOOTH) != 0u) {
            vec3 na = ex_normalize(unpack_normal(a.normal));
            vec3 nb = ex_normalize(unpack_normal(b.normal));
            vec3 nc = ex_normalize(unpack_normal(c.normal));
            vec3 smoothed = instance_normal(place, na * w.x + nb * w.y + nc * w.z);
            smoothed = ex_normalize(ex_scale_up(smoothed));
            s.shading = ex_dot(smoothed, world) < 0.0 ? -smoothed : smoothed;
            vec3 p = f.a * w.x + f.b * w.y + f.c * w.z;
            bool behind = ex_dot(d, world) > 0.0;
            vec3 moved = curved_point(p, f, w, behind ? -na : na, behind ? -nb : nb,
                                      behind ? -nc : nc) - p;
            s.lit_from = position + vector_of_instance(place, moved);
        }
    }
    return s;
}

// The error of the position, and so the offset of secondary rays, is proportional to the size of the
// numbers that it was computed from.
surface surface_at(gpu_hit hit, vec3 o, vec3 d)
{
    uint primitive = hit.primitive;
    float t = hit.t;
    vec3 position = o + d * t, normal = vec3(0.0, 1.0, 0.0);
    uint object = hit.object;
    vec2 uv = vec2(0.0);
    uv_growth growth = no_growth;
    bool planar = has_textures;
    vec3 a = abs(position);
    float reach = max(max(a.x, a.y), a.z);
    if (has_spheres && is_in(frame.spheres, primitive)) {
        gpu_sphere s = load_sphere(primitive);
        normal = ex_normalize((position - s.center) * s.inv_radius);
        position = s.center + normal * s.radius;
        vec3 c = abs(s.center);
        reach = max(max(c.x, c.y), max(c.z, s.radius));
    }
    if (has_planes && is_in(frame.planes, primitive)) {
        gpu_plane p = load_plane(primitive);
        normal = p.normal;
        position = position + normal * (p.offset - ex_dot(normal, position));
        reach = max(reach, abs(p.offset));
    }
    if (has_flats && is_in(frame.flats, primitive)) {
        gpu_flat f = load_flat(primitive);
        normal = f.normal;
        position = position + normal * (f.offset - ex_dot(normal, position));
        reach = max(reach, abs(f.offset));
        if (has_textures)
            uv = flat_uv(f, position);
        if (has_relief)
            growth = flat_growth(f);
        planar = false;
    }
    bool ellipsoid = has_ellipsoids && is_in(frame.ellipsoids, primitive);
    bool box = has_boxes && is_in(frame.boxes, primitive);
    bool cone = has_cones && is_in(frame.cones, primitive);
    if (has_solids && (ellipsoid || box || cone)) {
        gpu_solid s = load_solid(primitive);
        vec3 p = solid_point(s, position), n = p;
        if (has_boxes)
            n = box ? box_face_normal(p) : n;
        if (has_cones)
            n = cone ? cone_surface_normal(s, p) : n;
        normal = solid_normal(s, n);
        if (has_textures && has_boxes)
            uv = box_uv(p, n);
        if (has_relief && has_boxes)
            growth = box_growth(s, n);
        planar = planar && !box;
        reach = max(reach, t);
    }
    if (has_textures) {
        vec2 projected = planar_uv(object, position);
        uv = planar ? projected : uv;
    }
    if (has_relief && planar)
        growth = planar_growth(object);
    surface s = surface(position, reach * LR_OFFSET, normal, object, normal, position, vec3(1.0), uv,
                        growth);
    if (has_meshes && is_in(frame.triangles, primitive))
        s = mesh_surface(hit, o, d);
    return s;
}

#endif
