// The integer film: sums that no order of work can change. The format is in gpu_layout.h.
#ifndef FILM_GLSL
#define FILM_GLSL

#include "batch.glsl"
#include "bindings.glsl"
#include "exact.glsl"

// A sum of contributions to one pixel in registers: low and high words, and a bit for each channel
// that overflowed.
struct film_sum {
    uvec3 low;
    uvec3 high;
    uint flags;
    uint non_finite; // contributions left out
    uint saturated;  // contributions clipped
};

film_sum film_zero()
{
    return film_sum(uvec3(0u), uvec3(0u), 0u, 0u, 0u);
}

// One channel of a contribution in film steps, truncated; clipped just below 2^28. value >= 0 and
// finite. Its bits are m * 2^(e - 150) for the 24-bit significand m, so in steps of 2^-36 it is m
// shifted left by e - 114.
uvec2 film_fixed(float value)
{
    uint bits = floatBitsToUint(value);
    int e = int(bits >> 23);
    uint m = (bits & 0x007FFFFFu) | 0x00800000u;
    int left = e - 114;
    uint by = uint(left < 0 ? -left : left);
    uint shifted = m << (by & 31u);
    uint spill = (m >> 1) >> ((31u - by) & 31u); // m >> (32 - by), right for by = 0 too
    // By mix, since glslang makes branches of conditional expressions.
    uvec2 up = mix(uvec2(0u, shifted), uvec2(shifted, spill), bvec2(by < 32u));
    uvec2 down = uvec2(mix(0u, m >> (by & 31u), by < 32u), 0u);
    uvec2 fixed_point = mix(up, down, bvec2(left < 0));
    return mix(fixed_point, uvec2(0xFFFFFFFFu), bvec2(left > 40));
}

// Adds low and high words to a sum.
void film_plus(inout film_sum sum, uvec3 low, uvec3 high)
{
    uvec3 new_low = sum.low + low;
    uvec3 carry = uvec3(lessThan(new_low, low));
    uvec3 new_high = sum.high + high;
    uvec3 over = uvec3(lessThan(new_high, high));
    uvec3 carried = new_high + carry;
    over |= uvec3(lessThan(carried, carry));
    sum.low = new_low;
    sum.high = carried;
    sum.flags |= over.x | (over.y << 1) | (over.z << 2);
}

void film_accumulate(inout film_sum sum, vec3 value)
{
    bool finite = ex_is_finite(value);
    sum.non_finite += uint(!finite);
    bool above = any(greaterThanEqual(value, vec3(LR_FILM_MAX)));
    sum.saturated += uint(finite) & uint(above);
    vec3 kept = mix(vec3(0.0), max(value, vec3(0.0)), bvec3(finite));
    uvec2 r = film_fixed(kept.x), g = film_fixed(kept.y), b = film_fixed(kept.z);
    film_plus(sum, uvec3(r.x, g.x, b.x), uvec3(r.y, g.y, b.y));
}

void film_add_channel(uint at, uint channel, uint low, uint high, inout uint flags)
{
    uint old_low = 0u;
    if (low != 0u)
        old_low = atomicAdd(film[at + 2u * channel], low);
    uint add = high + (old_low + low < low ? 1u : 0u);
    // high + 1 wraps only when high is all ones: then the sum overflows in any case.
    bool wrapped = add < high;
    if (add != 0u) {
        uint old_high = atomicAdd(film[at + 2u * channel + 1u], add);
        wrapped = wrapped || old_high + add < add;
    }
    if (wrapped)
        flags |= 1u << (channel & 31u);
}

void film_add(uint pixel, film_sum sum)
{
    uint at = pixel * uint(LR_FILM_WORDS);
    uint flags = sum.flags;
    film_add_channel(at, 0u, sum.low.x, sum.high.x, flags);
    film_add_channel(at, 1u, sum.low.y, sum.high.y, flags);
    film_add_channel(at, 2u, sum.low.z, sum.high.z, flags);
    if (flags != 0u)
        atomicOr(film[at + uint(LR_FILM_FLAGS)], flags);
    if (sum.non_finite != 0u)
        atomicAdd(counters[LR_COUNTER_NON_FINITE], sum.non_finite);
    if (sum.saturated != 0u)
        atomicAdd(counters[LR_COUNTER_SATURATED], sum.saturated);
}

// The same for a batch, to be called by all its invocations; a sum of 0 is for those that have nothing.
// Neighbours of one pixel put their sums together first and share the channels between them, since on a
// CPU an atomic costs as much as some dozens of other instructions.
void film_add_batch(uint pixel, film_sum sum)
{
    add_count(LR_COUNTER_NON_FINITE, sum.non_finite);
    add_count(LR_COUNTER_SATURATED, sum.saturated);
    sum.non_finite = 0u;
    sum.saturated = 0u;
    if (has_shuffle) {
        // Invocations [begin, end) of the batch have this one's pixel.
        uint lane = batch_lane();
        bool begins = lane == 0u || batch_before(pixel, 1u) != pixel;
        uint beginnings = batch_sum(uint(begins) << (lane & 31u));
        uint behind = beginnings >> ((lane + 1u) & 31u);
        uint begin = highest_bit(beginnings & ((2u << (lane & 31u)) - 1u));
        uint end = behind == 0u ? uint(LR_BATCH) : lane + 1u + lowest_bit(behind);
        for (uint step = 1u; step < uint(LR_BATCH); step *= 2u) {
            uint joins = lane + step < end ? 0xFFFFFFFFu : 0u;
            uvec3 low = batch_behind(sum.low, step), high = batch_behind(sum.high, step);
            sum.flags |= batch_behind(sum.flags, step) & joins;
            film_plus(sum, low & joins, high & joins);
        }
        uint first = batch_begin() + begin, at = pixel * uint(LR_FILM_WORDS), flags = 0u;
        uvec3 low = share(sum.low, first), high = share(sum.high, first);
        if (lane == begin)
            flags = sum.flags;
        for (uint channel = lane - begin;;) {
            bool green = channel == 1u, blue = channel == 2u;
            if (channel < 3u)
                film_add_channel(at, channel, mix(mix(low.x, low.y, green), low.z, blue),
                                 mix(mix(high.x, high.y, green), high.z, blue), flags);
            channel += end - begin;
            if (channel >= 3u)
                break;
        }
        if (flags != 0u)
            atomicOr(film[at + uint(LR_FILM_FLAGS)], flags);
    } else {
        film_add(pixel, sum);
    }
}

#endif
