// Rays that go through a tree together: RAYS of each invocation and, if that is more than one, those of
// all invocations of its batch. The kernel defines RAYS before it includes this: 1 where every
// invocation goes its own way, more where a subgroup is one batch, so that a packet's control flow is
// uniform and what it loads is shared.
#ifndef PACKET_GLSL
#define PACKET_GLSL

#include "batch.glsl"
#include "intersect.glsl"

const bool joint = RAYS > 1;

#include "joint.glsl"

// Runs what follows for each ray k of the invocation, without a loop at run time.
#define EACH_RAY [[unroll]] for (uint k = 0u; k < uint(RAYS); k++)

vec3 ray_o[RAYS], ray_d[RAYS];
float ray_inv_a[RAYS]; // 1 / (d . d)
// The distance within which a ray still looks for hits; -1: it is done.
float ray_limit[RAYS];

// Ray k of the invocation in the work of a dispatch: neighbouring invocations have neighbouring rays.
uint packet_index(uint k)
{
    uint invocation = queue_index(), lane = joint ? batch_lane() : 0u;
    return (invocation - lane) * uint(RAYS) + k * (joint ? uint(LR_BATCH) : 1u) + lane;
}

int joint_min(int x)
{
    if (joint) {
        x = min(x, int(neighbour(uint(x), 1u)));
        x = min(x, int(neighbour(uint(x), 2u)));
        x = min(x, int(neighbour(uint(x), 4u)));
    }
    return x;
}

#endif
