#include "scene/rows.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* A multiplication a word, and the high bits folded down, as the slots are taken from the low. */
static uint32_t hash(const void *row, size_t size)
{
    uint64_t value = size;
    for (size_t i = 0; i < size; i += sizeof(uint32_t)) {
        uint32_t word = 0;
        memcpy(&word, (const char *)row + i, size - i < sizeof word ? size - i : sizeof word);
        value = (value ^ word) * 0x9E3779B97F4A7C15u;
        value ^= value >> 29;
    }
    return (uint32_t)(value ^ value >> 32);
}

static const char *row_at(const lr_rows *rows, uint32_t index)
{
    return (const char *)rows->items + index * rows->size;
}

/* The slot that holds the row, or the empty one where it belongs. */
static uint32_t *find(const lr_rows *rows, const void *row)
{
    uint32_t mask = rows->slot_count - 1, slot = hash(row, rows->size) & mask;
    while (rows->slots[slot] && memcmp(row_at(rows, rows->slots[slot] - 1), row, rows->size) != 0)
        slot = (slot + 1) & mask;
    return &rows->slots[slot];
}

static bool grow_slots(lr_rows *rows)
{
    if (rows->slot_count > UINT32_MAX / 2)
        return false;
    lr_rows grown = *rows;
    grown.slot_count = rows->slot_count ? rows->slot_count * 2 : 64;
    grown.slots = lr_alloc(grown.slot_count, sizeof *grown.slots);
    if (!grown.slots)
        return false;
    for (uint32_t i = 0; i < rows->slot_count; i++)
        if (rows->slots[i])
            *find(&grown, row_at(rows, rows->slots[i] - 1)) = rows->slots[i];
    free(rows->slots);
    *rows = grown;
    return true;
}

uint32_t lr_rows_add(lr_rows *rows, const void *row)
{
    if (!lr_array_reserve(&rows->items, rows->count, &rows->capacity, rows->size))
        return UINT32_MAX;
    memcpy((char *)rows->items + rows->count * rows->size, row, rows->size);
    return rows->count++;
}

uint32_t lr_rows_put(lr_rows *rows, const void *row)
{
    if (rows->slots_used >= rows->slot_count / 2 && !grow_slots(rows))
        return UINT32_MAX;
    uint32_t *slot = find(rows, row);
    if (*slot)
        return *slot - 1;
    uint32_t index = lr_rows_add(rows, row);
    if (index != UINT32_MAX) {
        *slot = index + 1;
        rows->slots_used++;
    }
    return index;
}

void lr_rows_free(lr_rows *rows)
{
    free(rows->items);
    free(rows->slots);
    *rows = (lr_rows){0};
}
