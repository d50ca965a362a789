/* What is known of pixels beside their light: each layer is a render of its own into the same
 * integer film, and so as exact as the picture. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "render/film.h"
#include "render/gather.h"
#include "render/job.h"
#include "render/spread.h"

/* The samples of a pixel are looked at in so many ranges to see how they differ. */
#define RANGES 16u

/* Shares of the progress, the picture's being 1: about the time that they take with paths. */
#define DIRECT_SHARE 0.5
#define INSPECTED_SHARE 0.25

static const struct {
    const char *name, *channels;
    bool integers, light;
} aovs[LR_AOV_COUNT] = {
    [LR_AOV_ALBEDO] = {.name = "albedo", .channels = "RGB"},
    [LR_AOV_NORMAL] = {.name = "normal", .channels = "XYZ"},
    [LR_AOV_DEPTH] = {.name = "depth", .channels = ""},
    [LR_AOV_POSITION] = {.name = "position", .channels = "XYZ"},
    [LR_AOV_ALPHA] = {.name = "alpha", .channels = ""},
    [LR_AOV_ID] = {.name = "id", .channels = "", .integers = true},
    [LR_AOV_DIRECT] = {.name = "direct", .channels = "RGB", .light = true},
    [LR_AOV_INDIRECT] = {.name = "indirect", .channels = "RGB", .light = true},
    [LR_AOV_VARIANCE] = {.name = "variance", .channels = "RGB"},
    [LR_AOV_SAMPLES] = {.name = "samples", .channels = "", .integers = true},
};

/* What becomes of one pixel's film; `at` is its number in the picture. */
struct rendering;
typedef void (*take_pixel)(struct rendering *r, size_t at, const uint32_t *film);

typedef struct rendering {
    lr_render_options options; /* the caller's, with the progress of all renders */
    bool (*progress)(void *user, double fraction);
    void *user;
    double done, running, total; /* shares */
    double traced;               /* lr_now() when the picture was there */
    uint32_t wanted;
    lr_settings settings; /* of the picture */
    lr_sums sums;         /* of the picture; later of what is indirect in it */
    void *samples[LR_AOV_COUNT];
    uint32_t *hits;    /* of each pixel: samples that meet something */
    lr_spread *spread; /* of the pixels of a tile */
    uint32_t in_tile;  /* the pixel that is being taken */
    take_pixel take;
} rendering;

const char *lr_aov_name(uint32_t aov)
{
    return aov < LR_AOV_COUNT ? aovs[aov].name : NULL;
}

void lr_layers_free(lr_layers *layers)
{
    for (uint32_t i = 0; i < layers->count; i++)
        free((void *)(uintptr_t)layers->layers[i].samples);
    *layers = (lr_layers){.count = 0};
}

static uint32_t bit(lr_aov aov)
{
    return 1u << aov;
}

static bool wants(const rendering *r, lr_aov aov)
{
    return r->wanted & bit(aov);
}

static float *floats_of(const rendering *r, lr_aov aov)
{
    return r->samples[aov];
}

static bool report_progress(void *user, double fraction)
{
    const rendering *r = user;
    return !r->progress || r->progress(r->user, (r->done + fraction * r->running) / r->total);
}

static void take_film(void *user, const lr_tile *tile, const uint32_t *film)
{
    rendering *r = user;
    r->in_tile = 0;
    for (uint32_t y = 0; y < tile->height; y++) {
        size_t row = (tile->y - r->settings.crop_y + y) * (size_t)r->settings.crop_width;
        for (uint32_t x = 0; x < tile->width; x++, r->in_tile++, film += LR_FILM_WORDS)
            r->take(r, row + tile->x - r->settings.crop_x + x, film);
    }
}

/* One render of the whole picture, whose film goes to `take`. */
static lr_status run(rendering *r, lr_job *job, double share, uint32_t ranges, take_pixel take,
                     lr_error *error)
{
    r->take = take;
    r->running = share;
    lr_status status = lr_job_trace(job, ranges, take_film, r, error);
    r->done += share;
    return status;
}

/* The same after the settings of the job have changed. */
static lr_status run_changed(rendering *r, lr_job *job, double share, take_pixel take,
                             lr_error *error)
{
    lr_status status = lr_job_change(job, error);
    return status ? status : run(r, job, share, 1, take, error);
}

/* ---- Light -------------------------------------------------------------------------------- */

static void take_picture(rendering *r, size_t at, const uint32_t *film)
{
    uint32_t *sums = &r->sums.film[at * LR_FILM_WORDS];
    bool first = sums[LR_FILM_SAMPLES] == 0;
    lr_film_add(sums, film);
    if (!r->spread)
        return;
    lr_spread *spread = &r->spread[r->in_tile];
    if (first)
        *spread = (lr_spread){.samples = 0};
    lr_spread_add(spread, film);
    lr_spread_variance(spread, &floats_of(r, LR_AOV_VARIANCE)[3 * at]);
}

static void take_direct(rendering *r, size_t at, const uint32_t *film)
{
    if (wants(r, LR_AOV_DIRECT))
        lr_film_resolve(film, 1, &floats_of(r, LR_AOV_DIRECT)[3 * at]);
    if (!wants(r, LR_AOV_INDIRECT))
        return;
    /* What is direct is among the picture's contributions, to the bit. */
    uint32_t *sums = &r->sums.film[at * LR_FILM_WORDS];
    for (uint32_t channel = 0; channel < 3; channel++) {
        uint64_t rest = lr_film_sum(sums, channel) - lr_film_sum(film, channel);
        sums[2 * channel] = (uint32_t)rest;
        sums[2 * channel + 1] = (uint32_t)(rest >> 32);
    }
    lr_film_resolve(sums, 1, &floats_of(r, LR_AOV_INDIRECT)[3 * at]);
}

static lr_status trace_picture(rendering *r, lr_job *job, lr_error *error)
{
    const lr_settings *settings = &r->settings;
    if (lr_needs_sums(&r->options)) {
        r->running = 1;
        lr_status status = lr_gather(job, &r->sums, error);
        r->done += 1;
        return status;
    }
    uint32_t ranges = 1;
    if (wants(r, LR_AOV_VARIANCE)) {
        r->spread = lr_alloc(lr_job_most_pixels(job), sizeof *r->spread);
        if (!r->spread)
            return lr_fail(error, LR_ERROR_MEMORY, "out of memory for the variance of pixels");
        ranges = settings->sample_count < RANGES ? settings->sample_count : RANGES;
    }
    return run(r, job, 1, ranges, take_picture, error);
}

/* The picture, and its direct part by the same kernels. */
static lr_status trace_light(rendering *r, lr_job *job, lr_picture *picture, lr_render_stats *stats,
                             lr_error *error)
{
    lr_status status = trace_picture(r, job, error);
    if (status)
        return status;
    lr_sums_resolve(&r->sums, picture->pixels);
    if (r->options.seconds > 0)
        job->settings.samples = job->settings.sample_count = r->sums.count;
    lr_job_count(&r->sums, stats);
    lr_job_describe(job, picture, stats);
    r->settings = job->settings;
    r->settings.samples = r->settings.sample_count = stats->most_samples;
    r->traced = lr_now();
    if (wants(r, LR_AOV_SAMPLES))
        for (size_t i = 0; i < (size_t)picture->width * picture->height; i++)
            ((uint32_t *)r->samples[LR_AOV_SAMPLES])[i] =
                r->sums.film[i * LR_FILM_WORDS + LR_FILM_SAMPLES];
    if (!(r->wanted & (bit(LR_AOV_DIRECT) | bit(LR_AOV_INDIRECT))))
        return LR_OK;
    lr_render_stats again = {0};
    job->wavefront->stats = &again;
    job->settings.depth = 0;
    return run_changed(r, job, DIRECT_SHARE, take_direct, error);
}

/* ---- What is seen ------------------------------------------------------------------------- */

static void take_albedo(rendering *r, size_t at, const uint32_t *film)
{
    lr_film_resolve(film, 1, &floats_of(r, LR_AOV_ALBEDO)[3 * at]);
}

static void take_normal(rendering *r, size_t at, const uint32_t *film)
{
    uint64_t samples = film[LR_FILM_SAMPLES];
    for (uint32_t channel = 0; channel < 3; channel++) {
        int64_t sum = (int64_t)(lr_film_sum(film, channel) - (samples << LR_FILM_STEP_BITS));
        double steps = (double)samples * (double)(1ull << LR_FILM_STEP_BITS);
        floats_of(r, LR_AOV_NORMAL)[3 * at + channel] = (float)((double)sum / steps);
    }
}

/* The mean of the samples that meet something. */
static float mean_of_hits(const rendering *r, size_t at, const uint32_t *film, uint32_t channel)
{
    uint32_t hits = r->hits[at];
    if (hits == 0)
        return 0;
    return film[LR_FILM_FLAGS] & 1u << channel ? lr_film_overflow(hits)
                                               : lr_film_mean(lr_film_sum(film, channel), hits);
}

static void take_distance(rendering *r, size_t at, const uint32_t *film)
{
    r->hits[at] = (uint32_t)(lr_film_sum(film, 1) >> LR_FILM_STEP_BITS);
    if (wants(r, LR_AOV_DEPTH))
        floats_of(r, LR_AOV_DEPTH)[at] = mean_of_hits(r, at, film, 0);
    if (wants(r, LR_AOV_ALPHA))
        floats_of(r, LR_AOV_ALPHA)[at] = (float)((double)r->hits[at] / film[LR_FILM_SAMPLES]);
}

static void take_position(rendering *r, size_t at, const uint32_t *film)
{
    for (uint32_t channel = 0; channel < 3; channel++)
        floats_of(r, LR_AOV_POSITION)[3 * at + channel] = mean_of_hits(r, at, film, channel);
}

static void take_negative_position(rendering *r, size_t at, const uint32_t *film)
{
    for (uint32_t channel = 0; channel < 3; channel++)
        floats_of(r, LR_AOV_POSITION)[3 * at + channel] -= mean_of_hits(r, at, film, channel);
}

static void take_number(rendering *r, size_t at, const uint32_t *film)
{
    uint64_t low = lr_film_sum(film, 0) >> LR_FILM_STEP_BITS;
    uint64_t high = lr_film_sum(film, 1) >> LR_FILM_STEP_BITS;
    ((uint32_t *)r->samples[LR_AOV_ID])[at] = (uint32_t)(low | high << 16);
}

/* In this order: means of hits need their number. */
static const struct {
    uint32_t aovs;
    lr_inspect inspect;
    take_pixel take;
} inspections[] = {
    {1u << LR_AOV_ALBEDO, LR_INSPECT_ALBEDO, take_albedo},
    {1u << LR_AOV_NORMAL, LR_INSPECT_SHIFTED_NORMAL, take_normal},
    {1u << LR_AOV_DEPTH | 1u << LR_AOV_ALPHA | 1u << LR_AOV_POSITION, LR_INSPECT_DISTANCE,
     take_distance},
    {1u << LR_AOV_POSITION, LR_INSPECT_POSITION, take_position},
    {1u << LR_AOV_POSITION, LR_INSPECT_NEGATIVE_POSITION, take_negative_position},
    {1u << LR_AOV_ID, LR_INSPECT_NUMBER, take_number},
};

#define INSPECTION_COUNT (sizeof inspections / sizeof *inspections)

static uint32_t inspections_wanted(uint32_t wanted)
{
    uint32_t count = 0;
    for (size_t i = 0; i < INSPECTION_COUNT; i++)
        count += (inspections[i].aovs & wanted) != 0;
    return count;
}

/* All that is wanted of it, by kernels of their own. */
static lr_status inspect(rendering *r, lr_device *device, const lr_scene *scene,
                         lr_render_stats *stats, lr_error *error)
{
    if (inspections_wanted(r->wanted) == 0)
        return LR_OK;
    lr_render_stats own = {0};
    lr_job job = {.options = &r->options, .settings = r->settings};
    job.settings.inspect = inspections[0].inspect;
    lr_status status = lr_job_open(&job, device, scene, &own, error);
    for (size_t i = 0; i < INSPECTION_COUNT && !status; i++) {
        if (!(inspections[i].aovs & r->wanted))
            continue;
        job.settings = r->settings;
        job.settings.inspect = inspections[i].inspect;
        if (inspections[i].inspect == LR_INSPECT_NUMBER) {
            /* The only sample of ray trees is the middle of the pixel. */
            job.settings.integrator = LR_INTEGRATOR_WHITTED;
            job.settings.samples = job.settings.sample_count = 1;
        }
        status = run_changed(r, &job, INSPECTED_SHARE, inspections[i].take, error);
    }
    stats->saturated += own.saturated;
    stats->non_finite += own.non_finite;
    lr_job_finish(&job);
    return status;
}

/* ---- All of it ---------------------------------------------------------------------------- */

static lr_status check(const lr_render_options *options, uint32_t wanted, lr_error *error)
{
    if (options->sample_range.count || options->checkpoint)
        return lr_fail(error, LR_ERROR_ARGUMENT,
                       "layers (--aov) go with neither --sample-range nor --checkpoint");
    if (wanted & bit(LR_AOV_VARIANCE) && lr_needs_sums(options))
        return lr_fail(error, LR_ERROR_ARGUMENT,
                       "the layer 'variance' needs a number of samples: --spp, not --time or "
                       "--noise");
    if (wanted & (bit(LR_AOV_DIRECT) | bit(LR_AOV_INDIRECT)) && options->noise > 0)
        return lr_fail(error, LR_ERROR_ARGUMENT,
                       "the layers 'direct' and 'indirect' need as many samples in each pixel, "
                       "which --noise does not give");
    return LR_OK;
}

static lr_status make_room(rendering *r, const lr_job *job, const lr_scene *scene, lr_error *error)
{
    r->settings = job->settings;
    if (wants(r, LR_AOV_VARIANCE) && r->settings.sample_count < 2)
        return lr_fail(error, LR_ERROR_ARGUMENT,
                       "the layer 'variance' needs 2 samples a pixel or more: --spp 2, or leave it "
                       "out of --aov");
    lr_status status = lr_sums_create(&r->sums, scene, &r->settings, &r->options, error);
    if (status)
        return status;
    size_t pixels = (size_t)r->settings.crop_width * r->settings.crop_height;
    bool enough = true;
    for (uint32_t i = 0; i < LR_AOV_COUNT; i++) {
        if (!wants(r, (lr_aov)i))
            continue;
        size_t channels = aovs[i].channels[0] ? strlen(aovs[i].channels) : 1;
        r->samples[i] = lr_alloc(pixels, channels * sizeof(float));
        enough = enough && r->samples[i];
    }
    r->hits = lr_alloc(pixels, sizeof *r->hits);
    if (!enough || !r->hits)
        return lr_fail(error, LR_ERROR_MEMORY,
                       "not enough memory for layers of %ux%u pixels; try a smaller --size, or "
                       "fewer of them",
                       r->settings.crop_width, r->settings.crop_height);
    return LR_OK;
}

/* Hands over those that are there. */
static void list_layers(rendering *r, lr_layers *layers)
{
    for (uint32_t i = 0; i < LR_AOV_COUNT; i++)
        if (r->samples[i])
            layers->layers[layers->count++] = (lr_layer){
                .name = aovs[i].name,
                .channels = aovs[i].channels,
                .samples = r->samples[i],
                .integers = aovs[i].integers,
                .light = aovs[i].light,
            };
}

lr_status lr_render_layers(lr_device *device, const lr_scene *scene,
                           const lr_render_options *options, uint32_t wanted, lr_picture *picture,
                           lr_layers *layers, lr_render_stats *stats, lr_error *error)
{
    lr_render_stats own_stats;
    rendering r = {.wanted = wanted, .total = 1};
    lr_job job = {0};
    stats = stats ? stats : &own_stats;
    if (options)
        r.options = *options;
    r.progress = r.options.progress;
    r.user = r.options.user;
    r.options.progress = report_progress;
    r.options.user = &r;
    if (wanted & (bit(LR_AOV_DIRECT) | bit(LR_AOV_INDIRECT)))
        r.total += DIRECT_SHARE;
    r.total += INSPECTED_SHARE * inspections_wanted(wanted);
    *picture = (lr_picture){0};
    *layers = (lr_layers){.count = 0};
    lr_status status = check(&r.options, wanted, error);
    if (!status)
        status = lr_job_start(&job, device, scene, &r.options, stats, error);
    if (!status)
        status = make_room(&r, &job, scene, error);
    if (!status)
        status = lr_job_picture(&job, picture, error);
    if (!status)
        status = trace_light(&r, &job, picture, stats, error);
    lr_job_finish(&job);
    if (!status)
        status = inspect(&r, device, scene, stats, error);
    stats->layers_seconds = lr_now() - r.traced;
    list_layers(&r, layers);
    if (status) {
        lr_picture_free(picture);
        lr_layers_free(layers);
    }
    lr_sums_free(&r.sums);
    free(r.spread);
    free(r.hits);
    return status;
}
