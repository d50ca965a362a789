// Camera rays and where in the pixel the samples fall.
#ifndef CAMERA_GLSL
#define CAMERA_GLSL

#include "bindings.glsl"
#include "exact.glsl"
#include "random.glsl"

// Where sample `index` of frame.samples lies in its pixel, in [0, 1)^2: stratified like a Hammersley
// set, one sample in each of n columns and, for n = 2^k, in each of n rows, with a scramble of the
// rows and a jitter within the stratum that depend on the pixel. One sample is the pixel's centre.
vec2 sample_position(uvec2 pixel, uint index)
{
    uint jitter = hash(hash_pixel(pixel, frame.seed, 0u) + index);
    uint scramble = hash_pixel(pixel, frame.seed, 1u);
    float x = (float(index) + unit_float(jitter)) * frame.inv_samples;
    uint row = bitfieldReverse(index) ^ scramble;
    vec2 stratified = vec2(min(x, 0.99999994), unit_float(row));
    return mix(stratified, vec2(0.5), bvec2(hidden(frame.samples) == 1u));
}

vec3 camera_direction(vec2 position)
{
    float right = position.x - frame.half_width;
    float down = position.y - frame.half_height;
    return ex_normalize(frame.forward + frame.pixel_right * right + frame.pixel_down * down);
}

#endif
