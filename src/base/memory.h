/* Checked allocation. Every function returns NULL on overflow or exhaustion and never exits. */
#ifndef LR_BASE_MEMORY_H
#define LR_BASE_MEMORY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* count * size zeroed bytes; freed with free(). */
void *lr_alloc(size_t count, size_t size);

/* The same without zeros, for what is written in full before it is read: where it is large, on huge
 * pages if the system has them, which saves most of the faults of first touch. */
void *lr_alloc_large(size_t count, size_t size);

/* A NUL-terminated copy of length bytes of text; freed with free(). */
char *lr_string_copy(const char *text, size_t length);

/* Makes room for one more element of `size` bytes in the growing array *items that holds `count`
 * and has room for *capacity. The new space is zeroed. False when memory is out; the array then
 * stays as it was. */
bool lr_array_reserve(void **items, uint32_t count, uint32_t *capacity, size_t size);

#endif
