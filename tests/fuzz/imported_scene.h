/* The promises of scene.h for what importers make. */
#ifndef LR_FUZZ_IMPORTED_SCENE_H
#define LR_FUZZ_IMPORTED_SCENE_H

#include <math.h>
#include <stdlib.h>

#include "scene/scene.h"

static inline void expect(bool fact)
{
    if (!fact)
        abort();
}

static inline void check_numbers(const float *numbers, size_t count, double limit)
{
    for (size_t i = 0; numbers && i < count; i++)
        expect(fabs((double)numbers[i]) <= limit);
}

static inline void check_mesh(const lr_mesh *mesh)
{
    size_t count = mesh->vertex_count;
    expect(mesh->name && mesh->triangle_count > 0 && count > 0);
    check_numbers(mesh->positions, 3 * count, LR_COORDINATE_MAX);
    check_numbers(mesh->normals, 3 * count, 1.000001);
    check_numbers(mesh->uvs, 2 * count, 1e7);
    check_numbers(mesh->colors, 3 * count, 1);
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; i++)
        expect(mesh->triangles[i] < count);
    for (size_t i = 0; mesh->normals && i < count; i++) {
        const float *n = &mesh->normals[3 * i];
        double length = sqrt((double)n[0] * (double)n[0] + (double)n[1] * (double)n[1] +
                             (double)n[2] * (double)n[2]);
        expect(fabs(length - 1) < 1e-5);
    }
}

static inline bool within(lr_color c, double limit)
{
    return c.x >= 0 && c.y >= 0 && c.z >= 0 && c.x <= limit && c.y <= limit && c.z <= limit;
}

static inline void check_material(const lr_scene *scene, const lr_material *m)
{
    expect(within(m->color.colors[0], LR_COLOR_MAX) && within(m->diffuse, LR_COLOR_MAX) &&
           within(m->specular, LR_COLOR_MAX) && within(m->reflect, 1) && within(m->transmit, 1) &&
           within(m->emission, LR_COLOR_MAX) && within(m->absorption, LR_COLOR_MAX));
    expect(m->shininess >= 0 && m->shininess <= 1e6 && m->ior >= 0.01 && m->ior <= 100);
    expect(m->color.kind != LR_PATTERN_IMAGE || m->color.texture < scene->texture_count);
}

static inline void check_scene(const lr_scene *scene)
{
    expect(scene->object_count > 0 && scene->camera_count > 0);
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        check_mesh(&scene->meshes[i]);
    for (uint32_t i = 0; i < scene->material_count; i++)
        check_material(scene, &scene->materials[i]);
    for (uint32_t i = 0; i < scene->object_count; i++) {
        const lr_object *object = &scene->objects[i];
        lr_transform inverse;
        expect(object->kind == LR_MESH && object->mesh < scene->mesh_count &&
               object->material < scene->material_count &&
               lr_transform_inverse(&object->to_world, &inverse));
    }
    for (uint32_t i = 0; i < scene->light_count; i++) {
        const lr_light *light = &scene->lights[i];
        expect(within(light->color, 1) && light->intensity >= 0 &&
               light->intensity <= LR_COLOR_MAX &&
               (light->kind == LR_LIGHT_POINT || lr_vec3_length(light->direction) > 0.5) &&
               (light->kind != LR_LIGHT_SPOT ||
                (light->angle > 0 && light->angle <= 90 && light->inner <= light->angle)));
    }
    for (uint32_t i = 0; i < scene->camera_count; i++) {
        const lr_camera *c = &scene->cameras[i];
        lr_vec3 view = lr_vec3_sub(c->to, c->from);
        expect(c->fov > 0 && c->fov < 180 && lr_vec3_length(view) > 0 &&
               lr_vec3_length(lr_vec3_cross(lr_vec3_normalize(view), c->up)) > 0);
    }
    expect(isfinite(scene->image.exposure) && within(scene->ambient, 1e30) &&
           within(scene->background.colors[0], LR_COLOR_MAX));
}

#endif
