// Pictures that are not colours: normals, heights, roughness, metal, light.
#ifndef MAPS_GLSL
#define MAPS_GLSL

#include "mesh.glsl"
#include "texture.glsl"
#include "uv.glsl"

// The texture at uv; what a material without it gets is not used.
vec4 map_texel(uint texture, vec2 uv)
{
    return texture_at(mix(texture, 0u, texture == LR_NO_MAP), uv);
}

// Components below 2^-100 as 0: some devices have no numbers further down.
vec3 without_dust(vec3 v)
{
    return mix(v, vec3(0.0), lessThan(abs(v), vec3(7.888609052210118e-31)));
}

// A vector that can be reckoned with: 0 if its greatest component is not within 2^-80..2^80, or not a
// number.
vec3 usable_growth(vec3 v)
{
    uvec3 bits = floatBitsToUint(abs(v));
    uint most = max(bits.x, max(bits.y, bits.z));
    return mix(without_dust(v), vec3(0.0), bvec3(most < 0x17800000u || most > 0x67800000u));
}

// The heights half a texel to both sides along u and v, from 0 to 1: red of four lookups of texture_at.
vec4 heights_around(uint texture, vec2 uv, out vec2 size)
{
    gpu_texture t = load_texture(texture);
    size = vec2(float(t.size & 0xFFFFu), float(t.size >> 16));
    vec2 half_texel = vec2(0.5 * ex_rcp(max(size.x, 1.0)), 0.5 * ex_rcp(max(size.y, 1.0)));
    vec4 found = vec4(0.0);
    for (uint k = 0u;;) {
        float side = mix(-1.0, 1.0, (k & 1u) != 0u);
        vec2 away = mix(vec2(half_texel.x, 0.0), vec2(0.0, half_texel.y), bvec2(k >= 2u));
        found = vec4(found.yzw, texture_at(texture, uv + away * side).x);
        k++;
        if (k >= 4u)
            break;
    }
    return found;
}

// The normal of a surface with heights on it (Blinn, "Simulation of Wrinkled Surfaces", 1978), by their
// gradient along the surface (Mikkelsen, 2010).
vec3 bumped(gpu_maps maps, vec3 n, vec2 uv, uv_growth growth)
{
    vec2 size;
    vec4 h = heights_around(mix(maps.bump, 0u, maps.bump == LR_NO_MAP), uv, size);
    vec2 rise = vec2(h.y - h.x, h.w - h.z);
    // What may be the rounding of equal heights is none.
    rise = mix(rise, vec2(0.0), lessThan(abs(rise), vec2(abs(h.y), abs(h.w)) * 1.0e-6)) * size;
    vec3 slope = (growth.u * rise.x + growth.v * rise.y) * maps.bump_height;
    slope = clamp(slope, vec3(-1.0e6), vec3(1.0e6));
    slope = without_dust(slope - n * ex_dot(slope, n));
    bool level = maps.bump == LR_NO_MAP || slope == vec3(0.0);
    return mix(ex_normalize(n - slope), n, bvec3(level));
}

// The normal that a picture in tangent space says, as glTF has it: x to the right and y up in the
// picture, z along n. The tangents follow the texture coordinates and stand at right angles to n.
vec3 normal_mapped(gpu_maps maps, vec3 n, vec2 uv, uv_growth growth)
{
    vec3 said = map_texel(maps.normal, uv).xyz;
    said = vec3(said.xy * maps.normal_scale, max(said.z, 0.0));
    vec3 u = ex_scale_up(growth.u), v = ex_scale_up(growth.v);
    float side = ex_dot(ex_cross(u, v), n); // below 0: as seen from outside, v goes down
    vec3 right = ex_cross(v, n);
    float length2 = ex_dot(right, right);
    bool level = maps.normal == LR_NO_MAP || said.xy == vec2(0.0) || abs(side) < 1.0e-8 || length2 < 1.0e-8;
    right = right * ex_rsqrt(level ? 1.0 : length2);
    right = side < 0.0 ? -right : right;
    vec3 up = side < 0.0 ? ex_cross(n, right) : ex_cross(right, n);
    vec3 bent = without_dust(right * said.x + up * said.y + n * said.z);
    float bent2 = ex_dot(bent, bent);
    level = level || bent2 < 1.0e-12;
    return mix(bent * ex_rsqrt(level ? 1.0 : bent2), n, bvec3(level));
}

// The outward normal n with what its material's pictures make of it; n itself, bit for bit, where they
// say nothing else.
vec3 relief_normal(gpu_maps maps, vec3 n, vec2 uv, uv_growth growth)
{
    vec3 bent = n;
    growth = uv_growth(usable_growth(growth.u), usable_growth(growth.v));
    if (has_bump_maps)
        bent = bumped(maps, bent, uv, growth);
    if (has_normal_maps)
        bent = normal_mapped(maps, bent, uv, growth);
    return bent;
}

// The normal nearest to n that mirrors what goes along d to the side that the surface's own normal ng is
// on (Keller et al., "The Iray Light Transport Simulation and Rendering System", 2017).
vec3 mirroring(vec3 n, vec3 ng, vec3 d)
{
    vec3 mirrored = d - n * (2.0 * ex_dot(d, n));
    float least = min(0.01, -0.9 * ex_dot(d, ng));
    float missing = least - ex_dot(mirrored, ng);
    vec3 bent = ex_normalize(mirrored + ng * missing) - d;
    float length2 = max(ex_dot(bent, bent), 1.0e-20);
    return mix(n, bent * ex_rsqrt(length2), bvec3(missing > 0.0 && least > 0.0));
}

float channel_of(vec4 texel, uint channel)
{
    vec2 two = mix(texel.xy, texel.zw, bvec2((channel & 2u) != 0u));
    return mix(two.x, two.y, (channel & 1u) != 0u);
}

// What multiplies a material's roughness and metal.
vec2 gloss_texel(gpu_maps maps, vec2 uv)
{
    float roughness = channel_of(map_texel(maps.roughness, uv), maps.flags & 3u);
    float metallic = channel_of(map_texel(maps.metallic, uv), (maps.flags >> LR_GPU_MAPS_METALLIC_SHIFT) & 3u);
    return vec2(mix(min(roughness, 1.0), 1.0, maps.roughness == LR_NO_MAP),
                mix(min(metallic, 1.0), 1.0, maps.metallic == LR_NO_MAP));
}

void dim_emission(gpu_maps maps, vec2 uv, inout gpu_material m)
{
    vec3 texel = mix(map_texel(maps.emission, uv).xyz, vec3(1.0), bvec3(maps.emission == LR_NO_MAP));
    m.emission_red *= texel.x;
    m.emission_green *= texel.y;
    m.emission_blue *= texel.z;
}

#endif
