/* One material on the device, seen from one direction: evaluated, sampled, summed up. */
#ifndef LR_BSDF_TESTS_H
#define LR_BSDF_TESTS_H

#include "gpu_tests.h"

#include "bsdf.spv.h"
#include "render/pack.h"
#include "scene/build.h"

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
    lr_device *device;
    lr_scene *scene;
    lr_packed_scene packed;
    lr_layout layout;
    lr_buffer frame, rows, out, in, back;
    VkPipeline program;
    VkDescriptorSet set;
} harness;

static question asked;
static answer found[MOST];

static inline lr_scene *scene_of(const lr_material *materials, uint32_t count)
{
    static const char text[] = "camera: {}\nobjects: [sphere: {}]";
    lr_scene *scene;
    char *report;
    if (lr_scene_parse(text, sizeof text - 1, "test.yaml", &scene, &report, NULL))
        fail_msg("%s", report);
    lr_scene_builder builder = {.scene = scene};
    free(scene->materials);
    scene->materials = NULL;
    scene->material_count = 0;
    for (uint32_t i = 0; i < count; i++)
        *lr_scene_add_material(&builder) = materials[i];
    return scene;
}

/* The materials must need no memory of their own: their names are NULL. */
static inline void open_harness(harness *h, lr_device *device, const lr_material *materials,
                                uint32_t count)
{
    enum { BINDINGS = LR_BIND_RAYS_IN + 1 };
    static const VkDescriptorType types[BINDINGS] = {
        [LR_BIND_FRAME] = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
        [LR_BIND_SCENE_TEXEL] = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,
        [LR_BIND_SCENE_ROWS] = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
        [LR_BIND_FILM] = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
        [LR_BIND_COUNTERS] = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
        [LR_BIND_RAYS_IN] = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
    };
    *h = (harness){.device = device, .scene = scene_of(materials, count)};
    lr_settings settings = {.width = 1,
                            .height = 1,
                            .samples = 1,
                            .camera = &h->scene->cameras[0],
                            .integrator = LR_INTEGRATOR_PATH};
    MUST(lr_pack_scene(h->scene, &settings, &h->packed, error));
    size_t bytes = (size_t)h->packed.row_count * 16;
    MUST(lr_buffer_create(device, LR_BUFFER_UNIFORM, sizeof h->packed.frame, "frame", &h->frame,
                          error));
    MUST(lr_buffer_create(device, LR_BUFFER_TEXEL, bytes, "rows", &h->rows, error));
    MUST(lr_buffer_create(device, LR_BUFFER_STORAGE, sizeof found, "out", &h->out, error));
    MUST(lr_buffer_create(device, LR_BUFFER_STORAGE, sizeof asked, "in", &h->in, error));
    MUST(lr_buffer_create(device, LR_BUFFER_HOST, sizeof found, "back", &h->back, error));
    MUST(lr_buffer_upload(device, &h->frame, &h->packed.frame, sizeof h->packed.frame, error));
    MUST(lr_buffer_upload(device, &h->rows, h->packed.rows, bytes, error));
    lr_layout_desc layout_desc = {types, BINDINGS, sizeof(struct gpu_work), 1};
    lr_program_desc desc = {bsdf_spv, sizeof bsdf_spv / 4, h->packed.constants, LR_SPEC_COUNT};
    const lr_buffer *buffers[BINDINGS] = {&h->frame, &h->rows, &h->rows, &h->out, &h->in, &h->in};
    MUST(lr_layout_create(device, &layout_desc, &h->layout, error));
    MUST(lr_set_create(device, &h->layout, buffers, &h->set, error));
    MUST(lr_program_create(device, &h->layout, &desc, &h->program, error));
}

static inline void close_harness(harness *h)
{
    h->device->vk.vkDestroyPipeline(h->device->handle, h->program, NULL);
    lr_layout_destroy(h->device, &h->layout);
    for (int i = 0; i < 5; i++)
        lr_buffer_destroy(h->device,
                          (lr_buffer *[]){&h->frame, &h->rows, &h->out, &h->in, &h->back}[i]);
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
    MUST(
        lr_buffer_upload(h->device, &h->in, &asked, sizeof asked.view + ways * sizeof(way), error));
    MUST(lr_commands_begin(h->device, error));
    lr_commands_dispatch(h->device, &h->layout, h->program, h->set, &work, count / LR_GROUP_SIZE, 1,
                         1);
    lr_commands_barrier(h->device);
    lr_commands_copy(h->device, &h->out, &h->back, count * sizeof *found);
    MUST(lr_commands_finish(h->device, error));
    memcpy(found, h->back.mapped, count * sizeof *found);
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
