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

gpu_shadow_ray load_shadow_ray(uint index)
{
    uvec4 a = shadow_row(2u * index), b = shadow_row(2u * index + 1u);
    return gpu_shadow_ray(uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), b.w);
}

// Puts the ray into its light's segment if it is wanted. All invocations of a batch must send light
// of the same source together.
void send_light(gpu_shadow_ray ray, bool wanted)
{
    uint segment = ray.light & uint(LR_SHADOW_LIGHTS - 1), slot;
    uint begin = segment * work.shadow_room;
    TAKE_SLOT(counters.shadow_rays[segment], wanted, slot)
    slot += work.shadow_first[segment];
    if (wanted && hidden(work.sorted) != 0u)
        atomicAdd(cells[segment * LR_CELLS + cell_of(ray.origin)], 1u);
    // The host checks that no segment ran over.
    if (wanted && slot < work.shadow_room) {
        uint at = 2u * (begin + slot);
        shadow_rays_queue[at] = pack_row(ray.origin, ray.pixel);
        shadow_rays_queue[at + 1u] = pack_row(ray.value, ray.light);
    }
}

#endif
