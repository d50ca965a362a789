/* A glTF document whose parts lie within each other: buffers, views, accessors, meshes, nodes. */
#include "scene/import_internal.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

typedef struct check {
    lr_import *import;
    uint64_t bin_size; /* of a GLB file's chunk */
    const json_t *buffers, *views, *accessors, *meshes, *nodes;
} check;

static lr_status wrong(check *c, const char *kind, size_t index, const char *what)
{
    return lr_fail(c->import->error, LR_ERROR_FILE, "%s: %s %zu: %s", c->import->shown, kind, index,
                   what);
}

/* A whole number of 0 to 2^53; false when the member is something else, true without it. */
static bool whole(const json_t *object, const char *key, uint64_t fallback, uint64_t *value)
{
    const json_t *member = json_object_get(object, key);
    *value = fallback;
    if (!member)
        return true;
    if (!json_is_integer(member) || json_integer_value(member) < 0 ||
        json_integer_value(member) > (json_int_t)1 << 53)
        return false;
    *value = (uint64_t)json_integer_value(member);
    return true;
}

static lr_status check_extensions(check *c)
{
    static const char *const read[] = {
        "KHR_lights_punctual",    "KHR_materials_ior",         "KHR_materials_transmission",
        "KHR_texture_transform",  "KHR_materials_volume",      "KHR_materials_emissive_strength",
        "KHR_materials_unlit",    "KHR_materials_sheen",       "KHR_materials_clearcoat",
        "KHR_materials_specular", "KHR_materials_iridescence", "KHR_materials_anisotropy",
        "KHR_materials_variants"};
    const json_t *required = json_object_get(c->import->json, "extensionsRequired");
    for (size_t i = 0; i < json_array_size(required); i++) {
        const char *name = json_string_value(json_array_get(required, i));
        bool found = false;
        for (size_t k = 0; name && k < sizeof read / sizeof *read; k++)
            found = found || strcmp(name, read[k]) == 0;
        char shown[80];
        if (!found)
            return lr_fail(c->import->error, LR_ERROR_FILE,
                           "%s: needs the extension %s, which is not read; export the file without "
                           "it",
                           c->import->shown,
                           lr_import_shown(shown, sizeof shown, name ? name : "?"));
    }
    return LR_OK;
}

static lr_status check_buffers(check *c)
{
    for (size_t i = 0; i < json_array_size(c->buffers); i++) {
        const json_t *buffer = json_array_get(c->buffers, i);
        uint64_t length;
        if (!json_is_object(buffer) || !whole(buffer, "byteLength", 0, &length) || length == 0)
            return wrong(c, "buffer", i, "has no usable byteLength");
        bool outside = json_object_get(buffer, "uri") != NULL;
        if (outside && !json_is_string(json_object_get(buffer, "uri")))
            return wrong(c, "buffer", i, "its uri is no text");
        if (!outside && (i > 0 || length > c->bin_size))
            return wrong(c, "buffer", i, "is longer than the bytes that the file has for it");
        lr_status status = outside ? lr_import_charge(c->import, length, "its buffers") : LR_OK;
        if (status)
            return status;
    }
    return LR_OK;
}

static lr_status check_views(check *c)
{
    for (size_t i = 0; i < json_array_size(c->views); i++) {
        const json_t *view = json_array_get(c->views, i);
        uint64_t buffer, offset, length, size, stride;
        if (!json_is_object(view) || !whole(view, "buffer", UINT64_MAX, &buffer) ||
            buffer >= json_array_size(c->buffers))
            return wrong(c, "bufferView", i, "names a buffer that there is not");
        if (!whole(json_array_get(c->buffers, (size_t)buffer), "byteLength", 0, &size) ||
            !whole(view, "byteOffset", 0, &offset) || !whole(view, "byteLength", 0, &length) ||
            offset > size || length > size - offset)
            return wrong(c, "bufferView", i, "reaches beyond its buffer");
        if (!whole(view, "byteStride", 0, &stride) || stride > 252)
            return wrong(c, "bufferView", i, "its byteStride is not 4 to 252");
        if (lr_gltf_extension(view, "EXT_meshopt_compression"))
            return wrong(c, "bufferView", i,
                         "is compressed by EXT_meshopt_compression, which is not read");
    }
    return LR_OK;
}

static uint32_t component_size(uint64_t type)
{
    switch (type) {
    case 5120:
    case 5121:
        return 1;
    case 5122:
    case 5123:
        return 2;
    case 5125:
    case 5126:
        return 4;
    default:
        return 0;
    }
}

/* Checks that accessor `index` is one of a shown mesh's; *count is its elements. type is "VEC3" or
 * such, NULL for VEC3 or VEC4; components of 4 bytes are floats unless `integers`. */
static lr_status check_accessor(check *c, const json_t *member, const char *type, bool integers,
                                uint64_t *count)
{
    size_t index = json_is_integer(member) && json_integer_value(member) >= 0
                       ? (size_t)json_integer_value(member)
                       : SIZE_MAX;
    const json_t *accessor = json_array_get(c->accessors, index);
    uint64_t component, view_index, offset, length, stride;
    if (!json_is_object(accessor))
        return lr_fail(c->import->error, LR_ERROR_FILE,
                       "%s: a mesh names an accessor that there is not", c->import->shown);
    const char *own = json_string_value(json_object_get(accessor, "type"));
    bool fits = own && (type ? strcmp(own, type) == 0
                             : strcmp(own, "VEC3") == 0 || strcmp(own, "VEC4") == 0);
    if (!fits || !whole(accessor, "componentType", 0, &component) || !component_size(component) ||
        (component_size(component) == 4 && (component == 5125) != integers))
        return wrong(c, "accessor", index, "its type is not the one that its use needs");
    if (!whole(accessor, "count", 0, count) || *count == 0 || *count >= UINT32_MAX)
        return wrong(c, "accessor", index, "has no usable count");
    if (json_object_get(accessor, "sparse"))
        return wrong(c, "accessor", index, "is sparse, which is not read; export it in full");
    if (!whole(accessor, "bufferView", UINT64_MAX, &view_index) ||
        view_index >= json_array_size(c->views))
        return wrong(c, "accessor", index, "names a bufferView that there is not");
    const json_t *view = json_array_get(c->views, (size_t)view_index);
    uint64_t element =
        component_size(component) * (strcmp(own, "SCALAR") == 0 ? 1u : (uint64_t)(own[3] - '0'));
    if (!whole(accessor, "byteOffset", 0, &offset) || !whole(view, "byteLength", 0, &length) ||
        !whole(view, "byteStride", 0, &stride))
        return wrong(c, "accessor", index, "its byteOffset is no whole number");
    stride = stride ? stride : element;
    if (stride < element || offset > length || length - offset < element ||
        *count - 1 > (length - offset - element) / stride)
        return wrong(c, "accessor", index, "reaches beyond its bufferView");
    return LR_OK;
}

static lr_status check_primitive(check *c, size_t mesh, const json_t *primitive)
{
    static const struct {
        const char *name, *type;
    } others[] = {{"NORMAL", "VEC3"}, {"TEXCOORD_0", "VEC2"}, {"COLOR_0", NULL}};
    const json_t *attributes = json_object_get(primitive, "attributes");
    const json_t *indices = json_object_get(primitive, "indices");
    const json_t *position = json_object_get(attributes, "POSITION");
    uint64_t vertices, count, mode, material;
    if (!json_is_object(attributes) || !position)
        return wrong(c, "mesh", mesh, "a primitive has no POSITION");
    if (lr_gltf_extension(primitive, "KHR_draco_mesh_compression"))
        return wrong(c, "mesh", mesh,
                     "is compressed by KHR_draco_mesh_compression, which is not read");
    lr_status status = check_accessor(c, position, "VEC3", false, &vertices);
    for (size_t i = 0; !status && i < sizeof others / sizeof *others; i++) {
        const json_t *other = json_object_get(attributes, others[i].name);
        if (!other)
            continue;
        status = check_accessor(c, other, others[i].type, false, &count);
        if (!status && count != vertices)
            status = wrong(c, "mesh", mesh, "its attributes have different counts");
    }
    if (!status && indices)
        status = check_accessor(c, indices, "SCALAR", true, &count);
    if (status)
        return status;
    if (!whole(primitive, "mode", 4, &mode) || mode > 6)
        return wrong(c, "mesh", mesh, "the mode of a primitive is not 0 to 6");
    if (!whole(primitive, "material", 0, &material) ||
        (json_object_get(primitive, "material") &&
         material >= json_array_size(json_object_get(c->import->json, "materials"))))
        return wrong(c, "mesh", mesh, "names a material that there is not");
    /* What assimp allocates: vertices with normal, texture coordinates and colour, and faces. */
    return lr_import_charge(c->import, vertices * 52 + (indices ? count : vertices) * 24,
                            "its meshes");
}

static lr_status check_meshes(check *c)
{
    for (size_t i = 0; i < json_array_size(c->meshes); i++) {
        const json_t *list = json_object_get(json_array_get(c->meshes, i), "primitives");
        if (!json_is_array(list) || json_array_size(list) == 0)
            return wrong(c, "mesh", i, "has no primitives");
        for (size_t k = 0; k < json_array_size(list); k++) {
            if (!json_is_object(json_array_get(list, k)))
                return wrong(c, "mesh", i, "a primitive is no mapping");
            lr_status status = check_primitive(c, i, json_array_get(list, k));
            if (status)
                return status;
        }
    }
    return LR_OK;
}

/* Each node has at most one parent, as the format wants, and no node is below itself: from each,
 * the way up ends after fewer steps than there are nodes. */
static lr_status check_tree(check *c, uint32_t *parents)
{
    size_t count = json_array_size(c->nodes);
    for (size_t i = 0; i < count; i++) {
        const json_t *node = json_array_get(c->nodes, i);
        const json_t *children = json_object_get(node, "children");
        uint64_t mesh;
        if (!json_is_object(node) || !whole(node, "mesh", 0, &mesh) ||
            (json_object_get(node, "mesh") && mesh >= json_array_size(c->meshes)))
            return wrong(c, "node", i, "names a mesh that there is not");
        for (size_t k = 0; k < json_array_size(children); k++) {
            const json_t *child = json_array_get(children, k);
            json_int_t index = json_is_integer(child) ? json_integer_value(child) : -1;
            if (index < 0 || (uint64_t)index >= count)
                return wrong(c, "node", i, "names a child that there is not");
            if (parents[index] != LR_NONE)
                return wrong(c, "node", (size_t)index, "is the child of two nodes");
            parents[index] = (uint32_t)i;
        }
    }
    for (size_t i = 0; i < count; i++) {
        uint32_t depth = 0;
        for (uint32_t at = parents[i]; at != LR_NONE; at = parents[at])
            if (++depth > LR_IMPORT_DEPTH_MAX)
                return lr_fail(c->import->error, LR_ERROR_FILE,
                               "%s: node %zu: is below itself, or nodes nest more than %d deep",
                               c->import->shown, i, LR_IMPORT_DEPTH_MAX);
    }
    return LR_OK;
}

static lr_status check_nodes(check *c)
{
    size_t count = json_array_size(c->nodes);
    if (count > LR_IMPORT_NODES_MAX)
        return lr_fail(c->import->error, LR_ERROR_FILE, "%s: more than %u nodes", c->import->shown,
                       LR_IMPORT_NODES_MAX);
    uint32_t *parents = malloc((count + 1) * sizeof *parents);
    if (!parents)
        return lr_import_no_memory(c->import);
    memset(parents, 0xFF, count * sizeof *parents);
    lr_status status = check_tree(c, parents);
    free(parents);
    return status;
}

/* The scene that is shown exists and names nodes that exist. */
static lr_status check_scene(check *c)
{
    const json_t *json = c->import->json;
    uint64_t index;
    const json_t *scenes = json_object_get(json, "scenes");
    if (!whole(json, "scene", 0, &index) || index >= json_array_size(scenes))
        return lr_fail(c->import->error, LR_ERROR_FILE, "%s: has no scene to show",
                       c->import->shown);
    const json_t *roots = json_object_get(json_array_get(scenes, (size_t)index), "nodes");
    for (size_t i = 0; i < json_array_size(roots); i++) {
        const json_t *root = json_array_get(roots, i);
        if (!json_is_integer(root) || json_integer_value(root) < 0 ||
            (uint64_t)json_integer_value(root) >= json_array_size(c->nodes))
            return wrong(c, "scene", (size_t)index, "names a node that there is not");
    }
    return LR_OK;
}

lr_status lr_gltf_check(lr_import *import, uint64_t bin_size)
{
    const json_t *json = import->json;
    check c = {
        .import = import,
        .bin_size = bin_size,
        .buffers = json_object_get(json, "buffers"),
        .views = json_object_get(json, "bufferViews"),
        .accessors = json_object_get(json, "accessors"),
        .meshes = json_object_get(json, "meshes"),
        .nodes = json_object_get(json, "nodes"),
    };
    lr_status status = check_extensions(&c);
    if (!status)
        status = check_buffers(&c);
    if (!status)
        status = check_views(&c);
    if (!status)
        status = check_meshes(&c);
    if (!status)
        status = check_nodes(&c);
    if (!status)
        status = check_scene(&c);
    return status;
}
