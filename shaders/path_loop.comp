#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
// The paths of a tile, in scenes without trees: each invocation takes those of one pixel a number of
// bounces further, one path after the other, and leaves the last one to the next pass.
#include "gpu_layout.h"
#include "bindings.glsl"
#include "bounce.glsl"
#include "camera.glsl"

layout(local_size_x = LR_TILE_GROUP, local_size_y = LR_TILE_GROUP) in;

void begin_path(uvec2 pixel, uint number, uint in_film, inout gpu_ray ray, inout gpu_path path)
{
    path_key key = key_of(pixel, frame.seed, number);
    camera_ray from = sample_ray(pixel, sample_pair(key, pair_pixel), key);
    ray = gpu_ray(from.origin, in_film, from.direction, LR_KIND_PRIMARY << LR_STATE_KIND_SHIFT,
                  vec3(1.0), 0u, frame.inside0, frame.inside1, frame.inside2, frame.inside3);
    path = gpu_path(key.pixel, key.order, 0.0, 0.0);
}

void main()
{
    load_uniforms();
    hold_records();
    uint y_group = spread_group(gl_WorkGroupID.y, gl_NumWorkGroups.y);
    uvec2 at = uvec2(gl_GlobalInvocationID.x, y_group * uint(LR_TILE_GROUP) + gl_LocalInvocationID.y);
    bool inside = at.x < work.tile_width && at.y < work.tile_height;
    uint slot = at.y * work.tile_width + at.x, samples = inside ? hidden(work.samples) : 0u;
    uvec2 pixel = uvec2(work.tile_x, work.tile_y) + at * work.step;
    uint in_film = work.film_first + at.y * work.step * work.film_pitch + at.x * work.step;

    bool resumed = inside && hidden(work.resumed) != 0u;
    gpu_ray ray = load_ray(resumed ? slot : 0u);
    gpu_path path = load_path(resumed ? slot : 0u);
    uint begun = resumed ? ray.note >> 1 : 0u, begun_before = begun;
    bool alive = resumed && (ray.note & 1u) != 0u;
    uint ended = 0u, first_hits = 0u;
    film_sum sum = film_zero();
    ray_counts counts = ray_counts(0u, 0u, 0u, 0u);
    for (uint round = 0u;;) {
        bool begins = !alive && begun < samples;
        if (begins)
            begin_path(pixel, work.first_sample + begun, in_film, ray, path);
        begun += uint(begins);
        bool wanted = alive || begins;
        uint hits_before = counts.hits;
        nearest_hit met = nearest_listed(ray.origin, ray.direction);
        alive = bounce(wanted, met, ray, path, sum, counts);
        ended += uint(wanted && !alive);
        first_hits += begins ? counts.hits - hits_before : 0u;
        round++;
        if (round >= hidden(work.rounds) || batch_max(uint(alive || begun < samples)) == 0u)
            break;
    }

    bool goes_on = alive || begun < samples;
    if (inside) {
        film_add(in_film, sum);
        atomicAdd(film[in_film * uint(LR_FILM_WORDS) + uint(LR_FILM_SAMPLES)], ended);
    }
    add_count(LR_COUNTER_RAYS, uint(goes_on));
    add_count(LR_COUNTER_MADE, begun - begun_before);
    add_count(LR_COUNTER_MADE_HITS, first_hits);
    add_count(LR_COUNTER_TRACED, counts.traced);
    add_count(LR_COUNTER_HITS, counts.hits);
    add_count(LR_COUNTER_SHADOW, counts.shadow);
    add_count(LR_COUNTER_SHADOW_HITS, counts.shadow_hits);
    write_counts();
    if (inside) {
        ray.note = begun << 1 | uint(alive);
        store_ray(slot, ray);
        store_path(slot, path);
    }
}
