// The way of a packet of rays through a tree. The boxes are tested so that they are met whenever the
// exact test of something inside could hit: they change speed, never the hit.
#ifndef TREE_GLSL
#define TREE_GLSL

#include "packet.glsl"

// Whether there is a tree in world space.
const bool has_world_tree = has_sphere_tree || has_flat_tree || has_ellipsoid_tree || has_box_tree ||
                            has_cone_tree || has_instance_tree || (has_meshes && !has_instances);

// 1 / direction, and the origin times it, moved forward and back by what all rounding may amount to.
vec3 slab_inverse[RAYS], slab_from[RAYS], slab_to[RAYS];
vec3 slab_slack[RAYS]; // half of that rounding, in distances along the ray

// Readies ray k for boxes whose coordinates go up to `reach`.
void slab_ready(uint k, float reach)
{
    vec3 o = ray_o[k], d = ray_d[k], a = abs(o);
    vec3 inverse = vec3(ex_rcp(away_from_zero(d.x)), ex_rcp(away_from_zero(d.y)),
                        ex_rcp(away_from_zero(d.z)));
    float slack = (reach + max(a.x, max(a.y, a.z))) * LR_BOX_SLACK;
    slab_slack[k] = 0.5 * slack * abs(inverse);
    slab_inverse[k] = inverse;
    slab_from[k] = (o + slack) * inverse;
    slab_to[k] = (o - slack) * inverse;
}

// The bits of the distance at which ray k enters a box, at least 0, or LR_BOX_MISSED. Slabs (Kay and
// Kajiya, 1986). Comparing the bits of floats as integers is right wherever the result matters:
// negative numbers come out in the wrong order, but negative.
int slab_entry(uint k, vec3 low, vec3 high)
{
    vec3 t0 = low * slab_inverse[k] - slab_from[k], t1 = high * slab_inverse[k] - slab_to[k];
    ivec3 b0 = floatBitsToInt(t0), b1 = floatBitsToInt(t1);
    ivec3 near = min(b0, b1), far = max(b0, b1);
    int first = max(max(near.x, near.y), max(near.z, 0));
    int last = min(min(far.x, far.y), min(far.z, floatBitsToInt(ray_limit[k])));
    return first <= last ? first : LR_BOX_MISSED;
}

// Whether a driver let all loops run to their ends (docs/drivers.md).
bool finished = true;

// What a packet puts aside lies in the registers of all its invocations: entry i in register i / 8 of
// invocation i modulo 8. A memory of its own would be written invocation by invocation.
const uint stack_registers = uint(LR_TREE_DEPTH / LR_BATCH);

#if RAYS > 1
#define STACK_SIZE stack_registers
#define PUSH(stack, depth, wanted, value)                                                          \
    {                                                                                              \
        uint pushed = value, mine = (wanted) ? depth - batch_lane() : 0xFFFFFFFFu;                 \
        [[unroll]] for (uint r = 0u; r < stack_registers; r++)                                     \
            stack[r] = mine == r * uint(LR_BATCH) ? pushed : stack[r];                             \
    }
#define POP(stack, depth, value)                                                                   \
    {                                                                                              \
        uint bank = 0u;                                                                            \
        [[unroll]] for (uint r = 0u; r < stack_registers; r++)                                     \
            bank = (depth >> 3) == r ? stack[r] : bank;                                            \
        value = share(bank, batch_begin() + (depth & uint(LR_BATCH - 1)));                         \
    }
#else
#define STACK_SIZE LR_TREE_DEPTH
#define PUSH(stack, depth, wanted, value)                                                          \
    if (wanted)                                                                                    \
        stack[depth] = value;
#define POP(stack, depth, value) value = stack[depth];
#endif

// Visits the leaves of the tree with the given root that some ray of the packet meets, nearer ones
// roughly first, and runs `test` on each primitive i in them; `valid` is false where i is none. An
// inner node puts its inner children aside, and its leaves are tested at once: so no round of either
// loop is in vain, which matters where every branch is paid for. Loops end at their bottom, as
// lavapipe executes what follows a break once more. An invocation that has left the inner loop knows
// only what each round makes of the last one's value, as lavapipe goes on computing all else for it
// while others are in the loop (docs/drivers.md): so `next` is the root again at the end, and leaves
// are kept though there are none when a round begins.
// Behind the outer loop a compiler knows that `next` is the root, but not whether a driver
// ended the loop by force.
#define VISIT_TREE(root, test)                                                                     \
    {                                                                                              \
        uint stack[STACK_SIZE];                                                                    \
        uint depth = 0u, next = root;                                                              \
        for (;;) {                                                                                 \
            uint leaf0 = 0u, leaf1 = 0u;                                                           \
            for (;;) {                                                                             \
                gpu_node node = joint_node(next);                                                  \
                int near0 = LR_BOX_MISSED, near1 = LR_BOX_MISSED;                                  \
                EACH_RAY                                                                           \
                {                                                                                  \
                    near0 = min(near0, slab_entry(k, node.min0, node.max0));                       \
                    near1 = min(near1, slab_entry(k, node.min1, node.max1));                       \
                }                                                                                  \
                near0 = joint_min(near0);                                                          \
                near1 = joint_min(near1);                                                          \
                bool met0 = near0 != LR_BOX_MISSED, met1 = near1 != LR_BOX_MISSED;                 \
                bool is_leaf0 = node.child0 >= LR_NODE_LEAF, is_leaf1 = node.child1 >= LR_NODE_LEAF; \
                leaf0 = met0 && is_leaf0 ? node.child0 : leaf0;                                    \
                leaf1 = met1 && is_leaf1 ? node.child1 : leaf1;                                    \
                bool inner0 = met0 && !is_leaf0, inner1 = met1 && !is_leaf1;                       \
                bool first0 = inner0 && !(inner1 && near1 < near0);                                \
                bool neither = !inner0 && !inner1;                                                 \
                PUSH(stack, depth, inner0 && inner1, first0 ? node.child1 : node.child0)           \
                depth += inner0 && inner1 ? 1u : 0u;                                               \
                bool done = neither && depth == 0u;                                                \
                depth -= neither && !done ? 1u : 0u;                                               \
                next = first0 ? node.child0 : node.child1;                                         \
                uint popped;                                                                       \
                POP(stack, depth, popped)                                                          \
                next = neither ? (done ? root : popped) : next;                                    \
                if (next == root || (leaf0 | leaf1) != 0u)                                         \
                    break;                                                                         \
            }                                                                                      \
            for (;;) {                                                                             \
                uint leaf = leaf0 != 0u ? leaf0 : leaf1;                                           \
                bool valid = leaf != 0u;                                                           \
                uint i = leaf & LR_NODE_FIRST;                                                     \
                test;                                                                              \
                bool last = ((leaf >> LR_NODE_COUNT_SHIFT) & 7u) == 0u;                            \
                uint rest = last ? 0u : leaf - (1u << LR_NODE_COUNT_SHIFT) + 1u;                   \
                leaf1 = leaf0 != 0u ? leaf1 : rest;                                                \
                leaf0 = leaf0 != 0u ? rest : 0u;                                                   \
                if ((leaf0 | leaf1) == 0u)                                                         \
                    break;                                                                         \
            }                                                                                      \
            if (next == root)                                                                      \
                break;                                                                             \
        }                                                                                          \
        finished = finished && hidden(next) == root;                                               \
    }

// Runs `test` on each primitive i of a list that is too short for a tree.
#define VISIT_LIST(list, test)                                                                     \
    for (uint i = list.begin;;) {                                                                  \
        const bool valid = true;                                                                   \
        test;                                                                                      \
        i++;                                                                                       \
        if (i >= hidden(list.end))                                                                 \
            break;                                                                                 \
    }

// A kind of primitives, by its tree or one after the other.
#define VISIT_KIND(has, has_tree, list, test)                                                      \
    if (has_tree) {                                                                                \
        VISIT_TREE(hidden(list.nodes), test)                                                       \
    } else if (has) {                                                                              \
        VISIT_LIST(list, test)                                                                     \
    }

#endif
