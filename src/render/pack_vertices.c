/* What belongs to the vertices of meshes: normals, texture coordinates, colours. */
#include "render/pack_internal.h"

#include <math.h>

bool lr_mesh_has_attributes(const lr_mesh *mesh)
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

bool lr_pack_vertices(const lr_scene *scene, const uint32_t *users, const uint32_t *shown_by,
                      uint32_t *vertex_rows, lr_packed_scene *packed)
{
    for (uint32_t i = 0; i < scene->mesh_count; i++) {
        const lr_mesh *mesh = &scene->meshes[i];
        vertex_rows[i] = packed->row_count;
        if (!users[i] || !lr_mesh_has_attributes(mesh))
            continue;
        packed->constants[LR_SPEC_CORNERS] = 1;
        if (!lr_pack_reserve(packed, mesh->vertex_count))
            return false;
        const lr_object *object = &scene->objects[shown_by[i]];
        bool in_world = users[i] == 1 && object->transformed;
        lr_transform to_mesh = lr_pack_inverse(&object->to_world);
        for (uint32_t v = 0; v < mesh->vertex_count; v++) {
            struct gpu_vertex vertex = {
                .normal = mesh->normals ? vertex_normal(mesh, v, in_world ? &to_mesh : NULL) : 0,
                .u = mesh->uvs ? mesh->uvs[2 * (size_t)v] : 0,
                .v = mesh->uvs ? mesh->uvs[2 * (size_t)v + 1] : 0,
                .color = mesh->colors ? pack_color(&mesh->colors[3 * (size_t)v]) : 0,
            };
            lr_pack_rows(packed, &vertex, 1);
        }
    }
    return true;
}
