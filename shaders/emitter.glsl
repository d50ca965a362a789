// What lights a point: one light source, chosen at random, and a point of it; and how likely that is for
// one that was found in another way.
#ifndef EMITTER_GLSL
#define EMITTER_GLSL

#include "background.glsl"
#include "basis.glsl"
#include "light.glsl"
#include "uv.glsl"

const float emitter_pi = 3.14159274;

struct light_sample {
    vec3 wi; // unit, towards the light
    float t_max;
    vec3 value; // radiance / (pdf, of the choice too); of a point light what has the same effect
    float pdf;  // per solid angle, times the choice's probability; 0: no other way leads there
};

const light_sample no_light = light_sample(vec3(0.0, 0.0, 1.0), 0.0, vec3(0.0), 0.0);

gpu_emitter load_emitter(uint at)
{
    vec4 a = scene_row_float(at), b = scene_row_float(at + 1u), c = scene_row_float(at + 2u);
    vec4 d = scene_row_float(at + 3u), e = scene_row_float(at + 4u);
    return gpu_emitter(a.xyz, floatBitsToUint(a.w), b.xyz, b.w, c.xyz, c.w, d.xyz,
                       floatBitsToUint(d.w), e.xyz, e.w);
}

gpu_object_emitter load_object_emitter(uint object)
{
    uint at = frame.object_emitters + LR_OBJECT_EMITTER_ROWS * object;
    vec4 a = scene_row_float(at), b = scene_row_float(at + 1u);
    return gpu_object_emitter(a.xyz, floatBitsToUint(a.w), b.x, b.y, 0u, 0u);
}

// The row of an emitter, by a number in [0, 1): Walker's aliases in whole numbers ("New Fast Method for
// Generating Discrete Random Numbers", Electronics Letters 10-8, 1974).
uint choose_emitter(float choice)
{
    uint steps = uint(int(choice * LR_CHOICE_STEPS));
    uint slot = steps >> (frame.choice_shift & 31u);
    uvec4 two = scene_row(frame.choices + slot);
    return mix(two.y, two.z, steps - (slot << (frame.choice_shift & 31u)) >= two.x);
}

// The radiance that leaves a sampled point towards where it lights.
vec3 emitter_radiance(gpu_emitter e, bool from_front)
{
    uint side = from_front ? LR_GPU_EMITTER_FRONT : LR_GPU_EMITTER_BACK;
    return (e.kind & side) != 0u ? e.radiance : vec3(0.0);
}

gpu_emitter_map load_emitter_map(uint at)
{
    vec4 a = scene_row_float(at), b = scene_row_float(at + 1u);
    return gpu_emitter_map(a.x, a.y, a.z, a.w, b.x, b.y, floatBitsToUint(b.z), floatBitsToUint(b.w));
}

// What multiplies its radiance at the point p, which lies at these coordinates of what is flat. Row 0 is
// no such map.
vec3 emitter_texel(gpu_emitter e, vec2 at, vec3 p)
{
    bool mapped = e.light != 0u && (e.kind & LR_GPU_EMITTER_KIND) != LR_GPU_EMITTER_LIGHT;
    gpu_emitter_map m = load_emitter_map(mapped ? e.light : 0u);
    vec2 uv = vec2(m.u, m.v) + vec2(m.u1, m.v1) * at.x + vec2(m.u2, m.v2) * at.y;
    if (has_sphere_emitters) {
        bool sphere = (e.kind & LR_GPU_EMITTER_KIND) == LR_GPU_EMITTER_SPHERE;
        uv = mix(uv, planar_uv(mapped ? m.object : 0u, p), bvec2(sphere));
    }
    vec4 texel = texture_at(mapped ? m.texture : 0u, uv);
    return mix(vec3(1.0), texel.xyz, bvec3(mapped));
}

// ---- Flat surfaces: a point uniform by area ----

// Coordinates along the two edges. Triangle: Heitz, "A Low-Distortion Map Between Triangle and Square",
// 2019.
vec2 flat_coordinates(uint kind, vec2 u)
{
    vec2 at = u;
    if (has_triangle_emitters) {
        vec2 low = u.y > u.x ? vec2(0.5 * u.x, u.y - 0.5 * u.x) : vec2(u.x - 0.5 * u.y, 0.5 * u.y);
        at = kind == LR_GPU_EMITTER_TRIANGLE ? low : at;
    }
    if (has_disk_emitters) {
        vec2 round = ex_cos_sin_turns(u.y) * ex_sqrt(u.x);
        at = kind == LR_GPU_EMITTER_DISK ? round : at;
    }
    return at;
}

light_sample sample_flat(gpu_emitter e, uint kind, vec3 position, vec2 u)
{
    vec2 at = flat_coordinates(kind, u);
    vec3 p = e.origin + e.e1 * at.x + e.e2 * at.y;
    if (has_emission_maps)
        e.radiance = e.radiance * emitter_texel(e, at, p);
    bool from_front = ex_dot(e.normal, position - p) > 0.0;
    vec3 n = from_front ? e.normal : -e.normal;
    // The shadow ray ends off the surface by as much as rays start off one, so it never meets it.
    vec3 reach = abs(p);
    p = p + n * (max(max(reach.x, reach.y), reach.z) * LR_OFFSET);
    vec3 to_light = p - position;
    float distance2 = ex_dot(to_light, to_light);
    bool apart = distance2 > 7.888609052210118e-31;
    distance2 = apart ? distance2 : 1.0;
    float inv_distance = ex_rsqrt(distance2);
    vec3 wi = to_light * inv_distance;
    float cosine = -ex_dot(n, wi);
    bool faces = apart && cosine > LR_COSINE_MIN;
    cosine = faces ? cosine : 1.0;
    vec3 value = emitter_radiance(e, from_front) * (cosine * e.inv_pdf * (inv_distance * inv_distance));
    return light_sample(wi, distance2 * inv_distance * LR_SHORT_OF, faces ? value : vec3(0.0),
                        faces ? e.pdf * distance2 * ex_rcp(cosine) : 0.0);
}

// ---- Balls: a direction uniform in the cone that the ball fills; from inside, in all directions ----

struct ball_cone {
    vec3 axis;    // unit
    float spread; // 1 - cosine of the cone's half angle
    float away2;  // squared distance of the centre, in radii
    bool outside;
    bool usable; // not so small and far that the cone is none
};

ball_cone cone_of_ball(vec3 center, float radius, vec3 position)
{
    vec3 away = (center - position) * ex_rcp(radius);
    float away2 = ex_dot(away, away);
    bool outside = away2 > 1.0, usable = away2 < 1.0e24;
    float safe = outside && usable ? away2 : 1.0;
    float inv = ex_rsqrt(safe), sine2 = inv * inv;
    float spread = sine2 * ex_rcp(1.0 + ex_sqrt(1.0 - sine2));
    return ball_cone(outside && usable ? away * inv : vec3(0.0, 0.0, 1.0), outside ? spread : 2.0, away2,
                     outside, usable);
}

// A direction of the cone; all parts of its solid angle are equally likely.
vec3 sample_cone(vec3 axis, float spread, vec2 u)
{
    float below = u.x * spread; // 1 - cosine
    float sine = ex_sqrt(below * (2.0 - below));
    vec2 around = ex_cos_sin_turns(u.y);
    return ex_normalize(to_world(basis_around(axis), vec3(around * sine, 1.0 - below)));
}

// How far it is to the ball's surface: the near side, or from inside the only one.
float distance_to_ball(vec3 center, float radius, vec3 position, vec3 wi, bool outside)
{
    vec3 away = (center - position) * ex_rcp(radius);
    float nearest = ex_dot(away, wi);
    vec3 q = away - wi * nearest;
    float half_chord = ex_sqrt(1.0 - ex_dot(q, q));
    return (outside ? nearest - half_chord : nearest + half_chord) * radius;
}

light_sample sample_sphere(gpu_emitter e, vec3 position, vec2 u)
{
    ball_cone cone = cone_of_ball(e.origin, e.radius, position);
    vec3 wi = sample_cone(cone.axis, cone.spread, u);
    float t = distance_to_ball(e.origin, e.radius, position, wi, cone.outside);
    float solid_angle = 2.0 * emitter_pi * cone.spread;
    if (has_emission_maps)
        e.radiance = e.radiance * emitter_texel(e, vec2(0.0), position + wi * t);
    vec3 value = emitter_radiance(e, cone.outside) * (solid_angle * e.inv_pdf);
    return light_sample(wi, t * LR_SHORT_OF, cone.usable ? value : vec3(0.0),
                        cone.usable ? e.pdf * ex_rcp(solid_angle) : 0.0);
}

// ---- The lights of scene.lights ----

// A point or a direction: what lights a surface as the ray tracer's cosine law does.
light_sample sample_sharp_light(gpu_light light, vec3 position)
{
    arriving_light arriving = sample_light(light, position);
    vec4 way = shadow_ray(light, position);
    return light_sample(way.xyz, way.w, arriving.color * emitter_pi, 0.0);
}

// A ball or a disk in the sky that brings as much light as the point or the direction would. No ray
// meets it, so no other way leads there.
light_sample sample_soft_light(gpu_light light, vec3 position, vec2 u)
{
    bool directional = (light.flags & LR_GPU_LIGHT_DIRECTIONAL) != 0u;
    ball_cone cone = cone_of_ball(light.position, light.radius, position);
    float spread = directional ? light.spread : cone.spread;
    vec3 wi = sample_cone(directional ? -light.direction : cone.axis, spread, u);
    float t = distance_to_ball(light.position, light.radius, position, wi, cone.outside);
    // The intensity is radiance times the disk that is seen, pi r^2, over pi; a falloff other than 2
    // dims all of it by the centre's distance.
    float away2 = cone.outside ? cone.away2 : 1.0;
    float fading = away2 * attenuation(light, away2 * light.radius * light.radius);
    float strength = 2.0 * emitter_pi * spread * fading;
    if (has_spots)
        strength = strength * spot_share(light, wi);
    strength = cone.usable ? strength : 0.0;
    // Irradiance across the beam is radiance pi sin^2; sin^2 / spread = 1 + cos.
    float across = 2.0 * emitter_pi * ex_rcp(2.0 - light.spread);
    return light_sample(wi, directional ? LR_T_MAX : t * LR_SHORT_OF,
                        light.color * (directional ? across : strength), 0.0);
}

light_sample sample_listed_light(uint index, vec3 position, vec2 u)
{
    gpu_light light = load_light(index);
    light_sample s = sample_sharp_light(light, position);
    if (has_soft_lights && (light.radius > 0.0 || light.spread > 0.0))
        s = sample_soft_light(light, position, u);
    if ((light.flags & LR_GPU_LIGHT_SHADOWS) == 0u)
        s.t_max = 0.0;
    return s;
}

// ---- The background ----

// Steps before texel x of a row of the picture, which begins at row `at` of the table.
uint steps_before(uint at, uint x)
{
    return texel_word(scene_row(at + (x >> 2)), x);
}

uint texel_table(gpu_environment e, uint y)
{
    return e.rows + e.height + y * ((e.width + 3u) >> 2);
}

// How many steps of a row of the picture are texel x's, if `before` come before it.
uint steps_of(gpu_environment e, uint at, uint x, uint before)
{
    uint next = min(x + 1u, e.width - 1u);
    uint end = mix(steps_before(at, next), uint(LR_CHOICE_STEPS), x + 1u == e.width);
    return end - before;
}

vec3 environment(vec3 d)
{
    return background(d);
}

// The pdf, per solid angle, with which sample_light_at goes towards d to see the background.
float environment_pdf(vec3 d)
{
    float pdf = 0.0;
    if (has_environment) {
        gpu_environment e = load_environment();
        vec2 uv = environment_uv(e, d);
        uint x = min(uint(int(max(uv.x, 0.0) * float(e.width))), e.width - 1u);
        uint y = min(uint(int(uv.y * float(e.height))), e.height - 1u);
        uvec4 row = scene_row(e.rows + y);
        uint at = texel_table(e, y);
        float share = float(row.y) * float(steps_of(e, at, x, steps_before(at, x)));
        share = share * 3.552713678800501e-15; // 2^-48
        pdf = e.pdf * share * ex_rcp(uintBitsToFloat(row.w));
        if (has_sun && in_sun(e, d))
            pdf = pdf + e.sun_pdf;
    }
    return pdf;
}

// The last of `count` entries that has at most `steps` before it. A whole row of the picture, or one of
// its texels.
uint last_before(uint at, uint count, uint steps, bool texels)
{
    uint found = 0u;
    for (uint width = 8192u;;) {
        uint next = found + width;
        uint entry = min(next, count - 1u);
        uint before = texels ? steps_before(at, entry) : scene_row(at + entry).x;
        found = next < count && before <= steps ? next : found;
        width >>= 1;
        if (width == 0u)
            break;
    }
    return found;
}

vec3 sample_picture(gpu_environment e, vec2 u)
{
    uint steps_y = uint(int(u.y * LR_CHOICE_STEPS)), steps_x = uint(int(u.x * LR_CHOICE_STEPS));
    uint y = last_before(e.rows, e.height, steps_y, false);
    uvec4 row = scene_row(e.rows + y);
    uint at = texel_table(e, y);
    uint x = last_before(at, e.width, steps_x, true);
    uint before = steps_before(at, x);
    // What is left of both numbers tells where in the texel.
    float down = (float(steps_y - row.x) + 0.5) * ex_rcp(float(max(row.y, 1u)));
    float along = (float(steps_x - before) + 0.5) *
                  ex_rcp(float(max(steps_of(e, at, x, before), 1u)));
    bool lower = y >= (e.height + 1u) >> 1;
    float from_pole = uintBitsToFloat(row.z) + uintBitsToFloat(row.w) * (lower ? 1.0 - down : down);
    float cosine = 1.0 - 2.0 * from_pole, sine = 2.0 * ex_sqrt(from_pole * (1.0 - from_pole));
    cosine = lower ? -cosine : cosine;
    vec2 around = ex_cos_sin_turns((float(x) + along) * ex_rcp(float(e.width)) - 0.5) * sine;
    return ex_normalize(e.right * around.y + e.up * cosine + e.forward * around.x);
}

// The picture and the sun are one light with two ways to sample it: their densities add up.
light_sample sample_environment(bool sun, vec2 u)
{
    gpu_environment e = load_environment();
    vec3 wi = sample_picture(e, u);
    if (has_sun)
        wi = sun ? sample_cone(e.sun, e.sun_spread, u) : wi;
    float pdf = environment_pdf(wi);
    vec3 value = environment(wi) * ex_rcp(max(pdf, 1.0e-20));
    return light_sample(wi, LR_T_MAX, pdf > 1.0e-20 ? value : vec3(0.0), pdf);
}

// ---- All of them ----

light_sample sample_light_at(vec3 position, float choice, vec2 u)
{
    light_sample s = no_light;
    if (has_emitters) {
        gpu_emitter e = load_emitter(choose_emitter(choice));
        uint kind = e.kind & LR_GPU_EMITTER_KIND;
        if (has_flat_emitters)
            s = sample_flat(e, kind, position, u);
        if (has_sphere_emitters && kind == LR_GPU_EMITTER_SPHERE)
            s = sample_sphere(e, position, u);
        if (has_delta_lights && kind == LR_GPU_EMITTER_LIGHT) {
            s = sample_listed_light(e.light, position, u);
            s.value = s.value * e.inv_pdf;
        }
        bool sun = has_sun && kind == LR_GPU_EMITTER_SUN;
        if (has_environment && (sun || kind == LR_GPU_EMITTER_ENVIRONMENT))
            s = sample_environment(sun, u);
    }
    return s;
}

// The pdf of sample_light_at for a point of an object that a ray from `origin` meets after t metres,
// where the geometric normal is ng. 0 where nothing chooses the object.
float emitter_pdf(uint object, vec3 origin, vec3 direction, float t, vec3 ng)
{
    float pdf = 0.0;
    if (has_flat_emitters || has_sphere_emitters) {
        gpu_object_emitter e = load_object_emitter(object);
        float cosine = abs(ex_dot(direction, ng));
        bool faces = cosine > LR_COSINE_MIN;
        float seen = e.pdf * (t * t) * ex_rcp(faces ? cosine : 1.0);
        pdf = has_flat_emitters && faces && e.kind == LR_GPU_EMITTER_RECTANGLE ? seen : pdf;
        if (has_sphere_emitters && e.kind == LR_GPU_EMITTER_SPHERE) {
            ball_cone cone = cone_of_ball(e.center, e.radius, origin);
            pdf = cone.usable ? e.pdf * ex_rcp(2.0 * emitter_pi * cone.spread) : 0.0;
        }
    }
    return pdf;
}

#endif
