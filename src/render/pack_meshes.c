/* Meshes and the objects that show them. The meshes that one object shows are brought into the
 * world and stand in one tree together; a mesh that several show has a tree in its own space. */
#include "render/pack_internal.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

/* Small leaves are faster, great ones save memory where there are many triangles. */
#define LEAF_SIZE 2
#define LEAF_SIZE_OF_MANY 4
#define MANY 200000

/* A triangle on its way into a tree. */
typedef struct facet {
    float corners[9];
    uint32_t mesh, triangle, object;
    bool mirrored;
} facet;

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

static bool has_attributes(const lr_mesh *mesh)
{
    return mesh->normals || mesh->uvs || mesh->colors;
}

static uint32_t pack_unit(double x)
{
    return (uint32_t)(floor(x * 32767 + 0.5) + 32767);
}

static double sign_of(double x)
{
    return x < 0 ? -1 : 1;
}

/* The other way round than unpack_normal() in mesh.glsl. */
static uint32_t pack_normal(const float *n)
{
    double sum = fabs((double)n[0]) + fabs((double)n[1]) + fabs((double)n[2]);
    double x = n[0] / sum, y = n[1] / sum;
    if (n[2] < 0) {
        double folded = (1 - fabs(y)) * sign_of(x);
        y = (1 - fabs(x)) * sign_of(y);
        x = folded;
    }
    return pack_unit(x) | pack_unit(y) << 16;
}

static uint32_t pack_color(const float *c)
{
    uint32_t bits = 0;
    for (int i = 0; i < 3; i++)
        bits |= (uint32_t)(sqrt(fmin(fmax(c[i], 0), 1)) * 1023 + 0.5) << 10 * i;
    return bits;
}

/* The vertex's normal, in the world if the mesh is brought there by the inverse of `to_mesh`. */
static uint32_t vertex_normal(const lr_mesh *mesh, uint32_t vertex, const lr_transform *to_mesh)
{
    const float *n = &mesh->normals[3 * (size_t)vertex];
    if (!to_mesh)
        return pack_normal(n);
    lr_vec3 turned = {n[0], n[1], n[2]};
    turned = lr_vec3_normalize(lr_transform_normal(to_mesh, turned));
    return pack_normal((const float[3]){(float)turned.x, (float)turned.y, (float)turned.z});
}

static bool pack_vertices(mesh_packing *m)
{
    for (uint32_t i = 0; i < m->scene->mesh_count; i++) {
        const lr_mesh *mesh = &m->scene->meshes[i];
        m->vertex_rows[i] = m->packed->row_count;
        if (!m->users[i] || !has_attributes(mesh))
            continue;
        m->packed->constants[LR_SPEC_CORNERS] = 1;
        if (!lr_pack_reserve(m->packed, mesh->vertex_count))
            return false;
        const lr_object *object = &m->scene->objects[m->shown_by[i]];
        bool in_world = m->users[i] == 1 && object->transformed;
        lr_transform to_mesh = lr_pack_inverse(&object->to_world);
        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            struct gpu_vertex vertex = {
                .normal = mesh->normals ? vertex_normal(mesh, v, in_world ? &to_mesh : NULL) : 0,
                .u = mesh->uvs ? mesh->uvs[2 * (size_t)v] : 0,
                .v = mesh->uvs ? mesh->uvs[2 * (size_t)v + 1] : 0,
                .color = mesh->colors ? pack_color(&mesh->colors[3 * (size_t)v]) : 0,
            };
            lr_pack_rows(m->packed, &vertex, 1);
        }
    }
    return true;
}

static bool is_mirrored(const lr_transform *t)
{
    lr_vec3 x = {t->m[0][0], t->m[1][0], t->m[2][0]}, y = {t->m[0][1], t->m[1][1], t->m[2][1]};
    lr_vec3 z = {t->m[0][2], t->m[1][2], t->m[2][2]};
    return lr_vec3_dot(lr_vec3_cross(x, y), z) < 0;
}

/* The vertices of a triangle, counter-clockwise as seen from outside after the transform. */
static void facet_vertices(const lr_mesh *mesh, uint32_t triangle, bool mirrored,
                           uint32_t vertices[3])
{
    const uint32_t *v = &mesh->triangles[3 * (size_t)triangle];
    vertices[0] = v[0];
    vertices[1] = v[mirrored ? 2 : 1];
    vertices[2] = v[mirrored ? 1 : 2];
}

/* The corners of a triangle under a transform; false when they span no area. */
static bool place_facet(const lr_mesh *mesh, const uint32_t vertices[3], const lr_transform *t,
                        float corners[9])
{
    lr_vec3 p[3];
    for (int i = 0; i < 3; i++) {
        const float *v = &mesh->positions[3 * (size_t)vertices[i]];
        p[i] = (lr_vec3){v[0], v[1], v[2]};
        if (t)
            p[i] = lr_transform_point(t, p[i]);
        corners[3 * i] = (float)p[i].x;
        corners[3 * i + 1] = (float)p[i].y;
        corners[3 * i + 2] = (float)p[i].z;
    }
    lr_vec3 q[3];
    for (int i = 0; i < 3; i++)
        q[i] = (lr_vec3){corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]};
    lr_vec3 n = lr_vec3_cross(lr_vec3_sub(q[1], q[0]), lr_vec3_sub(q[2], q[0]));
    return lr_vec3_dot(n, n) > 0;
}

/* Adds a mesh's triangles, those without an area left out. Returns the new count. */
static uint32_t add_facets(const mesh_packing *m, uint32_t mesh, uint32_t object,
                           const lr_transform *t, facet *facets, uint32_t count)
{
    const lr_mesh *from = &m->scene->meshes[mesh];
    bool mirrored = t && is_mirrored(t);
    for (uint32_t i = 0; i < from->triangle_count; i++) {
        facet *f = &facets[count];
        uint32_t vertices[3];
        facet_vertices(from, i, mirrored, vertices);
        *f = (facet){.mesh = mesh, .triangle = i, .object = object, .mirrored = mirrored};
        count += place_facet(from, vertices, t, f->corners);
    }
    return count;
}

static lr_bvh_box box_of(const facet *f)
{
    lr_bvh_box box;
    for (int i = 0; i < 3; i++) {
        const float *c = &f->corners[i];
        box.min[i] = fminf(c[0], fminf(c[3], c[6]));
        box.max[i] = fmaxf(c[0], fmaxf(c[3], c[6]));
    }
    return box;
}

static uint32_t attribute_flags(const lr_mesh *mesh)
{
    return (mesh->normals ? LR_FLAG_SMOOTH : 0) | (mesh->uvs ? LR_FLAG_UV : 0) |
           (mesh->colors ? LR_FLAG_COLORS : 0);
}

static bool pack_facet(mesh_packing *m, const facet *f, bool shared)
{
    const lr_mesh *mesh = &m->scene->meshes[f->mesh];
    const float *c = f->corners;
    struct gpu_triangle record = {
        .a = {c[0], c[1], c[2]},
        .object = shared ? 0 : f->object,
        .b = {c[3], c[4], c[5]},
        .order = f->triangle,
        .c = {c[6], c[7], c[8]},
        .flags = attribute_flags(mesh) | (shared ? 0 : m->object_flags[f->object]),
    };
    if (m->corners && has_attributes(mesh)) {
        uint32_t v[3], row = m->vertex_rows[f->mesh];
        facet_vertices(mesh, f->triangle, f->mirrored, v);
        m->corners[m->triangle_count] = (struct gpu_corners){row + v[0], row + v[1], row + v[2], 0};
    }
    m->triangle_count++;
    return lr_pack_rows(m->packed, &record, sizeof record / 16) != UINT32_MAX;
}

/* A tree over facets, whose records must come right behind those of the trees before. */
static lr_status build_facets(lr_packed_scene *packed, const facet *facets, uint32_t count,
                              bool shared, float *reach, lr_bvh **bvh, lr_error *error)
{
    lr_bvh_box *boxes = lr_alloc_large(count, sizeof *boxes);
    if (!boxes)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for %u triangles", count);
    for (uint32_t i = 0; i < count; i++) {
        boxes[i] = box_of(&facets[i]);
        lr_pack_reach(reach, &boxes[i]);
        if (!shared)
            lr_pack_place(packed, &boxes[i]);
    }
    uint32_t leaf_size = count > MANY ? LEAF_SIZE_OF_MANY : LEAF_SIZE;
    lr_status status = lr_pack_build(packed, boxes, count, leaf_size, bvh, error);
    free(boxes);
    return status;
}

/* The records of one tree's triangles, and the tree behind the last of them. */
typedef struct mesh_tree {
    lr_bvh *bvh;
    uint32_t first; /* number of its first triangle */
    float reach;
} mesh_tree;

static lr_status no_memory(lr_error *error)
{
    return lr_fail(error, LR_ERROR_MEMORY, "out of memory for the scene's meshes");
}

/* Builds the tree over `count` facets and packs their records in the order of its leaves. */
static lr_status pack_facets(mesh_packing *m, const facet *facets, uint32_t count, bool shared,
                             mesh_tree *tree, lr_error *error)
{
    tree->first = m->packed->frame.triangles.begin + m->triangle_count;
    lr_status status =
        build_facets(m->packed, facets, count, shared, &tree->reach, &tree->bvh, error);
    if (status)
        return status;
    if (!lr_pack_reserve(m->packed, 3ull * count))
        return no_memory(error);
    for (uint32_t i = 0; i < count; i++)
        if (!pack_facet(m, &facets[tree->bvh->order[i]], shared))
            return no_memory(error);
    return LR_OK;
}

/* All meshes with one user, in world space. */
static lr_status pack_world_tree(mesh_packing *m, mesh_tree *tree, lr_error *error)
{
    uint64_t total = 0;
    for (uint32_t i = 0; i < m->scene->mesh_count; i++)
        total += m->users[i] == 1 ? m->scene->meshes[i].triangle_count : 0;
    facet *facets = lr_alloc_large(total ? total : 1, sizeof *facets);
    uint32_t count = 0;
    if (!facets)
        return no_memory(error);
    for (uint32_t i = 0; i < m->scene->object_count; i++) {
        const lr_object *object = &m->scene->objects[i];
        if (object->kind == LR_MESH && m->users[object->mesh] == 1)
            count = add_facets(m, object->mesh, i, object->transformed ? &object->to_world : NULL,
                               facets, count);
    }
    lr_status status = count ? pack_facets(m, facets, count, false, tree, error) : LR_OK;
    free(facets);
    return status;
}

static lr_status pack_shared_tree(mesh_packing *m, uint32_t mesh, mesh_tree *tree, lr_error *error)
{
    uint32_t total = m->scene->meshes[mesh].triangle_count;
    facet *facets = lr_alloc_large(total, sizeof *facets);
    if (!facets)
        return no_memory(error);
    uint32_t count = add_facets(m, mesh, 0, NULL, facets, 0);
    lr_status status = count ? pack_facets(m, facets, count, true, tree, error) : LR_OK;
    free(facets);
    return status;
}

/* trees[mesh_count] is the world's. */
static lr_status pack_trees(mesh_packing *m, mesh_tree *trees, lr_error *error)
{
    uint32_t count = m->scene->mesh_count;
    lr_status status = pack_world_tree(m, &trees[count], error);
    for (uint32_t i = 0; i < count && !status; i++)
        if (m->users[i] > 1)
            status = pack_shared_tree(m, i, &trees[i], error);
    return status;
}

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
        lr_pack_place(m->packed, &boxes[m->instance_count]);
        struct gpu_instance *instance = add_instance(m, &to_mesh, tree, roots[object->mesh]);
        instance->object = i;
        instance->flags = m->object_flags[i];
    }
    free(roots);
    return fits;
}

/* The instances in a list, or in a tree if they are many. instances[] is brought to their order. */
static lr_status pack_instances(mesh_packing *m, const lr_bvh_box *boxes, uint32_t *instances,
                                lr_error *error)
{
    uint32_t count = m->instance_count;
    gpu_list *list = &m->packed->frame.instances;
    bool tree = count > LR_LISTED_MAX;
    lr_bvh *bvh = NULL;
    lr_status status = LR_OK;
    for (uint32_t i = 0; i < count && tree; i++)
        lr_pack_reach(&m->packed->frame.reach, &boxes[i]);
    if (tree)
        status = lr_pack_build(m->packed, boxes, count, 1, &bvh, error);
    uint32_t *place = lr_alloc(count, sizeof *place);
    if (!status && !place)
        status = no_memory(error);
    *list = (gpu_list){.base = m->packed->row_count, .end = count};
    for (uint32_t i = 0; i < count && !status; i++) {
        uint32_t from = tree ? bvh->order[i] : i;
        place[from] = i;
        if (lr_pack_rows(m->packed, &m->instances[from], sizeof *m->instances / 16) == UINT32_MAX)
            status = no_memory(error);
    }
    for (uint32_t i = 0; i < m->scene->object_count && !status; i++)
        if (m->scene->objects[i].kind == LR_MESH && count)
            instances[i] = place[instances[i]];
    if (tree && !status) {
        list->nodes = lr_pack_tree(m->packed, bvh, 0);
        m->packed->constants[LR_SPEC_INSTANCE_TREE] = 1;
        if (list->nodes == UINT32_MAX)
            status = no_memory(error);
    }
    free(place);
    lr_bvh_destroy(bvh);
    return status;
}

/* Packs the trees' nodes. Where no mesh is shown several times, rays go through the world's tree
 * without further ado. */
static lr_status place_trees(mesh_packing *m, const mesh_tree *trees, uint32_t *instances,
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
        return packed->frame.triangles.nodes == UINT32_MAX ? no_memory(error) : LR_OK;
    }
    lr_bvh_box *boxes = lr_alloc(scene->object_count + 1ull, sizeof *boxes);
    lr_status status = LR_OK;
    if (boxes && place_meshes(m, trees, instances, boxes))
        status = pack_instances(m, boxes, instances, error);
    else
        status = no_memory(error);
    free(boxes);
    return status;
}

static lr_status pack_all(mesh_packing *m, mesh_tree *trees, uint32_t *instances, lr_error *error)
{
    const lr_scene *scene = m->scene;
    lr_packed_scene *packed = m->packed;
    uint64_t shown = 0;
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        shown += m->users[i] ? scene->meshes[i].triangle_count : 0;
    uint32_t first = packed->frame.planes.end;
    if (shown > LR_NODE_FIRST - first)
        return lr_fail(error, LR_ERROR_SCENE,
                       "the meshes have %llu triangles, over the limit of %u",
                       (unsigned long long)shown, LR_NODE_FIRST - first);
    if (!pack_vertices(m))
        return no_memory(error);
    if (packed->constants[LR_SPEC_CORNERS]) {
        m->corners = lr_alloc_large(shown, sizeof *m->corners);
        if (!m->corners)
            return no_memory(error);
    }
    packed->frame.triangles = (gpu_list){.base = packed->row_count - 3 * first, .begin = first};
    lr_status status = pack_trees(m, trees, error);
    if (status)
        return status;
    packed->frame.triangles.end = first + m->triangle_count;
    packed->frame.corners = packed->row_count;
    if (m->corners && lr_pack_rows(packed, m->corners, m->triangle_count) == UINT32_MAX)
        return no_memory(error);
    packed->constants[LR_SPEC_MESHES] = m->triangle_count > 0;
    return place_trees(m, trees, instances, error);
}

lr_status lr_pack_meshes(const lr_scene *scene, const uint32_t *flags, uint32_t *instances,
                         lr_packed_scene *packed, lr_error *error)
{
    if (scene->mesh_count == 0)
        return LR_OK;
    mesh_packing m = {
        .scene = scene,
        .object_flags = flags,
        .packed = packed,
        .users = lr_alloc(scene->mesh_count, sizeof *m.users),
        .shown_by = lr_alloc(scene->mesh_count, sizeof *m.shown_by),
        .vertex_rows = lr_alloc(scene->mesh_count, sizeof *m.vertex_rows),
        .instances = lr_alloc(scene->object_count + 1ull, sizeof *m.instances),
    };
    mesh_tree *trees = lr_alloc(scene->mesh_count + 1ull, sizeof *trees);
    lr_status status = LR_OK;
    if (!m.users || !m.shown_by || !m.vertex_rows || !m.instances || !trees)
        status = no_memory(error);
    for (uint32_t i = 0; i < scene->object_count && !status; i++)
        if (scene->objects[i].kind == LR_MESH) {
            m.users[scene->objects[i].mesh]++;
            m.shown_by[scene->objects[i].mesh] = i;
        }
    if (!status)
        status = pack_all(&m, trees, instances, error);
    for (uint32_t i = 0; trees && i <= scene->mesh_count; i++)
        lr_bvh_destroy(trees[i].bvh);
    free(trees);
    free(m.users);
    free(m.shown_by);
    free(m.vertex_rows);
    free(m.instances);
    free(m.corners);
    return status;
}
