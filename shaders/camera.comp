#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
// Makes the camera rays of a tile, one sample a workgroup layer, into the first queue.
#include "gpu_layout.h"
#include "batch.glsl"
#include "bindings.glsl"
#include "camera.glsl"
#include "queue.glsl"

layout(local_size_x = LR_TILE_GROUP, local_size_y = LR_TILE_GROUP) in;

void main()
{
    load_uniforms();
    uint y_group = spread_group(gl_WorkGroupID.y, gl_NumWorkGroups.y);
    uvec2 at = uvec2(gl_GlobalInvocationID.x, y_group * uint(LR_TILE_GROUP) + gl_LocalInvocationID.y);
    bool wanted = at.x < work.tile_width && at.y < work.tile_height;
    add_count(LR_COUNTER_MADE, uint(wanted));
    write_counts();
    if (!wanted)
        return;
    uvec2 pixel = uvec2(work.tile_x, work.tile_y) + at * work.step;
    uint number = work.first_sample + gl_WorkGroupID.z;
    path_key key = key_of(pixel, frame.seed, number);
    vec2 within;
    if (has_paths)
        within = sample_pair(key, pair_pixel);
    else
        within = sample_position(pixel, number);
    if (has_inspect && (hidden(frame.inspect) & LR_GPU_INSPECT_PATHS) != 0u)
        within = sample_pair(key, pair_pixel);
    camera_ray ray = sample_ray(pixel, within, key);
    uint in_film = work.film_first + at.y * work.step * work.film_pitch + at.x * work.step;
    // Squares of 8 x 8 pixels one after the other, those at the tile's edges smaller, and all samples of a
    // pixel together, so that rays that are neighbours in the queue are so in the picture.
    uvec2 corner = at & ~7u, size = min(uvec2(work.tile_width, work.tile_height) - corner, uvec2(8u));
    uvec2 inside = at - corner;
    uint place = corner.y * work.tile_width + corner.x * size.y + inside.y * size.x + inside.x;
    uint slot = place * gl_NumWorkGroups.z + gl_WorkGroupID.z;
    atomicAdd(film[in_film * uint(LR_FILM_WORDS) + uint(LR_FILM_SAMPLES)], 1u);
    store_ray(slot, gpu_ray(ray.origin, in_film, ray.direction,
                            LR_KIND_PRIMARY << LR_STATE_KIND_SHIFT, vec3(1.0), 0u, frame.inside0,
                            frame.inside1, frame.inside2, frame.inside3));
    if (has_paths)
        store_path(slot, gpu_path(key.pixel, key.order, 0.0, 0.0));
}
