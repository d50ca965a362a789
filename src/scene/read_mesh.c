/* Files of meshes that a scene text names. */
#include "scene/read.h"

#include "base/memory.h"
#include "scene/import.h"

#include <stdlib.h>
#include <string.h>

static bool load(lr_reader *reader, const lr_node *node, lr_mesh_file *file)
{
    lr_scene *scene = reader->scene;
    uint32_t before = scene->object_count;
    file->first_material = file->end_material = scene->material_count;
    lr_error error = {0};
    if (!lr_import_knows(file->name)) {
        char shown[LR_SHOWN_MAX];
        lr_report_add(reader->report, node->offset,
                      "\"%s\" is no model that is read, expected a .gltf, .glb, .obj, .ply or .stl "
                      "file",
                      lr_shown(shown, node->text, node->count));
        return false;
    }
    lr_status status = lr_import_objects(&reader->builder, reader->report->name, file->name,
                                         &reader->options, &error);
    if (status == LR_ERROR_INTERRUPTED)
        reader->report->interrupted = reader->full = true;
    else if (status)
        lr_report_add(reader->report, node->offset, "%s", error.message);
    if (status)
        return false;
    file->end_material = scene->material_count;
    /* Out of the scene again: they are placed wherever the text names the file. */
    file->count = scene->object_count - before;
    file->objects = lr_alloc(file->count, sizeof *file->objects);
    file->bounds = lr_alloc(file->count, sizeof *file->bounds);
    scene->object_count = before;
    if (!file->objects || !file->bounds) {
        reader->report->no_memory = true;
        return false;
    }
    memcpy(file->objects, &scene->objects[before], file->count * sizeof *file->objects);
    for (uint32_t i = 0; i < file->count; i++)
        file->bounds[i] = lr_mesh_bounds(&scene->meshes[file->objects[i].mesh]);
    return true;
}

const lr_mesh_file *lr_read_mesh_file(lr_reader *reader, const lr_node *node)
{
    lr_mesh_files *files = &reader->files;
    for (uint32_t i = 0; i < files->count; i++)
        if (strcmp(files->items[i].name, node->text) == 0)
            return files->items[i].objects ? &files->items[i] : NULL;
    lr_mesh_file file = {.name = lr_string_copy(node->text, node->count)};
    if (!file.name || !lr_array_reserve((void **)&files->items, files->count, &files->capacity,
                                        sizeof *files->items)) {
        reader->report->no_memory = true;
        free(file.name);
        return NULL;
    }
    bool loaded = load(reader, node, &file);
    /* One that failed is kept too, so that it is reported once. */
    files->items[files->count] = file;
    files->count++;
    return loaded ? &files->items[files->count - 1] : NULL;
}

/* Marks what must stay: all that came from no file, and what some object has. */
static void mark_used(const lr_reader *reader, bool *used)
{
    const lr_scene *scene = reader->scene;
    for (uint32_t i = 0; i < scene->material_count; i++)
        used[i] = true;
    for (uint32_t f = 0; f < reader->files.count; f++)
        for (uint32_t i = reader->files.items[f].first_material;
             i < reader->files.items[f].end_material; i++)
            used[i] = false;
    for (uint32_t i = 0; i < scene->object_count; i++)
        used[scene->objects[i].material] = true;
}

void lr_drop_unused_materials(lr_reader *reader)
{
    lr_scene *scene = reader->scene;
    bool *used = lr_alloc(scene->material_count + 1ull, sizeof *used);
    uint32_t *moved = lr_alloc(scene->material_count + 1ull, sizeof *moved), kept = 0;
    if (used && moved) {
        mark_used(reader, used);
        for (uint32_t i = 0; i < scene->material_count; i++) {
            moved[i] = kept;
            if (used[i])
                scene->materials[kept++] = scene->materials[i];
            else
                free(scene->materials[i].name);
        }
        scene->material_count = kept;
        for (uint32_t i = 0; i < scene->object_count; i++)
            scene->objects[i].material = moved[scene->objects[i].material];
    } else {
        reader->report->no_memory = true;
    }
    free(used);
    free(moved);
}

void lr_mesh_files_free(lr_mesh_files *files)
{
    for (uint32_t i = 0; i < files->count; i++) {
        free(files->items[i].name);
        free(files->items[i].objects);
        free(files->items[i].bounds);
    }
    free(files->items);
}
