/* Whatever assimp may return, so far as its pointers lead to what its counts say, must become a
 * scene whose arrays keep the promises of scene.h, or one message. The bytes are read as a recipe
 * for such a structure. */
#include "imported_scene.h"

#include <assimp/material.h>
#include <assimp/scene.h>
#include <stdio.h>
#include <string.h>

#include "scene/import_internal.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { MESHES = 4, MATERIALS = 3, TEXTURES = 2, NODES = 12, PROPERTIES = 8, MANY_CORNERS = 10050 };

static const char json_text[] =
    "{\"materials\": [{\"pbrMetallicRoughness\": {\"baseColorFactor\": [1, 0.5, -1, 0.5],"
    "\"baseColorTexture\": {\"index\": 0}, \"metallicFactor\": 1e300}, \"alphaMode\": \"BLEND\","
    "\"extensions\": {\"KHR_materials_transmission\": {\"transmissionFactor\": 1}}},"
    "{\"alphaMode\": \"MASK\", \"emissiveFactor\": [1, 1, 1]}, 7]}";

/* ---- The recipe ---------------------------------------------------------------------------- */

typedef struct recipe {
    const uint8_t *at, *end;
    void *blocks[4096]; /* all that the structure points to */
    uint32_t block_count;
} recipe;

/* 0 when the recipe is at its end. */
static uint32_t take(recipe *r)
{
    return r->at < r->end ? *r->at++ : 0;
}

static uint32_t take_word(recipe *r)
{
    uint32_t word = take(r);
    for (int i = 1; i < 4; i++)
        word |= take(r) << 8 * i;
    return word;
}

/* Zeroed, freed with the recipe; NULL for nothing and when there is enough. */
static void *keep(recipe *r, size_t count, size_t size)
{
    if (count == 0 || r->block_count == sizeof r->blocks / sizeof *r->blocks)
        return NULL;
    return r->blocks[r->block_count++] = calloc(count, size);
}

static float take_float(recipe *r)
{
    static const float odd[] = {0, -0.0f, 1, -1, 0.5f, 1e12f, 2e12f, 1e-30f, 3e38f, INFINITY, NAN};
    uint32_t choice = take(r), bits;
    if (choice < 200)
        return (float)(choice % 16) - 4;
    if (choice < 240)
        return odd[choice % (sizeof odd / sizeof *odd)];
    bits = take_word(r);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Mostly below `count`. */
static uint32_t take_index(recipe *r, uint32_t count)
{
    uint32_t choice = take(r);
    return choice < 250 && count ? choice % count : choice < 253 ? count : take_word(r);
}

static void take_floats(recipe *r, void *out, size_t count)
{
    for (size_t i = 0; out && i < count; i++)
        ((float *)out)[i] = take_float(r);
}

static void take_name(recipe *r, struct aiString *name)
{
    name->length = take(r) % 16;
    for (uint32_t i = 0; i < name->length; i++)
        name->data[i] = (char)(take(r) | 1); /* no NUL */
}

/* ---- The structure ------------------------------------------------------------------------- */

static void make_face(recipe *r, struct aiFace *face, uint32_t vertex_count)
{
    uint32_t kind = take(r), corners = kind < 200 ? 3 : kind % 8;
    if (kind == 255) { /* a count, and nothing there */
        face->mNumIndices = take_word(r);
        return;
    }
    if (kind == 254)
        corners = MANY_CORNERS - 100 + take(r);
    face->mIndices = keep(r, corners, sizeof *face->mIndices);
    face->mNumIndices = face->mIndices ? corners : 0;
    for (uint32_t i = 0; i < face->mNumIndices; i++)
        face->mIndices[i] = corners > 8 ? i % (vertex_count + 1) : take_index(r, vertex_count);
}

static struct aiMesh *make_mesh(recipe *r)
{
    struct aiMesh *mesh = keep(r, 1, sizeof *mesh);
    uint32_t has = take(r), count = take(r) % 64;
    if (!mesh || has == 255)
        return NULL;
    take_name(r, &mesh->mName);
    mesh->mPrimitiveTypes = take(r);
    mesh->mMaterialIndex = take_index(r, MATERIALS);
    mesh->mNumVertices = has == 254 ? UINT32_MAX : count;
    mesh->mVertices = has & 1 ? NULL : keep(r, count, sizeof *mesh->mVertices);
    if (has == 254)
        mesh->mVertices = NULL;
    take_floats(r, mesh->mVertices, 3 * count);
    mesh->mNormals = has & 2 ? keep(r, count, sizeof *mesh->mNormals) : NULL;
    take_floats(r, mesh->mNormals, 3 * count);
    for (uint32_t i = 0; i < 2; i++) {
        mesh->mTextureCoords[i] = has & 4 << i ? keep(r, count, sizeof *mesh->mVertices) : NULL;
        take_floats(r, mesh->mTextureCoords[i], 3 * count);
        mesh->mNumUVComponents[i] = take(r) % 5;
        mesh->mColors[i] = has & 16 << i ? keep(r, count, sizeof **mesh->mColors) : NULL;
        take_floats(r, mesh->mColors[i], 4 * count);
    }
    mesh->mNumFaces = take(r) % 64;
    mesh->mFaces = keep(r, mesh->mNumFaces, sizeof *mesh->mFaces);
    for (uint32_t i = 0; mesh->mFaces && i < mesh->mNumFaces; i++)
        make_face(r, &mesh->mFaces[i], count);
    return mesh;
}

/* Texts as assimp stores them: a length of 32 bits, the text and a NUL. */
static void make_value(recipe *r, struct aiMaterialProperty *p)
{
    static const char *const texts[] = {"*0",    "*1",       "*",           "*99999999999999999999",
                                        "a.png", "../a.png", "/etc/passwd", "a%20b\\c.png",
                                        "1 2 3"};
    uint32_t kind = take(r) % 4;
    if (kind == 0) {
        const char *text = texts[take(r) % (sizeof texts / sizeof *texts)];
        uint32_t length = (uint32_t)strlen(text);
        p->mType = aiPTI_String;
        p->mData = keep(r, 5 + length, 1);
        if (p->mData)
            memcpy(p->mData, &length, 4);
        if (p->mData)
            memcpy(p->mData + 4, text, length);
        p->mDataLength = 5 + length;
        return;
    }
    static const enum aiPropertyTypeInfo types[] = {aiPTI_Float, aiPTI_Integer, aiPTI_Buffer};
    uint32_t words = 1 + take(r) % 5;
    p->mType = types[kind - 1];
    p->mData = keep(r, words, 4);
    p->mDataLength = 4 * words;
    for (uint32_t i = 0; p->mData && i < words; i++) {
        uint32_t word = p->mType == aiPTI_Float ? 0 : take_index(r, 12);
        float value = take_float(r);
        if (p->mType == aiPTI_Float)
            memcpy(&word, &value, sizeof word);
        memcpy(p->mData + 4 * i, &word, sizeof word);
    }
}

static struct aiMaterial *make_material(recipe *r)
{
    static const char *const keys[] = {
        "?mat.name",    "$clr.diffuse",  "$clr.specular",  "$clr.emissive", "$clr.transparent",
        "$mat.opacity", "$mat.refracti", "$mat.shininess", "$mat.illum",    "$tex.file",
        "$tex.uvwsrc",  "$tex.mapmodeu", "$tex.mapmodev",  "$tex.uvtrafo",  "$tex.mapping"};
    struct aiMaterial *material = keep(r, 1, sizeof *material);
    uint32_t count = take(r) % PROPERTIES;
    if (!material)
        return NULL;
    material->mProperties = keep(r, PROPERTIES, sizeof *material->mProperties);
    for (uint32_t i = 0; material->mProperties && i < count; i++) {
        struct aiMaterialProperty *p = keep(r, 1, sizeof *p);
        if (!p)
            break;
        const char *key = keys[take(r) % (sizeof keys / sizeof *keys)];
        memcpy(p->mKey.data, key, strlen(key));
        p->mKey.length = (ai_uint32)strlen(key);
        p->mSemantic = strncmp(key, "$tex", 4) ? 0 : take(r) % (aiTextureType_BASE_COLOR + 1);
        make_value(r, p);
        if (p->mData)
            material->mProperties[material->mNumProperties++] = p;
    }
    return material;
}

static struct aiTexture *make_texture(recipe *r)
{
    static const char picture[] = "P6 1 1 255 abc";
    struct aiTexture *texture = keep(r, 1, sizeof *texture);
    uint32_t kind = take(r);
    if (!texture || kind == 255)
        return NULL;
    texture->mHeight = kind % 3 == 1;
    texture->mWidth = kind % 3 == 2 ? 0 : sizeof picture;
    texture->pcData = kind > 200 ? NULL : keep(r, sizeof picture, sizeof *texture->pcData);
    if (texture->pcData)
        memcpy(texture->pcData, picture, sizeof picture);
    return texture;
}

/* Some below themselves or below several. */
static void make_nodes(recipe *r, struct aiNode *nodes[NODES])
{
    for (uint32_t i = 0; i < NODES; i++)
        if (!(nodes[i] = keep(r, 1, sizeof **nodes)))
            return;
    for (uint32_t i = 0; i < NODES; i++) {
        struct aiNode *node = nodes[i];
        uint32_t odd = take(r);
        take_name(r, &node->mName);
        node->mTransformation.a1 = node->mTransformation.b2 = 1;
        node->mTransformation.c3 = node->mTransformation.d4 = 1;
        if (odd & 1)
            take_floats(r, &node->mTransformation, odd & 2 ? 16 : 12);
        node->mNumMeshes = take(r) % 4;
        node->mMeshes = odd & 4 ? NULL : keep(r, node->mNumMeshes, sizeof *node->mMeshes);
        for (uint32_t k = 0; node->mMeshes && k < node->mNumMeshes; k++)
            node->mMeshes[k] = take_index(r, MESHES);
        node->mNumChildren = take(r) % 4;
        node->mChildren = odd & 8 ? NULL : keep(r, node->mNumChildren, sizeof *node->mChildren);
        for (uint32_t k = 0; node->mChildren && k < node->mNumChildren; k++) {
            uint32_t child = odd & 16 ? take(r) % NODES : i + 1 + k;
            node->mChildren[k] = child < NODES ? nodes[child] : NULL;
        }
    }
}

static void make_scene(recipe *r, struct aiScene *scene)
{
    struct aiNode *nodes[NODES] = {NULL};
    uint32_t odd = take(r);
    make_nodes(r, nodes);
    scene->mRootNode = nodes[0];
    scene->mNumMeshes = MESHES;
    scene->mMeshes = odd == 255 ? NULL : keep(r, MESHES, sizeof *scene->mMeshes);
    for (uint32_t i = 0; scene->mMeshes && i < MESHES; i++)
        scene->mMeshes[i] = make_mesh(r);
    scene->mNumMaterials = MATERIALS;
    scene->mMaterials = odd == 254 ? NULL : keep(r, MATERIALS, sizeof *scene->mMaterials);
    for (uint32_t i = 0; scene->mMaterials && i < MATERIALS; i++)
        scene->mMaterials[i] = take(r) > 250 ? NULL : make_material(r);
    scene->mNumTextures = TEXTURES;
    scene->mTextures = odd == 253 ? NULL : keep(r, TEXTURES, sizeof *scene->mTextures);
    for (uint32_t i = 0; scene->mTextures && i < TEXTURES; i++)
        scene->mTextures[i] = make_texture(r);
}

/* ---- The import ---------------------------------------------------------------------------- */

static void import_made(const struct aiScene *made, lr_import_kind kind)
{
    lr_error error = {0};
    lr_scene_builder builder = {.scene = calloc(1, sizeof(lr_scene))};
    lr_import import = {.builder = &builder,
                        .options = {.max_memory = 64 << 20, .max_triangles = 100000},
                        .kind = kind,
                        .base_file = "/nowhere/model",
                        .name = "model",
                        .shown = "model",
                        .scene = made,
                        .world = lr_bounds_empty(),
                        .error = &error};
    expect(builder.scene);
    if (kind == LR_IMPORT_GLTF)
        import.json = json_loads(json_text, 0, NULL);
    lr_status status = lr_import_convert(&import);
    if (!status)
        status = lr_import_surroundings(&import);
    expect(status == LR_OK || error.message[0]);
    if (status == LR_OK)
        check_scene(builder.scene);
    json_decref(import.json);
    free(import.meshes);
    free(import.bounds);
    free(import.materials);
    lr_scene_destroy(builder.scene);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    recipe r = {.at = data, .end = data + size};
    struct aiScene scene = {0};
    lr_import_kind kind = (lr_import_kind)(take(&r) % (LR_IMPORT_STL + 1));
    make_scene(&r, &scene);
    if (scene.mRootNode) /* assimp returns none without */
        import_made(&scene, kind);
    for (uint32_t i = 0; i < r.block_count; i++)
        free(r.blocks[i]);
    return 0;
}
