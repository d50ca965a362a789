/* A scene from text: the top level, and the functions of the library. */
#include "scene/load.h"
#include "scene/read.h"

#include "base/hash.h"
#include "base/status.h"
#include "base/memory.h"
#include "scene/build.h"
#include "scene/camera.h"
#include "scene/moment.h"
#include "scene/part.h"

#include <stdlib.h>
#include <string.h>

static lr_camera *add_camera(lr_reader *reader)
{
    lr_camera *camera = lr_scene_add_camera(&reader->builder);
    if (!camera)
        reader->report->no_memory = true;
    return camera;
}

/* False after reporting what no camera may be. */
static bool check_camera(lr_reader *reader, const lr_camera *camera, const lr_given *given,
                         const lr_node *at)
{
    const lr_record *record = &lr_camera_record;
    const lr_node *from = lr_given_value(given, record, "from");
    const lr_node *to = lr_given_value(given, record, "to");
    const lr_node *own_up = lr_given_value(given, record, "up");
    const lr_node *aim = to ? to : from ? from : at;
    lr_vec3 view = lr_vec3_sub(camera->to, camera->from);
    if (!(lr_vec3_length(view) >= LR_LENGTH_MIN)) {
        lr_report_add(reader->report, aim->offset,
                      "the camera's from and to are the same point, expected two");
        return false;
    }
    if (lr_parallel(view, camera->up)) {
        bool along_z = lr_parallel(view, (lr_vec3){0, 0, 1});
        lr_report_add(reader->report, (own_up ? own_up : aim)->offset,
                      "the camera's up [%.10g, %.10g, %.10g] lies along its view, expected "
                      "another direction, such as `up: [%d, 0, %d]`",
                      camera->up.x, camera->up.y, camera->up.z, along_z ? 1 : 0, along_z ? 0 : -1);
        return false;
    }
    const char *key, *flaw = lr_camera_flaw(camera, &key);
    if (!flaw)
        return true;
    const lr_node *value = lr_given_value(given, record, key);
    lr_report_add(reader->report, (value ? value : at)->offset, "the camera's %s: %s", key, flaw);
    return false;
}

/* Where the camera is when the shutter closes: the same text, read in a frame a little later. */
static void read_closing(lr_reader *reader, const lr_node *node, const lr_node *at, lr_vec3 up,
                         lr_camera *camera)
{
    lr_camera closing = {.up = up};
    lr_given given;
    double frame = reader->options.frame;
    reader->options.frame = frame + camera->shutter;
    bool good = lr_read_record(reader, node, at, &lr_camera_record, &closing, &given) &&
                check_camera(reader, &closing, &given, at);
    reader->options.frame = frame;
    if (good)
        lr_camera_move(camera, &closing);
}

static void read_camera(lr_reader *reader, const lr_node *node, const lr_node *name, lr_vec3 up)
{
    lr_camera *camera = add_camera(reader);
    lr_given given;
    if (!camera)
        return;
    *camera = (lr_camera){.line = name ? name->line : node->line, .up = up};
    const lr_node *at = name ? name : node;
    bool around = reader->beside_motion;
    reader->beside_motion = true;
    bool valid = lr_read_record(reader, node, at, &lr_camera_record, camera, &given);
    if (name && !(camera->name = lr_string_copy(name->text, name->count)))
        reader->report->no_memory = true;
    if (valid && check_camera(reader, camera, &given, at) && camera->shutter > 0 && !reader->moment)
        read_closing(reader, node, at, up, camera);
    reader->beside_motion = around;
}

static void read_cameras(lr_reader *reader, const lr_node *node, lr_vec3 up)
{
    if (node->kind != LR_NODE_MAP || node->count == 0) {
        lr_report_type(reader, node, "cameras",
                       "a mapping of names to cameras, such as `front: {from: [0, 1, 5]}`");
        return;
    }
    for (uint32_t i = 0; i < node->count; i++)
        read_camera(reader, lr_map_value(node, i), lr_map_key(node, i), up);
}

/* Cameras are known to be given in one way or the other, else that is reported. */
static void read_all_cameras(lr_reader *reader, const lr_node *root, const lr_given *given,
                             lr_vec3 up)
{
    const lr_record *record = &lr_scene_record;
    const lr_node *camera = lr_given_value(given, record, "camera");
    const lr_node *cameras = lr_given_value(given, record, "cameras");
    if (camera && cameras)
        lr_report_add(reader->report, cameras->offset,
                      "the scene has both camera and cameras, expected one of them");
    else if (!camera && !cameras && given->valid)
        lr_report_add(reader->report, root->offset,
                      "the scene has no camera, expected a key such as `camera: {from: [0, 1, 5], "
                      "to: [0, 0, 0]}`");
    if (camera)
        read_camera(reader, camera, NULL, up);
    if (cameras)
        read_cameras(reader, cameras, up);
}

void lr_read_cameras(lr_reader *reader, const lr_node *root)
{
    lr_scene_draft draft = {0};
    lr_given given;
    lr_read_record(reader, root, root, &lr_scene_record, &draft, &given);
    read_all_cameras(reader, root, &given, draft.up);
}

void lr_read_scene(lr_reader *reader, const lr_node *root)
{
    const lr_record *record = &lr_scene_record;
    lr_scene *scene = reader->scene;
    lr_given given;
    if (root->kind != LR_NODE_MAP) {
        lr_report_type(reader, root, "the scene", "a mapping with keys such as camera and objects");
        return;
    }
    lr_scene_draft draft = {0};
    lr_read_record(reader, root, root, record, &draft, &given);
    scene->ambient = draft.scene.ambient;
    lr_vec3 up = lr_vec3_normalize(draft.up);
    scene->background_up = up;
    lr_record_defaults(&lr_image_record, scene);
    lr_record_defaults(&lr_fog_record, scene);
    lr_record_defaults(&lr_air_record, scene);
    const lr_field *sky = &record->fields[lr_field_index(record, "background")];
    scene->background.colors[0] = (lr_color){sky->fallback[0], sky->fallback[1], sky->fallback[2]};
    scene->background.colors[1] = (lr_color){sky->fallback[3], sky->fallback[4], sky->fallback[5]};

    const lr_node *image = lr_given_value(&given, record, "image");
    const lr_node *fog = lr_given_value(&given, record, "fog");
    const lr_node *air = lr_given_value(&given, record, "air");
    const lr_node *background = lr_given_value(&given, record, "background");
    const lr_node *materials = lr_given_value(&given, record, "materials");
    const lr_node *lights = lr_given_value(&given, record, "lights");
    const lr_node *objects = lr_given_value(&given, record, "objects");
    /* Materials before objects, which name them; otherwise the order is free, as the report sorts.
     */
    lr_given ignored;
    read_all_cameras(reader, root, &given, draft.up);
    reader->beside_motion = true;
    if (image)
        lr_read_record(reader, image, image, &lr_image_record, scene, &ignored);
    reader->beside_motion = false;
    if (fog)
        lr_read_record(reader, fog, fog, &lr_fog_record, scene, &ignored);
    if (air)
        lr_read_record(reader, air, air, &lr_air_record, scene, &ignored);
    if (air && fog)
        lr_report_add(reader->report, air->offset,
                      "air stands beside fog, expected one of the two");
    if (background)
        lr_read_background(reader, background, sky);
    if (materials)
        lr_read_materials(reader, materials);
    scene->default_light = !lights;
    if (lights)
        lr_read_lights(reader, lights);
    if (objects)
        lr_read_objects(reader, objects);
    if (reader->files.count && reader->report->count == 0 && !reader->report->no_memory)
        lr_drop_unused_materials(reader);
}

static void free_mesh(lr_mesh *mesh)
{
    free(mesh->name);
    if (mesh->borrowed)
        return;
    free(mesh->positions);
    free(mesh->normals);
    free(mesh->uvs);
    free(mesh->colors);
    free(mesh->triangles);
}

static void free_texture(lr_texture *texture)
{
    free(texture->name);
    if (texture->borrowed)
        return;
    free(texture->bytes);
    free(texture->floats);
}

void lr_scene_destroy(lr_scene *scene)
{
    if (!scene)
        return;
    for (uint32_t i = 0; i < scene->camera_count; i++)
        free(scene->cameras[i].name);
    for (uint32_t i = 0; i < scene->material_count; i++)
        free(scene->materials[i].name);
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        free_mesh(&scene->meshes[i]);
    for (uint32_t i = 0; i < scene->texture_count; i++)
        free_texture(&scene->textures[i]);
    for (uint32_t i = 0; i < scene->note_count; i++)
        free(scene->notes[i]);
    for (uint32_t i = 0; i < scene->part_count; i++)
        lr_part_release(scene->parts[i]);
    free(scene->parts);
    free(scene->meshes);
    free(scene->textures);
    free(scene->notes);
    free(scene->cameras);
    free(scene->materials);
    free(scene->objects);
    free(scene->lights);
    free(scene->source);
    lr_retold_free(scene->retold);
    free(scene);
}

const lr_language lr_scene_language = {
    .subject = "scene",
    .examples = "camera and objects",
    .relief = "bulk geometry belongs in mesh files",
    .knows_key = lr_key_is_known,
};

void lr_read_tree(const lr_tree *tree, lr_scene *scene, lr_report *report,
                  const lr_load_options *options,
                  void (*read)(lr_reader *reader, const lr_node *root))
{
    lr_reader reader = {
        .report = report, .scene = scene, .builder.scene = scene, .default_material = UINT32_MAX};
    if (options)
        reader.options = *options;
    scene->frame = reader.options.frame;
    reader.builder.donors[0] = reader.options.previous;
    reader.locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (!reader.locale)
        report->no_memory = true;
    else if (tree->root)
        read(&reader, tree->root);
    if (reader.locale)
        freelocale(reader.locale);
    lr_mesh_files_free(&reader.files);
    lr_names_free(&reader.materials);
    free(reader.mixes.items);
}

/* Reads the report's text into the scene; what is wrong goes to the report. */
static void read_text(lr_scene *scene, lr_report *report, const lr_load_options *options)
{
    if (!lr_text_check(report))
        return;
    lr_tree tree;
    lr_tree_read(&tree, report);
    lr_read_tree(&tree, scene, report, options, lr_read_scene);
    if (lr_scene_blurs_any(scene) && !lr_scene_retell(scene, report, options, &tree))
        report->no_memory = true;
    lr_tree_free(&tree);
}

static void read_moment(lr_reader *reader, const lr_node *root)
{
    reader->moment = reader->scene->moment = reader->builder.trusting = true;
    lr_read_scene(reader, root);
}

static void read_retold(lr_scene *scene, lr_report *report, const lr_load_options *options)
{
    lr_read_tree(&options->previous->retold->tree, scene, report, options, read_moment);
}

lr_status lr_scene_from_text(const char *text, size_t length, const char *name,
                             const lr_language *language, const lr_load_options *options,
                             void (*read)(lr_scene *scene, lr_report *report,
                                          const lr_load_options *options),
                             lr_scene **scene, char **report, lr_error *error)
{
    *scene = NULL;
    *report = NULL;
    lr_status status = LR_OK;
    lr_scene *made = lr_alloc(1, sizeof *made);
    lr_report *problems = lr_alloc(1, sizeof *problems);
    if (!made || !problems)
        goto no_memory;
    made->source = lr_string_copy(name, strlen(name));
    if (!made->source)
        goto no_memory;
    lr_hash_bytes(text, length, made->sha256);
    problems->language = language;
    problems->name = name;
    problems->text = text;
    problems->length = length;
    read(made, problems, options);
    if (problems->no_memory)
        goto no_memory;
    if (problems->interrupted) {
        status = lr_fail(error, LR_ERROR_INTERRUPTED, "%s: interrupted", name);
    } else if (problems->count > 0) {
        *report = lr_report_text(problems);
        if (!*report)
            goto no_memory;
        uint64_t count = problems->count + problems->dropped;
        status = lr_fail(error, LR_ERROR_SCENE, "%s: %llu error%s in the scene", name,
                         (unsigned long long)count, count == 1 ? "" : "s");
    } else {
        *scene = made;
        made = NULL;
    }
    goto done;
no_memory:
    status = lr_fail(error, LR_ERROR_MEMORY, "%s: out of memory while reading the scene", name);
done:
    if (problems)
        lr_report_free(problems);
    free(problems);
    lr_scene_destroy(made);
    return status;
}

lr_status lr_scene_parse_with(const char *text, size_t length, const char *name,
                              const lr_load_options *options, lr_scene **scene, char **report,
                              lr_error *error)
{
    return lr_scene_from_text(text, length, name, &lr_scene_language, options, read_text, scene,
                              report, error);
}

lr_status lr_scene_read_moment(const lr_scene *scene, double frame, lr_scene **moment,
                               char **report, lr_error *error)
{
    const lr_retold *retold = scene->retold;
    lr_load_options options = retold->options;
    options.frame = frame;
    options.previous = scene;
    return lr_scene_from_text(retold->text, retold->length, scene->source, &lr_scene_language,
                              &options, read_retold, moment, report, error);
}

lr_status lr_scene_parse(const char *text, size_t length, const char *name, lr_scene **scene,
                         char **report, lr_error *error)
{
    return lr_scene_parse_with(text, length, name, NULL, scene, report, error);
}
