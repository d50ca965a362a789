// Ray against triangle, watertight: Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection",
// JCGT 2013. In a space where the ray is the z axis, which side of an edge it passes is the sign of a
// difference of two products. Products that are rounded keep their order, so that sign is never
// wrong, only 0 at times, and 0 counts as inside: neighbours cannot both miss.
#ifndef TRIANGLE_GLSL
#define TRIANGLE_GLSL

#include "exact.glsl"
#include "intersect.glsl"

// A ray as its greatest direction component and the shear that makes it the z axis.
struct sheared_ray {
    uint axis;
    vec3 shear;
};

// The components after, after that and at `axis`.
vec3 along_axis(vec3 v, uint axis)
{
    return mix(mix(v.xyz, v.zxy, bvec3(axis == 1u)), v.yzx, bvec3(axis == 0u));
}

sheared_ray shear_ray(vec3 d)
{
    vec3 a = abs(d);
    uint axis = a.x >= a.y ? (a.x >= a.z ? 0u : 2u) : (a.y >= a.z ? 1u : 2u);
    vec3 p = along_axis(d, axis);
    float inverse = ex_rcp(away_from_zero(p.z));
    return sheared_ray(axis, vec3(p.x * inverse, p.y * inverse, inverse));
}

vec3 shear_point(sheared_ray ray, vec3 p)
{
    vec3 q = along_axis(p, ray.axis);
    return vec3(q.x - ray.shear.x * q.z, q.y - ray.shear.y * q.z, ray.shear.z * q.z);
}

// Nothing may hang on subnormal numbers, which some devices do not have.
float edge_side(vec3 p, vec3 q)
{
    float side = p.x * q.y - p.y * q.x;
    return abs(side) < 7.888609052210118e-31 ? 0.0 : side;
}

struct triangle_hit {
    float t;     // -1: none
    vec3 weight; // of the corners; their sum is 1
    bool front;  // met from where the corners go counter-clockwise
};

triangle_hit intersect_triangle(vec3 o, sheared_ray ray, gpu_triangle f)
{
    vec3 a = shear_point(ray, f.a - o), b = shear_point(ray, f.b - o), c = shear_point(ray, f.c - o);
    vec3 side = vec3(edge_side(c, b), edge_side(a, c), edge_side(b, a));
    bool under = side.x < 0.0 || side.y < 0.0 || side.z < 0.0;
    bool over = side.x > 0.0 || side.y > 0.0 || side.z > 0.0;
    bool hit = under != over;
    vec3 weight = side * ex_rcp(hit ? side.x + side.y + side.z : 1.0);
    float t = ex_dot(weight, vec3(a.z, b.z, c.z));
    return triangle_hit(hit ? t : -1.0, weight, under == (ray.shear.z < 0.0));
}

// Where a ray that meets the triangle at t, as `intersect_triangle` has it, is to meet it, or -1. Seen edge-on,
// all signs are those of roundings: the triangle is met anywhere along its line, in truth beside it or not. So
// the ray must pass the box around its corners, and the hit is moved into that. `slack` widens it, in distances
// along the ray by axis; `inverse` is 1 / direction. Distances are compared by their bits, as in slab_entry: the
// least of three is right unless one is negative, and the greatest unless all are.
float t_in_box(float t, vec3 o, vec3 inverse, vec3 slack, gpu_triangle f)
{
    ivec3 a = floatBitsToInt((f.a - o) * inverse), b = floatBitsToInt((f.b - o) * inverse);
    ivec3 c = floatBitsToInt((f.c - o) * inverse);
    ivec3 near = floatBitsToInt(intBitsToFloat(min(a, min(b, c))) - slack);
    ivec3 far = floatBitsToInt(intBitsToFloat(max(a, max(b, c))) + slack);
    int first = max(max(near.x, near.y), max(near.z, 0)), last = min(far.x, min(far.y, far.z));
    int bits = floatBitsToInt(t);
    return first <= last && bits >= 0 ? intBitsToFloat(clamp(bits, first, last)) : -1.0;
}

#endif
