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
    uint slot = take_slot(LR_COUNTER_HITS, hit);
    add_count(LR_COUNTER_HIT_GROUPS, uint(hit && (slot & (uint(LR_GROUP_SIZE) - 1u)) == 0u));
    uint kind = ray_kind(ray);
    add_count(LR_COUNTER_REFLECTED_HITS, uint(hit && kind == LR_KIND_REFLECTED));
    add_count(LR_COUNTER_REFRACTED_HITS, uint(hit && kind == LR_KIND_REFRACTED));
    add_count(LR_COUNTER_TRACED, uint(wanted));
    if (explains && wanted)
        note_ray(ray, met.t, met.primitive);
    film_sum sum = film_zero();
    if (wanted && !hit) {
        vec3 fog;
        vec3 weight = weight_after(ray, met.t, fog);
        if (has_fog && !has_inspect)
            film_accumulate(sum, fog);
        vec3 beyond = weight * background(ray.direction);
        if (has_inspect)
            beyond = inspected_beyond(ray);
        film_accumulate(sum, beyond);
        if (explains) {
            note_air(weight, fog, medium_of(ray));
            note_background(beyond);
        }
    }
    film_add_batch(ray.pixel, sum);
    write_counts();
    // Last, because on a CPU an atomic waits for all stores before it.
    if (explains && hit)
        notes.of_hit[slot] = noted_ray;
    if (hit)
        store_hit(slot, gpu_hit(index, met.t, met.primitive, met.object));
}
