// What a pixel shows when it is asked for something else than light (has_inspect): lr_inspect.
#ifndef INSPECT_GLSL
#define INSPECT_GLSL

#include "bindings.glsl"
#include "boundary.glsl"
#include "fresnel.glsl"
#include "queue.glsl"
#include "random.glsl"
#include "shading.glsl"

uint inspected()
{
    return hidden(frame.inspect) & LR_GPU_INSPECT_KIND;
}

bool counts_rays()
{
    return has_inspect && inspected() == LR_GPU_INSPECT_RAYS;
}

// So many rays, towards lights too.
vec3 inspected_rays(uint count)
{
    return vec3(counts_rays() ? float(count) * LR_GPU_INSPECT_RAY : 0.0);
}

// From the camera to a hit: what is behind holes was reached by several rays.
float inspected_distance(gpu_ray ray, float t)
{
    return uintBitsToFloat(ray.note) + t;
}

// How much of white light from everywhere comes back, or through.
vec3 inspected_albedo(gpu_ray ray, shading at, boundary sides)
{
    gpu_material m = at.material;
    vec3 mirrored = m.reflect;
    if (has_fresnel) {
        float c1 = min(max(-ex_dot(ray.direction, at.lit_by), 0.0), 1.0);
        float inside = refracted_cosine_squared(c1, ex_div(sides.ior1, sides.ior2));
        float f = inside <= 0.0 ? 1.0 : fresnel_reflectance(c1, ex_sqrt(inside), sides.ior1, sides.ior2);
        mirrored = mix(mirrored, mirrored * f, bvec3((m.flags & LR_GPU_FRESNEL) != 0u));
    }
    return min(at.color * m.diffuse + mirrored + m.transmit, vec3(1.0));
}

vec3 inspected_number(uint object)
{
    uint number = object + 1u;
    return vec3(float(number & 0xFFFFu), float(number >> 16), 0.0);
}

// What the camera sees where a ray of its own meets a surface; later rays show nothing.
vec3 inspected_hit(gpu_ray ray, float t, shading at, boundary sides)
{
    uint what = inspected(), bits = hash(at.at.object + 1u);
    vec3 color = vec3(uvec3(bits, bits >> 8, bits >> 16) & 255u) * 0.00392156862745098;
    vec3 p = at.at.position;
    float distance = inspected_distance(ray, t);
    vec3 value = at.lit_by * 0.5 + vec3(0.5);
    value = mix(value, vec3(frame.inspect_scale * ex_rcp(distance + frame.inspect_scale)),
                bvec3(what == LR_GPU_INSPECT_DEPTH));
    value = mix(value, color * 0.8 + vec3(0.2), bvec3(what == LR_GPU_INSPECT_OBJECT));
    value = mix(value, inspected_albedo(ray, at, sides), bvec3(what == LR_GPU_INSPECT_ALBEDO));
    value = mix(value, at.lit_by + vec3(1.0), bvec3(what == LR_GPU_INSPECT_SHIFTED_NORMAL));
    value = mix(value, vec3(distance, 1.0, 0.0), bvec3(what == LR_GPU_INSPECT_DISTANCE));
    value = mix(value, max(p, vec3(0.0)), bvec3(what == LR_GPU_INSPECT_POSITION));
    value = mix(value, max(-p, vec3(0.0)), bvec3(what == LR_GPU_INSPECT_NEGATIVE_POSITION));
    value = mix(value, inspected_number(at.at.object), bvec3(what == LR_GPU_INSPECT_NUMBER));
    bool seen = (ray.state & LR_STATE_DEPTH) == 0u && !sides.hidden;
    bool counted = !at.absent;
    return counts_rays() ? inspected_rays(uint(counted)) : mix(vec3(0.0), value, bvec3(seen));
}

// ... and where it meets nothing.
vec3 inspected_beyond(gpu_ray ray)
{
    bool shifted = inspected() == LR_GPU_INSPECT_SHIFTED_NORMAL;
    bool seen = (ray.state & LR_STATE_DEPTH) == 0u;
    return shifted && seen ? vec3(1.0) : inspected_rays(1u);
}

#endif
