// How pictures lie on surfaces (docs/scene.md): texture coordinates, with v down the picture.
#ifndef UV_GLSL
#define UV_GLSL

#include "exact.glsl"
#include "scene_data.glsl"

// How fast texture coordinates grow in the world, a metre each way; only in scenes with relief.
struct uv_growth {
    vec3 u, v;
};

const uv_growth no_growth = uv_growth(vec3(0.0), vec3(0.0));

// A rectangle, a disk or a triangle at the point p: its own coordinates are -1..1, and 0..1 for
// triangles.
vec2 flat_uv(gpu_flat f, vec3 p)
{
    float u = ex_dot(f.u, p) + f.u_offset, v = ex_dot(f.v, p) + f.v_offset;
    bool triangle = (f.flags & LR_FLAG_TRIANGLE) != 0u;
    return mix(vec2(0.5 + 0.5 * u, 0.5 - 0.5 * v), vec2(u, 1.0 - v), bvec2(triangle));
}

uv_growth flat_growth(gpu_flat f)
{
    bool triangle = (f.flags & LR_FLAG_TRIANGLE) != 0u;
    float share = triangle ? 1.0 : 0.5;
    return uv_growth(f.u * share, -f.v * share);
}

// The face with normal n of the box |x|, |y|, |z| <= 1 at the point p, upright with +y up; above, -z is
// up, and below, +z.
vec2 box_uv(vec3 p, vec3 n)
{
    vec2 right_down = vec2(n.x * -p.z + n.z * p.x, -p.y);
    vec2 level = vec2(p.x, n.y * p.z);
    return (n.y != 0.0 ? level : right_down) * 0.5 + vec2(0.5);
}

uv_growth box_growth(gpu_solid s, vec3 n)
{
    float share = 0.5 * s.inv_scale;
    vec3 x = s.row0.xyz * share, y = s.row1.xyz * share, z = s.row2.xyz * share;
    bool level = n.y != 0.0;
    return uv_growth(mix(z * -n.x + x * n.z, x, bvec3(level)), mix(-y, z * n.y, bvec3(level)));
}

// Along the object's own y axis, one picture a metre.
vec2 planar_uv(uint object, vec3 p)
{
    vec4 row0, row1, row2;
    load_object_space(object, row0, row1, row2);
    return vec2(ex_dot(row0.xyz, p) + row0.w, ex_dot(row2.xyz, p) + row2.w);
}

uv_growth planar_growth(uint object)
{
    vec4 row0, row1, row2;
    load_object_space(object, row0, row1, row2);
    return uv_growth(row0.xyz, row2.xyz);
}

#endif
