/* Rows of bytes, each kept once: vertices that corners share, materials that objects share. */
#ifndef LR_SCENE_ROWS_H
#define LR_SCENE_ROWS_H

#include <stddef.h>
#include <stdint.h>

/* Set the size of a row; the rest is zero at the start. */
typedef struct lr_rows {
    size_t size; /* bytes a row */
    void *items; /* the rows, in the order of their first appearance; freed by lr_rows_free */
    uint32_t count;
    uint32_t capacity;
    uint32_t *slots; /* a hash table of indices, 0 for none, otherwise the index + 1 */
    uint32_t slot_count, slots_used;
} lr_rows;

/* The index of the row with these bytes, which is added when there is none; UINT32_MAX when memory
 * is out. Padding counts, so rows have none. */
uint32_t lr_rows_put(lr_rows *rows, const void *row);
/* Adds a row without looking for it; lr_rows_put will not find it either. */
uint32_t lr_rows_add(lr_rows *rows, const void *row);
void lr_rows_free(lr_rows *rows);

#endif
