#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
// The children of each hit: the reflected and the refracted ray, and the list of the hits that light
// falls on. Runs only in scenes where something reflects or transmits.
#include "gpu_layout.h"
#include "bindings.glsl"
#include "exact.glsl"
#include "fresnel.glsl"
#include "media.glsl"
#include "scene_data.glsl"

layout(local_size_x = LR_GROUP_SIZE) in;

struct child {
    vec3 weight;
    vec3 direction;
    float side; // which side of the surface it starts on, along the facing normal
    uvec4 media;
    uint state;
};

float greatest(vec3 v)
{
    return max(v.x, max(v.y, v.z));
}

// Whether a child is worth a ray; counts the ones that are cut off.
bool admit(child c, uint depth)
{
    float weight = greatest(c.weight);
    if (weight < LR_WEIGHT_MIN)
        return false;
    if (depth >= frame.depth) {
        atomicAdd(counters.dropped_depth, 1u);
        return false;
    }
    if (weight < frame.min_weight) {
        atomicAdd(counters.dropped_weight, 1u);
        return false;
    }
    return true;
}

void emit(child c, gpu_hit hit, vec3 n)
{
    uint slot = atomicAdd(counters.rays, 1u);
    rays_out[slot] = gpu_ray(hit.position + n * (c.side * hit.offset), hit.pixel,
                             ex_normalize(c.direction), c.state, c.weight, 0u, c.media.x,
                             c.media.y, c.media.z, c.media.w);
}

void main()
{
    uint index = queue_index();
    if (index >= counters.hits)
        return;
    gpu_hit hit = hits[index];
    uvec3 ids = load_object_ids(hit.object);
    gpu_material m = load_material(ids.x);
    bool entering = ex_dot(hit.direction, hit.normal) < 0.0;
    vec3 n = entering ? hit.normal : -hit.normal;
    float c1 = min(max(-ex_dot(hit.direction, n), 0.0), 1.0);
    uvec4 media = uvec4(hit.media0, hit.media1, hit.media2, hit.media3);
    uvec4 beyond = media;
    bool solid = has_media && (ids.y & LR_FLAG_SOLID) != 0u && (ids.y & LR_FLAG_TRANSPARENT) != 0u;
    uint depth = hit.state & LR_STATE_DEPTH;

    bool hidden = false;
    float ior1 = 1.0, ior2 = m.ior, gamma = 1.0;
    if (has_media) {
        bool placed = true;
        uint before = media_top(media);
        if (solid && entering && !media_contains(media, ids.z))
            beyond = media_with(media, ids.z, placed);
        if (solid && !entering)
            beyond = media_without(media, ids.z);
        if (!placed)
            atomicAdd(counters.dropped_nesting, 1u);
        uint after = media_top(beyond);
        hidden = solid && before == after;
        ior1 = load_medium(before).ior;
        if (solid) {
            ior2 = load_medium(after).ior;
            gamma = ex_div(ior1, ior2);
        }
    }

    vec3 reflect_weight = hit.weight * m.reflect;
    vec3 transmit_weight = hit.weight * m.transmit;
    float c2_squared = refracted_cosine_squared(c1, gamma);
    float c2 = ex_sqrt(c2_squared);
    bool total = solid && c2_squared <= 0.0;
    if (has_fresnel && (m.flags & LR_GPU_FRESNEL) != 0u) {
        // A thin sheet bends nothing, but reflects as its material would.
        float ratio = ex_div(ior1, ior2);
        float inside = refracted_cosine_squared(c1, ratio);
        float f = inside <= 0.0 ? 1.0
                                : fresnel_reflectance(c1, ex_sqrt(inside), ior1, ior2);
        reflect_weight = (reflect_weight + transmit_weight) * f;
        transmit_weight = transmit_weight * (1.0 - f);
    } else if (total) {
        reflect_weight = reflect_weight + transmit_weight;
    }
    vec3 refracted = solid ? refract_direction(hit.direction, n, c1, c2, gamma) : hit.direction;

    uint passes = hit.state >> LR_STATE_PASSES_SHIFT;
    uint next = (hit.state & ~(LR_STATE_DEPTH | LR_STATE_KIND)) | (depth + 1u);
    child mirrored = child(reflect_weight, reflect_direction(hit.direction, n), 1.0, media,
                           next | (LR_KIND_REFLECTED << LR_STATE_KIND_SHIFT));
    child through = child(transmit_weight, refracted, -1.0, beyond,
                          next | (LR_KIND_REFRACTED << LR_STATE_KIND_SHIFT));
    bool emit_mirrored = !hidden && admit(mirrored, depth);
    bool emit_through = !hidden && !total && admit(through, depth);
    if (hidden) {
        // The surface lies inside a medium that fills the space on both sides: as if it were not
        // there. The ray goes on as the same ray.
        uint kind = (hit.state & LR_STATE_KIND) >> LR_STATE_KIND_SHIFT;
        uint on_kind = kind == LR_KIND_PRIMARY ? LR_KIND_REFRACTED : kind;
        through = child(hit.weight, hit.direction, -1.0, beyond,
                        depth | (on_kind << LR_STATE_KIND_SHIFT) |
                            ((passes + 1u) << LR_STATE_PASSES_SHIFT));
        emit_through = passes < uint(LR_PASSES_MAX);
        if (emit_through)
            atomicAdd(counters.passed, 1u);
        else
            atomicAdd(counters.dropped_nesting, 1u);
    }

    if (emit_mirrored) {
        emit(mirrored, hit, n);
        atomicAdd(counters.reflected, 1u);
    }
    if (emit_through) {
        emit(through, hit, n);
        if (!hidden)
            atomicAdd(counters.refracted, 1u);
    }
    if (!hidden && (m.flags & LR_GPU_LIT) != 0u) {
        uint slot = atomicAdd(counters.lit, 1u);
        if ((slot & (uint(LR_GROUP_SIZE) - 1u)) == 0u)
            atomicAdd(counters.lit_groups, 1u);
        lit[slot] = index;
    }
    atomicAdd(counters.scattered, 1u);
}
