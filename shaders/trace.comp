#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
// Closest hits. As the primary kernel it makes the camera rays of a tile, one sample a workgroup
// layer; otherwise it reads rays_in. Rays that miss put the background into the film, the others
// become entries of hits.
#include "gpu_layout.h"
#include "bindings.glsl"
#include "camera.glsl"
#include "film.glsl"
#include "media.glsl"
#include "trace.glsl"

layout(local_size_x = LR_TILE_GROUP, local_size_y = LR_TILE_GROUP) in;

vec3 background(vec3 d)
{
    float up = 0.5 + 0.5 * ex_dot(d, frame.background_up);
    return ex_mix(frame.background_low, frame.background_high, clamp(up, 0.0, 1.0));
}

// What is left of light after t metres: in a medium absorption, outside fog.
vec3 remaining_after(float t, uint medium)
{
    vec3 rate = vec3(0.0);
    if (has_fog)
        rate = vec3(frame.fog_density);
    if (has_media && medium != 0u)
        rate = has_absorption ? load_medium(medium).absorption : vec3(0.0);
    vec3 depth = rate * t;
    return vec3(ex_exp2(-depth.x), ex_exp2(-depth.y), ex_exp2(-depth.z));
}

bool make_camera_ray(out gpu_ray ray)
{
    uint y_group = spread_group(gl_WorkGroupID.y, gl_NumWorkGroups.y);
    uvec2 at = uvec2(gl_GlobalInvocationID.x, y_group * uint(LR_TILE_GROUP) + gl_LocalInvocationID.y);
    uvec2 pixel = uvec2(work.tile_x, work.tile_y) + at;
    vec2 position = vec2(pixel) + sample_position(pixel, work.first_sample + gl_WorkGroupID.z);
    ray = gpu_ray(frame.origin, at.y * work.tile_width + at.x, camera_direction(position),
                  LR_KIND_PRIMARY << LR_STATE_KIND_SHIFT, vec3(1.0), 0u, frame.inside0,
                  frame.inside1, frame.inside2, frame.inside3);
    return at.x < work.tile_width && at.y < work.tile_height;
}

void main()
{
    gpu_ray ray;
    bool wanted;
    if (primary) {
        wanted = make_camera_ray(ray);
    } else {
        uint index = queue_index();
        wanted = index < work.count;
        ray = rays_in[work.first + (wanted ? index : 0u)];
    }

    nearest_hit found = trace_nearest(ray.origin, ray.direction);
    if (!wanted)
        return;
    bool missed = found.kind == LR_PRIMITIVE_NONE;
    uint medium = has_media ? media_top(uvec4(ray.media0, ray.media1, ray.media2, ray.media3)) : 0u;
    vec3 weight = ray.weight;
    film_sum sum = film_zero();
    if (has_fog || has_absorption) {
        vec3 remaining = remaining_after(found.t, medium);
        if (has_fog && medium == 0u)
            film_accumulate(sum, weight * (frame.fog_color * (vec3(1.0) - remaining)));
        weight = weight * remaining;
    }
    if (missed)
        film_accumulate(sum, weight * background(ray.direction));
    if (has_fog || missed)
        film_add(ray.pixel, sum);

    if (!missed) {
        vec3 position, normal;
        float reach;
        surface_at(found, ray.origin, ray.direction, position, normal, reach);
        uint slot = atomicAdd(counters.hits, 1u);
        if ((slot & (uint(LR_GROUP_SIZE) - 1u)) == 0u)
            atomicAdd(counters.hit_groups, 1u);
        hits[slot] = gpu_hit(position, ray.pixel, normal, found.object, ray.direction, ray.state,
                             weight, reach * LR_OFFSET, ray.media0, ray.media1, ray.media2,
                             ray.media3);
        if (!primary) {
            if (((ray.state & LR_STATE_KIND) >> LR_STATE_KIND_SHIFT) == LR_KIND_REFLECTED)
                atomicAdd(counters.reflected_hits, 1u);
            else
                atomicAdd(counters.refracted_hits, 1u);
        }
    }
    if (primary)
        atomicAdd(film[ray.pixel * uint(LR_FILM_WORDS) + uint(LR_FILM_SAMPLES)], 1u);
    atomicAdd(counters.traced, 1u);
}
