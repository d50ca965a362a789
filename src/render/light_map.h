/* How bright parts of a picture are. */
#ifndef LR_RENDER_LIGHT_MAP_H
#define LR_RENDER_LIGHT_MAP_H

#include "scene/scene.h"

/* Sums over squares of LR_LIGHT_BLOCK texels: sums[y * (columns + 1) + x] is that of all squares
 * left of and above x, y, in units of 2^-30 of `unit`, rounded up for each texel. */
#define LR_LIGHT_BLOCK 8
typedef struct lr_light_map {
    const lr_texture *texture;
    uint64_t *sums; /* owned */
    double unit;    /* the greatest mean of a texel's red, green and blue */
    uint32_t columns, rows;
} lr_light_map;

/* False when memory is out. */
bool lr_light_map_build(const lr_texture *texture, lr_light_map *map);
void lr_light_map_free(lr_light_map *map);

/* About the mean of red, green and blue where texture coordinates lie within low..high; that of the
 * whole picture where they go beyond 0..1. 0 only if all of it is black. */
double lr_light_map_mean(const lr_light_map *map, const double low[2], const double high[2]);

#endif
