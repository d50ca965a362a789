/* From the kernels' notes, which stand in no order, to the tree of rays. */
#include "render/explain_internal.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

/* One of the notes that belong to something, in the order that they are told in. */
typedef struct sorted_note {
    uint32_t owner, note; /* number of the owner's note, index of this one */
    float distance;
    uint32_t index; /* of the light or object */
} sorted_note;

typedef struct tree {
    const struct gpu_notes *notes;
    const lr_packed_scene *packed;
    lr_explanation *out;
    uint32_t (*children)[2]; /* by note number: notes of the reflected and the other child */
    sorted_note *lights, *obstacles; /* each sorted by owner */
    uint32_t *objects_by_rank;
    uint32_t object_count;
} tree;

static int compare_notes(const void *a, const void *b)
{
    const sorted_note *x = a, *y = b;
    if (x->owner != y->owner)
        return x->owner < y->owner ? -1 : 1;
    if (x->distance != y->distance)
        return x->distance < y->distance ? -1 : 1;
    return x->index < y->index ? -1 : x->index > y->index;
}

/* The first note of an owner. */
static const sorted_note *find_owned(const sorted_note *notes, uint32_t count, uint32_t owner)
{
    uint32_t low = 0, high = count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (notes[middle].owner < owner)
            low = middle + 1;
        else
            high = middle;
    }
    return notes + low;
}

static void copy3(float to[3], vec3 from)
{
    to[0] = from.x;
    to[1] = from.y;
    to[2] = from.z;
}

static void copy_steps(uint64_t to[3], const uint32_t words[6])
{
    for (int c = 0; c < 3; c++)
        to[c] = words[2 * c] | (uint64_t)words[2 * c + 1] << 32;
}

static void add_steps(uint64_t to[3], const uint64_t more[3])
{
    for (int c = 0; c < 3; c++)
        to[c] += more[c];
}

static struct gpu_object packed_object(const lr_packed_scene *packed, uint32_t index)
{
    struct gpu_object record;
    size_t row = packed->frame.objects + sizeof record / 16 * (size_t)index;
    memcpy(&record, &packed->rows[row], sizeof record);
    return record;
}

/* Where a ray meets a primitive, in metres: the nearest crossing that is ahead. */
static float nearest(const gpu_obstacle_note *note)
{
    return note->t0 > 0 ? note->t0 : note->t1;
}

/* The number of a primitive in its mesh. */
static uint32_t triangle_of(const lr_packed_scene *packed, uint32_t primitive)
{
    struct gpu_triangle record;
    const gpu_list *list = &packed->frame.triangles;
    if (primitive < list->begin || primitive >= list->end)
        return LR_NO_INDEX;
    uint32_t row = list->base + (uint32_t)(sizeof record / 16) * primitive;
    memcpy(&record, &packed->rows[row], sizeof record);
    return record.order;
}

static uint32_t object_of_rank(const tree *t, uint32_t rank)
{
    return rank == 0 || rank > t->object_count ? LR_NO_INDEX : t->objects_by_rank[rank];
}

static bool find_ranks(tree *t)
{
    t->objects_by_rank = lr_alloc(t->object_count + 1, sizeof *t->objects_by_rank);
    for (uint32_t i = 0; t->objects_by_rank && i < t->object_count; i++) {
        uint32_t rank = packed_object(t->packed, i).rank;
        if (rank <= t->object_count)
            t->objects_by_rank[rank] = i;
    }
    return t->objects_by_rank;
}

static bool find_children(tree *t)
{
    const struct gpu_notes *n = t->notes;
    t->children = lr_alloc(n->rays + 1, sizeof *t->children);
    for (uint32_t i = 0; t->children && i < n->rays; i++) {
        uint32_t parent = n->ray[i].parent;
        bool reflected =
            (n->ray[i].state & LR_STATE_KIND) >> LR_STATE_KIND_SHIFT == LR_KIND_REFLECTED;
        if (parent <= n->rays)
            t->children[parent][!reflected] = i + 1;
    }
    return t->children;
}

static bool sort_notes(tree *t)
{
    const struct gpu_notes *n = t->notes;
    t->lights = lr_alloc(n->lights, sizeof *t->lights);
    t->obstacles = lr_alloc(n->obstacles, sizeof *t->obstacles);
    if (!t->lights || !t->obstacles)
        return false;
    for (uint32_t i = 0; i < n->lights; i++)
        t->lights[i] = (sorted_note){n->light[i].ray, i, 0, n->light[i].light};
    for (uint32_t i = 0; i < n->obstacles; i++)
        t->obstacles[i] =
            (sorted_note){n->obstacle[i].light, i, nearest(&n->obstacle[i]), n->obstacle[i].object};
    qsort(t->lights, n->lights, sizeof *t->lights, compare_notes);
    qsort(t->obstacles, n->obstacles, sizeof *t->obstacles, compare_notes);
    return true;
}

static void add_obstacles(const tree *t, uint32_t light_note, lr_explained_light *light)
{
    lr_explanation *out = t->out;
    uint32_t count = t->notes->obstacles;
    light->first_obstacle = out->obstacle_count;
    const sorted_note *s = find_owned(t->obstacles, count, light_note);
    for (; s < t->obstacles + count && s->owner == light_note; s++) {
        lr_explained_obstacle *o = &out->obstacles[out->obstacle_count++];
        *o = (lr_explained_obstacle){.object = s->index, .distance = s->distance};
        copy3(o->left, t->notes->obstacle[s->note].left);
    }
    light->obstacle_count = out->obstacle_count - light->first_obstacle;
}

static void add_light(const tree *t, uint32_t index)
{
    const gpu_light_note *n = &t->notes->light[index];
    lr_explained_light *light = &t->out->lights[t->out->light_count++];
    *light = (lr_explained_light){
        .light = n->light,
        .distance = n->distance < (float)LR_T_MAX ? n->distance : 0,
        .attenuation = n->attenuation,
        .spot = n->spot,
        .cosine = n->cosine,
        .highlight = n->highlight,
        .tested = n->reaches,
    };
    copy3(light->origin, n->origin);
    copy3(light->wi, n->wi);
    copy3(light->arriving, n->arriving);
    copy3(light->unshadowed, n->value);
    copy3(light->left, n->left);
    copy_steps(light->steps, n->steps);
    add_obstacles(t, index + 1, light);
}

static void add_lights(const tree *t, uint32_t ray_note, lr_explained_ray *ray)
{
    uint32_t count = t->notes->lights;
    ray->first_light = t->out->light_count;
    const sorted_note *s = find_owned(t->lights, count, ray_note);
    for (; s < t->lights + count && s->owner == ray_note; s++) {
        add_light(t, s->note);
        add_steps(ray->steps, t->out->lights[t->out->light_count - 1].steps);
    }
    ray->light_count = t->out->light_count - ray->first_light;
}

static void fill_surface(const tree *t, const gpu_ray_note *n, lr_explained_ray *ray)
{
    ray->object = n->object;
    ray->triangle = triangle_of(t->packed, n->primitive);
    copy3(ray->position, n->position);
    copy3(ray->normal, n->normal);
    copy3(ray->lit_by, n->lit_by);
    ray->cosine = n->cosine;
    copy3(ray->color, n->color);
    ray->entering = n->flags & LR_NOTE_ENTERING;
    ray->lit = n->flags & LR_NOTE_LIT;
    ray->hidden = n->flags & LR_NOTE_HIDDEN;
    ray->hole = n->flags & LR_NOTE_HOLE;
    ray->lost = n->flags & LR_NOTE_LOST;
    copy3(ray->ambient, n->ambient);
    copy3(ray->emission, n->emission);
    ray->bends = n->flags & LR_NOTE_BENDS;
    ray->total = n->flags & LR_NOTE_TOTAL;
    ray->fresnel = n->flags & LR_NOTE_FRESNEL;
    ray->medium_beyond = object_of_rank(t, n->medium_beyond);
    ray->ior = n->ior;
    ray->ior_beyond = n->ior_beyond;
    ray->refracted_cosine = n->refracted_cosine;
    ray->reflectance = n->reflectance;
    copy3(ray->reflect_weight, n->reflect_weight);
    copy3(ray->transmit_weight, n->transmit_weight);
}

static lr_ray_kind kind_of(const gpu_ray_note *n, bool onward)
{
    static const lr_ray_kind kinds[4] = {
        [LR_KIND_PRIMARY] = LR_RAY_CAMERA,
        [LR_KIND_REFLECTED] = LR_RAY_REFLECTED,
        [LR_KIND_REFRACTED] = LR_RAY_REFRACTED,
    };
    return onward ? LR_RAY_ONWARD : kinds[(n->state & LR_STATE_KIND) >> LR_STATE_KIND_SHIFT];
}

static void fill_ray(const tree *t, const gpu_ray_note *n, lr_explained_ray *ray)
{
    ray->depth = n->state & LR_STATE_DEPTH;
    ray->passed = n->state >> LR_STATE_PASSES_SHIFT;
    copy3(ray->origin, n->origin);
    copy3(ray->direction, n->direction);
    copy3(ray->weight, n->weight);
    ray->t = n->t;
    ray->medium = object_of_rank(t, n->medium);
    copy3(ray->weight_there, n->weight_there);
    copy3(ray->fog, n->fog);
    copy_steps(ray->fog_steps, n->fog_steps);
    copy_steps(ray->own_steps, n->own_steps);
    copy3(ray->background, n->background);
    if (n->primitive != LR_PRIMITIVE_NONE)
        fill_surface(t, n, ray);
    add_steps(ray->steps, ray->fog_steps);
    add_steps(ray->steps, ray->own_steps);
}

static uint32_t new_ray(const tree *t, uint32_t parent, lr_ray_kind kind)
{
    lr_explained_ray *ray = &t->out->rays[t->out->ray_count];
    *ray = (lr_explained_ray){
        .parent = parent,
        .kind = kind,
        .medium = LR_NO_INDEX,
        .object = LR_NO_INDEX,
        .triangle = LR_NO_INDEX,
        .medium_beyond = LR_NO_INDEX,
    };
    return t->out->ray_count++;
}

/* A child that was not traced. */
static void add_cut(const tree *t, uint32_t parent, const gpu_ray_note *n, bool reflected,
                    uint32_t fate)
{
    lr_ray_kind kind = reflected ? LR_RAY_REFLECTED : LR_RAY_REFRACTED;
    lr_explained_ray *ray = &t->out->rays[new_ray(t, parent, kind)];
    ray->cut = fate == LR_FATE_TOO_DEEP ? LR_CUT_DEPTH : LR_CUT_WEIGHT;
    ray->depth = t->out->rays[parent].depth + 1;
    copy3(ray->origin, n->position);
    copy3(ray->direction, reflected ? n->reflected : n->refracted);
    copy3(ray->weight, reflected ? n->reflect_weight : n->transmit_weight);
}

/* Appends a ray and all that comes from it, at most LR_GENERATIONS_MAX deep; returns its index. */
static uint32_t add_ray(const tree *t, uint32_t note, uint32_t parent, bool onward)
{
    const gpu_ray_note *n = &t->notes->ray[note - 1];
    uint32_t index = new_ray(t, parent, kind_of(n, onward));
    lr_explained_ray *rays = t->out->rays;
    fill_ray(t, n, &rays[index]);
    add_lights(t, note, &rays[index]);
    bool passes = n->flags & (LR_NOTE_HIDDEN | LR_NOTE_HOLE);
    const uint32_t fates[2] = {n->flags >> LR_NOTE_REFLECTED_SHIFT & 3u,
                               n->flags >> LR_NOTE_REFRACTED_SHIFT & 3u};
    for (int i = 0; i < 2; i++) {
        uint32_t child = t->children[note][i];
        if (child)
            add_steps(rays[index].steps, rays[add_ray(t, child, index, passes)].steps);
        else if (fates[i] == LR_FATE_TOO_DEEP || fates[i] == LR_FATE_TOO_WEAK)
            add_cut(t, index, n, i == 0, fates[i]);
    }
    return index;
}

lr_status lr_explain_tree(const struct gpu_notes *notes, const lr_scene *scene,
                          const lr_packed_scene *packed, lr_explanation *explanation,
                          lr_error *error)
{
    lr_explanation *x = explanation;
    tree t = {.notes = notes, .packed = packed, .out = x, .object_count = scene->object_count};
    /* Of each ray two children at most are not traced. */
    x->rays = lr_alloc(3 * (size_t)notes->rays, sizeof *x->rays);
    x->lights = lr_alloc(notes->lights, sizeof *x->lights);
    x->obstacles = lr_alloc(notes->obstacles, sizeof *x->obstacles);
    lr_status status = LR_OK;
    if (!x->rays || !x->lights || !x->obstacles || !find_ranks(&t) || !find_children(&t) ||
        !sort_notes(&t)) {
        status = lr_fail(error, LR_ERROR_MEMORY, "out of memory for the tree of rays");
    } else if (!t.children[0][1]) {
        status = lr_fail(error, LR_ERROR_DEVICE, "the device noted no ray of the camera");
    } else {
        add_ray(&t, t.children[0][1], LR_NO_INDEX, false);
        memcpy(x->sample_steps, x->rays[0].steps, sizeof x->sample_steps);
    }
    free(t.children);
    free(t.lights);
    free(t.obstacles);
    free(t.objects_by_rank);
    return status;
}
