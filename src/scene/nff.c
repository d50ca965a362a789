#include "scene/nff.h"

#include <math.h>
#include <string.h>
#include <strings.h>

#include "scene/nff_mesh.h"
#include "scene/nff_text.h"
#include "scene/read.h"

/* Rays of five generations: the eye's and four bounces. The format leaves it to the program. */
#define DEPTH 4

#define COORDINATE -LR_COORDINATE_MAX, LR_COORDINATE_MAX
#define COLOR 0, LR_COLOR_MAX
#define XYZ(name)                                                                                  \
    {"x of " name, COORDINATE}, {"y of " name, COORDINATE},                                        \
    {                                                                                              \
        "z of " name, COORDINATE                                                                   \
    }
#define RGB                                                                                        \
    {"red", COLOR}, {"green", COLOR},                                                              \
    {                                                                                              \
        "blue", COLOR                                                                              \
    }

/* The values of an `f` line, which make two materials the same or not. */
typedef struct fill {
    double red, green, blue, diffuse, specular, shine, transmit, ior;
} fill;

typedef struct nff_reader {
    lr_nff_text text;
    lr_scene_builder builder;
    lr_nff_parts parts;
    lr_rows fills;      /* of the materials, in their order */
    uint32_t material;  /* of the latest `f`; LR_NONE: none yet */
    lr_nff_count empty; /* spheres and cones without a size */
    bool has_view, has_object, told_fill;
} nff_reader;

static lr_vec3 vec3_of(const double values[3])
{
    return (lr_vec3){values[0], values[1], values[2]};
}

/* Adds an error at a word that has been read. */
static void report_at(nff_reader *reader, const lr_nff_word *at, const char *message)
{
    lr_report *report = reader->text.report;
    lr_report_add(report, (size_t)(at->text - report->text), "%s", message);
}

static bool out_of_memory(nff_reader *reader)
{
    reader->text.report->no_memory = true;
    return false;
}

/* ---- Surroundings -------------------------------------------------------------------------- */

typedef struct view_item {
    const char *keyword;
    uint32_t count;
    lr_nff_number numbers[3];
} view_item;

enum { FROM, AT, UP, ANGLE, HITHER, RESOLUTION, VIEW_ITEMS };

static const view_item view_items[VIEW_ITEMS] = {
    {"from", 3, {XYZ("from")}},
    {"at", 3, {XYZ("at")}},
    {"up", 3, {XYZ("up")}},
    {"angle", 1, {{"angle", 1e-6, 179.999}}},
    {"hither", 1, {{"hither distance", COORDINATE}}},
    {"resolution", 2, {{"width", 1, 32768}, {"height", 1, 32768}}},
};

static bool read_view_items(nff_reader *reader, double values[VIEW_ITEMS][3])
{
    lr_nff_text *text = &reader->text;
    for (int i = 0; i < VIEW_ITEMS; i++) {
        const view_item *item = &view_items[i];
        char shown[LR_SHOWN_MAX];
        if (!lr_nff_word_is(&text->word, item->keyword)) {
            lr_nff_report(text, "%s, expected \"%s\" in the viewpoint",
                          text->word.length ? lr_shown(shown, text->word.text, text->word.length)
                                            : "the file ends",
                          item->keyword);
            return false;
        }
        lr_nff_step(text);
        if (!lr_nff_read_numbers(text, "viewpoint", item->numbers, item->count, values[i]))
            return false;
    }
    return true;
}

static bool read_view(nff_reader *reader, const lr_nff_word *at)
{
    lr_scene *scene = reader->builder.scene;
    double values[VIEW_ITEMS][3] = {{0}};
    if (!read_view_items(reader, values))
        return false;
    lr_vec3 from = vec3_of(values[FROM]), to = vec3_of(values[AT]), up = vec3_of(values[UP]);
    lr_vec3 view = lr_vec3_sub(to, from);
    double width = values[RESOLUTION][0], height = values[RESOLUTION][1];
    const char *wrong = NULL;
    if (scene->camera_count)
        wrong = "a second viewpoint, expected one in a file";
    else if (!(lr_vec3_length(view) >= LR_LENGTH_MIN))
        wrong = "from and at are the same point, expected two";
    else if (lr_parallel(view, up))
        wrong = "up is zero or lies along the view, expected another direction";
    else if (width != floor(width) || height != floor(height))
        wrong = "the resolution is no whole number of pixels";
    if (wrong) {
        report_at(reader, at, wrong);
        return false;
    }
    lr_camera *camera = lr_scene_add_camera(&reader->builder);
    if (!camera)
        return out_of_memory(reader);
    *camera = (lr_camera){.line = at->line,
                          .from = from,
                          .to = to,
                          .up = up,
                          .fov = values[ANGLE][0],
                          .fov_to_centers = true};
    scene->background_up = lr_vec3_normalize(up);
    scene->image.width = (uint32_t)width;
    scene->image.height = (uint32_t)height;
    return true;
}

static bool read_background(nff_reader *reader, const lr_nff_word *at)
{
    static const lr_nff_number numbers[] = {RGB};
    double values[3];
    (void)at;
    if (!lr_nff_read_numbers(&reader->text, "background", numbers, 3, values))
        return false;
    lr_scene *scene = reader->builder.scene;
    scene->background.colors[0] = scene->background.colors[1] = vec3_of(values);
    return true;
}

/* An intensity of -1 marks a light without a colour until all are counted. */
static bool read_light(nff_reader *reader, const lr_nff_word *at)
{
    static const lr_nff_number place[] = {XYZ("the position")}, color[] = {RGB};
    double position[3], rgb[3] = {1, 1, 1};
    lr_nff_text *text = &reader->text;
    if (!lr_nff_read_numbers(text, "light", place, 3, position))
        return false;
    bool colored = lr_nff_at_number(text);
    if (colored && !lr_nff_read_numbers(text, "light", color, 3, rgb))
        return false;
    if (reader->builder.scene->light_count == LR_LIGHTS_MAX) {
        lr_nff_report(text, "more than %d lights", LR_LIGHTS_MAX);
        return false;
    }
    lr_light *light = lr_scene_add_light(&reader->builder);
    if (!light)
        return out_of_memory(reader);
    *light = (lr_light){.kind = LR_LIGHT_POINT,
                        .line = at->line,
                        .color = vec3_of(rgb),
                        .intensity = colored ? 1 : -1,
                        .position = vec3_of(position),
                        .shadows = true};
    return true;
}

/* n lights without a colour shine as sqrt(n) together: sqrt(n) / n each. */
static void complete_lights(lr_scene *scene)
{
    double n = scene->light_count;
    for (uint32_t i = 0; i < scene->light_count; i++)
        if (scene->lights[i].intensity < 0)
            scene->lights[i].intensity = sqrt(n) / n;
    scene->default_light = scene->light_count == 0;
}

/* ---- Materials ----------------------------------------------------------------------------- */

static bool add_material(nff_reader *reader, const fill *f, uint32_t line)
{
    lr_material *m = lr_scene_add_material(&reader->builder);
    if (!m)
        return out_of_memory(reader);
    lr_color color = {f->red, f->green, f->blue};
    *m = (lr_material){
        .line = line,
        .color = {.colors = {color, color}, .size = 1, .direction = {0, 1, 0}},
        .diffuse = {f->diffuse, f->diffuse, f->diffuse},
        .specular = {f->specular, f->specular, f->specular},
        .reflect = {f->specular, f->specular, f->specular},
        .transmit = {f->transmit, f->transmit, f->transmit},
        .shininess = f->shine,
        .highlight = LR_HIGHLIGHT_PHONG,
        .ior = f->ior,
    };
    return true;
}

static bool read_fill(nff_reader *reader, const lr_nff_word *at)
{
    static const lr_nff_number numbers[] = {
        RGB,
        {"diffuse component", 0, LR_COLOR_MAX},
        {"specular component", 0, 1},
        {"shine", 0, 1e6},
        {"transmittance", 0, 1},
    };
    static const lr_nff_number ior = {"index of refraction", 0.01, 100};
    static const lr_nff_number unused = {"index of refraction", COORDINATE};
    lr_nff_text *text = &reader->text;
    double v[8];
    if (!lr_nff_read_numbers(text, "fill colour", numbers, 7, v) ||
        !lr_nff_read_numbers(text, "fill colour", v[6] > 0 ? &ior : &unused, 1, &v[7]))
        return false;
    /* + 0 makes -0 the 0 that it equals. */
    fill f = {v[0] + 0, v[1] + 0, v[2] + 0, v[3] + 0, v[4] + 0, v[5] + 0, v[6] + 0, v[7]};
    if (f.transmit == 0)
        f.ior = 1;
    uint32_t index = lr_rows_put(&reader->fills, &f);
    if (index == LR_NONE)
        return out_of_memory(reader);
    if (index >= LR_MATERIALS_MAX) {
        lr_nff_report(text, "more than %d different fill colours", LR_MATERIALS_MAX);
        return false;
    }
    reader->material = index;
    if (index < reader->builder.scene->material_count)
        return true;
    return add_material(reader, &f, at->line);
}

/* ---- Objects ------------------------------------------------------------------------------- */

/* Whether there is a material for the object; told for the first that has none. */
static bool check_material(nff_reader *reader, const lr_nff_word *at)
{
    if (reader->material != LR_NONE)
        return true;
    if (!reader->told_fill)
        report_at(reader, at,
                  "an object before the first fill colour, expected a line such as "
                  "`f 1 1 1 0.8 0 10 0 1` before it");
    reader->told_fill = true;
    return false;
}

static lr_object *add_object(nff_reader *reader, lr_object_kind kind, uint32_t line)
{
    lr_object *object = lr_scene_add_object(&reader->builder);
    if (!object)
        return NULL;
    object->kind = kind;
    object->material = reader->material;
    object->line = line;
    object->shadow = true;
    object->to_world = lr_transform_identity();
    return object;
}

/* Whether a negative radius hides the outside: transmitting surfaces have two sides. */
static bool is_inward(const nff_reader *reader, double radius)
{
    return radius < 0 && reader->builder.scene->materials[reader->material].transmit.x == 0;
}

static bool read_sphere(nff_reader *reader, const lr_nff_word *at)
{
    static const lr_nff_number numbers[] = {XYZ("the centre"), {"radius", COORDINATE}};
    double v[4];
    if (!lr_nff_read_numbers(&reader->text, "sphere", numbers, 4, v) || !check_material(reader, at))
        return false;
    if (fabs(v[3]) < LR_LENGTH_MIN) {
        lr_nff_add_count(&reader->empty, at->line);
        return true;
    }
    lr_object *object = add_object(reader, LR_SPHERE, at->line);
    if (!object)
        return out_of_memory(reader);
    object->inward = is_inward(reader, v[3]);
    object->sphere.center = vec3_of(v);
    object->sphere.radius = fabs(v[3]);
    return true;
}

static bool read_cone(nff_reader *reader, const lr_nff_word *at)
{
    static const lr_nff_number numbers[] = {
        XYZ("the base"), {"base radius", COORDINATE}, XYZ("the apex"), {"apex radius", COORDINATE}};
    double v[8];
    if (!lr_nff_read_numbers(&reader->text, "cone", numbers, 8, v) || !check_material(reader, at))
        return false;
    lr_vec3 from = vec3_of(v), to = vec3_of(v + 4);
    double radius = fmax(fabs(v[3]), fabs(v[7]));
    if ((v[3] < 0 && v[7] > 0) || (v[3] > 0 && v[7] < 0)) {
        report_at(reader, at,
                  "one of the cone's radii is positive and one negative, expected both positive "
                  "(seen from outside) or both negative (from inside)");
        return false;
    }
    if (radius < LR_LENGTH_MIN || !(lr_vec3_length(lr_vec3_sub(to, from)) >= LR_LENGTH_MIN)) {
        lr_nff_add_count(&reader->empty, at->line);
        return true;
    }
    lr_object *object = add_object(reader, v[3] == v[7] ? LR_CYLINDER : LR_CONE, at->line);
    if (!object)
        return out_of_memory(reader);
    object->open = true;
    object->inward = is_inward(reader, fmin(v[3], v[7]));
    object->cone.from = from;
    object->cone.to = to;
    object->cone.radius_from = fabs(v[3]);
    object->cone.radius_to = fabs(v[7]);
    return true;
}

static bool read_corners(nff_reader *reader, const lr_nff_word *at, bool patch)
{
    static const lr_nff_number counts = {"number of vertices", 3, LR_POLYGON_CORNERS_MAX};
    static const lr_nff_number numbers[] = {XYZ("a vertex"), XYZ("a normal")};
    lr_polygon *polygon = reader->parts.polygon;
    lr_nff_word before = reader->text.word;
    double count;
    if (!lr_nff_read_numbers(&reader->text, "polygon", &counts, 1, &count))
        return false;
    if (count != floor(count)) {
        report_at(reader, &before, "the number of vertices is no whole number");
        return false;
    }
    polygon->count = (uint32_t)count;
    for (uint32_t i = 0; i < polygon->count; i++) {
        double v[6];
        if (!lr_nff_read_numbers(&reader->text, "polygon", numbers, patch ? 6 : 3, v))
            return false;
        polygon->corners[i] = vec3_of(v);
        if (patch)
            (*reader->parts.normals)[i] = vec3_of(v + 3);
    }
    if (!check_material(reader, at))
        return false;
    return lr_nff_add_polygon(&reader->parts, reader->material, patch, at->line) ||
           out_of_memory(reader);
}

static bool read_polygon(nff_reader *reader, const lr_nff_word *at)
{
    return read_corners(reader, at, false);
}

static bool read_patch(nff_reader *reader, const lr_nff_word *at)
{
    return read_corners(reader, at, true);
}

/* ---- The text ------------------------------------------------------------------------------ */

typedef struct entity {
    const char *keyword;
    bool (*read)(nff_reader *reader, const lr_nff_word *at);
    bool is_object;
} entity;

static const entity entities[] = {
    {"v", read_view, false},   {"b", read_background, false}, {"l", read_light, false},
    {"f", read_fill, false},   {"s", read_sphere, true},      {"c", read_cone, true},
    {"p", read_polygon, true}, {"pp", read_patch, true},
};

static const entity *find_entity(const lr_nff_word *word)
{
    for (size_t i = 0; i < sizeof entities / sizeof *entities; i++)
        if (lr_nff_word_is(word, entities[i].keyword))
            return &entities[i];
    return NULL;
}

/* To where reading can go on after an error: the next line that begins with a keyword. */
static void skip(nff_reader *reader)
{
    lr_nff_text *text = &reader->text;
    while (text->word.length && !(text->word.leads && find_entity(&text->word)))
        lr_nff_step(text);
}

static void read_entities(nff_reader *reader)
{
    lr_nff_text *text = &reader->text;
    while (text->word.length && !text->report->no_memory) {
        lr_nff_word at = text->word;
        const entity *e = find_entity(&at);
        if (!e) {
            char shown[LR_SHOWN_MAX];
            lr_nff_report(text, "%s, expected one of v, b, l, f, s, c, p, pp or a # comment",
                          lr_shown(shown, at.text, at.length));
            skip(reader);
            continue;
        }
        reader->has_view |= e->read == read_view;
        reader->has_object |= e->is_object;
        lr_nff_step(text);
        if (!e->read(reader, &at))
            skip(reader);
    }
}

static bool note_counts(nff_reader *reader)
{
    const lr_nff_parts *parts = &reader->parts;
    const struct {
        const lr_nff_count *count;
        const char *what;
    } notes[] = {
        {&parts->flattened, "polygons without an area, left out"},
        {&parts->crossing, "polygons that cross themselves, whose triangles may overlap"},
        {&parts->vanished, "triangles too small for single precision, left out"},
        {&parts->turned, "normals of length 0, replaced by their polygon's"},
        {&reader->empty, "spheres and cones without a size, left out"},
    };
    lr_scene *scene = reader->builder.scene;
    for (size_t i = 0; i < sizeof notes / sizeof *notes; i++)
        if (notes[i].count->count &&
            !lr_scene_add_note(&reader->builder, "%.300s:%u: %s: %u from here on", scene->source,
                               (unsigned)notes[i].count->line, notes[i].what,
                               (unsigned)notes[i].count->count))
            return false;
    return !scene->default_light ||
           lr_scene_add_note(&reader->builder, "%.300s: no lights, one that suits the camera added",
                             scene->source);
}

/* What can be said only at the end. */
static void complete(nff_reader *reader)
{
    lr_scene *scene = reader->builder.scene;
    lr_report *report = reader->text.report;
    complete_lights(scene);
    if (!lr_nff_add_meshes(&reader->parts, &reader->builder) || !note_counts(reader))
        out_of_memory(reader);
    if (!reader->has_view)
        lr_report_add(report, 0,
                      "the file has no viewpoint, expected a line \"v\" and those of "
                      "from, at, up, angle, hither, resolution");
    if (!reader->has_object)
        lr_report_add(report, report->length, "the file has no object, expected s, c, p or pp");
    else if (scene->object_count == 0 && !lr_report_failed(report))
        lr_report_add(report, report->length,
                      "all objects of the file have no size, expected one that can be seen");
}

static void read_text(lr_scene *scene, lr_report *report, const lr_load_options *options)
{
    (void)options; /* NFF names no files */
    nff_reader reader = {
        .text = {.report = report},
        .builder = {.scene = scene},
        .fills = {.size = sizeof(fill)},
        .material = LR_NONE,
    };
    scene->image.samples = 1;
    scene->image.depth = DEPTH;
    reader.text.locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (!reader.text.locale || !lr_nff_parts_init(&reader.parts)) {
        out_of_memory(&reader);
    } else {
        lr_nff_start(&reader.text);
        read_entities(&reader);
        complete(&reader);
    }
    if (reader.text.locale)
        freelocale(reader.text.locale);
    lr_nff_parts_free(&reader.parts);
    lr_rows_free(&reader.fills);
}

bool lr_nff_is_path(const char *path)
{
    const char *end = strrchr(path, '.');
    return end && strcasecmp(end, ".nff") == 0;
}

static const lr_language nff_language = {
    .subject = "scene",
    .examples = "v and f",
    .relief = "split it",
};

lr_status lr_nff_read(const char *text, size_t length, const char *name, lr_scene **scene,
                      char **report, lr_error *error)
{
    return lr_scene_from_text(text, length, name, &nff_language, NULL, read_text, scene, report,
                              error);
}
