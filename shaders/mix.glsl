// Mixes of materials: a path finds one of the two, by chance and by the weight where it meets the
// surface.
#ifndef MIX_GLSL
#define MIX_GLSL

#include "pattern.glsl"
#include "surface.glsl"
#include "texture.glsl"

// The colour of a material on a surface, and the alpha of its picture there.
vec4 paint_at(gpu_material m, surface s)
{
    vec4 paint = vec4(m.color0, 1.0);
    if (has_patterns)
        paint.xyz = pattern_color(m, s.object, s.position, s.normal);
    if (has_textures) {
        vec4 texel = material_texel(m, s.uv);
        paint = vec4(paint.xyz * texel.xyz, texel.w);
    }
    return paint;
}

// The luminance, as lr_color_luminance has it.
float share_of_second(vec3 weight)
{
    return clamp(weight.y + 0.2126 * (weight.x - weight.y) + 0.0722 * (weight.z - weight.y), 0.0, 1.0);
}

gpu_mix load_mix(uint material)
{
    uvec4 a = scene_row(frame.mixes + material);
    return gpu_mix(a.x, a.y, a.z, a.w);
}

// The material that a mix, or what is none, shows. `chance` within [0, 1) decides, and becomes another
// that the decision says nothing of.
uint chosen_material(uint material, surface s, inout float chance)
{
    for (uint level = 0u;;) {
        gpu_mix parts = load_mix(material);
        bool mixed = parts.first != LR_GPU_MIX_NONE;
        float weight = share_of_second(paint_at(load_material(material), s).xyz);
        bool second = chance < weight;
        float share = mix(1.0 - weight, weight, second), begin = mix(weight, 0.0, second);
        float within = min(ex_div(chance - begin, max(share, 1.0e-7)), 0.99999994);
        chance = mix(chance, within, mixed && share < 1.0);
        material = mix(material, mix(parts.first, parts.second, second), mixed);
        level++;
        if (!mixed || level >= LR_GPU_MIX_NESTING_MAX)
            break;
    }
    return material;
}

#endif
