/* What the vertices of paths choose their light source from: the lights, and whatever shines and
 * can be sampled by area. The rest, such as cones, lights what happens to meet it. */
#ifndef LR_RENDER_EMITTERS_H
#define LR_RENDER_EMITTERS_H

#include "render/light_map.h"
#include "render/pack_internal.h"

typedef struct lr_emitter {
    struct gpu_emitter record;  /* but for the probabilities */
    struct gpu_emitter_map map; /* of the picture of its light, if `mapped` */
    bool mapped;
    double area; /* square metres; 0 of a light */
    double power;
    uint32_t object; /* LR_NONE: one of the lights, or the background */
} lr_emitter;

/* Those of one object stand together. */
typedef struct lr_emitters {
    const lr_scene *scene;
    lr_emitter *items; /* owned */
    uint32_t count, capacity;
    lr_light_map *light_maps; /* of each texture, once it is needed; only while they are found */
    bool no_memory;
} lr_emitters;

/* All of the scene's, at most LR_CHOICES_MAX: what is too many, or too small or large for floats,
 * is left out. primitives[i] is object i. False when memory is out; the caller frees the items. */
bool lr_emitters_find(const lr_scene *scene, const lr_primitive *primitives,
                      const lr_packed_scene *packed, lr_emitters *list);

#endif
