/* The scene as the kernels read it: rows of 16 bytes, the frame's constants, and which parts of the
 * kernels the scene needs. All floats are rounded from double here and nowhere else. */
#ifndef LR_RENDER_PACK_H
#define LR_RENDER_PACK_H

#include "base/status.h"
#include "gpu_layout.h"
#include "render/trees.h"
#include "scene/color.h"
#include "scene/scene.h"

/* What pixels show. Anything but light needs kernels of its own. */
typedef enum lr_inspect {
    LR_INSPECT_LIGHT,
    LR_INSPECT_NORMAL = LR_GPU_INSPECT_NORMAL, /* that light falls by: (n + 1) / 2 */
    LR_INSPECT_DEPTH = LR_GPU_INSPECT_DEPTH,   /* from 1 at the eye, 1/2 at the focus, to 0 */
    LR_INSPECT_OBJECT = LR_GPU_INSPECT_OBJECT, /* a colour for each */
    LR_INSPECT_RAYS = LR_GPU_INSPECT_RAYS,     /* rays, 1/64 each */
    /* Not in the window, as gpu_layout.h says: */
    LR_INSPECT_ALBEDO = LR_GPU_INSPECT_ALBEDO,
    LR_INSPECT_SHIFTED_NORMAL = LR_GPU_INSPECT_SHIFTED_NORMAL,
    LR_INSPECT_DISTANCE = LR_GPU_INSPECT_DISTANCE,
    LR_INSPECT_POSITION = LR_GPU_INSPECT_POSITION,
    LR_INSPECT_NEGATIVE_POSITION = LR_GPU_INSPECT_NEGATIVE_POSITION,
    LR_INSPECT_NUMBER = LR_GPU_INSPECT_NUMBER,
} lr_inspect;

/* What a render is asked for, with the scene's own values where the caller left them open. */
typedef struct lr_settings {
    uint32_t width, height, samples, depth, seed;
    uint32_t crop_x, crop_y, crop_width, crop_height;
    uint32_t first_sample, sample_count; /* of the samples: which are traced */
    uint32_t noise; /* that may stay, in millionths; 0: all samples are traced */
    const lr_camera *camera;
    lr_integrator integrator;
    lr_filter filter;
    uint32_t leaf_size, threads; /* of the builder of trees; 0: as suits them */
    lr_inspect inspect;
    lr_trees *trees; /* NULL, or those of the packing before, which become those of this one; the
                        same rows come out as without them */
} lr_settings;

/* Of the corners of what stands in trees: how many, the sums of their coordinates and of the
 * squares of these. */
typedef struct lr_places {
    double count, sum[3], square_sum[3];
} lr_places;

typedef struct lr_packed_scene {
    vec4 *rows; /* owned */
    uint32_t row_count, row_capacity;
    uint32_t light_count;
    uint32_t tests_per_ray;      /* about so many primitives does a ray meet on its way */
    uint32_t leaf_size, threads; /* of lr_settings */
    lr_trees *trees;             /* while it is being packed */
    bool moment;                 /* a sample is all that is taken of it */
    lr_places places;
    lr_texture sky; /* of a background that is the sky, while it is being packed */
    double environment_light, sun_light; /* their radiance times their solid angle */
    struct gpu_frame frame;
    uint32_t constants[LR_SPEC_COUNT]; /* but for those that only the device decides */
} lr_packed_scene;

lr_status lr_pack_scene(const lr_scene *scene, const lr_settings *settings, lr_packed_scene *packed,
                        lr_error *error);
void lr_packed_scene_free(lr_packed_scene *packed);

/* pack_camera.c: what depends on the settings alone, so that another camera, size or depth needs no
 * more than this: the camera and the media around it, and the light of scenes that name none. */
void lr_pack_camera(const lr_scene *scene, const lr_settings *settings, lr_packed_scene *packed);

/* Appends `rows` rows from `record`; returns the index of the first, or UINT32_MAX when memory is
 * out. */
uint32_t lr_pack_rows(lr_packed_scene *packed, const void *record, uint32_t rows);

/* Makes room for that many more rows. */
bool lr_pack_reserve(lr_packed_scene *packed, uint64_t rows);

/* pack_environment.c: a background that is a picture; how likely paths choose the picture and its
 * sun is filled in later. */
lr_status lr_pack_environment(const lr_scene *scene, lr_packed_scene *packed, lr_error *error);
void lr_pack_environment_choice(lr_packed_scene *packed, double picture, double sun);

/* pack_objects.c: the primitives, objects and media of the scene. */
lr_status lr_pack_objects(const lr_scene *scene, lr_packed_scene *packed, lr_error *error);

/* pack_bsdf.c: the materials once more, for paths. */
lr_status lr_pack_bsdfs(const lr_scene *scene, lr_packed_scene *packed, lr_error *error);

/* pack_textures.c: first makes room for the records of the scene's textures, texture i in row i
 * and behind them the sky's, and last fills them and appends their texels. */
lr_status lr_pack_texture_records(const lr_scene *scene, lr_packed_scene *packed, lr_error *error);
lr_status lr_pack_textures(const lr_scene *scene, lr_packed_scene *packed, lr_error *error);

void lr_pack_light(const lr_light *light, struct gpu_light *out);

vec3 lr_pack_vec3(lr_vec3 v);

#endif
