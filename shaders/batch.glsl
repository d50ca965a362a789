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

// Adds n of each invocation to a counter.
#define COUNT(counter, n)                                                                          \
    {                                                                                              \
        uint batch_count = batch_sum(n);                                                           \
        if (batch_lane() == 0u && batch_count != 0u)                                               \
            atomicAdd(counter, batch_count);                                                       \
    }

// Gives each invocation that wants one a slot of its own of those that `counter` counts.
#define TAKE_SLOT(counter, want, slot)                                                             \
    {                                                                                              \
        uint taken = batch_sum(uint(want)), first_slot = 0u;                                       \
        if (batch_lane() == 0u && taken != 0u)                                                     \
            first_slot = atomicAdd(counter, taken);                                                \
        if (has_shuffle)                                                                           \
            first_slot = subgroupShuffle(first_slot, batch_begin());                               \
        slot = first_slot + batch_sum_before(uint(want));                                          \
    }

#endif
