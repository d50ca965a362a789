#include "scene/build.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "scene/color.h"

lr_camera *lr_scene_add_camera(lr_scene_builder *builder)
{
    lr_scene *scene = builder->scene;
    if (!lr_array_reserve((void **)&scene->cameras, scene->camera_count, &builder->camera_capacity,
                          sizeof *scene->cameras))
        return NULL;
    return &scene->cameras[scene->camera_count++];
}

lr_material *lr_scene_add_material(lr_scene_builder *builder)
{
    lr_scene *scene = builder->scene;
    if (!lr_array_reserve((void **)&scene->materials, scene->material_count,
                          &builder->material_capacity, sizeof *scene->materials))
        return NULL;
    return &scene->materials[scene->material_count++];
}

lr_object *lr_scene_add_object(lr_scene_builder *builder)
{
    lr_scene *scene = builder->scene;
    if (!lr_array_reserve((void **)&scene->objects, scene->object_count, &builder->object_capacity,
                          sizeof *scene->objects))
        return NULL;
    return &scene->objects[scene->object_count++];
}

bool lr_light_is_black(const lr_light *light)
{
    return !(light->intensity > 0) || lr_color_is_black(light->color);
}

lr_light *lr_scene_add_light(lr_scene_builder *builder)
{
    lr_scene *scene = builder->scene;
    if (!lr_array_reserve((void **)&scene->lights, scene->light_count, &builder->light_capacity,
                          sizeof *scene->lights))
        return NULL;
    return &scene->lights[scene->light_count++];
}

lr_mesh *lr_scene_add_mesh(lr_scene_builder *builder)
{
    lr_scene *scene = builder->scene;
    if (!lr_array_reserve((void **)&scene->meshes, scene->mesh_count, &builder->mesh_capacity,
                          sizeof *scene->meshes))
        return NULL;
    return &scene->meshes[scene->mesh_count++];
}

lr_texture *lr_scene_add_texture(lr_scene_builder *builder)
{
    lr_scene *scene = builder->scene;
    if (!lr_array_reserve((void **)&scene->textures, scene->texture_count,
                          &builder->texture_capacity, sizeof *scene->textures))
        return NULL;
    return &scene->textures[scene->texture_count++];
}

bool lr_scene_add_note(lr_scene_builder *builder, const char *format, ...)
{
    lr_scene *scene = builder->scene;
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (!lr_array_reserve((void **)&scene->notes, scene->note_count, &builder->note_capacity,
                          sizeof *scene->notes))
        return false;
    char *note = lr_string_copy(text, strlen(text));
    if (!note)
        return false;
    scene->notes[scene->note_count++] = note;
    return true;
}

bool lr_material_has_relief(const lr_material *material)
{
    return material->maps[LR_MAP_NORMAL].given || material->maps[LR_MAP_BUMP].given;
}

bool lr_light_is_soft(const lr_light *light)
{
    return light->kind == LR_LIGHT_DIRECTIONAL ? light->angle > 0 : light->radius > 0;
}

lr_light lr_default_light(const lr_camera *camera)
{
    lr_vec3 forward = lr_vec3_normalize(lr_vec3_sub(camera->to, camera->from));
    lr_vec3 right = lr_vec3_normalize(lr_vec3_cross(forward, camera->up));
    lr_vec3 up = lr_vec3_cross(right, forward);
    return (lr_light){
        .kind = LR_LIGHT_DIRECTIONAL,
        .color = {1, 1, 1},
        .intensity = 0.9,
        .direction = lr_vec3_add(lr_vec3_scale(forward, 0.55),
                                 lr_vec3_sub(lr_vec3_scale(right, 0.35), lr_vec3_scale(up, 0.75))),
        .shadows = true};
}
