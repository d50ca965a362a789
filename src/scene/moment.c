#include "scene/moment.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/status.h"
#include "scene/load.h"

bool lr_scene_blurs(const lr_scene *scene, const lr_camera *camera)
{
    return scene->things_move && scene->moves_from < scene->frame + camera->shutter;
}

bool lr_scene_blurs_any(const lr_scene *scene)
{
    bool any = false;
    for (uint32_t i = 0; i < scene->camera_count; i++)
        any = any || lr_scene_blurs(scene, &scene->cameras[i]);
    return any;
}

bool lr_scene_keep_text(lr_scene *scene, const char *text, size_t length,
                        const lr_load_options *options)
{
    scene->text = lr_string_copy(text, length);
    scene->text_length = length;
    if (options)
        scene->text_options = (lr_load_options){.allow_path = options->allow_path,
                                                .max_triangles = options->max_triangles,
                                                .max_memory = options->max_memory};
    return scene->text;
}

lr_status lr_scene_at(const lr_scene *scene, double frame, lr_scene **moment, lr_error *error)
{
    lr_load_options options = scene->text_options;
    lr_error cause = {0};
    char *report;
    options.frame = frame;
    options.previous = scene;
    lr_status status = lr_scene_parse_moment(scene->text, scene->text_length, scene->source,
                                             &options, moment, &report, &cause);
    if (status) /* the first line of the report tells where and what */
        lr_fail(error, status, "%.*s, in frame %.10g while the shutter is open",
                report ? (int)strcspn(report, "\n") : 900, report ? report : cause.message, frame);
    free(report);
    return status;
}
