#include "render/wavefront.h"

#include <string.h>

#include "camera.spv.h"
#include "gpu/commands.h"
#include "nearest_packet.spv.h"
#include "nearest_ray.spv.h"
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

#define CELLS_SIZE (4ull * LR_CELLS * LR_SHADOW_LIGHTS)

/* RAYS of the kernels named packet. */
#define PACKET_RAYS 4

static uint32_t at_least(uint32_t value, uint32_t least)
{
    return value > least ? value : least;
}

static uint32_t at_most(uint32_t value, uint32_t most)
{
    return value < most ? value : most;
}

static uint32_t groups_for(uint32_t items, uint32_t size)
{
    return (items + size - 1) / size;
}

static bool has_trees(const lr_wavefront *w)
{
    return w->scene->constants[LR_SPEC_TREES];
}

/* How the work is cut up: passes that stay short whatever the number of primitives and lights. */
static void plan(lr_wavefront *w, const lr_render_options *options)
{
    uint32_t primitives = w->scene->tests_per_ray + 8, lights = w->scene->light_count;
    uint32_t fitting = TESTS_PER_PASS / primitives / (has_trees(w) ? 1 : 1 + lights);
    bool software = w->device->info.software;
    uint32_t chunk = at_most(fitting, software ? CHUNK_SOFTWARE : CHUNK_GPU);
    uint32_t lights_a_segment = at_least(groups_for(lights, LR_SHADOW_LIGHTS), 1);
    if (has_trees(w))
        chunk /= lights_a_segment;
    chunk = at_least(chunk, CHUNK_MIN);
    uint32_t pixels = chunk;
    /* A tile whose samples all fit in half a chunk keeps the film in the cache as well. */
    if (software)
        pixels =
            at_most(chunk, at_least(chunk / 2 / at_least(w->scene->frame.samples, 1), 64 * 64));
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
}

/* Bytes of a queue that has room for the children of one chunk. */
static VkDeviceSize queue_size(const lr_wavefront *w)
{
    return 2 * sizeof(struct gpu_ray) * (VkDeviceSize)w->chunk_rays;
}

static VkDeviceSize found_size(const lr_wavefront *w)
{
    return has_trees(w) ? sizeof(struct gpu_hit) * (VkDeviceSize)w->chunk_rays : 16;
}

static VkDeviceSize shadow_size(const lr_wavefront *w)
{
    VkDeviceSize segment = sizeof(struct gpu_shadow_ray) * (VkDeviceSize)w->shadow_room;
    return has_trees(w) ? LR_SHADOW_LIGHTS * segment : 16;
}

static lr_status create_programs(lr_wavefront *w, bool texel_loads, lr_error *error)
{
    uint32_t constants[LR_SPEC_COUNT];
    memcpy(constants, w->scene->constants, sizeof constants);
    uint32_t limit = w->device->limits.maxTexelBufferElements;
    constants[LR_SPEC_TEXEL_LOADS] = texel_loads;
    constants[LR_SPEC_TEXEL_QUEUES] =
        texel_loads && queue_size(w) / 16 <= limit && shadow_size(w) / 16 <= limit;
    constants[LR_SPEC_SHUFFLE] = w->device->shuffle_size >= LR_BATCH;
    const struct {
        const uint32_t *words;
        size_t size;
        VkPipeline *program;
    } wanted[] = {
        {camera_spv, sizeof camera_spv, &w->camera},
        {trace_spv, sizeof trace_spv, &w->trace},
        {shade_spv, sizeof shade_spv, &w->shade},
        {sort_scan_spv, sizeof sort_scan_spv, &w->sort_scan},
        {sort_place_spv, sizeof sort_place_spv, &w->sort_place},
        {nearest_packet_spv, sizeof nearest_packet_spv, &w->nearest},
        {shadow_packet_spv, sizeof shadow_packet_spv, &w->shadow},
        {nearest_ray_spv, sizeof nearest_ray_spv, &w->nearest},
        {shadow_ray_spv, sizeof shadow_ray_spv, &w->shadow},
    };
    /* The last two pairs exclude each other. */
    const size_t always = 3, first_packet = 5, first_ray = 7;
    size_t skipped = w->rays_at_once > 1 ? first_ray : first_packet;
    size_t count = has_trees(w) ? sizeof wanted / sizeof *wanted : always;
    lr_status status = LR_OK;
    for (size_t i = 0; i < count && !status; i++) {
        if (i == skipped || i == skipped + 1)
            continue;
        /* Only the shadow rays of children are sorted. */
        if (i >= always && i < first_packet && !w->scene->constants[LR_SPEC_SCATTER])
            continue;
        lr_program_desc desc = {wanted[i].words, wanted[i].size / 4, constants, LR_SPEC_COUNT};
        status = lr_program_create(w->device, &w->layout, &desc, wanted[i].program, error);
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
        {&w->order, LR_BUFFER_STORAGE, shadow_size(w) / 8, "the order of shadow rays"},
        {&w->none, LR_BUFFER_TEXEL, 256, "nothing"},
    };
    lr_status status = LR_OK;
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted && !status; i++)
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

static void close_if_empty(lr_wavefront *w, lr_queue *queue)
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
        [LR_BIND_SCENE_ROWS] = &w->rows,
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

/* Opens the queues of a pass and points the sets at them. */
static lr_status open_generation(lr_wavefront *w, uint32_t generation, lr_error *error)
{
    lr_queue *queue = &w->queues[generation], *next = queue + 1;
    bool children = w->scene->constants[LR_SPEC_SCATTER];
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

static void reset_counters(lr_wavefront *w)
{
    struct gpu_counters zero = {.hit_groups_y = 1, .hit_groups_z = 1};
    lr_commands_write(w->device, &w->counters, &zero, sizeof zero);
}

/* Drivers compile a kernel when it first runs, so each runs once here on nothing. */
static lr_status warm_up(lr_wavefront *w, lr_error *error)
{
    lr_status status = lr_commands_begin(w->device, error);
    if (status)
        return status;
    struct gpu_work nothing = {0};
    reset_counters(w);
    const VkPipeline programs[] = {w->camera, w->trace,     w->shade,     w->nearest,
                                   w->shadow, w->sort_scan, w->sort_place};
    for (size_t i = 0; i < sizeof programs / sizeof *programs; i++) {
        if (!programs[i])
            continue;
        lr_commands_barrier(w->device);
        lr_commands_dispatch(w->device, &w->layout, programs[i], w->set, &nothing, 1, 1, 1);
    }
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
        status = open_generation(w, 0, error);
    double uploaded = lr_now();
    stats->upload_cpu_seconds += lr_cpu_now() - cpu_start;
    cpu_start = lr_cpu_now();
    bool texel_loads = w->rows.view && !options->storage_loads;
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
    VkPipeline programs[] = {w->camera, w->trace,     w->shade,     w->nearest,
                             w->shadow, w->sort_scan, w->sort_place};
    for (size_t i = 0; i < sizeof programs / sizeof *programs; i++)
        if (programs[i])
            w->device->vk.vkDestroyPipeline(w->device->handle, programs[i], NULL);
    lr_layout_destroy(w->device, &w->layout);
    lr_buffer *buffers[] = {&w->frame,         &w->rows, &w->film, &w->film_host, &w->counters,
                            &w->counters_host, &w->hits, &w->none, &w->found,     &w->shadow_rays};
    for (size_t i = 0; i < sizeof buffers / sizeof *buffers; i++)
        lr_buffer_destroy(w->device, buffers[i]);
    for (uint32_t i = 0; i < w->pool_count; i++)
        lr_buffer_destroy(w->device, &w->pool[i]);
    *w = (lr_wavefront){0};
}

/* Shades the hits of a pass: in several dispatches when there are many lights. */
static void record_shade(lr_wavefront *w, struct gpu_work *work)
{
    work->light = 0;
    work->first_lights = 1;
    work->shadow_room = w->shadow_room;
    memcpy(work->shadow_first, w->shadow_counts, sizeof work->shadow_first);
    work->sorted = w->shadows_sorted;
    do {
        work->light_count = at_most(w->lights_at_once, w->scene->light_count - work->light);
        lr_commands_barrier(w->device);
        lr_commands_dispatch_indirect(w->device, &w->layout, w->shade, w->set, work, &w->counters,
                                      offsetof(struct gpu_counters, hit_groups));
        work->light += work->light_count;
        work->first_lights = 0;
    } while (work->light < w->scene->light_count);
}

static uint32_t shade_dispatches(const lr_wavefront *w)
{
    return at_least(groups_for(w->scene->light_count, w->lights_at_once), 1);
}

static void add_shadow_counts(lr_render_stats *s, const struct gpu_counters *c)
{
    s->shadow.traced += c->shadow;
    s->shadow.hit += c->shadow_hits;
    s->non_finite += c->non_finite;
    s->saturated += c->saturated;
}

/* Adds a pass's counts to the statistics, after checking that no kernel stopped half-way and no
 * queue overflowed: drivers have done either without a word. */
static lr_status take_counts(lr_wavefront *w, uint32_t rays, uint32_t generation, lr_error *error)
{
    const struct gpu_counters *c = w->counters_host.mapped;
    uint32_t made = generation == 0 ? rays : 0, shaded = c->hits * shade_dispatches(w);
    uint32_t found = has_trees(w) ? rays : 0;
    bool fits = true;
    for (uint32_t i = 0; i < LR_SHADOW_LIGHTS; i++) {
        w->shadow_counts[i] += c->shadow_rays[i];
        fits = fits && w->shadow_counts[i] <= w->shadow_room;
    }
    if (c->made != made || c->traced != rays || c->hits > rays || c->rays > 2 * w->chunk_rays ||
        c->shaded != shaded || c->found != found || c->unfinished || !fits)
        return lr_fail(error, LR_ERROR_DEVICE,
                       "the device did not finish its work (%u of %u camera rays made, %u of %u "
                       "rays traced, %u of %u hits shaded); its driver is faulty, try "
                       "--device cpu",
                       c->made, made, c->traced, rays, c->shaded, shaded);
    lr_render_stats *s = w->stats;
    if (generation == 0) {
        s->primary.traced += rays;
        s->primary.hit += c->hits;
    }
    s->reflected.traced += c->reflected;
    s->reflected.hit += c->reflected_hits;
    s->refracted.traced += c->refracted;
    s->refracted.hit += c->refracted_hits;
    add_shadow_counts(s, c);
    s->passed += c->passed;
    s->dropped_depth += c->dropped_depth;
    s->dropped_weight += c->dropped_weight;
    s->dropped_nesting += c->dropped_nesting;
    w->queues[generation + 1].count = c->rays;
    return LR_OK;
}

/* Submits what was recorded and reads the counters back. */
static lr_status finish_pass(lr_wavefront *w, lr_error *error)
{
    lr_commands_barrier(w->device);
    lr_commands_copy(w->device, &w->counters, &w->counters_host, sizeof(struct gpu_counters));
    double start = lr_now();
    lr_status status = lr_commands_finish(w->device, error);
    double seconds = lr_now() - start;
    if (seconds > w->stats->longest_pass_seconds)
        w->stats->longest_pass_seconds = seconds;
    return status;
}

/* Brings the shadow rays of each segment into the order of the cells that they end in. */
static void record_sort(lr_wavefront *w)
{
    struct gpu_work work = {.shadow_room = w->shadow_room};
    lr_commands_dispatch(w->device, &w->layout, w->sort_scan, w->set, &work, LR_SHADOW_LIGHTS, 1,
                         1);
    lr_commands_barrier(w->device);
    for (work.light = 0; work.light < LR_SHADOW_LIGHTS; work.light++) {
        work.count = w->shadow_counts[work.light];
        if (work.count)
            lr_commands_dispatch(w->device, &w->layout, w->sort_place, w->set, &work,
                                 groups_for(work.count, LR_GROUP_SIZE), 1, 1);
    }
    lr_commands_barrier(w->device);
}

static uint64_t waiting_shadows(const lr_wavefront *w)
{
    uint64_t total = 0;
    for (uint32_t i = 0; i < LR_SHADOW_LIGHTS; i++)
        total += w->shadow_counts[i];
    return total;
}

/* Traces the shadow rays that wait in the segments. */
static lr_status drain_shadows(lr_wavefront *w, lr_error *error)
{
    uint64_t total = waiting_shadows(w);
    if (total == 0)
        return LR_OK;
    lr_status status = lr_commands_begin(w->device, error);
    if (status)
        return status;
    reset_counters(w);
    lr_commands_barrier(w->device);
    if (w->shadows_sorted)
        record_sort(w);
    struct gpu_work work = {.shadow_room = w->shadow_room, .sorted = w->shadows_sorted};
    for (work.light = 0; work.light < LR_SHADOW_LIGHTS; work.light++) {
        work.count = w->shadow_counts[work.light];
        uint32_t groups = groups_for(work.count, LR_GROUP_SIZE * w->rays_at_once);
        if (groups)
            lr_commands_dispatch(w->device, &w->layout, w->shadow, w->set, &work, groups, 1, 1);
        w->shadow_counts[work.light] = 0;
    }
    status = finish_pass(w, error);
    const struct gpu_counters *c = w->counters_host.mapped;
    if (!status && (c->shadow != total || c->unfinished))
        status = lr_fail(error, LR_ERROR_DEVICE,
                         "the device finished %u of %llu shadow rays, %u of them half-way; its "
                         "driver is faulty, try --device cpu",
                         c->shadow, (unsigned long long)total, c->unfinished);
    add_shadow_counts(w->stats, c);
    return status;
}

/* Traces the waiting shadow rays if those of `rays` more hits might not fit. Those of camera rays
 * come in a good order; those of their children are sorted, and so wait for as many as there are.
 */
static lr_status make_shadow_room(lr_wavefront *w, uint32_t rays, bool sorted, lr_error *error)
{
    uint32_t most = rays * groups_for(w->scene->light_count, LR_SHADOW_LIGHTS);
    bool fits = w->shadows_sorted == sorted;
    for (uint32_t i = 0; i < LR_SHADOW_LIGHTS; i++)
        fits = fits && w->shadow_counts[i] + most <= w->shadow_room;
    lr_status status = fits ? LR_OK : drain_shadows(w, error);
    w->shadows_sorted = sorted;
    return status;
}

/* One pass: in generation 0 make camera rays; trace `rays` rays from work->first; shade. */
static lr_status run_pass(lr_wavefront *w, uint32_t generation, struct gpu_work *work,
                          const uint32_t camera_groups[3], uint32_t rays, lr_error *error)
{
    lr_status status = open_generation(w, generation, error);
    if (!status)
        status = make_shadow_room(w, rays, generation > 0, error);
    if (!status)
        status = lr_commands_begin(w->device, error);
    if (status)
        return status;
    work->count = rays;
    if (w->shadows_sorted && waiting_shadows(w) == 0)
        lr_commands_zero(w->device, &w->cells, w->cells.size);
    reset_counters(w);
    lr_commands_barrier(w->device);
    if (camera_groups) {
        lr_commands_dispatch(w->device, &w->layout, w->camera, w->camera_set, work,
                             camera_groups[0], camera_groups[1], camera_groups[2]);
        lr_commands_barrier(w->device);
    }
    if (has_trees(w)) {
        lr_commands_dispatch(w->device, &w->layout, w->nearest, w->set, work,
                             groups_for(rays, LR_GROUP_SIZE * w->rays_at_once), 1, 1);
        lr_commands_barrier(w->device);
    }
    lr_commands_dispatch(w->device, &w->layout, w->trace, w->set, work,
                         groups_for(rays, LR_GROUP_SIZE), 1, 1);
    record_shade(w, work);
    status = finish_pass(w, error);
    if (!status)
        status = take_counts(w, rays, generation, error);
    close_if_empty(w, &w->queues[generation]);
    close_if_empty(w, &w->queues[generation + 1]);
    return status;
}

/* Traces the queues until all are empty, the deepest first. */
static lr_status drain_queues(lr_wavefront *w, lr_pass_done done, void *user, double fraction,
                              lr_error *error)
{
    uint32_t generation = 1;
    while (generation > 0) {
        lr_queue *queue = &w->queues[generation];
        if (queue->count == 0) {
            generation--;
            continue;
        }
        if (generation + 1 == LR_GENERATIONS_MAX)
            return lr_fail(error, LR_ERROR_DEVICE, "the ray tree did not end");
        uint32_t rays = at_most(queue->count, w->chunk_rays);
        queue->count -= rays;
        struct gpu_work work = {.first = queue->count};
        lr_status status = run_pass(w, generation, &work, NULL, rays, error);
        if (status)
            return status;
        if (!done(user, fraction))
            return lr_fail(error, LR_ERROR_INTERRUPTED, "interrupted");
        generation++;
    }
    return LR_OK;
}

static lr_status read_film(lr_wavefront *w, const lr_tile *tile, uint32_t samples, lr_error *error)
{
    double start = lr_now();
    uint32_t pixels = tile->width * tile->height;
    lr_status status = lr_commands_begin(w->device, error);
    if (status)
        return status;
    lr_commands_copy(w->device, &w->film, &w->film_host, 4ull * LR_FILM_WORDS * pixels);
    status = lr_commands_finish(w->device, error);
    const uint32_t *film = w->film_host.mapped;
    for (uint32_t i = 0; !status && i < pixels; i++)
        if (film[i * LR_FILM_WORDS + LR_FILM_SAMPLES] != samples)
            status = lr_fail(error, LR_ERROR_DEVICE,
                             "the device finished %u of %u samples of a pixel; its driver is "
                             "faulty, try --device cpu",
                             film[i * LR_FILM_WORDS + LR_FILM_SAMPLES], samples);
    w->stats->read_back_seconds += lr_now() - start;
    return status;
}

lr_status lr_wavefront_render(lr_wavefront *wavefront, const lr_tile *tile, lr_pass_done done,
                              void *user, const uint32_t **film, lr_error *error)
{
    lr_wavefront *w = wavefront;
    double start = lr_now(), read_before = w->stats->read_back_seconds, cpu_start = lr_cpu_now();
    uint32_t pixels = tile->width * tile->height, samples = w->scene->frame.samples;
    lr_status status = lr_commands_begin(w->device, error);
    if (!status) {
        lr_commands_zero(w->device, &w->film, 4ull * LR_FILM_WORDS * pixels);
        status = lr_commands_finish(w->device, error);
    }
    uint32_t at_once = at_least(w->chunk_rays / pixels, 1);
    for (uint32_t sample = 0; sample < samples && !status; sample += at_once) {
        uint32_t count = at_most(at_once, samples - sample);
        struct gpu_work work = {.tile_x = tile->x,
                                .tile_y = tile->y,
                                .tile_width = tile->width,
                                .tile_height = tile->height,
                                .first_sample = sample};
        uint32_t groups[3] = {groups_for(tile->width, LR_TILE_GROUP),
                              groups_for(tile->height, LR_TILE_GROUP), count};
        double fraction = (double)(sample + count) / samples;
        status = run_pass(w, 0, &work, groups, pixels * count, error);
        if (!status && !done(user, fraction))
            status = lr_fail(error, LR_ERROR_INTERRUPTED, "interrupted");
        if (!status)
            status = drain_queues(w, done, user, fraction, error);
    }
    if (!status)
        status = drain_shadows(w, error);
    if (!status)
        status = read_film(w, tile, samples, error);
    *film = w->film_host.mapped;
    w->stats->trace_seconds += lr_now() - start - (w->stats->read_back_seconds - read_before);
    w->stats->trace_cpu_seconds += lr_cpu_now() - cpu_start;
    return status;
}
