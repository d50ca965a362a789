#include "render/progressive.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "gpu/commands.h"
#include "render/film.h"

/* The first whole picture is made of as many pixels as can be traced in this time. */
#define FIRST_SECONDS 0.03

/* Before anything was measured. */
#define SOFTWARE_SECONDS_PER_RAY 2e-6
#define GPU_SECONDS_PER_RAY 2e-8

#define TELLING_RAYS 2000.0

#define BLOCK 8u /* rays go in blocks of 8 x 8 pixels: neighbours meet the same objects */

lr_status lr_progressive_create(lr_device *device, const lr_scene *scene,
                                const lr_settings *settings, lr_progressive **progressive,
                                lr_error *error)
{
    static const lr_render_options defaults;
    lr_progressive *p = *progressive = lr_alloc(1, sizeof *p);
    if (!p)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory");
    p->scene = scene;
    p->settings.inspect = settings->inspect;
    p->seconds_per_ray = device->info.software ? SOFTWARE_SECONDS_PER_RAY : GPU_SECONDS_PER_RAY;
    lr_status status = lr_pack_scene(scene, settings, &p->packed, error);
    if (!status)
        status =
            lr_wavefront_create(device, &p->packed, &defaults, &p->stats, &p->wavefront, error);
    if (status) {
        lr_progressive_destroy(p);
        *progressive = NULL;
    }
    return status;
}

void lr_progressive_destroy(lr_progressive *progressive)
{
    if (!progressive)
        return;
    lr_wavefront_destroy(&progressive->wavefront);
    lr_packed_scene_free(&progressive->packed);
    free(progressive);
}

lr_status lr_progressive_replace(lr_progressive *progressive, const lr_scene *scene,
                                 lr_packed_scene *packed, bool *taken, lr_error *error)
{
    lr_progressive *p = progressive;
    static const lr_render_options defaults;
    *taken = lr_wavefront_suits(&p->wavefront, packed, &defaults);
    if (!*taken)
        return LR_OK;
    lr_wavefront_discard(&p->wavefront);
    lr_packed_scene_free(&p->packed);
    p->packed = *packed;
    *packed = (lr_packed_scene){0};
    p->scene = scene;
    return lr_wavefront_replace_scene(&p->wavefront, &p->packed, error);
}

static void begin_sweep(lr_progressive *p, lr_sweep sweep)
{
    p->sweep = sweep;
    p->column = p->row = p->band = 0;
}

static uint64_t pixels_of(const lr_settings *s)
{
    return (uint64_t)s->width * s->height;
}

lr_status lr_progressive_start(lr_progressive *progressive, const lr_settings *settings,
                               lr_error *error)
{
    lr_progressive *p = progressive;
    lr_status status = LR_OK;
    lr_wavefront_discard(&p->wavefront);
    if (pixels_of(settings) > UINT32_MAX / LR_FILM_WORDS)
        return lr_fail(error, LR_ERROR_ARGUMENT, "%ux%u pixels are too many for a window",
                       settings->width, settings->height);
    if (settings->width != p->settings.width || settings->height != p->settings.height)
        status = lr_wavefront_resize_film(&p->wavefront, (uint32_t)pixels_of(settings), error);
    p->settings = *settings;
    lr_pack_camera(p->scene, settings, &p->packed);
    if (!status)
        status = lr_wavefront_update_camera(&p->wavefront, error);
    if (!status)
        status = lr_wavefront_clear(&p->wavefront, (uint32_t)pixels_of(settings), error);
    p->stats = (lr_render_stats){0};
    p->shown = p->finished = false;
    uint32_t step = 1;
    double seconds = (double)pixels_of(settings) * p->seconds_per_ray;
    while (step < LR_COARSE_MAX && seconds / (step * step) > FIRST_SECONDS)
        step *= 2;
    begin_sweep(p, (lr_sweep){.step = step, .samples = 1});
    return status;
}

static uint32_t clamp(double value, uint32_t least, uint32_t most)
{
    return value < least ? least : value > most ? most : (uint32_t)value;
}

/* Camera rays that take so long. */
static uint32_t rays_for(const lr_progressive *p, double seconds)
{
    return clamp(seconds / p->seconds_per_ray, BLOCK * BLOCK, p->wavefront.chunk_rays);
}

/* The sweep after the one that has come to its end; false when there is none. Between the pixels of
 * a coarse picture those come that halve their distance. */
static bool next_sweep(lr_progressive *p, uint32_t rays)
{
    lr_sweep s = p->sweep;
    uint32_t half = s.step / 2, samples = p->settings.samples;
    p->shown = true;
    if (s.step == 1 || (half == 1 && s.x && s.y)) {
        uint32_t first = s.first_sample + s.samples;
        if (first >= samples)
            return false;
        uint32_t count = clamp((double)rays / (double)pixels_of(&p->settings), 1, samples - first);
        begin_sweep(p, (lr_sweep){.step = 1, .first_sample = first, .samples = count});
    } else if (s.x && s.y) {
        begin_sweep(p, (lr_sweep){.x = half / 2, .step = half, .samples = 1});
    } else if (s.y) {
        begin_sweep(p, (lr_sweep){.x = s.y, .y = s.y, .step = s.step, .samples = 1});
    } else if (s.x) {
        begin_sweep(p, (lr_sweep){.y = s.x, .step = s.step, .samples = 1});
    } else {
        begin_sweep(p, (lr_sweep){.x = half, .step = s.step, .samples = 1});
    }
    return true;
}

static uint32_t count_of(uint32_t extent, uint32_t first, uint32_t step)
{
    return extent > first ? (extent - first + step - 1) / step : 0;
}

static uint32_t whole_blocks(uint32_t count, uint32_t most)
{
    uint32_t whole = count - count % BLOCK;
    whole = whole < BLOCK ? BLOCK : whole;
    return whole < most ? whole : most;
}

static uint32_t columns_of(const lr_progressive *p)
{
    return count_of(p->settings.width, p->sweep.x, p->sweep.step);
}

static uint32_t rows_of(const lr_progressive *p)
{
    return count_of(p->settings.height, p->sweep.y, p->sweep.step);
}

/* The next camera rays of the sweep, about so many. */
static lr_camera_rays next_rays(lr_progressive *p, uint32_t rays)
{
    const lr_sweep *s = &p->sweep;
    uint32_t columns = columns_of(p), pixels = rays / s->samples;
    if (p->column == 0)
        p->band = whole_blocks(pixels / columns, rows_of(p) - p->row);
    uint32_t x = s->x + p->column * s->step, y = s->y + p->row * s->step;
    lr_camera_rays next = {
        .x = x,
        .y = y,
        .columns = whole_blocks(pixels / p->band, columns - p->column),
        .rows = p->band,
        .step = s->step,
        .film_first = y * p->settings.width + x,
        .film_pitch = p->settings.width,
        .first_sample = s->first_sample,
        .samples = s->samples,
    };
    p->column += next.columns;
    if (p->column == columns) {
        p->column = 0;
        p->row += p->band;
    }
    return next;
}

/* Quick to become careful, slow to become bold, and little by steps that are too small to tell. */
static void learn_speed(lr_progressive *p, double rays, double seconds)
{
    double each = seconds / rays;
    double weight = (each > p->seconds_per_ray ? 0.6 : 0.3) * rays / (rays + TELLING_RAYS);
    p->seconds_per_ray += (each - p->seconds_per_ray) * weight;
}

lr_status lr_progressive_step(lr_progressive *progressive, double seconds, lr_pass_done go_on,
                              void *user, lr_error *error)
{
    lr_progressive *p = progressive;
    if (p->finished)
        return LR_OK;
    uint32_t most = rays_for(p, seconds);
    lr_camera_rays rays = next_rays(p, most);
    double start = lr_now();
    double done = lr_progressive_done(p);
    lr_status status =
        lr_wavefront_trace(&p->wavefront, &rays, go_on, user, (const double[]){done, done}, error);
    if (!status)
        status = lr_wavefront_settle(&p->wavefront, error);
    if (status) {
        lr_wavefront_discard(&p->wavefront);
        return status;
    }
    learn_speed(p, (double)rays.columns * rays.rows * rays.samples, lr_now() - start);
    while (!p->finished && (columns_of(p) == 0 || p->row >= rows_of(p)))
        p->finished = !next_sweep(p, most);
    return LR_OK;
}

void lr_progressive_look(const lr_progressive *p, lr_look *look)
{
    look->samples = p->sweep.first_sample + p->sweep.samples;
    look->linear = p->settings.inspect != LR_INSPECT_LIGHT;
    look->palette = p->settings.inspect == LR_INSPECT_RAYS;
    look->others = p->sweep.first_sample > 0 ? p->sweep.first_sample : 1;
    look->coarse = p->sweep.first_sample > 0 || p->finished ? 1 : p->sweep.step;
}

double lr_progressive_done(const lr_progressive *p)
{
    const lr_sweep *s = &p->sweep;
    if (p->finished)
        return 1;
    double rows = p->row + p->band * (double)p->column / columns_of(p);
    double sweeps = (s->x > 0) + 2 * (s->y > 0) + rows / rows_of(p);
    double samples = s->first_sample + s->samples * sweeps / ((double)s->step * s->step);
    return samples / p->settings.samples;
}

/* Where the colour of a pixel stands that has no sample yet; display.comp does the same. */
static const uint32_t *find_pixel(const uint32_t *film, uint32_t x, uint32_t y, uint32_t width)
{
    const uint32_t *found = NULL;
    for (uint32_t coarse = 1; coarse <= LR_COARSE_MAX; coarse *= 2) {
        uint32_t mask = ~(coarse - 1);
        found = &film[((size_t)(y & mask) * width + (x & mask)) * LR_FILM_WORDS];
        if (found[LR_FILM_SAMPLES] > 0)
            break;
    }
    return found;
}

lr_status lr_progressive_picture(lr_progressive *progressive, lr_picture *picture, lr_error *error)
{
    lr_progressive *p = progressive;
    lr_device *device = p->wavefront.device;
    uint32_t width = p->settings.width, height = p->settings.height;
    lr_buffer host = {0};
    *picture = (lr_picture){width, height, lr_alloc(pixels_of(&p->settings), 3 * sizeof(float))};
    if (!picture->pixels)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for the picture");
    VkDeviceSize size = 4ull * LR_FILM_WORDS * pixels_of(&p->settings);
    lr_status status = lr_buffer_create(device, LR_BUFFER_HOST, size, "the film", &host, error);
    if (!status)
        status = lr_commands_begin(device, error);
    if (!status) {
        lr_commands_copy(device, &p->wavefront.film, &host, size);
        status = lr_commands_finish(device, error);
    }
    for (uint32_t y = 0; y < height && !status; y++)
        for (uint32_t x = 0; x < width; x++)
            lr_film_resolve(find_pixel(host.mapped, x, y, width), 1,
                            &picture->pixels[3 * ((size_t)y * width + x)]);
    lr_buffer_destroy(device, &host);
    if (status)
        lr_picture_free(picture);
    return status;
}
