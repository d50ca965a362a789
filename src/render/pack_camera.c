/* The picture that is asked for: camera, size, samples. */
#include "render/pack_internal.h"

#include <math.h>
#include <string.h>

#include "scene/camera.h"

/* The media around the camera: of more than LR_MEDIA_MAX the ones that rank highest. */
static void pack_inside(const lr_scene *scene, const lr_camera *camera, lr_packed_scene *packed)
{
    uint32_t inside[LR_MEDIA_MAX] = {0};
    bool media = packed->constants[LR_SPEC_MEDIA];
    for (uint32_t i = 0; media && i < scene->object_count; i++) {
        struct gpu_object record;
        memcpy(&record, &packed->rows[packed->frame.objects + i * (sizeof record / 16)],
               sizeof record);
        if (record.rank == 0 || !lr_pack_contains(&scene->objects[i], camera->from))
            continue;
        uint32_t lowest = 0;
        for (uint32_t k = 1; k < LR_MEDIA_MAX; k++)
            if (inside[k] < inside[lowest])
                lowest = k;
        if (record.rank > inside[lowest])
            inside[lowest] = record.rank;
    }
    packed->frame.inside0 = inside[0] | inside[1] << 16;
    packed->frame.inside1 = inside[2] | inside[3] << 16;
    packed->frame.inside2 = inside[4] | inside[5] << 16;
    packed->frame.inside3 = inside[6] | inside[7] << 16;
}

/* The frame's vectors as a camera has them. */
static void pack_view(const lr_camera *camera, const lr_settings *settings, struct gpu_frame *frame)
{
    lr_vec3 forward = lr_vec3_normalize(lr_vec3_sub(camera->to, camera->from));
    lr_vec3 right = lr_vec3_normalize(lr_vec3_cross(forward, camera->up));
    lr_vec3 up = lr_vec3_cross(right, forward);
    double pixel = lr_camera_pixel_size(camera, settings->height);
    if (camera->projection == LR_ORTHOGRAPHIC)
        pixel *= lr_vec3_length(lr_vec3_sub(camera->to, camera->from));
    if (camera->projection == LR_PANORAMA)
        pixel = 1;
    frame->origin = lr_pack_vec3(camera->from);
    frame->forward = lr_pack_vec3(forward);
    frame->pixel_right = lr_pack_vec3(lr_vec3_scale(right, pixel));
    frame->pixel_down = lr_pack_vec3(lr_vec3_scale(up, -pixel));
    frame->lens.right = lr_pack_vec3(lr_vec3_scale(right, camera->aperture / 2));
    frame->lens.up = lr_pack_vec3(lr_vec3_scale(up, camera->aperture / 2));
}

static vec3 step_between(vec3 from, vec3 to)
{
    return (vec3){to.x - from.x, to.y - from.y, to.z - from.z};
}

/* How the frame's vectors change while the shutter is open. */
static void pack_motion(const lr_camera *camera, const lr_settings *settings,
                        struct gpu_frame *frame)
{
    struct gpu_frame end = *frame;
    lr_camera closing = lr_camera_closing(camera);
    pack_view(&closing, settings, &end);
    frame->lens.origin_step = step_between(frame->origin, end.origin);
    frame->lens.forward_step = step_between(frame->forward, end.forward);
    frame->lens.right_step = step_between(frame->pixel_right, end.pixel_right);
    frame->lens.down_step = step_between(frame->pixel_down, end.pixel_down);
}

uint32_t lr_pack_filter(const lr_scene *scene, const lr_settings *settings)
{
    lr_filter filter =
        settings->filter ? settings->filter : (lr_filter)(scene->image.filter + LR_FILTER_BOX);
    return filter == LR_FILTER_TENT              ? LR_GPU_FILTER_TENT
           : filter == LR_FILTER_BLACKMAN_HARRIS ? LR_GPU_FILTER_BLACKMAN_HARRIS
                                                 : 0;
}

static void pack_lens(const lr_camera *camera, const lr_settings *settings, struct gpu_lens *lens)
{
    static const uint32_t projections[] = {0, LR_GPU_ORTHOGRAPHIC, LR_GPU_PANORAMA};
    lens->kind = projections[camera->projection] | camera->blades << LR_GPU_BLADES_SHIFT;
    lens->inv_focus = (float)(1 / lr_camera_focus_distance(camera));
    lens->blade_turns = (float)(fmod(90 - camera->blade_rotation, 360) / 360);
    lens->inv_blades = camera->blades ? (float)(1.0 / camera->blades) : 1;
    lens->turns_across = (float)(1.0 / settings->width);
    lens->turns_down = (float)(0.5 / settings->height);
}

void lr_pack_camera(const lr_scene *scene, const lr_settings *settings, lr_packed_scene *packed)
{
    const lr_camera *camera = settings->camera;
    struct gpu_frame *frame = &packed->frame;
    pack_view(camera, settings, frame);
    pack_lens(camera, settings, &frame->lens);
    pack_motion(camera, settings, frame);
    frame->lens.kind |= lr_pack_filter(scene, settings);
    if (settings->inspect == LR_INSPECT_NUMBER) {
        /* The middle of the lens, when the shutter opens: numbers have no mean. */
        struct gpu_lens *lens = &frame->lens;
        const vec3 none = {0, 0, 0};
        lens->right = lens->up = none;
        lens->origin_step = lens->forward_step = lens->right_step = lens->down_step = none;
    }
    frame->half_width = (float)(settings->width * 0.5);
    frame->half_height = (float)(settings->height * 0.5);
    frame->samples = settings->samples;
    frame->inv_samples = (float)(1.0 / settings->samples);
    frame->seed = settings->seed;
    /* Only light and the rays that it takes depend on what is behind the first surface. */
    bool bounces = settings->inspect == LR_INSPECT_LIGHT || settings->inspect == LR_INSPECT_RAYS;
    frame->depth = bounces ? settings->depth : 0;
    frame->inspect = settings->inspect;
    if (settings->integrator == LR_INTEGRATOR_PATH)
        frame->inspect |= LR_GPU_INSPECT_PATHS;
    frame->inspect_scale = (float)lr_vec3_length(lr_vec3_sub(camera->to, camera->from));
    pack_inside(scene, camera, packed);
    if (scene->default_light) {
        lr_light light = lr_default_light(camera);
        struct gpu_light record;
        lr_pack_light(&light, &record);
        memcpy(&packed->rows[frame->lights], &record, sizeof record);
    }
}
