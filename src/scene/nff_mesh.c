#include "scene/nff_mesh.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

void lr_nff_add_count(lr_nff_count *count, uint32_t line)
{
    if (count->count++ == 0)
        count->line = line;
}

bool lr_nff_parts_init(lr_nff_parts *parts)
{
    *parts = (lr_nff_parts){0};
    parts->polygon = lr_alloc(1, sizeof *parts->polygon);
    parts->normals = lr_alloc(1, sizeof *parts->normals);
    return parts->polygon && parts->normals;
}

void lr_nff_parts_free(lr_nff_parts *parts)
{
    for (uint32_t i = 0; i < parts->count; i++) {
        lr_rows_free(&parts->items[i].vertices);
        free(parts->items[i].triangles);
    }
    free(parts->items);
    free(parts->polygon);
    free(parts->normals);
    *parts = (lr_nff_parts){0};
}

static lr_nff_part *part_of(lr_nff_parts *parts, uint32_t material, bool patch)
{
    while (parts->count < 2 * (material + 1)) {
        if (!lr_array_reserve((void **)&parts->items, parts->count, &parts->capacity,
                              sizeof *parts->items))
            return NULL;
        bool normals = parts->count % 2;
        parts->items[parts->count++].vertices.size = (normals ? 6 : 3) * sizeof(float);
    }
    return &parts->items[2 * material + patch];
}

static void write_row(float row[3], lr_vec3 v)
{
    /* + 0 makes -0 the 0 that it equals. */
    row[0] = (float)v.x + 0.0f;
    row[1] = (float)v.y + 0.0f;
    row[2] = (float)v.z + 0.0f;
}

/* Makes the normals of the patch unit ones; one that has no length becomes the polygon's. */
static void complete_normals(lr_nff_parts *parts, uint32_t line)
{
    for (uint32_t i = 0; i < parts->polygon->count; i++) {
        lr_vec3 *normal = &(*parts->normals)[i];
        *normal = lr_vec3_normalize(*normal);
        if (!(lr_vec3_length(*normal) > 0.5)) {
            *normal = parts->polygon->normal;
            lr_nff_add_count(&parts->turned, line);
        }
    }
}

static bool same_place(const float a[3], const float b[3])
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

static bool add_triangle(lr_nff_parts *parts, lr_nff_part *part, bool patch,
                         const uint32_t corners[3], uint32_t line)
{
    float rows[3][6];
    for (int i = 0; i < 3; i++) {
        write_row(rows[i], parts->polygon->corners[corners[i]]);
        if (patch)
            write_row(rows[i] + 3, (*parts->normals)[corners[i]]);
    }
    if (same_place(rows[0], rows[1]) || same_place(rows[1], rows[2]) ||
        same_place(rows[2], rows[0])) {
        lr_nff_add_count(&parts->vanished, line);
        return true;
    }
    if (!lr_array_reserve((void **)&part->triangles, part->triangle_count, &part->triangle_capacity,
                          sizeof *part->triangles))
        return false;
    lr_nff_triangle *triangle = &part->triangles[part->triangle_count++];
    for (int i = 0; i < 3; i++)
        if ((triangle->vertices[i] = lr_rows_put(&part->vertices, rows[i])) == LR_NONE)
            return false;
    return true;
}

bool lr_nff_add_polygon(lr_nff_parts *parts, uint32_t material, bool patch, uint32_t line)
{
    lr_polygon *polygon = parts->polygon;
    lr_polygon_result result = lr_polygon_triangulate(polygon);
    if (result == LR_POLYGON_FLATTENED) {
        lr_nff_add_count(&parts->flattened, line);
        return true;
    }
    if (result == LR_POLYGON_CROSSING)
        lr_nff_add_count(&parts->crossing, line);
    lr_nff_part *part = part_of(parts, material, patch);
    if (!part)
        return false;
    if (part->triangle_count == 0)
        part->line = line;
    if (patch)
        complete_normals(parts, line);
    for (uint32_t i = 0; i < polygon->triangle_count; i++)
        if (!add_triangle(parts, part, patch, polygon->triangles[i], line))
            return false;
    return true;
}

/* Gives the vertices to the mesh. False when memory is out. */
static bool move_vertices(lr_nff_part *part, bool patch, lr_mesh *mesh)
{
    const float *rows = part->vertices.items;
    mesh->vertex_count = part->vertices.count;
    if (!patch) {
        mesh->positions = part->vertices.items;
        part->vertices.items = NULL;
        return true;
    }
    mesh->positions = lr_alloc(mesh->vertex_count, 3 * sizeof *mesh->positions);
    mesh->normals = lr_alloc(mesh->vertex_count, 3 * sizeof *mesh->normals);
    if (!mesh->positions || !mesh->normals)
        return false;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        memcpy(mesh->positions + 3 * i, rows + 6 * i, 3 * sizeof *rows);
        memcpy(mesh->normals + 3 * i, rows + 6 * i + 3, 3 * sizeof *rows);
    }
    return true;
}

static bool add_mesh(lr_nff_part *part, uint32_t material, bool patch, lr_scene_builder *builder)
{
    lr_scene *scene = builder->scene;
    lr_mesh *mesh = lr_scene_add_mesh(builder);
    lr_object *object = lr_scene_add_object(builder);
    if (!mesh || !object)
        return false;
    const lr_material *m = &scene->materials[material];
    char name[1024];
    int length = snprintf(name, sizeof name, "%.900s: %s with the material of line %u",
                          scene->source, patch ? "patches" : "polygons", (unsigned)m->line);
    mesh->name = lr_string_copy(name, (size_t)length);
    mesh->triangles = (uint32_t *)part->triangles;
    mesh->triangle_count = part->triangle_count;
    part->triangles = NULL;
    mesh->closed = m->transmit.x > 0;
    *object = (lr_object){
        .kind = LR_MESH,
        .material = material,
        .line = part->line,
        .shadow = true,
        .to_world = lr_transform_identity(),
        .mesh = scene->mesh_count - 1,
    };
    return mesh->name && move_vertices(part, patch, mesh);
}

bool lr_nff_add_meshes(lr_nff_parts *parts, lr_scene_builder *builder)
{
    for (uint32_t i = 0; i < parts->count; i++)
        if (parts->items[i].triangle_count &&
            !add_mesh(&parts->items[i], i / 2, i % 2 == 1, builder))
            return false;
    return true;
}
