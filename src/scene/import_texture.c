/* Textures of materials; those that nothing shows are noted. */
#include "scene/import_internal.h"

#include <assimp/material.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/texture.h"

/* By aiGetMaterialTexture, other properties of the texture could overflow what it reads them into.
 */
static bool has_texture(const struct aiMaterial *from, enum aiTextureType type,
                        struct aiString *path)
{
    return aiGetMaterialString(from, AI_MATKEY_TEXTURE(type, 0), path) == aiReturn_SUCCESS;
}

/* The one of assimp's types that the format uses for the colour. */
static bool find_color_texture(const struct aiMaterial *from, enum aiTextureType *type,
                               struct aiString *path)
{
    static const enum aiTextureType types[] = {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE};
    for (size_t i = 0; i < sizeof types / sizeof *types; i++) {
        *type = types[i];
        if (has_texture(from, *type, path) && path->data[0])
            return true;
    }
    return false;
}

static int integer_of(const struct aiMaterial *from, const char *key, enum aiTextureType type,
                      int fallback)
{
    int value = fallback;
    unsigned count = 1;
    if (!lr_import_has_numbers(from, key, type) ||
        aiGetMaterialIntegerArray(from, key, type, 0, &value, &count) != aiReturn_SUCCESS)
        value = fallback;
    return value;
}

static lr_wrap wrap_of(const struct aiMaterial *from, const char *key, enum aiTextureType type)
{
    switch (integer_of(from, key, type, aiTextureMapMode_Wrap)) {
    case aiTextureMapMode_Clamp:
    case aiTextureMapMode_Decal:
        return LR_WRAP_CLAMP;
    case aiTextureMapMode_Mirror:
        return LR_WRAP_MIRROR;
    default:
        return LR_WRAP_REPEAT;
    }
}

/* The picture inside of the file that the path "*3" or a name stands for; NULL when it is none. */
static const struct aiTexture *embedded(const struct aiScene *scene, const char *path)
{
    if (path[0] != '*')
        return NULL;
    char *end;
    unsigned long index = strtoul(path + 1, &end, 10);
    return *end == 0 && end != path + 1 && index < scene->mNumTextures && scene->mTextures
               ? scene->mTextures[index]
               : NULL;
}

static lr_status load(lr_import *import, const char *path, lr_wrap wrap_u, lr_wrap wrap_v,
                      lr_texels texels, uint32_t *texture, lr_error *error)
{
    if (path[0] == '*') {
        const struct aiTexture *inside = embedded(import->scene, path);
        /* Without a height it is a compressed file of mWidth bytes. */
        if (!inside || inside->mHeight != 0 || inside->mWidth == 0 || !inside->pcData)
            return lr_fail(error, LR_ERROR_FILE, "its picture is not in the file");
        char name[200];
        snprintf(name, sizeof name, "%s: picture %.20s", import->shown, path + 1);
        return lr_texture_decode(import->builder, inside->pcData, inside->mWidth, name, wrap_u,
                                 wrap_v, texels, texture, error);
    }
    char *file;
    lr_status status = lr_import_resolve(import, path, &file, error);
    if (!status)
        status = lr_texture_load(import->builder, file, wrap_u, wrap_v, texels, texture, error);
    free(file);
    return status;
}

/* What a material has and is not shown. */
static lr_status note_others(lr_import *import, const struct aiMaterial *from,
                             const lr_material *material)
{
    const lr_map *maps = material->maps;
    bool normals = maps[LR_MAP_NORMAL].given, heights = maps[LR_MAP_BUMP].given || normals;
    bool light = maps[LR_MAP_EMISSION].given;
    const struct {
        enum aiTextureType type;
        bool shown;
        const char *what;
    } others[] = {
        {aiTextureType_NORMALS, normals, "normal map"},
        {aiTextureType_HEIGHT, heights, "bump map"},
        {aiTextureType_SPECULAR, false, "specular map"},
        {aiTextureType_OPACITY, false, "opacity map"},
        {aiTextureType_EMISSIVE, light, "emissive map"},
        {aiTextureType_REFLECTION, false, "reflection map"},
        {aiTextureType_LIGHTMAP, false, "occlusion map"},
        {aiTextureType_SHININESS, false, "shininess map"},
        {aiTextureType_DISPLACEMENT, false, "displacement map"},
    };
    char list[200] = "";
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        struct aiString path;
        if (others[i].shown || !has_texture(from, others[i].type, &path))
            continue;
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s", used ? ", " : "", others[i].what);
    }
    return list[0] ? lr_import_note(import, "material \"%s\": not shown: %s", material->name, list)
                   : LR_OK;
}

/* Loads a material's texture of one type; *texture stays LR_NONE, after a note, when it cannot be
 * shown. `what` stands for it in notes. */
static lr_status load_type(lr_import *import, const struct aiMaterial *from,
                           enum aiTextureType type, const char *name, const char *what,
                           lr_texels texels, uint32_t *texture)
{
    struct aiString path;
    *texture = LR_NONE;
    if (!has_texture(from, type, &path) || !path.data[0])
        return LR_OK;
    if (integer_of(from, _AI_MATKEY_UVWSRC_BASE, type, 0) != 0)
        return lr_import_note(import,
                              "material \"%s\": its %s is not shown: it goes by another set "
                              "of texture coordinates than the first",
                              name, what);
    struct aiUVTransform moved;
    lr_status status = LR_OK;
    if (lr_import_has_numbers(from, _AI_MATKEY_UVTRANSFORM_BASE, type) &&
        aiGetMaterialUVTransform(from, AI_MATKEY_UVTRANSFORM(type, 0), &moved) == aiReturn_SUCCESS)
        status = lr_import_note(import,
                                "material \"%s\": the shift, turn and scale of its %s are "
                                "left out",
                                name, what);
    lr_wrap wrap_u = wrap_of(from, _AI_MATKEY_MAPPINGMODE_U_BASE, type);
    lr_wrap wrap_v = wrap_of(from, _AI_MATKEY_MAPPINGMODE_V_BASE, type);
    lr_error error = {0};
    uint32_t loaded_to;
    lr_status loaded =
        status ? status : load(import, path.data, wrap_u, wrap_v, texels, &loaded_to, &error);
    if (loaded == LR_OK) {
        *texture = loaded_to;
        return LR_OK;
    }
    if (status || loaded == LR_ERROR_MEMORY)
        return status ? status : lr_fail(import->error, loaded, "%s", error.message);
    char reason[300];
    lr_import_shown(reason, sizeof reason, error.message);
    return lr_import_note(import, "material \"%s\": without its %s: %s", name, what, reason);
}

lr_status lr_import_map(lr_import *import, const struct aiMaterial *from, unsigned type,
                        const char *what, lr_map_kind kind, lr_map map, lr_material *material)
{
    lr_status status = load_type(import, from, (enum aiTextureType)type, material->name, what,
                                 lr_map_texels(kind), &map.texture);
    map.given = map.texture != LR_NONE;
    if (!status && map.given)
        material->maps[kind] = map;
    return status;
}

bool lr_import_is_colored(const lr_import *import, uint32_t texture)
{
    const lr_texture *t = &import->builder->scene->textures[texture];
    bool colored = false;
    for (size_t i = 0; i < (size_t)t->width * t->height && !colored; i++)
        colored = t->bytes ? t->bytes[4 * i] != t->bytes[4 * i + 1] ||
                                 t->bytes[4 * i] != t->bytes[4 * i + 2]
                           : t->floats[3 * i] != t->floats[3 * i + 1] ||
                                 t->floats[3 * i] != t->floats[3 * i + 2];
    return colored;
}

lr_status lr_import_texture(lr_import *import, const struct aiMaterial *from, lr_material *material)
{
    enum aiTextureType type;
    struct aiString path;
    uint32_t texture;
    lr_status status = note_others(import, from, material);
    if (status || !find_color_texture(from, &type, &path))
        return status;
    status = load_type(import, from, type, material->name, "texture", LR_TEXELS_COLORS, &texture);
    if (!status && texture != LR_NONE) {
        material->color.kind = LR_PATTERN_IMAGE;
        material->color.texture = texture;
    }
    return status;
}
