/* The scene language, from the same tables of keys that its reader uses: what equals a default is
 * left out. */
#include <string.h>
#include <strings.h>

#include "scene/camera.h"
#include "scene/keys.h"
#include "scene/models.h"
#include "scene/report.h"
#include "scene/write.h"

/* A mapping in braces being written. */
typedef struct mapping {
    FILE *out;
    bool begun;
} mapping;

static void put_key(mapping *map, const char *key)
{
    fprintf(map->out, "%s%s: ", map->begun ? ", " : "{", key);
    map->begun = true;
}

static void end_mapping(mapping *map)
{
    fputs(map->begun ? "}" : "{}", map->out);
}

/* As it is where YAML cannot take it for anything else, otherwise as JSON writes it. */
static void put_text(FILE *out, const char *text)
{
    static const char *const words[] = {"null", "true", "false", "yes", "no",
                                        "on",   "off",  "y",     "n"};
    const char *safe = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
    bool plain = text[0] && !strchr("0123456789_-", text[0]) && strspn(text, safe) == strlen(text);
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        plain = plain && strcasecmp(text, words[i]) != 0;
    if (plain) {
        fputs(text, out);
        return;
    }
    fputc('"', out);
    for (const char *c = text; *c; c++)
        if (*c == '"' || *c == '\\')
            fprintf(out, "\\%c", *c);
        else if ((unsigned char)*c < 0x20 || *c == 0x7F)
            fprintf(out, "\\u%04X", (unsigned)*c);
        else
            fputc(*c, out);
    fputc('"', out);
}

static void put_vector(FILE *out, const double *values, uint32_t count)
{
    fputc('[', out);
    lr_put_numbers(out, values, count);
    fputc(']', out);
}

static void put_color(FILE *out, lr_color color)
{
    if (lr_color_is_grey(color))
        lr_put_number(out, color.x);
    else
        put_vector(out, &color.x, 3);
}

static void put_colors(FILE *out, const lr_color colors[2])
{
    /* Lists, for a number would do as a colour but not be seen to be one. */
    fputc('[', out);
    put_vector(out, &colors[0].x, 3);
    fputs(", ", out);
    put_vector(out, &colors[1].x, 3);
    fputc(']', out);
}

/* Whether the stored value stands for one that other keys decide: 0, where the field itself begins
 * above it. */
static bool is_left_open(const lr_field *field, const void *value)
{
    if (field->type == LR_FIELD_INTEGER)
        return field->minimum > 0 && *(const uint32_t *)value == 0;
    return field->type == LR_FIELD_NUMBER && *(const double *)value == 0 &&
           (field->minimum > 0 || (field->minimum == 0 && field->flags & LR_ABOVE));
}

/* Whether the stored value is the field's default. */
static bool is_default(const lr_field *field, const void *value)
{
    const double *d = field->fallback, *v = value;
    if (field->flags & LR_DERIVED)
        return is_left_open(field, value);
    if (field->flags & LR_REQUIRED)
        return false;
    switch (field->type) {
    case LR_FIELD_NUMBER:
        return *v == d[0];
    case LR_FIELD_INTEGER:
    case LR_FIELD_CHOICE:
        return *(const uint32_t *)value == (uint32_t)(int64_t)d[0];
    case LR_FIELD_BOOLEAN:
        return *(const bool *)value == (d[0] != 0);
    case LR_FIELD_VECTOR:
    case LR_FIELD_COLOR:
        return v[0] == d[0] && v[1] == d[1] && v[2] == d[2];
    default:
        return false;
    }
}

static void put_value(FILE *out, const lr_field *field, const void *value)
{
    switch (field->type) {
    case LR_FIELD_NUMBER:
        lr_put_number(out, *(const double *)value);
        break;
    case LR_FIELD_INTEGER:
        if (field->minimum < 0)
            fprintf(out, "%d", (int)*(const int32_t *)value);
        else
            fprintf(out, "%u", (unsigned)*(const uint32_t *)value);
        break;
    case LR_FIELD_BOOLEAN:
        fputs(*(const bool *)value ? "true" : "false", out);
        break;
    case LR_FIELD_CHOICE:
        fputs(field->choices[*(const uint32_t *)value], out);
        break;
    case LR_FIELD_VECTOR:
        put_vector(out, value, 3);
        break;
    case LR_FIELD_COLOR:
        put_color(out, *(const lr_color *)value);
        break;
    case LR_FIELD_COLORS:
        put_colors(out, value);
        break;
    default:
        break;
    }
}

/* Whether the tables store the field's value as the language writes it; transforms are written as
 * a matrix. */
static bool is_written(const lr_field *field)
{
    return field->type <= LR_FIELD_COLORS;
}

/* A field of a record, unless it is a default. */
static void put_field(mapping *map, const lr_field *field, const void *base)
{
    const void *value = (const char *)base + field->offset;
    if (!is_written(field) || is_default(field, value))
        return;
    put_key(map, field->name);
    put_value(map->out, field, value);
}

/* The fields of a record; `left_out` is one that another one says. */
static void put_record(mapping *map, const lr_record *record, const void *base,
                       const char *left_out)
{
    for (uint32_t i = 0; i < record->count; i++)
        if (!left_out || strcmp(record->fields[i].name, left_out) != 0)
            put_field(map, &record->fields[i], base);
}

static bool same_numbers(const lr_field *field, const void *a, const void *b)
{
    size_t count = field->type == LR_FIELD_VECTOR ? 3 : field->type == LR_FIELD_NUMBER ? 1 : 0;
    const double *x = a, *y = b;
    bool same = true;
    for (size_t i = 0; i < count; i++)
        same = same && x[i] == y[i];
    return same;
}

/* A value that is another one at a later frame. */
static void put_moving(mapping *map, const lr_field *field, const void *value, double frame,
                       const void *later)
{
    put_key(map, field->name);
    fputs("{keys: {0: ", map->out);
    put_value(map->out, field, value);
    fputs(", ", map->out);
    lr_put_number(map->out, frame);
    fputs(": ", map->out);
    put_value(map->out, field, later);
    fputs("}}", map->out);
}

static const lr_record *record_of(const lr_record *records, uint32_t count, int kind)
{
    for (uint32_t i = 0; i < count; i++)
        if (records[i].kind == kind)
            return &records[i];
    return NULL;
}

/* ---- The parts ----------------------------------------------------------------------------- */

void lr_put_camera(FILE *out, const lr_camera *camera)
{
    mapping map = {.out = out};
    lr_camera closing = lr_camera_closing(camera);
    for (uint32_t i = 0; i < lr_camera_record.count; i++) {
        const lr_field *field = &lr_camera_record.fields[i];
        const void *value = (const char *)camera + field->offset;
        const void *later = (const char *)&closing + field->offset;
        if (!same_numbers(field, value, later))
            put_moving(&map, field, value, camera->shutter, later);
        else
            put_field(&map, field, camera);
    }
    end_mapping(&map);
}

static void put_camera_entry(FILE *out, void *entry)
{
    const lr_camera *camera = entry;
    if (camera->name) {
        fputs("  ", out);
        put_text(out, camera->name);
        fputs(": ", out);
    } else {
        fputs("camera: ", out);
    }
    lr_put_camera(out, camera);
    fputc('\n', out);
}

char *lr_camera_text(const lr_camera *camera)
{
    lr_camera entry = *camera;
    size_t length;
    return lr_written(put_camera_entry, &entry, &length);
}

static void put_cameras(lr_writer *writer)
{
    const lr_scene *scene = writer->scene;
    fputs(scene->cameras[0].name ? "cameras:\n" : "", writer->out);
    for (uint32_t i = 0; i < scene->camera_count; i++)
        put_camera_entry(writer->out, &scene->cameras[i]);
}

static void put_file_name(lr_writer *writer, uint32_t number, const char *ending)
{
    char path[4096];
    const char *name = lr_side_path(writer->path, number, ending, path, sizeof path);
    const char *slash = name ? strrchr(name, '/') : NULL;
    put_text(writer->out, slash ? slash + 1 : name ? name : "");
}

static void put_background(lr_writer *writer)
{
    const lr_background *background = &writer->scene->background;
    lr_background_draft draft = {.background = *background};
    mapping map = {.out = writer->out};
    if (background->kind == LR_BACKGROUND_GRADIENT &&
        lr_colors_equal(background->colors[0], background->colors[1])) {
        put_color(writer->out, background->colors[0]);
        return;
    }
    if (background->kind == LR_BACKGROUND_IMAGE) {
        put_key(&map, "image");
        put_file_name(writer, background->texture,
                      lr_texture_ending(&writer->scene->textures[background->texture]));
    }
    put_record(&map,
               record_of(lr_background_records, lr_background_record_count, (int)background->kind),
               &draft, NULL);
    end_mapping(&map);
}

static void put_surroundings(lr_writer *writer)
{
    const lr_scene *scene = writer->scene;
    FILE *out = writer->out;
    mapping image = {.out = out}, fog = image, air = image;
    fputs("image: ", out);
    put_record(&image, &lr_image_record, scene, NULL);
    end_mapping(&image);
    fputs("\nambient: ", out);
    put_color(out, scene->ambient);
    fputs("\nbackground: ", out);
    put_background(writer);
    fputs("\nup: ", out);
    put_vector(out, &scene->background_up.x, 3);
    fputc('\n', out);
    if (scene->fog_density > 0) {
        fputs("fog: ", out);
        put_record(&fog, &lr_fog_record, scene, NULL);
        end_mapping(&fog);
        fputc('\n', out);
    }
    if (!lr_color_is_black(scene->air.absorption) || !lr_color_is_black(scene->air.scattering)) {
        fputs("air: ", out);
        put_record(&air, &lr_air_record, scene, NULL);
        end_mapping(&air);
        fputc('\n', out);
    }
}

/* NULL when the texture is in no file of its own. */
static const char *picture_ending(lr_writer *writer, const lr_texture *texture)
{
    const char *ending = lr_texture_ending(texture);
    if (!ending)
        lr_writer_cannot(writer, "pictures inside of models are not written, only their tint is");
    else if (texture->wrap_u != texture->wrap_v)
        lr_writer_cannot(writer, "pictures that go on in two ways are written with one of them");
    return ending;
}

/* False when the texture is in no file of its own. */
static bool put_picture(lr_writer *writer, const lr_pattern *pattern, const lr_record *record)
{
    const lr_texture *texture = &writer->scene->textures[pattern->texture];
    const char *ending = picture_ending(writer, texture);
    if (!ending)
        return false;
    mapping map = {.out = writer->out};
    lr_pattern_draft draft = {.pattern = *pattern, .wrap = (uint32_t)texture->wrap_u};
    put_key(&map, "image");
    put_file_name(writer, pattern->texture, ending);
    put_record(&map, record, &draft, NULL);
    end_mapping(&map);
    return true;
}

static void put_paint(lr_writer *writer, const lr_pattern *pattern)
{
    const lr_record *record =
        record_of(lr_pattern_records, lr_pattern_record_count, (int)pattern->kind);
    bool picture = pattern->kind == LR_PATTERN_IMAGE;
    if (picture && put_picture(writer, pattern, record))
        return;
    if (picture || pattern->kind == LR_PATTERN_NONE) {
        put_color(writer->out, pattern->colors[0]);
        return;
    }
    mapping map = {.out = writer->out};
    lr_pattern_draft draft = {.pattern = *pattern, .space = pattern->object_space};
    draft.to = lr_vec3_add(pattern->origin, pattern->direction);
    put_record(&map, record, &draft, NULL);
    end_mapping(&map);
}

/* The keys that the model has, but for those that `metal` says. */
static void put_properties(mapping *map, const lr_material *material)
{
    const lr_record *record = &lr_material_record;
    for (uint32_t i = 0; i < record->count; i++) {
        const char *name = record->fields[i].name;
        bool index = strcmp(name, "eta") == 0 || strcmp(name, "k") == 0;
        if (lr_model_has_key(material->model, name) && !(index && material->metal))
            put_field(map, &record->fields[i], material);
        /* Glass has another default than the table says. */
        if (strcmp(name, "transmit") == 0 && lr_model_is_glass(material->model) &&
            lr_colors_equal(material->transmit, (lr_color){0, 0, 0})) {
            put_key(map, name);
            put_color(map->out, material->transmit);
        }
    }
}

/* The pictures that are not the colour. */
static void put_maps(lr_writer *writer, mapping *map, const lr_material *material)
{
    for (int i = 0; i < LR_MAP_COUNT; i++) {
        const lr_map *m = &material->maps[i];
        if (!m->given)
            continue;
        const lr_texture *texture = &writer->scene->textures[m->texture];
        const char *ending = picture_ending(writer, texture);
        if (!ending)
            continue;
        lr_map_draft draft = {.map = *m, .wrap = (uint32_t)texture->wrap_u};
        mapping inner = {.out = writer->out};
        put_key(map, lr_map_records[i].name);
        put_key(&inner, "image");
        put_file_name(writer, m->texture, ending);
        put_record(&inner, &lr_map_records[i], &draft, NULL);
        end_mapping(&inner);
    }
}

static void put_material_name(lr_writer *writer, uint32_t index)
{
    const char *name = writer->scene->materials[index].name;
    if (name)
        put_text(writer->out, name);
    else
        fprintf(writer->out, "%s%u", writer->names, (unsigned)index + 1);
}

/* The keys that are no single numbers or colours. */
static void put_paints(lr_writer *writer, mapping *map, const lr_material *material)
{
    if (lr_model_has_key(material->model, "color")) {
        put_key(map, "color");
        put_paint(writer, &material->color);
    }
    if (material->model != LR_MODEL_MIX)
        return;
    put_key(map, "first");
    put_material_name(writer, material->mix.first);
    put_key(map, "second");
    put_material_name(writer, material->mix.second);
    put_key(map, "weight");
    put_paint(writer, &material->mix.weight);
}

static void put_materials(lr_writer *writer)
{
    const lr_scene *scene = writer->scene;
    fputs(scene->material_count ? "materials:\n" : "", writer->out);
    for (uint32_t i = 0; i < scene->material_count; i++) {
        mapping map = {.out = writer->out};
        fputs("  ", writer->out);
        put_material_name(writer, i);
        fputs(": ", writer->out);
        put_paints(writer, &map, &scene->materials[i]);
        put_properties(&map, &scene->materials[i]);
        put_maps(writer, &map, &scene->materials[i]);
        end_mapping(&map);
        fputc('\n', writer->out);
    }
}

static void put_lights(lr_writer *writer)
{
    const lr_scene *scene = writer->scene;
    if (scene->default_light)
        return;
    bool any = false;
    for (uint32_t i = 0; i < scene->light_count; i++) {
        const lr_light *light = &scene->lights[i];
        if (lr_light_is_black(light)) /* imported so: the language refuses them */
            continue;
        fputs(any ? "" : "lights:\n", writer->out);
        any = true;
        const lr_record *record =
            record_of(lr_light_records, lr_light_record_count, (int)light->kind);
        lr_light_draft draft = {.light = *light};
        mapping map = {.out = writer->out};
        fprintf(writer->out, "  - %s: ", record->name);
        put_record(&map, record, &draft, "to");
        end_mapping(&map);
        fputc('\n', writer->out);
    }
    if (!any)
        fputs("lights: []\n", writer->out);
}

static void put_matrix(mapping *map, const lr_transform *t)
{
    put_key(map, "matrix");
    for (int i = 0; i < 3; i++) {
        fputs(i ? ", " : "[", map->out);
        put_vector(map->out, t->m[i], 4);
    }
    fputc(']', map->out);
}

static void put_object(lr_writer *writer, const lr_object *object)
{
    const lr_record *record =
        record_of(lr_object_records, lr_object_record_count, (int)object->kind);
    lr_object_draft draft = {.object = *object};
    mapping map = {.out = writer->out};
    bool is_mesh = object->kind == LR_MESH;
    fprintf(writer->out, "  - %s: ", record->name);
    if (is_mesh) {
        put_key(&map, "file");
        put_file_name(writer, object->mesh, ".ply");
    }
    put_record(&map, record, &draft, NULL);
    put_key(&map, "material");
    put_material_name(writer, object->material);
    if (object->transformed)
        put_matrix(&map, &object->to_world);
    if (object->inward)
        lr_writer_cannot(writer, "objects of which only the inside shows are written with both");
    end_mapping(&map);
    fputc('\n', writer->out);
}

void lr_write_yaml(lr_writer *writer)
{
    const lr_scene *scene = writer->scene;
    lr_put_origin(writer, "#");
    fputs("lavaray: 1\n", writer->out);
    put_cameras(writer);
    put_surroundings(writer);
    put_materials(writer);
    put_lights(writer);
    fputs("objects:\n", writer->out);
    for (uint32_t i = 0; i < scene->object_count; i++)
        put_object(writer, &scene->objects[i]);
}
