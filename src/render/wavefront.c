/* The passes of the ray tree. */
#include "render/wavefront_internal.h"

#include <string.h>

#include "gpu/commands.h"

/* Workgroups that any device takes along one axis; camera.comp has a sample in each. */
#define LAYERS_MAX 65535

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

/* Traces the rays and shades what they hit. */
static void record_tree(lr_wavefront *w, struct gpu_work *work)
{
    lr_commands_dispatch(w->device, &w->layout, w->trace, w->set, work,
                         groups_for(work->count, LR_GROUP_SIZE), 1, 1);
    record_shade(w, work);
}

/* One bounce of paths. */
static void record_paths(lr_wavefront *w, struct gpu_work *work)
{
    work->shadow_room = w->shadow_room;
    memcpy(work->shadow_first, w->shadow_counts, sizeof work->shadow_first);
    work->sorted = w->shadows_sorted;
    work->light_count = w->scene->light_count;
    lr_commands_dispatch(w->device, &w->layout, w->path, w->set, work,
                         groups_for(work->count, LR_GROUP_SIZE), 1, 1);
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
    uint32_t made = generation == 0 ? rays : 0;
    uint32_t shaded = has_paths(w) ? 0 : c->hits * shade_dispatches(w);
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
    if (has_paths(w) && generation > 0) {
        s->bounced.traced += rays;
        s->bounced.hit += c->hits;
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
    wavefront_reset_counters(w);
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
    uint32_t most = rays * groups_for(lights_asked(w), LR_SHADOW_LIGHTS);
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
    lr_status status = wavefront_open_generation(w, generation, error);
    if (!status)
        status = make_shadow_room(w, rays, generation > 0 && !explains(w), error);
    if (!status)
        status = lr_commands_begin(w->device, error);
    if (status)
        return status;
    work->count = rays;
    if (w->shadows_sorted && waiting_shadows(w) == 0)
        lr_commands_zero(w->device, &w->cells, w->cells.size);
    wavefront_reset_counters(w);
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
    if (has_paths(w))
        record_paths(w, work);
    else
        record_tree(w, work);
    status = finish_pass(w, error);
    if (!status)
        status = take_counts(w, rays, generation, error);
    wavefront_close_if_empty(w, &w->queues[generation]);
    wavefront_close_if_empty(w, &w->queues[generation + 1]);
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

/* Traces the camera rays of `work`, and then the queues until all are empty. */
static lr_status trace_in_queues(lr_wavefront *w, struct gpu_work *work, lr_pass_done done,
                                 void *user, double fraction, lr_error *error)
{
    uint32_t groups[3] = {groups_for(work->tile_width, LR_TILE_GROUP),
                          groups_for(work->tile_height, LR_TILE_GROUP), work->samples};
    uint32_t rays = work->tile_width * work->tile_height * work->samples;
    lr_status status = run_pass(w, 0, work, groups, rays, error);
    if (!status && !done(user, fraction))
        status = lr_fail(error, LR_ERROR_INTERRUPTED, "interrupted");
    return status ? status : drain_queues(w, done, user, fraction, error);
}

/* Takes the paths of all pixels some bounces further, and says how many pixels have paths left. */
static lr_status run_rounds(lr_wavefront *w, const struct gpu_work *work, uint32_t *left,
                            lr_error *error)
{
    lr_status status = lr_commands_begin(w->device, error);
    if (status)
        return status;
    wavefront_reset_counters(w);
    lr_commands_barrier(w->device);
    lr_commands_dispatch(w->device, &w->layout, w->path_loop, w->set, work,
                         groups_for(work->tile_width, LR_TILE_GROUP),
                         groups_for(work->tile_height, LR_TILE_GROUP), 1);
    status = finish_pass(w, error);
    if (status)
        return status;
    const struct gpu_counters *c = w->counters_host.mapped;
    lr_render_stats *s = w->stats;
    s->primary.traced += c->made;
    s->primary.hit += c->made_hits;
    s->bounced.traced += c->traced - c->made;
    s->bounced.hit += c->hits - c->made_hits;
    add_shadow_counts(s, c);
    *left = c->rays;
    if (c->traced == 0 || c->made > c->traced || c->hits > c->traced)
        status = lr_fail(error, LR_ERROR_DEVICE,
                         "the device did not go on with its work; its driver is faulty, try "
                         "--device cpu");
    return status;
}

/* Traces the paths of all pixels one after the other, in passes that stay short. */
static lr_status trace_in_rounds(lr_wavefront *w, struct gpu_work *work, lr_pass_done done,
                                 void *user, const double fractions[2], lr_error *error)
{
    const struct gpu_frame *frame = &w->scene->frame;
    work->plane_rows = frame->planes.base + 2 * frame->planes.begin;
    work->sphere_rows = frame->spheres.base + 2 * frame->spheres.begin;
    work->flat_rows = frame->flats.base + 4 * frame->flats.begin;
    work->solid_rows = frame->solids.base + 5 * frame->solids.begin;
    uint32_t pixels = work->tile_width * work->tile_height, left = pixels;
    lr_status status = wavefront_open_rounds(w, error);
    work->rounds = at_least(at_most(w->chunk_rays / pixels, w->rounds_most), 1);
    uint64_t before = w->stats->primary.traced, paths = (uint64_t)pixels * work->samples;
    while (!status && left > 0) {
        status = run_rounds(w, work, &left, error);
        work->resumed = 1;
        double share = (double)(w->stats->primary.traced - before) / (double)paths;
        if (!status && !done(user, fractions[0] + (fractions[1] - fractions[0]) * share))
            status = lr_fail(error, LR_ERROR_INTERRUPTED, "interrupted");
    }
    if (!status && w->stats->primary.traced - before != paths)
        status = lr_fail(error, LR_ERROR_DEVICE,
                         "the device made %llu of %llu paths; its driver is faulty, try "
                         "--device cpu",
                         (unsigned long long)(w->stats->primary.traced - before),
                         (unsigned long long)paths);
    return status;
}

lr_status lr_wavefront_trace(lr_wavefront *wavefront, const lr_camera_rays *rays, lr_pass_done done,
                             void *user, const double fractions[2], lr_error *error)
{
    lr_wavefront *w = wavefront;
    struct gpu_work work = {
        .tile_x = rays->x,
        .tile_y = rays->y,
        .tile_width = rays->columns,
        .tile_height = rays->rows,
        .first_sample = rays->first_sample,
        .step = rays->step,
        .film_first = rays->film_first,
        .film_pitch = rays->film_pitch,
        .samples = rays->samples,
    };
    double start = lr_now(), cpu_start = lr_cpu_now();
    lr_status status;
    if (w->loops)
        status = trace_in_rounds(w, &work, done, user, fractions, error);
    else
        status = trace_in_queues(w, &work, done, user, fractions[1], error);
    w->stats->trace_seconds += lr_now() - start;
    w->stats->trace_cpu_seconds += lr_cpu_now() - cpu_start;
    return status;
}

lr_status lr_wavefront_settle(lr_wavefront *wavefront, lr_error *error)
{
    double start = lr_now(), cpu_start = lr_cpu_now();
    lr_status status = drain_shadows(wavefront, error);
    wavefront->stats->trace_seconds += lr_now() - start;
    wavefront->stats->trace_cpu_seconds += lr_cpu_now() - cpu_start;
    return status;
}

void lr_wavefront_discard(lr_wavefront *wavefront)
{
    for (uint32_t i = 0; i < LR_GENERATIONS_MAX; i++) {
        wavefront->queues[i].count = 0;
        wavefront_close_if_empty(wavefront, &wavefront->queues[i]);
    }
    memset(wavefront->shadow_counts, 0, sizeof wavefront->shadow_counts);
}

lr_status lr_wavefront_clear(lr_wavefront *wavefront, uint32_t pixels, lr_error *error)
{
    lr_status status = lr_commands_begin(wavefront->device, error);
    if (status)
        return status;
    lr_commands_zero(wavefront->device, &wavefront->film, 4ull * LR_FILM_WORDS * pixels);
    return lr_commands_finish(wavefront->device, error);
}

static lr_status read_film(lr_wavefront *w, const lr_tile *tile, lr_error *error)
{
    double start = lr_now(), cpu_start = lr_cpu_now();
    uint32_t pixels = tile->width * tile->height;
    lr_status status = lr_commands_begin(w->device, error);
    if (status)
        return status;
    lr_commands_copy(w->device, &w->film, &w->film_host, 4ull * LR_FILM_WORDS * pixels);
    status = lr_commands_finish(w->device, error);
    const uint32_t *film = w->film_host.mapped;
    for (uint32_t i = 0; !status && i < pixels; i++)
        if (film[i * LR_FILM_WORDS + LR_FILM_SAMPLES] != tile->samples)
            status = lr_fail(error, LR_ERROR_DEVICE,
                             "the device finished %u of %u samples of a pixel; its driver is "
                             "faulty, try --device cpu",
                             film[i * LR_FILM_WORDS + LR_FILM_SAMPLES], tile->samples);
    w->stats->read_back_seconds += lr_now() - start;
    w->stats->trace_cpu_seconds += lr_cpu_now() - cpu_start;
    return status;
}

lr_status lr_wavefront_render(lr_wavefront *wavefront, const lr_tile *tile, lr_pass_done done,
                              void *user, const uint32_t **film, lr_error *error)
{
    lr_wavefront *w = wavefront;
    uint32_t pixels = tile->width * tile->height, samples = tile->samples;
    lr_status status = lr_wavefront_clear(w, pixels, error);
    uint32_t at_once = w->loops ? samples : at_least(w->chunk_rays / pixels, 1);
    at_once = at_most(at_once, LAYERS_MAX);
    for (uint32_t sample = 0; sample < samples && !status; sample += at_once) {
        lr_camera_rays rays = {
            .x = tile->x,
            .y = tile->y,
            .columns = tile->width,
            .rows = tile->height,
            .step = 1,
            .film_pitch = tile->width,
            .first_sample = tile->first_sample + sample,
            .samples = at_most(at_once, samples - sample),
        };
        double fractions[2] = {(double)sample / samples, (double)(sample + rays.samples) / samples};
        status = lr_wavefront_trace(w, &rays, done, user, fractions, error);
    }
    if (!status)
        status = lr_wavefront_settle(w, error);
    if (!status)
        status = read_film(w, tile, error);
    *film = w->film_host.mapped;
    return status;
}
