/* The light sources of paths, and how likely each is to be chosen. */
#include "render/emitters.h"

#include <stdlib.h>

#include "base/memory.h"
#include "render/choice.h"

/* Of all choices a share goes to all sources alike: power tells little of what lights a corner. */
#define EVEN_SHARE 0.125

static bool is_flat(uint32_t kind)
{
    return kind == LR_GPU_EMITTER_RECTANGLE || kind == LR_GPU_EMITTER_DISK ||
           kind == LR_GPU_EMITTER_TRIANGLE;
}

static void note_use(const lr_emitters *list, uint32_t *constants)
{
    constants[LR_SPEC_EMITTERS] = list->count > 0;
    for (uint32_t i = 0; i < list->count; i++) {
        uint32_t kind = list->items[i].record.kind & LR_GPU_EMITTER_KIND;
        constants[LR_SPEC_DELTA_LIGHTS] |= kind == LR_GPU_EMITTER_LIGHT;
        constants[LR_SPEC_SPHERE_EMITTERS] |= kind == LR_GPU_EMITTER_SPHERE;
        constants[LR_SPEC_SUN] |= kind == LR_GPU_EMITTER_SUN;
        constants[LR_SPEC_FLAT_EMITTERS] |= is_flat(kind);
        constants[LR_SPEC_DISK_EMITTERS] |= kind == LR_GPU_EMITTER_DISK;
        constants[LR_SPEC_TRIANGLE_EMITTERS] |= kind == LR_GPU_EMITTER_TRIANGLE;
    }
}

/* How often each is chosen, in steps of 1 / LR_CHOICE_STEPS; NULL when memory is out. */
static uint32_t *choose_steps(const lr_emitters *list)
{
    double *weights = lr_alloc(list->count, sizeof *weights), power = 0;
    uint32_t *steps = lr_alloc(list->count, sizeof *steps);
    for (uint32_t i = 0; i < list->count; i++)
        power += list->items[i].power;
    for (uint32_t i = 0; weights && i < list->count; i++)
        weights[i] = list->items[i].power / power + EVEN_SHARE / list->count;
    if (weights && steps)
        lr_choice_steps(weights, list->count, steps);
    if (!weights) {
        free(steps);
        steps = NULL;
    }
    free(weights);
    return steps;
}

/* The probabilities of emitters from `from` on up to `end`, which are all of one object, or one of
 * the lights. Where a ray meets the object it cannot tell which of them that is, so its area as a
 * whole counts. */
static void set_probabilities(lr_emitters *list, uint32_t from, uint32_t end, const uint32_t *steps,
                              struct gpu_object_emitter *objects)
{
    lr_emitter *first = &list->items[from];
    uint32_t kind = first->record.kind & LR_GPU_EMITTER_KIND;
    bool by_area = is_flat(kind);
    double area = 0, chosen = 0;
    for (uint32_t i = from; i < end; i++) {
        area += list->items[i].area;
        chosen += steps[i] / LR_CHOICE_STEPS;
    }
    double pdf = by_area ? chosen / area : chosen;
    for (uint32_t i = from; i < end; i++) {
        double extent = by_area ? list->items[i].area : 1;
        list->items[i].record.pdf = (float)pdf;
        list->items[i].record.inv_pdf = (float)(extent * LR_CHOICE_STEPS / steps[i]);
    }
    if (first->object != LR_NONE)
        objects[first->object] = (struct gpu_object_emitter){
            .center = first->record.origin,
            .kind = by_area ? LR_GPU_EMITTER_RECTANGLE : LR_GPU_EMITTER_SPHERE,
            .pdf = (float)pdf,
            .radius = first->record.radius,
        };
}

static void set_all_probabilities(lr_emitters *list, const uint32_t *steps,
                                  struct gpu_object_emitter *objects)
{
    for (uint32_t from = 0, end; from < list->count; from = end) {
        uint32_t object = list->items[from].object;
        end = from + 1;
        while (end < list->count && object != LR_NONE && list->items[end].object == object)
            end++;
        set_probabilities(list, from, end, steps, objects);
    }
}

/* Tells the background how likely it is chosen. */
static void set_background(const lr_emitters *list, const uint32_t *steps, lr_packed_scene *packed)
{
    double picture = 0, sun = 0;
    for (uint32_t i = 0; i < list->count; i++) {
        uint32_t kind = list->items[i].record.kind & LR_GPU_EMITTER_KIND;
        double chosen = steps[i] / LR_CHOICE_STEPS;
        picture += kind == LR_GPU_EMITTER_ENVIRONMENT ? chosen : 0;
        sun += kind == LR_GPU_EMITTER_SUN ? chosen : 0;
    }
    if (packed->constants[LR_SPEC_ENVIRONMENT])
        lr_pack_environment_choice(packed, picture, sun);
}

/* How pictures lie on emitters, whose records get to know the rows. */
static bool pack_emitter_maps(lr_emitters *list, lr_packed_scene *packed)
{
    bool fits = true;
    for (uint32_t i = 0; i < list->count && fits; i++) {
        lr_emitter *d = &list->items[i];
        if (!d->mapped)
            continue;
        d->record.light = lr_pack_rows(packed, &d->map, sizeof d->map / 16);
        fits = d->record.light != UINT32_MAX;
    }
    return fits;
}

static bool pack_choices(lr_emitters *list, const uint32_t *steps, lr_packed_scene *packed)
{
    uint32_t bits;
    struct gpu_choice *choices = lr_choice_table(steps, list->count, &bits);
    if (!choices)
        return false;
    bool fits = pack_emitter_maps(list, packed);
    uint32_t first = packed->row_count;
    for (uint32_t i = 0; i < list->count && fits; i++)
        fits = lr_pack_rows(packed, &list->items[i].record, LR_EMITTER_ROWS) != UINT32_MAX;
    for (uint32_t i = 0; i < 1u << bits; i++) {
        choices[i].first = first + LR_EMITTER_ROWS * choices[i].first;
        choices[i].second = first + LR_EMITTER_ROWS * choices[i].second;
    }
    packed->frame.choices = packed->row_count;
    packed->frame.choice_shift = LR_CHOICE_BITS - bits;
    fits = fits && lr_pack_rows(packed, choices, 1u << bits) != UINT32_MAX;
    free(choices);
    return fits;
}

static bool pack_list(lr_emitters *list, lr_packed_scene *packed)
{
    uint32_t objects = list->scene->object_count;
    uint32_t *steps = choose_steps(list);
    struct gpu_object_emitter *of_objects = lr_alloc(objects, sizeof *of_objects);
    bool fits = steps && of_objects;
    if (fits) {
        set_all_probabilities(list, steps, of_objects);
        set_background(list, steps, packed);
        fits = pack_choices(list, steps, packed);
    }
    packed->frame.object_emitters = packed->row_count;
    fits = fits && lr_pack_rows(packed, of_objects, LR_OBJECT_EMITTER_ROWS * objects) != UINT32_MAX;
    free(steps);
    free(of_objects);
    return fits;
}

lr_status lr_pack_emitters(const lr_scene *scene, const lr_primitive *primitives,
                           lr_packed_scene *packed, lr_error *error)
{
    lr_emitters list;
    bool fits = lr_emitters_find(scene, primitives, packed, &list);
    if (fits)
        note_use(&list, packed->constants);
    if (fits && list.count > 0)
        fits = pack_list(&list, packed);
    free(list.items);
    return fits ? LR_OK : lr_fail(error, LR_ERROR_MEMORY, "out of memory for what shines");
}
