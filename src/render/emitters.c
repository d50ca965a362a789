#include "render/emitters.h"

#include <math.h>
#include <stdlib.h>

#include "base/exact.h"
#include "base/memory.h"
#include "render/choice.h"
#include "scene/bounds.h"

#define PI 3.14159265358979323846

/* Beyond these areas floats fail. */
#define AREA_MIN 1e-24
#define AREA_MAX 1e24

static double mean_of(lr_color c)
{
    return (c.x + c.y + c.z) / 3;
}

static lr_emitter *add(lr_emitters *list)
{
    void *items = list->items;
    bool fits = lr_array_reserve(&items, list->count, &list->capacity, sizeof *list->items);
    list->items = items;
    list->no_memory = list->no_memory || !fits;
    return fits ? &list->items[list->count++] : NULL;
}

/* ---- Surfaces that shine ---- */

static const lr_material *material_of(const lr_emitters *list, uint32_t object)
{
    return &list->scene->materials[list->scene->objects[object].material];
}

/* The sides of the object that shine, as far as they are there. */
static uint32_t sides_of(const lr_emitters *list, uint32_t index, bool sided)
{
    const lr_material *m = material_of(list, index);
    uint32_t sides = LR_GPU_EMITTER_FRONT | LR_GPU_EMITTER_BACK;
    if (m->emits == LR_EMITS_FRONT || (m->one_sided && sided))
        sides &= LR_GPU_EMITTER_FRONT;
    if (list->scene->objects[index].inward)
        sides &= LR_GPU_EMITTER_BACK;
    return lr_color_is_black(m->emission) ? 0 : sides;
}

/* How bright the picture of the object's light is where it lies as `map` says; 1 without a picture.
 * 0 only where all of it is black. */
static double picture_mean(lr_emitters *list, uint32_t object, const struct gpu_emitter_map *map)
{
    const lr_map *light = &material_of(list, object)->maps[LR_MAP_EMISSION];
    if (!light->given)
        return 1;
    lr_light_map *known = &list->light_maps[light->texture];
    if (!known->sums && !lr_light_map_build(&list->scene->textures[light->texture], known)) {
        list->no_memory = true;
        return 1;
    }
    /* Of a triangle and the like the corners, of a disk all around, of a ball everything. */
    double u[3] = {map->u, (double)map->u + map->u1, (double)map->u + map->u2};
    double v[3] = {map->v, (double)map->v + map->v1, (double)map->v + map->v2};
    double low[2] = {fmin(u[0], fmin(u[1], u[2])), fmin(v[0], fmin(v[1], v[2]))};
    double high[2] = {fmax(u[0], fmax(u[1], u[2])), fmax(v[0], fmax(v[1], v[2]))};
    if (list->scene->objects[object].kind != LR_MESH)
        low[0] = low[1] = -1;
    return lr_light_map_mean(known, low, high);
}

/* A surface of that area; `kind` with its sides. What is black all over is none. */
static lr_emitter *add_surface(lr_emitters *list, uint32_t object, uint32_t kind, double area,
                               struct gpu_emitter_map map)
{
    if (!(area >= AREA_MIN && area <= AREA_MAX))
        return NULL;
    double share = picture_mean(list, object, &map);
    const lr_map *light = &material_of(list, object)->maps[LR_MAP_EMISSION];
    lr_emitter *d = share > 0 ? add(list) : NULL;
    if (!d)
        return NULL;
    const uint32_t both = LR_GPU_EMITTER_FRONT | LR_GPU_EMITTER_BACK;
    lr_color radiance = material_of(list, object)->emission;
    *d = (lr_emitter){
        .record = {.kind = kind, .radiance = lr_pack_vec3(radiance)},
        .map = map,
        .mapped = light->given,
        .area = area,
        .power = PI * area * mean_of(radiance) * share * ((kind & both) == both ? 2 : 1),
        .object = object,
    };
    d->map.texture = light->texture;
    d->map.object = object;
    return d;
}

/* As flat_uv() in uv.glsl has it. */
static const struct gpu_emitter_map flat_map = {.v = 1, .u1 = 1, .v2 = -1};
static const struct gpu_emitter_map disk_map = {.u = 0.5f, .v = 0.5f, .u1 = 0.5f, .v2 = -0.5f};

/* What origin, e1, e2 span: the parallelogram, the triangle or the ellipse. Its front is where
 * e1 x e2 points. */
static void add_flat(lr_emitters *list, uint32_t object, uint32_t kind, lr_vec3 origin, lr_vec3 e1,
                     lr_vec3 e2, struct gpu_emitter_map map)
{
    static const double shares[] = {[LR_GPU_EMITTER_RECTANGLE] = 1,
                                    [LR_GPU_EMITTER_DISK] = PI,
                                    [LR_GPU_EMITTER_TRIANGLE] = 0.5};
    lr_vec3 normal = lr_vec3_cross(e1, e2);
    double area = lr_vec3_length(normal) * shares[kind & LR_GPU_EMITTER_KIND];
    lr_emitter *d = add_surface(list, object, kind, area, map);
    if (!d)
        return;
    d->record.origin = lr_pack_vec3(origin);
    d->record.e1 = lr_pack_vec3(e1);
    d->record.e2 = lr_pack_vec3(e2);
    d->record.normal = lr_pack_vec3(lr_vec3_normalize(normal));
}

static void add_disk(lr_emitters *list, uint32_t index, uint32_t sides)
{
    const lr_object *object = &list->scene->objects[index];
    const lr_transform *t = &object->to_world;
    lr_vec3 u, v;
    lr_vec3_frame(lr_vec3_normalize(object->disk.normal), &u, &v);
    u = lr_transform_vector(t, lr_vec3_scale(u, object->disk.radius));
    v = lr_transform_vector(t, lr_vec3_scale(v, object->disk.radius));
    add_flat(list, index, LR_GPU_EMITTER_DISK | sides, lr_transform_point(t, object->disk.center),
             u, v, disk_map);
}

/* box_uv() in uv.glsl. */
static void box_uv(const double p[3], const double n[3], float *u, float *v)
{
    bool level = n[1] != 0;
    *u = (float)(0.5 + 0.5 * (level ? p[0] : n[2] * p[0] - n[0] * p[2]));
    *v = (float)(0.5 + 0.5 * (level ? n[1] * p[2] : -p[1]));
}

/* How a picture lies on the box's face that edges a and b span from a corner of it. */
static struct gpu_emitter_map box_map(int axis, bool far_side, int a, int b)
{
    struct gpu_emitter_map map;
    double p[3] = {-1, -1, -1}, n[3] = {0};
    n[axis] = p[axis] = far_side ? 1 : -1;
    box_uv(p, n, &map.u, &map.v);
    p[a] = 1;
    box_uv(p, n, &map.u1, &map.v1);
    p[a] = -1;
    p[b] = 1;
    box_uv(p, n, &map.u2, &map.v2);
    map.u1 -= map.u;
    map.v1 -= map.v;
    map.u2 -= map.u;
    map.v2 -= map.v;
    return map;
}

/* Six parallelograms. */
static void add_box(lr_emitters *list, uint32_t index, uint32_t sides)
{
    const lr_object *object = &list->scene->objects[index];
    const lr_transform *t = &object->to_world;
    lr_vec3 size = lr_vec3_sub(object->box.max, object->box.min);
    lr_vec3 low = lr_transform_point(t, object->box.min);
    lr_vec3 edges[3] = {lr_transform_vector(t, (lr_vec3){size.x, 0, 0}),
                        lr_transform_vector(t, (lr_vec3){0, size.y, 0}),
                        lr_transform_vector(t, (lr_vec3){0, 0, size.z})};
    for (int i = 0; i < 6; i++) {
        int first = (i / 2 + 1) % 3, second = (i / 2 + 2) % 3;
        lr_vec3 along = edges[i / 2], a = edges[first], b = edges[second];
        bool far_side = i & 1;
        lr_vec3 corner = far_side ? lr_vec3_add(low, along) : low;
        bool outward = (lr_vec3_dot(lr_vec3_cross(a, b), along) > 0) == far_side;
        add_flat(list, index, LR_GPU_EMITTER_RECTANGLE | sides, corner, outward ? a : b,
                 outward ? b : a,
                 box_map(i / 2, far_side, outward ? first : second, outward ? second : first));
    }
}

static bool is_mirrored(const lr_transform *t)
{
    lr_vec3 x = {t->m[0][0], t->m[1][0], t->m[2][0]}, y = {t->m[0][1], t->m[1][1], t->m[2][1]};
    lr_vec3 z = {t->m[0][2], t->m[1][2], t->m[2][2]};
    return lr_vec3_dot(lr_vec3_cross(x, y), z) < 0;
}

/* How the picture lies on triangle i; its first corner is the origin, `second` and `third` are
 * along e1 and e2. */
static struct gpu_emitter_map mesh_map(const lr_mesh *mesh, uint32_t i, int second, int third)
{
    if (!mesh->uvs)
        return (struct gpu_emitter_map){.u = 0};
    const uint32_t *corners = &mesh->triangles[3 * (size_t)i];
    const float *a = &mesh->uvs[2 * (size_t)corners[0]];
    const float *b = &mesh->uvs[2 * (size_t)corners[second]];
    const float *c = &mesh->uvs[2 * (size_t)corners[third]];
    return (struct gpu_emitter_map){.u = a[0],
                                    .v = a[1],
                                    .u1 = b[0] - a[0],
                                    .v1 = b[1] - a[1],
                                    .u2 = c[0] - a[0],
                                    .v2 = c[1] - a[1]};
}

static void add_mesh(lr_emitters *list, uint32_t index, uint32_t sides)
{
    const lr_object *object = &list->scene->objects[index];
    const lr_mesh *mesh = &list->scene->meshes[object->mesh];
    bool mirrored = is_mirrored(&object->to_world);
    if (mesh->triangle_count > LR_CHOICES_MAX - list->count)
        return;
    for (uint32_t i = 0; i < mesh->triangle_count && !list->no_memory; i++) {
        lr_vec3 corners[3];
        for (int k = 0; k < 3; k++) {
            const float *p = &mesh->positions[3 * (size_t)mesh->triangles[3 * (size_t)i + k]];
            corners[k] = lr_transform_point(&object->to_world, (lr_vec3){p[0], p[1], p[2]});
        }
        lr_vec3 e1 = lr_vec3_sub(corners[1], corners[0]), e2 = lr_vec3_sub(corners[2], corners[0]);
        add_flat(list, index, LR_GPU_EMITTER_TRIANGLE | sides, corners[0], mirrored ? e2 : e1,
                 mirrored ? e1 : e2, mesh_map(mesh, i, mirrored ? 2 : 1, mirrored ? 1 : 2));
    }
}

static void add_sphere(lr_emitters *list, uint32_t index, uint32_t sides,
                       const struct gpu_sphere *sphere)
{
    double r = sphere->radius;
    lr_emitter *d = add_surface(list, index, LR_GPU_EMITTER_SPHERE | sides, 4 * PI * r * r,
                                (struct gpu_emitter_map){.u = 0});
    if (!d)
        return;
    d->record.origin = sphere->center;
    d->record.radius = sphere->radius;
}

static void add_object(lr_emitters *list, uint32_t index, const lr_primitive *primitive)
{
    const lr_object *object = &list->scene->objects[index];
    const lr_material *m = material_of(list, index);
    const lr_transform *t = &object->to_world;
    uint32_t sides = sides_of(list, index, primitive->sided);
    /* What has holes shines where it is met: a sample in a hole would bring light. */
    bool cut = m->color.kind == LR_PATTERN_IMAGE && m->alpha_cutoff > 0;
    if (!sides || cut || list->count + 6 > LR_CHOICES_MAX)
        return;
    switch (object->kind) {
    case LR_RECTANGLE:
        add_flat(list, index, LR_GPU_EMITTER_RECTANGLE | sides,
                 lr_transform_point(t, object->rectangle.corner),
                 lr_transform_vector(t, object->rectangle.u),
                 lr_transform_vector(t, object->rectangle.v), flat_map);
        break;
    case LR_TRIANGLE: {
        lr_vec3 a = object->triangle.a;
        add_flat(list, index, LR_GPU_EMITTER_TRIANGLE | sides, lr_transform_point(t, a),
                 lr_transform_vector(t, lr_vec3_sub(object->triangle.b, a)),
                 lr_transform_vector(t, lr_vec3_sub(object->triangle.c, a)), flat_map);
        break;
    }
    case LR_DISK:
        add_disk(list, index, sides);
        break;
    case LR_BOX:
        add_box(list, index, sides);
        break;
    case LR_MESH:
        add_mesh(list, index, sides);
        break;
    case LR_SPHERE:
        if (primitive->list == LR_SPHERES)
            add_sphere(list, index, sides, &primitive->record.sphere);
        break;
    default:
        break;
    }
}

/* ---- The lights ---- */

/* The radius of the scene, metres: half the diagonal of the box around what has one. */
static double radius_of(const lr_scene *scene, const lr_primitive *primitives)
{
    lr_bounds all = lr_bounds_empty();
    for (uint32_t i = 0; i < scene->object_count; i++) {
        const lr_object *object = &scene->objects[i];
        const lr_bvh_box *box = &primitives[i].box;
        if (primitives[i].list == LR_MESHES) {
            lr_bounds own = lr_mesh_bounds(&scene->meshes[object->mesh]);
            own = lr_bounds_transform(&own, &object->to_world);
            lr_bounds_add(&all, &own);
        } else if (primitives[i].list != LR_PLANES) {
            lr_bounds_add_point(&all, (lr_vec3){box->min[0], box->min[1], box->min[2]});
            lr_bounds_add_point(&all, (lr_vec3){box->max[0], box->max[1], box->max[2]});
        }
    }
    double radius = all.min.x <= all.max.x ? lr_vec3_length(lr_vec3_sub(all.max, all.min)) / 2 : 1;
    return fmin(fmax(radius, 1e-12), 1e12);
}

/* About how much of the light's power arrives in the scene; a spot counts as if it shone all
 * around, for where it does shine it is as bright. */
static double power_of(const lr_light *light, double radius)
{
    double value = PI * mean_of(light->color) * light->intensity;
    if (light->kind == LR_LIGHT_DIRECTIONAL)
        return value * PI * radius * radius;
    return value * 4 * PI * lr_exp2((2 - light->falloff) * lr_log2(radius));
}

static void add_light(lr_emitters *list, uint32_t kind, uint32_t index, double power)
{
    lr_emitter *d = power > 0 ? add(list) : NULL;
    if (!d)
        return;
    *d = (lr_emitter){.record = {.kind = kind, .light = index}, .power = power, .object = LR_NONE};
}

/* The light that follows the camera gives way to any other. */
static void add_lights(lr_emitters *list, const lr_primitive *primitives,
                       const lr_packed_scene *packed)
{
    const lr_scene *scene = list->scene;
    uint32_t lights = scene->default_light ? 0 : scene->light_count;
    if (lights > 0 || packed->environment_light > 0) {
        double radius = radius_of(scene, primitives), across = PI * radius * radius;
        add_light(list, LR_GPU_EMITTER_ENVIRONMENT, 0, packed->environment_light * across);
        add_light(list, LR_GPU_EMITTER_SUN, 0, packed->sun_light * across);
        for (uint32_t i = 0; i < lights; i++)
            add_light(list, LR_GPU_EMITTER_LIGHT, i, power_of(&scene->lights[i], radius));
    }
    if (scene->default_light && list->count == 0)
        add_light(list, LR_GPU_EMITTER_LIGHT, 0, 1);
}

bool lr_emitters_find(const lr_scene *scene, const lr_primitive *primitives,
                      const lr_packed_scene *packed, lr_emitters *list)
{
    *list = (lr_emitters){.scene = scene};
    list->light_maps = lr_alloc(scene->texture_count, sizeof *list->light_maps);
    if (!list->light_maps)
        return false;
    for (uint32_t i = 0; i < scene->object_count; i++)
        add_object(list, i, &primitives[i]);
    add_lights(list, primitives, packed);
    for (uint32_t i = 0; i < scene->texture_count; i++)
        lr_light_map_free(&list->light_maps[i]);
    free(list->light_maps);
    list->light_maps = NULL;
    return !list->no_memory;
}
