#include "scene/names.h"

#include "base/memory.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

static uint32_t hash(const char *text, size_t length)
{
    uint32_t value = 2166136261u; /* FNV-1a */
    for (size_t i = 0; i < length; i++)
        value = (value ^ (unsigned char)text[i]) * 16777619u;
    return value;
}

static lr_name *find(const lr_names *names, const char *text, size_t length)
{
    uint32_t mask = names->capacity - 1;
    uint32_t slot = hash(text, length) & mask;
    for (;; slot = (slot + 1) & mask) {
        lr_name *name = &names->slots[slot];
        if (!name->text || (name->length == length && memcmp(name->text, text, length) == 0))
            return name;
    }
}

bool lr_names_put(lr_names *names, const char *text, size_t length, uint32_t value)
{
    if (names->count * 2 >= names->capacity) {
        lr_names grown = {.capacity = names->capacity ? names->capacity * 2 : 32};
        grown.slots = lr_alloc(grown.capacity, sizeof *grown.slots);
        if (!grown.slots)
            return false;
        for (uint32_t i = 0; i < names->capacity; i++) {
            const lr_name *old = &names->slots[i];
            if (old->text)
                *find(&grown, old->text, old->length) = *old;
        }
        grown.count = names->count;
        free(names->slots);
        *names = grown;
    }
    lr_name *name = find(names, text, length);
    if (!name->text)
        names->count++;
    *name = (lr_name){text, (uint32_t)length, value};
    return true;
}

bool lr_names_get(const lr_names *names, const char *text, size_t length, uint32_t *value)
{
    if (names->capacity == 0)
        return false;
    const lr_name *name = find(names, text, length);
    if (!name->text)
        return false;
    *value = name->value;
    return true;
}

void lr_names_free(lr_names *names)
{
    free(names->slots);
    *names = (lr_names){0};
}

#define COMPARED_MAX 32

static uint32_t least(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

/* Optimal string alignment distance without regard to case: insertions, deletions, substitutions
 * and swaps of neighbours count one each. */
static uint32_t edit_distance(const char *a, size_t a_length, const char *b, size_t b_length)
{
    uint32_t rows[3][COMPARED_MAX + 1];
    uint32_t *before = rows[0], *last = rows[1], *row = rows[2];
    for (uint32_t j = 0; j <= b_length; j++)
        last[j] = before[j] = j;
    for (size_t i = 1; i <= a_length; i++) {
        row[0] = (uint32_t)i;
        for (size_t j = 1; j <= b_length; j++) {
            int ca = tolower((unsigned char)a[i - 1]), cb = tolower((unsigned char)b[j - 1]);
            uint32_t cost = ca == cb ? 0 : 1;
            row[j] = least(least(last[j] + 1, row[j - 1] + 1), last[j - 1] + cost);
            if (i > 1 && j > 1 && ca == tolower((unsigned char)b[j - 2]) &&
                tolower((unsigned char)a[i - 2]) == cb)
                row[j] = least(row[j], before[j - 2] + 1);
        }
        uint32_t *free_row = before;
        before = last;
        last = row;
        row = free_row;
    }
    return last[b_length];
}

void lr_nearest_offer(lr_nearest *nearest, const char *candidate)
{
    size_t length = strlen(candidate);
    if (nearest->length == 0 || nearest->length > COMPARED_MAX || length > COMPARED_MAX)
        return;
    uint32_t allowed = nearest->length <= 4 ? 1 : (uint32_t)nearest->length / 3;
    size_t gap = length > nearest->length ? length - nearest->length : nearest->length - length;
    if (gap > allowed)
        return;
    uint32_t distance = edit_distance(nearest->text, nearest->length, candidate, length);
    /* One-letter names such as u and v resemble every other letter. */
    if (distance > allowed || distance >= nearest->length || (length == 1 && distance > 0))
        return;
    if (!nearest->best || distance < nearest->distance) {
        nearest->best = candidate;
        nearest->distance = distance;
    }
}
