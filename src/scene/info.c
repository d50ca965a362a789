#include "scene/moment.h"

#include <string.h>

void lr_scene_get_info(const lr_scene *scene, lr_scene_info *info)
{
    *info = (lr_scene_info){
        .objects = scene->object_count,
        .lights = scene->light_count + scene->default_light,
        .materials = scene->material_count,
        .cameras = scene->camera_count,
        .exposure = (float)scene->image.exposure,
        .tone = scene->image.tone,
        .white = (float)scene->image.white,
        .meshes = scene->mesh_count,
        .notes = (const char *const *)scene->notes,
        .note_count = scene->note_count,
        .moves = scene->moves,
        .blurs = lr_scene_blurs_any(scene),
    };
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        info->triangles += scene->meshes[i].triangle_count;
    memcpy(info->sha256, scene->sha256, sizeof info->sha256);
}

static void copy_color(double to[3], lr_color from)
{
    to[0] = from.x;
    to[1] = from.y;
    to[2] = from.z;
}

bool lr_scene_get_object(const lr_scene *scene, uint32_t index, lr_object_info *info)
{
    if (index >= scene->object_count)
        return false;
    const lr_object *object = &scene->objects[index];
    *info = (lr_object_info){
        .kind = lr_object_kind_name(object->kind),
        .mesh = object->kind == LR_MESH ? scene->meshes[object->mesh].name : NULL,
        .line = object->line,
        .material = object->material,
    };
    return true;
}

bool lr_scene_get_material(const lr_scene *scene, uint32_t index, lr_material_info *info)
{
    if (index >= scene->material_count)
        return false;
    const lr_material *m = &scene->materials[index];
    *info = (lr_material_info){
        .name = m->name,
        .line = m->line,
        .shininess = m->shininess,
        .ior = m->ior,
        .phong = m->highlight == LR_HIGHLIGHT_PHONG,
        .fresnel = m->fresnel,
    };
    copy_color(info->ambient, m->ambient);
    copy_color(info->diffuse, m->diffuse);
    copy_color(info->specular, m->specular);
    copy_color(info->reflect, m->reflect);
    copy_color(info->transmit, m->transmit);
    return true;
}

bool lr_scene_get_light(const lr_scene *scene, uint32_t index, lr_light_info *info)
{
    static const char *const kinds[] = {
        [LR_LIGHT_POINT] = "point",
        [LR_LIGHT_DIRECTIONAL] = "directional",
        [LR_LIGHT_SPOT] = "spot",
    };
    if (index >= scene->light_count + scene->default_light)
        return false;
    lr_light added = lr_default_light(&scene->cameras[0]);
    const lr_light *light = scene->default_light ? &added : &scene->lights[index];
    *info = (lr_light_info){
        .kind = kinds[light->kind],
        .line = light->line,
        .intensity = light->intensity,
        .falloff = light->falloff,
        .shadows = light->shadows,
        .added = scene->default_light,
    };
    copy_color(info->color, light->color);
    return true;
}
