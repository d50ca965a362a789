/* Cameras and KHR_lights_punctual of a glTF file, from its JSON: assimp would find them by the
 * names of nodes, of which several may be equal. */
#include "scene/import_internal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

#define PI 3.14159265358979324

typedef struct visit {
    size_t node;
    lr_transform around;
} visit;

typedef struct visits {
    visit *items;
    uint32_t count, capacity;
} visits;

/* count numbers of a list, all of them or none. */
static bool numbers(const json_t *object, const char *key, size_t count, double *out)
{
    const json_t *list = json_object_get(object, key);
    if (json_array_size(list) != count)
        return false;
    for (size_t i = 0; i < count; i++)
        if (!json_is_number(json_array_get(list, i)))
            return false;
    for (size_t i = 0; i < count; i++)
        out[i] = json_number_value(json_array_get(list, i));
    return true;
}

/* The matrix, stored by columns, or translation * rotation (a unit quaternion) * scale. */
static lr_transform node_transform(const json_t *node)
{
    double m[16], t[3] = {0, 0, 0}, q[4] = {0, 0, 0, 1}, s[3] = {1, 1, 1};
    lr_transform out;
    if (numbers(node, "matrix", 16, m)) {
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 4; j++)
                out.m[i][j] = m[4 * j + i];
        return out;
    }
    numbers(node, "translation", 3, t);
    numbers(node, "rotation", 4, q);
    numbers(node, "scale", 3, s);
    double x = q[0], y = q[1], z = q[2], w = q[3];
    double rotation[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                             {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                             {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
            out.m[i][j] = rotation[i][j] * s[j];
        out.m[i][3] = t[i];
    }
    return out;
}

static const char *shown_name(const json_t *object, char buffer[80])
{
    const char *name = json_string_value(json_object_get(object, "name"));
    return lr_import_shown(buffer, 80, name ? name : "");
}

/* ---- Cameras ------------------------------------------------------------------------------- */

static lr_status add_camera(lr_import *import, const json_t *node, const json_t *from,
                            const lr_transform *to_world)
{
    const json_t *perspective = json_object_get(from, "perspective");
    double yfov = lr_gltf_number(perspective, "yfov", 0);
    char name[80];
    shown_name(from, name);
    if (!name[0])
        shown_name(node, name);
    if (!perspective)
        return lr_import_note(import, "camera \"%s\": left out, only perspective ones are read",
                              name);
    lr_vec3 eye = lr_transform_point(to_world, (lr_vec3){0, 0, 0});
    lr_vec3 view = lr_vec3_normalize(lr_transform_vector(to_world, (lr_vec3){0, 0, -1}));
    lr_vec3 up = lr_vec3_normalize(lr_transform_vector(to_world, (lr_vec3){0, 1, 0}));
    double degrees = yfov * 180 / PI;
    bool parallel = !(lr_vec3_length(lr_vec3_cross(view, up)) > 1e-6);
    if (!(degrees > 0 && degrees < 180) || parallel)
        return lr_import_note(import,
                              "camera \"%s\": left out, its yfov or transform is not usable", name);
    /* Far enough for coordinates of any size: where it looks matters, not how far. */
    double reach = fmax(1, fmax(fabs(eye.x), fmax(fabs(eye.y), fabs(eye.z))));
    lr_camera *camera = lr_scene_add_camera(import->builder);
    if (!camera)
        return lr_import_no_memory(import);
    *camera = (lr_camera){
        .from = eye, .to = lr_vec3_add(eye, lr_vec3_scale(view, reach)), .up = up, .fov = degrees};
    if (!name[0])
        snprintf(name, sizeof name, "camera %u", import->builder->scene->camera_count);
    camera->name = lr_string_copy(name, strlen(name));
    return camera->name ? LR_OK : lr_import_no_memory(import);
}

/* ---- Lights -------------------------------------------------------------------------------- */

static lr_color light_color(const json_t *from)
{
    double c[3] = {1, 1, 1};
    numbers(from, "color", 3, c);
    for (int i = 0; i < 3; i++)
        c[i] = c[i] >= 0 ? fmin(c[i], 1) : 0;
    return (lr_color){c[0], c[1], c[2]};
}

/* Candela and lux become what a white matt surface sends on: ours has no 1 / pi of its own. */
static lr_status add_light(lr_import *import, const json_t *from, const lr_transform *to_world)
{
    const char *type = json_string_value(json_object_get(from, "type"));
    const json_t *spot = json_object_get(from, "spot");
    double intensity = lr_gltf_number(from, "intensity", 1) / PI;
    double outer = lr_gltf_number(spot, "outerConeAngle", PI / 4) * 180 / PI;
    double inner = lr_gltf_number(spot, "innerConeAngle", 0) * 180 / PI;
    char name[80];
    shown_name(from, name);
    lr_light light = {.color = light_color(from),
                      .intensity = intensity >= 0 ? fmin(intensity, LR_COLOR_MAX) : 0,
                      .falloff = 2,
                      .position = lr_transform_point(to_world, (lr_vec3){0, 0, 0}),
                      .direction =
                          lr_vec3_normalize(lr_transform_vector(to_world, (lr_vec3){0, 0, -1})),
                      .shadows = true};
    if (type && strcmp(type, "point") == 0) {
        light.kind = LR_LIGHT_POINT;
    } else if (type && strcmp(type, "directional") == 0) {
        light.kind = LR_LIGHT_DIRECTIONAL;
        light.falloff = 0;
    } else if (type && strcmp(type, "spot") == 0 && outer > 0) {
        light.kind = LR_LIGHT_SPOT;
        light.angle = fmin(outer, 90);
        light.inner = inner >= 0 ? fmin(inner, light.angle) : 0;
    } else {
        return lr_import_note(import, "light \"%s\": left out, it is no point, directional or spot",
                              name);
    }
    if (import->builder->scene->light_count == LR_LIGHTS_MAX)
        return lr_import_note(import, "light \"%s\": left out, a scene has at most %d", name,
                              LR_LIGHTS_MAX);
    lr_light *added = lr_scene_add_light(import->builder);
    if (!added)
        return lr_import_no_memory(import);
    *added = light;
    if (json_object_get(from, "range"))
        return lr_import_note(import, "light \"%s\": its range is not used, it reaches on", name);
    return LR_OK;
}

/* ---- Nodes --------------------------------------------------------------------------------- */

static const json_t *item_at(const json_t *list, const json_t *index)
{
    return json_is_integer(index) && json_integer_value(index) >= 0
               ? json_array_get(list, (size_t)json_integer_value(index))
               : NULL;
}

static bool push(visits *stack, const json_t *list, const lr_transform *around)
{
    for (size_t i = json_array_size(list); i-- > 0;) {
        if (!lr_array_reserve((void **)&stack->items, stack->count, &stack->capacity,
                              sizeof *stack->items))
            return false;
        stack->items[stack->count++] =
            (visit){(size_t)json_integer_value(json_array_get(list, i)), *around};
    }
    return true;
}

static lr_status visit_node(lr_import *import, const visit *at, visits *stack)
{
    const json_t *json = import->json;
    const json_t *node = json_array_get(json_object_get(json, "nodes"), at->node);
    const json_t *lights =
        json_object_get(lr_gltf_extension(json, "KHR_lights_punctual"), "lights");
    const json_t *camera =
        item_at(json_object_get(json, "cameras"), json_object_get(node, "camera"));
    const json_t *light =
        item_at(lights, json_object_get(lr_gltf_extension(node, "KHR_lights_punctual"), "light"));
    lr_transform own = node_transform(node);
    lr_transform to_world = lr_transform_multiply(at->around, own);
    lr_status status = LR_OK;
    if (!lr_transform_usable(&to_world)) /* noted with the objects */
        return LR_OK;
    if (camera)
        status = add_camera(import, node, camera, &to_world);
    if (!status && light)
        status = add_light(import, light, &to_world);
    if (!status && !push(stack, json_object_get(node, "children"), &to_world))
        status = lr_import_no_memory(import);
    return status;
}

lr_status lr_gltf_view(lr_import *import)
{
    visits stack = {0};
    lr_transform world = lr_transform_identity();
    /* lr_gltf_check has seen that these exist and that the nodes are a tree. */
    const json_t *scene = json_array_get(json_object_get(import->json, "scenes"),
                                         (size_t)lr_gltf_number(import->json, "scene", 0));
    lr_status status = LR_OK;
    if (!push(&stack, json_object_get(scene, "nodes"), &world))
        status = lr_import_no_memory(import);
    while (!status && stack.count > 0) {
        visit next = stack.items[--stack.count];
        status = visit_node(import, &next, &stack);
    }
    free(stack.items);
    return status;
}
