#include "base/memory.h"

#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

void *lr_alloc(size_t count, size_t size)
{
    return calloc(count ? count : 1, size ? size : 1);
}

void *lr_alloc_large(size_t count, size_t size)
{
    const size_t page = (size_t)2 << 20;
    size_t bytes;
    if (__builtin_mul_overflow(count, size, &bytes) || bytes > PTRDIFF_MAX - page)
        return NULL;
    if (bytes < 2 * page)
        return malloc(bytes ? bytes : 1);
    bytes = (bytes + page - 1) / page * page;
    void *memory = aligned_alloc(page, bytes);
    if (memory)
        (void)madvise(memory, bytes, MADV_HUGEPAGE);
    return memory;
}

char *lr_string_copy(const char *text, size_t length)
{
    char *copy = lr_alloc(length + 1, 1);
    if (copy)
        memcpy(copy, text, length);
    return copy;
}

bool lr_array_reserve(void **items, uint32_t count, uint32_t *capacity, size_t size)
{
    if (count < *capacity)
        return true;
    if (*capacity > UINT32_MAX / 2)
        return false;
    uint32_t wanted = *capacity ? *capacity * 2 : 16;
    if (wanted > SIZE_MAX / size)
        return false;
    char *grown = realloc(*items, wanted * size);
    if (!grown)
        return false;
    memset(grown + count * size, 0, (wanted - count) * size);
    *items = grown;
    *capacity = wanted;
    return true;
}
