/* The ray tree made ready: how the work is cut up, programs, buffers, queues. */
#include "render/wavefront_internal.h"

#include <string.h>

#include "camera.spv.h"
#include "gpu/commands.h"
#include "nearest_packet.spv.h"
#include "nearest_ray.spv.h"
#include "path.spv.h"
#include "path_loop.spv.h"
#include "shade.spv.h"
#include "shadow_packet.spv.h"
#include "shadow_ray.spv.h"
#include "sort_place.spv.h"
#include "sort_scan.spv.h"
#include "trace.spv.h"

/* Rays, towards lights too, times primitives that one pass may test: some 50 ms on two cores. */
#define TESTS_PER_PASS (1u << 23)

/* lavapipe of Mesa 22.3 silently ends all loops of an invocation after some 65,000 iterations
 * (docs/drivers.md); this stays far below. */
#define LOOPS_PER_INVOCATION 16384

/* Rays handed to a device at once: as many as it takes to fill a GPU, or as caches hold. */
#define CHUNK_GPU 262144
#define CHUNK_SOFTWARE 131072
#define CHUNK_MIN 256

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

#define CELLS_SIZE (4ull * LR_CELLS * LR_SHADOW_LIGHTS)

/* Whether paths stay in registers on software devices, where trees do not need queues: on lavapipe
 * a bounce through queues takes longer by half at least (docs/performance.md). Not on SwiftShader,
 * whose compiler takes gigabytes and minutes for that kernel. */
#define LOOPS_ON_SOFTWARE 1

/* RAYS of the kernels named packet. */
#define PACKET_RAYS 4

/* How the work is cut up: passes that stay short whatever the number of primitives and lights. */
static void plan(lr_wavefront *w, const lr_render_options *options)
{
    uint32_t primitives = w->scene->tests_per_ray + 8, lights = lights_asked(w);
    uint32_t fitting = TESTS_PER_PASS / primitives / (has_trees(w) ? 1 : 1 + lights);
    bool software = w->device->info.software;
    uint32_t chunk = at_most(fitting, software ? CHUNK_SOFTWARE : CHUNK_GPU);
    uint32_t lights_a_segment = at_least(groups_for(lights, LR_SHADOW_LIGHTS), 1);
    if (has_trees(w))
        chunk /= lights_a_segment;
    chunk = at_least(chunk, CHUNK_MIN);
    uint32_t pixels = chunk, samples = w->scene->moment ? 1 : at_least(w->scene->frame.samples, 1);
    /* A tile whose samples all fit in half a chunk keeps the film in the cache as well. */
    if (software)
        pixels = at_most(chunk, at_least(chunk / 2 / samples, 64 * 64));
    w->tile_size = 256;
    while (w->tile_size > 8 && w->tile_size * w->tile_size > pixels)
        w->tile_size /= 2;
    if (options->chunk_rays)
        chunk = options->chunk_rays;
    if (options->tile_size)
        w->tile_size = at_least(at_most(options->tile_size, 1024), 1);
    w->chunk_rays = at_least(chunk, w->tile_size * w->tile_size);
    uint32_t at_once = at_least(LOOPS_PER_INVOCATION / primitives, 1);
    w->lights_at_once = at_most(at_once, at_least(lights, 1));
    w->shadow_room = 2 * w->chunk_rays * lights_a_segment;
    /* Where a subgroup is one batch its rays go through a tree together. */
    bool packets = software && w->device->shuffle_size == LR_BATCH && !options->single_rays;
    w->rays_at_once = packets ? PACKET_RAYS : 1;
    w->rounds_most = at_least(LOOPS_PER_INVOCATION / (2 * primitives), 1);
    w->loops = LOOPS_ON_SOFTWARE && software && w->device->shuffle_size == LR_BATCH &&
               has_paths(w) && !has_trees(w);
}

/* Bytes of a queue that has room for the children of one chunk. */
static VkDeviceSize queue_size(const lr_wavefront *w)
{
    size_t ray = sizeof(struct gpu_ray) + (has_paths(w) ? sizeof(struct gpu_path) : 0);
    return (has_paths(w) ? 1 : 2) * ray * (VkDeviceSize)w->chunk_rays;
}

static VkDeviceSize found_size(const lr_wavefront *w)
{
    return has_trees(w) ? sizeof(struct gpu_hit) * (VkDeviceSize)w->chunk_rays : 16;
}

static VkDeviceSize shadow_size(const lr_wavefront *w)
{
    size_t ray = sizeof(struct gpu_shadow_ray) + (has_paths(w) ? sizeof(struct gpu_shadow_way) : 0);
    uint32_t segments = has_paths(w) ? 1 : LR_SHADOW_LIGHTS;
    return has_trees(w) ? segments * ray * (VkDeviceSize)w->shadow_room : 16;
}

/* What explains does not sort, and has its notes there. */
static VkDeviceSize order_size(const lr_wavefront *w)
{
    return explains(w) ? sizeof(struct gpu_notes) : shadow_size(w) / 8;
}

/* A scene may be too large for a storage buffer, and is then read as a texel buffer only. */
static bool storage_fits(const lr_wavefront *w)
{
    return w->rows.size <= w->device->limits.maxStorageBufferRange;
}

static lr_status create_programs(lr_wavefront *w, bool texel_loads, lr_error *error)
{
    uint32_t constants[LR_SPEC_COUNT];
    memcpy(constants, w->scene->constants, sizeof constants);
    uint32_t limit = w->device->limits.maxTexelBufferElements;
    constants[LR_SPEC_TEXEL_LOADS] = texel_loads;
    constants[LR_SPEC_FEW] &= w->loops && storage_fits(w);
    constants[LR_SPEC_TEXEL_QUEUES] =
        texel_loads && queue_size(w) / 16 <= limit && shadow_size(w) / 16 <= limit;
    constants[LR_SPEC_SHUFFLE] = w->device->shuffle_size >= LR_BATCH;
    /* Only the shadow rays of children are sorted. */
    bool trees = has_trees(w), packets = w->rays_at_once > 1;
    bool paths = has_paths(w);
    bool sorts = trees && !explains(w) && (paths || w->scene->constants[LR_SPEC_SCATTER]);
    const struct {
        const uint32_t *words;
        size_t size;
        VkPipeline *program;
        bool needed;
    } kernels[] = {
        {camera_spv, sizeof camera_spv, &w->camera, !w->loops},
        {trace_spv, sizeof trace_spv, &w->trace, !paths},
        {shade_spv, sizeof shade_spv, &w->shade, !paths},
        {path_spv, sizeof path_spv, &w->path, paths && !w->loops},
        {path_loop_spv, sizeof path_loop_spv, &w->path_loop, w->loops},
        {sort_scan_spv, sizeof sort_scan_spv, &w->sort_scan, sorts},
        {sort_place_spv, sizeof sort_place_spv, &w->sort_place, sorts},
        {nearest_packet_spv, sizeof nearest_packet_spv, &w->nearest, trees && packets},
        {shadow_packet_spv, sizeof shadow_packet_spv, &w->shadow, trees && packets},
        {nearest_ray_spv, sizeof nearest_ray_spv, &w->nearest, trees && !packets},
        {shadow_ray_spv, sizeof shadow_ray_spv, &w->shadow, trees && !packets},
    };
    lr_status status = LR_OK;
    for (size_t i = 0; i < COUNT_OF(kernels) && !status; i++) {
        lr_program_desc desc = {kernels[i].words, kernels[i].size / 4, constants, LR_SPEC_COUNT};
        if (kernels[i].needed)
            status = lr_program_take(w->device, &w->layout, &desc, kernels[i].program, error);
    }
    return status;
}

static lr_status create_buffers(lr_wavefront *w, lr_error *error)
{
    VkDeviceSize film_size = 4ull * LR_FILM_WORDS * w->tile_size * w->tile_size;
    const struct {
        lr_buffer *buffer;
        lr_buffer_kind kind;
        VkDeviceSize size;
        const char *what;
    } wanted[] = {
        {&w->frame, LR_BUFFER_UNIFORM, sizeof(struct gpu_frame), "the frame"},
        {&w->rows, LR_BUFFER_TEXEL, 16ull * w->scene->row_count, "the scene"},
        {&w->film, LR_BUFFER_STORAGE, film_size, "the film"},
        {&w->film_host, LR_BUFFER_HOST, film_size, "the film"},
        {&w->counters, LR_BUFFER_STORAGE, sizeof(struct gpu_counters), "the counters"},
        {&w->counters_host, LR_BUFFER_HOST, sizeof(struct gpu_counters), "the counters"},
        {&w->hits, LR_BUFFER_TEXEL, sizeof(struct gpu_hit) * (VkDeviceSize)w->chunk_rays,
         "the hits"},
        {&w->found, LR_BUFFER_TEXEL, found_size(w), "the nearest hits"},
        {&w->shadow_rays, LR_BUFFER_TEXEL, shadow_size(w), "the queue of shadow rays"},
        {&w->cells, LR_BUFFER_STORAGE, has_trees(w) ? CELLS_SIZE : 16, "sorting"},
        {&w->order, LR_BUFFER_STORAGE, order_size(w), "the order of shadow rays"},
        {&w->none, LR_BUFFER_TEXEL, 256, "nothing"},
    };
    lr_status status = LR_OK;
    for (size_t i = 0; i < COUNT_OF(wanted) && !status; i++)
        status = lr_buffer_create(w->device, wanted[i].kind, wanted[i].size, wanted[i].what,
                                  wanted[i].buffer, error);
    if (!status)
        status =
            lr_buffer_upload(w->device, &w->frame, &w->scene->frame, sizeof w->scene->frame, error);
    if (!status)
        status = lr_buffer_upload(w->device, &w->rows, w->scene->rows,
                                  16 * (size_t)w->scene->row_count, error);
    return status;
}

static lr_status create_layout(lr_wavefront *w, lr_error *error)
{
    VkDescriptorType types[LR_BIND_COUNT];
    for (uint32_t i = 0; i < LR_BIND_COUNT; i++)
        types[i] = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    types[LR_BIND_FRAME] = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    types[LR_BIND_SCENE_TEXEL] = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    types[LR_BIND_RAYS_TEXEL] = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    types[LR_BIND_HITS_TEXEL] = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    types[LR_BIND_FOUND_TEXEL] = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    types[LR_BIND_SHADOWS_TEXEL] = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    lr_layout_desc desc = {types, LR_BIND_COUNT, sizeof(struct gpu_work), 2};
    return lr_layout_create(w->device, &desc, &w->layout, error);
}

static_assert(offsetof(lr_wavefront, sort_place) + sizeof(VkPipeline) ==
                  offsetof(lr_wavefront, programs) + sizeof(VkPipeline[9]),
              "programs[] holds all programs");
static_assert(LR_SPEC_COUNT <= LR_PROGRAM_CONSTANTS_MAX, "programs are told by all constants");
static_assert(offsetof(lr_wavefront, order) + sizeof(lr_buffer) ==
                  offsetof(lr_wavefront, buffers) + sizeof(lr_buffer[12]),
              "buffers[] holds all buffers");

/* Gives an empty queue a buffer for the children of one chunk. */
static lr_status open_queue(lr_wavefront *w, lr_queue *queue, lr_error *error)
{
    if (queue->rays)
        return LR_OK;
    if (w->unused_count == 0) {
        lr_buffer *buffer = &w->pool[w->pool_count];
        lr_status status = lr_buffer_create(w->device, LR_BUFFER_TEXEL, queue_size(w),
                                            "the queue of rays", buffer, error);
        if (status)
            return status;
        w->pool_count++;
        w->unused[w->unused_count++] = buffer;
    }
    queue->rays = w->unused[--w->unused_count];
    return LR_OK;
}

void wavefront_close_if_empty(lr_wavefront *w, lr_queue *queue)
{
    if (!queue->rays || queue->count > 0)
        return;
    w->unused[w->unused_count++] = queue->rays;
    queue->rays = NULL;
}

/* The buffers of the kernels that read the rays of one queue and write those of another. */
static void list_buffers(const lr_wavefront *w, const lr_buffer *rays_in, const lr_buffer *rays_out,
                         const lr_buffer *buffers[LR_BIND_COUNT])
{
    const lr_buffer *list[LR_BIND_COUNT] = {
        [LR_BIND_FRAME] = &w->frame,
        [LR_BIND_SCENE_TEXEL] = w->rows.view ? &w->rows : &w->none,
        [LR_BIND_SCENE_ROWS] = storage_fits(w) ? &w->rows : &w->none,
        [LR_BIND_FILM] = &w->film,
        [LR_BIND_COUNTERS] = &w->counters,
        [LR_BIND_RAYS_IN] = rays_in,
        [LR_BIND_RAYS_OUT] = rays_out,
        [LR_BIND_HITS] = &w->hits,
        [LR_BIND_RAYS_TEXEL] = rays_in->view ? rays_in : &w->none,
        [LR_BIND_HITS_TEXEL] = w->hits.view ? &w->hits : &w->none,
        [LR_BIND_FOUND] = &w->found,
        [LR_BIND_FOUND_TEXEL] = w->found.view ? &w->found : &w->none,
        [LR_BIND_SHADOWS] = &w->shadow_rays,
        [LR_BIND_SHADOWS_TEXEL] = w->shadow_rays.view ? &w->shadow_rays : &w->none,
        [LR_BIND_CELLS] = &w->cells,
        [LR_BIND_ORDER] = &w->order,
    };
    memcpy(buffers, list, sizeof list);
}

static lr_status create_sets(lr_wavefront *w, lr_error *error)
{
    const lr_buffer *buffers[LR_BIND_COUNT];
    list_buffers(w, &w->none, &w->none, buffers);
    lr_status status = lr_set_create(w->device, &w->layout, buffers, &w->camera_set, error);
    if (!status)
        status = lr_set_create(w->device, &w->layout, buffers, &w->set, error);
    return status;
}

lr_status wavefront_open_generation(lr_wavefront *w, uint32_t generation, lr_error *error)
{
    lr_queue *queue = &w->queues[generation], *next = queue + 1;
    bool children = has_paths(w) || w->scene->constants[LR_SPEC_SCATTER];
    lr_status status = open_queue(w, queue, error);
    if (!status && children)
        status = open_queue(w, next, error);
    if (status)
        return status;
    const lr_buffer *buffers[LR_BIND_COUNT];
    list_buffers(w, queue->rays, children ? next->rays : &w->none, buffers);
    lr_set_write(w->device, &w->layout, buffers, w->set);
    if (generation == 0) {
        list_buffers(w, &w->none, queue->rays, buffers);
        lr_set_write(w->device, &w->layout, buffers, w->camera_set);
    }
    return LR_OK;
}

lr_status wavefront_open_rounds(lr_wavefront *w, lr_error *error)
{
    lr_status status = open_queue(w, &w->queues[0], error);
    if (status)
        return status;
    const lr_buffer *buffers[LR_BIND_COUNT];
    list_buffers(w, w->queues[0].rays, w->queues[0].rays, buffers);
    lr_set_write(w->device, &w->layout, buffers, w->set);
    return LR_OK;
}

void wavefront_reset_counters(lr_wavefront *w)
{
    struct gpu_counters zero = {.hit_groups_y = 1, .hit_groups_z = 1};
    lr_commands_write(w->device, &w->counters, 0, &zero, sizeof zero);
}

/* Drivers compile a kernel when it first runs, so each runs once here on nothing; those that the
 * device has kept are ready. */
static lr_status warm_up(lr_wavefront *w, lr_error *error)
{
    lr_status status = lr_commands_begin(w->device, error);
    if (status)
        return status;
    struct gpu_work nothing = {0};
    wavefront_reset_counters(w);
    for (size_t i = 0; i < COUNT_OF(w->programs); i++) {
        if (!w->programs[i])
            continue;
        lr_commands_barrier(w->device);
        lr_commands_dispatch(w->device, &w->layout, w->programs[i], w->set, &nothing, 1, 1, 1);
    }
    return lr_commands_finish(w->device, error);
}

static bool is_texel_buffer(const lr_wavefront *w, const lr_packed_scene *scene)
{
    return scene->row_count <= w->device->limits.maxTexelBufferElements;
}

/* Passes may become twice as long, or half. */
static bool is_near(uint32_t a, uint32_t b)
{
    return a <= 2 * b && b <= 2 * a;
}

bool lr_wavefront_suits(const lr_wavefront *w, const lr_packed_scene *scene,
                        const lr_render_options *options)
{
    lr_wavefront other = {.device = w->device, .scene = scene};
    plan(&other, options);
    return !memcmp(w->scene->constants, scene->constants, sizeof scene->constants) &&
           is_texel_buffer(w, w->scene) && is_texel_buffer(w, scene) &&
           lights_asked(&other) == lights_asked(w) && is_near(other.chunk_rays, w->chunk_rays) &&
           is_near(other.lights_at_once, w->lights_at_once) &&
           is_near(other.rounds_most, w->rounds_most) && other.loops == w->loops &&
           other.rays_at_once == w->rays_at_once;
}

lr_status lr_wavefront_replace_scene(lr_wavefront *w, const lr_packed_scene *scene, lr_error *error)
{
    lr_status status = LR_OK;
    VkDeviceSize size = 16ull * scene->row_count;
    w->scene = scene;
    if (size != w->rows.size) {
        lr_buffer_destroy(w->device, &w->rows);
        status = lr_buffer_create(w->device, LR_BUFFER_TEXEL, size, "the scene", &w->rows, error);
    }
    if (!status)
        status = lr_buffer_upload(w->device, &w->rows, scene->rows, size, error);
    return status;
}

lr_status lr_wavefront_resize_film(lr_wavefront *w, uint32_t pixels, lr_error *error)
{
    lr_buffer_destroy(w->device, &w->film);
    return lr_buffer_create(w->device, LR_BUFFER_STORAGE, 4ull * LR_FILM_WORDS * pixels, "the film",
                            &w->film, error);
}

lr_status lr_wavefront_update_camera(lr_wavefront *w, lr_error *error)
{
    lr_status status = lr_commands_begin(w->device, error);
    if (status)
        return status;
    lr_commands_write(w->device, &w->frame, 0, &w->scene->frame, sizeof w->scene->frame);
    uint32_t light = w->scene->frame.lights;
    if (w->scene->light_count > 0)
        lr_commands_write(w->device, &w->rows, 16ull * light, &w->scene->rows[light],
                          sizeof(struct gpu_light));
    return lr_commands_finish(w->device, error);
}

lr_status lr_wavefront_create(lr_device *device, const lr_packed_scene *scene,
                              const lr_render_options *options, lr_render_stats *stats,
                              lr_wavefront *wavefront, lr_error *error)
{
    *wavefront = (lr_wavefront){.device = device, .scene = scene, .stats = stats};
    lr_wavefront *w = wavefront;
    plan(w, options);
    double start = lr_now(), cpu_start = lr_cpu_now();
    lr_status status = create_layout(w, error);
    if (!status)
        status = create_buffers(w, error);
    if (!status)
        status = create_sets(w, error);
    if (!status)
        status = wavefront_open_generation(w, 0, error);
    double uploaded = lr_now();
    stats->upload_cpu_seconds += lr_cpu_now() - cpu_start;
    cpu_start = lr_cpu_now();
    bool texel_loads = w->rows.view && !(options->storage_loads && storage_fits(w));
    if (!status)
        status = create_programs(w, texel_loads, error);
    if (!status)
        status = warm_up(w, error);
    stats->upload_seconds += uploaded - start;
    stats->compile_seconds += lr_now() - uploaded;
    stats->compile_cpu_seconds += lr_cpu_now() - cpu_start;
    if (status)
        lr_wavefront_destroy(w);
    return status;
}

void lr_wavefront_destroy(lr_wavefront *wavefront)
{
    lr_wavefront *w = wavefront;
    if (!w->device)
        return;
    for (size_t i = 0; i < COUNT_OF(w->programs); i++)
        if (w->programs[i])
            lr_program_give_back(w->device, w->programs[i]);
    lr_layout_destroy(w->device, &w->layout);
    for (size_t i = 0; i < COUNT_OF(w->buffers); i++)
        lr_buffer_destroy(w->device, &w->buffers[i]);
    for (uint32_t i = 0; i < w->pool_count; i++)
        lr_buffer_destroy(w->device, &w->pool[i]);
    *w = (lr_wavefront){0};
}
