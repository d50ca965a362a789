// Batches: LR_BATCH neighbouring invocations of a subgroup that share loads, sums and slots by
// shuffles, because loads and atomics are paid per invocation on software devices, and a shuffle is
// one instruction. All invocations must be active in these functions. Where shuffles are missing a
// batch is one invocation.
#ifndef BATCH_GLSL
#define BATCH_GLSL

#include "bindings.glsl"

uint batch_size()
{
    uint size = 1u;
    if (has_shuffle)
        size = uint(LR_BATCH);
    return size;
}

// This invocation's number in its batch.
uint batch_lane()
{
    uint lane = gl_SubgroupInvocationID;
    return has_shuffle ? lane & (uint(LR_BATCH) - 1u) : 0u;
}

// Where the batch begins in the subgroup.
uint batch_begin()
{
    uint lane = gl_SubgroupInvocationID;
    return lane & ~(uint(LR_BATCH) - 1u);
}

// The value of the batch's invocation `lane`.
float share(float x, uint lane)
{
    return has_shuffle ? subgroupShuffle(x, lane) : x;
}

uint share(uint x, uint lane)
{
    return has_shuffle ? subgroupShuffle(x, lane) : x;
}

uvec3 share(uvec3 v, uint lane)
{
    return uvec3(share(v.x, lane), share(v.y, lane), share(v.z, lane));
}

vec3 share(vec3 v, uint lane)
{
    return vec3(share(v.x, lane), share(v.y, lane), share(v.z, lane));
}

vec4 share(vec4 v, uint lane)
{
    return vec4(share(v.x, lane), share(v.y, lane), share(v.z, lane), share(v.w, lane));
}

uint neighbour(uint x, uint distance)
{
    uint lane = gl_SubgroupInvocationID;
    return subgroupShuffle(x, lane ^ distance);
}

// The value of the batch's invocation `distance` before this one, or behind it; where there is none, of
// the batch's first or last.
uint batch_before(uint x, uint distance)
{
    return subgroupShuffle(x, batch_begin() + max(batch_lane(), distance) - distance);
}

uint batch_behind(uint x, uint distance)
{
    return subgroupShuffle(x, batch_begin() + min(batch_lane() + distance, uint(LR_BATCH) - 1u));
}

uvec3 batch_behind(uvec3 v, uint distance)
{
    return uvec3(batch_behind(v.x, distance), batch_behind(v.y, distance),
                 batch_behind(v.z, distance));
}

// The sum over the batch.
uint batch_sum(uint x)
{
    if (has_shuffle) {
        x += neighbour(x, 1u);
        x += neighbour(x, 2u);
        x += neighbour(x, 4u);
    }
    return x;
}

uint batch_max(uint x)
{
    if (has_shuffle) {
        x = max(x, neighbour(x, 1u));
        x = max(x, neighbour(x, 2u));
        x = max(x, neighbour(x, 4u));
    }
    return x;
}

// The sum over the batch's earlier invocations. Each step doubles the aligned run of lanes that is
// summed up: the upper half of a run adds the sum of its lower half.
uint batch_sum_before(uint x)
{
    uint before = 0u, sum = x;
    if (has_shuffle) {
        uint lane = batch_lane();
        for (uint step = 1u; step < uint(LR_BATCH); step *= 2u) {
            uint other = neighbour(sum, step);
            before += (lane & step) != 0u ? other : 0u;
            sum += other;
        }
    }
    return before;
}

// The number of the lowest bit set; of the highest one, of bits below 2^24. (GLSL's findLSB is of low
// precision.)
uint lowest_bit(uint bits)
{
    return ((floatBitsToUint(float(int(bits & (~bits + 1u)))) >> 23) & 255u) - 127u;
}

uint highest_bit(uint bits)
{
    return (floatBitsToUint(float(int(bits))) >> 23) - 127u;
}

// What a kernel counts: each sum waits in an invocation of its own, until write_counts adds them all with
// one atomic.
uint count_of_lane = 0u, counter_of_lane = 0u, lanes_that_count = 0u;

void write_counts()
{
    if (count_of_lane != 0u)
        atomicAdd(counters[counter_of_lane], count_of_lane);
    count_of_lane = 0u;
    lanes_that_count = 0u;
}

// Adds n of each invocation to counter LR_COUNTER_*, when write_counts is called. Outside loops, so that
// compilers know the lane.
void add_count(uint counter, uint n)
{
    uint sum = batch_sum(n);
    if (has_shuffle) {
        if (lanes_that_count == uint(LR_BATCH))
            write_counts();
        bool mine = batch_lane() == lanes_that_count;
        count_of_lane = mine ? sum : count_of_lane;
        counter_of_lane = mine ? counter : counter_of_lane;
        lanes_that_count++;
    } else if (sum != 0u) {
        atomicAdd(counters[counter], sum);
    }
}

// Slots of those that a counter counts, for each invocation that wants the first and for each that wants
// the second.
uvec2 take_slots(uint counter, bool first, bool second)
{
    uint wanted = uint(first) | uint(second) << 16;
    uint taken = batch_sum(wanted), before = batch_sum_before(wanted);
    uint firsts = taken & 0xFFFFu, all = firsts + (taken >> 16), begin = 0u;
    if (batch_lane() == 0u && all != 0u)
        begin = atomicAdd(counters[counter], all);
    if (has_shuffle)
        begin = subgroupShuffle(begin, batch_begin());
    return uvec2(begin + (before & 0xFFFFu), begin + firsts + (before >> 16));
}

uint take_slot(uint counter, bool wanted)
{
    return take_slots(counter, wanted, false).x;
}

#endif
