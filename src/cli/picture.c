#include "cli/picture.h"

#include <string.h>

static lr_integrator integrator_named(const char *name)
{
    if (!name)
        return LR_INTEGRATOR_DEFAULT;
    return strcmp(name, "path") == 0 ? LR_INTEGRATOR_PATH : LR_INTEGRATOR_WHITTED;
}

static lr_filter filter_named(const char *name)
{
    if (!name)
        return LR_FILTER_DEFAULT;
    return strcmp(name, "box") == 0    ? LR_FILTER_BOX
           : strcmp(name, "tent") == 0 ? LR_FILTER_TENT
                                       : LR_FILTER_BLACKMAN_HARRIS;
}

lr_render_options picture_options(const picture_values *values)
{
    const picture_values *v = values;
    return (lr_render_options){
        .width = v->size.width,
        .height = v->size.height,
        .samples = v->samples >= 0 ? (uint32_t)v->samples : 0,
        .depth = v->depth >= 0 ? (int32_t)v->depth : 0,
        .has_depth = v->depth >= 0,
        .seed = v->seed >= 0 ? (uint32_t)v->seed : 0,
        .has_seed = v->seed >= 0,
        .camera = v->camera,
        .integrator = integrator_named(v->integrator),
        .filter = filter_named(v->filter),
    };
}
