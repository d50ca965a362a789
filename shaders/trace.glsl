// The nearest hit of a ray. All invocations of a subgroup must call trace_nearest together.
#ifndef TRACE_GLSL
#define TRACE_GLSL

#include "candidates.glsl"
#include "intersect.glsl"

struct nearest_hit {
    float t;
    uint primitive; // LR_PRIMITIVE_NONE when there is none
    uint object;
};

// Keeps the crossing if it is in front and nearer; on equal distance the smaller object wins, so
// that the order of the lists cannot matter.
void keep_nearer(inout nearest_hit best, vec2 crossing, uint primitive, uint object)
{
    float t = crossing.x > 0.0 ? crossing.x : crossing.y;
    if (t > 0.0 && (t < best.t || (t == best.t && object < best.object)))
        best = nearest_hit(t, primitive, object);
}

void nearest_plane(inout nearest_hit best, uint i, vec3 o, vec3 d)
{
    gpu_plane p = load_plane(i);
    keep_nearer(best, intersect_plane(o, d, p.normal, p.offset), i, p.object);
}

void nearest_sphere(inout nearest_hit best, uint i, vec3 o, vec3 d, float inv_a)
{
    gpu_sphere s = load_sphere(i);
    keep_nearer(best, intersect_sphere(o, d, inv_a, s), i, s.object);
}

void nearest_flat(inout nearest_hit best, uint i, vec3 o, vec3 d)
{
    gpu_flat f = load_flat(i);
    keep_nearer(best, intersect_flat(o, d, f), i, f.object);
}

void nearest_solid(inout nearest_hit best, uint i, vec3 o, vec3 d)
{
    gpu_solid s = load_solid(i);
    keep_nearer(best, intersect_solid(o, d, s, i), i, s.object);
}

// Runs `test` on each candidate i of one kind. Loops end at their bottom because on lavapipe what
// follows a break is executed once more, with no invocation active.
#define FOR_EACH_CANDIDATE(list, test)                                                             \
    {                                                                                              \
        uint left = bits & bits_of(list, first);                                                   \
        if (left != 0u)                                                                            \
            for (;;) {                                                                             \
                uint i = first + lowest_bit(left);                                                 \
                test;                                                                              \
                left = left & (left - 1u);                                                         \
                if (left == 0u)                                                                    \
                    break;                                                                         \
            }                                                                                      \
    }

nearest_hit trace_nearest(vec3 o, vec3 d)
{
    nearest_hit best = nearest_hit(LR_T_MAX, LR_PRIMITIVE_NONE, 0xFFFFFFFFu);
    if (has_planes)
        for (uint i = frame.planes.begin;;) {
            nearest_plane(best, i, o, d);
            i++;
            if (i >= hidden(frame.planes.end))
                break;
        }
    if (has_bounded) {
        float inv_a = ex_rcp(ex_dot(d, d));
        uint stop = hidden(frame.bounded);
        for (uint first = 0u;;) {
            uint bits = 0u;
            for (uint at = 0u;;) {
                vec4 held = load_ball(first + at, stop);
                bits |= batch_candidates(held, o, d) << (at & 31u);
                at += batch_size();
                if (at >= 32u || first + at >= stop)
                    break;
            }
            bits &= bits_before(stop, first);
            if (has_spheres)
                FOR_EACH_CANDIDATE(frame.spheres, nearest_sphere(best, i, o, d, inv_a))
            if (has_flats)
                FOR_EACH_CANDIDATE(frame.flats, nearest_flat(best, i, o, d))
            if (has_solids)
                FOR_EACH_CANDIDATE(frame.solids, nearest_solid(best, i, o, d))
            first += 32u;
            if (first >= stop)
                break;
        }
    }
    return best;
}

#endif
