#include "cli/picture.h"

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
    };
}
