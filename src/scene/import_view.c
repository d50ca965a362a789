/* What an imported scene has beside its objects: camera, background, exposure. */
#include "scene/import_internal.h"

#include <math.h>

#include "base/exact.h"
#include "scene/read.h"

#define FOV 40.0
#define SIN_HALF_FOV 0.34202014332566873 /* of 20 degrees */
#define AMBIENT 0.1

/* In three-quarter view from slightly above, as near as the sphere around everything allows. */
static lr_camera fitted_camera(const lr_bounds *world)
{
    lr_vec3 center = lr_vec3_scale(lr_vec3_add(world->min, world->max), 0.5);
    double radius = lr_vec3_length(lr_vec3_sub(world->max, world->min)) / 2;
    /* 30 degrees to the right of +Z, 20 above. */
    lr_vec3 toward = lr_vec3_normalize((lr_vec3){0.5, 0.42, 0.8660254});
    double distance = fmax(radius, LR_LENGTH_MIN * 1e3) / SIN_HALF_FOV;
    return (lr_camera){.from = lr_vec3_add(center, lr_vec3_scale(toward, distance)),
                       .to = center,
                       .up = {0, 1, 0},
                       .fov = FOV};
}

/* What a white surface in the middle of the scene shows when it faces every light: the sum of
 * intensity / distance^2, no nearer than half the radius. */
static double brightness(const lr_scene *scene, const lr_bounds *world)
{
    lr_vec3 center = lr_vec3_scale(lr_vec3_add(world->min, world->max), 0.5);
    double radius = lr_vec3_length(lr_vec3_sub(world->max, world->min)) / 2, sum = 0;
    for (uint32_t i = 0; i < scene->light_count; i++) {
        const lr_light *light = &scene->lights[i];
        double value =
            light->intensity * fmax(light->color.x, fmax(light->color.y, light->color.z));
        double distance = fmax(lr_vec3_length(lr_vec3_sub(light->position, center)), radius / 2);
        if (light->kind != LR_LIGHT_DIRECTIONAL)
            value /= fmax(distance * distance, 1e-24);
        sum += value;
    }
    return sum;
}

/* Half stops that bring that brightness to about 1. */
static double fitted_exposure(double sum)
{
    if (!(sum > 0 && sum <= 1e60))
        return 0;
    return fmax(-64, fmin(64, floor(-2 * lr_log2(sum) + 0.5) / 2));
}

lr_status lr_import_surroundings(lr_import *import)
{
    lr_scene *scene = import->builder->scene;
    lr_record_defaults(&lr_image_record, scene);
    scene->image.samples = 4;
    scene->background_up = (lr_vec3){0, 1, 0};
    scene->default_light = scene->light_count == 0;
    if (!scene->default_light)
        scene->image.exposure = fitted_exposure(brightness(scene, &import->world));
    /* The exposure is for the lights: the rest looks as it does without. */
    double unexposed = lr_exp2(-scene->image.exposure);
    const lr_field *sky = lr_field_find(&lr_scene_record, "background", 10);
    scene->ambient = (lr_color){AMBIENT * unexposed, AMBIENT * unexposed, AMBIENT * unexposed};
    for (int i = 0; i < 2; i++)
        scene->background.colors[i] = lr_vec3_scale(
            (lr_color){sky->fallback[3 * i], sky->fallback[3 * i + 1], sky->fallback[3 * i + 2]},
            fmin(unexposed, LR_COLOR_MAX));
    if (scene->camera_count > 0)
        return LR_OK;
    lr_camera *camera = lr_scene_add_camera(import->builder);
    if (!camera)
        return lr_import_no_memory(import);
    *camera = fitted_camera(&import->world);
    return LR_OK;
}
