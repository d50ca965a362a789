// One bounce of a path (Kajiya, "The Rendering Equation", 1986): the light where its ray ends, the light
// of one source, and the next ray. Light that can be found in both ways is weighted by the power heuristic
// (Veach, 1997).
#ifndef BOUNCE_GLSL
#define BOUNCE_GLSL

#include "air.glsl"
#include "basis.glsl"
#include "bsdf_load.glsl"
#include "emitter.glsl"
#include "few.glsl"
#include "film.glsl"
#include "flight.glsl"
#include "queue.glsl"
#include "sampler.glsl"
#include "shading.glsl"
#include "shadow.glsl"
#include "shadow_queue.glsl"
#include "trace.glsl"

// Rays that were counted on the way.
struct ray_counts {
    uint traced, hits;
    uint shadow, shadow_hits;
};

// Bounces after which paths may end by chance, and how faint, 1 / roulette_margin, they must be: of what
// was tried on the Cornell box this takes the least time to a given noise (docs/performance.md).
const uint roulette_from = 3u;
const float roulette_margin = 2.0;

// The weight of what one of two ways found with density a, the other with b; 1 if only the first can.
float power_heuristic(float a, float b)
{
    float a2 = a * a, b2 = b * b;
    bool both = a > 0.0 && b > 0.0;
    // Beyond the range of squares the greater one has it all.
    float ratio = a > 1.0e9 || b > 1.0e9 ? (a > b ? 1.0 : 0.0) : a2 * ex_rcp(max(a2 + b2, 1.0e-20));
    return both ? ratio : 1.0;
}

// In scenes without trees.
nearest_hit nearest_listed(vec3 o, vec3 d)
{
    nearest_hit met;
    if (has_few)
        met = nearest_of_few(o, d);
    else
        met = trace_nearest(o, d);
    return met;
}

// The optical depth of what stands in the way of light, as in shadow_rays.
uvec3 listed_depth(vec3 o, light_sample light, bool wanted)
{
    uvec3 depth;
    if (has_few) {
        depth = uvec3(few_block(o, light.wi, light.t_max) ? LR_SHADOW_OPAQUE : 0u);
    } else {
        shadow_rays rays = shadow_rays_none();
        set_ray(rays, wanted ? 0u : no_slot, vec4(light.wi, light.t_max), 1u);
        rays.through = light.pdf == 0.0;
        trace_shadows(rays, o, 1u);
        depth = uvec3(rays.red.x, rays.green.x, rays.blue.x);
    }
    return depth;
}

// Sends the light of a source on its way to a point; what it brings, if that is known at once. Light
// that paths cannot find by themselves comes straight through transparent objects, as in ray trees.
vec3 arriving(vec3 origin, light_sample light, vec3 value, uint pixel, bool wanted,
              inout ray_counts counts)
{
    vec3 arrives = vec3(0.0);
    if (has_trees) {
        send_light(gpu_shadow_ray(origin, pixel, value, light.pdf == 0.0 ? LR_SHADOW_THROUGH : 0u),
                   gpu_shadow_way(light.wi, light.t_max), wanted);
    } else {
        uvec3 depth = listed_depth(origin, light, wanted);
        counts.shadow += uint(wanted);
        counts.shadow_hits += uint(wanted && depth != uvec3(0u));
        arrives = wanted ? value * light_left(depth) : vec3(0.0);
    }
    return arrives;
}

// What media leave of the light of a source on its way to where those are. Light that comes straight through
// solids is dimmed by these: obstacle.glsl.
vec3 left_on_the_way(uvec4 media, light_sample light)
{
    uint medium = has_media ? media_top(media) : 0u;
    vec3 left = left_of(load_medium(medium), light.t_max);
    return mix(left, vec3(1.0), bvec3(medium != 0u && light.pdf == 0.0));
}

// Takes the path of a ray that has met something on by a bounce: `ray` and `path` become those of the next
// ray. Whether there is one. All invocations must call this together; those that do not want it add nothing.
bool bounce(bool wanted, nearest_hit met, inout gpu_ray ray, inout gpu_path path, inout film_sum sum,
            inout ray_counts counts)
{
    bool last = (ray.state & LR_STATE_LAST) != 0u;
    uint depth = ray.state & LR_STATE_DEPTH, pair = pair_bounces + depth * pairs_a_bounce;
    path_key key = path_key(path.pixel, path.order);

    vec3 fog;
    vec3 weight = weight_after(ray, met.t, fog);
    if (has_fog && wanted)
        film_accumulate(sum, fog);
    flight way = no_flight;
    if (has_scattering) {
        uint segment = (ray.state >> LR_STATE_PASSES_SHIFT) + depth * uint(LR_PASSES_MAX + 1);
        way = fly(ray, met.t, sample_pair(key, pair_flights + segment), wanted && !last);
        weight = weight * way.weight;
    }
    bool hit = wanted && met.primitive != LR_PRIMITIVE_NONE && !way.scatters;
    bool beyond = wanted && !hit && !way.scatters;

    vec2 chances = sample_pair(key, pair + pair_roulette);
    gpu_hit seen = gpu_hit(0u, met.t, met.primitive, hit ? met.object : 0u);
    shading here = shading_at(seen, ray, chances.y);
    surface s = here.at;
    gpu_material m = here.material;
    boundary sides = boundary_at(ray, s, here.ids, m.ior, here.absent);
    if (has_mixes)
        sides = sides_of_part(sides, m);
    bool solid_there = hit && !sides.hidden;

    // The light that is there.
    vec3 emission = emission_of(m, ray.direction, s.normal);
    vec3 light_from = ray.origin - ray.direction * path.distance;
    float pdf = emitter_pdf(s.object, light_from, ray.direction, path.distance + met.t, s.normal);
    vec3 found = solid_there ? emission : vec3(0.0);
    if (beyond) {
        found = environment(ray.direction);
        pdf = environment_pdf(ray.direction);
    }
    if (any(greaterThan(found, vec3(0.0))))
        film_accumulate(sum, weight * found * power_heuristic(path.pdf, pdf));

    // The light of one source.
    vec2 choices = sample_pair(key, pair + pair_choices);
    basis around = basis_around(here.lit_by);
    vec3 wo = to_local(around, -ray.direction);
    bsdf b = load_bsdf(here.ids.x, m, here.color, here.gloss, sides, wo, chances.y);
    vec3 origin = s.lit_from + here.n * s.offset;
    if (has_scattering)
        origin = mix(origin, way.position, bvec3(way.scatters));
    bool scatters = (solid_there && !last) || way.scatters;
    bool deepest = depth >= frame.depth;
    light_sample light = sample_light_at(origin, choices.x, sample_pair(key, pair + pair_light_point));
    vec3 local_wi = to_local(around, light.wi);
    bsdf_value towards = evaluate_bsdf(b, wo, local_wi);
    bool in_front = ex_dot(light.wi, here.n) > 0.0;
    uvec4 lit_media = ray_media(ray);
    if (has_rough_glass) {
        // Light from behind comes through; interpolated normals must not take one side for the other.
        bool behind = !in_front && local_wi.z < 0.0;
        origin = mix(origin, s.position - here.n * s.offset, bvec3(behind));
        in_front = behind || (in_front && local_wi.z > 0.0);
        lit_media = mix(lit_media, sides.beyond, bvec4(behind && !way.scatters));
    }
    if (has_scattering && way.scatters) {
        float share = phase_at(way.anisotropy, ex_dot(ray.direction, light.wi));
        towards = bsdf_value(vec3(share), share);
        origin = way.position;
        in_front = true;
    }
    vec3 value = weight * towards.f * light.value * power_heuristic(light.pdf, towards.pdf);
    if (has_scattering)
        value = value * left_on_the_way(lit_media, light);
    bool reaches = scatters && in_front && any(greaterThanEqual(value, vec3(LR_FILM_STEP)));
    value = arriving(origin, light, value, ray.pixel, reaches, counts);
    if (!has_trees)
        film_accumulate(sum, value);

    // The next ray.
    vec2 aim = sample_pair(key, pair + pair_direction);
    bsdf_sample next = sample_bsdf(b, wo, choices.y, aim);
    vec3 wi = to_world(around, next.wi);
    if (has_scattering && way.scatters) {
        wi = sample_phase(way.anisotropy, ray.direction, aim);
        float density = phase_at(way.anisotropy, ex_dot(ray.direction, wi));
        next = bsdf_sample(wi, vec3(1.0), density, LR_BSDF_REFLECTS);
    }
    bool through = (next.kind & LR_BSDF_TRANSMITS) != 0u;
    vec3 side = through ? -here.n : here.n;
    vec3 arrived = weight;
    weight = arrived * next.weight;
    float survives = depth < roulette_from ? 1.0 : min(brightest(weight) * roulette_margin, 1.0);
    bool goes_on = scatters && next.kind != 0u && (ex_dot(wi, side) > 0.0 || way.scatters) &&
                   !(brightest(weight) < LR_WEIGHT_MIN) && !(brightest(weight) < frame.min_weight) &&
                   chances.x < survives;
    weight = survives < 1.0 ? weight * ex_rcp(max(survives, 1.0e-20)) : weight;
    uint kind = through ? LR_KIND_REFRACTED : LR_KIND_REFLECTED;
    uint state = (depth + 1u) | kind << LR_STATE_KIND_SHIFT | (deepest ? LR_STATE_LAST : 0u);
    uvec4 media = through ? sides.beyond : ray_media(ray);
    float bounce_pdf = next.pdf, distance = 0.0;
    if (hit && sides.hidden) {
        // As if nothing were there: the ray goes on as the same ray.
        uint passes = ray.state >> LR_STATE_PASSES_SHIFT;
        goes_on = passes < uint(LR_PASSES_MAX);
        state = ray.state + (1u << LR_STATE_PASSES_SHIFT);
        weight = arrived;
        media = sides.beyond;
        side = -here.n;
        wi = ray.direction;
        bounce_pdf = path.pdf;
        distance = path.distance + met.t;
    }

    counts.traced += uint(wanted);
    counts.hits += uint(hit);
    vec3 from = s.position + side * s.offset;
    if (has_scattering)
        from = mix(from, way.position, bvec3(way.scatters));
    ray = gpu_ray(from, ray.pixel, ex_normalize(wi), state, weight, ray.note,
                  media.x, media.y, media.z, media.w);
    path = gpu_path(path.pixel, path.order, bounce_pdf, distance);
    return goes_on;
}

#endif
