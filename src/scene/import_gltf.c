/* glTF before assimp sees it: the container is checked, and the JSON is cut down to what is shown,
 * so that skins, animations and extensions cannot lead its parser astray. */
#include "scene/import_internal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

#define MAGIC_GLTF 0x46546C67u
#define MAGIC_JSON 0x4E4F534Au
#define MAGIC_BIN 0x004E4942u

enum { HEADER_SIZE = 12, CHUNK_HEADER_SIZE = 8 };

/* ---- Looking things up --------------------------------------------------------------------- */

const json_t *lr_gltf_member(const json_t *object, const char *key)
{
    return object ? json_object_get(object, key) : NULL;
}

const json_t *lr_gltf_extension(const json_t *object, const char *name)
{
    return lr_gltf_member(lr_gltf_member(object, "extensions"), name);
}

double lr_gltf_number(const json_t *object, const char *key, double fallback)
{
    const json_t *value = lr_gltf_member(object, key);
    return json_is_number(value) ? json_number_value(value) : fallback;
}

const json_t *lr_gltf_material(const lr_import *import, uint32_t index)
{
    return json_array_get(lr_gltf_member(import->json, "materials"), index);
}

/* ---- The container ------------------------------------------------------------------------- */

static uint32_t read_u32(const char *bytes)
{
    const unsigned char *b = (const unsigned char *)bytes;
    return b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static void write_u32(char *bytes, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        bytes[i] = (char)(value >> 8 * i & 255);
}

/* Where the parts of a GLB file are. */
typedef struct chunks {
    const char *json, *bin; /* bin: NULL without one */
    uint32_t json_size, bin_size;
} chunks;

static lr_status find_chunks(lr_import *import, chunks *parts)
{
    const char *bytes = import->bytes;
    size_t size = import->size;
    *parts = (chunks){0};
    if (size < HEADER_SIZE || read_u32(bytes) != MAGIC_GLTF)
        return lr_fail(import->error, LR_ERROR_FILE, "%s: is no GLB file: it does not begin as one",
                       import->shown);
    if (read_u32(bytes + 4) != 2)
        return lr_fail(import->error, LR_ERROR_FILE, "%s: version %u of GLB, only 2 is read",
                       import->shown, read_u32(bytes + 4));
    if (read_u32(bytes + 8) > size)
        return lr_fail(import->error, LR_ERROR_FILE,
                       "%s: cut short: its header says %u bytes, there are %zu", import->shown,
                       read_u32(bytes + 8), size);
    size = read_u32(bytes + 8);
    for (size_t at = HEADER_SIZE; at + CHUNK_HEADER_SIZE <= size;) {
        uint32_t length = read_u32(bytes + at), type = read_u32(bytes + at + 4);
        at += CHUNK_HEADER_SIZE;
        if (length > size - at)
            return lr_fail(import->error, LR_ERROR_FILE,
                           "%s: a chunk of %u bytes reaches beyond the end of the file",
                           import->shown, length);
        if (type == MAGIC_JSON && !parts->json) {
            parts->json = bytes + at;
            parts->json_size = length;
        } else if (type == MAGIC_BIN && !parts->bin) {
            parts->bin = bytes + at;
            parts->bin_size = length;
        }
        at += length;
    }
    if (!parts->json)
        return lr_fail(import->error, LR_ERROR_FILE, "%s: has no JSON chunk", import->shown);
    return LR_OK;
}

static lr_status read_json(lr_import *import, const char *text, size_t size)
{
    json_error_t problem;
    lr_status status = lr_import_charge(import, 8 * (uint64_t)size, "its JSON");
    if (status)
        return status;
    import->json = json_loadb(text, size, JSON_ALLOW_NUL, &problem);
    if (!import->json) {
        char reason[200];
        lr_import_shown(reason, sizeof reason, problem.text);
        return lr_fail(import->error, LR_ERROR_FILE, "%s: line %d of its JSON: %s", import->shown,
                       problem.line, reason);
    }
    const char *version =
        json_string_value(lr_gltf_member(lr_gltf_member(import->json, "asset"), "version"));
    if (!version || strncmp(version, "2.", 2) != 0) {
        char shown[40];
        lr_import_shown(shown, sizeof shown, version ? version : "");
        return lr_fail(import->error, LR_ERROR_FILE,
                       "%s: glTF version \"%s\" in `asset`, only 2.0 is read", import->shown,
                       shown);
    }
    return LR_OK;
}

/* ---- Cutting down -------------------------------------------------------------------------- */

/* A shallow copy with only these keys; NULL when memory is out or it is no object. */
static json_t *keep(const json_t *object, const char *const *keys)
{
    json_t *kept = json_is_object(object) ? json_object() : NULL;
    for (; kept && *keys; keys++) {
        json_t *value = json_object_get(object, *keys);
        if (value && json_object_set(kept, *keys, value)) {
            json_decref(kept);
            return NULL;
        }
    }
    return kept;
}

/* Whether the accessor holds floats: assimp copies the bytes of integers as if they were. */
static bool has_floats(const json_t *document, const json_t *accessor)
{
    const json_t *list = json_object_get(document, "accessors");
    const json_t *item = json_array_get(list, (size_t)json_integer_value(accessor));
    return json_integer_value(json_object_get(item, "componentType")) == 5126;
}

static json_t *reduce_primitive(const json_t *document, const json_t *primitive)
{
    static const char *const keys[] = {"indices", "material", "mode", NULL};
    static const char *const attributes[] = {"POSITION", "NORMAL", "TEXCOORD_0", "COLOR_0", NULL};
    json_t *reduced = keep(primitive, keys);
    json_t *kept = keep(json_object_get(primitive, "attributes"), attributes);
    if (kept && !has_floats(document, json_object_get(kept, "TEXCOORD_0")))
        json_object_del(kept, "TEXCOORD_0");
    if (!reduced || !kept || json_object_set_new(reduced, "attributes", kept)) {
        if (!reduced)
            json_decref(kept);
        json_decref(reduced);
        return NULL;
    }
    return reduced;
}

static json_t *reduce_mesh(const json_t *document, const json_t *mesh)
{
    static const char *const keys[] = {"name", NULL};
    const json_t *primitives = json_object_get(mesh, "primitives");
    json_t *reduced = keep(mesh, keys), *list = json_array();
    for (size_t i = 0; reduced && list && i < json_array_size(primitives); i++) {
        if (json_array_append_new(list,
                                  reduce_primitive(document, json_array_get(primitives, i)))) {
            json_decref(list);
            list = NULL;
        }
    }
    if (!reduced || !list || json_object_set_new(reduced, "primitives", list)) {
        if (!reduced)
            json_decref(list);
        json_decref(reduced);
        return NULL;
    }
    return reduced;
}

static json_t *reduce_node(const json_t *document, const json_t *node)
{
    (void)document;
    static const char *const keys[] = {"name",        "children", "mesh",  "matrix",
                                       "translation", "rotation", "scale", NULL};
    return keep(node, keys);
}

static json_t *reduce_material(const json_t *document, const json_t *material)
{
    (void)document;
    static const char *const keys[] = {
        "name", "pbrMetallicRoughness", "normalTexture", "occlusionTexture", "emissiveTexture",
        NULL};
    return keep(material, keys);
}

/* Replaces document[key] by its elements reduced. */
static bool reduce_list(json_t *document, const char *key,
                        json_t *(*reduce)(const json_t *document, const json_t *item))
{
    const json_t *list = json_object_get(document, key);
    json_t *reduced = json_array();
    for (size_t i = 0; reduced && i < json_array_size(list); i++) {
        if (json_array_append_new(reduced, reduce(document, json_array_get(list, i)))) {
            json_decref(reduced);
            reduced = NULL;
        }
    }
    return reduced &&
           (list ? json_object_set_new(document, key, reduced) == 0 : (json_decref(reduced), true));
}

/* The document's text as assimp gets it; NULL when memory is out. */
static char *reduced_text(const json_t *json)
{
    static const char *const keys[] = {
        "asset",       "scene",     "scenes",   "nodes",  "meshes",   "accessors", "buffers",
        "bufferViews", "materials", "textures", "images", "samplers", NULL};
    json_t *document = keep(json, keys);
    char *text = NULL;
    if (document && reduce_list(document, "meshes", reduce_mesh) &&
        reduce_list(document, "nodes", reduce_node) &&
        reduce_list(document, "materials", reduce_material))
        text = json_dumps(document, JSON_COMPACT);
    json_decref(document);
    return text;
}

/* Puts the text, with the binary chunk of a GLB file behind it, in the place of the file. */
static lr_status replace_file(lr_import *import, const char *text, const chunks *parts)
{
    size_t length = strlen(text), padded = (length + 3) / 4 * 4;
    size_t size = HEADER_SIZE + CHUNK_HEADER_SIZE + padded;
    if (parts->bin)
        size += CHUNK_HEADER_SIZE + parts->bin_size;
    if (size > UINT32_MAX)
        return lr_fail(import->error, LR_ERROR_FILE, "%s: over 4 GiB", import->shown);
    lr_status status = lr_import_charge(import, size, "the file");
    if (status)
        return status;
    char *bytes = malloc(size), *out = bytes;
    if (!bytes)
        return lr_import_no_memory(import);
    write_u32(out, MAGIC_GLTF);
    write_u32(out + 4, 2);
    write_u32(out + 8, (uint32_t)size);
    write_u32(out + 12, (uint32_t)padded);
    write_u32(out + 16, MAGIC_JSON);
    out += HEADER_SIZE + CHUNK_HEADER_SIZE;
    memset(out, ' ', padded);
    memcpy(out, text, length);
    out += padded;
    if (parts->bin) {
        write_u32(out, parts->bin_size);
        write_u32(out + 4, MAGIC_BIN);
        memcpy(out + CHUNK_HEADER_SIZE, parts->bin, parts->bin_size);
    }
    free(import->bytes);
    import->bytes = bytes;
    import->size = size;
    return LR_OK;
}

lr_status lr_gltf_guard(lr_import *import)
{
    chunks parts = {.json = import->bytes, .json_size = 0};
    bool binary = import->kind == LR_IMPORT_GLB;
    lr_status status = binary ? find_chunks(import, &parts) : LR_OK;
    if (!status)
        status = read_json(import, parts.json, binary ? parts.json_size : import->size);
    if (!status)
        status = lr_gltf_check(import, parts.bin_size);
    if (status)
        return status;
    char *text = reduced_text(import->json);
    if (!text)
        return lr_import_no_memory(import);
    if (binary) {
        status = replace_file(import, text, &parts);
    } else {
        free(import->bytes);
        import->bytes = text;
        import->size = strlen(text);
        text = NULL;
    }
    free(text);
    return status;
}

/* ---- Notes --------------------------------------------------------------------------------- */

static lr_status note_extensions(lr_import *import)
{
    static const char *const known[] = {
        "KHR_lights_punctual",        "KHR_materials_ior",
        "KHR_materials_transmission", "KHR_texture_transform", /* noted at the material */
        "KHR_materials_volume",       "KHR_materials_emissive_strength",
        "KHR_materials_clearcoat",    "KHR_materials_sheen"};
    const json_t *used = json_object_get(import->json, "extensionsUsed");
    lr_status status = LR_OK;
    for (size_t i = 0; !status && i < json_array_size(used); i++) {
        const char *name = json_string_value(json_array_get(used, i));
        bool found = name == NULL;
        for (size_t k = 0; !found && k < sizeof known / sizeof *known; k++)
            found = strcmp(name, known[k]) == 0;
        char shown[80];
        if (!found)
            status = lr_import_note(import, "extension %s is not shown",
                                    lr_import_shown(shown, sizeof shown, name));
    }
    return status;
}

static bool any_has(const json_t *list, const char *key)
{
    for (size_t i = 0; i < json_array_size(list); i++)
        if (json_object_get(json_array_get(list, i), key))
            return true;
    return false;
}

lr_status lr_gltf_notes(lr_import *import)
{
    const json_t *json = import->json, *meshes = json_object_get(json, "meshes");
    lr_status status = note_extensions(import);
    size_t animations = json_array_size(json_object_get(json, "animations"));
    if (!status && animations)
        status = lr_import_note(import, "%zu animation%s not shown: the scene stands still",
                                animations, animations == 1 ? " is" : "s are");
    if (!status && json_array_size(json_object_get(json, "skins")))
        status = lr_import_note(import, "skins are not shown: meshes keep the pose that they are "
                                        "stored in");
    bool targets = false, integers = false;
    for (size_t i = 0; i < json_array_size(meshes); i++) {
        const json_t *list = json_object_get(json_array_get(meshes, i), "primitives");
        targets = targets || any_has(list, "targets");
        for (size_t k = 0; k < json_array_size(list); k++) {
            const json_t *attributes = json_object_get(json_array_get(list, k), "attributes");
            const json_t *uv = json_object_get(attributes, "TEXCOORD_0");
            integers = integers || (uv && !has_floats(json, uv));
        }
    }
    if (!status && integers)
        status = lr_import_note(import, "texture coordinates that are stored as integers are not "
                                        "read");
    if (!status && targets)
        status =
            lr_import_note(import, "morph targets are not shown: meshes keep their base shape");
    if (!status && json_array_size(json_object_get(json, "scenes")) > 1)
        status = lr_import_note(import, "of its scenes only the one that it names is shown");
    return status;
}
