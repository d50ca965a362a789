/* A kernel that reads a packed scene, is asked something in a buffer and answers in another. */
#ifndef LR_PACKED_TESTS_H
#define LR_PACKED_TESTS_H

#include "gpu_tests.h"

#include "render/pack.h"
#include "scene/build.h"

typedef struct packed_kernel {
    lr_device *device;
    lr_layout layout;
    lr_buffer frame, rows, out, in, back;
    VkPipeline program;
    VkDescriptorSet set;
} packed_kernel;

/* `in` and `out` are bytes of the questions (LR_BIND_RAYS_IN) and the answers (LR_BIND_FILM). */
static inline void open_packed(packed_kernel *k, lr_device *device, const lr_packed_scene *packed,
                               const lr_program_desc *desc, size_t in, size_t out)
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
    *k = (packed_kernel){.device = device};
    const lr_buffer *buffers[BINDINGS] = {&k->frame, &k->rows, &k->rows, &k->out, &k->in, &k->in};
    size_t bytes = (size_t)packed->row_count * 16;
    MUST(lr_buffer_create(device, LR_BUFFER_UNIFORM, sizeof packed->frame, "frame", &k->frame,
                          error));
    MUST(lr_buffer_create(device, LR_BUFFER_TEXEL, bytes, "rows", &k->rows, error));
    MUST(lr_buffer_create(device, LR_BUFFER_STORAGE, out, "out", &k->out, error));
    MUST(lr_buffer_create(device, LR_BUFFER_STORAGE, in, "in", &k->in, error));
    MUST(lr_buffer_create(device, LR_BUFFER_HOST, out, "back", &k->back, error));
    MUST(lr_buffer_upload(device, &k->frame, &packed->frame, sizeof packed->frame, error));
    MUST(lr_buffer_upload(device, &k->rows, packed->rows, bytes, error));
    lr_layout_desc layout_desc = {types, BINDINGS, sizeof(struct gpu_work), 1};
    MUST(lr_layout_create(device, &layout_desc, &k->layout, error));
    MUST(lr_set_create(device, &k->layout, buffers, &k->set, error));
    MUST(lr_program_create(device, &k->layout, desc, &k->program, error));
}

/* Asks `in` bytes of questions in so many groups; `out` bytes of answers come back. */
static inline void ask_packed(packed_kernel *k, const struct gpu_work *work, uint32_t groups,
                              const void *questions, size_t in, void *answers, size_t out)
{
    MUST(lr_buffer_upload(k->device, &k->in, questions, in, error));
    MUST(lr_commands_begin(k->device, error));
    lr_commands_dispatch(k->device, &k->layout, k->program, k->set, work, groups, 1, 1);
    lr_commands_barrier(k->device);
    lr_commands_copy(k->device, &k->out, &k->back, out);
    MUST(lr_commands_finish(k->device, error));
    memcpy(answers, k->back.mapped, out);
}

static inline void close_packed(packed_kernel *k)
{
    k->device->vk.vkDestroyPipeline(k->device->handle, k->program, NULL);
    lr_layout_destroy(k->device, &k->layout);
    for (int i = 0; i < 5; i++)
        lr_buffer_destroy(k->device,
                          (lr_buffer *[]){&k->frame, &k->rows, &k->out, &k->in, &k->back}[i]);
}

/* A scene that has no materials yet. */
static inline lr_scene *scene_without_materials(void)
{
    static const char text[] = "camera: {}\nobjects: [sphere: {}]";
    lr_scene *scene;
    char *report;
    if (lr_scene_parse(text, sizeof text - 1, "test.yaml", &scene, &report, NULL))
        fail_msg("%s", report);
    free(scene->materials);
    scene->materials = NULL;
    scene->material_count = 0;
    return scene;
}

#endif
