#include "render/light_map.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "scene/color.h"

#define STEPS 1073741824.0

/* The means of all texels, for each byte's value; the textures of light are colours. */
static double texel_mean(const lr_texture *t, size_t i, const double *curve)
{
    if (t->floats)
        return ((double)t->floats[3 * i] + t->floats[3 * i + 1] + t->floats[3 * i + 2]) / 3;
    const uint8_t *b = &t->bytes[4 * i];
    return (curve[b[0]] + curve[b[1]] + curve[b[2]]) / 3;
}

bool lr_light_map_build(const lr_texture *t, lr_light_map *map)
{
    *map = (lr_light_map){
        .texture = t,
        .columns = (t->width + LR_LIGHT_BLOCK - 1) / LR_LIGHT_BLOCK,
        .rows = (t->height + LR_LIGHT_BLOCK - 1) / LR_LIGHT_BLOCK,
    };
    size_t pitch = map->columns + 1;
    map->sums = lr_alloc(pitch * (map->rows + 1), sizeof *map->sums);
    if (!map->sums)
        return false;
    double curve[256];
    for (unsigned i = 0; i < 256; i++)
        curve[i] = lr_srgb_to_linear(i);
    size_t count = (size_t)t->width * t->height;
    for (size_t i = 0; i < count; i++)
        map->unit = fmax(map->unit, texel_mean(t, i, curve));
    for (size_t i = 0; i < count && map->unit > 0; i++) {
        size_t x = i % t->width / LR_LIGHT_BLOCK, y = i / t->width / LR_LIGHT_BLOCK;
        uint64_t *sum = &map->sums[(y + 1) * pitch + x + 1];
        *sum += (uint64_t)ceil(texel_mean(t, i, curve) / map->unit * STEPS);
    }
    for (size_t y = 1; y <= map->rows; y++)
        for (size_t x = 1; x < pitch; x++)
            map->sums[y * pitch + x] += map->sums[y * pitch + x - 1];
    for (size_t y = 1; y <= map->rows; y++)
        for (size_t x = 1; x < pitch; x++)
            map->sums[y * pitch + x] += map->sums[(y - 1) * pitch + x];
    return true;
}

void lr_light_map_free(lr_light_map *map)
{
    free(map->sums);
    *map = (lr_light_map){.sums = NULL};
}

/* The texels that blending reaches along one side, as [from, end) of the blocks; all of them where
 * the coordinates leave the picture, whose neighbours are then elsewhere in it. */
static void blocks_of(double low, double high, uint32_t size, uint32_t blocks, uint32_t *from,
                      uint32_t *end)
{
    double first = floor(low * size - 0.5) - 1, last = floor(high * size - 0.5) + 2;
    bool inside = first >= 0 && last <= size - 1.0;
    *from = inside ? (uint32_t)first / LR_LIGHT_BLOCK : 0;
    *end = inside ? (uint32_t)last / LR_LIGHT_BLOCK + 1 : blocks;
}

double lr_light_map_mean(const lr_light_map *map, const double low[2], const double high[2])
{
    const lr_texture *t = map->texture;
    uint32_t left, right, top, bottom;
    blocks_of(low[0], high[0], t->width, map->columns, &left, &right);
    blocks_of(low[1], high[1], t->height, map->rows, &top, &bottom);
    const uint64_t *upper = &map->sums[(size_t)top * (map->columns + 1)];
    const uint64_t *lower = &map->sums[(size_t)bottom * (map->columns + 1)];
    uint64_t sum = lower[right] - lower[left] - upper[right] + upper[left];
    double width = fmin(right * (double)LR_LIGHT_BLOCK, t->width) - left * (double)LR_LIGHT_BLOCK;
    double height = fmin(bottom * (double)LR_LIGHT_BLOCK, t->height) - top * (double)LR_LIGHT_BLOCK;
    return (double)sum / STEPS * map->unit / (width * height);
}
