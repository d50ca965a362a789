/* Any bytes must be read as an NFF scene or reported, without a crash, a leak or much time; what a
 * scene then says lies within the ranges that scene.h promises. */
#include "scene/nff.h"
#include "scene/scene.h"

#include <math.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static bool mesh_is_sound(const lr_mesh *mesh)
{
    bool sound = mesh->name && mesh->positions && mesh->triangles && mesh->triangle_count;
    for (uint32_t i = 0; sound && i < 3 * mesh->vertex_count; i++)
        sound = fabsf(mesh->positions[i]) <= (float)LR_COORDINATE_MAX &&
                (!mesh->normals || fabsf(mesh->normals[i]) <= 1);
    for (uint32_t i = 0; sound && i < 3 * mesh->triangle_count; i++)
        sound = mesh->triangles[i] < mesh->vertex_count;
    return sound;
}

static bool scene_is_sound(const lr_scene *scene)
{
    bool sound = scene->camera_count == 1 && scene->object_count >= 1;
    for (uint32_t i = 0; sound && i < scene->object_count; i++)
        sound = scene->objects[i].material < scene->material_count &&
                (scene->objects[i].kind != LR_MESH || scene->objects[i].mesh < scene->mesh_count);
    for (uint32_t i = 0; sound && i < scene->mesh_count; i++)
        sound = mesh_is_sound(&scene->meshes[i]);
    return sound;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    lr_scene *scene;
    char *report;
    lr_error error = {0};
    lr_status status = lr_nff_read((const char *)data, size, "fuzz.nff", &scene, &report, &error);
    bool consistent = status == LR_OK            ? scene && !report && scene_is_sound(scene)
                      : status == LR_ERROR_SCENE ? !scene && report && report[0]
                                                 : !scene && !report;
    if (!consistent)
        abort();
    lr_scene_destroy(scene);
    free(report);
    return 0;
}
