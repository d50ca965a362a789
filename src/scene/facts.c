/* What a scene holds and takes. */
#include <math.h>

#include "scene/bounds.h"
#include "scene/fingerprint.h"

static const char *const object_kinds[LR_OBJECT_KINDS] = {
    [LR_SPHERE] = "sphere", [LR_PLANE] = "plane",         [LR_BOX] = "box",
    [LR_DISK] = "disk",     [LR_RECTANGLE] = "rectangle", [LR_CYLINDER] = "cylinder",
    [LR_CONE] = "cone",     [LR_TRIANGLE] = "triangle",   [LR_MESH] = "mesh",
};

const char *lr_object_kind_name(lr_object_kind kind)
{
    return object_kinds[kind];
}

/* A point and up to three spans around it, in the world: what the object reaches along each axis is
 * at most the root of the sum of their squares there (round), or the sum of their sizes (angular).
 */
static void add_spans(lr_bounds *bounds, const lr_object *object, lr_vec3 center,
                      const lr_vec3 *spans, int count, bool round)
{
    const lr_transform *t = &object->to_world;
    lr_vec3 reach = {0, 0, 0}, c = lr_transform_point(t, center);
    for (int i = 0; i < count; i++) {
        lr_vec3 s = lr_transform_vector(t, spans[i]);
        lr_vec3 more = round ? (lr_vec3){s.x * s.x, s.y * s.y, s.z * s.z}
                             : (lr_vec3){fabs(s.x), fabs(s.y), fabs(s.z)};
        reach = lr_vec3_add(reach, more);
    }
    if (round)
        reach = (lr_vec3){sqrt(reach.x), sqrt(reach.y), sqrt(reach.z)};
    lr_bounds_add_point(bounds, lr_vec3_sub(c, reach));
    lr_bounds_add_point(bounds, lr_vec3_add(c, reach));
}

static void add_disk(lr_bounds *bounds, const lr_object *object, lr_vec3 center, lr_vec3 normal,
                     double radius)
{
    lr_vec3 spans[2];
    lr_vec3_frame(lr_vec3_normalize(normal), &spans[0], &spans[1]);
    for (int i = 0; i < 2; i++)
        spans[i] = lr_vec3_scale(spans[i], radius);
    add_spans(bounds, object, center, spans, 2, true);
}

static void add_mesh(lr_bounds *bounds, const lr_object *object, const lr_mesh *mesh)
{
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        const float *p = mesh->positions + 3 * i;
        lr_bounds_add_point(bounds,
                            lr_transform_point(&object->to_world, (lr_vec3){p[0], p[1], p[2]}));
    }
}

static void add_object(lr_bounds *bounds, const lr_scene *scene, const lr_object *o)
{
    switch (o->kind) {
    case LR_SPHERE: {
        double r = o->sphere.radius;
        const lr_vec3 spans[] = {{r, 0, 0}, {0, r, 0}, {0, 0, r}};
        add_spans(bounds, o, o->sphere.center, spans, 3, true);
        break;
    }
    case LR_PLANE:
        break;
    case LR_BOX: {
        lr_bounds box = {o->box.min, o->box.max};
        box = lr_bounds_transform(&box, &o->to_world);
        lr_bounds_add(bounds, &box);
        break;
    }
    case LR_DISK:
        add_disk(bounds, o, o->disk.center, o->disk.normal, o->disk.radius);
        break;
    case LR_RECTANGLE: {
        lr_vec3 u = lr_vec3_scale(o->rectangle.u, 0.5), v = lr_vec3_scale(o->rectangle.v, 0.5);
        add_spans(bounds, o, lr_vec3_add(o->rectangle.corner, lr_vec3_add(u, v)),
                  (const lr_vec3[]){u, v}, 2, false);
        break;
    }
    case LR_CYLINDER:
    case LR_CONE: {
        lr_vec3 axis = lr_vec3_sub(o->cone.to, o->cone.from);
        add_disk(bounds, o, o->cone.from, axis, o->cone.radius_from);
        add_disk(bounds, o, o->cone.to, axis, o->cone.radius_to);
        break;
    }
    case LR_TRIANGLE:
        lr_bounds_add_point(bounds, lr_transform_point(&o->to_world, o->triangle.a));
        lr_bounds_add_point(bounds, lr_transform_point(&o->to_world, o->triangle.b));
        lr_bounds_add_point(bounds, lr_transform_point(&o->to_world, o->triangle.c));
        break;
    case LR_MESH:
        add_mesh(bounds, o, &scene->meshes[o->mesh]);
        break;
    }
}

static void count_objects(const lr_scene *scene, lr_scene_facts *facts)
{
    lr_bounds bounds = lr_bounds_empty();
    for (int kind = 0; kind < LR_OBJECT_KINDS; kind++)
        facts->objects[kind].name = lr_object_kind_name(kind);
    for (uint32_t i = 0; i < scene->object_count; i++) {
        const lr_object *object = &scene->objects[i];
        facts->objects[object->kind].count++;
        if (object->kind == LR_MESH)
            facts->shown_triangles += scene->meshes[object->mesh].triangle_count;
        add_object(&bounds, scene, object);
    }
    facts->bounded = bounds.min.x <= bounds.max.x;
    for (int i = 0; facts->bounded && i < 3; i++) {
        facts->min[i] = (&bounds.min.x)[i];
        facts->max[i] = (&bounds.max.x)[i];
    }
    facts->bytes += scene->object_count * sizeof *scene->objects;
}

static void count_lights(const lr_scene *scene, lr_scene_facts *facts)
{
    for (uint32_t i = 0; i < scene->light_count; i++) {
        lr_light_kind kind = scene->lights[i].kind;
        facts->point_lights += kind == LR_LIGHT_POINT;
        facts->directional_lights += kind == LR_LIGHT_DIRECTIONAL;
        facts->spot_lights += kind == LR_LIGHT_SPOT;
    }
    facts->bytes += scene->light_count * sizeof *scene->lights;
}

static void count_meshes(const lr_scene *scene, lr_scene_facts *facts)
{
    for (uint32_t i = 0; i < scene->mesh_count; i++) {
        const lr_mesh *mesh = &scene->meshes[i];
        uint64_t floats =
            3 + (mesh->normals ? 3u : 0) + (mesh->uvs ? 2u : 0) + (mesh->colors ? 3u : 0);
        facts->vertices += mesh->vertex_count;
        facts->triangles += mesh->triangle_count;
        facts->bytes += mesh->vertex_count * floats * sizeof(float) +
                        mesh->triangle_count * (uint64_t)(3 * sizeof(uint32_t));
    }
    facts->bytes += scene->mesh_count * sizeof *scene->meshes;
}

static void count_textures(const lr_scene *scene, lr_scene_facts *facts)
{
    facts->textures = scene->texture_count;
    for (uint32_t i = 0; i < scene->texture_count; i++) {
        const lr_texture *texture = &scene->textures[i];
        uint64_t texels = (uint64_t)texture->width * texture->height;
        facts->texels += texels;
        facts->bytes += texels * (texture->floats ? 3 * sizeof(float) : 4);
    }
    facts->bytes += scene->texture_count * sizeof *scene->textures;
}

void lr_scene_get_facts(const lr_scene *scene, lr_scene_facts *facts)
{
    *facts = (lr_scene_facts){
        .bytes = scene->camera_count * sizeof *scene->cameras +
                 scene->material_count * sizeof *scene->materials,
    };
    count_objects(scene, facts);
    count_lights(scene, facts);
    count_meshes(scene, facts);
    count_textures(scene, facts);
    lr_scene_hash(scene, facts->sha256);
}

const char *lr_scene_camera_name(const lr_scene *scene, uint32_t index)
{
    return scene->cameras[index].name;
}
