/* PLY ("The PLY Polygon File Format", Turk, 1994), text and binary, as the scene that assimp would
 * return: its own reader reads and writes beside its memory when a file is not as it should be. */
#define _GNU_SOURCE /* strtod_l */
#include "scene/import_ply.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* What lr_ply_parse allocates; the scene points into it. */
struct lr_ply {
    struct aiScene scene;
    struct aiMesh mesh, *meshes[1];
    struct aiNode node;
    unsigned node_mesh;
    uint32_t *indices;
    uint32_t index_count, index_capacity;
};

static const uint32_t type_sizes[TYPES] = {1, 1, 2, 2, 4, 4, 4, 8};

static lr_status row_error(reader *r, const char *what)
{
    return lr_fail(r->import->error, LR_ERROR_FILE, "%s: %s %llu: %s", r->import->shown, r->what,
                   (unsigned long long)r->row, what);
}

/* ---- Numbers ------------------------------------------------------------------------------- */

/* Whole numbers of up to 15 digits, which most of the file is; 0 for what is none of these, and the
 * length of their text otherwise. */
static size_t read_digits(const char *text, double *value)
{
    uint64_t number = 0;
    size_t used = 0;
    for (; text[used] >= '0' && text[used] <= '9' && used < 15; used++)
        number = 10 * number + (uint64_t)(text[used] - '0');
    *value = (double)number;
    return text[used] && strchr(" \r\n", text[used]) ? used : 0;
}

static lr_status read_text_number(reader *r, double *value)
{
    const char *start = r->import->bytes + r->at;
    start += *start == ' ' || *start == '\n';
    size_t digits = read_digits(start, value);
    char *end = (char *)start + digits;
    /* The file ends with a NUL, at which this stops. */
    if (digits == 0)
        *value = strtod_l(start, &end, r->locale);
    if (end == start || (*end && !isspace((unsigned char)*end)))
        return row_error(r, "is no number, or the file is cut short");
    r->at = (size_t)(end - r->import->bytes);
    return LR_OK;
}

static inline uint64_t load_bytes(const unsigned char *b, uint32_t size, bool big)
{
    uint16_t two;
    uint32_t four;
    uint64_t eight;
    bool swap = big != (__BYTE_ORDER__ == __ORDER_BIG_ENDIAN__);
    switch (size) {
    case 1:
        return *b;
    case 2:
        memcpy(&two, b, sizeof two);
        return swap ? __builtin_bswap16(two) : two;
    case 4:
        memcpy(&four, b, sizeof four);
        return swap ? __builtin_bswap32(four) : four;
    default:
        memcpy(&eight, b, sizeof eight);
        return swap ? __builtin_bswap64(eight) : eight;
    }
}

static lr_status read_binary_number(reader *r, ply_type type, double *value)
{
    uint32_t size = type_sizes[type];
    if (r->import->size - r->at < size)
        return row_error(r, "the file is cut short here");
    const unsigned char *b = (const unsigned char *)r->import->bytes + r->at;
    r->at += size;
    uint64_t bits = load_bytes(b, size, r->format == BIG);
    uint32_t low = (uint32_t)bits;
    float single;
    switch (type) {
    case FLOAT32:
        memcpy(&single, &low, sizeof single);
        *value = (double)single;
        break;
    case FLOAT64:
        memcpy(value, &bits, sizeof *value);
        break;
    case INT8:
        *value = (int8_t)bits;
        break;
    case INT16:
        *value = (int16_t)bits;
        break;
    case INT32:
        *value = (int32_t)bits;
        break;
    default:
        *value = low;
        break;
    }
    return LR_OK;
}

static lr_status read_number(reader *r, ply_type type, double *value)
{
    return r->format == TEXT ? read_text_number(r, value) : read_binary_number(r, type, value);
}

/* ---- Elements ------------------------------------------------------------------------------ */

/* Room for `more` corners. */
static bool reserve_corners(struct lr_ply *ply, uint64_t more)
{
    uint64_t wanted = ply->index_count + more;
    if (wanted <= ply->index_capacity)
        return true;
    if (wanted < 2 * (uint64_t)ply->index_capacity)
        wanted = 2 * (uint64_t)ply->index_capacity;
    if (wanted > UINT32_MAX)
        return false;
    uint32_t *grown = realloc(ply->indices, wanted * sizeof *grown);
    if (!grown)
        return false;
    ply->indices = grown;
    ply->index_capacity = (uint32_t)wanted;
    return true;
}

/* A corner that is no index of a vertex becomes UINT32_MAX, which no vertex has. */
static uint32_t corner_of(double value)
{
    return value >= 0 && value < (double)UINT32_MAX ? (uint32_t)value : UINT32_MAX;
}

/* As many corners as a list promises, where its numbers have 4 bytes and are there. */
static bool read_whole_corners(reader *r, const property *p, uint32_t *out, uint64_t count)
{
    const unsigned char *b = (const unsigned char *)r->import->bytes + r->at;
    bool is_signed = p->type == INT32;
    if (r->format == TEXT || (!is_signed && p->type != UINT32) ||
        count > (r->import->size - r->at) / 4)
        return false;
    for (uint64_t i = 0; i < count; i++) {
        uint32_t value = (uint32_t)load_bytes(b + 4 * i, 4, r->format == BIG);
        out[i] = is_signed && value > INT32_MAX ? UINT32_MAX : value;
    }
    r->at += 4 * count;
    return true;
}

static lr_status read_corners(reader *r, const property *p, struct aiFace *face, uint64_t count)
{
    struct lr_ply *ply = r->ply;
    if (!reserve_corners(ply, count))
        return lr_import_no_memory(r->import);
    uint32_t *out = &ply->indices[ply->index_count];
    lr_status status = LR_OK;
    if (!read_whole_corners(r, p, out, count))
        for (uint64_t i = 0; !status && i < count; i++) {
            double value;
            status = read_number(r, p->type, &value);
            if (!status)
                out[i] = corner_of(value);
        }
    ply->index_count += (uint32_t)count;
    face->mNumIndices += (unsigned)count;
    return status;
}

static lr_status read_list(reader *r, const property *p, struct aiFace *face)
{
    double length, value;
    lr_status status = read_number(r, p->count_type, &length);
    if (!status && !(length >= 0 && length <= (double)(r->import->size - r->at)))
        status = row_error(r, "a list that is longer than the file");
    if (!status && face && p->is_corners)
        return read_corners(r, p, face, (uint64_t)length);
    for (uint64_t i = 0; !status && i < (uint64_t)length; i++)
        status = read_number(r, p->type, &value);
    return status;
}

/* Integers stand for 0 to 1. */
static double color_scale(ply_type type)
{
    return type == UINT8 ? 1 / 255.0 : type == UINT16 ? 1 / 65535.0 : 1;
}

static lr_status read_row(reader *r, const element *e, double values[SLOTS + 1],
                          struct aiFace *face)
{
    lr_status status = LR_OK;
    for (uint32_t i = 0; !status && i < e->property_count; i++) {
        const property *p = &e->properties[i];
        double value;
        if (p->is_list) {
            status = read_list(r, p, face);
            continue;
        }
        status = read_number(r, p->type, &value);
        bool color = p->slot >= RED && p->slot <= BLUE;
        if (!status)
            values[p->slot] = color ? value * color_scale(p->type) : value;
    }
    return status;
}

static void store_vertex(struct aiMesh *mesh, uint64_t i, const double v[SLOTS + 1])
{
    mesh->mVertices[i] = (struct aiVector3D){(float)v[X], (float)v[Y], (float)v[Z]};
    if (mesh->mNormals)
        mesh->mNormals[i] = (struct aiVector3D){(float)v[NX], (float)v[NY], (float)v[NZ]};
    if (mesh->mTextureCoords[0])
        mesh->mTextureCoords[0][i] = (struct aiVector3D){(float)v[U], (float)v[V], 0};
    if (mesh->mColors[0])
        mesh->mColors[0][i] = (struct aiColor4D){(float)v[RED], (float)v[GREEN], (float)v[BLUE], 1};
}

/* Room for the rows, of which each takes at least one byte a property. */
static lr_status prepare(reader *r, const element *e, bool vertices, bool faces)
{
    struct aiMesh *mesh = &r->ply->mesh;
    lr_import *import = r->import;
    size_t count = (size_t)e->count;
    uint64_t least = 0;
    for (uint32_t i = 0; i < e->property_count; i++) {
        const property *p = &e->properties[i];
        least += r->format == TEXT ? 2 : type_sizes[p->is_list ? p->count_type : p->type];
    }
    if (least == 0 || e->count > (import->size - r->at + 1) / least || e->count >= UINT32_MAX)
        return lr_fail(import->error, LR_ERROR_FILE,
                       "%s: its header says %llu of %s, the file is too short for them",
                       import->shown, (unsigned long long)e->count, r->what);
    if (faces && e->count > import->options.max_triangles)
        return lr_fail(import->error, LR_ERROR_FILE,
                       "%s: has %llu faces, more than %llu triangles; allow more with "
                       "--max-triangles",
                       import->shown, (unsigned long long)e->count,
                       (unsigned long long)import->options.max_triangles);
    lr_status status = lr_import_charge(import, e->count * (vertices ? 52 : faces ? 36 : 0), "it");
    if (status)
        return status;
    bool good = true;
    if (vertices) {
        mesh->mNumVertices = (unsigned)count;
        good = (mesh->mVertices = lr_alloc_large(count, sizeof *mesh->mVertices)) != NULL;
        if (r->has[NX] && r->has[NY] && r->has[NZ])
            good &= (mesh->mNormals = lr_alloc_large(count, sizeof *mesh->mNormals)) != NULL;
        if (r->has[U] && r->has[V])
            good &= (mesh->mTextureCoords[0] = lr_alloc_large(count, sizeof(struct aiVector3D))) !=
                    NULL;
        if (r->has[RED] && r->has[GREEN] && r->has[BLUE])
            good &= (mesh->mColors[0] = lr_alloc_large(count, sizeof(struct aiColor4D))) != NULL;
        mesh->mNumUVComponents[0] = 2;
    }
    if (faces) {
        mesh->mNumFaces = (unsigned)count;
        good = (mesh->mFaces = lr_alloc_large(count, sizeof *mesh->mFaces)) != NULL;
        /* Most faces are triangles. */
        if (good && count <= UINT32_MAX / 3 &&
            (r->ply->indices = lr_alloc_large(3 * count, sizeof *r->ply->indices)))
            r->ply->index_capacity = 3 * (uint32_t)count;
    }
    return good ? LR_OK : lr_import_no_memory(import);
}

static lr_status read_rows(reader *r, const element *e)
{
    struct aiMesh *mesh = &r->ply->mesh;
    bool vertices = strcmp(e->name, "vertex") == 0 && !mesh->mVertices;
    bool faces = strcmp(e->name, "face") == 0 && !mesh->mFaces;
    char what[40];
    r->what = lr_import_shown(what, sizeof what, e->name);
    lr_status status = e->count ? prepare(r, e, vertices, faces) : LR_OK;
    for (r->row = 0; !status && r->row < e->count; r->row++) {
        double values[SLOTS + 1] = {0};
        struct aiFace *face = faces ? &mesh->mFaces[r->row] : NULL;
        if (face)
            *face = (struct aiFace){0};
        status = read_row(r, e, values, face);
        if (!status && vertices)
            store_vertex(mesh, r->row, values);
        if (!status && r->row % 65536 == 65535)
            status =
                lr_import_progress(r->import, 0.1 + 0.5 * (double)r->at / (double)r->import->size);
    }
    return status;
}

static void make_scene(struct lr_ply *ply)
{
    uint32_t *indices = ply->indices;
    for (uint32_t i = 0; indices && i < ply->mesh.mNumFaces; i++) {
        ply->mesh.mFaces[i].mIndices = indices;
        indices += ply->mesh.mFaces[i].mNumIndices;
    }
    ply->meshes[0] = &ply->mesh;
    ply->node.mTransformation.a1 = ply->node.mTransformation.b2 = 1;
    ply->node.mTransformation.c3 = ply->node.mTransformation.d4 = 1;
    ply->node.mMeshes = &ply->node_mesh;
    ply->node.mNumMeshes = 1;
    ply->scene.mRootNode = &ply->node;
    ply->scene.mMeshes = ply->meshes;
    ply->scene.mNumMeshes = 1;
}

lr_status lr_ply_parse(lr_import *import)
{
    reader *r = lr_alloc(1, sizeof *r);
    lr_status status = LR_ERROR_MEMORY;
    import->ply = lr_alloc(1, sizeof *import->ply);
    if (r)
        r->locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (!r || !import->ply || !r->locale) {
        lr_import_no_memory(import);
        goto done;
    }
    r->import = import;
    r->ply = import->ply;
    status = lr_ply_read_header(r);
    for (uint32_t i = 0; !status && i < r->element_count; i++)
        status = read_rows(r, &r->elements[i]);
    if (!status) {
        make_scene(import->ply);
        import->scene = &import->ply->scene;
    }
done:
    if (r && r->locale)
        freelocale(r->locale);
    free(r);
    return status;
}

void lr_ply_free(struct lr_ply *ply)
{
    if (!ply)
        return;
    free(ply->mesh.mVertices);
    free(ply->mesh.mNormals);
    free(ply->mesh.mTextureCoords[0]);
    free(ply->mesh.mColors[0]);
    free(ply->mesh.mFaces);
    free(ply->indices);
    free(ply);
}
