#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
// The nearest hits of a queue of rays. Rays that miss put the background into the film.
#include "gpu_layout.h"
#include "bindings.glsl"
#include "air.glsl"
#include "background.glsl"
#include "batch.glsl"
#include "film.glsl"
#include "found.glsl"
#include "inspect.glsl"
#include "notes.glsl"
#include "queue.glsl"
#include "trace.glsl"

layout(local_size_x = LR_GROUP_SIZE) in;

void main()
{
    load_uniforms();
    uint index = queue_index();
    bool wanted = index < work.count;
    index = work.first + (wanted ? index : 0u);
    gpu_ray ray = load_ray(index);
    nearest_hit met;
    if (has_trees)
        met = load_found(index - work.first);
    else
        met = trace_nearest(ray.origin, ray.direction);
    bool hit = wanted && met.primitive != LR_PRIMITIVE_NONE;
    uint slot;
    TAKE_SLOT(counters.hits, hit, slot)
    if (hit && (slot & (uint(LR_GROUP_SIZE) - 1u)) == 0u)
        atomicAdd(counters.hit_groups, 1u);
    uint kind = ray_kind(ray);
    COUNT(counters.reflected_hits, uint(hit && kind == LR_KIND_REFLECTED))
    COUNT(counters.refracted_hits, uint(hit && kind == LR_KIND_REFRACTED))
    COUNT(counters.traced, uint(wanted))
    if (explains && wanted)
        note_ray(ray, met.t, met.primitive);
    if (wanted && !hit) {
        film_sum sum = film_zero();
        vec3 fog;
        vec3 weight = weight_after(ray, met.t, fog);
        if (has_fog && !has_inspect)
            film_accumulate(sum, fog);
        vec3 beyond = weight * background(ray.direction);
        if (has_inspect)
            beyond = inspected_beyond(ray);
        film_accumulate(sum, beyond);
        film_add(ray.pixel, sum);
        if (explains) {
            note_air(weight, fog, medium_of(ray));
            note_background(beyond);
        }
    }
    // Last, because on a CPU an atomic waits for all stores before it.
    if (explains && hit)
        notes.of_hit[slot] = noted_ray;
    if (hit)
        store_hit(slot, gpu_hit(index, met.t, met.primitive, met.object));
}
