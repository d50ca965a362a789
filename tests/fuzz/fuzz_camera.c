/* In any text that is a scene a camera can be saved, unless aliases, keys behind question marks or
 * values that change from frame to frame stand in the way; and what comes out is read as that
 * camera. */
#include "scene/save_camera.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static lr_scene *parse(const char *text, size_t size)
{
    lr_scene *scene;
    char *report;
    lr_scene_parse(text, size, "fuzz.yaml", &scene, &report, NULL);
    free(report);
    return scene;
}

static void save(const lr_scene *scene, const char *text, size_t size, uint32_t index)
{
    lr_camera camera = scene->cameras[index];
    camera.from = (lr_vec3){0.1, -1e7, 3};
    camera.to = (lr_vec3){4, 5, 6e-3};
    camera.up = (lr_vec3){0, 1, 0.5};
    camera.fov = 33;
    char *edited;
    size_t length;
    lr_status status =
        lr_camera_edit(text, size, "fuzz.yaml", index, &camera, &edited, &length, NULL);
    if (status != LR_OK) {
        if (!memchr(text, '*', size) && !memchr(text, '?', size) && !scene->moves)
            abort();
        return;
    }
    lr_scene *saved = parse(edited, length);
    if (!saved || memcmp(&saved->cameras[index].from, &camera.from, 3 * sizeof camera.from) != 0 ||
        saved->cameras[index].fov != camera.fov)
        abort();
    lr_scene_destroy(saved);
    free(edited);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    lr_scene *scene = parse((const char *)data, size);
    for (uint32_t i = 0; scene && i < scene->camera_count && i < 4; i++)
        save(scene, (const char *)data, size, i);
    lr_scene_destroy(scene);
    return 0;
}
