/* What the files that pack objects share. */
#ifndef LR_RENDER_PACK_INTERNAL_H
#define LR_RENDER_PACK_INTERNAL_H

#include "bvh/bvh.h"
#include "render/pack.h"

/* In scenes with trees, a kind with more members than this has one. */
#define LR_LISTED_MAX 6

/* In the order of the primitives' numbers; LR_SPEC_SPHERES + kind tells whether there are any, and
 * LR_SPEC_SPHERE_TREE + kind whether they have a tree. Meshes are not in these lists. */
typedef enum lr_list_kind {
    LR_SPHERES,
    LR_FLATS,
    LR_ELLIPSOIDS,
    LR_BOXES,
    LR_CONES,
    LR_PLANES,
    LR_LIST_COUNT,
    LR_MESHES,
} lr_list_kind;

typedef struct lr_primitive {
    union {
        struct gpu_sphere sphere;
        struct gpu_plane plane;
        struct gpu_flat flat;
        struct gpu_solid solid;
    } record;
    lr_list_kind list;
    bool encloses; /* a medium, if its material transmits */
    bool sided;    /* has a front and a back */
    vec4 ball;     /* holds it, if it is bounded: centre, radius squared */
    lr_bvh_box box;
} lr_primitive;

/* pack_camera.c: LR_GPU_FILTER_TENT, ...; 0: the box, which needs no kernel's help. */
uint32_t lr_pack_filter(const lr_scene *scene, const lr_settings *settings);

lr_transform lr_pack_inverse(const lr_transform *t);
vec4 lr_pack_row(const double row[4], double scale);

/* pack_shapes.c. False when the object is too thin. */
bool lr_pack_shape(const lr_scene *scene, const lr_object *object, lr_primitive *out);

/* Whether a point lies inside a solid primitive, in double from the object's own description. */
bool lr_pack_contains(const lr_object *object, lr_vec3 point);

/* pack_lists.c: the records kind by kind, behind them the balls around the bounded ones or the
 * trees. Planes come last. */
lr_status lr_pack_lists(const lr_primitive *primitives, uint32_t count, lr_packed_scene *packed,
                        lr_error *error);

/* Packs a hierarchy's nodes; the number of its first primitive is `first`. Returns the row of the
 * root, or UINT32_MAX when memory is out. */
uint32_t lr_pack_tree(lr_packed_scene *packed, const lr_bvh *bvh, uint32_t first);

/* A hierarchy with leaves of at most `leaf_size`, unless the settings say otherwise. It lives until
 * the scene is packed. */
lr_status lr_pack_build(const lr_packed_scene *packed, const lr_bvh_box *boxes, uint32_t count,
                        uint32_t leaf_size, const lr_bvh **bvh, lr_error *error);

/* Notes where something in a tree is; adds up such notes; lays the cells around most of what was
 * noted: within two standard deviations of the mean. */
void lr_pack_place(lr_places *places, const lr_bvh_box *box);
void lr_pack_add_places(lr_places *places, const lr_places *more);
void lr_pack_cells(lr_packed_scene *packed);

/* pack_repeated.c: whether thousands of a tree's boxes are the same; and which primitives another
 * one with the same box hides. False when memory is out. */
bool lr_pack_has_heaps(const lr_bvh *bvh);
typedef bool (*lr_pack_hides)(const void *context, uint32_t first, uint32_t later);
bool lr_pack_find_repeated(const lr_bvh_box *boxes, uint32_t count, lr_pack_hides hides,
                           const void *context, bool *hidden);

/* Widens *reach, the greatest coordinate in a tree, by a box. */
void lr_pack_reach(float *reach, const lr_bvh_box *box);

/* pack_meshes.c: the meshes, and every object that shows one as an instance. instances[i] becomes
 * the instance of object i. `flags` are the objects'. */
lr_status lr_pack_meshes(const lr_scene *scene, const uint32_t *flags, uint32_t *instances,
                         lr_packed_scene *packed, lr_error *error);

/* bake_sky.c: the sky's picture, whose texels the caller frees, and the sun's radiance and solid
 * angle. `axes` point right, up and forward, as those of gpu_environment. False when memory is out.
 */
bool lr_bake_sky(const lr_scene *scene, const lr_vec3 axes[3], lr_texture *picture, lr_color *sun,
                 double *solid_angle);

/* pack_maps.c: the pictures of materials that are not their colour. */
lr_status lr_pack_maps(const lr_scene *scene, lr_packed_scene *packed, lr_error *error);

/* pack_emitters.c: for paths, what shines, how it is chosen, and how likely that is for each
 * object. */
lr_status lr_pack_emitters(const lr_scene *scene, const lr_primitive *primitives,
                           lr_packed_scene *packed, lr_error *error);

/* pack_vertices.c: the vertices of the meshes that are shown and have more than positions, those of
 * meshes with one user in world space. vertex_rows[i] becomes where mesh i's begin. False when
 * memory is out. */
bool lr_pack_vertices(const lr_scene *scene, const uint32_t *users, const uint32_t *shown_by,
                      uint32_t *vertex_rows, lr_packed_scene *packed);
bool lr_mesh_has_attributes(const lr_mesh *mesh);

#endif
