// What rays see that meet nothing.
#ifndef BACKGROUND_GLSL
#define BACKGROUND_GLSL

#include "exact.glsl"
#include "scene_data.glsl"
#include "texture.glsl"

gpu_environment load_environment()
{
    uint at = frame.environment;
    vec4 a = scene_row_float(at), b = scene_row_float(at + 1u), c = scene_row_float(at + 2u);
    vec4 d = scene_row_float(at + 3u), e = scene_row_float(at + 4u);
    uvec4 f = scene_row(at + 5u);
    return gpu_environment(a.xyz, floatBitsToUint(a.w), b.xyz, b.w, c.xyz, floatBitsToUint(c.w), d.xyz,
                           d.w, e.xyz, e.w, uintBitsToFloat(f.x), f.y, f.z, f.w);
}

// Where a direction lies in the picture.
vec2 environment_uv(gpu_environment e, vec3 d)
{
    float x = ex_dot(d, e.right), y = ex_dot(d, e.up), z = ex_dot(d, e.forward);
    float across = ex_sqrt(x * x + z * z);
    return vec2(0.5 + ex_angle_turns(x, z), 2.0 * ex_angle_turns(across, y));
}

// By the chord, since cosines of small angles are too coarse: it is 2 (1 - cos) squared.
bool in_sun(gpu_environment e, vec3 d)
{
    vec3 chord = d - e.sun;
    return ex_dot(chord, chord) <= 2.0 * e.sun_spread;
}

vec3 background(vec3 d)
{
    float up = 0.5 + 0.5 * ex_dot(d, frame.background_up);
    vec3 light = ex_mix(frame.background_low, frame.background_high, clamp(up, 0.0, 1.0));
    if (has_environment) {
        gpu_environment e = load_environment();
        light = texture_at(e.texture, environment_uv(e, d)).xyz * e.intensity;
        if (has_sun && in_sun(e, d))
            light = light + e.sun_radiance;
    }
    return light;
}

#endif
