#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
// One bounce of each path in a queue.
#include "gpu_layout.h"
#include "bindings.glsl"
#include "bounce.glsl"
#include "found.glsl"

layout(local_size_x = LR_GROUP_SIZE) in;

void main()
{
    load_uniforms();
    uint index = queue_index();
    bool wanted = index < work.count;
    uint at = work.first + (wanted ? index : 0u);
    gpu_ray ray = load_ray(at);
    gpu_path path = load_path(at);
    nearest_hit met;
    if (has_trees)
        met = load_found(at - work.first);
    else
        met = nearest_listed(ray.origin, ray.direction);
    film_sum sum = film_zero();
    ray_counts counts = ray_counts(0u, 0u, 0u, 0u);
    bool goes_on = bounce(wanted, met, ray, path, sum, counts);
    film_add_batch(ray.pixel, sum);
    // The stores come last: on a CPU an atomic waits for all stores before it.
    uint slot = take_slot(LR_COUNTER_RAYS, goes_on);
    add_count(LR_COUNTER_TRACED, counts.traced);
    add_count(LR_COUNTER_HITS, counts.hits);
    add_count(LR_COUNTER_SHADOW, counts.shadow);
    add_count(LR_COUNTER_SHADOW_HITS, counts.shadow_hits);
    write_counts();
    if (goes_on) {
        store_ray(slot, ray);
        store_path(slot, path);
    }
}
