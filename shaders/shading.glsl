// What there is to shade at a hit: surface, material, colour, normals.
#ifndef SHADING_GLSL
#define SHADING_GLSL

#include "maps.glsl"
#include "mix.glsl"
#include "queue.glsl"
#include "scene_data.glsl"

struct shading {
    surface at;
    uvec3 ids; // of the object: load_object_ids; of a mix the material that shows
    gpu_material material;
    vec3 color;
    bool absent; // the surface has a hole there
    vec3 n;      // geometric normal, against the ray
    vec3 lit_by; // the normal that light falls by, against the ray
    vec2 gloss;  // what multiplies the material's roughness and metal
};

// A normal that is interpolated may face away from the ray where the surface itself does not: it is
// bent towards it, and so reflections stay in front.
vec3 facing(vec3 n, vec3 d)
{
    const float least = 0.01;
    float cosine = -ex_dot(n, d);
    return cosine < least ? ex_normalize(n - d * (least - cosine)) : n;
}

// A part of a mix with the light that the whole surface sends out.
gpu_material shining_as(gpu_material part, gpu_material whole)
{
    part.emission_red = whole.emission_red;
    part.emission_green = whole.emission_green;
    part.emission_blue = whole.emission_blue;
    part.flags = (part.flags & ~LR_GPU_FRONT_ONLY) | (whole.flags & LR_GPU_FRONT_ONLY);
    return part;
}

// `chance`: chosen_material.
shading shading_at(gpu_hit hit, gpu_ray ray, inout float chance)
{
    surface s = surface_at(hit, ray.origin, ray.direction);
    uvec3 ids = load_object_ids(s.object);
    uint whole = ids.x;
    gpu_material m = load_material(whole);
    if (has_mixes) {
        ids.x = chosen_material(ids.x, s, chance);
        m = shining_as(load_material(ids.x), m);
    }
    vec4 paint = paint_at(m, s);
    vec3 color = paint.xyz;
    bool absent = has_textures && has_cutouts && is_hole(m.pattern, m.inv_size, paint.w);
    vec3 n = ex_dot(ray.direction, s.normal) < 0.0 ? s.normal : -s.normal;
    vec3 lit_by = n, upright = s.shading;
    vec2 gloss = vec2(1.0);
    bool mirrors = false;
    if (has_relief || has_gloss_maps || has_emission_maps) {
        gpu_maps maps = load_maps(ids.x);
        mirrors = (maps.flags & LR_GPU_MAPS_MIRROR) != 0u;
        if (has_relief)
            upright = relief_normal(maps, upright, s.uv, s.growth);
        if (has_gloss_maps)
            gloss = gloss_texel(maps, s.uv);
        if (has_emission_maps)
            dim_emission(load_maps(whole), s.uv, m);
    }
    if (has_corners)
        color = color * s.tint;
    if (has_corners || has_relief)
        lit_by = facing(ex_dot(ray.direction, s.normal) < 0.0 ? upright : -upright, ray.direction);
    if (has_relief && mirrors)
        lit_by = mirroring(lit_by, n, ray.direction);
    return shading(s, ids, m, color, absent, n, lit_by, gloss);
}

#endif
