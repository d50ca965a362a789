// What an object takes from light that meets it on its way.
#ifndef OBSTACLE_GLSL
#define OBSTACLE_GLSL

#include "scene_data.glsl"

bool crosses(vec2 crossing, float t_max)
{
    return (crossing.x > 0.0 && crossing.x < t_max) || (crossing.y > 0.0 && crossing.y < t_max);
}

// What one transparent object takes from the light: its transmit colour once per surface, and its
// absorption over the length inside. `shadow` is the object's record for that.
uvec3 tint(vec2 crossing, float t_max, uvec4 shadow)
{
    bool first = crossing.x > 0.0 && crossing.x < t_max;
    bool second = crossing.y > 0.0 && crossing.y < t_max;
    uint surfaces = (first ? 1u : 0u) + (second ? 1u : 0u);
    uvec3 add = shadow.xyz * surfaces;
    bool dims = surfaces != 0u || has_scattering; // that of both ends within one solid
    if ((has_absorption || has_scattering) && dims && shadow.w != 0u) {
        float inside = max(min(crossing.y, t_max) - max(crossing.x, 0.0), 0.0);
        add += uvec3(min(load_medium(shadow.w).absorption * inside, vec3(40.0)) * LR_SHADOW_UNIT);
    }
    return add;
}

// What is left of each channel behind the optical depth of all obstacles.
vec3 light_left(uvec3 depth)
{
    bvec3 dark = equal(depth, uvec3(LR_SHADOW_OPAQUE));
    vec3 left = vec3(1.0);
    if (has_transparent) {
        vec3 bits = vec3(depth) * LR_SHADOW_BITS;
        left = vec3(ex_exp2(bits.x), ex_exp2(bits.y), ex_exp2(bits.z));
    }
    return mix(left, vec3(0.0), dark);
}

#endif
