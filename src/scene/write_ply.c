/* Meshes as binary PLY files (Greg Turk, "The PLY Polygon File Format", 1994). */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "scene/write.h"

static char *put_word(char *at, uint32_t word)
{
    for (int i = 0; i < 4; i++)
        *at++ = (char)(word >> 8 * i & 0xFF);
    return at;
}

static char *put_floats(char *at, const float *values, int count)
{
    for (int i = 0; values && i < count; i++) {
        uint32_t word;
        memcpy(&word, &values[i], sizeof word);
        at = put_word(at, word);
    }
    return at;
}

char *lr_mesh_ply(const lr_mesh *mesh, size_t *size)
{
    char header[1024];
    int length = snprintf(
        header, sizeof header,
        "ply\nformat binary_little_endian 1.0\nelement vertex %u\n"
        "property float x\nproperty float y\nproperty float z\n%s%s%s"
        "element face %u\nproperty list uchar uint vertex_indices\nend_header\n",
        (unsigned)mesh->vertex_count,
        mesh->normals ? "property float nx\nproperty float ny\nproperty float nz\n" : "",
        mesh->uvs ? "property float s\nproperty float t\n" : "",
        mesh->colors ? "property float red\nproperty float green\nproperty float blue\n" : "",
        (unsigned)mesh->triangle_count);
    size_t floats = 3 + (mesh->normals ? 3u : 0) + (mesh->uvs ? 2u : 0) + (mesh->colors ? 3u : 0);
    *size = (size_t)length + mesh->vertex_count * floats * 4 + mesh->triangle_count * (size_t)13;
    char *bytes = lr_alloc(*size, 1), *at = bytes;
    if (!bytes)
        return NULL;
    memcpy(at, header, (size_t)length);
    at += length;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        at = put_floats(at, mesh->positions + 3 * i, 3);
        at = put_floats(at, mesh->normals ? mesh->normals + 3 * i : NULL, 3);
        at = put_floats(at, mesh->uvs ? mesh->uvs + 2 * i : NULL, 2);
        at = put_floats(at, mesh->colors ? mesh->colors + 3 * i : NULL, 3);
    }
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        *at++ = 3;
        for (int k = 0; k < 3; k++)
            at = put_word(at, mesh->triangles[3 * i + (size_t)k]);
    }
    return bytes;
}
