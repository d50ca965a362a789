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

bool lr_scene_retell(lr_scene *scene, const lr_report *report, const lr_load_options *options,
                     lr_tree *tree)
{
    lr_retold *retold = scene->retold = lr_alloc(1, sizeof *retold);
    if (!retold)
        return false;
    retold->tree = *tree;
    *tree = (lr_tree){.root = NULL};
    retold->text = lr_string_copy(report->text, report->length);
    retold->length = report->length;
    if (options)
        retold->options = (lr_load_options){.allow_path = options->allow_path,
                                            .max_triangles = options->max_triangles,
                                            .max_memory = options->max_memory};
    return retold->text;
}

void lr_retold_free(lr_retold *retold)
{
    if (!retold)
        return;
    free(retold->text);
    lr_tree_free(&retold->tree);
    free(retold);
}

lr_status lr_scene_at(const lr_scene *scene, double frame, lr_scene **moment, lr_error *error)
{
    lr_error cause = {0};
    char *report;
    lr_status status = lr_scene_read_moment(scene, frame, moment, &report, &cause);
    if (status) /* the first line of the report tells where and what */
        lr_fail(error, status, "%.*s, in frame %.10g while the shutter is open",
                report ? (int)strcspn(report, "\n") : 900, report ? report : cause.message, frame);
    free(report);
    return status;
}
