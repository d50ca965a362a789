// Media that scatter light: how far a path flies in one, and where it goes from there.
#ifndef FLIGHT_GLSL
#define FLIGHT_GLSL

#include "air.glsl"
#include "basis.glsl"

struct flight {
    vec3 weight;      // of what is at its end
    vec3 position;    // where it ends within the medium, if it does
    bool scatters;
    float anisotropy; // of the medium
};

const flight no_flight = flight(vec3(1.0), vec3(0.0), false, 0.0);

// What is left of light after t metres in a medium.
vec3 left_of(gpu_medium m, float t)
{
    vec3 depth = m.absorption * t;
    return vec3(ex_exp2(-depth.x), ex_exp2(-depth.y), ex_exp2(-depth.z));
}

// A ray that meets something after `t_max` metres. One channel, chosen at random, says how far it flies; all
// that could have said so share the weight (Veach's balance heuristic of one sample). A path that may not
// bounce any more flies on, and only its light dwindles.
flight fly(gpu_ray ray, float t_max, vec2 u, bool may_scatter)
{
    gpu_medium m = load_medium(medium_of(ray));
    float rate = mix(mix(m.absorption.z, m.absorption.y, u.x < 0.6666667), m.absorption.x, u.x < 0.33333334);
    bool can = may_scatter && any(greaterThan(m.scattering, vec3(0.0)));
    bool ends = can && rate > 1.0e-15;
    float t = ends ? -ex_log2(1.0 - u.y) * ex_rcp(max(rate, 1.0e-15)) : t_max;
    bool scatters = ends && t < t_max;
    t = scatters ? t : t_max;
    vec3 left = left_of(m, t);
    vec3 density = scatters ? m.absorption * left : left;
    float mean = (density.x + density.y + density.z) * (1.0 / 3.0);
    vec3 weight = (scatters ? m.scattering * left : left) * ex_rcp(max(mean, 1.0e-25));
    return flight(can ? weight : left, ray.origin + ray.direction * t, scatters, m.anisotropy);
}

// Henyey and Greenstein ("Diffuse radiation in the galaxy", 1941): how much light, per solid angle, goes on
// at an angle of that cosine to where it came from.
float phase_at(float g, float cosine)
{
    float inv = ex_rsqrt(max(1.0 + g * g - 2.0 * g * cosine, 1.0e-4));
    return (1.0 - g * g) * 0.0795774715 * (inv * inv * inv); // 1 / 4 pi
}

// Such a direction. The cosine is (1 + g^2 - ((1 - g^2) / (1 + g s))^2) / 2 g for s in [-1, 1], with g
// taken out of the numerator, which does not cancel.
vec3 sample_phase(float g, vec3 direction, vec2 u)
{
    float s = 2.0 * u.x - 1.0, g2 = g * g, inv = ex_rcp(1.0 + g * s);
    float over = s + 1.5 * g + 0.5 * g * (s * s) + g2 * s + 0.5 * (g2 * g) * (s * s - 1.0);
    float cosine = clamp(over * (inv * inv), -1.0, 1.0);
    float sine = ex_sqrt(max(1.0 - cosine * cosine, 0.0));
    vec2 around = ex_cos_sin_turns(u.y) * sine;
    return ex_normalize(to_world(basis_around(direction), vec3(around, cosine)));
}

#endif
