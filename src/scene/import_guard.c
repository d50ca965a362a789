/* Headers of PLY and STL files that promise more than the file holds: assimp would allocate what
 * they say. */
#define _GNU_SOURCE /* memmem */
#include "scene/import_internal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { STL_HEADER = 84, STL_TRIANGLE = 50 };

static lr_status too_many(lr_import *import, const char *what, uint64_t count)
{
    return lr_fail(import->error, LR_ERROR_FILE,
                   "%s: its header says %llu %s, the file is too short for them", import->shown,
                   (unsigned long long)count, what);
}

/* Whether it is the binary form: the text one begins with "solid" and says "facet" early on; some
 * binary files begin with "solid" too. */
static lr_status guard_stl(lr_import *import)
{
    const char *bytes = import->bytes;
    size_t size = import->size;
    if (size >= 5 && memcmp(bytes, "solid", 5) == 0 &&
        memmem(bytes, size < 1000 ? size : 1000, "facet", 5))
        return LR_OK;
    if (size < STL_HEADER)
        return lr_fail(import->error, LR_ERROR_FILE, "%s: is no STL file, or cut short",
                       import->shown);
    const unsigned char *b = (const unsigned char *)bytes + STL_HEADER - 4;
    uint64_t count = b[0] | (uint64_t)b[1] << 8 | (uint64_t)b[2] << 16 | (uint64_t)b[3] << 24;
    if (count > (size - STL_HEADER) / STL_TRIANGLE)
        return too_many(import, "triangles", count);
    return LR_OK;
}

/* The next line of at most 200 characters; false at the end. *at moves behind it. */
static bool next_line(const lr_import *import, size_t *at, char line[201])
{
    size_t used = 0;
    if (*at >= import->size)
        return false;
    while (*at < import->size && import->bytes[*at] != '\n' && import->bytes[*at] != '\r') {
        if (used < 200)
            line[used++] = import->bytes[*at];
        ++*at;
    }
    ++*at;
    line[used] = 0;
    return true;
}

/* Each element of a PLY file has at least one byte. */
static lr_status guard_ply(lr_import *import)
{
    char line[201], name[100];
    size_t at = 0;
    unsigned long long count;
    if (!next_line(import, &at, line) || strncmp(line, "ply", 3) != 0)
        return lr_fail(import->error, LR_ERROR_FILE, "%s: is no PLY file: it does not begin as one",
                       import->shown);
    while (next_line(import, &at, line)) {
        if (strncmp(line, "end_header", 10) == 0)
            return LR_OK;
        if (sscanf(line, " element %99s %llu", name, &count) != 2)
            continue;
        if (strchr(line, '-') || count > import->size)
            return too_many(import, "elements of one kind", count);
        if (strcmp(name, "face") == 0 && count > import->options.max_triangles)
            return lr_fail(import->error, LR_ERROR_FILE,
                           "%s: has %llu faces, more than %llu triangles; allow more with "
                           "--max-triangles",
                           import->shown, count, (unsigned long long)import->options.max_triangles);
    }
    return lr_fail(import->error, LR_ERROR_FILE, "%s: its header has no end", import->shown);
}

lr_status lr_import_guard(lr_import *import)
{
    switch (import->kind) {
    case LR_IMPORT_GLTF:
    case LR_IMPORT_GLB:
        return lr_gltf_guard(import);
    case LR_IMPORT_PLY:
        return guard_ply(import);
    case LR_IMPORT_STL:
        return guard_stl(import);
    case LR_IMPORT_OBJ:
        break;
    }
    return LR_OK;
}
