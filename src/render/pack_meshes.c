/* Meshes. Those that one object shows are brought into the world and stand in one tree together; a
 * mesh that several show has a tree in its own space. */
#include "render/pack_meshes.h"

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

lr_status lr_pack_no_memory(lr_error *error)
{
    return lr_fail(error, LR_ERROR_MEMORY, "out of memory for the scene's meshes");
}

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

/* The triangles of a tree, and what their boxes come to. */
typedef struct facet_list {
    facet *facets;
    lr_bvh_box *boxes;
    uint32_t count;
    float reach;
    lr_places places;
} facet_list;

/* A mesh on its way into a list; each part fills a list of its own within that one. */
typedef struct facet_listing {
    const mesh_packing *m;
    uint32_t mesh, object;
    bool shared;
    facet_list *parts;
} facet_listing;

#define FACETS_A_PART 32768

static uint32_t part_count(uint32_t facets)
{
    return facets / FACETS_A_PART + 1;
}

static uint32_t part_end(uint32_t part, uint32_t facets)
{
    return facets / FACETS_A_PART == part ? facets : (part + 1) * FACETS_A_PART;
}

static void list_part(void *context, uint32_t part)
{
    const facet_listing *l = context;
    const lr_mesh *from = &l->m->scene->meshes[l->mesh];
    placement p = place_mesh(l->m, l->object, l->shared);
    facet_list list = l->parts[part];
    for (uint32_t i = part * FACETS_A_PART; i < part_end(part, from->triangle_count); i++) {
        uint32_t vertices[3];
        vec3 corners[3];
        facet_vertices(from, i, p.mirrored, vertices);
        facet_corners(from, vertices, &p, corners);
        if (!has_area(corners))
            continue;
        lr_bvh_box *box = &list.boxes[list.count];
        *box = box_of(corners);
        list.facets[list.count++] = (facet){l->mesh, i, l->object};
        lr_pack_reach(&list.reach, box);
        lr_pack_place(&list.places, box);
    }
    l->parts[part] = list;
}

/* Adds a mesh's triangles, those without an area left out. False when memory is out. */
static bool add_facets(const mesh_packing *m, uint32_t mesh, uint32_t object, bool shared,
                       facet_list *list)
{
    uint32_t total = m->scene->meshes[mesh].triangle_count;
    facet_list *parts = lr_alloc(part_count(total), sizeof *parts);
    if (!parts)
        return false;
    for (uint32_t i = 0; i < part_count(total); i++) {
        size_t from = list->count + (size_t)i * FACETS_A_PART;
        parts[i] = (facet_list){.facets = &list->facets[from], .boxes = &list->boxes[from]};
    }
    facet_listing listing = {m, mesh, object, shared, parts};
    lr_run_parallel_on(m->packed->threads, part_count(total), list_part, &listing);
    for (uint32_t i = 0; i < part_count(total); i++) {
        const facet_list *part = &parts[i];
        if (part->facets != &list->facets[list->count]) {
            memmove(&list->facets[list->count], part->facets, part->count * sizeof(facet));
            memmove(&list->boxes[list->count], part->boxes, part->count * sizeof(lr_bvh_box));
        }
        list->count += part->count;
        list->reach = greatest(list->reach, part->reach);
        lr_pack_add_places(&list->places, &part->places);
    }
    free(parts);
    return true;
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
    for (uint32_t i = part * FACETS_A_PART; i < part_end(part, work->bvh->count); i++)
        pack_facet(work, i);
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

/* Drops the facets that others hide. False when memory is out. */
static bool drop_hidden(const heap *h, facet_list *list)
{
    const lr_scene *scene = h->m->scene;
    for (uint32_t i = 0; i < scene->object_count && h->shared; i++)
        if (scene->objects[i].kind == LR_MESH && scene->objects[i].mesh == list->facets[0].mesh &&
            !is_opaque(h->m, i))
            return true;
    bool *hidden = lr_alloc_large(list->count, sizeof *hidden);
    bool found = hidden && lr_pack_find_repeated(list->boxes, list->count, hides, h, hidden);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < list->count && found; i++) {
        if (hidden[i])
            continue;
        list->facets[kept] = list->facets[i];
        list->boxes[kept++] = list->boxes[i];
    }
    list->count = found ? kept : list->count;
    free(hidden);
    return found;
}

/* The tree over the facets, fewer afterwards where thousands are in the same place. */
static lr_status build_facets(mesh_packing *m, facet_list *list, bool shared, mesh_tree *tree,
                              lr_error *error)
{
    uint32_t before = list->count, leaf_size = before > MANY ? LEAF_SIZE_OF_MANY : LEAF_SIZE;
    lr_status status = lr_pack_build(m->packed, list->boxes, before, leaf_size, &tree->bvh, error);
    if (status || !lr_pack_has_heaps(tree->bvh))
        return status;
    if (!drop_hidden(&(heap){m, list->facets, shared}, list))
        return lr_pack_no_memory(error);
    if (list->count == before)
        return LR_OK;
    return lr_pack_build(m->packed, list->boxes, list->count, leaf_size, &tree->bvh, error);
}

/* Builds the tree over the facets and packs their records in the order of its leaves. */
static lr_status pack_facets(mesh_packing *m, facet_list *list, bool shared, mesh_tree *tree,
                             lr_error *error)
{
    lr_packed_scene *packed = m->packed;
    tree->reach = list->reach;
    if (!shared)
        lr_pack_add_places(&packed->places, &list->places);
    tree->first = packed->frame.triangles.begin + m->triangle_count;
    lr_status status = build_facets(m, list, shared, tree, error);
    if (status)
        return status;
    /* With room for the tree's nodes, so that what is packed here need not move for them. */
    if (!lr_pack_reserve(packed, 3ull * list->count + LR_NODE_ROWS * (tree->bvh->node_count / 2)))
        return lr_pack_no_memory(error);
    facet_work work = {m, list->facets, tree->bvh, shared, packed->row_count, m->triangle_count};
    lr_run_parallel_on(packed->threads, part_count(list->count), pack_part, &work);
    packed->row_count += 3 * list->count;
    m->triangle_count += list->count;
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
    facet_list list = {.facets = lr_alloc_large(total, sizeof *list.facets),
                       .boxes = lr_alloc_large(total, sizeof *list.boxes)};
    bool fits = list.facets && list.boxes;
    if (fits && shared)
        fits = add_facets(m, mesh, m->shown_by[mesh], true, &list);
    for (uint32_t i = 0; i < scene->object_count && fits && !shared; i++) {
        const lr_object *object = &scene->objects[i];
        if (object->kind == LR_MESH && m->users[object->mesh] == 1)
            fits = add_facets(m, object->mesh, i, false, &list);
    }
    lr_status status = fits ? LR_OK : lr_pack_no_memory(error);
    if (fits && list.count)
        status = pack_facets(m, &list, shared, tree, error);
    free(list.facets);
    free(list.boxes);
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
        return lr_pack_no_memory(error);
    if (packed->constants[LR_SPEC_CORNERS]) {
        m->corners = lr_alloc_large(shown, sizeof *m->corners);
        if (!m->corners)
            return lr_pack_no_memory(error);
    }
    packed->frame.triangles = (gpu_list){.base = packed->row_count - 3 * first, .begin = first};
    lr_status status = pack_trees(m, trees, error);
    if (status)
        return status;
    packed->frame.triangles.end = first + m->triangle_count;
    packed->frame.corners = packed->row_count;
    if (m->corners && lr_pack_rows(packed, m->corners, m->triangle_count) == UINT32_MAX)
        return lr_pack_no_memory(error);
    packed->constants[LR_SPEC_MESHES] = m->triangle_count > 0;
    return lr_pack_instances(m, trees, instances, error);
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
        status = lr_pack_no_memory(error);
    for (uint32_t i = 0; i < scene->object_count && !status; i++)
        if (scene->objects[i].kind == LR_MESH) {
            /* In motion a mesh keeps to its own space, where its tree stays the same. */
            bool moves = scene->moment && scene->objects[i].moves;
            m.users[scene->objects[i].mesh] += moves ? 2 : 1;
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
