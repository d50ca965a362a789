/* Shared by the tests of files of other programs. */
#ifndef LR_IMPORT_TESTS_H
#define LR_IMPORT_TESTS_H

#include <sys/stat.h>
#include <unistd.h>

#include "scene_tests.h"
#include "temporary_folder.h"

#define SHARED SOURCE_DIR "/../shared/data/"

static inline void file_path(char path[256], const char *name)
{
    snprintf(path, 256, "%s/%s", folder, name);
}

static inline void put_bytes(const char *name, const void *bytes, size_t size)
{
    char path[256];
    file_path(path, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

static inline void put_text(const char *name, const char *text)
{
    put_bytes(name, text, strlen(text));
}

/* Loads a file of the folder that must be a scene. */
static inline lr_scene *import_good(const char *name)
{
    char path[256], *report = NULL;
    lr_scene *scene = NULL;
    lr_error error = {0};
    file_path(path, name);
    lr_status status = lr_scene_load(path, NULL, &scene, &report, &error);
    if (status != LR_OK)
        print_error("%s\n%s\n", error.message, report ? report : "");
    free(report);
    assert_int_equal(status, LR_OK);
    return scene;
}

/* Whether loading fails with a message that holds the fragment and the file's name. */
static inline bool import_fails(const char *name, const lr_load_options *options,
                                const char *fragment)
{
    char path[256], *report = NULL;
    lr_scene *scene = NULL;
    lr_error error = {0};
    file_path(path, name);
    lr_status status = lr_scene_load(path, options, &scene, &report, &error);
    const char *message = report ? report : error.message;
    bool good = status != LR_OK && !scene && strstr(message, fragment) && strstr(message, name);
    if (!good)
        print_error("expected: %s\ngot: %s\n", fragment, status == LR_OK ? "a scene" : message);
    lr_scene_destroy(scene);
    free(report);
    return good;
}

static inline bool has_note(const lr_scene *scene, const char *fragment)
{
    for (uint32_t i = 0; i < scene->note_count; i++)
        if (strstr(scene->notes[i], fragment))
            return true;
    print_error("no note says: %s\n", fragment);
    for (uint32_t i = 0; i < scene->note_count; i++)
        print_error("  %s\n", scene->notes[i]);
    return false;
}

/* A triangle at (0,0,0) (1,0,0) (0,1,0) as t.bin, 36 bytes of positions and 6 of indices. */
static inline void put_triangle_bin(void)
{
    unsigned char bytes[44] = {0};
    const float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const uint16_t indices[3] = {0, 1, 2};
    memcpy(bytes, positions, sizeof positions);
    memcpy(bytes + 36, indices, sizeof indices);
    put_bytes("t.bin", bytes, sizeof bytes);
}

/* The rest of a glTF file around `nodes` and `more`, which ends with a comma when it is not empty:
 * mesh 0 is the triangle with material 0, if there is one. */
#define GLTF_HEAD "{\"asset\": {\"version\": \"2.0\"}, \"scenes\": [{\"nodes\": [0]}],"
#define GLTF_BUFFERS                                                                               \
    "\"buffers\": [{\"byteLength\": 44, \"uri\": \"t.bin\"}],"                                     \
    "\"bufferViews\": [{\"buffer\": 0, \"byteLength\": 36},"                                       \
    "{\"buffer\": 0, \"byteOffset\": 36, \"byteLength\": 6}],"
#define GLTF_ACCESSORS                                                                             \
    "\"accessors\": [{\"bufferView\": 0, \"componentType\": 5126, \"count\": 3, \"type\": "        \
    "\"VEC3\"},"                                                                                   \
    "{\"bufferView\": 1, \"componentType\": 5123, \"count\": 3, \"type\": \"SCALAR\"}],"
#define GLTF_MESH(material)                                                                        \
    "\"meshes\": [{\"name\": \"tri\", \"primitives\": [{\"attributes\": {\"POSITION\": 0}, "       \
    "\"indices\": 1" material "}]}]"
#define GLTF(nodes, material, more)                                                                \
    GLTF_HEAD "\"nodes\": [" nodes "]," more GLTF_BUFFERS GLTF_ACCESSORS GLTF_MESH(material) "}"

#endif
