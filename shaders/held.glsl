// The records of a scene of few primitives, in registers for all the rays that an invocation takes:
// kernels that run with LR_SPEC_FEW load them before all branches, where lavapipe loads a row once for all
// invocations.
#ifndef HELD_GLSL
#define HELD_GLSL

#include "bindings.glsl"

gpu_plane held_planes[LR_FEW_PLANES];
gpu_sphere held_spheres[LR_FEW_SPHERES];
gpu_flat held_flats[LR_FEW_FLATS];
gpu_solid held_solids[LR_FEW_SOLIDS];

// Runs `test(k)` for each k that there is; k is a constant, so that the arrays stay in registers.
#define HELD_ONE(count, k, test)                                                                   \
    if (count > k) {                                                                               \
        test(k)                                                                                    \
    }
#define HELD_FOUR(count, k, test)                                                                  \
    HELD_ONE(count, k + 0u, test)                                                                  \
    HELD_ONE(count, k + 1u, test)                                                                  \
    HELD_ONE(count, k + 2u, test)                                                                  \
    HELD_ONE(count, k + 3u, test)
#define EACH_HELD_PLANE(test) HELD_FOUR(few_planes, 0u, test)
#define EACH_HELD_SPHERE(test)                                                                     \
    HELD_FOUR(few_spheres, 0u, test)                                                               \
    HELD_FOUR(few_spheres, 4u, test)
#define EACH_HELD_FLAT(test)                                                                       \
    HELD_FOUR(few_flats, 0u, test)                                                                 \
    HELD_FOUR(few_flats, 4u, test)                                                                 \
    HELD_FOUR(few_flats, 8u, test)                                                                 \
    HELD_FOUR(few_flats, 12u, test)
#define EACH_HELD_SOLID(test)                                                                      \
    HELD_FOUR(few_solids, 0u, test)                                                                \
    HELD_FOUR(few_solids, 4u, test)

#endif
