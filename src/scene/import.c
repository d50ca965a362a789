#include "scene/import.h"

#include <assimp/cimport.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "scene/import_internal.h"

/* What assimp needs beside the text of a file while it parses it: an OBJ face of 8 bytes becomes
 * about 100. */
#define PARSE_FACTOR 8

/* ---- Kinds --------------------------------------------------------------------------------- */

static bool find_kind(const char *path, lr_import_kind *kind)
{
    static const char *const endings[] = {".gltf", ".glb", ".obj", ".ply", ".stl"};
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    for (size_t i = 0; dot && i < sizeof endings / sizeof *endings; i++) {
        if (strcasecmp(dot, endings[i]) == 0) {
            *kind = (lr_import_kind)i;
            return true;
        }
    }
    return false;
}

bool lr_import_knows(const char *path)
{
    lr_import_kind kind;
    return find_kind(path, &kind);
}

const char *lr_import_bare_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* ---- What the parts share ------------------------------------------------------------------ */

const char *lr_import_shown(char *buffer, size_t size, const char *text)
{
    size_t used = 0;
    while (text[used] && used + 1 < size) {
        unsigned char c = (unsigned char)text[used];
        buffer[used++] = c < 0x20 || c == 0x7F ? '?' : (char)c;
    }
    /* Not within a character of several bytes. */
    if (text[used])
        while (used > 0 && ((unsigned char)text[used] & 0xC0) == 0x80)
            used--;
    buffer[used] = 0;
    return buffer;
}

lr_status lr_import_no_memory(lr_import *import)
{
    return lr_fail(import->error, LR_ERROR_MEMORY, "%s: out of memory", import->shown);
}

lr_status lr_import_note(lr_import *import, const char *format, ...)
{
    char text[512];
    if (import->notes++ >= LR_IMPORT_NOTES_MAX)
        return LR_OK;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return lr_scene_add_note(import->builder, "%s: %s", import->shown, text)
               ? LR_OK
               : lr_import_no_memory(import);
}

lr_status lr_import_charge(lr_import *import, uint64_t bytes, const char *what)
{
    if (bytes > import->options.max_memory - import->memory)
        return lr_fail(import->error, LR_ERROR_MEMORY,
                       "%s: %s needs more memory than the %llu MiB allowed; allow more with "
                       "--max-memory",
                       import->shown, what, (unsigned long long)(import->options.max_memory >> 20));
    import->memory += bytes;
    return LR_OK;
}

lr_status lr_import_progress(lr_import *import, double fraction)
{
    const lr_load_options *options = &import->options;
    if (options->progress && !options->progress(options->user, "reading", fraction))
        return lr_fail(import->error, LR_ERROR_INTERRUPTED, "%s: interrupted", import->shown);
    return LR_OK;
}

static void count_meshes(const lr_scene *scene, uint64_t *triangles, uint64_t *memory)
{
    for (uint32_t i = 0; i < scene->mesh_count; i++) {
        *triangles += scene->meshes[i].triangle_count;
        *memory += (uint64_t)scene->meshes[i].triangle_count * 12 +
                   (uint64_t)scene->meshes[i].vertex_count * 44;
    }
}

/* ---- One file ------------------------------------------------------------------------------ */

/* What the meshes of other files of the scene take up already. */
static void count_present(lr_import *import)
{
    count_meshes(import->builder->scene, &import->triangles, &import->memory);
    if (import->builder->beside)
        count_meshes(import->builder->beside, &import->triangles, &import->memory);
    if (import->memory > import->options.max_memory)
        import->memory = import->options.max_memory;
    if (import->triangles > import->options.max_triangles)
        import->triangles = import->options.max_triangles;
}

/* Fills in the defaults. */
static void settle(lr_load_options *options)
{
    if (options->max_triangles == 0)
        options->max_triangles = LR_IMPORT_TRIANGLES_DEFAULT;
    if (options->max_memory == 0)
        options->max_memory = LR_IMPORT_MEMORY_DEFAULT;
}

bool lr_import_fits(const lr_scene *scene, const lr_scene *more, const lr_load_options *options)
{
    lr_load_options settled = *options;
    uint64_t triangles = 0, memory = 0;
    settle(&settled);
    count_meshes(scene, &triangles, &memory);
    count_meshes(more, &triangles, &memory);
    return triangles <= settled.max_triangles && memory <= settled.max_memory;
}

static void start(lr_import *import, lr_scene_builder *builder, const char *base_file,
                  const char *name, const lr_load_options *options, lr_error *error)
{
    *import = (lr_import){.builder = builder,
                          .base_file = base_file,
                          .name = name,
                          .error = error,
                          .world = lr_bounds_empty()};
    if (options)
        import->options = *options;
    settle(&import->options);
    find_kind(name, &import->kind);
    count_present(import);
}

static void finish(lr_import *import)
{
    if (import->scene && !import->ply)
        aiReleaseImport(import->scene);
    lr_ply_free(import->ply);
    json_decref(import->json);
    free(import->bytes);
    free(import->meshes);
    free(import->bounds);
    free(import->materials);
}

/* Tables over what assimp returned. */
static lr_status make_tables(lr_import *import)
{
    const struct aiScene *scene = import->scene;
    size_t meshes = scene->mMeshes ? scene->mNumMeshes : 0;
    size_t materials = scene->mMaterials ? scene->mNumMaterials : 0;
    if (meshes != scene->mNumMeshes || materials != scene->mNumMaterials)
        return lr_fail(import->error, LR_ERROR_FILE, "%s: has no meshes", import->shown);
    import->meshes = malloc((meshes + 1) * sizeof *import->meshes);
    import->bounds = lr_alloc(meshes + 1, sizeof *import->bounds);
    import->materials = malloc((materials + 1) * sizeof *import->materials);
    if (!import->meshes || !import->bounds || !import->materials)
        return lr_import_no_memory(import);
    memset(import->meshes, 0xFF, (meshes + 1) * sizeof *import->meshes);
    memset(import->materials, 0xFF, (materials + 1) * sizeof *import->materials);
    return LR_OK;
}

lr_status lr_import_convert(lr_import *import)
{
    uint32_t before = import->builder->scene->object_count;
    lr_status status = make_tables(import);
    if (!status)
        status = lr_import_nodes(import);
    if (!status && import->json)
        status = lr_gltf_notes(import);
    if (!status && import->builder->scene->object_count == before)
        status = lr_fail(import->error, LR_ERROR_FILE,
                         "%s: there is nothing in it that can be shown%s%s", import->shown,
                         import->notes > 0 ? "; " : "",
                         import->notes > 0
                             ? import->builder->scene->notes[import->builder->scene->note_count - 1]
                             : "");
    if (!status && import->notes > LR_IMPORT_NOTES_MAX &&
        !lr_scene_add_note(import->builder, "%s: and %u more notes", import->shown,
                           import->notes - LR_IMPORT_NOTES_MAX))
        status = lr_import_no_memory(import);
    return status;
}

/* Adds the file's objects to the scene. */
static lr_status add_objects(lr_import *import)
{
    lr_status status = lr_import_progress(import, 0);
    if (!status)
        status = lr_import_guard(import);
    if (!status)
        status = lr_import_charge(import, PARSE_FACTOR * (uint64_t)import->size, "the file");
    if (!status)
        status = lr_import_progress(import, 0.1);
    if (!status)
        status = import->kind == LR_IMPORT_PLY ? lr_ply_parse(import) : lr_import_parse(import);
    if (!status)
        status = lr_import_progress(import, 0.6);
    if (!status)
        status = lr_import_convert(import);
    return status;
}

lr_status lr_import_scene(const char *path, const lr_load_options *options, lr_scene **scene,
                          lr_error *error)
{
    lr_import import;
    lr_scene_builder builder = {.scene = lr_alloc(1, sizeof(lr_scene))};
    lr_status status = LR_ERROR_MEMORY;
    *scene = NULL;
    if (options)
        builder.donors[0] = options->previous;
    start(&import, &builder, path, lr_import_bare_name(path), options, error);
    lr_import_shown(import.shown, sizeof import.shown, path);
    if (builder.scene)
        builder.scene->source = lr_string_copy(path, strlen(path));
    if (!builder.scene || !builder.scene->source) {
        lr_import_no_memory(&import);
        goto done;
    }
    /* The file itself may be anywhere: it was named by hand. */
    status = lr_file_read(
        path, import.options.max_memory < SIZE_MAX ? (size_t)import.options.max_memory : SIZE_MAX,
        &import.bytes, &import.size, error);
    if (status)
        goto done;
    import.memory += import.size;
    lr_hash_bytes(import.bytes, import.size, builder.scene->sha256);
    status = add_objects(&import);
    if (!status && import.json)
        status = lr_gltf_view(&import);
    if (!status)
        status = lr_import_surroundings(&import);
    if (!status)
        status = lr_import_progress(&import, 1);
done:
    finish(&import);
    if (status)
        lr_scene_destroy(builder.scene);
    else
        *scene = builder.scene;
    return status;
}

lr_status lr_import_objects(lr_scene_builder *builder, const char *base_file, const char *name,
                            const lr_load_options *options, lr_error *error)
{
    lr_import import;
    start(&import, builder, base_file, name, options, error);
    lr_import_shown(import.shown, sizeof import.shown, name);
    lr_status status =
        lr_import_read(&import, lr_import_bare_name(name), &import.bytes, &import.size, error);
    if (!status)
        status = add_objects(&import);
    if (!status && import.json &&
        (lr_gltf_member(import.json, "cameras") ||
         lr_gltf_extension(import.json, "KHR_lights_punctual")))
        status =
            lr_import_note(&import, "its cameras and lights are left out: the scene has its own");
    finish(&import);
    return status;
}
