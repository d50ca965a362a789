// What stands between a point and up to four lights. All invocations of a subgroup must call
// trace_shadows together.
#ifndef SHADOW_GLSL
#define SHADOW_GLSL

#include "candidates.glsl"
#include "hole.glsl"
#include "intersect.glsl"
#include "notes.glsl"
#include "obstacle.glsl"

// The rays from one point towards up to four lights, one a component.
struct shadow_rays {
    uint count;
    vec4 x, y, z;   // unit directions
    vec4 t_max;     // a little short of the light
    uvec4 shadowed; // 1: what stands in the way counts
    bool through;   // transparent objects let light through
    // The optical depth of what stands in the way, by channel: -log2 of what is left of the light in
    // LR_SHADOW_UNIT; LR_SHADOW_OPAQUE when nothing is. In integers, so that no order matters.
    uvec4 red, green, blue;
};

shadow_rays shadow_rays_none()
{
    return shadow_rays(0u, vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), uvec4(0u), true,
                       uvec4(0u), uvec4(0u), uvec4(0u));
}

// Component i of v. By mix, since glslang makes branches of nested conditional expressions.
float pick(vec4 v, uint i)
{
    return mix(mix(v.w, v.z, i == 2u), mix(v.y, v.x, i == 0u), i < 2u);
}

uint pick(uvec4 v, uint i)
{
    return mix(mix(v.w, v.z, i == 2u), mix(v.y, v.x, i == 0u), i < 2u);
}

// v with `by` as its component i.
vec4 replaced(vec4 v, uint i, float by)
{
    return mix(v, vec4(by), equal(uvec4(i), uvec4(0u, 1u, 2u, 3u)));
}

uvec4 replaced(uvec4 v, uint i, uint by)
{
    return mix(v, uvec4(by), equal(uvec4(i), uvec4(0u, 1u, 2u, 3u)));
}

// Selects instead of branches: this is cheap where every branch is paid for.
const uint no_slot = 4u;

void set_ray(inout shadow_rays rays, uint slot, vec4 ray, uint shadowed)
{
    rays.x = replaced(rays.x, slot, ray.x);
    rays.y = replaced(rays.y, slot, ray.y);
    rays.z = replaced(rays.z, slot, ray.z);
    rays.t_max = replaced(rays.t_max, slot, ray.w);
    rays.shadowed = replaced(rays.shadowed, slot, shadowed);
}

vec3 direction_of(shadow_rays rays, uint l)
{
    return vec3(pick(rays.x, l), pick(rays.y, l), pick(rays.z, l));
}

// Adds to the depth of ray l what a primitive takes; returns whether nothing is left, and so no other
// needs to be looked at.
bool dim(inout shadow_rays rays, uint l, vec2 crossing, float t_max, uint object, uint flags)
{
    uvec3 add = crosses(crossing, t_max) ? uvec3(LR_SHADOW_OPAQUE) : uvec3(0u);
    if (has_transparent && rays.through && (flags & LR_FLAG_TRANSPARENT) != 0u)
        add = tint(crossing, t_max, load_object_shadow(object));
    if ((flags & LR_FLAG_SHADOW) == 0u)
        add = uvec3(0u);
    if (explains && add != uvec3(0u))
        note_obstacle(pick(noted_lights, l), object, crossing, add);
    uvec3 depth = uvec3(pick(rays.red, l), pick(rays.green, l), pick(rays.blue, l));
    depth = min(depth + add, uvec3(LR_SHADOW_OPAQUE));
    rays.red = replaced(rays.red, l, depth.x);
    rays.green = replaced(rays.green, l, depth.y);
    rays.blue = replaced(rays.blue, l, depth.z);
    bool dark = depth == uvec3(LR_SHADOW_OPAQUE);
    if (explains) // all of them are noted
        dark = false;
    return dark;
}

bool dim_plane(inout shadow_rays rays, uint l, uint i, vec3 o, vec3 d, float t_max)
{
    gpu_plane p = load_plane(i);
    vec2 crossing = intersect_plane(o, d, p.normal, p.offset);
    if (has_cutouts)
        crossing = projected_crossings(crossing, p.object, o, d);
    return dim(rays, l, crossing, t_max, p.object, p.flags);
}

bool dim_sphere(inout shadow_rays rays, uint l, uint i, vec3 o, vec3 d, float t_max)
{
    gpu_sphere s = load_sphere(i);
    vec2 crossing = intersect_sphere(o, d, ex_rcp(ex_dot(d, d)), s);
    if (has_cutouts)
        crossing = projected_crossings(crossing, s.object, o, d);
    return dim(rays, l, crossing, t_max, s.object, s.flags);
}

bool dim_flat(inout shadow_rays rays, uint l, uint i, vec3 o, vec3 d, float t_max)
{
    gpu_flat f = load_flat(i);
    vec2 crossing = intersect_flat(o, d, f);
    if (has_cutouts)
        crossing = flat_crossing(crossing, f, o, d);
    return dim(rays, l, crossing, t_max, f.object, f.flags);
}

bool dim_solid(inout shadow_rays rays, uint l, uint i, vec3 o, vec3 d, float t_max)
{
    gpu_solid s = load_solid(i);
    vec2 crossing = intersect_solid(o, d, s, i);
    if (has_cutouts)
        crossing = solid_crossings(crossing, s, has_boxes && is_in(frame.boxes, i), o, d);
    return dim(rays, l, crossing, t_max, s.object, s.flags);
}

// The first component that is not 0, or 3.
uint first_of(uvec4 v)
{
    return mix(mix(mix(3u, 2u, v.z != 0u), 1u, v.y != 0u), 0u, v.x != 0u);
}

// Runs `test` on each candidate i of one kind for each ray l: every invocation goes through its own
// pairs of the two, so few rounds serve all of them. Loops end at their bottom, as in trace.glsl.
#define FOR_EACH_PAIR(kind_bits, test)                                                             \
    {                                                                                              \
        uvec4 left = bits & (kind_bits);                                                           \
        if (left != uvec4(0u))                                                                     \
            for (;;) {                                                                             \
                uint l = first_of(left);                                                           \
                uint mine = pick(left, l), i = first + lowest_bit(mine);                           \
                vec3 d = direction_of(rays, l);                                                    \
                float t_max = pick(rays.t_max, l);                                                 \
                bool dark = test;                                                                  \
                left = replaced(left, l, dark ? 0u : mine & (mine - 1u));                          \
                if (left == uvec4(0u))                                                             \
                    break;                                                                         \
            }                                                                                      \
    }

// `most` is the greatest number of rays that an invocation of the batch has.
void trace_shadows(inout shadow_rays rays, vec3 o, uint most)
{
    if (has_planes)
        for (uint first = frame.planes.begin;;) {
            uvec4 bits = uvec4(0u);
            gpu_plane p = load_plane(first);
            for (uint l = 0u;;) {
                vec3 d = direction_of(rays, l);
                vec2 crossing = intersect_plane(o, d, p.normal, p.offset);
                bits = replaced(bits, l, crosses(crossing, pick(rays.t_max, l)) ? 1u : 0u);
                l++;
                if (l >= most)
                    break;
            }
            bits = bits * rays.shadowed;
            if (has_transparent_planes || explains) {
                FOR_EACH_PAIR(1u, dim_plane(rays, l, i, o, d, t_max))
            } else if ((p.flags & LR_FLAG_SHADOW) != 0u) {
                rays.red |= bits * LR_SHADOW_OPAQUE;
                rays.green |= bits * LR_SHADOW_OPAQUE;
                rays.blue |= bits * LR_SHADOW_OPAQUE;
            }
            first++;
            if (first >= hidden(frame.planes.end))
                break;
        }
    if (has_bounded) {
        uint stop = hidden(frame.bounded);
        for (uint first = 0u;;) {
            uvec4 bits = uvec4(0u);
            for (uint at = 0u;;) {
                vec4 held = load_ball(first + at, stop);
                for (uint l = 0u;;) {
                    vec3 d = direction_of(rays, l);
                    uint found = batch_candidates(held, o, d) << (at & 31u);
                    bits = replaced(bits, l, pick(bits, l) | found);
                    l++;
                    if (l >= most)
                        break;
                }
                at += batch_size();
                if (at >= 32u || first + at >= stop)
                    break;
            }
            bits = bits * rays.shadowed & bits_before(stop, first);
            if (has_spheres)
                FOR_EACH_PAIR(bits_of(frame.spheres, first), dim_sphere(rays, l, i, o, d, t_max))
            if (has_flats)
                FOR_EACH_PAIR(bits_of(frame.flats, first), dim_flat(rays, l, i, o, d, t_max))
            if (has_solids)
                FOR_EACH_PAIR(bits_of(frame.solids, first), dim_solid(rays, l, i, o, d, t_max))
            first += 32u;
            if (first >= stop)
                break;
        }
    }
}

#endif
