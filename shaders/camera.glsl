// Camera rays and where in the pixel the samples fall.
#ifndef CAMERA_GLSL
#define CAMERA_GLSL

#include "bindings.glsl"
#include "exact.glsl"
#include "lens.glsl"
#include "random.glsl"
#include "sampler.glsl"

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

// A position in the pixel, in [0, 1)^2, after the filter, whose reach may be beyond the pixel.
vec2 filtered_position(vec2 u)
{
    uint kind = hidden(frame.lens.kind);
    vec2 t = 2.0 * u - 1.0;
    vec2 tent = vec2(tent_offset(t.x), tent_offset(t.y)) + 0.5;
    vec2 harris = vec2(blackman_harris_offset(t.x), blackman_harris_offset(t.y)) + 0.5;
    vec2 position = mix(u, tent, bvec2((kind & LR_GPU_FILTER_TENT) != 0u));
    return mix(position, harris, bvec2((kind & LR_GPU_FILTER_BLACKMAN_HARRIS) != 0u));
}

struct camera_ray {
    vec3 origin;
    vec3 direction; // unit
};

camera_ray pinhole_ray(vec2 position)
{
    float right = position.x - frame.half_width;
    float down = position.y - frame.half_height;
    return camera_ray(frame.origin, ex_normalize(frame.forward + frame.pixel_right * right +
                                                 frame.pixel_down * down));
}

// Any camera's ray: `lens` in [0, 1)^2 is where it goes through the lens, `time` in [0, 1) when while
// the shutter is open. For a pinhole it is pinhole_ray, to the bit. The frame's vectors move along
// straight lines, and the lens with them, unturned.
camera_ray lens_ray(vec2 position, vec2 lens, float time)
{
    uint kind = hidden(frame.lens.kind);
    float right = position.x - frame.half_width;
    float down = position.y - frame.half_height;
    vec3 origin = frame.origin + frame.lens.origin_step * time;
    vec3 forward = frame.forward + frame.lens.forward_step * time;
    vec3 pixel_right = frame.pixel_right + frame.lens.right_step * time;
    vec3 pixel_down = frame.pixel_down + frame.lens.down_step * time;

    float blades = float(kind >> uint(LR_GPU_BLADES_SHIFT));
    vec2 polygon = polygon_point(lens, blades, frame.lens.inv_blades, frame.lens.blade_turns);
    vec2 at = mix(disk_point(lens), polygon, bvec2(blades > 0.0));
    vec3 aside = frame.lens.right * at.x + frame.lens.up * at.y;

    bool parallel = (kind & LR_GPU_ORTHOGRAPHIC) != 0u, around = (kind & LR_GPU_PANORAMA) != 0u;
    vec2 longitude = ex_cos_sin_turns(right * frame.lens.turns_across);
    vec2 latitude = ex_cos_sin_turns(down * frame.lens.turns_down);
    vec3 ahead = forward + pixel_right * right + pixel_down * down;
    vec3 turned = (forward * longitude.x + pixel_right * longitude.y) * latitude.x +
                  pixel_down * latitude.y;
    vec3 shift = pixel_right * right + pixel_down * down;
    vec3 towards = mix(ahead - aside * frame.lens.inv_focus, forward, bvec3(parallel));
    return camera_ray(origin + mix(aside, shift, bvec3(parallel)),
                      ex_normalize(mix(towards, turned, bvec3(around))));
}

// The ray of the sample that `key` tells, `within` its pixel.
camera_ray sample_ray(uvec2 pixel, vec2 within, path_key key)
{
    camera_ray ray;
    if (has_lens)
        ray = lens_ray(vec2(pixel) + filtered_position(within), sample_pair(key, pair_lens),
                       sample_pair(key, pair_time).x);
    else
        ray = pinhole_ray(vec2(pixel) + within);
    return ray;
}

#endif
