// The queue of light on its way to points, in segments by the number of the light source.
#ifndef SHADOW_QUEUE_GLSL
#define SHADOW_QUEUE_GLSL

#include "batch.glsl"
#include "cell.glsl"
#include "queue.glsl"

uvec4 shadow_row(uint row)
{
    uvec4 value;
    if (texel_queues)
        value = texelFetch(shadow_texels, int(row));
    else
        value = shadow_rays_queue[row];
    return value;
}

uint shadow_rows()
{
    uint rows = 2u;
    if (has_paths)
        rows = 3u;
    return rows;
}

gpu_shadow_ray load_shadow_ray(uint index)
{
    uvec4 a = shadow_row(shadow_rows() * index), b = shadow_row(shadow_rows() * index + 1u);
    return gpu_shadow_ray(uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), b.w);
}

gpu_shadow_way load_shadow_way(uint index)
{
    uvec4 a = shadow_row(shadow_rows() * index + 2u);
    return gpu_shadow_way(uintBitsToFloat(a.xyz), uintBitsToFloat(a.w));
}

const gpu_shadow_way no_way = gpu_shadow_way(vec3(0.0), 0.0);

// Puts the ray into its light's segment if it is wanted. All invocations of a batch must send light
// of the same source together. `way` is for paths alone.
void send_light(gpu_shadow_ray ray, gpu_shadow_way way, bool wanted)
{
    uint segment = ray.light & uint(LR_SHADOW_LIGHTS - 1);
    uint begin = segment * work.shadow_room;
    uint slot = take_slot(LR_COUNTER_SHADOW_RAYS + segment, wanted) + work.shadow_first[segment];
    if (wanted && hidden(work.sorted) != 0u)
        atomicAdd(cells[segment * LR_CELLS + cell_of(ray.origin)], 1u);
    // The host checks that no segment ran over.
    if (wanted && slot < work.shadow_room) {
        uint at = shadow_rows() * (begin + slot);
        shadow_rays_queue[at] = pack_row(ray.origin, ray.pixel);
        shadow_rays_queue[at + 1u] = pack_row(ray.value, ray.light);
        if (has_paths)
            shadow_rays_queue[at + 2u] = pack_row(way.direction, floatBitsToUint(way.t_max));
    }
}

#endif
