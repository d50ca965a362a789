/* Every number goes into the hash in little-endian bytes: counts, kinds, indices and switches as
 * uint32, coordinates as float64, what meshes and textures hold as float32 or bytes; -0 as +0. The
 * order is that of docs/info.md. */
#include "scene/fingerprint.h"

#include "scene/color.h"

#include <sha2.h>
#include <string.h>

#include "base/hash.h"
#include "scene/camera.h"
#include "scene/moment.h"

typedef struct hasher {
    SHA2_CTX context;
    size_t used;
    unsigned char block[4096];
} hasher;

static void put_bytes(hasher *h, const uint8_t *bytes, size_t count)
{
    lr_hash_update(&h->context, h->block, h->used);
    lr_hash_update(&h->context, bytes, count);
    h->used = 0;
}

static void put_word(hasher *h, uint64_t word, unsigned bytes)
{
    if (h->used + bytes > sizeof h->block) {
        lr_hash_update(&h->context, h->block, h->used);
        h->used = 0;
    }
    for (unsigned i = 0; i < bytes; i++)
        h->block[h->used++] = (unsigned char)(word >> 8 * i);
}

static void put_count(hasher *h, uint32_t value)
{
    put_word(h, value, 4);
}

static void put_number(hasher *h, double value)
{
    uint64_t bits;
    value = value == 0 ? 0 : value;
    memcpy(&bits, &value, sizeof bits);
    put_word(h, bits, 8);
}

static void put_numbers(hasher *h, const double *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        put_number(h, values[i]);
}

static void put_vector(hasher *h, lr_vec3 v)
{
    put_numbers(h, &v.x, 3);
}

/* Nothing when there are none. */
static void put_floats(hasher *h, const float *values, size_t count)
{
    for (size_t i = 0; values && i < count; i++) {
        uint32_t bits;
        float value = values[i] == 0 ? 0 : values[i];
        memcpy(&bits, &value, sizeof bits);
        put_word(h, bits, 4);
    }
}

static void put_background(hasher *h, const lr_background *b)
{
    put_count(h, b->kind);
    put_vector(h, b->colors[0]);
    put_vector(h, b->colors[1]);
    put_count(h, b->texture);
    put_number(h, b->intensity);
    put_number(h, b->rotate);
    put_vector(h, b->sun);
    put_number(h, b->turbidity);
    put_vector(h, b->ground);
}

static void put_surroundings(hasher *h, const lr_scene *scene)
{
    put_count(h, scene->image.width);
    put_count(h, scene->image.height);
    put_count(h, scene->image.samples);
    put_count(h, scene->image.depth);
    put_count(h, scene->image.seed);
    put_number(h, scene->image.min_weight);
    put_number(h, scene->image.exposure);
    put_count(h, scene->image.integrator);
    put_count(h, scene->image.filter);
    put_count(h, scene->image.tone);
    put_number(h, scene->image.white);
    put_vector(h, scene->ambient);
    put_background(h, &scene->background);
    put_vector(h, scene->background_up);
    put_number(h, scene->fog_density);
    put_vector(h, scene->fog_density > 0 ? scene->fog_color : (lr_color){0, 0, 0});
    if (!lr_color_is_black(scene->air.absorption) || !lr_color_is_black(scene->air.scattering)) {
        put_vector(h, scene->air.absorption);
        put_vector(h, scene->air.scattering);
        put_number(h, scene->air.anisotropy);
    }
}

static void put_camera(hasher *h, const lr_camera *camera)
{
    put_vector(h, camera->from);
    put_vector(h, camera->to);
    put_vector(h, camera->up);
    put_number(h, camera->fov);
    put_count(h, camera->fov_to_centers);
    put_count(h, camera->projection);
    put_number(h, camera->height);
    put_number(h, camera->aperture);
    put_number(h, camera->focus);
    put_count(h, camera->blades);
    put_number(h, camera->blade_rotation);
    lr_camera closing = lr_camera_closing(camera);
    put_vector(h, closing.from);
    put_vector(h, closing.to);
    put_vector(h, closing.up);
    put_number(h, closing.fov);
    put_number(h, closing.height);
}

static void put_light(hasher *h, const lr_light *light)
{
    put_count(h, light->kind);
    put_vector(h, light->color);
    put_number(h, light->intensity);
    put_number(h, light->falloff);
    put_vector(h, light->position);
    put_vector(h, light->direction);
    put_number(h, light->angle);
    put_number(h, light->inner);
    put_number(h, light->radius);
    put_count(h, light->shadows);
}

static void put_pattern(hasher *h, const lr_pattern *p)
{
    put_count(h, p->kind);
    put_count(h, p->object_space);
    put_vector(h, p->colors[0]);
    put_vector(h, p->colors[1]);
    put_count(h, p->texture);
    put_number(h, p->size);
    put_vector(h, p->origin);
    put_vector(h, p->direction);
}

static void put_material(hasher *h, const lr_material *m)
{
    put_pattern(h, &m->color);
    const lr_color *colors[] = {&m->ambient,  &m->diffuse,  &m->specular,  &m->reflect,
                                &m->transmit, &m->emission, &m->absorption};
    for (size_t i = 0; i < sizeof colors / sizeof *colors; i++)
        put_vector(h, *colors[i]);
    put_number(h, m->shininess);
    put_count(h, m->highlight);
    put_number(h, m->ior);
    put_count(h, m->fresnel);
    put_count(h, (uint32_t)m->priority);
    put_number(h, m->alpha_cutoff);
    put_count(h, m->one_sided);
    put_count(h, m->emits);
    put_count(h, m->model);
    const double physical[] = {m->roughness,           m->metallic,
                               m->transmission,        m->clearcoat,
                               m->clearcoat_roughness, m->sheen_roughness};
    put_numbers(h, physical, sizeof physical / sizeof *physical);
    put_vector(h, m->eta);
    put_vector(h, m->k);
    put_vector(h, m->sheen);
    for (int i = 0; i < LR_MAP_COUNT; i++) {
        put_count(h, m->maps[i].given);
        put_count(h, m->maps[i].texture);
        put_count(h, m->maps[i].channel);
        put_number(h, m->maps[i].amount);
    }
    if (!lr_color_is_black(m->scattering)) {
        put_vector(h, m->scattering);
        put_number(h, m->anisotropy);
    }
    if (m->model == LR_MODEL_MIX) {
        put_count(h, m->mix.first);
        put_count(h, m->mix.second);
        put_pattern(h, &m->mix.weight);
    }
}

static void put_shape(hasher *h, const lr_object *object)
{
    switch (object->kind) {
    case LR_SPHERE:
        put_vector(h, object->sphere.center);
        put_number(h, object->sphere.radius);
        break;
    case LR_PLANE:
        put_vector(h, object->plane.normal);
        put_number(h, object->plane.offset);
        break;
    case LR_BOX:
        put_vector(h, object->box.min);
        put_vector(h, object->box.max);
        break;
    case LR_DISK:
        put_vector(h, object->disk.center);
        put_vector(h, object->disk.normal);
        put_number(h, object->disk.radius);
        break;
    case LR_RECTANGLE:
        put_vector(h, object->rectangle.corner);
        put_vector(h, object->rectangle.u);
        put_vector(h, object->rectangle.v);
        break;
    case LR_CYLINDER:
    case LR_CONE:
        put_vector(h, object->cone.from);
        put_vector(h, object->cone.to);
        put_number(h, object->cone.radius_from);
        put_number(h, object->cone.radius_to);
        break;
    case LR_TRIANGLE:
        put_vector(h, object->triangle.a);
        put_vector(h, object->triangle.b);
        put_vector(h, object->triangle.c);
        break;
    case LR_MESH:
        put_count(h, object->mesh);
        break;
    }
}

static void put_object(hasher *h, const lr_object *object)
{
    put_count(h, object->kind);
    put_count(h, object->material);
    put_count(h, object->shadow);
    put_count(h, object->open);
    put_count(h, object->inward);
    put_numbers(h, object->to_world.m[0], 4);
    put_numbers(h, object->to_world.m[1], 4);
    put_numbers(h, object->to_world.m[2], 4);
    put_shape(h, object);
}

static void put_mesh(hasher *h, const lr_mesh *mesh)
{
    size_t vertices = mesh->vertex_count, corners = 3 * (size_t)mesh->triangle_count;
    put_count(h, mesh->vertex_count);
    put_count(h, mesh->triangle_count);
    put_count(h, mesh->closed);
    put_count(h, mesh->normals != NULL);
    put_count(h, mesh->uvs != NULL);
    put_count(h, mesh->colors != NULL);
    put_floats(h, mesh->positions, 3 * vertices);
    put_floats(h, mesh->normals, 3 * vertices);
    put_floats(h, mesh->uvs, 2 * vertices);
    put_floats(h, mesh->colors, 3 * vertices);
    for (size_t i = 0; i < corners; i++)
        put_count(h, mesh->triangles[i]);
}

static void put_texture(hasher *h, const lr_texture *texture)
{
    size_t texels = (size_t)texture->width * texture->height;
    put_count(h, texture->width);
    put_count(h, texture->height);
    put_count(h, texture->wrap_u);
    put_count(h, texture->wrap_v);
    put_count(h, texture->texels);
    put_count(h, texture->floats != NULL);
    if (texture->bytes)
        put_bytes(h, texture->bytes, 4 * texels);
    put_floats(h, texture->floats, 3 * texels);
}

/* Nothing where all but cameras stand still, so that scenes without keys keep their hash. */
static void put_motion(hasher *h, const lr_scene *scene)
{
    if (!lr_scene_blurs_any(scene))
        return;
    put_word(h, scene->motion, 8);
    for (uint32_t i = 0; i < scene->camera_count; i++)
        put_number(h, scene->cameras[i].shutter);
}

void lr_scene_hash(const lr_scene *scene, char hash[65])
{
    unsigned char digest[SHA256_DIGEST_LENGTH];
    hasher h = {.used = 0};
    SHA256Init(&h.context);
    put_surroundings(&h, scene);
    put_count(&h, scene->camera_count);
    for (uint32_t i = 0; i < scene->camera_count; i++)
        put_camera(&h, &scene->cameras[i]);
    put_count(&h, scene->default_light);
    put_count(&h, scene->light_count);
    for (uint32_t i = 0; i < scene->light_count; i++)
        put_light(&h, &scene->lights[i]);
    put_count(&h, scene->material_count);
    for (uint32_t i = 0; i < scene->material_count; i++)
        put_material(&h, &scene->materials[i]);
    put_count(&h, scene->object_count);
    for (uint32_t i = 0; i < scene->object_count; i++)
        put_object(&h, &scene->objects[i]);
    put_count(&h, scene->mesh_count);
    for (uint32_t i = 0; i < scene->mesh_count; i++)
        put_mesh(&h, &scene->meshes[i]);
    put_count(&h, scene->texture_count);
    for (uint32_t i = 0; i < scene->texture_count; i++)
        put_texture(&h, &scene->textures[i]);
    put_motion(&h, scene);
    put_bytes(&h, NULL, 0);
    SHA256Final(digest, &h.context);
    lr_hash_text(digest, hash);
}
