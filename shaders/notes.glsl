// What kernels that explain write down about the rays of one pixel. Notes change nothing that they
// tell of. All calls stand in branches on `explains`, which are cut out for pictures.
#ifndef NOTES_GLSL
#define NOTES_GLSL

#include "bindings.glsl"
#include "film.glsl"
#include "obstacle.glsl"

uint noted_ray;     // the note of the ray at hand
uvec4 noted_lights; // the notes of the lights at hand, by the slots of their shadow rays

uint ray_note_index()
{
    return min(noted_ray - 1u, uint(LR_NOTED_RAYS - 1));
}

uint light_note_index(uint note)
{
    return min(note - 1u, uint(LR_NOTED_LIGHTS - 1));
}

// The value in film steps, as the film takes it.
#define NOTE_STEPS(to, value)                                                                      \
    {                                                                                              \
        film_sum steps = film_zero();                                                              \
        film_accumulate(steps, value);                                                             \
        to[0] = steps.low.x;                                                                       \
        to[1] = steps.high.x;                                                                      \
        to[2] = steps.low.y;                                                                       \
        to[3] = steps.high.y;                                                                      \
        to[4] = steps.low.z;                                                                       \
        to[5] = steps.high.z;                                                                      \
    }

// A new note of a ray that meets `primitive` after t metres, or nothing.
void note_ray(gpu_ray ray, float t, uint primitive)
{
    noted_ray = atomicAdd(notes.rays, 1u) + 1u;
    uint i = ray_note_index();
    notes.ray[i].origin = ray.origin;
    notes.ray[i].parent = ray.note;
    notes.ray[i].direction = ray.direction;
    notes.ray[i].state = ray.state;
    notes.ray[i].weight = ray.weight;
    notes.ray[i].t = t;
    notes.ray[i].primitive = primitive;
}

void note_air(vec3 weight_there, vec3 fog, uint medium)
{
    uint i = ray_note_index();
    notes.ray[i].weight_there = weight_there;
    notes.ray[i].medium = medium;
    notes.ray[i].fog = fog;
    NOTE_STEPS(notes.ray[i].fog_steps, fog)
}

void note_background(vec3 background)
{
    uint i = ray_note_index();
    notes.ray[i].background = background;
    NOTE_STEPS(notes.ray[i].own_steps, background)
}

void note_surface(uint object, vec3 position, vec3 normal, vec3 lit_by, vec3 direction, vec3 color,
                  bool lit)
{
    uint i = ray_note_index();
    notes.ray[i].object = object;
    notes.ray[i].position = position;
    notes.ray[i].normal = normal;
    notes.ray[i].lit_by = lit_by;
    notes.ray[i].cosine = -ex_dot(direction, lit_by);
    notes.ray[i].color = color;
    notes.ray[i].flags = (ex_dot(direction, normal) < 0.0 ? LR_NOTE_ENTERING : 0u) |
                         (lit ? LR_NOTE_LIT : 0u);
}

// The light that the surface gives off by itself.
void note_own_light(vec3 ambient, vec3 emission, vec3 sum)
{
    uint i = ray_note_index();
    notes.ray[i].ambient = ambient;
    notes.ray[i].emission = emission;
    NOTE_STEPS(notes.ray[i].own_steps, sum)
}

// What is on both sides, and the cosine of what goes through.
void note_refraction(uint medium_beyond, float ior, float ior_beyond, float refracted_cosine)
{
    uint i = ray_note_index();
    notes.ray[i].medium_beyond = medium_beyond;
    notes.ray[i].ior = ior;
    notes.ray[i].ior_beyond = ior_beyond;
    notes.ray[i].refracted_cosine = refracted_cosine;
}

void note_reflectance(float reflectance)
{
    notes.ray[ray_note_index()].reflectance = reflectance;
}

void note_children(vec3 reflect_weight, vec3 reflected, vec3 transmit_weight, vec3 refracted, uint flags)
{
    uint i = ray_note_index();
    notes.ray[i].reflect_weight = reflect_weight;
    notes.ray[i].transmit_weight = transmit_weight;
    notes.ray[i].reflected = ex_normalize(reflected);
    notes.ray[i].refracted = ex_normalize(refracted);
    notes.ray[i].flags |= flags;
}

// A new note of a light; returns its number.
uint note_light(gpu_light_note note)
{
    uint number = atomicAdd(notes.lights, 1u) + 1u;
    notes.light[light_note_index(number)] = note;
    return number;
}

// What is left of a light behind all that stands in its way, and what it brings.
void note_arrival(uint number, vec3 left, vec3 value)
{
    uint i = light_note_index(number);
    notes.light[i].left = left;
    NOTE_STEPS(notes.light[i].steps, value)
}

// Something that takes `depth` from a light.
void note_obstacle(uint light, uint object, vec2 crossing, uvec3 depth)
{
    uint i = min(atomicAdd(notes.obstacles, 1u), uint(LR_NOTED_OBSTACLES - 1));
    vec3 left = light_left(min(depth, uvec3(LR_SHADOW_OPAQUE)));
    notes.obstacle[i] = gpu_obstacle_note(left, light, crossing.x, crossing.y, object, 0u);
}

#endif
