#include "render/gather.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "render/noise.h"

#define CHECKPOINT_SECONDS 30.0

/* A checkpoint that takes long to write is written the more seldom, by this. */
#define CHECKPOINT_SHARE 20.0

/* Samples that a pass over the picture brings each pixel at least: fewer would spend too much of
 * the time reading the film back. */
#define PASS_SAMPLES 16u

typedef struct gather {
    lr_job *job;
    const lr_render_options *options;
    lr_sums *sums;
    lr_render_stats *stats;
    const lr_noise *noise;  /* NULL, or which blocks go on */
    double done, total;     /* samples of all pixels */
    double running;         /* of the rectangle that is being traced */
    double next_checkpoint; /* lr_now() */
} gather;

/* A piece of the film. */
typedef struct rectangle {
    uint32_t x, y, width, height;
} rectangle;

static bool report_progress(void *user, double fraction)
{
    gather *g = user;
    double limit = g->options->seconds;
    if (limit > 0 && g->options->progress) {
        double passed = (lr_now() - g->job->begun) / limit;
        return g->options->progress(g->options->user, passed < 1 ? passed : 1);
    }
    return !g->options->progress ||
           g->options->progress(g->options->user, (g->done + fraction * g->running) / g->total);
}

/* ---- Checkpoints -------------------------------------------------------------------------- */

static double checkpoint_seconds(const gather *g)
{
    return g->options->checkpoint_seconds > 0 ? g->options->checkpoint_seconds : CHECKPOINT_SECONDS;
}

/* What cannot be written now may be later, so this is no reason to lose what has been traced. */
static void write_checkpoint(gather *g)
{
    lr_error problem = {0};
    double start = lr_now();
    lr_status status = lr_sums_write(g->sums, g->options->checkpoint, &problem);
    snprintf(g->stats->checkpoint_problem, sizeof g->stats->checkpoint_problem, "%.255s",
             status ? problem.message : "");
    double pause = CHECKPOINT_SHARE * (lr_now() - start), least = checkpoint_seconds(g);
    g->next_checkpoint = lr_now() + (pause > least ? pause : least);
}

static lr_status check_checkpoint(const lr_sums *found, const lr_sums *wanted, const char *path,
                                  lr_error *error)
{
    const char *other = NULL;
    if (strcmp(found->id.software, wanted->id.software) != 0)
        other = "another version of lavaray";
    else if (strcmp(found->id.numbers, wanted->id.numbers) != 0)
        other = "another scene";
    if (other)
        return lr_fail(error, LR_ERROR_FILE,
                       "%.500s: is a checkpoint of %s; name another file, or delete it to begin "
                       "anew",
                       path, other);
    if (strcmp(found->id.settings, wanted->id.settings) != 0 || found->first != wanted->first ||
        found->count != wanted->count || found->width != wanted->width ||
        found->height != wanted->height)
        return lr_fail(
            error, LR_ERROR_FILE,
            "%.200s: is a checkpoint of other settings: samples %u-%u of %.200s; this is "
            "samples %u-%u of %.200s; name another file, or delete it to begin anew",
            path, found->first, found->first + found->count - 1, found->id.settings, wanted->first,
            wanted->first + wanted->count - 1, wanted->id.settings);
    return LR_OK;
}

static lr_status resume(gather *g, lr_error *error)
{
    const char *path = g->options->checkpoint;
    struct stat info;
    bool exists = stat(path, &info) == 0;
    if (!exists && errno == ENOENT)
        return LR_OK;
    lr_sums found = {0};
    lr_error cause = {0};
    lr_status status = exists && !S_ISREG(info.st_mode)
                           ? lr_fail(&cause, LR_ERROR_FILE, "%.500s: is no regular file", path)
                           : lr_sums_read(path, &found, &cause);
    if (status)
        return lr_fail(error, status,
                       "the checkpoint %.700s; name another file, or delete it to begin anew",
                       cause.message);
    status = check_checkpoint(&found, g->sums, path, error);
    if (!status) {
        uint32_t *film = g->sums->film;
        g->sums->film = found.film;
        found.film = film;
    }
    lr_sums_free(&found);
    return status;
}

/* ---- Passes ------------------------------------------------------------------------------- */

static uint32_t at_most(uint32_t value, uint32_t most)
{
    return value < most ? value : most;
}

static void add_film(const gather *g, const rectangle *r, const uint32_t *film)
{
    for (uint32_t y = 0; y < r->height; y++) {
        uint32_t *pixel = lr_sums_pixel(g->sums, r->x, r->y + y);
        for (uint32_t x = 0; x < r->width; x++, film += LR_FILM_WORDS, pixel += LR_FILM_WORDS)
            lr_film_add(pixel, film);
    }
}

/* Adds the samples from number `from` up to `to` of the sums' to the pixels of r. */
static lr_status trace(gather *g, const rectangle *r, uint32_t from, uint32_t to, lr_error *error)
{
    lr_tile tile = {
        .x = g->job->settings.crop_x + r->x,
        .y = g->job->settings.crop_y + r->y,
        .width = r->width,
        .height = r->height,
        .first_sample = g->sums->first + from,
        .samples = to - from,
    };
    const uint32_t *film;
    g->running = (double)r->width * r->height * tile.samples;
    lr_status status =
        lr_wavefront_render(g->job->wavefront, &tile, report_progress, g, &film, error);
    if (status)
        return status;
    add_film(g, r, film);
    g->done += g->running;
    if (g->options->checkpoint && lr_now() >= g->next_checkpoint)
        write_checkpoint(g);
    return LR_OK;
}

/* The samples that a pixel has; `target` where that is enough. */
static uint32_t count_at(const gather *g, uint32_t x, uint32_t y, uint32_t target)
{
    if (g->noise && lr_noise_stopped(g->noise, x, y))
        return target;
    return at_most(lr_sums_pixel(g->sums, x, y)[LR_FILM_SAMPLES], target);
}

/* ... of all pixels of r; UINT32_MAX: they have different numbers. */
static uint32_t common_count(const gather *g, const rectangle *r, uint32_t target)
{
    uint32_t common = count_at(g, r->x, r->y, target);
    for (uint32_t y = r->y; y < r->y + r->height; y++)
        for (uint32_t x = r->x; x < r->x + r->width; x++)
            if (count_at(g, x, y, target) != common)
                return UINT32_MAX;
    return common;
}

/* About the half of a side, so that pieces are whole blocks while they are larger than one. */
static uint32_t half_of(uint32_t side)
{
    uint32_t half = side / 2, rest = half % LR_NOISE_BLOCK;
    return side > LR_NOISE_BLOCK && rest ? half - rest + LR_NOISE_BLOCK : half;
}

/* Brings the pixels of r to `target` samples, in halves where they have different numbers: at the
 * edge of blocks that go on, or those of a checkpoint whose tiles were others. */
static lr_status reach(gather *g, rectangle r, uint32_t target, lr_error *error)
{
    uint32_t from = common_count(g, &r, target);
    if (from == target)
        return LR_OK;
    if (from != UINT32_MAX)
        return trace(g, &r, from, target, error);
    rectangle first = r, second = r;
    if (r.width >= r.height) {
        first.width = half_of(r.width);
        second.x += first.width;
        second.width -= first.width;
    } else {
        first.height = half_of(r.height);
        second.y += first.height;
        second.height -= first.height;
    }
    lr_status status = reach(g, first, target, error);
    return status ? status : reach(g, second, target, error);
}

/* A pass over the picture, tile by tile. */
static lr_status pass_over(gather *g, uint32_t target, lr_error *error)
{
    uint32_t size = g->job->wavefront->tile_size, width = g->sums->width, height = g->sums->height;
    lr_status status = LR_OK;
    for (uint32_t y = 0; y < height && !status; y += size)
        for (uint32_t x = 0; x < width && !status; x += size) {
            rectangle tile = {x, y, at_most(size, width - x), at_most(size, height - y)};
            status = reach(g, tile, target, error);
        }
    return status;
}

/* Brings all pixels, which have `from` samples at least, to `target`: where the scene moves from
 * one to the next, by a pass for each, of which those of a checkpoint are left out. */
static lr_status reach_all(gather *g, uint32_t from, uint32_t target, lr_error *error)
{
    const rectangle all = {0, 0, g->sums->width, g->sums->height};
    lr_status status = LR_OK;
    if (!g->job->blurs)
        return pass_over(g, target, error);
    while (from < target && !status) {
        uint32_t sample = g->sums->first + from++;
        if (common_count(g, &all, from) == from)
            continue;
        status = lr_job_seek(g->job, sample, error);
        if (!status)
            status = pass_over(g, from, error);
    }
    return status;
}

/* Passes from `from` samples a pixel to `to` that bring each tile as many as are traced at once. */
static lr_status reach_in_passes(gather *g, uint32_t from, uint32_t to, lr_error *error)
{
    uint32_t size = g->job->wavefront->tile_size;
    uint32_t step = g->job->wavefront->chunk_rays / (size * size);
    step = step > PASS_SAMPLES ? step : PASS_SAMPLES;
    lr_status status = LR_OK;
    while (from < to && !status) {
        uint32_t next = to - from > step ? from + step : to;
        status = reach_all(g, from, next, error);
        from = next;
    }
    return status;
}

/* Whole passes over the picture until the time is up, about: none is begun that would take longer
 * than what is left. Each takes up to half of that, by what the one before took, so that the last
 * ones are short. */
static lr_status reach_in_time(gather *g, lr_error *error)
{
    uint32_t most = g->sums->count, reached = 0, next = 1;
    lr_status status = LR_OK;
    while (next > 0 && !status) {
        double begun = lr_now();
        status = reach_all(g, reached, reached + next, error);
        double now = lr_now(), left = g->job->begun + g->options->seconds - now;
        double fitting = left * next / (now - begun);
        reached += next;
        fitting = fitting < 2 ? fitting : fitting / 2;
        next = at_most(fitting < reached ? (uint32_t)(fitting > 0 ? fitting : 0) : reached,
                       most - reached);
    }
    g->sums->count = reached;
    return status;
}

/* Whatever happens, a checkpoint is left of what has been traced. */
static lr_status reach_with_checkpoints(gather *g, lr_error *error)
{
    lr_status status = resume(g, error);
    if (status)
        return status;
    g->stats->resumed = lr_sums_done(g->sums);
    g->done = g->stats->resumed * g->total;
    g->next_checkpoint = lr_now() + checkpoint_seconds(g);
    status = reach_in_passes(g, 0, g->sums->count, error);
    if (status && g->done > g->stats->resumed * g->total)
        write_checkpoint(g);
    return status;
}

bool lr_needs_sums(const lr_render_options *options)
{
    return options->checkpoint || options->seconds > 0 || options->noise > 0;
}

/* Doubles the samples of the blocks that are too noisy until none is, or all are used up. */
static lr_status reach_quiet(gather *g, lr_error *error)
{
    lr_noise noise;
    uint32_t most = g->sums->count, reached = 0;
    uint64_t left = (uint64_t)g->sums->width * g->sums->height;
    lr_status status = lr_noise_create(&noise, g->sums, error);
    g->noise = &noise;
    while (!status && left > 0 && reached < most) {
        uint32_t next = at_most(reached ? 2 * reached : LR_NOISE_FIRST / 2, most);
        status = reach_in_passes(g, reached, next, error);
        if (!status && next >= LR_NOISE_FIRST && next < most)
            left = lr_noise_decide(&noise, g->sums, 1e-6 * g->job->settings.noise);
        if (!status && next < most)
            lr_noise_keep(&noise, g->sums);
        reached = next;
        g->total = g->done + (double)left * (most - reached);
    }
    g->noise = NULL;
    lr_noise_free(&noise);
    return status;
}

lr_status lr_gather(lr_job *job, lr_sums *sums, lr_error *error)
{
    gather g = {
        .job = job,
        .options = job->options,
        .sums = sums,
        .stats = job->wavefront->stats,
        .total = (double)sums->width * sums->height * sums->count,
    };
    if (g.options->seconds > 0)
        return reach_in_time(&g, error);
    if (job->settings.noise)
        return reach_quiet(&g, error);
    return g.options->checkpoint ? reach_with_checkpoints(&g, error)
                                 : reach_all(&g, 0, sums->count, error);
}
