// What rays see that meet nothing.
#ifndef BACKGROUND_GLSL
#define BACKGROUND_GLSL

#include "bindings.glsl"
#include "exact.glsl"

vec3 background(vec3 d)
{
    float up = 0.5 + 0.5 * ex_dot(d, frame.background_up);
    return ex_mix(frame.background_low, frame.background_high, clamp(up, 0.0, 1.0));
}

#endif
