// The queues between kernels, read and written in whole rows of 16 bytes.
#ifndef QUEUE_GLSL
#define QUEUE_GLSL

#include "bindings.glsl"

uint ray_rows()
{
    uint rows = 4u;
    if (has_paths)
        rows = 5u;
    return rows;
}

uvec4 ray_media(gpu_ray ray)
{
    return uvec4(ray.media0, ray.media1, ray.media2, ray.media3);
}

// LR_KIND_*
uint ray_kind(gpu_ray ray)
{
    return (ray.state & LR_STATE_KIND) >> LR_STATE_KIND_SHIFT;
}

uvec4 ray_row(uint row)
{
    uvec4 value;
    if (texel_queues)
        value = texelFetch(ray_texels, int(row));
    else
        value = rays_in[row];
    return value;
}

gpu_ray load_ray(uint index)
{
    uint at = ray_rows() * index;
    uvec4 a = ray_row(at), b = ray_row(at + 1u), c = ray_row(at + 2u), media = uvec4(0u);
    if (has_media)
        media = ray_row(at + 3u);
    return gpu_ray(uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), b.w, uintBitsToFloat(c.xyz),
                   c.w, media.x, media.y, media.z, media.w);
}

uvec4 pack_row(vec3 v, uint word)
{
    return uvec4(floatBitsToUint(v), word);
}

void store_ray(uint index, gpu_ray ray)
{
    uint at = ray_rows() * index;
    rays_out[at] = pack_row(ray.origin, ray.pixel);
    rays_out[at + 1u] = pack_row(ray.direction, ray.state);
    uint note = 0u;
    if (explains || has_inspect || has_paths)
        note = ray.note;
    rays_out[at + 2u] = pack_row(ray.weight, note);
    if (has_media)
        rays_out[at + 3u] = ray_media(ray);
}

gpu_path load_path(uint index)
{
    uvec4 a = ray_row(ray_rows() * index + 4u);
    return gpu_path(a.x, a.y, uintBitsToFloat(a.z), uintBitsToFloat(a.w));
}

void store_path(uint index, gpu_path path)
{
    rays_out[ray_rows() * index + 4u] =
        uvec4(path.pixel, path.order, floatBitsToUint(path.pdf), floatBitsToUint(path.distance));
}

gpu_hit load_hit(uint index)
{
    uvec4 a;
    if (texel_queues)
        a = texelFetch(hit_texels, int(index));
    else
        a = hits[index];
    return gpu_hit(a.x, uintBitsToFloat(a.y), a.z, a.w);
}

void store_hit(uint index, gpu_hit hit)
{
    hits[index] = uvec4(hit.ray, floatBitsToUint(hit.t), hit.primitive, hit.object);
}

#endif
