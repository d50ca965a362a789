#include "scene/scene.h"

#include <string.h>

void lr_scene_get_info(const lr_scene *scene, lr_scene_info *info)
{
    *info = (lr_scene_info){
        .objects = scene->object_count,
        .lights = scene->light_count + scene->default_light,
        .materials = scene->material_count,
        .cameras = scene->camera_count,
        .exposure = (float)scene->image.exposure,
        .meshes = scene->mesh_count,
        .notes = (const char *const *)scene->notes,
        .note_count = scene->note_count,
    };
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        info->triangles += scene->meshes[i].triangle_count;
    memcpy(info->sha256, scene->sha256, sizeof info->sha256);
}
