/* Files of meshes that a scene text names. */
#include "scene/read.h"

#include "base/memory.h"
#include "scene/import.h"
#include "scene/part.h"
#include "scene/path.h"

#include <stdlib.h>
#include <string.h>

/* Lists the files that something was made of. Of textures, which have parts of their own, these
 * know what was read. */
static bool list_files(lr_reader *reader, const lr_file_list *files)
{
    bool listed = true;
    for (uint32_t i = 0; reader->options.files && i < files->count && listed; i++) {
        const lr_file *file = &files->files[i];
        const lr_part *own = lr_part_of(reader->scene, file->path);
        listed = lr_file_list_put(reader->options.files, file->path,
                                  own ? &own->files.files[0].stamp : &file->stamp);
    }
    return listed;
}

lr_status lr_read_path(lr_reader *reader, const char *name, char **path, lr_error *error)
{
    if (!reader->moment)
        return lr_path_resolve(reader->report->name, name, &reader->options, path, error);
    *path = lr_path_join(reader->report->name, name);
    return *path ? LR_OK : LR_ERROR_MEMORY;
}

/* What the scene before made of the file; NULL when that is of no use. */
static lr_part *find_part(lr_reader *reader, const char *name)
{
    const lr_load_options *options = &reader->options;
    lr_error ignored;
    char *path;
    if (!options->previous || lr_read_path(reader, name, &path, &ignored) != LR_OK)
        return NULL;
    lr_part *part = lr_part_find(&reader->builder, path, options->allow_path);
    free(path);
    if (part && lr_import_fits(reader->scene, part->content, options))
        return part;
    lr_part_release(part);
    return NULL;
}

/* Reads the file into a part with one user. */
static lr_status import_part(lr_reader *reader, const char *name, lr_part **part, lr_error *error)
{
    lr_file_list files = {0};
    lr_load_options options = reader->options;
    lr_scene_builder builder = {.scene = lr_alloc(1, sizeof(lr_scene)),
                                .beside = reader->scene,
                                .donors = {options.previous}};
    if (!builder.scene)
        return LR_ERROR_MEMORY;
    options.files = &files;
    lr_status status = lr_import_objects(&builder, reader->report->name, name, &options, error);
    if (status) {
        bool listed = list_files(reader, &files);
        lr_file_list_free(&files);
        lr_scene_destroy(builder.scene);
        return listed ? status : LR_ERROR_MEMORY;
    }
    *part = lr_part_create(builder.scene, &files, options.allow_path);
    return *part ? LR_OK : LR_ERROR_MEMORY;
}

/* The objects of the part's content, placed in the scene. */
static bool take_objects(lr_mesh_file *file, const lr_part *part, uint32_t first_mesh)
{
    const lr_scene *content = part->content;
    file->count = content->object_count;
    file->objects = lr_alloc(file->count, sizeof *file->objects);
    file->bounds = lr_alloc(file->count, sizeof *file->bounds);
    for (uint32_t i = 0; file->objects && file->bounds && i < file->count; i++) {
        file->objects[i] = content->objects[i];
        file->objects[i].mesh += first_mesh;
        file->objects[i].material += file->first_material;
        file->bounds[i] = part->bounds[content->objects[i].mesh];
    }
    return file->objects && file->bounds;
}

/* Places the part and hands the caller's use of it to the scene. */
static lr_status place_part(lr_reader *reader, lr_part *part, lr_mesh_file *file, lr_error *error)
{
    uint32_t first_mesh = reader->scene->mesh_count;
    lr_status status = lr_part_place(&reader->builder, part, error);
    if (status) {
        lr_part_release(part);
        return status;
    }
    file->end_material = reader->scene->material_count;
    bool good = list_files(reader, &part->files) && take_objects(file, part, first_mesh);
    return lr_scene_add_part(&reader->builder, part) && good ? LR_OK : LR_ERROR_MEMORY;
}

static bool load(lr_reader *reader, const lr_node *node, lr_mesh_file *file)
{
    lr_scene *scene = reader->scene;
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
    lr_part *part = find_part(reader, file->name);
    lr_status status = part ? place_part(reader, part, file, &error) : LR_ERROR_FILE;
    /* It is read where it is new, and where a texture of the part is broken now, which is noted. */
    if (status == LR_ERROR_FILE) {
        error = (lr_error){0};
        status = import_part(reader, file->name, &part, &error);
        if (!status)
            status = place_part(reader, part, file, &error);
    }
    if (status == LR_ERROR_INTERRUPTED)
        reader->report->interrupted = reader->full = true;
    else if (status == LR_ERROR_MEMORY && !error.message[0])
        reader->report->no_memory = true;
    else if (status)
        lr_report_add(reader->report, node->offset, "%s", error.message);
    return !status;
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
        for (uint32_t i = 0; i < kept; i++) {
            scene->materials[i].mix.first = moved[scene->materials[i].mix.first];
            scene->materials[i].mix.second = moved[scene->materials[i].mix.second];
        }
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
