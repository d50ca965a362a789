#include "scene/write.h"

#include <locale.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "base/file.h"
#include "base/memory.h"
#include "scene/camera.h"
#include "scene/report.h"

char *lr_written(void (*put)(FILE *out, void *something), void *something, size_t *length)
{
    char *text = NULL;
    locale_t c_locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    FILE *out = c_locale ? open_memstream(&text, length) : NULL;
    bool good = false;
    if (out) {
        locale_t before = uselocale(c_locale);
        put(out, something);
        uselocale(before);
        good = !ferror(out);
        good = fclose(out) == 0 && good;
    }
    if (c_locale)
        freelocale(c_locale);
    if (!good) {
        free(text);
        return NULL;
    }
    return text;
}

void lr_writer_cannot(lr_writer *writer, const char *text)
{
    uint32_t i = 0;
    while (i < writer->note_count && strcmp(writer->notes[i].text, text) != 0)
        i++;
    if (i == LR_WRITER_NOTES_MAX)
        return;
    if (i == writer->note_count)
        writer->notes[writer->note_count++] = (lr_writer_note){.text = text};
    writer->notes[i].count++;
}

void lr_put_number(FILE *out, double value)
{
    char text[32];
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, value);
        if (strtod(text, NULL) == value)
            break;
    }
    fputs(text, out);
}

void lr_put_float(FILE *out, float value)
{
    char text[32];
    for (int digits = 6; digits <= 9; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, (double)value);
        if (strtof(text, NULL) == value)
            break;
    }
    fputs(text, out);
}

void lr_put_numbers(FILE *out, const double *values, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        fputs(i ? ", " : "", out);
        lr_put_number(out, values[i]);
    }
}

void lr_put_floats(FILE *out, const float *values, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        fputs(i ? ", " : "", out);
        lr_put_float(out, values[i]);
    }
}

void lr_put_origin(const lr_writer *writer, const char *mark)
{
    char shown[LR_SHOWN_MAX];
    const char *source = writer->scene->source, *slash = strrchr(source, '/');
    source = slash ? slash + 1 : source;
    fprintf(writer->out, "%s from %s, written by lavaray %s\n", mark,
            lr_shown(shown, source, strlen(source)), LR_VERSION);
}

bool lr_color_is_grey(lr_color color)
{
    return color.x == color.y && color.y == color.z;
}

double lr_color_greatest(lr_color color)
{
    double xy = color.x > color.y ? color.x : color.y;
    return xy > color.z ? xy : color.z;
}

void lr_camera_frame(const lr_scene *scene, const lr_camera *camera, lr_vec3 *forward,
                     lr_vec3 *right, lr_vec3 *up, double *half_height)
{
    *forward = lr_vec3_normalize(lr_vec3_sub(camera->to, camera->from));
    *right = lr_vec3_normalize(lr_vec3_cross(*forward, camera->up));
    *up = lr_vec3_cross(*right, *forward);
    double rows = scene->image.height;
    *half_height = lr_camera_pixel_size(camera, rows) * rows / 2;
}

const char *lr_side_path(const char *path, uint32_t number, const char *ending, char *buffer,
                         size_t size)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(path, '.');
    size_t stem = dot && dot > (slash ? slash + 1 : path) ? (size_t)(dot - path) : strlen(path);
    int length = snprintf(buffer, size, "%.*s-%u%s", (int)stem, path, (unsigned)number + 1, ending);
    return length > 0 && (size_t)length < size ? buffer : NULL;
}

const char *lr_texture_ending(const lr_texture *texture)
{
    struct stat info;
    const char *slash = strrchr(texture->name, '/'), *dot = strrchr(texture->name, '.');
    if (!dot || (slash && dot < slash) || stat(texture->name, &info) != 0 || !S_ISREG(info.st_mode))
        return NULL;
    return dot;
}

/* ---- Files --------------------------------------------------------------------------------- */

static const struct {
    const char *ending;
    lr_scene_format format;
} endings[] = {
    {".yaml", LR_SCENE_YAML},   {".yml", LR_SCENE_YAML},    {".pov", LR_SCENE_POVRAY},
    {".dat", LR_SCENE_TACHYON}, {".tac", LR_SCENE_TACHYON},
};

bool lr_scene_format_from_path(const char *path, lr_scene_format *format)
{
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot && i < sizeof endings / sizeof *endings; i++)
        if (strcasecmp(dot, endings[i].ending) == 0) {
            *format = endings[i].format;
            return true;
        }
    return false;
}

/* A file to be written. */
typedef struct output {
    char *path, *bytes;
    size_t size;
} output;

static void free_outputs(output *files, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        free(files[i].path);
        free(files[i].bytes);
    }
    free(files);
}

static bool exists(const char *path)
{
    struct stat info;
    return lstat(path, &info) == 0;
}

/* A file that is there already is replaced only along with the scene that it belongs to. */
static lr_status name_file(const char *path, uint32_t number, const char *ending, output *file,
                           lr_error *error)
{
    char name[4096];
    if (!lr_side_path(path, number, ending, name, sizeof name))
        return lr_fail(error, LR_ERROR_FILE, "%.500s: the name is too long", path);
    if (exists(name) && !exists(path))
        return lr_fail(error, LR_ERROR_FILE,
                       "%.500s: exists already and would be replaced by a part of %.300s; move it "
                       "or choose another name",
                       name, path);
    file->path = lr_string_copy(name, strlen(name));
    return file->path ? LR_OK : lr_fail(error, LR_ERROR_MEMORY, "out of memory for a file's name");
}

static lr_status make_mesh_file(const lr_scene *scene, const char *path, uint32_t mesh,
                                output *file, lr_error *error)
{
    lr_status status = name_file(path, mesh, ".ply", file, error);
    if (status == LR_OK && !(file->bytes = lr_mesh_ply(&scene->meshes[mesh], &file->size)))
        status = lr_fail(error, LR_ERROR_MEMORY, "out of memory for the file of a mesh");
    return status;
}

static lr_status make_texture_file(const lr_scene *scene, const char *path, uint32_t index,
                                   output *file, lr_error *error)
{
    const lr_texture *texture = &scene->textures[index];
    const char *ending = lr_texture_ending(texture);
    if (!ending)
        return LR_OK;
    lr_status status = name_file(path, index, ending, file, error);
    return status ? status
                  : lr_file_read(texture->name, SIZE_MAX / 2, &file->bytes, &file->size, error);
}

/* All files beside path are complete in memory before the first is written, for one of them may be
 * the picture that another one copies. */
static lr_status write_side_files(const lr_scene *scene, const char *path, lr_error *error)
{
    size_t count = (size_t)scene->mesh_count + scene->texture_count;
    output *files = lr_alloc(count, sizeof *files);
    if (!files)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for a scene's files");
    lr_status status = LR_OK;
    for (uint32_t i = 0; i < scene->mesh_count && status == LR_OK; i++)
        status = make_mesh_file(scene, path, i, &files[i], error);
    for (uint32_t i = 0; i < scene->texture_count && status == LR_OK; i++)
        status = make_texture_file(scene, path, i, &files[scene->mesh_count + i], error);
    for (size_t i = 0; i < count && status == LR_OK; i++)
        if (files[i].path)
            status = lr_file_write(files[i].path, files[i].bytes, files[i].size, error);
    free_outputs(files, count);
    return status;
}

/* ---- The text ------------------------------------------------------------------------------ */

/* A beginning of names that no material's name has. */
static void choose_names(lr_writer *writer)
{
    const lr_scene *scene = writer->scene;
    strcpy(writer->names, "material");
    for (uint32_t i = 0; i < scene->material_count; i++) {
        size_t length = strlen(writer->names);
        const char *name = scene->materials[i].name;
        if (name && strncmp(name, writer->names, length) == 0 &&
            length + 1 < sizeof writer->names) {
            memcpy(writer->names + length, "_", 2);
            i = UINT32_MAX; /* from the first on again */
        }
    }
}

static void put_scene(FILE *out, void *to)
{
    static void (*const writers[])(lr_writer *) = {
        [LR_SCENE_YAML] = lr_write_yaml,
        [LR_SCENE_POVRAY] = lr_write_povray,
        [LR_SCENE_TACHYON] = lr_write_tachyon,
    };
    lr_writer *writer = to;
    writer->out = out;
    choose_names(writer);
    if (writer->scene->moves)
        lr_writer_cannot(writer, "what moves is written as it is in this frame");
    writers[writer->format](writer);
}

/* NULL when there are none; sets *failed when memory is out. */
static char *notes_text(const lr_writer *writer, bool *failed)
{
    char *text = NULL;
    size_t length;
    FILE *out = writer->note_count ? open_memstream(&text, &length) : NULL;
    *failed = writer->note_count && !out;
    for (uint32_t i = 0; out && i < writer->note_count; i++)
        fprintf(out, "%s (%u)\n", writer->notes[i].text, (unsigned)writer->notes[i].count);
    if (out && fclose(out) != 0) {
        *failed = true;
        free(text);
        return NULL;
    }
    return text;
}

lr_status lr_scene_write(const lr_scene *scene, const char *path, lr_scene_format format,
                         char **notes, lr_error *error)
{
    lr_writer writer = {.scene = scene, .path = path, .format = format};
    size_t length;
    bool failed = false;
    *notes = NULL;
    char *text = lr_written(put_scene, &writer, &length);
    if (text)
        *notes = notes_text(&writer, &failed);
    if (!text || failed) {
        free(text);
        return lr_fail(error, LR_ERROR_MEMORY, "%.500s: out of memory while writing", path);
    }
    lr_status status = LR_OK;
    if (format == LR_SCENE_YAML)
        status = write_side_files(scene, path, error);
    if (status == LR_OK)
        status = lr_file_write(path, text, length, error);
    free(text);
    if (status != LR_OK) {
        free(*notes);
        *notes = NULL;
    }
    return status;
}
