// What a pixel shows when it is asked for something else than light (has_inspect): lr_inspect.
#ifndef INSPECT_GLSL
#define INSPECT_GLSL

#include "bindings.glsl"
#include "queue.glsl"
#include "random.glsl"

bool counts_rays()
{
    return has_inspect && hidden(frame.inspect) == LR_GPU_INSPECT_RAYS;
}

// So many rays, towards lights too.
vec3 inspected_rays(uint count)
{
    return vec3(counts_rays() ? float(count) * LR_GPU_INSPECT_RAY : 0.0);
}

// What the camera sees at distance t; later rays show nothing of their own.
vec3 inspected_hit(gpu_ray ray, float t, uint object, vec3 normal)
{
    uint what = hidden(frame.inspect), bits = hash(object + 1u);
    vec3 color = vec3(uvec3(bits, bits >> 8, bits >> 16) & 255u) * 0.00392156862745098;
    vec3 value = normal * 0.5 + vec3(0.5);
    value = mix(value, vec3(frame.inspect_scale * ex_rcp(t + frame.inspect_scale)),
                bvec3(what == LR_GPU_INSPECT_DEPTH));
    value = mix(value, color * 0.8 + vec3(0.2), bvec3(what == LR_GPU_INSPECT_OBJECT));
    bool seen = ray_kind(ray) == LR_KIND_PRIMARY && what != LR_GPU_INSPECT_RAYS;
    return mix(vec3(0.0), value, bvec3(seen)) + inspected_rays(1u);
}

#endif
