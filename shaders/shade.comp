#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
// What happens at each hit: the reflected and the refracted ray go into the next queue, the light
// that falls there into the film.
#include "gpu_layout.h"
#include "bindings.glsl"
#include "air.glsl"
#include "classic.glsl"
#include "film.glsl"
#include "inspect.glsl"
#include "light.glsl"
#include "notes.glsl"
#include "queue.glsl"
#include "scatter.glsl"
#include "shading.glsl"
#include "shadow.glsl"
#include "shadow_queue.glsl"

layout(local_size_x = LR_GROUP_SIZE) in;

// Notes what a light would bring if nothing stood in its way; returns the note's number.
uint note_sample(gpu_light light, uint number, arriving_light arriving, gpu_material m, surface s,
                 vec3 n, vec3 wo, vec3 origin, vec3 value, bool reaches)
{
    bool directional = (light.flags & LR_GPU_LIGHT_DIRECTIONAL) != 0u;
    vec3 to_light = light.position - s.position;
    float distance2 = ex_dot(to_light, to_light), fading = 1.0, highlight = 0.0, spot = 1.0;
    if (has_falloff)
        fading = attenuation(light, max(distance2, 7.888609052210118e-31));
    if (has_specular && m.specular != vec3(0.0))
        highlight = highlight_at(m, n, wo, arriving.wi);
    if (has_spots)
        spot = spot_share(light, arriving.wi);
    uint none[6] = uint[6](0u, 0u, 0u, 0u, 0u, 0u);
    return note_light(gpu_light_note(
        origin, noted_ray, arriving.wi, number, arriving.color,
        directional ? LR_T_MAX : ex_sqrt(distance2), value, ex_dot(n, arriving.wi), vec3(0.0),
        highlight, directional ? 1.0 : fading, spot, uint(reaches), 0u, none, 0u, 0u));
}

// Whether light from wi meets the side of the surface that its normal n is on; whatever the relief says.
bool is_lit(vec3 n, vec3 wi)
{
    bool lit = true;
    if (has_relief)
        lit = ex_dot(n, wi) > 0.0;
    return lit;
}

struct shadow_counts {
    uint traced, hits;
};

// Adds the light of up to four sources from number `first`.
void add_lights(uint first, uint count, vec3 weight, vec3 color, gpu_material m, surface s, vec3 n,
                vec3 lit_by, vec3 wo, bool lit, inout film_sum sum, inout shadow_counts counts)
{
    vec3 origin = s.position + n * s.offset;
    shadow_rays rays = shadow_rays_none();
    vec4 red = vec4(0.0), green = vec4(0.0), blue = vec4(0.0);
    uint shadowed = 0u;
    gpu_light held;
    if (has_shuffle)
        held = load_light(first + min(batch_lane(), count - 1u));
    for (uint l = 0u;;) {
        gpu_light light;
        if (has_shuffle)
            light = share(held, l);
        else
            light = load_light(first + l);
        arriving_light arriving = sample_light(light, s.position);
        vec3 value = weight * (arriving.color * classic_light(m, color, lit_by, wo, arriving.wi));
        // Light of less than a step of the film adds nothing, whatever stands in its way.
        bool reaches = lit && is_lit(n, arriving.wi) && any(greaterThanEqual(value, vec3(LR_FILM_STEP)));
        uint slot = reaches ? rays.count : no_slot;
        red = replaced(red, slot, value.x);
        green = replaced(green, slot, value.y);
        blue = replaced(blue, slot, value.z);
        uint shadows = (light.flags & LR_GPU_LIGHT_SHADOWS) != 0u ? 1u : 0u;
        set_ray(rays, slot, shadow_ray(light, origin), shadows);
        if (explains && lit)
            noted_lights = replaced(noted_lights, slot,
                                    note_sample(light, first + l, arriving, m, s, lit_by, wo, origin,
                                                value, reaches));
        rays.count += reaches ? 1u : 0u;
        shadowed += reaches ? shadows : 0u;
        l++;
        if (l >= count)
            break;
    }
    uint most = batch_max(rays.count);
    if (has_inspect)
        film_accumulate(sum, inspected_rays(shadowed));
    else
        trace_shadows(rays, origin, most);
    uvec4 met = rays.red | rays.green | rays.blue;
    counts.traced += shadowed;
    counts.hits += uint(met.x != 0u) + uint(met.y != 0u) + uint(met.z != 0u) + uint(met.w != 0u);
    for (uint i = 0u;;) {
        vec3 value = vec3(pick(red, i), pick(green, i), pick(blue, i));
        uvec3 depth = uvec3(pick(rays.red, i), pick(rays.green, i), pick(rays.blue, i));
        if (!has_inspect)
            film_accumulate(sum, value * light_left(depth));
        if (explains && i < rays.count)
            note_arrival(pick(noted_lights, i), light_left(depth), value * light_left(depth));
        i++;
        if (i >= most)
            break;
    }
}

// The same in scenes with trees, where kernels of their own find what stands in the way.
void send_lights(uint first, uint count, vec3 weight, vec3 color, gpu_material m, surface s, vec3 n,
                 vec3 lit_by, gpu_ray ray, bool lit, inout film_sum sum)
{
    vec3 origin = s.lit_from + n * s.offset;
    gpu_light held;
    if (has_shuffle)
        held = load_light(first + min(batch_lane(), count - 1u));
    for (uint l = 0u;;) {
        gpu_light light;
        if (has_shuffle)
            light = share(held, l);
        else
            light = load_light(first + l);
        arriving_light arriving = sample_light(light, s.position);
        vec3 light_color = classic_light(m, color, lit_by, -ray.direction, arriving.wi);
        vec3 value = weight * (arriving.color * light_color);
        bool reaches = lit && is_lit(n, arriving.wi) && any(greaterThanEqual(value, vec3(LR_FILM_STEP)));
        bool shadowed = (light.flags & LR_GPU_LIGHT_SHADOWS) != 0u;
        vec3 at_once = value;
        if (has_inspect)
            at_once = inspected_rays(uint(shadowed));
        if (reaches && (!shadowed || has_inspect))
            film_accumulate(sum, at_once);
        uint pixel = ray.pixel;
        if (explains && lit) {
            pixel = note_sample(light, first + l, arriving, m, s, lit_by, -ray.direction, origin,
                                value, reaches);
            if (reaches && !shadowed)
                note_arrival(pixel, vec3(1.0), value);
        }
        send_light(gpu_shadow_ray(origin, pixel, value, first + l), no_way,
                   reaches && shadowed && !has_inspect);
        l++;
        if (l >= count)
            break;
    }
}

void main()
{
    load_uniforms();
    uint index = queue_index();
    bool wanted = index < counters[LR_COUNTER_HITS];
    gpu_hit hit = load_hit(wanted ? index : 0u);
    gpu_ray ray = load_ray(hit.ray);
    float chance = 0.0; // ray trees have no mixes
    shading at = shading_at(hit, ray, chance);
    surface s = at.at;
    uvec3 ids = at.ids;
    gpu_material m = at.material;
    vec3 color = at.color, n = at.n, lit_by = at.lit_by;

    vec3 fog;
    vec3 weight = weight_after(ray, hit.t, fog);
    bool first_lights = wanted && hidden(work.first_lights) != 0u;
    bool lit = wanted && (m.flags & LR_GPU_LIT) != 0u;
    if (explains && wanted) {
        noted_ray = notes.of_hit[index];
        if (first_lights) {
            note_air(weight, fog, medium_of(ray));
            note_surface(s.object, s.position, s.normal, lit_by, ray.direction, color, lit);
        }
    }
    if (has_inspect)
        noted_ray = floatBitsToUint(inspected_distance(ray, hit.t));
    children next;
    if (has_scatter) {
        next = scatter(ray, weight, s, n, lit_by, ids, m, at.absent, first_lights);
        lit = lit && !next.hidden;
    }
    film_sum sum = film_zero();
    if (has_fog && first_lights && !has_inspect)
        film_accumulate(sum, fog);
    vec3 emission = emission_of(m, ray.direction, s.normal);
    vec3 own = weight * (m.ambient * color + emission);
    if (has_inspect) {
        boundary sides = boundary_at(ray, s, ids, m.ior, at.absent);
        if (first_lights)
            film_accumulate(sum, inspected_hit(ray, hit.t, at, sides));
        lit = lit && counts_rays();
    } else if (lit && first_lights) {
        film_accumulate(sum, own);
        if (explains)
            note_own_light(weight * (m.ambient * color), weight * emission, own);
    }
    shadow_counts counts = shadow_counts(0u, 0u);
    uint count = hidden(work.light_count);
    lit = lit && count != 0u;
    for (uint l = 0u;;) {
        uint some = max(min(count - l, 4u), 1u);
        if (has_trees)
            send_lights(work.light + l, some, weight, color, m, s, n, lit_by, ray, lit, sum);
        else
            add_lights(work.light + l, some, weight, color, m, s, n, lit_by, -ray.direction, lit, sum,
                       counts);
        l += 4u;
        if (l >= count)
            break;
    }
    film_add_batch(ray.pixel, sum);
    add_count(LR_COUNTER_SHADED, uint(wanted));
    add_count(LR_COUNTER_SHADOW, counts.traced);
    add_count(LR_COUNTER_SHADOW_HITS, counts.hits);
    if (has_scatter)
        count_children(next);
    write_counts();
    if (has_scatter)
        emit_children(next, ray.pixel, s, n);
}
