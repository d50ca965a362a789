/* What the files that pack meshes share. */
#ifndef LR_RENDER_PACK_MESHES_H
#define LR_RENDER_PACK_MESHES_H

#include "render/pack_internal.h"

/* What all the triangles' records come from. */
typedef struct mesh_packing {
    const lr_scene *scene;
    const uint32_t *object_flags;
    lr_packed_scene *packed;
    uint32_t *users;             /* of each mesh: how many objects show it */
    uint32_t *shown_by;          /* the last of them */
    uint32_t *vertex_rows;       /* where its vertices' rows begin, if it has any */
    struct gpu_corners *corners; /* of all triangles, in the order of their numbers */
    struct gpu_instance *instances;
    uint32_t instance_count, triangle_count;
} mesh_packing;

/* The tree of some meshes. */
typedef struct mesh_tree {
    const lr_bvh *bvh;
    uint32_t first; /* number of its first triangle */
    float reach;
} mesh_tree;

lr_status lr_pack_no_memory(lr_error *error);

/* pack_instances.c: packs the trees' nodes, trees[mesh_count] being the world's, and what shows the
 * others; instances[i] becomes the instance of object i. Where no mesh is shown several times, rays
 * go through the world's tree without further ado. */
lr_status lr_pack_instances(mesh_packing *m, const mesh_tree *trees, uint32_t *instances,
                            lr_error *error);

#endif
