// What happens to light between two surfaces: fog outside, absorption in media.
#ifndef AIR_GLSL
#define AIR_GLSL

#include "exact.glsl"
#include "media.glsl"
#include "queue.glsl"
#include "scene_data.glsl"

uint medium_of(gpu_ray ray)
{
    return has_media ? media_top(ray_media(ray)) : 0u;
}

// What is left of light after t metres; with media that scatter that is flight.glsl's matter, but for fog.
vec3 remaining_after(float t, uint medium)
{
    vec3 rate = vec3(0.0);
    if (has_fog)
        rate = vec3(frame.fog_density);
    if (has_media && medium != 0u)
        rate = has_absorption && !has_scattering ? load_medium(medium).absorption : vec3(0.0);
    vec3 depth = rate * t;
    return vec3(ex_exp2(-depth.x), ex_exp2(-depth.y), ex_exp2(-depth.z));
}

// The weight of what a ray meets after t metres, and the fog's own light on the way.
vec3 weight_after(gpu_ray ray, float t, out vec3 fog)
{
    vec3 weight = ray.weight;
    fog = vec3(0.0);
    if (has_fog || has_absorption) {
        uint medium = medium_of(ray);
        vec3 remaining = remaining_after(t, medium);
        if (has_fog && medium == 0u)
            fog = weight * (frame.fog_color * (vec3(1.0) - remaining));
        weight = weight * remaining;
    }
    return weight;
}

#endif
