/* One material on the device, seen from one direction: evaluated, sampled, summed up. */
#ifndef LR_BSDF_TESTS_H
#define LR_BSDF_TESTS_H

#include "packed_tests.h"

#include "bsdf.spv.h"

#define MOST (1u << 20) /* answers of one question */

typedef enum task { EVALUATE, SAMPLE, SUM } task;

typedef struct way {
    float wi[3], choice;
} way;

typedef struct answer {
    vec4 a, b;
} answer;

typedef struct view {
    float wo[3];
    uint32_t material;
    float ior1, ior2;
    uint32_t solid, seed;
} view;

typedef struct question {
    view view;
    way ways[MOST];
} question;

typedef struct harness {
    lr_scene *scene;
    lr_packed_scene packed;
    packed_kernel kernel;
} harness;

static question asked;
static answer found[MOST];

static inline lr_scene *scene_of(const lr_material *materials, uint32_t count)
{
    lr_scene *scene = scene_without_materials();
    lr_scene_builder builder = {.scene = scene};
    for (uint32_t i = 0; i < count; i++)
        *lr_scene_add_material(&builder) = materials[i];
    return scene;
}

/* The materials must need no memory of their own: their names are NULL. */
static inline void open_harness(harness *h, lr_device *device, const lr_material *materials,
                                uint32_t count)
{
    *h = (harness){.scene = scene_of(materials, count)};
    lr_settings settings = {.width = 1,
                            .height = 1,
                            .samples = 1,
                            .camera = &h->scene->cameras[0],
                            .integrator = LR_INTEGRATOR_PATH};
    MUST(lr_pack_scene(h->scene, &settings, &h->packed, error));
    lr_program_desc desc = {bsdf_spv, sizeof bsdf_spv / 4, h->packed.constants, LR_SPEC_COUNT};
    open_packed(&h->kernel, device, &h->packed, &desc, sizeof asked, sizeof found);
}

static inline void close_harness(harness *h)
{
    close_packed(&h->kernel);
    lr_packed_scene_free(&h->packed);
    lr_scene_destroy(h->scene);
}

/* Asks what is in `asked`; the first `count` answers, a multiple of LR_GROUP_SIZE, are in `found`,
 * each summing up `each` samples. */
static inline void ask(harness *h, task what, uint32_t count, uint32_t each)
{
    struct gpu_work work = {.tile_x = what, .count = each};
    size_t ways = what == EVALUATE ? count : 1;
    assert_in_range(count, 1, MOST);
    assert_int_equal(count % LR_GROUP_SIZE, 0);
    ask_packed(&h->kernel, &work, count / LR_GROUP_SIZE, &asked,
               sizeof asked.view + ways * sizeof(way), found, count * sizeof *found);
}

/* Seen from a cosine, from an angle about the normal that nothing depends on. */
static inline view view_at(uint32_t material, double cosine)
{
    double sine = sqrt(1 - cosine * cosine);
    return (view){.wo = {(float)(0.6 * sine), (float)(-0.8 * sine), (float)cosine},
                  .material = material,
                  .ior1 = 1,
                  .ior2 = 1,
                  .seed = 7};
}

#endif
