/* Mixes of materials: their parts are found when all materials have names, and completed parts
 * first, as mixes may have mixes for parts. */
#include "scene/read.h"

#include "scene/color.h"
#include "scene/models.h"

#include <stdio.h>

static bool transmits(const lr_material *m)
{
    return !lr_color_is_black(m->transmit);
}

/* Reports what a part has that only the whole surface can have. */
static void check_part(lr_reader *reader, const lr_node *node, const char *which,
                       const lr_material *part)
{
    const char *own = !lr_color_is_black(part->emission) ? "emission"
                      : part->emits != LR_EMITS_BOTH     ? "emits"
                      : part->one_sided                  ? "one_sided"
                                                         : NULL;
    if (own)
        lr_report_add(reader->report, node->offset,
                      "the %s material of the mix has %s, expected it as a key of the mix", which,
                      own);
    if (part->alpha_cutoff > 0)
        lr_report_add(reader->report, node->offset,
                      "the %s material of the mix has alpha_cutoff, expected none: where there is "
                      "to be no surface, a weight can choose {model: thin_glass, ior: 1}",
                      which);
}

static bool same_medium(const lr_material *a, const lr_material *b)
{
    return a->ior == b->ior && a->priority == b->priority && a->anisotropy == b->anisotropy &&
           lr_colors_equal(a->absorption, b->absorption) &&
           lr_colors_equal(a->scattering, b->scattering);
}

/* Where both let light through, the inside must be the same. */
static void check_inside(lr_reader *reader, const lr_mix *mix, const lr_material *first,
                         const lr_material *second)
{
    if (!transmits(first) || !transmits(second))
        return;
    if (first->pane != second->pane)
        lr_report_add(reader->report, mix->second->offset,
                      "one material of the mix fills the inside, the other is thin_glass, expected "
                      "two of the same kind");
    else if (!first->pane && !same_medium(first, second))
        lr_report_add(reader->report, mix->second->offset,
                      "both materials of the mix let light in, expected the same ior, absorption, "
                      "scattering, anisotropy and priority: one medium fills the inside");
}

/* The material of a part, LR_NONE after reporting. */
static uint32_t find_part(lr_reader *reader, const lr_mix *mix, const lr_node *node,
                          const char *key)
{
    if (node)
        return lr_read_material_use(reader, node);
    lr_report_add(reader->report, mix->at->offset,
                  "model mix needs %s, the name of a material or a mapping of material keys", key);
    return LR_NONE;
}

/* Reads the parts of all mixes that were added, also of those that stand within others. */
static bool find_parts(lr_reader *reader)
{
    bool found = true;
    for (uint32_t i = 0; i < reader->mixes.count && !reader->full; i++) {
        lr_mix mix = reader->mixes.items[i];
        uint32_t first = find_part(reader, &mix, mix.first, "first");
        uint32_t second = find_part(reader, &mix, mix.second, "second");
        lr_material *material = &reader->scene->materials[mix.material];
        material->mix.first = first;
        material->mix.second = second;
        found = found && first != LR_NONE && second != LR_NONE;
    }
    return found && !reader->full;
}

/* How deep mixes are nested in the material, with all of them completed; 0: it is none, greater
 * than LR_MIX_NESTING_MAX: too deep, or it is a part of itself. */
static uint32_t nesting_of(lr_scene *scene, uint32_t index, uint32_t above)
{
    lr_material *m = &scene->materials[index];
    if (m->model != LR_MODEL_MIX || m->mix.nesting)
        return m->mix.nesting;
    if (above == LR_MIX_NESTING_MAX)
        return LR_MIX_NESTING_MAX + 1;
    uint32_t first = nesting_of(scene, m->mix.first, above + 1);
    uint32_t second = nesting_of(scene, m->mix.second, above + 1);
    uint32_t nesting = 1 + (first > second ? first : second);
    if (nesting <= LR_MIX_NESTING_MAX) {
        m->mix.nesting = nesting;
        lr_approximate_mix(scene, m);
    }
    return nesting;
}

static bool complete(lr_reader *reader, const lr_mix *mix)
{
    lr_scene *scene = reader->scene;
    if (nesting_of(scene, mix->material, 0) > LR_MIX_NESTING_MAX) {
        lr_report_add(reader->report, mix->at->offset,
                      "the mix is nested more than %d deep, or a part of itself",
                      LR_MIX_NESTING_MAX);
        return false;
    }
    const lr_material *m = &scene->materials[mix->material];
    const lr_material *first = &scene->materials[m->mix.first];
    const lr_material *second = &scene->materials[m->mix.second];
    check_part(reader, mix->first, "first", first);
    check_part(reader, mix->second, "second", second);
    check_inside(reader, mix, first, second);
    return true;
}

void lr_complete_mixes(lr_reader *reader)
{
    lr_mixes *mixes = &reader->mixes;
    if (mixes->open)
        return;
    mixes->open = true;
    bool found = find_parts(reader);
    for (uint32_t i = 0; found && i < mixes->count; i++)
        found = complete(reader, &mixes->items[i]);
    /* What was reported stands for no mix to others. */
    for (uint32_t i = 0; !found && i < mixes->count; i++)
        reader->scene->materials[mixes->items[i].material].model = LR_MODEL_CLASSIC;
    mixes->count = 0;
    mixes->open = false;
}
