// Which primitives a ray may hit, by their bounding balls: a cheap test of all of them leaves a few
// bits for each ray, and each invocation then runs the exact tests of its own few.
#ifndef CANDIDATES_GLSL
#define CANDIDATES_GLSL

#include "batch.glsl"
#include "exact.glsl"
#include "scene_data.glsl"

const bool has_solids = has_ellipsoids || has_boxes || has_cones;
const bool has_bounded = has_spheres || has_flats || has_solids;

// Whether a ray may hit what a ball holds: whether its point nearest to the centre is within the ball.
// On the safe side of all rounding in here and in the exact tests: a candidate more costs time, a
// candidate less would change the picture.
bool may_hit(vec4 ball, vec3 o, vec3 d)
{
    vec3 c = ball.xyz - o;
    float along = ex_dot(c, d);
    float ahead = along < 0.0 ? 0.0 : along;
    return !(ahead * ahead + ball.w < ex_dot(c, c) * LR_CULL_SLACK);
}

// What this invocation loads of the balls from number `at`: those of its batch get it by shuffles.
vec4 load_ball(uint at, uint end)
{
    return scene_row_float(frame.balls + min(at + batch_lane(), end - 1u));
}

// The candidates among a batch of balls, as bits from bit 0.
uint batch_candidates(vec4 held, vec3 o, vec3 d)
{
    uint bits = 0u, begin = batch_begin();
    for (uint lane = 0u; lane < batch_size(); lane++) {
        vec4 ball = share(held, begin + lane);
        bits |= may_hit(ball, o, d) ? 1u << (lane & 31u) : 0u;
    }
    return bits;
}

// Bits 0 to n - 1, for n up to 32.
uint bits_below(uint n)
{
    return n >= 32u ? 0xFFFFFFFFu : (1u << (n & 31u)) - 1u;
}

// Bits for the up to 32 bounded primitives from number `first`.
uint bits_before(uint stop, uint first)
{
    return bits_below(min(stop - first, 32u));
}

// The bits of one kind's primitives among the 32 from number `first`.
uint bits_of(gpu_list list, uint first)
{
    uint begin = max(list.begin, first) - first, end = max(list.end, first) - first;
    return bits_below(end) & ~bits_below(begin);
}

#endif
