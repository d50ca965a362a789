// The children of a hit: the reflected and the refracted ray.
#ifndef SCATTER_GLSL
#define SCATTER_GLSL

#include "batch.glsl"
#include "boundary.glsl"
#include "exact.glsl"
#include "fresnel.glsl"
#include "notes.glsl"
#include "queue.glsl"
#include "scene_data.glsl"
#include "surface.glsl"

struct child {
    vec3 weight;
    vec3 direction;
    float side; // which side of the surface it starts on, along the facing normal
    uvec4 media;
    uint state;
};

float greatest(vec3 v)
{
    return max(v.x, max(v.y, v.z));
}

// Children that are not traced, by the reason.
struct dropped_counts {
    uint deep, weak, nested;
};

// Whether a child is worth a ray. `fate` is what becomes of it, in kernels that explain.
bool admit(child c, uint depth, inout dropped_counts dropped, inout uint fate)
{
    float weight = greatest(c.weight);
    bool counts = !(weight < LR_WEIGHT_MIN);
    bool too_deep = counts && depth >= frame.depth;
    bool too_weak = counts && !too_deep && weight < frame.min_weight;
    dropped.deep += uint(too_deep);
    dropped.weak += uint(too_weak);
    if (explains)
        fate = mix(mix(mix(LR_FATE_TRACED, LR_FATE_TOO_WEAK, too_weak), LR_FATE_TOO_DEEP, too_deep),
                   LR_FATE_NONE, !counts);
    return counts && !too_deep && !too_weak;
}

// A direction that an interpolated normal brought to the wrong side of the surface, brought back.
vec3 on_side(vec3 d, vec3 n)
{
    const float least = 0.001;
    float side = ex_dot(d, n);
    return side < least ? d + n * (least - side) : d;
}

void emit(uint slot, child c, uint pixel, surface s, vec3 n)
{
    store_ray(slot, gpu_ray(s.position + n * (c.side * s.offset), pixel, ex_normalize(c.direction),
                            c.state, c.weight, noted_ray, c.media.x, c.media.y, c.media.z, c.media.w));
}

struct children {
    child mirrored, through;
    bool has_mirrored, has_through;
    bool hidden; // the surface is absent there or hidden within another medium: nothing to be lit
    dropped_counts dropped;
};

// The children of `ray`, which met `s` with `weight`; n is the surface's normal against the ray, lit_by
// the one that it is lit and mirrors by.
children scatter(gpu_ray ray, vec3 weight, surface s, vec3 n, vec3 lit_by, uvec3 ids, gpu_material m,
                 bool absent, bool wanted)
{
    float c1 = min(max(-ex_dot(ray.direction, lit_by), 0.0), 1.0);
    uint depth = ray.state & LR_STATE_DEPTH;
    boundary b = boundary_at(ray, s, ids, m.ior, absent);
    bool hidden = b.hidden, solid = b.solid, lost = !b.placed;
    float ior1 = b.ior1, ior2 = b.ior2, gamma = b.gamma;
    dropped_counts dropped = dropped_counts(0u, 0u, uint(wanted && lost));

    vec3 reflect_weight = weight * m.reflect;
    vec3 transmit_weight = weight * m.transmit;
    float c2_squared = refracted_cosine_squared(c1, gamma);
    float c2 = ex_sqrt(c2_squared);
    bool total = solid && c2_squared <= 0.0;
    if (has_fresnel && (m.flags & LR_GPU_FRESNEL) != 0u) {
        // A thin sheet bends nothing, but reflects as its material would.
        float ratio = ex_div(ior1, ior2);
        float inside = refracted_cosine_squared(c1, ratio);
        float f = inside <= 0.0 ? 1.0
                                : fresnel_reflectance(c1, ex_sqrt(inside), ior1, ior2);
        if (explains && wanted)
            note_reflectance(f);
        reflect_weight = (reflect_weight + transmit_weight) * f;
        transmit_weight = transmit_weight * (1.0 - f);
    } else if (total) {
        reflect_weight = reflect_weight + transmit_weight;
    }
    vec3 refracted = solid ? refract_direction(ray.direction, lit_by, c1, c2, gamma) : ray.direction;
    vec3 reflected = reflect_direction(ray.direction, lit_by);
    if (has_corners || has_relief) {
        reflected = on_side(reflected, n);
        refracted = on_side(refracted, -n);
    }

    uint passes = ray.state >> LR_STATE_PASSES_SHIFT;
    uint next = (ray.state & ~(LR_STATE_DEPTH | LR_STATE_KIND)) | (depth + 1u);
    child mirrored = child(reflect_weight, reflected, 1.0, ray_media(ray),
                           next | (LR_KIND_REFLECTED << LR_STATE_KIND_SHIFT));
    child through = child(transmit_weight, refracted, -1.0, b.beyond,
                          next | (LR_KIND_REFRACTED << LR_STATE_KIND_SHIFT));
    uint mirrored_fate = LR_FATE_NONE, through_fate = LR_FATE_NONE;
    bool emit_mirrored = wanted && !hidden && admit(mirrored, depth, dropped, mirrored_fate);
    bool emit_through = wanted && !hidden && !total && admit(through, depth, dropped, through_fate);
    if (wanted && hidden) {
        // The surface lies inside a medium that fills the space on both sides, or has a hole: as if
        // it were not there. The ray goes on as the same ray.
        uint kind = ray_kind(ray);
        uint on_kind = kind == LR_KIND_PRIMARY ? LR_KIND_REFRACTED : kind;
        through = child(weight, ray.direction, -1.0, b.beyond,
                        depth | (on_kind << LR_STATE_KIND_SHIFT) |
                            ((passes + 1u) << LR_STATE_PASSES_SHIFT));
        emit_through = passes < uint(LR_PASSES_MAX);
        dropped.nested += uint(!emit_through);
    }

    if (explains && wanted) {
        lost = lost || (hidden && !emit_through);
        note_refraction(media_top(b.beyond), ior1, ior2, c2);
        note_children(reflect_weight, reflected, transmit_weight, refracted,
                      (solid ? LR_NOTE_BENDS : 0u) | (total ? LR_NOTE_TOTAL : 0u) |
                          (m.flags & LR_GPU_FRESNEL) * LR_NOTE_FRESNEL |
                          (absent ? LR_NOTE_HOLE : hidden ? LR_NOTE_HIDDEN : 0u) |
                          (lost ? LR_NOTE_LOST : 0u) | mirrored_fate << LR_NOTE_REFLECTED_SHIFT |
                          through_fate << LR_NOTE_REFRACTED_SHIFT);
    }

    return children(mirrored, through, emit_mirrored, emit_through, hidden, dropped);
}

void count_children(children c)
{
    add_count(LR_COUNTER_REFLECTED, uint(c.has_mirrored));
    add_count(LR_COUNTER_REFRACTED, uint(c.has_through && !c.hidden));
    add_count(LR_COUNTER_PASSED, uint(c.has_through && c.hidden));
    add_count(LR_COUNTER_DROPPED_DEPTH, c.dropped.deep);
    add_count(LR_COUNTER_DROPPED_WEIGHT, c.dropped.weak);
    add_count(LR_COUNTER_DROPPED_NESTING, c.dropped.nested);
}

// Puts the children into the next queue, the reflected one of each invocation first. The last thing that a kernel
// does: on a CPU an atomic waits for all stores before it. In a loop, as the stores of a ray are a lot of code there.
void emit_children(children c, uint pixel, surface s, vec3 n)
{
    uvec2 slots = take_slots(LR_COUNTER_RAYS, c.has_mirrored, c.has_through);
    uint count = uint(c.has_mirrored) + uint(c.has_through), most = batch_max(count);
    for (uint i = 0u;;) {
        bool mirrored = c.has_mirrored && i == 0u;
        child next = c.through;
        if (mirrored)
            next = c.mirrored;
        if (i < count)
            emit(mirrored ? slots.x : slots.y, next, pixel, s, n);
        i++;
        if (i >= most)
            break;
    }
}

#endif
