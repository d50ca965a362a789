/* What the parts of the importer share. Everything that assimp returns is checked before it is
 * used: its parsers believe much of what a file says. */
#ifndef LR_SCENE_IMPORT_INTERNAL_H
#define LR_SCENE_IMPORT_INTERNAL_H

#include <assimp/scene.h>
#include <jansson.h>

#include "base/status.h"
#include "scene/bounds.h"
#include "scene/build.h"

#define LR_IMPORT_TRIANGLES_DEFAULT 100000000u
#define LR_IMPORT_MEMORY_DEFAULT ((uint64_t)8 << 30)
#define LR_IMPORT_NODES_MAX 1000000u
#define LR_IMPORT_DEPTH_MAX 256 /* of nodes; assimp calls itself for each level */
#define LR_IMPORT_NOTES_MAX 40  /* written out of one file; the rest is counted */

#define LR_IMPORT_NOTHING (LR_NONE - 1)

typedef enum lr_import_kind {
    LR_IMPORT_GLTF,
    LR_IMPORT_GLB,
    LR_IMPORT_OBJ,
    LR_IMPORT_PLY,
    LR_IMPORT_STL,
} lr_import_kind;

typedef struct lr_import {
    lr_scene_builder *builder;
    lr_load_options options; /* with the defaults filled in */
    lr_import_kind kind;
    const char *base_file; /* in whose folder all files must lie */
    const char *name;      /* of the file, as seen from that folder */
    char shown[160];       /* stands for the file in messages, safe to print */
    char *bytes;           /* the file */
    size_t size;
    json_t *json;                /* glTF, else NULL */
    const struct aiScene *scene; /* as assimp returned it, or within ply */
    struct lr_ply *ply;          /* PLY, else NULL */
    uint64_t memory;             /* charged so far */
    uint64_t triangles;
    uint32_t notes;
    uint32_t *meshes;    /* of each aiMesh: the scene's mesh; LR_NONE: not converted yet;
                            LR_IMPORT_NOTHING: nothing of it can be shown */
    lr_bounds *bounds;   /* of each aiMesh that was converted */
    uint32_t *materials; /* of each aiMaterial: the scene's material; LR_NONE: not converted yet */
    lr_bounds world;     /* of all objects added */
    char refused[512];   /* why a file was not opened for assimp, the first one */
    lr_error *error;
} lr_import;

/* The path behind its last slash. */
const char *lr_import_bare_name(const char *path);

/* Of texts of a file in messages: without control characters, cut to size. Returns buffer. */
const char *lr_import_shown(char *buffer, size_t size, const char *text);

/* Notes what is left out and why, behind the file's name. LR_ERROR_MEMORY. */
lr_status lr_import_note(lr_import *import, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
lr_status lr_import_no_memory(lr_import *import);

/* Counts memory that is about to be used; fails over the limit. */
lr_status lr_import_charge(lr_import *import, uint64_t bytes, const char *what);
lr_status lr_import_progress(lr_import *import, double fraction);

/* import_io.c: reads a file that the imported file names, as seen from its folder, or the file
 * itself; the caller frees *bytes. */
lr_status lr_import_read(lr_import *import, const char *relative, char **bytes, size_t *size,
                         lr_error *error);
/* The path of such a file, which the caller frees. */
lr_status lr_import_resolve(lr_import *import, const char *relative, char **path, lr_error *error);
/* import_ply.c: reads a PLY file into import->ply, which the caller frees, and import->scene. */
lr_status lr_ply_parse(lr_import *import);
void lr_ply_free(struct lr_ply *ply);

/* Runs assimp's parser on the file into import->scene. */
lr_status lr_import_parse(lr_import *import);

/* import_guard.c, import_gltf.c: refuse files whose headers promise what they do not hold, before
 * assimp believes them. lr_gltf_guard also fills import->json. */
lr_status lr_import_guard(lr_import *import);
lr_status lr_gltf_guard(lr_import *import);

/* import_gltf_check.c: whether the parts of import->json lie within each other and within bin_size
 * bytes beside it. */
lr_status lr_gltf_check(lr_import *import, uint64_t bin_size);

/* import_gltf.c: the notes about what a glTF file has and is not shown. */
lr_status lr_gltf_notes(lr_import *import);
/* The object of a material, NULL when there is none; a member as a number, or the fallback. */
const json_t *lr_gltf_material(const lr_import *import, uint32_t index);
double lr_gltf_number(const json_t *object, const char *key, double fallback);
/* object[key], or NULL; object may be NULL. */
const json_t *lr_gltf_member(const json_t *object, const char *key);
const json_t *lr_gltf_extension(const json_t *object, const char *name);

/* import_light.c: cameras and lights of a glTF file; none is no error. */
lr_status lr_gltf_view(lr_import *import);

/* import_view.c: what a scene has beside objects: a camera if there is none, the background, and
 * an exposure that suits the lights. */
lr_status lr_import_surroundings(lr_import *import);

/* import.c: what assimp returned, import->scene, as objects of the scene. */
lr_status lr_import_convert(lr_import *import);

/* import_material.c: the scene's material for aiMaterial `index`. */
lr_status lr_import_material(lr_import *import, uint32_t index, uint32_t *material);
/* Whether a material has numbers under the key; asked for numbers in a text, assimp may throw. */
bool lr_import_has_numbers(const struct aiMaterial *from, const char *key, unsigned texture_type);
/* import_texture.c: the texture of the colour, if there is one that can be shown; notes about those
 * that neither it nor a map shows. */
lr_status lr_import_texture(lr_import *import, const struct aiMaterial *from,
                            lr_material *material);
/* The texture of assimp's type, if there is one that can be shown, as a map like `map`; `what`
 * stands for it in notes. */
lr_status lr_import_map(lr_import *import, const struct aiMaterial *from, unsigned type,
                        const char *what, lr_map_kind kind, lr_map map, lr_material *material);
/* Whether some texel of the texture is not grey. */
bool lr_import_is_colored(const lr_import *import, uint32_t texture);

/* import_mesh.c: the scene's mesh for aiMesh `index`; LR_IMPORT_NOTHING, after a note, when nothing
 * of it can be shown. */
lr_status lr_import_mesh(lr_import *import, uint32_t index, uint32_t *mesh);

/* import_node.c: the objects. */
lr_status lr_import_nodes(lr_import *import);

/* closed.c: of each vertex, the first one at its position, with -0 as 0; freed by the caller. NULL
 * when memory is out. */
uint32_t *lr_vertices_weld(const float *positions, uint32_t count);
/* Whether the triangles enclose a space: with vertices joined as lr_vertices_weld says, each edge
 * is met by exactly two triangles, once in each direction. False when memory is out. */
bool lr_triangles_closed(const uint32_t *first, uint32_t vertex_count, const uint32_t *triangles,
                         uint32_t triangle_count, bool *closed);

#endif
