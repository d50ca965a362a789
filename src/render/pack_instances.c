/* The trees of meshes in the scene, and the objects that show a mesh which others show too. */
#include "render/pack_meshes.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

static struct gpu_instance *add_instance(mesh_packing *m, const lr_transform *to_mesh,
                                         const mesh_tree *tree, uint32_t nodes)
{
    struct gpu_instance *instance = &m->instances[m->instance_count++];
    *instance = (struct gpu_instance){.row0 = lr_pack_row(to_mesh->m[0], 1),
                                      .row1 = lr_pack_row(to_mesh->m[1], 1),
                                      .row2 = lr_pack_row(to_mesh->m[2], 1),
                                      .nodes = nodes,
                                      .reach = tree->reach};
    return instance;
}

/* The box in the world of what an object shows. */
static lr_bvh_box box_in_world(const lr_bvh_node *root, const lr_transform *to_world)
{
    lr_bvh_box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (int i = 0; i < 8; i++) {
        lr_vec3 p = {i & 1 ? root->max[0] : root->min[0], i & 2 ? root->max[1] : root->min[1],
                     i & 4 ? root->max[2] : root->min[2]};
        p = lr_transform_point(to_world, p);
        const float q[3] = {(float)p.x, (float)p.y, (float)p.z};
        for (int k = 0; k < 3; k++) {
            box.min[k] = fminf(box.min[k], q[k]);
            box.max[k] = fmaxf(box.max[k], q[k]);
        }
    }
    return box;
}

/* Packs the trees' nodes and makes the instances and the boxes around them. */
static bool place_meshes(mesh_packing *m, const mesh_tree *trees, uint32_t *instances,
                         lr_bvh_box *boxes)
{
    const lr_scene *scene = m->scene;
    const mesh_tree *world = &trees[scene->mesh_count];
    const lr_transform identity = lr_transform_identity();
    uint32_t *roots = lr_alloc(scene->mesh_count, sizeof *roots);
    bool fits = roots;
    if (fits && world->bvh) {
        uint32_t root = lr_pack_tree(m->packed, world->bvh, world->first);
        fits = root != UINT32_MAX;
        boxes[m->instance_count] = box_in_world(world->bvh->nodes, &identity);
        add_instance(m, &identity, world, root);
    }
    for (uint32_t i = 0; i < scene->mesh_count && fits; i++)
        if (trees[i].bvh) {
            roots[i] = lr_pack_tree(m->packed, trees[i].bvh, trees[i].first);
            fits = roots[i] != UINT32_MAX;
        }
    for (uint32_t i = 0; i < scene->object_count && fits; i++) {
        const lr_object *object = &scene->objects[i];
        if (object->kind != LR_MESH || !trees[object->mesh].bvh)
            continue;
        const mesh_tree *tree = &trees[object->mesh];
        lr_transform to_mesh = lr_pack_inverse(&object->to_world);
        instances[i] = m->instance_count;
        boxes[m->instance_count] = box_in_world(tree->bvh->nodes, &object->to_world);
        lr_pack_place(&m->packed->places, &boxes[m->instance_count]);
        struct gpu_instance *instance = add_instance(m, &to_mesh, tree, roots[object->mesh]);
        instance->object = i;
        instance->flags = m->object_flags[i];
    }
    free(roots);
    return fits;
}

/* The instances in a list, or in a tree if they are many. instances[] is brought to their order. */
static lr_status list_instances(mesh_packing *m, const lr_bvh_box *boxes, uint32_t *instances,
                                lr_error *error)
{
    uint32_t count = m->instance_count;
    gpu_list *list = &m->packed->frame.instances;
    bool tree = count > LR_LISTED_MAX;
    const lr_bvh *bvh = NULL;
    lr_status status = LR_OK;
    for (uint32_t i = 0; i < count && tree; i++)
        lr_pack_reach(&m->packed->frame.reach, &boxes[i]);
    if (tree)
        status = lr_pack_build(m->packed, boxes, count, 1, &bvh, error);
    uint32_t *place = lr_alloc(count, sizeof *place);
    if (!status && !place)
        status = lr_pack_no_memory(error);
    *list = (gpu_list){.base = m->packed->row_count, .end = count};
    for (uint32_t i = 0; i < count && !status; i++) {
        uint32_t from = tree ? bvh->order[i] : i;
        place[from] = i;
        if (lr_pack_rows(m->packed, &m->instances[from], sizeof *m->instances / 16) == UINT32_MAX)
            status = lr_pack_no_memory(error);
    }
    for (uint32_t i = 0; i < m->scene->object_count && !status; i++)
        if (m->scene->objects[i].kind == LR_MESH && count)
            instances[i] = place[instances[i]];
    if (tree && !status) {
        list->nodes = lr_pack_tree(m->packed, bvh, 0);
        m->packed->constants[LR_SPEC_INSTANCE_TREE] = 1;
        if (list->nodes == UINT32_MAX)
            status = lr_pack_no_memory(error);
    }
    free(place);
    return status;
}

lr_status lr_pack_instances(mesh_packing *m, const mesh_tree *trees, uint32_t *instances,
                            lr_error *error)
{
    const lr_scene *scene = m->scene;
    lr_packed_scene *packed = m->packed;
    const mesh_tree *world = &trees[scene->mesh_count];
    bool shared = false;
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        shared = shared || trees[i].bvh;
    packed->constants[LR_SPEC_INSTANCES] = shared;
    if (!shared && world->bvh) {
        packed->frame.reach = fmaxf(packed->frame.reach, world->reach);
        packed->frame.triangles.nodes = lr_pack_tree(packed, world->bvh, world->first);
        return packed->frame.triangles.nodes == UINT32_MAX ? lr_pack_no_memory(error) : LR_OK;
    }
    lr_bvh_box *boxes = lr_alloc(scene->object_count + 1ull, sizeof *boxes);
    lr_status status = LR_OK;
    if (boxes && place_meshes(m, trees, instances, boxes))
        status = list_instances(m, boxes, instances, error);
    else
        status = lr_pack_no_memory(error);
    free(boxes);
    return status;
}
