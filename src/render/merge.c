/* Parts of a render become the picture. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "render/sums.h"

/* The samples from first up to end of the part at path. */
typedef struct range {
    uint32_t first, end;
    const char *path;
} range;

static int compare_ranges(const void *a, const void *b)
{
    const range *x = a, *y = b;
    return (x->first > y->first) - (x->first < y->first);
}

/* A part has all of its samples everywhere, a checkpoint not yet. */
static lr_status check_complete(const lr_sums *part, const char *path, lr_error *error)
{
    size_t pixels = (size_t)part->width * part->height;
    for (size_t i = 0; i < pixels; i++)
        if (part->film[i * LR_FILM_WORDS + LR_FILM_SAMPLES] != part->count)
            return lr_fail(error, LR_ERROR_FILE,
                           "%.500s: is the checkpoint of a render that is not finished; finish it "
                           "with lavaray render --checkpoint",
                           path);
    return LR_OK;
}

static lr_status check_same(const lr_sums *a, const char *a_path, const lr_sums *b,
                            const char *b_path, lr_error *error)
{
    if (strcmp(a->id.software, b->id.software) != 0)
        return lr_fail(error, LR_ERROR_FILE,
                       "%.300s is by %s, %.300s by %s; render all parts with one version", a_path,
                       a->id.software, b_path, b->id.software);
    if (strcmp(a->id.numbers, b->id.numbers) != 0)
        return lr_fail(error, LR_ERROR_FILE,
                       "%.300s and %.300s are of different scenes: their numbers have the hashes "
                       "%.12s... and %.12s... (lavaray info shows them)",
                       a_path, b_path, a->id.numbers, b->id.numbers);
    if (strcmp(a->id.settings, b->id.settings) != 0 || a->samples != b->samples ||
        a->width != b->width || a->height != b->height || a->exposure != b->exposure ||
        a->white != b->white || a->tone != b->tone)
        return lr_fail(error, LR_ERROR_FILE,
                       "%.200s and %.200s have different settings: '%.200s' and '%.200s'", a_path,
                       b_path, a->id.settings, b->id.settings);
    return LR_OK;
}

static void add(lr_sums *sums, const lr_sums *part)
{
    size_t words = (size_t)sums->width * sums->height * LR_FILM_WORDS;
    for (size_t i = 0; i < words; i += LR_FILM_WORDS)
        lr_film_add(&sums->film[i], &part->film[i]);
}

/* Reads the part and adds it to the sums, which it becomes when they are the first. */
static lr_status take_part(lr_sums *sums, const char *first_path, range *part_range,
                           lr_error *error)
{
    lr_sums part;
    const char *path = part_range->path;
    lr_status status = lr_sums_read(path, &part, error);
    if (!status)
        status = check_complete(&part, path, error);
    if (!status && sums->film)
        status = check_same(sums, first_path, &part, path, error);
    part_range->first = part.first;
    part_range->end = part.first + part.count;
    if (!status && sums->film) {
        add(sums, &part);
    } else if (!status) {
        *sums = part;
        return LR_OK;
    }
    lr_sums_free(&part);
    return status;
}

/* "16-31, 48, ..." appended to a list, as far as it has room. */
static void list_missing(char *list, size_t size, uint32_t first, uint32_t end)
{
    size_t used = strlen(list);
    const char *separator = used ? ", " : "";
    if (size - used < 24) {
        if (!strstr(list, "..."))
            snprintf(list + used, size - used, ", ...");
    } else if (end - first == 1) {
        snprintf(list + used, size - used, "%s%u", separator, first);
    } else {
        snprintf(list + used, size - used, "%s%u-%u", separator, first, end - 1);
    }
}

/* Sorts the ranges; what no part has goes into `missing`. */
static lr_status check_ranges(range *ranges, uint32_t count, uint32_t samples, char *missing,
                              size_t size, lr_error *error)
{
    qsort(ranges, count, sizeof *ranges, compare_ranges);
    uint32_t next = 0;
    for (uint32_t i = 0; i < count; i++) {
        const range *r = &ranges[i];
        if (r->first < next)
            return lr_fail(error, LR_ERROR_FILE,
                           "%.300s and %.300s have samples in common, from %u on; leave out one of "
                           "them",
                           ranges[i - 1].path, r->path, r->first);
        if (r->first > next)
            list_missing(missing, size, next, r->first);
        next = r->end;
    }
    if (next < samples)
        list_missing(missing, size, next, samples);
    return LR_OK;
}

static lr_status make_picture(const lr_sums *sums, lr_picture *picture, lr_merge_info *info,
                              lr_error *error)
{
    *picture = (lr_picture){sums->width, sums->height, NULL};
    picture->pixels = lr_alloc((size_t)sums->width * sums->height, 3 * sizeof(float));
    if (!picture->pixels)
        return lr_fail(error, LR_ERROR_MEMORY, "not enough memory for %ux%u pixels", sums->width,
                       sums->height);
    lr_sums_resolve(sums, picture->pixels);
    memcpy(info->scene_hash, sums->scene, sizeof info->scene_hash);
    memcpy(info->settings, sums->id.settings, sizeof info->settings);
    info->exposure = sums->exposure;
    info->white = sums->white;
    info->tone = sums->tone;
    info->samples = sums->film[LR_FILM_SAMPLES];
    lr_picture_hash(picture, info->hash);
    return LR_OK;
}

lr_status lr_merge_parts(const char *const *paths, uint32_t count, bool partial,
                         lr_picture *picture, lr_merge_info *info, lr_error *error)
{
    lr_merge_info own;
    lr_sums sums = {0};
    info = info ? info : &own;
    *info = (lr_merge_info){0};
    *picture = (lr_picture){0};
    if (count == 0)
        return lr_fail(error, LR_ERROR_ARGUMENT, "there are no parts to merge");
    range *ranges = lr_alloc(count, sizeof *ranges);
    lr_status status = ranges ? LR_OK : lr_fail(error, LR_ERROR_MEMORY, "out of memory");
    for (uint32_t i = 0; i < count && !status; i++) {
        ranges[i].path = paths[i];
        status = take_part(&sums, paths[0], &ranges[i], error);
    }
    if (!status)
        status =
            check_ranges(ranges, count, sums.samples, info->missing, sizeof info->missing, error);
    if (!status && info->missing[0] && !partial)
        status = lr_fail(error, LR_ERROR_FILE,
                         "samples %s of %u are missing; render them with --sample-range, or take "
                         "what is there with --partial",
                         info->missing, sums.samples);
    if (!status)
        status = make_picture(&sums, picture, info, error);
    lr_sums_free(&sums);
    free(ranges);
    return status;
}
