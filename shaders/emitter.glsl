// What lights a point: one of the light sources, chosen at random.
#ifndef EMITTER_GLSL
#define EMITTER_GLSL

#include "background.glsl"
#include "light.glsl"

struct light_sample {
    vec3 wi; // unit, towards the light
    float t_max;
    vec3 value; // radiance / (pdf, of the choice too); of a point light what has the same effect
    float pdf;  // per solid angle, times the choice's probability; 0: no other way leads there
};

light_sample sample_light_at(vec3 position, float choice, vec2 u)
{
    uint count = max(hidden(work.light_count), 1u);
    uint l = min(uint(int(choice * float(count))), count - 1u);
    gpu_light light = load_light(l);
    arriving_light arriving = sample_light(light, position);
    vec4 way = shadow_ray(light, position);
    const float pi = 3.14159274;
    return light_sample(way.xyz, way.w, arriving.color * (pi * float(count)), 0.0);
}

// The pdf of sample_light_at for a point that a ray from `origin` meets after t metres, where the
// geometric normal is ng.
float emitter_pdf(uint object, vec3 origin, vec3 direction, float t, vec3 ng)
{
    return 0.0;
}

vec3 environment(vec3 d)
{
    return background(d);
}

float environment_pdf(vec3 d)
{
    return 0.0;
}

#endif
