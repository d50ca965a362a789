/* Tachyon 0.99. Its world is left-handed, so everything is written with z negated; it has no
 * transforms, so they are applied here; what it has no shape for is cut into triangles. */
#include <math.h>

#include "scene/write.h"

#define SEGMENTS 96 /* around what is cut into triangles */

static void put_vector(FILE *out, const char *name, lr_vec3 v)
{
    fprintf(out, " %s ", name);
    lr_put_number(out, v.x);
    fputc(' ', out);
    lr_put_number(out, v.y);
    fputc(' ', out);
    lr_put_number(out, -v.z);
}

static void put_color(FILE *out, const char *name, lr_color c)
{
    put_vector(out, name, (lr_color){c.x, c.y, -c.z});
}

static void put_value(FILE *out, const char *name, double value)
{
    fprintf(out, " %s ", name);
    lr_put_number(out, value);
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
    fprintf(out, "RESOLUTION %u %u\nCAMERA\n ", (unsigned)scene->image.width,
            (unsigned)scene->image.height);
    put_value(out, "ZOOM", 0.5 / half_height);
    fprintf(out, " ASPECTRATIO 1 ANTIALIASING 0 RAYDEPTH %u\n ", (unsigned)scene->image.depth + 1);
    put_vector(out, "CENTER", camera->from);
    put_vector(out, "VIEWDIR", forward);
    put_vector(out, "UPDIR", up);
    fputs("\nEND_CAMERA\n", out);
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

static void put_surroundings(lr_writer *writer)
{
    const lr_scene *scene = writer->scene;
    FILE *out = writer->out;
    if (scene->background.kind != LR_BACKGROUND_GRADIENT)
        lr_writer_cannot(writer, "pictures and the sky as background are left out");
    if (lr_colors_equal(scene->background.colors[0], scene->background.colors[1])) {
        put_color(out, "BACKGROUND", scene->background.colors[0]);
    } else {
        fputs("BACKGROUND_GRADIENT SKY_SPHERE", out);
        put_vector(out, "UPDIR", scene->background_up);
        fputs(" TOPVAL 1 BOTTOMVAL -1", out);
        put_color(out, "TOPCOLOR", scene->background.colors[1]);
        put_color(out, "BOTTOMCOLOR", scene->background.colors[0]);
    }
    fputc('\n', out);
    if (scene->fog_density > 0) {
        fputs("FOG EXP START 0 END 1", out);
        put_value(out, "DENSITY", scene->fog_density);
        put_color(out, "COLOR", scene->fog_color);
        fputc('\n', out);
    }
    if (scene->image.samples > 1)
        lr_writer_cannot(writer, "samples a pixel are left out, -aasamples asks Tachyon for some");
    if (scene->image.exposure != 0)
        lr_writer_cannot(writer, "the exposure is left out");
    if (scene->image.tone != LR_TONE_NONE)
        lr_writer_cannot(writer, "the tone map is left out");
    if (scene->image.white != 0)
        lr_writer_cannot(writer, "the white balance is left out");
}

static void put_attenuation(lr_writer *writer, double falloff)
{
    FILE *out = writer->out;
    if (falloff == 0)
        return;
    bool linear = falloff < 1.5;
    fputs(linear ? " ATTENUATION CONSTANT 0 LINEAR 1 QUADRATIC 0"
                 : " ATTENUATION CONSTANT 0 LINEAR 0 QUADRATIC 1",
          out);
    if (falloff != 1 && falloff != 2)
        lr_writer_cannot(writer, "falloffs other than 0, 1 and 2 are written as the nearest");
}

static void put_light(lr_writer *writer, const lr_light *light)
{
    FILE *out = writer->out;
    if (light->kind == LR_LIGHT_DIRECTIONAL) {
        fputs("DIRECTIONAL_LIGHT", out);
        put_vector(out, "DIRECTION", lr_vec3_normalize(light->direction));
    } else {
        bool spot = light->kind == LR_LIGHT_SPOT;
        fputs(spot ? "SPOTLIGHT" : "LIGHT", out);
        put_vector(out, "CENTER", light->position);
        fputs(" RAD 0.000001", out);
        if (spot) {
            put_vector(out, "DIRECTION", lr_vec3_normalize(light->direction));
            put_value(out, "FALLOFF_START", light->inner);
            put_value(out, "FALLOFF_END", light->angle);
        }
        put_attenuation(writer, light->falloff);
    }
    put_color(out, "COLOR", lr_vec3_scale(light->color, light->intensity));
    fputc('\n', out);
    if (!light->shadows)
        lr_writer_cannot(writer, "lights without shadows are written with shadows");
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

static void note_material(lr_writer *writer, const lr_material *m)
{
    bool transmits = lr_color_greatest(m->transmit) > 0;
    if (transmits && m->ior != 1)
        lr_writer_cannot(writer, "refraction is left out, rays go straight through");
    if (lr_color_greatest(m->absorption) > 0)
        lr_writer_cannot(writer, "absorption is left out");
    if (m->fresnel)
        lr_writer_cannot(writer, "Fresnel's law is left out");
    if (!lr_color_is_grey(m->reflect) || !lr_color_is_grey(m->transmit) ||
        !lr_color_is_grey(m->specular))
        lr_writer_cannot(writer, "coloured reflection, transmission and highlights are grey");
    if (m->color.kind != LR_PATTERN_NONE)
        lr_writer_cannot(writer, "patterns and pictures are left out, only a colour is written");
    if (lr_color_greatest(m->emission) > 0)
        lr_writer_cannot(writer, "light that surfaces show by themselves is left out");
    if (m->one_sided)
        lr_writer_cannot(writer, "one-sided materials are written with two sides");
    if (lr_material_has_relief(m))
        lr_writer_cannot(writer, "pictures of normals and heights are left out");
    if (m->alpha_cutoff > 0)
        lr_writer_cannot(writer, "surfaces cut out by alpha are written whole");
    if (m->highlight == LR_HIGHLIGHT_PHONG && lr_color_greatest(m->specular) > 0)
        lr_writer_cannot(writer, "Phong's highlights need the flag -shade_phong");
}

/* The colour that stands for the material, times a coloured diffuse share. */
static lr_color material_color(const lr_material *m, double diffuse)
{
    lr_color c = m->color.colors[0], d = m->diffuse;
    if (lr_color_is_grey(d))
        return c;
    return (lr_color){c.x * d.x / diffuse, c.y * d.y / diffuse, c.z * d.z / diffuse};
}

static void put_material(lr_writer *writer, uint32_t index)
{
    const lr_scene *scene = writer->scene;
    const lr_material *m = &scene->materials[index];
    FILE *out = writer->out;
    double diffuse = lr_color_greatest(m->diffuse);
    fprintf(out, "TEXDEF M%u\n ", (unsigned)index + 1);
    put_value(out, "AMBIENT", lr_color_greatest(m->ambient) * lr_color_greatest(scene->ambient));
    put_value(out, "DIFFUSE", diffuse);
    put_value(out, "SPECULAR", lr_color_greatest(m->reflect));
    put_value(out, "OPACITY", 1 - lr_color_greatest(m->transmit));
    put_value(out, "PHONG PLASTIC", lr_color_greatest(m->specular));
    put_value(out, "PHONG_SIZE", m->shininess);
    put_color(out, "COLOR", material_color(m, diffuse));
    fputs(" TEXFUNC 0\n", out);
    note_material(writer, m);
}

/* ---- Objects ------------------------------------------------------------------------------- */

/* An object on its way into the world. */
typedef struct placed {
    FILE *out;
    const lr_object *object;
    lr_transform inverse;
    double scale; /* of lengths, if it keeps angles */
    bool similar; /* it keeps angles, so that spheres stay spheres */
} placed;

static placed place(lr_writer *writer, const lr_object *object)
{
    placed p = {.out = writer->out, .object = object, .inverse = lr_transform_identity()};
    const lr_transform *t = &object->to_world;
    lr_transform_inverse(t, &p.inverse);
    lr_vec3 columns[3];
    for (int i = 0; i < 3; i++)
        columns[i] = (lr_vec3){t->m[0][i], t->m[1][i], t->m[2][i]};
    p.scale = lr_vec3_length(columns[0]);
    p.similar = true;
    for (int i = 0; i < 3; i++) {
        double tolerance = 1e-12 * p.scale * p.scale;
        double length2 = lr_vec3_dot(columns[i], columns[i]);
        if (fabs(length2 - p.scale * p.scale) > tolerance ||
            fabs(lr_vec3_dot(columns[i], columns[(i + 1) % 3])) > tolerance)
            p.similar = false;
    }
    return p;
}

static lr_vec3 point_of(const placed *p, lr_vec3 point)
{
    return lr_transform_point(&p->object->to_world, point);
}

static lr_vec3 normal_of(const placed *p, lr_vec3 normal)
{
    return lr_vec3_normalize(lr_transform_normal(&p->inverse, normal));
}

static void end_shape(const placed *p)
{
    fprintf(p->out, " M%u\n", (unsigned)p->object->material + 1);
}

/* Points in object space. The mirrored world turns the triangle over, so its corners run the other
 * way round. */
static void put_triangle(const placed *p, const lr_vec3 points[3], const lr_vec3 normals[3])
{
    static const char *const names[] = {"V0", "V1", "V2"}, *const normal_names[] = {"N0", "N1",
                                                                                    "N2"};
    static const int order[] = {0, 2, 1};
    fputs(normals ? "STRI" : "TRI", p->out);
    for (int i = 0; i < 3; i++)
        put_vector(p->out, names[i], point_of(p, points[order[i]]));
    for (int i = 0; normals && i < 3; i++)
        put_vector(p->out, normal_names[i], normal_of(p, normals[order[i]]));
    end_shape(p);
}

static void put_quad(const placed *p, const lr_vec3 points[4], const lr_vec3 normals[4])
{
    static const int halves[2][3] = {{0, 1, 2}, {0, 2, 3}};
    for (int i = 0; i < 2; i++) {
        lr_vec3 corners[3], at[3];
        for (int k = 0; k < 3; k++) {
            corners[k] = points[halves[i][k]];
            at[k] = normals ? normals[halves[i][k]] : corners[k];
        }
        /* At a pole two corners fall together. */
        lr_vec3 ab = lr_vec3_sub(corners[1], corners[0]), ac = lr_vec3_sub(corners[2], corners[0]);
        if (lr_vec3_length(lr_vec3_cross(ab, ac)) > 0)
            put_triangle(p, corners, normals ? at : NULL);
    }
}

/* A circle around the axis w: its place along it, its radius, and the normals across and along. */
typedef struct circle {
    double along, radius, across_normal, along_normal;
} circle;

/* The strip between two circles around the axis w through `origin`. */
static void put_strip(const placed *p, lr_vec3 origin, lr_vec3 w, const circle ends[2])
{
    lr_vec3 u, v, points[4], normals[4];
    lr_vec3_frame(w, &u, &v);
    for (int segment = 0; segment < SEGMENTS; segment++) {
        for (int corner = 0; corner < 4; corner++) {
            /* 0 and 1 on the first circle, 2 and 3 back on the second. */
            const circle *c = &ends[corner / 2];
            double sine, cosine, turn = segment + (corner == 1 || corner == 2);
            lr_sincos_degrees(360 * turn / SEGMENTS, &sine, &cosine);
            lr_vec3 out = lr_vec3_add(lr_vec3_scale(u, cosine), lr_vec3_scale(v, sine));
            points[corner] = lr_vec3_add(
                origin, lr_vec3_add(lr_vec3_scale(w, c->along), lr_vec3_scale(out, c->radius)));
            normals[corner] = lr_vec3_add(lr_vec3_scale(out, c->across_normal),
                                          lr_vec3_scale(w, c->along_normal));
        }
        put_quad(p, points, normals);
    }
}

static void put_sphere(lr_writer *writer, const placed *p)
{
    const lr_object *o = p->object;
    if (p->similar) {
        fputs("SPHERE", p->out);
        put_vector(p->out, "CENTER", point_of(p, o->sphere.center));
        put_value(p->out, "RAD", o->sphere.radius * p->scale);
        end_shape(p);
        return;
    }
    lr_writer_cannot(writer, "ellipsoids and cones are cut into triangles");
    for (int i = 0; i < SEGMENTS / 2; i++) {
        circle ends[2];
        for (int k = 0; k < 2; k++) {
            double sine, cosine;
            lr_sincos_degrees(-90 + 360.0 * (i + k) / SEGMENTS, &sine, &cosine);
            ends[k] = (circle){sine * o->sphere.radius, cosine * o->sphere.radius, cosine, sine};
        }
        put_strip(p, o->sphere.center, (lr_vec3){0, 0, 1}, ends);
    }
}

static void put_disk(const placed *p, lr_vec3 center, lr_vec3 normal, double radius)
{
    if (!p->similar) {
        circle ends[2] = {{0, radius, 0, 1}, {0, 0, 0, 1}};
        put_strip(p, center, lr_vec3_normalize(normal), ends);
        return;
    }
    fputs("RING", p->out);
    put_vector(p->out, "CENTER", point_of(p, center));
    put_vector(p->out, "NORMAL", normal_of(p, normal));
    put_value(p->out, "INNER 0 OUTER", radius * p->scale);
    end_shape(p);
}

static void put_cone(lr_writer *writer, const placed *p)
{
    const lr_object *o = p->object;
    double r0 = o->cone.radius_from, r1 = o->cone.radius_to;
    lr_vec3 axis = lr_vec3_sub(o->cone.to, o->cone.from), w = lr_vec3_normalize(axis);
    double length = lr_vec3_length(axis);
    if (r0 == r1 && p->similar) {
        fputs("FCYLINDER", p->out);
        put_vector(p->out, "BASE", point_of(p, o->cone.from));
        put_vector(p->out, "APEX", point_of(p, o->cone.to));
        put_value(p->out, "RAD", r0 * p->scale);
        end_shape(p);
    } else {
        lr_writer_cannot(writer, "ellipsoids and cones are cut into triangles");
        circle ends[2] = {{0, r0, length, r0 - r1}, {length, r1, length, r0 - r1}};
        put_strip(p, o->cone.from, w, ends);
    }
    if (!o->open && r0 > 0)
        put_disk(p, o->cone.from, lr_vec3_scale(w, -1), r0);
    if (!o->open && r1 > 0)
        put_disk(p, o->cone.to, w, r1);
}

static void put_box(const placed *p)
{
    /* Each face by its corners, whose bits choose x, y and z of max. */
    static const int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                    {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    lr_vec3 low = p->object->box.min, high = p->object->box.max;
    for (int i = 0; i < 6; i++) {
        lr_vec3 points[4];
        for (int k = 0; k < 4; k++) {
            int bits = faces[i][k];
            points[k] = (lr_vec3){bits & 1 ? high.x : low.x, bits & 2 ? high.y : low.y,
                                  bits & 4 ? high.z : low.z};
        }
        put_quad(p, points, NULL);
    }
}

static void put_mesh(lr_writer *writer, const placed *p)
{
    const lr_mesh *mesh = &writer->scene->meshes[p->object->mesh];
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        lr_vec3 points[3], normals[3];
        for (size_t k = 0; k < 3; k++) {
            size_t at = 3 * (size_t)mesh->triangles[3 * i + k];
            const float *x = mesh->positions + at;
            points[k] = (lr_vec3){x[0], x[1], x[2]};
            x = mesh->normals ? mesh->normals + at : x;
            normals[k] = (lr_vec3){x[0], x[1], x[2]};
        }
        put_triangle(p, points, mesh->normals ? normals : NULL);
    }
    if (mesh->colors)
        lr_writer_cannot(writer, "colours of vertices are left out");
}

static void put_plane(const placed *p)
{
    const lr_object *o = p->object;
    double length2 = lr_vec3_dot(o->plane.normal, o->plane.normal);
    fputs("PLANE", p->out);
    put_vector(p->out, "CENTER",
               point_of(p, lr_vec3_scale(o->plane.normal, o->plane.offset / length2)));
    put_vector(p->out, "NORMAL", normal_of(p, o->plane.normal));
    end_shape(p);
}

static void put_object(lr_writer *writer, const lr_object *o)
{
    placed p = place(writer, o);
    switch (o->kind) {
    case LR_SPHERE:
        put_sphere(writer, &p);
        break;
    case LR_PLANE:
        put_plane(&p);
        break;
    case LR_BOX:
        put_box(&p);
        break;
    case LR_DISK:
        put_disk(&p, o->disk.center, o->disk.normal, o->disk.radius);
        break;
    case LR_RECTANGLE: {
        lr_vec3 b = lr_vec3_add(o->rectangle.corner, o->rectangle.u);
        lr_vec3 points[4] = {o->rectangle.corner, b, lr_vec3_add(b, o->rectangle.v),
                             lr_vec3_add(o->rectangle.corner, o->rectangle.v)};
        put_quad(&p, points, NULL);
        break;
    }
    case LR_CYLINDER:
    case LR_CONE:
        put_cone(writer, &p);
        break;
    case LR_TRIANGLE:
        put_triangle(&p, (const lr_vec3[]){o->triangle.a, o->triangle.b, o->triangle.c}, NULL);
        break;
    case LR_MESH:
        put_mesh(writer, &p);
        break;
    }
    if (!o->shadow)
        lr_writer_cannot(writer, "objects without shadows are written with shadows");
    if (o->inward)
        lr_writer_cannot(writer, "objects of which only the inside shows are written with both");
}

void lr_write_tachyon(lr_writer *writer)
{
    const lr_scene *scene = writer->scene;
    lr_put_origin(writer, "#");
    fputs("BEGIN_SCENE\n", writer->out);
    put_camera(writer);
    put_surroundings(writer);
    put_lights(writer);
    for (uint32_t i = 0; i < scene->material_count; i++)
        put_material(writer, i);
    for (uint32_t i = 0; i < scene->object_count; i++)
        put_object(writer, &scene->objects[i]);
    fputs("END_SCENE\n", writer->out);
}
