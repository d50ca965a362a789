#include "scene/part.h"

#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"
#include "scene/texture.h"

lr_part *lr_part_create(lr_scene *content, lr_file_list *files, bool allow_path)
{
    lr_part *part = lr_alloc(1, sizeof *part);
    lr_bounds *bounds = lr_alloc(content->mesh_count, sizeof *bounds);
    if (!part || !bounds) {
        free(part);
        free(bounds);
        lr_file_list_free(files);
        lr_scene_destroy(content);
        return NULL;
    }
    for (uint32_t i = 0; i < content->mesh_count; i++)
        bounds[i] = lr_mesh_bounds(&content->meshes[i]);
    *part =
        (lr_part){.files = *files, .allow_path = allow_path, .content = content, .bounds = bounds};
    atomic_init(&part->users, 1);
    *files = (lr_file_list){0};
    return part;
}

void lr_part_release(lr_part *part)
{
    if (!part || atomic_fetch_sub(&part->users, 1) != 1)
        return;
    lr_file_list_free(&part->files);
    lr_scene_destroy(part->content);
    free(part->bounds);
    free(part);
}

lr_part *lr_part_of(const lr_scene *scene, const char *path)
{
    for (uint32_t i = 0; i < scene->part_count; i++)
        if (strcmp(scene->parts[i]->files.files[0].path, path) == 0)
            return scene->parts[i];
    return NULL;
}

/* A list that is full may lack some. */
static bool is_current(const lr_part *part)
{
    for (uint32_t i = 0; i < part->files.count; i++) {
        const lr_file *file = &part->files.files[i];
        /* Textures have parts of their own, so that one that changes does not touch the meshes. */
        if (i > 0 && lr_part_of(part->content, file->path))
            continue;
        lr_file_stamp now = lr_file_stamp_of(file->path);
        if (!lr_file_is_same(&file->stamp, &now))
            return false;
    }
    return part->files.count < LR_FILES_MAX;
}

lr_part *lr_part_find(const lr_scene_builder *builder, const char *path, bool allow_path)
{
    for (size_t i = 0; i < sizeof builder->donors / sizeof *builder->donors; i++) {
        lr_part *part = builder->donors[i] ? lr_part_of(builder->donors[i], path) : NULL;
        if (part && part->allow_path == allow_path && (builder->trusting || is_current(part))) {
            atomic_fetch_add(&part->users, 1);
            return part;
        }
    }
    return NULL;
}

bool lr_scene_add_part(lr_scene_builder *builder, lr_part *part)
{
    lr_scene *scene = builder->scene;
    if (!lr_array_reserve((void **)&scene->parts, scene->part_count, &builder->part_capacity,
                          sizeof *scene->parts)) {
        lr_part_release(part);
        return false;
    }
    scene->parts[scene->part_count++] = part;
    return true;
}

/* ---- Placing ------------------------------------------------------------------------------- */

static bool copy_name(char **name)
{
    if (*name)
        *name = lr_string_copy(*name, strlen(*name));
    return *name;
}

static lr_status place_texture(lr_scene_builder *builder, const lr_part *part, uint32_t index,
                               uint32_t *placed, lr_error *error)
{
    const lr_texture *from = &part->content->textures[index];
    if (lr_part_of(part->content, from->name))
        return lr_texture_load(builder, from->name, from->wrap_u, from->wrap_v, placed, error);
    return lr_texture_borrow(builder, from, placed, error);
}

static bool place_material(lr_scene_builder *builder, const lr_material *from,
                           const uint32_t *textures)
{
    lr_material *added = lr_scene_add_material(builder);
    if (!added)
        return false;
    *added = *from;
    if (from->color.kind == LR_PATTERN_IMAGE)
        added->color.texture = textures[from->color.texture];
    return copy_name(&added->name);
}

static bool place_mesh(lr_scene_builder *builder, const lr_mesh *from)
{
    lr_mesh *added = lr_scene_add_mesh(builder);
    if (!added)
        return false;
    *added = *from;
    added->borrowed = true;
    return copy_name(&added->name);
}

/* Takes back the textures and notes that came last. */
static void take_back(lr_scene *scene, uint32_t texture_count, uint32_t note_count)
{
    while (scene->texture_count > texture_count)
        free(scene->textures[--scene->texture_count].name);
    while (scene->note_count > note_count)
        free(scene->notes[--scene->note_count]);
}

lr_status lr_part_place(lr_scene_builder *builder, const lr_part *part, lr_error *error)
{
    const lr_scene *content = part->content;
    if (content->material_count > LR_MATERIALS_MAX - builder->scene->material_count)
        return lr_fail(error, LR_ERROR_FILE, "%.400s: with it there are more than %d materials",
                       part->files.files[0].path, LR_MATERIALS_MAX);
    uint32_t *textures = lr_alloc(content->texture_count, sizeof *textures);
    const lr_scene *donor = builder->donors[1];
    lr_status status = textures ? LR_OK : LR_ERROR_MEMORY;
    uint32_t texture_count = builder->scene->texture_count, note_count = builder->scene->note_count;
    builder->donors[1] = content;
    for (uint32_t i = 0; i < content->texture_count && !status; i++)
        status = place_texture(builder, part, i, &textures[i], error);
    builder->donors[1] = donor;
    if (status)
        take_back(builder->scene, texture_count, note_count);
    bool good = !status;
    for (uint32_t i = 0; i < content->material_count && good; i++)
        good = place_material(builder, &content->materials[i], textures);
    for (uint32_t i = 0; i < content->mesh_count && good; i++)
        good = place_mesh(builder, &content->meshes[i]);
    for (uint32_t i = 0; i < content->note_count && good; i++)
        good = lr_scene_add_note(builder, "%s", content->notes[i]);
    free(textures);
    if (status == LR_ERROR_FILE || good)
        return status;
    return lr_fail(error, LR_ERROR_MEMORY, "%.400s: out of memory", part->files.files[0].path);
}
