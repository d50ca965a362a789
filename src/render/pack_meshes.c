/* Meshes and the objects that show them. The meshes that one object shows are brought into the
 * world and stand in one tree together; a mesh that several show has a tree in its own space. */
#include "render/pack_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"

/* Small leaves are faster, great ones save memory where there are many triangles. */
#define LEAF_SIZE 2
#define LEAF_SIZE_OF_MANY 4
#define MANY 200000

/* A triangle on its way into a tree. */
typedef struct facet {
    uint32_t mesh, triangle, object;
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

static bool is_mirrored(const lr_transform *t)
{
    lr_vec3 x = {t->m[0][0], t->m[1][0], t->m[2][0]}, y = {t->m[0][1], t->m[1][1], t->m[2][1]};
    lr_vec3 z = {t->m[0][2], t->m[1][2], t->m[2][2]};
    return lr_vec3_dot(lr_vec3_cross(x, y), z) < 0;
}

/* How the meshes of a tree come into its space. */
typedef struct placement {
    const lr_transform *to_world; /* NULL: as they are */
    bool mirrored;                /* front and back change sides */
} placement;

static placement place_mesh(const mesh_packing *m, uint32_t index, bool shared)
{
    const lr_object *object = &m->scene->objects[index];
    placement p = {.to_world = shared || !object->transformed ? NULL : &object->to_world};
    p.mirrored = p.to_world && is_mirrored(p.to_world);
    return p;
}

/* The vertices of a triangle, counter-clockwise as seen from outside. */
static void facet_vertices(const lr_mesh *mesh, uint32_t triangle, bool mirrored,
                           uint32_t vertices[3])
{
    const uint32_t *v = &mesh->triangles[3 * (size_t)triangle];
    vertices[0] = v[0];
    vertices[1] = v[mirrored ? 2 : 1];
    vertices[2] = v[mirrored ? 1 : 2];
}

static void facet_corners(const lr_mesh *mesh, const uint32_t vertices[3], const placement *p,
                          vec3 corners[3])
{
    for (int i = 0; i < 3; i++) {
        const float *v = &mesh->positions[3 * (size_t)vertices[i]];
        corners[i] = (vec3){v[0], v[1], v[2]};
        if (p->to_world)
            corners[i] = lr_pack_vec3(lr_transform_point(p->to_world, (lr_vec3){v[0], v[1], v[2]}));
    }
}

static bool has_area(const vec3 corners[3])
{
    double ux = (double)corners[1].x - corners[0].x, vx = (double)corners[2].x - corners[0].x;
    double uy = (double)corners[1].y - corners[0].y, vy = (double)corners[2].y - corners[0].y;
    double uz = (double)corners[1].z - corners[0].z, vz = (double)corners[2].z - corners[0].z;
    return uy * vz != uz * vy || uz * vx != ux * vz || ux * vy != uy * vx;
}

static float least(float a, float b)
{
    return a < b ? a : b;
}

static float greatest(float a, float b)
{
    return a > b ? a : b;
}

static lr_bvh_box box_of(const vec3 c[3])
{
    return (lr_bvh_box){
        .min = {least(c[0].x, least(c[1].x, c[2].x)), least(c[0].y, least(c[1].y, c[2].y)),
                least(c[0].z, least(c[1].z, c[2].z))},
        .max = {greatest(c[0].x, greatest(c[1].x, c[2].x)),
                greatest(c[0].y, greatest(c[1].y, c[2].y)),
                greatest(c[0].z, greatest(c[1].z, c[2].z))},
    };
}

/* Adds a mesh's triangles with their boxes, those without an area left out. Returns the new count.
 */
static uint32_t add_facets(const mesh_packing *m, uint32_t mesh, uint32_t object, bool shared,
                           facet *facets, lr_bvh_box *boxes, uint32_t count)
{
    const lr_mesh *from = &m->scene->meshes[mesh];
    placement p = place_mesh(m, object, shared);
    for (uint32_t i = 0; i < from->triangle_count; i++) {
        uint32_t vertices[3];
        vec3 corners[3];
        facet_vertices(from, i, p.mirrored, vertices);
        facet_corners(from, vertices, &p, corners);
        if (!has_area(corners))
            continue;
        facets[count] = (facet){mesh, i, object};
        boxes[count++] = box_of(corners);
    }
    return count;
}

static uint32_t attribute_flags(const lr_mesh *mesh)
{
    return (mesh->normals ? LR_FLAG_SMOOTH : 0) | (mesh->uvs ? LR_FLAG_UV : 0) |
           (mesh->colors ? LR_FLAG_COLORS : 0);
}

/* The records of one tree's triangles, in the order of its leaves. */
typedef struct facet_work {
    const mesh_packing *m;
    const facet *facets;
    const lr_bvh *bvh;
    bool shared;
    uint32_t first_row, first; /* of the records, and of the corners */
} facet_work;

#define FACETS_A_PART 32768

static void pack_facet(const facet_work *work, uint32_t place)
{
    const mesh_packing *m = work->m;
    const facet *f = &work->facets[work->bvh->order[place]];
    const lr_mesh *mesh = &m->scene->meshes[f->mesh];
    placement p = place_mesh(m, f->object, work->shared);
    uint32_t v[3], row = m->vertex_rows[f->mesh];
    vec3 corners[3];
    facet_vertices(mesh, f->triangle, p.mirrored, v);
    facet_corners(mesh, v, &p, corners);
    struct gpu_triangle record = {
        .a = corners[0],
        .object = work->shared ? 0 : f->object,
        .b = corners[1],
        .order = f->triangle,
        .c = corners[2],
        .flags = attribute_flags(mesh) | (work->shared ? 0 : m->object_flags[f->object]),
    };
    memcpy(&m->packed->rows[work->first_row + 3 * (size_t)place], &record, sizeof record);
    if (m->corners) {
        bool has = lr_mesh_has_attributes(mesh);
        m->corners[work->first + place] =
            has ? (struct gpu_corners){row + v[0], row + v[1], row + v[2], 0}
                : (struct gpu_corners){0};
    }
}

static void pack_part(void *context, uint32_t part)
{
    const facet_work *work = context;
    uint64_t end = (uint64_t)(part + 1) * FACETS_A_PART;
    for (uint32_t i = part * FACETS_A_PART; i < work->bvh->count && i < end; i++)
        pack_facet(work, i);
}

/* The tree of some meshes. */
typedef struct mesh_tree {
    const lr_bvh *bvh;
    uint32_t first; /* number of its first triangle */
    float reach;
} mesh_tree;

static lr_status no_memory(lr_error *error)
{
    return lr_fail(error, LR_ERROR_MEMORY, "out of memory for the scene's meshes");
}

/* ---- Triangles in the same place ---- */

/* The facets of a tree that may have others in the same place. */
typedef struct heap {
    const mesh_packing *m;
    const facet *facets;
    bool shared;
} heap;

/* Whether no light gets through the object. */
static bool is_opaque(const mesh_packing *m, uint32_t object)
{
    const lr_scene *scene = m->scene;
    const lr_material *material = &scene->materials[scene->objects[object].material];
    bool cut = material->color.kind == LR_PATTERN_IMAGE && material->alpha_cutoff > 0;
    return !cut && !(m->object_flags[object] & LR_FLAG_TRANSPARENT);
}

/* Whether the picture would be the same without `later`: the first of two triangles with the same
 * corners wins every tie, so the other one shows only where the first is not there or lets light
 * through. */
static bool hides(const void *context, uint32_t first, uint32_t later)
{
    const heap *h = context;
    const facet *f[2] = {&h->facets[first], &h->facets[later]};
    vec3 corners[2][3];
    for (int i = 0; i < 2; i++) {
        uint32_t vertices[3];
        placement p = place_mesh(h->m, f[i]->object, h->shared);
        facet_vertices(&h->m->scene->meshes[f[i]->mesh], f[i]->triangle, p.mirrored, vertices);
        facet_corners(&h->m->scene->meshes[f[i]->mesh], vertices, &p, corners[i]);
    }
    if (memcmp(corners[0], corners[1], sizeof corners[0]) != 0)
        return false;
    if (h->shared)
        return true;
    uint32_t a = h->m->object_flags[f[0]->object], b = h->m->object_flags[f[1]->object];
    bool dark = (a & LR_FLAG_SHADOW) || !(b & LR_FLAG_SHADOW);
    return is_opaque(h->m, f[0]->object) &&
           (f[0]->object == f[1]->object || (!(a & LR_FLAG_ONE_SIDED) && dark));
}

/* Drops the facets that others hide; *count becomes how many are left. False when memory is out. */
static bool drop_hidden(const heap *h, facet *facets, lr_bvh_box *boxes, uint32_t *count)
{
    const lr_scene *scene = h->m->scene;
    for (uint32_t i = 0; i < scene->object_count && h->shared; i++)
        if (scene->objects[i].kind == LR_MESH && scene->objects[i].mesh == facets[0].mesh &&
            !is_opaque(h->m, i))
            return true;
    bool *hidden = lr_alloc_large(*count, sizeof *hidden);
    bool found = hidden && lr_pack_find_repeated(boxes, *count, hides, h, hidden);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < *count && found; i++) {
        if (hidden[i])
            continue;
        facets[kept] = facets[i];
        boxes[kept++] = boxes[i];
    }
    *count = found ? kept : *count;
    free(hidden);
    return found;
}

/* The tree over `count` facets, fewer afterwards where thousands are in the same place. */
static lr_status build_facets(mesh_packing *m, facet *facets, lr_bvh_box *boxes, uint32_t *count,
                              bool shared, mesh_tree *tree, lr_error *error)
{
    uint32_t leaf_size = *count > MANY ? LEAF_SIZE_OF_MANY : LEAF_SIZE, before = *count;
    lr_status status = lr_pack_build(m->packed, boxes, *count, leaf_size, &tree->bvh, error);
    if (status || !lr_pack_has_heaps(tree->bvh))
        return status;
    if (!drop_hidden(&(heap){m, facets, shared}, facets, boxes, count))
        return no_memory(error);
    if (*count == before)
        return LR_OK;
    return lr_pack_build(m->packed, boxes, *count, leaf_size, &tree->bvh, error);
}

/* Builds the tree over `count` facets and packs their records in the order of its leaves. */
static lr_status pack_facets(mesh_packing *m, facet *facets, lr_bvh_box *boxes, uint32_t count,
                             bool shared, mesh_tree *tree, lr_error *error)
{
    lr_packed_scene *packed = m->packed;
    for (uint32_t i = 0; i < count; i++) {
        lr_pack_reach(&tree->reach, &boxes[i]);
        if (!shared)
            lr_pack_place(packed, &boxes[i]);
    }
    tree->first = packed->frame.triangles.begin + m->triangle_count;
    lr_status status = build_facets(m, facets, boxes, &count, shared, tree, error);
    if (status)
        return status;
    if (!lr_pack_reserve(packed, 3ull * count))
        return no_memory(error);
    facet_work work = {m, facets, tree->bvh, shared, packed->row_count, m->triangle_count};
    lr_run_parallel((count + FACETS_A_PART - 1) / FACETS_A_PART, pack_part, &work);
    packed->row_count += 3 * count;
    m->triangle_count += count;
    return LR_OK;
}

/* A tree of all meshes with one user in world space or, if `mesh` is none of these, of that mesh in
 * its own. */
static lr_status pack_tree_of(mesh_packing *m, uint32_t mesh, mesh_tree *tree, lr_error *error)
{
    const lr_scene *scene = m->scene;
    bool shared = mesh != LR_NONE;
    uint64_t total = 1;
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        if (shared ? i == mesh : m->users[i] == 1)
            total += scene->meshes[i].triangle_count;
    facet *facets = lr_alloc_large(total, sizeof *facets);
    lr_bvh_box *boxes = lr_alloc_large(total, sizeof *boxes);
    uint32_t count = 0;
    lr_status status = facets && boxes ? LR_OK : no_memory(error);
    if (!status && shared)
        count = add_facets(m, mesh, m->shown_by[mesh], true, facets, boxes, 0);
    for (uint32_t i = 0; i < scene->object_count && !status && !shared; i++) {
        const lr_object *object = &scene->objects[i];
        if (object->kind == LR_MESH && m->users[object->mesh] == 1)
            count = add_facets(m, object->mesh, i, false, facets, boxes, count);
    }
    if (count)
        status = pack_facets(m, facets, boxes, count, shared, tree, error);
    free(facets);
    free(boxes);
    return status;
}

/* trees[mesh_count] is the world's. */
static lr_status pack_trees(mesh_packing *m, mesh_tree *trees, lr_error *error)
{
    uint32_t count = m->scene->mesh_count;
    lr_status status = pack_tree_of(m, LR_NONE, &trees[count], error);
    for (uint32_t i = 0; i < count && !status; i++)
        if (m->users[i] > 1)
            status = pack_tree_of(m, i, &trees[i], error);
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
    const lr_bvh *bvh = NULL;
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
    if (!lr_pack_vertices(m->scene, m->users, m->shown_by, m->vertex_rows, m->packed))
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
    free(trees);
    free(m.users);
    free(m.shown_by);
    free(m.vertex_rows);
    free(m.instances);
    free(m.corners);
    return status;
}
