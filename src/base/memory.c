#include "base/memory.h"

#include <stdlib.h>
#include <string.h>

void *lr_alloc(size_t count, size_t size)
{
    return calloc(count ? count : 1, size ? size : 1);
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
