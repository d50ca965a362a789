/* The objects with their materials, and the media that they enclose. */
#include "render/pack_internal.h"

#include <math.h>
#include <stdlib.h>

#include "base/exact.h"
#include "base/memory.h"

#define LOG2_E 1.4426950408889634

/* Media in the order of their rank: by priority, then by their place in the scene. */
typedef struct medium_order {
    int priority;
    uint32_t object;
} medium_order;

static int compare_media(const void *a, const void *b)
{
    const medium_order *x = a, *y = b;
    if (x->priority != y->priority)
        return x->priority < y->priority ? -1 : 1;
    return x->object < y->object ? -1 : x->object > y->object;
}

static const lr_material *material_of(const lr_scene *scene, uint32_t object)
{
    return &scene->materials[scene->objects[object].material];
}

static bool encloses_medium(const lr_material *m, const lr_primitive *p)
{
    return p->encloses && !lr_color_is_black(m->transmit) && !m->pane;
}

/* A record of the table of media; of paths all that takes light away is one. */
static bool pack_medium(lr_color absorption, lr_color scattering, double anisotropy, double ior,
                        lr_packed_scene *packed)
{
    bool scatters = !lr_color_is_black(scattering) && packed->constants[LR_SPEC_PATH];
    packed->constants[LR_SPEC_SCATTERING] |= scatters;
    struct gpu_medium medium = {.ior = (float)ior};
    if (scatters) {
        absorption = lr_vec3_add(absorption, scattering);
        medium.scattering = lr_pack_vec3(lr_vec3_scale(scattering, LOG2_E));
        medium.anisotropy = (float)anisotropy;
    }
    medium.absorption = lr_pack_vec3(lr_vec3_scale(absorption, LOG2_E));
    return lr_pack_rows(packed, &medium, sizeof medium / 16) != UINT32_MAX;
}

/* Packs the table of media and gives the ranks of the objects' media in ranks[]. */
static lr_status pack_media(const lr_scene *scene, const lr_primitive *primitives, uint32_t *ranks,
                            lr_packed_scene *packed, lr_error *error)
{
    medium_order *order = lr_alloc(scene->object_count, sizeof *order);
    if (!order)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for the scene's media");
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->object_count; i++) {
        const lr_material *m = material_of(scene, i);
        if (encloses_medium(m, &primitives[i]))
            order[count++] = (medium_order){m->priority, i};
    }
    qsort(order, count, sizeof *order, compare_media);

    bool paths = packed->constants[LR_SPEC_PATH];
    lr_color absorption = paths ? scene->air.absorption : (lr_color){0, 0, 0};
    packed->constants[LR_SPEC_SCATTERING] = !lr_color_is_black(absorption);
    packed->frame.media = packed->row_count;
    bool fits = pack_medium(absorption, scene->air.scattering, scene->air.anisotropy, 1, packed);
    for (uint32_t i = 0; fits && i < count; i++) {
        uint32_t object = order[i].object;
        const lr_material *m = material_of(scene, object);
        ranks[object] = i + 1;
        fits = pack_medium(m->absorption, m->scattering, m->anisotropy, m->ior, packed);
        packed->constants[LR_SPEC_MEDIA] = 1;
        packed->constants[LR_SPEC_ABSORPTION] |= !lr_color_is_black(m->absorption);
    }
    free(order);
    return fits ? LR_OK : lr_fail(error, LR_ERROR_MEMORY, "out of memory for the scene's media");
}

/* A transmitted share as optical depth in shadows. */
static uint32_t shadow_depth(double transmit)
{
    if (transmit <= 0)
        return LR_SHADOW_OPAQUE;
    double depth = -lr_log2(transmit) * LR_SHADOW_UNIT;
    return depth < LR_SHADOW_OPAQUE ? (uint32_t)floor(depth + 0.5) : LR_SHADOW_OPAQUE;
}

static void set_ids(lr_primitive *p, uint32_t object, uint32_t flags)
{
    switch (p->list) {
    case LR_SPHERES:
        p->record.sphere.object = object;
        p->record.sphere.flags = flags;
        break;
    case LR_PLANES:
        p->record.plane.object = object;
        p->record.plane.flags = flags;
        break;
    case LR_FLATS:
        p->record.flat.object = object;
        p->record.flat.flags |= flags;
        break;
    default:
        p->record.solid.object = object;
        p->record.solid.flags |= flags;
    }
}

static uint32_t flags_of(const lr_scene *scene, uint32_t object, const lr_primitive *p)
{
    const lr_material *m = material_of(scene, object);
    bool inward = scene->objects[object].inward;
    return (p->encloses && !m->pane ? LR_FLAG_SOLID : 0) |
           (lr_color_is_black(m->transmit) ? 0 : LR_FLAG_TRANSPARENT) |
           (scene->objects[object].shadow ? LR_FLAG_SHADOW : 0) | (inward ? LR_FLAG_INWARD : 0) |
           ((m->one_sided || inward) && p->sided ? LR_FLAG_ONE_SIDED : 0);
}

static void note_use(uint32_t *constants, lr_list_kind list, uint32_t flags)
{
    uint32_t casts_light = LR_FLAG_SHADOW | LR_FLAG_TRANSPARENT;
    bool transparent = (flags & casts_light) == casts_light;
    constants[LR_SPEC_TRANSPARENT] |= transparent;
    constants[LR_SPEC_TRANSPARENT_PLANES] |=
        list == LR_PLANES && (transparent || constants[LR_SPEC_CUTOUTS]);
    constants[LR_SPEC_ONE_SIDED] |= (flags & (LR_FLAG_ONE_SIDED | LR_FLAG_INWARD)) != 0;
}

/* What every object becomes, for the time of packing. */
typedef struct drafts {
    lr_primitive *primitives;
    uint32_t *ranks, *flags, *instances;
} drafts;

static bool pack_object_record(const lr_scene *scene, uint32_t index, const drafts *d,
                               lr_packed_scene *packed)
{
    const lr_object *object = &scene->objects[index];
    lr_transform inverse = lr_pack_inverse(&object->to_world);
    lr_color transmit = material_of(scene, index)->transmit;
    struct gpu_object record = {
        .row0 = lr_pack_row(inverse.m[0], 1),
        .row1 = lr_pack_row(inverse.m[1], 1),
        .row2 = lr_pack_row(inverse.m[2], 1),
        .material = object->material,
        .flags = d->flags[index],
        .rank = d->ranks[index],
        .instance = d->instances[index],
        .shadow_red = shadow_depth(transmit.x),
        .shadow_green = shadow_depth(transmit.y),
        .shadow_blue = shadow_depth(transmit.z),
        .shadow_rank = d->flags[index] & LR_FLAG_SOLID ? d->ranks[index] : 0,
    };
    return lr_pack_rows(packed, &record, sizeof record / 16) != UINT32_MAX;
}

static lr_status pack_drafts(const lr_scene *scene, drafts *d, lr_packed_scene *packed,
                             lr_error *error)
{
    uint32_t count = scene->object_count;
    for (uint32_t i = 0; i < count; i++) {
        if (!lr_pack_shape(scene, &scene->objects[i], &d->primitives[i]))
            return lr_fail(error, LR_ERROR_SCENE,
                           "%s:%u: the object is too thin: its shortest extent must be at least "
                           "1e-9 of its longest",
                           scene->source, scene->objects[i].line);
        d->flags[i] = flags_of(scene, i, &d->primitives[i]);
        note_use(packed->constants, d->primitives[i].list, d->flags[i]);
        if (d->primitives[i].list != LR_MESHES)
            set_ids(&d->primitives[i], i, d->flags[i]);
    }
    lr_status status = pack_media(scene, d->primitives, d->ranks, packed, error);
    if (!status)
        status = lr_pack_lists(d->primitives, count, packed, error);
    if (!status)
        status = lr_pack_meshes(scene, d->flags, d->instances, packed, error);
    if (status)
        return status;
    lr_pack_cells(packed);
    packed->frame.objects = packed->row_count;
    for (uint32_t i = 0; i < count; i++)
        if (!pack_object_record(scene, i, d, packed))
            return lr_fail(error, LR_ERROR_MEMORY, "out of memory for the scene's objects");
    bool paths = packed->constants[LR_SPEC_PATH];
    return paths ? lr_pack_emitters(scene, d->primitives, packed, error) : LR_OK;
}

lr_status lr_pack_objects(const lr_scene *scene, lr_packed_scene *packed, lr_error *error)
{
    uint32_t count = scene->object_count;
    drafts d = {
        .primitives = lr_alloc(count, sizeof *d.primitives),
        .ranks = lr_alloc(count, sizeof *d.ranks),
        .flags = lr_alloc(count, sizeof *d.flags),
        .instances = lr_alloc(count, sizeof *d.instances),
    };
    lr_status status = LR_OK;
    if (d.primitives && d.ranks && d.flags && d.instances)
        status = pack_drafts(scene, &d, packed, error);
    else
        status = lr_fail(error, LR_ERROR_MEMORY, "out of memory for the scene's objects");
    free(d.primitives);
    free(d.ranks);
    free(d.flags);
    free(d.instances);
    return status;
}
