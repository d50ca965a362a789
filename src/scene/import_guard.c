/* Headers of files that promise more than the file holds: assimp would allocate what they say. */
#define _GNU_SOURCE /* memmem */
#include "scene/import_internal.h"

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

lr_status lr_import_guard(lr_import *import)
{
    switch (import->kind) {
    case LR_IMPORT_GLTF:
    case LR_IMPORT_GLB:
        return lr_gltf_guard(import);
    case LR_IMPORT_STL:
        return guard_stl(import);
    case LR_IMPORT_OBJ:
    case LR_IMPORT_PLY:
        break;
    }
    return LR_OK;
}
