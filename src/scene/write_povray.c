/* POV-Ray 3.7. Its world may be right-handed like ours, because the camera is given as vectors. Its
 * pigments are scaled by 1 - transmit, so what is matt is divided by that. */
#include "scene/write.h"

/* A parallel light's distance from the origin; only its direction matters. */
#define FAR_AWAY 1e6

static void put_vector(FILE *out, lr_vec3 v)
{
    fputc('<', out);
    lr_put_numbers(out, &v.x, 3);
    fputc('>', out);
}

static void put_rgb(FILE *out, lr_color color)
{
    fputs("rgb ", out);
    put_vector(out, color);
}

/* ---- Surroundings -------------------------------------------------------------------------- */

static void put_camera(lr_writer *writer)
{
    const lr_scene *scene = writer->scene;
    const lr_camera *camera = &scene->cameras[0];
    FILE *out = writer->out;
    lr_vec3 forward, right, up;
    double half_height;
    lr_camera_frame(scene, camera, &forward, &right, &up, &half_height);
    double aspect = (double)scene->image.width / scene->image.height;
    fputs("camera {\n  location ", out);
    put_vector(out, camera->from);
    fputs("\n  direction ", out);
    put_vector(out, forward);
    fputs("\n  right ", out);
    put_vector(out, lr_vec3_scale(right, 2 * half_height * aspect));
    fputs("\n  up ", out);
    put_vector(out, lr_vec3_scale(up, 2 * half_height));
    fputs("\n}\n", out);
    if (camera->projection != LR_PERSPECTIVE)
        lr_writer_cannot(writer,
                         "the camera's projection is left out, it is written as perspective");
    if (camera->aperture > 0)
        lr_writer_cannot(writer, "the camera's lens is left out, everything is in focus");
    if (camera->moves)
        lr_writer_cannot(writer, "the blur of the moving camera is left out");
    for (uint32_t i = 1; i < scene->camera_count; i++)
        lr_writer_cannot(writer, "cameras beside the first are left out");
}

/* The expression u . (p - origin) of a point p = (x, y, z). */
static void put_dot(FILE *out, lr_vec3 u, lr_vec3 origin)
{
    fputs("((x-(", out);
    lr_put_number(out, origin.x);
    fputs("))*(", out);
    lr_put_number(out, u.x);
    fputs(")+(y-(", out);
    lr_put_number(out, origin.y);
    fputs("))*(", out);
    lr_put_number(out, u.y);
    fputs(")+(z-(", out);
    lr_put_number(out, origin.z);
    fputs("))*(", out);
    lr_put_number(out, u.z);
    fputs("))", out);
}

static void put_background(lr_writer *writer)
{
    const lr_scene *scene = writer->scene;
    FILE *out = writer->out;
    if (scene->background.kind != LR_BACKGROUND_GRADIENT)
        lr_writer_cannot(writer, "pictures and the sky as background are left out");
    if (lr_colors_equal(scene->background.colors[0], scene->background.colors[1])) {
        fputs("background { ", out);
        put_rgb(out, scene->background.colors[0]);
        fputs(" }\n", out);
        return;
    }
    /* A value of 1 would wrap to 0. */
    fputs("sky_sphere { pigment { function { min(0.999999, max(0, 0.5+0.5*", out);
    put_dot(out, scene->background_up, (lr_vec3){0, 0, 0});
    fputs(")) }\n  color_map { [0 ", out);
    put_rgb(out, scene->background.colors[0]);
    fputs("] [1 ", out);
    put_rgb(out, scene->background.colors[1]);
    fputs("] } } }\n", out);
}

static void put_surroundings(lr_writer *writer)
{
    const lr_scene *scene = writer->scene;
    FILE *out = writer->out;
    fprintf(out, "global_settings {\n  assumed_gamma 1\n  max_trace_level %u\n  adc_bailout ",
            (unsigned)scene->image.depth + 1);
    lr_put_number(out, scene->image.min_weight);
    fputs("\n  ambient_light ", out);
    put_rgb(out, scene->ambient);
    fputs("\n}\n", out);
    put_background(writer);
    if (scene->fog_density > 0) {
        fputs("fog { fog_type 1 distance ", out);
        lr_put_number(out, 1 / scene->fog_density);
        fputs(" color ", out);
        put_rgb(out, scene->fog_color);
        fputs(" }\n", out);
    }
    if (scene->image.samples > 1)
        lr_writer_cannot(writer, "samples a pixel are left out, +A asks POV-Ray for some");
    if (scene->image.exposure != 0)
        lr_writer_cannot(writer, "the exposure is left out");
    if (scene->image.tone != LR_TONE_NONE)
        lr_writer_cannot(writer, "the tone map is left out");
    if (scene->image.white != 0)
        lr_writer_cannot(writer, "the white balance is left out");
}

static void put_light(lr_writer *writer, const lr_light *light)
{
    FILE *out = writer->out;
    lr_color color = lr_vec3_scale(light->color, light->intensity);
    bool directional = light->kind == LR_LIGHT_DIRECTIONAL;
    lr_vec3 along = lr_vec3_normalize(light->direction);
    fputs("light_source { ", out);
    put_vector(out, directional ? lr_vec3_scale(along, -FAR_AWAY) : light->position);
    fputc(' ', out);
    put_rgb(out, color);
    if (light->falloff > 0) {
        /* 2 / (1 + (d / fade_distance)^p), where fade_distance^p is 1e-6: nearly 2e-6 / d^p. */
        fputs("*500000 fade_distance pow(10, -6/", out);
        lr_put_number(out, light->falloff);
        fputs(") fade_power ", out);
        lr_put_number(out, light->falloff);
    }
    if (directional)
        fputs(" parallel point_at 0", out);
    if (light->kind == LR_LIGHT_SPOT) {
        fputs(" spotlight tightness 0 radius ", out);
        lr_put_number(out, light->inner);
        fputs(" falloff ", out);
        lr_put_number(out, light->angle > light->inner ? light->angle : light->angle * 1.0001);
        fputs(" point_at ", out);
        put_vector(out, lr_vec3_add(light->position, along));
    }
    fputs(light->shadows ? " }\n" : " shadowless }\n", out);
}

static void put_lights(lr_writer *writer)
{
    const lr_scene *scene = writer->scene;
    lr_light added = lr_default_light(&scene->cameras[0]);
    if (scene->default_light)
        put_light(writer, &added);
    for (uint32_t i = 0; i < scene->light_count; i++) {
        put_light(writer, &scene->lights[i]);
        if (lr_light_is_soft(&scene->lights[i]))
            lr_writer_cannot(writer, "soft lights are written as points");
    }
}

/* ---- Materials ----------------------------------------------------------------------------- */

/* What a material becomes: a pigment of a colour or pattern times `tint`, and the finish. */
typedef struct finish {
    lr_color tint, ambient;
    double diffuse, transmit, filter;
} finish;

static lr_color divide(lr_color a, lr_color b)
{
    return (lr_color){b.x > 0 ? a.x / b.x : 0, b.y > 0 ? a.y / b.y : 0, b.z > 0 ? a.z / b.z : 0};
}

static lr_color multiply(lr_color a, lr_color b)
{
    return (lr_color){a.x * b.x, a.y * b.y, a.z * b.z};
}

static finish finish_of(lr_writer *writer, const lr_material *m)
{
    finish f = {.tint = {1, 1, 1}, .ambient = m->ambient, .diffuse = m->diffuse.x};
    bool matt = lr_color_greatest(m->diffuse) > 0 || lr_color_greatest(m->ambient) > 0;
    if (!lr_color_is_grey(m->diffuse)) {
        f.tint = m->diffuse;
        f.ambient = divide(m->ambient, m->diffuse);
        f.diffuse = 1;
    }
    double transmit = lr_color_greatest(m->transmit);
    if (!lr_color_is_grey(m->transmit) && !matt && m->color.kind == LR_PATTERN_NONE) {
        f.tint = divide(m->transmit, m->color.colors[0]);
        f.filter = 1;
        return f;
    }
    if (!lr_color_is_grey(m->transmit))
        lr_writer_cannot(writer, "coloured transmission of surfaces that are also matt or "
                                 "patterned is written as grey");
    f.transmit = transmit;
    if (transmit < 1) {
        f.diffuse /= 1 - transmit;
        f.ambient = lr_vec3_scale(f.ambient, 1 / (1 - transmit));
    } else if (matt) {
        lr_writer_cannot(writer, "the matt share of wholly transparent surfaces is left out");
    }
    return f;
}

static void put_pigment_color(FILE *out, const finish *f, lr_color color)
{
    put_rgb(out, multiply(color, f->tint));
    if (f->transmit > 0) {
        fputs(" transmit ", out);
        lr_put_number(out, f->transmit);
    }
    if (f->filter > 0)
        fputs(" filter 1", out);
}

/* The number of a cell along one axis. A surface within 1e-4 cells of a cell's face belongs to the
 * cell below, as that under a floor does. */
static void put_cell(FILE *out, const char *coordinate, double size)
{
    fprintf(out, "floor(%s/(", coordinate);
    lr_put_number(out, size);
    fputs(")-0.0001)", out);
}

/* 0.25 in cells with an even number, 0.75 in the others, or the share along a gradient. */
static void put_pattern_function(FILE *out, const lr_pattern *p)
{
    lr_vec3 zero = {0, 0, 0}, along = lr_vec3_normalize(p->direction);
    const char *cells = "0.25+0.5*abs(mod(";
    switch (p->kind) {
    case LR_PATTERN_GRADIENT:
        fputs("min(0.999999, max(0, ", out);
        put_dot(out, lr_vec3_scale(p->direction, 1 / lr_vec3_dot(p->direction, p->direction)),
                p->origin);
        fputs("))", out);
        return;
    case LR_PATTERN_STRIPES:
        fprintf(out, "%sfloor(", cells);
        put_dot(out, lr_vec3_scale(along, 1 / p->size), zero);
        fputs("-0.0001)", out);
        break;
    case LR_PATTERN_RINGS: {
        lr_vec3 u, v;
        lr_vec3_frame(along, &u, &v);
        fprintf(out, "%sfloor(sqrt(pow(", cells);
        put_dot(out, lr_vec3_scale(u, 1 / p->size), p->origin);
        fputs(", 2)+pow(", out);
        put_dot(out, lr_vec3_scale(v, 1 / p->size), p->origin);
        fputs(", 2)))", out);
        break;
    }
    default:
        fputs(cells, out);
        put_cell(out, "x", p->size);
        fputc('+', out);
        put_cell(out, "y", p->size);
        fputc('+', out);
        put_cell(out, "z", p->size);
    }
    fputs(", 2))", out);
}

static void put_pigment(lr_writer *writer, const finish *f, const lr_pattern *p)
{
    FILE *out = writer->out;
    fputs("    pigment { ", out);
    if (p->kind == LR_PATTERN_IMAGE)
        lr_writer_cannot(writer, "pictures on surfaces are left out, only their tint is written");
    if (p->kind == LR_PATTERN_NONE || p->kind == LR_PATTERN_IMAGE) {
        put_pigment_color(out, f, p->colors[0]);
        fputs(" }\n", out);
        return;
    }
    bool smooth = p->kind == LR_PATTERN_GRADIENT;
    fputs("function { ", out);
    put_pattern_function(out, p);
    fputs(smooth ? " }\n      color_map { [0 " : " }\n      color_map { [0.5 ", out);
    put_pigment_color(out, f, p->colors[0]);
    fputs(smooth ? "] [1 " : "] [0.5 ", out);
    put_pigment_color(out, f, p->colors[1]);
    fputs("] } }\n", out);
}

static void put_highlight(lr_writer *writer, const lr_material *m)
{
    FILE *out = writer->out;
    double strength = lr_color_greatest(m->specular);
    if (strength == 0)
        return;
    if (!lr_color_is_grey(m->specular))
        lr_writer_cannot(writer, "coloured highlights are written as white");
    bool phong = m->highlight == LR_HIGHLIGHT_PHONG;
    fputs(phong ? " phong " : " specular ", out);
    lr_put_number(out, strength);
    fputs(phong ? " phong_size " : " roughness ", out);
    lr_put_number(out, phong ? m->shininess : 1 / (m->shininess > 1e-6 ? m->shininess : 1e-6));
}

static void put_finish(lr_writer *writer, const finish *f, const lr_material *m)
{
    FILE *out = writer->out;
    fputs("    finish { ambient ", out);
    put_rgb(out, f->ambient);
    fputs(" diffuse ", out);
    lr_put_number(out, f->diffuse);
    put_highlight(writer, m);
    if (m->fresnel) {
        fputs(" reflection { rgb 0, ", out);
        put_rgb(out, lr_vec3_add(m->reflect, m->transmit));
        fputs(" fresnel on } conserve_energy", out);
        if (lr_color_greatest(m->reflect) > 0 && lr_color_greatest(m->transmit) > 0)
            lr_writer_cannot(writer, "transmission of fresnel materials that also reflect is "
                                     "written a little weaker");
    } else if (lr_color_greatest(m->reflect) > 0) {
        fputs(" reflection { ", out);
        put_rgb(out, m->reflect);
        fputs(" }", out);
    }
    if (lr_color_greatest(m->emission) > 0)
        lr_writer_cannot(writer, "light that surfaces show by themselves is left out");
    fputs(" }\n", out);
}

static void put_interior(FILE *out, const lr_material *m)
{
    fputs("  interior { ior ", out);
    lr_put_number(out, m->ior);
    double greatest = lr_color_greatest(m->absorption);
    if (greatest > 0) {
        /* From a fade_power of 1000 on: exp((fade_color - 1) * depth / fade_distance). */
        lr_color share = lr_vec3_scale(m->absorption, 1 / greatest);
        fputs(" fade_power 1001 fade_distance ", out);
        lr_put_number(out, 1 / greatest);
        fputs(" fade_color ", out);
        put_rgb(out, lr_vec3_sub((lr_vec3){1, 1, 1}, share));
    }
    fputs(" }\n", out);
}

static void put_material(lr_writer *writer, uint32_t index)
{
    const lr_material *m = &writer->scene->materials[index];
    FILE *out = writer->out;
    finish f = finish_of(writer, m);
    fprintf(out, "#declare M%u = material {\n  texture {\n", (unsigned)index + 1);
    put_pigment(writer, &f, &m->color);
    put_finish(writer, &f, m);
    fputs("  }\n", out);
    put_interior(out, m);
    fputs("}\n", out);
    if (m->one_sided)
        lr_writer_cannot(writer, "one-sided materials are written with two sides");
    if (lr_material_has_relief(m))
        lr_writer_cannot(writer, "pictures of normals and heights are left out");
    if (m->priority != 0)
        lr_writer_cannot(writer, "priorities of media are left out");
    if (m->alpha_cutoff > 0)
        lr_writer_cannot(writer, "surfaces cut out by alpha are written whole");
}

/* ---- Objects ------------------------------------------------------------------------------- */

static void put_triangle(FILE *out, lr_vec3 a, lr_vec3 b, lr_vec3 c)
{
    fputs("triangle { ", out);
    put_vector(out, a);
    fputs(", ", out);
    put_vector(out, b);
    fputs(", ", out);
    put_vector(out, c);
}

static void put_list(FILE *out, const char *name, const float *values, uint32_t count)
{
    fprintf(out, "  %s { %u", name, (unsigned)count);
    for (size_t i = 0; i < count; i++) {
        fputs(i % 4 ? ", <" : ",\n    <", out);
        lr_put_floats(out, values + 3 * i, 3);
        fputc('>', out);
    }
    fputs(" }\n", out);
}

static void put_mesh(lr_writer *writer, const lr_mesh *mesh)
{
    FILE *out = writer->out;
    fputs("mesh2 {\n", out);
    put_list(out, "vertex_vectors", mesh->positions, mesh->vertex_count);
    if (mesh->normals)
        put_list(out, "normal_vectors", mesh->normals, mesh->vertex_count);
    fprintf(out, "  face_indices { %u", (unsigned)mesh->triangle_count);
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *t = mesh->triangles + 3 * i;
        fprintf(out, "%s<%u, %u, %u>", i % 8 ? ", " : ",\n    ", (unsigned)t[0], (unsigned)t[1],
                (unsigned)t[2]);
    }
    fputs(" }\n", out);
    if (mesh->closed)
        fputs("  inside_vector <0, 0, 1>\n", out);
    if (mesh->colors)
        lr_writer_cannot(writer, "colours of vertices are left out");
}

/* Everything of the object but its material and transform; the brace stays open. */
static void put_shape(lr_writer *writer, const lr_object *object)
{
    FILE *out = writer->out;
    switch (object->kind) {
    case LR_SPHERE:
        fputs("sphere { ", out);
        put_vector(out, object->sphere.center);
        fputs(", ", out);
        lr_put_number(out, object->sphere.radius);
        break;
    case LR_PLANE:
        fputs("plane { ", out);
        put_vector(out, object->plane.normal);
        fputs(", ", out);
        lr_put_number(out, object->plane.offset / lr_vec3_length(object->plane.normal));
        break;
    case LR_BOX:
        fputs("box { ", out);
        put_vector(out, object->box.min);
        fputs(", ", out);
        put_vector(out, object->box.max);
        break;
    case LR_DISK:
        fputs("disc { ", out);
        put_vector(out, object->disk.center);
        fputs(", ", out);
        put_vector(out, object->disk.normal);
        fputs(", ", out);
        lr_put_number(out, object->disk.radius);
        break;
    case LR_RECTANGLE: {
        lr_vec3 a = object->rectangle.corner, b = lr_vec3_add(a, object->rectangle.u);
        lr_vec3 d = lr_vec3_add(a, object->rectangle.v);
        lr_vec3 c = lr_vec3_add(b, object->rectangle.v);
        fputs("mesh { ", out);
        put_triangle(out, a, b, c);
        fputs(" } ", out);
        put_triangle(out, a, c, d);
        fputs(" }", out);
        break;
    }
    case LR_CYLINDER:
    case LR_CONE:
        fputs("cone { ", out);
        put_vector(out, object->cone.from);
        fputs(", ", out);
        lr_put_number(out, object->cone.radius_from);
        fputs(", ", out);
        put_vector(out, object->cone.to);
        fputs(", ", out);
        lr_put_number(out, object->cone.radius_to);
        fputs(object->open ? " open" : "", out);
        break;
    case LR_TRIANGLE:
        put_triangle(out, object->triangle.a, object->triangle.b, object->triangle.c);
        break;
    case LR_MESH:
        put_mesh(writer, &writer->scene->meshes[object->mesh]);
        break;
    }
}

/* Points are rows there: the matrix is the transpose of ours. */
static void put_matrix(FILE *out, const lr_transform *t)
{
    fputs(" matrix <", out);
    for (int column = 0; column < 4; column++)
        for (int row = 0; row < 3; row++) {
            fputs(column || row ? ", " : "", out);
            lr_put_number(out, t->m[row][column]);
        }
    fputc('>', out);
}

static void put_object(lr_writer *writer, const lr_object *object)
{
    FILE *out = writer->out;
    const lr_pattern *pattern = &writer->scene->materials[object->material].color;
    bool carries_pattern = pattern->object_space;
    put_shape(writer, object);
    if (object->transformed && !carries_pattern)
        put_matrix(out, &object->to_world);
    fprintf(out, " material { M%u }", (unsigned)object->material + 1);
    if (object->transformed && carries_pattern)
        put_matrix(out, &object->to_world);
    fputs(object->shadow ? " }\n" : " no_shadow }\n", out);
    if (object->inward)
        lr_writer_cannot(writer, "objects of which only the inside shows are written with both");
}

void lr_write_povray(lr_writer *writer)
{
    const lr_scene *scene = writer->scene;
    lr_put_origin(writer, "//");
    fprintf(writer->out, "// Render with +W%u +H%u -A.\n#version 3.7;\n",
            (unsigned)scene->image.width, (unsigned)scene->image.height);
    put_surroundings(writer);
    put_camera(writer);
    put_lights(writer);
    for (uint32_t i = 0; i < scene->material_count; i++)
        put_material(writer, i);
    for (uint32_t i = 0; i < scene->object_count; i++)
        put_object(writer, &scene->objects[i]);
}
