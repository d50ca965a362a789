/* Names: a table from text to a number, and the nearest of several names to a mistyped one. */
#ifndef LR_SCENE_NAMES_H
#define LR_SCENE_NAMES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct lr_name {
    const char *text; /* NULL: an empty slot */
    uint32_t length, value;
} lr_name;

/* Zeroed is empty. The text of the names stays the caller's and outlives the table. */
typedef struct lr_names {
    lr_name *slots;
    uint32_t capacity, count;
} lr_names;

/* Enters or replaces a name; false when memory is out. */
bool lr_names_put(lr_names *names, const char *text, size_t length, uint32_t value);
bool lr_names_get(const lr_names *names, const char *text, size_t length, uint32_t *value);
void lr_names_free(lr_names *names);

/* The search for the name nearest to `text`: start with {text, length}, offer the candidates,
 * read `best`, which is NULL when none is near. */
typedef struct lr_nearest {
    const char *text;
    size_t length;
    const char *best;
    uint32_t distance;
} lr_nearest;

void lr_nearest_offer(lr_nearest *nearest, const char *candidate);

#endif
