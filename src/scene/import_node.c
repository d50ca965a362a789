/* Objects: each mesh of each node is one, with the node's transform. */
#include "scene/import_internal.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

typedef struct visit {
    const struct aiNode *node;
    lr_transform to_world; /* of the nodes around it */
    uint32_t depth;
} visit;

typedef struct visits {
    visit *items;
    uint32_t count, capacity;
} visits;

static lr_transform transform_of(const struct aiMatrix4x4 *m)
{
    return (lr_transform){{{(double)m->a1, (double)m->a2, (double)m->a3, (double)m->a4},
                           {(double)m->b1, (double)m->b2, (double)m->b3, (double)m->b4},
                           {(double)m->c1, (double)m->c2, (double)m->c3, (double)m->c4}}};
}

static bool is_identity(const lr_transform *t)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++)
            if (t->m[i][j] != (i == j))
                return false;
    return true;
}

static lr_status add_object(lr_import *import, const struct aiNode *node, uint32_t index,
                            const lr_transform *to_world)
{
    const struct aiScene *from = import->scene;
    char name[80];
    lr_import_shown(name, sizeof name, node->mName.data);
    if (index >= from->mNumMeshes)
        return lr_import_note(import, "node \"%s\": it names mesh %u, which there is not", name,
                              index);
    if (import->meshes[index] == LR_NONE) {
        lr_status status = lr_import_mesh(import, index, &import->meshes[index]);
        if (status)
            return status;
    }
    if (import->meshes[index] == LR_IMPORT_NOTHING)
        return LR_OK;
    lr_bounds world = lr_bounds_transform(&import->bounds[index], to_world);
    if (!lr_bounds_usable(&world))
        return lr_import_note(import, "node \"%s\": left out, it reaches beyond 1e12 metres", name);
    uint32_t material;
    lr_status status = lr_import_material(import, from->mMeshes[index]->mMaterialIndex, &material);
    if (status)
        return status;
    if (import->builder->scene->object_count >= LR_OBJECTS_MAX)
        return lr_fail(import->error, LR_ERROR_FILE,
                       "%s: more than %d objects: join its meshes where it was made", import->shown,
                       LR_OBJECTS_MAX);
    lr_object *object = lr_scene_add_object(import->builder);
    if (!object)
        return lr_import_no_memory(import);
    *object = (lr_object){.kind = LR_MESH,
                          .material = material,
                          .shadow = true,
                          .transformed = !is_identity(to_world),
                          .to_world = *to_world,
                          .mesh = import->meshes[index]};
    lr_bounds_add(&import->world, &world);
    return LR_OK;
}

/* Adds the node's objects and puts its children on the stack, the first on top. */
static lr_status visit_node(lr_import *import, const visit *at, visits *stack)
{
    const struct aiNode *node = at->node;
    char name[80];
    lr_import_shown(name, sizeof name, node->mName.data);
    lr_transform own = transform_of(&node->mTransformation);
    const struct aiMatrix4x4 *m = &node->mTransformation;
    lr_transform to_world = lr_transform_multiply(at->to_world, own);
    if (!lr_transform_usable(&to_world) || m->d1 != 0 || m->d2 != 0 || m->d3 != 0 || m->d4 != 1)
        return lr_import_note(import,
                              "node \"%s\": left out with all below it, its transform flattens it "
                              "or is extreme",
                              name);
    if (node->mNumMeshes > 0 && !node->mMeshes)
        return LR_OK;
    for (uint32_t i = 0; i < node->mNumMeshes; i++) {
        lr_status status = add_object(import, node, node->mMeshes[i], &to_world);
        if (status)
            return status;
    }
    if (at->depth > LR_IMPORT_DEPTH_MAX) /* assimp may put a root of its own on top */
        return lr_fail(import->error, LR_ERROR_FILE, "%s: its nodes nest more than %d deep",
                       import->shown, LR_IMPORT_DEPTH_MAX);
    for (uint32_t i = node->mChildren ? node->mNumChildren : 0; i-- > 0;) {
        if (!node->mChildren[i])
            continue;
        if (!lr_array_reserve((void **)&stack->items, stack->count, &stack->capacity,
                              sizeof *stack->items))
            return lr_import_no_memory(import);
        stack->items[stack->count++] = (visit){node->mChildren[i], to_world, at->depth + 1};
    }
    return LR_OK;
}

lr_status lr_import_nodes(lr_import *import)
{
    visits stack = {0};
    lr_status status = LR_OK;
    uint32_t visited = 0;
    visit next = {import->scene->mRootNode, lr_transform_identity(), 0};
    for (;;) {
        status = visit_node(import, &next, &stack);
        if (!status && ++visited % 64 == 0)
            status = lr_import_progress(import, 0.6);
        if (!status && visited == LR_IMPORT_NODES_MAX)
            status = lr_fail(import->error, LR_ERROR_FILE, "%s: more than %u nodes", import->shown,
                             LR_IMPORT_NODES_MAX);
        if (status || stack.count == 0)
            break;
        next = stack.items[--stack.count];
    }
    free(stack.items);
    return status;
}
