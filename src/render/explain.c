/* One pixel rendered by kernels that note every ray. */
#include "render/explain.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "gpu/commands.h"
#include "render/explain_internal.h"
#include "render/film.h"
#include "render/settings.h"
#include "scene/moment.h"
#include "render/wavefront.h"

typedef struct explaining {
    const lr_render_options *options;
    const lr_render_stats *stats;
    bool noting, too_large;
} explaining;

/* A tree that is too large is not traced to its end, which may be far. */
static bool pass_done(void *user, double fraction)
{
    explaining *e = user;
    const lr_render_stats *s = e->stats;
    uint64_t rays = s->primary.traced + s->reflected.traced + s->refracted.traced + s->passed;
    e->too_large = e->noting && rays >= LR_NOTED_RAYS;
    if (e->too_large)
        return false;
    return !e->options->progress || e->options->progress(e->options->user, fraction);
}

static lr_status fail_too_large(lr_error *error)
{
    return lr_fail(error, LR_ERROR_MEMORY,
                   "the tree of this pixel has more than %d rays, or %d lights or obstacles, that "
                   "can be explained; try a smaller --depth",
                   LR_NOTED_RAYS - 1, LR_NOTED_LIGHTS - 1);
}

/* Traces `samples` samples of the pixel and copies its film words. */
static lr_status trace_samples(lr_wavefront *w, const lr_explanation *x, uint32_t first,
                               uint32_t samples, explaining *e, uint32_t film[LR_FILM_WORDS],
                               lr_error *error)
{
    *w->stats = (lr_render_stats){0};
    lr_status status = lr_wavefront_clear(w, 1, error);
    for (uint32_t done = 0; done < samples && !status;) {
        lr_camera_rays rays = {.x = x->x,
                               .y = x->y,
                               .columns = 1,
                               .rows = 1,
                               .step = 1,
                               .film_pitch = 1,
                               .first_sample = first + done,
                               .samples = samples - done};
        if (rays.samples > w->chunk_rays)
            rays.samples = w->chunk_rays;
        double before = (double)done / samples;
        done += rays.samples;
        double fractions[2] = {before, (double)done / samples};
        status = lr_wavefront_trace(w, &rays, pass_done, e, fractions, error);
    }
    if (!status)
        status = lr_wavefront_settle(w, error);
    if (e->too_large)
        status = fail_too_large(error);
    if (!status)
        status = lr_commands_begin(w->device, error);
    if (status)
        return status;
    lr_commands_copy(w->device, &w->film, &w->film_host, sizeof(uint32_t[LR_FILM_WORDS]));
    status = lr_commands_finish(w->device, error);
    memcpy(film, w->film_host.mapped, sizeof(uint32_t[LR_FILM_WORDS]));
    if (!status && film[LR_FILM_SAMPLES] != samples)
        status = lr_fail(error, LR_ERROR_DEVICE,
                         "the device finished %u of %u samples of the pixel; its driver is "
                         "faulty, try --device cpu",
                         film[LR_FILM_SAMPLES], samples);
    return status;
}

static void film_steps(const uint32_t film[LR_FILM_WORDS], uint64_t steps[3])
{
    for (uint32_t c = 0; c < 3; c++)
        steps[c] = lr_film_sum(film, c);
}

/* The sample in question: what was noted of it, in *host, which is then to be destroyed. */
static lr_status trace_sample(lr_wavefront *w, explaining *e, const lr_explanation *x,
                              uint32_t film[LR_FILM_WORDS], lr_buffer *host, lr_error *error)
{
    lr_status status = lr_buffer_create(w->device, LR_BUFFER_HOST, sizeof(struct gpu_notes),
                                        "the notes of rays", host, error);
    if (!status)
        status = lr_commands_begin(w->device, error);
    if (status)
        return status;
    lr_commands_zero(w->device, &w->order, w->order.size);
    status = lr_commands_finish(w->device, error);
    e->noting = true;
    if (!status)
        status = trace_samples(w, x, x->sample, 1, e, film, error);
    e->noting = false;
    if (!status)
        status = lr_commands_begin(w->device, error);
    if (status)
        return status;
    lr_commands_copy(w->device, &w->order, host, sizeof(struct gpu_notes));
    status = lr_commands_finish(w->device, error);
    const struct gpu_notes *n = host->mapped;
    if (!status && (n->rays >= LR_NOTED_RAYS || n->lights >= LR_NOTED_LIGHTS ||
                    n->obstacles >= LR_NOTED_OBSTACLES))
        status = fail_too_large(error);
    return status;
}

/* All samples; nobody reads what is noted of them. */
static lr_status trace_pixel(lr_wavefront *w, explaining *e, lr_explanation *x,
                             uint32_t film[LR_FILM_WORDS], lr_error *error)
{
    lr_status status = LR_OK;
    if (x->samples > 1)
        status = trace_samples(w, x, 0, x->samples, e, film, error);
    film_steps(film, x->total_steps);
    x->saturated = film[LR_FILM_FLAGS] != 0;
    lr_film_resolve(film, 1, x->pixel);
    return status;
}

static lr_status check_sums(const lr_explanation *x, const uint32_t film[LR_FILM_WORDS],
                            lr_error *error)
{
    uint64_t steps[3];
    film_steps(film, steps);
    if (memcmp(x->sample_steps, steps, sizeof steps) != 0)
        return lr_fail(error, LR_ERROR_DEVICE,
                       "what the device noted of the rays does not add up to the pixel; its "
                       "driver is faulty, try --device cpu");
    return LR_OK;
}

static lr_status explain_packed(lr_device *device, const lr_scene *scene,
                                const lr_packed_scene *packed, const lr_render_options *options,
                                lr_explanation *x, lr_error *error)
{
    lr_render_stats stats = {0};
    lr_buffer host = {0};
    uint32_t film[LR_FILM_WORDS] = {0};
    explaining e = {.options = options, .stats = &stats};
    lr_wavefront *w = lr_alloc(1, sizeof *w);
    if (!w)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory");
    lr_render_options own = *options;
    own.tile_size = 1;
    own.chunk_rays = LR_NOTED_HITS;
    lr_status status = lr_wavefront_create(device, packed, &own, &stats, w, error);
    if (!status)
        status = trace_sample(w, &e, x, film, &host, error);
    if (!status)
        status = lr_explain_tree(host.mapped, scene, packed, x, error);
    if (!status)
        status = check_sums(x, film, error);
    if (!status)
        status = trace_pixel(w, &e, x, film, error);
    lr_buffer_destroy(device, &host);
    lr_wavefront_destroy(w);
    free(w);
    return status;
}

lr_status lr_explain(lr_device *device, const lr_scene *scene, const lr_render_options *options,
                     uint32_t x, uint32_t y, uint32_t sample, lr_explanation *explanation,
                     lr_error *error)
{
    lr_render_options own = options ? *options : (lr_render_options){0};
    own.crop.width = 0;
    lr_settings settings;
    *explanation = (lr_explanation){0};
    lr_status status = lr_settle(scene, &own, &settings, error);
    if (!status && settings.integrator == LR_INTEGRATOR_PATH)
        status = lr_fail(error, LR_ERROR_ARGUMENT,
                         "explain tells of ray trees, and this scene is path-traced; ask with "
                         "--integrator whitted");
    if (!status && lr_scene_blurs(scene, settings.camera))
        status = lr_fail(error, LR_ERROR_ARGUMENT,
                         "explain tells of scenes that stand still, and in this one not only the "
                         "camera moves while its shutter is open; give it `shutter: 0`");
    if (status)
        return status;
    return lr_explain_picture(device, scene, &settings, &own, x, y, sample, explanation, error);
}

lr_status lr_explain_picture(lr_device *device, const lr_scene *scene, const lr_settings *settings,
                             const lr_render_options *options, uint32_t x, uint32_t y,
                             uint32_t sample, lr_explanation *explanation, lr_error *error)
{
    lr_packed_scene packed = {0};
    *explanation = (lr_explanation){0};
    if (x >= settings->width || y >= settings->height)
        return lr_fail(error, LR_ERROR_ARGUMENT,
                       "the pixel %u,%u is outside the picture of %ux%u (--size), whose pixels are "
                       "0,0 to %u,%u",
                       x, y, settings->width, settings->height, settings->width - 1,
                       settings->height - 1);
    if (sample >= settings->samples)
        return lr_fail(error, LR_ERROR_ARGUMENT,
                       "there is no sample %u: the pixel has %u, and the first is 0 (--spp)",
                       sample, settings->samples);
    *explanation = (lr_explanation){
        .width = settings->width,
        .height = settings->height,
        .x = x,
        .y = y,
        .sample = sample,
        .samples = settings->samples,
        .depth = settings->depth,
        .seed = settings->seed,
    };
    lr_status status = lr_pack_scene(scene, settings, &packed, error);
    if (status)
        return status;
    packed.constants[LR_SPEC_EXPLAIN] = 1;
    status = explain_packed(device, scene, &packed, options, explanation, error);
    if (status)
        lr_explanation_free(explanation);
    lr_packed_scene_free(&packed);
    return status;
}

void lr_explanation_free(lr_explanation *explanation)
{
    free(explanation->rays);
    free(explanation->lights);
    free(explanation->obstacles);
    *explanation = (lr_explanation){0};
}
