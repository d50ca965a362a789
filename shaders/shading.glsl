// What there is to shade at a hit: surface, material, colour, normals.
#ifndef SHADING_GLSL
#define SHADING_GLSL

#include "maps.glsl"
#include "pattern.glsl"
#include "queue.glsl"
#include "scene_data.glsl"
#include "surface.glsl"
#include "texture.glsl"

struct shading {
    surface at;
    uvec3 ids; // of the object: load_object_ids
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

shading shading_at(gpu_hit hit, gpu_ray ray)
{
    surface s = surface_at(hit, ray.origin, ray.direction);
    uvec3 ids = load_object_ids(s.object);
    gpu_material m = load_material(ids.x);
    vec3 color = m.color0;
    if (has_patterns)
        color = pattern_color(m, s.object, s.position, s.normal);
    bool absent = false;
    if (has_textures) {
        vec4 texel = material_texel(m, s.uv);
        color = color * texel.xyz;
        absent = has_cutouts && is_hole(m.pattern, m.inv_size, texel.w);
    }
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
            dim_emission(maps, s.uv, m);
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
