/* One mesh of assimp's as one of ours: checked, cut into triangles, equal corners joined. */
#include "scene/import_internal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "scene/color.h"
#include "scene/polygon.h"
#include "scene/rows.h"

_Static_assert(sizeof(struct aiVector3D) == 3 * sizeof(float), "assimp with float coordinates");

#define UV_MAX 1e6 /* further out, a float no longer says where in the texture it is */

/* All that can belong to the corner of a triangle: position, normal, texture coordinates, colour.
 * What the mesh does not have is left out. -0 is written as 0, so that equal ones have equal bytes.
 */
enum { CORNER_FLOATS = 3 + 3 + 2 + 3 };

typedef struct counts {
    uint32_t lines, large, crossing, bad_index, bad_position, no_area, bad_normal, bad_uv;
    uint32_t first_bad_index, first_bad_position; /* faces */
} counts;

typedef struct builder {
    lr_import *import;
    const struct aiMesh *from;
    const char *label; /* the mesh in messages */
    bool normals, uvs, colors;
    counts counts;
    uint32_t *triangles; /* indices of assimp's vertices, later of corners */
    uint32_t triangle_count;
    lr_polygon *polygon; /* working memory */
    uint32_t *first;     /* of each vertex, the first one at its position */
    lr_rows corners;     /* of floats, each row once */
} builder;

/* ---- Triangles ----------------------------------------------------------------------------- */

static lr_vec3 position_of(const struct aiMesh *mesh, uint32_t vertex)
{
    const struct aiVector3D *p = &mesh->mVertices[vertex];
    return (lr_vec3){(double)p->x, (double)p->y, (double)p->z};
}

static bool in_range(double value, double limit)
{
    return fabs(value) <= limit; /* false for NaN */
}

/* Sorts faces that cannot be shown into the counts. */
static bool face_usable(builder *b, uint32_t index)
{
    const struct aiFace *face = &b->from->mFaces[index];
    counts *c = &b->counts;
    if (face->mNumIndices < 3) {
        c->lines++;
        return false;
    }
    bool valid = face->mIndices != NULL;
    for (uint32_t i = 0; valid && i < face->mNumIndices; i++)
        valid = face->mIndices[i] < b->from->mNumVertices;
    if (!valid) {
        if (c->bad_index++ == 0)
            c->first_bad_index = index;
        return false;
    }
    for (uint32_t i = 0; i < face->mNumIndices; i++) {
        lr_vec3 p = position_of(b->from, face->mIndices[i]);
        if (!in_range(p.x, LR_COORDINATE_MAX) || !in_range(p.y, LR_COORDINATE_MAX) ||
            !in_range(p.z, LR_COORDINATE_MAX)) {
            if (c->bad_position++ == 0)
                c->first_bad_position = index;
            return false;
        }
    }
    if (face->mNumIndices > LR_POLYGON_CORNERS_MAX)
        c->large++;
    return face->mNumIndices <= LR_POLYGON_CORNERS_MAX;
}

static void cut_face(builder *b, const struct aiFace *face)
{
    uint32_t *out = &b->triangles[3 * (size_t)b->triangle_count];
    if (face->mNumIndices == 3) {
        memcpy(out, face->mIndices, 3 * sizeof(uint32_t));
        b->triangle_count++;
        return;
    }
    lr_polygon *polygon = b->polygon;
    polygon->count = face->mNumIndices;
    for (uint32_t i = 0; i < polygon->count; i++)
        polygon->corners[i] = position_of(b->from, face->mIndices[i]);
    switch (lr_polygon_triangulate(polygon)) {
    case LR_POLYGON_GOOD:
        break;
    case LR_POLYGON_CROSSING:
        b->counts.crossing++;
        break;
    case LR_POLYGON_FLATTENED:
        b->counts.no_area++;
        return;
    }
    for (uint32_t i = 0; i < polygon->triangle_count; i++)
        for (int k = 0; k < 3; k++)
            *out++ = face->mIndices[polygon->triangles[i][k]];
    b->triangle_count += polygon->triangle_count;
}

static lr_status cut_faces(builder *b)
{
    lr_import *import = b->import;
    uint64_t total = 0;
    for (uint32_t i = 0; i < b->from->mNumFaces; i++) {
        uint32_t corners = b->from->mFaces[i].mNumIndices;
        total += corners >= 3 && corners <= LR_POLYGON_CORNERS_MAX ? corners - 2 : 0;
    }
    if (total > UINT32_MAX / 3 || total > import->options.max_triangles - import->triangles)
        return lr_fail(import->error, LR_ERROR_FILE,
                       "%s: with %s it has more than %llu triangles; allow more with "
                       "--max-triangles",
                       import->shown, b->label, (unsigned long long)import->options.max_triangles);
    import->triangles += total;
    /* The triangles, and their corners with the table that joins them, while it grows. */
    uint64_t corners = b->from->mNumVertices < 3 * total ? b->from->mNumVertices : 3 * total;
    lr_status status = lr_import_charge(
        import, total * 3 * sizeof(uint32_t) + corners * (3 * CORNER_FLOATS * sizeof(float)),
        b->label);
    if (status)
        return status;
    b->triangles = lr_alloc_large(3 * (size_t)total, sizeof *b->triangles);
    b->polygon = malloc(sizeof *b->polygon);
    if (!b->triangles || !b->polygon)
        return lr_import_no_memory(import);
    for (uint32_t i = 0; i < b->from->mNumFaces; i++)
        if (face_usable(b, i))
            cut_face(b, &b->from->mFaces[i]);
    return LR_OK;
}

/* Also false where the corners lie on one line but for rounding, a millionth of a radian. */
static bool has_area(const struct aiMesh *mesh, const uint32_t *triangle)
{
    lr_vec3 a = position_of(mesh, triangle[0]), b = position_of(mesh, triangle[1]);
    lr_vec3 c = position_of(mesh, triangle[2]);
    const double ab[3] = {b.x - a.x, b.y - a.y, b.z - a.z};
    const double ac[3] = {c.x - a.x, c.y - a.y, c.z - a.z};
    const double n[3] = {ab[1] * ac[2] - ab[2] * ac[1], ab[2] * ac[0] - ab[0] * ac[2],
                         ab[0] * ac[1] - ab[1] * ac[0]};
    double n2 = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    double ab2 = ab[0] * ab[0] + ab[1] * ab[1] + ab[2] * ab[2];
    double ac2 = ac[0] * ac[0] + ac[1] * ac[1] + ac[2] * ac[2];
    /* Twice the limits: no rounding can make a difference. */
    if (n2 > 4e-12 * ab2 * ac2 && n2 > 4e-72)
        return true;
    lr_vec3 sine = lr_vec3_cross(lr_vec3_normalize((lr_vec3){ab[0], ab[1], ab[2]}),
                                 lr_vec3_normalize((lr_vec3){ac[0], ac[1], ac[2]}));
    return lr_vec3_length(sine) > 1e-6 && lr_vec3_length((lr_vec3){n[0], n[1], n[2]}) > 1e-36;
}

static void drop_without_area(builder *b)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < b->triangle_count; i++) {
        const uint32_t *triangle = &b->triangles[3 * (size_t)i];
        if (has_area(b->from, triangle))
            memmove(&b->triangles[3 * (size_t)kept++], triangle, 3 * sizeof *triangle);
    }
    b->counts.no_area += b->triangle_count - kept;
    b->triangle_count = kept;
}

/* ---- Corners ------------------------------------------------------------------------------- */

static void store(float out[3], lr_vec3 v)
{
    out[0] = (float)v.x + 0.0f;
    out[1] = (float)v.y + 0.0f;
    out[2] = (float)v.z + 0.0f;
}

/* glTF's colours are linear; other programs write what they show. */
static float linear_color(const builder *b, float value)
{
    double v = value >= 0 ? fmin((double)value, 1) : 0; /* NaN: 0 */
    if (b->import->kind == LR_IMPORT_GLTF || b->import->kind == LR_IMPORT_GLB)
        return (float)v;
    return (float)lr_srgb_to_linear((unsigned)(v * 255 + 0.5));
}

/* The unit normal of a corner. False when the vertex's own was not usable and that of the face, the
 * cross product of two edges, stands in. */
static bool make_normal(builder *b, uint32_t vertex, const uint32_t *triangle, float out[3])
{
    const struct aiVector3D *n = &b->from->mNormals[vertex];
    lr_vec3 normal = {(double)n->x, (double)n->y, (double)n->z};
    double length = lr_vec3_length(normal);
    bool own = length >= 1e-6 && length <= 1e6;
    if (!own) {
        lr_vec3 at = position_of(b->from, triangle[0]);
        normal = lr_vec3_cross(lr_vec3_sub(position_of(b->from, triangle[1]), at),
                               lr_vec3_sub(position_of(b->from, triangle[2]), at));
        b->counts.bad_normal++;
    }
    store(out, lr_vec3_normalize(normal));
    return own;
}

/* The corner of a triangle at one of its vertices. False when it has its normal from the triangle.
 */
static bool make_corner(builder *b, uint32_t vertex, const uint32_t *triangle, float *out)
{
    const struct aiMesh *from = b->from;
    bool own_normal = true;
    store(out, position_of(from, vertex));
    out += 3;
    if (b->normals) {
        own_normal = make_normal(b, vertex, triangle, out);
        out += 3;
    }
    if (b->uvs) {
        /* assimp counts v upwards. */
        const struct aiVector3D *uv = &from->mTextureCoords[0][vertex];
        bool usable = in_range((double)uv->x, UV_MAX) && in_range((double)uv->y, UV_MAX);
        b->counts.bad_uv += !usable;
        *out++ = usable ? uv->x + 0.0f : 0;
        *out++ = usable ? 1 - uv->y + 0.0f : 0;
    }
    if (b->colors) {
        const struct aiColor4D *c = &from->mColors[0][vertex];
        out[0] = linear_color(b, c->r);
        out[1] = linear_color(b, c->g);
        out[2] = linear_color(b, c->b);
    }
    return own_normal;
}

/* Of each vertex, whether it is alone at its position: then no other corner equals its own. NULL
 * when memory is out. */
static bool *find_alone(const builder *b)
{
    uint32_t count = b->from->mNumVertices;
    bool *alone = malloc(count * sizeof *alone);
    for (uint32_t i = 0; alone && i < count; i++) {
        alone[i] = b->first[i] == i;
        if (!alone[i])
            alone[b->first[i]] = false;
    }
    return alone;
}

/* Makes b->triangles indices of corners. */
static lr_status join_corners(builder *b)
{
    lr_status status = LR_ERROR_MEMORY;
    /* Of a vertex with a normal of its own, the corner it became. */
    uint32_t *known = lr_alloc_large(b->from->mNumVertices, sizeof *known);
    bool *alone = find_alone(b);
    if (!known || !alone)
        goto done;
    memset(known, 0xFF, (size_t)b->from->mNumVertices * sizeof *known);
    for (uint32_t i = 0; i < b->triangle_count; i++) {
        uint32_t *triangle = &b->triangles[3 * (size_t)i];
        const uint32_t vertices[3] = {triangle[0], triangle[1], triangle[2]};
        for (int k = 0; k < 3; k++) {
            uint32_t vertex = vertices[k], index = known[vertex];
            if (index == LR_NONE) {
                float row[CORNER_FLOATS];
                bool own = make_corner(b, vertex, vertices, row);
                index = own && alone[vertex] ? lr_rows_add(&b->corners, row)
                                             : lr_rows_put(&b->corners, row);
                if (index == LR_NONE)
                    goto done;
                if (own)
                    known[vertex] = index;
            }
            triangle[k] = index;
        }
    }
    status = LR_OK;
done:
    free(known);
    free(alone);
    return status ? lr_import_no_memory(b->import) : LR_OK;
}

/* ---- The mesh ------------------------------------------------------------------------------ */

/* Of each corner, `count` floats from *offset on, which is moved behind them; NULL when memory is
 * out. */
static float *take_floats(const builder *b, size_t *offset, size_t count)
{
    size_t corners = b->corners.count, stride = b->corners.size / sizeof(float);
    const float *from = (const float *)b->corners.items + *offset;
    float *out = malloc(corners * count * sizeof *out);
    for (size_t i = 0; out && i < corners; i++)
        memcpy(&out[count * i], &from[stride * i], count * sizeof *out);
    *offset += count;
    return out;
}

static lr_status fill_mesh(builder *b, lr_mesh *mesh)
{
    size_t offset = 0;
    mesh->name = lr_string_copy(b->label, strlen(b->label));
    mesh->positions = take_floats(b, &offset, 3);
    mesh->normals = b->normals ? take_floats(b, &offset, 3) : NULL;
    mesh->uvs = b->uvs ? take_floats(b, &offset, 2) : NULL;
    mesh->colors = b->colors ? take_floats(b, &offset, 3) : NULL;
    mesh->triangles = b->triangles;
    b->triangles = NULL;
    if (!mesh->name || !mesh->positions || (b->normals && !mesh->normals) ||
        (b->uvs && !mesh->uvs) || (b->colors && !mesh->colors))
        return lr_import_no_memory(b->import);
    mesh->vertex_count = b->corners.count;
    mesh->triangle_count = b->triangle_count;
    return LR_OK;
}

static lr_status note_count(builder *b, uint32_t count, const char *what)
{
    if (count == 0)
        return LR_OK;
    return lr_import_note(b->import, "%s: %u %s", b->label, count, what);
}

static lr_status note_first(builder *b, uint32_t count, uint32_t first, const char *what)
{
    if (count == 0)
        return LR_OK;
    return lr_import_note(b->import, "%s: %u faces left out, the first is number %u: %s", b->label,
                          count, first, what);
}

static lr_status write_notes(builder *b)
{
    const counts *c = &b->counts;
    const struct aiMesh *from = b->from;
    lr_status status = note_count(b, c->lines, "points and lines left out: only faces are shown");
    if (!status)
        status =
            note_first(b, c->bad_index, c->first_bad_index, "it names vertices that there are not");
    if (!status)
        status = note_first(b, c->bad_position, c->first_bad_position,
                            "its coordinates are no numbers or above 1e12");
    if (!status)
        status = note_count(b, c->large, "faces left out: they have over 10000 corners");
    if (!status)
        status = note_count(b, c->crossing, "faces cross themselves: their parts may overlap");
    if (!status)
        status = note_count(b, c->no_area, "faces left out: they have no area");
    if (!status)
        status = note_count(b, c->bad_normal,
                            "corners have no usable normal and get that of their triangle");
    if (!status)
        status =
            note_count(b, c->bad_uv, "vertices have no usable texture coordinates and get 0, 0");
    if (!status && from->mTextureCoords[1])
        status = lr_import_note(b->import, "%s: only the first set of texture coordinates is used",
                                b->label);
    if (!status && from->mColors[1])
        status =
            lr_import_note(b->import, "%s: only the first set of vertex colours is used", b->label);
    return status;
}

static lr_status convert(builder *b, uint32_t index, uint32_t *mesh)
{
    lr_import *import = b->import;
    bool closed = false;
    lr_status status = cut_faces(b);
    if (!status && !(b->first = lr_vertices_weld(&b->from->mVertices[0].x, b->from->mNumVertices)))
        status = lr_import_no_memory(import);
    /* Before the triangles without area go: without them the seams that they fill would be open. */
    if (!status && !lr_triangles_closed(b->first, b->from->mNumVertices, b->triangles,
                                        b->triangle_count, &closed))
        status = lr_import_no_memory(import);
    if (!status)
        drop_without_area(b);
    if (!status)
        status = join_corners(b);
    if (!status)
        status = write_notes(b);
    if (status)
        return status;
    if (b->triangle_count == 0)
        return lr_import_note(import, "%s: left out, no face of it can be shown", b->label);
    lr_mesh *added = lr_scene_add_mesh(import->builder);
    if (!added)
        return lr_import_no_memory(import);
    added->closed = closed;
    *mesh = import->builder->scene->mesh_count - 1;
    status = fill_mesh(b, added);
    if (!status)
        import->bounds[index] = lr_mesh_bounds(added);
    return status;
}

lr_status lr_import_mesh(lr_import *import, uint32_t index, uint32_t *mesh)
{
    const struct aiMesh *from = import->scene->mMeshes[index];
    char name[80], label[320];
    *mesh = LR_IMPORT_NOTHING;
    if (!from || !from->mVertices || from->mNumVertices == 0 || !from->mFaces ||
        from->mNumVertices == LR_NONE)
        return lr_import_note(import, "mesh %u: left out, it has no faces", index);
    lr_import_shown(name, sizeof name, from->mName.data);
    snprintf(label, sizeof label, name[0] ? "mesh %u \"%s\"" : "mesh %u%s", index, name);
    builder b = {
        .import = import,
        .from = from,
        .label = label,
        /* Those of STL say no more than the corners do, and often less. */
        .normals = from->mNormals && import->kind != LR_IMPORT_STL,
        .uvs = from->mTextureCoords[0] && from->mNumUVComponents[0] >= 2,
        .colors = from->mColors[0] != NULL,
    };
    b.corners.size =
        (3 + (b.normals ? 3 : 0) + (b.uvs ? 2 : 0) + (b.colors ? 3 : 0)) * sizeof(float);
    lr_status status = convert(&b, index, mesh);
    free(b.triangles);
    free(b.polygon);
    free(b.first);
    lr_rows_free(&b.corners);
    return status;
}
