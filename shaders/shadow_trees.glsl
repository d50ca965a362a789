// Which shadow rays reach their points, in scenes with trees; the light of those goes into the film.
#include "gpu_layout.h"
#include "bindings.glsl"
#include "film.glsl"
#include "hole.glsl"
#include "light.glsl"
#include "notes.glsl"
#include "obstacle.glsl"
#include "shadow_queue.glsl"
#include "visit.glsl"

layout(local_size_x = LR_GROUP_SIZE) in;

uint met = 0u, dark = 0u;  // bit k: ray k met something, and none of its light is left
uvec3 ray_depth[RAYS];     // optical depths so far, in scenes with transparent shadow casters
uint through = 0xFFFFFFFFu; // bit k: ray k goes through transparent objects
uint noted[RAYS];          // the notes of the lights, in kernels that explain

// What stands in the way: whether its material lets light through, and then its record for shadows.
struct obstacle {
    bool there, transparent;
    uint object;
    uvec4 shadow;
};

obstacle joint_obstacle(bool valid, uint object, uint flags)
{
    uvec4 shadow = uvec4(0u);
    if (has_transparent) {
        uint at = frame.objects + 5u * object + 4u;
        shadow = held_row(hold_rows(at, 1u), at, 0u);
    }
    return obstacle(valid && (flags & LR_FLAG_SHADOW) != 0u, (flags & LR_FLAG_TRANSPARENT) != 0u,
                    object, shadow);
}

// What it takes from ray k.
void dim(uint k, obstacle by, vec2 crossing)
{
    float t_max = ray_limit[k];
    bool meets = by.there && crosses(crossing, t_max), blocked = meets;
    uvec3 takes = uvec3(LR_SHADOW_OPAQUE);
    if (has_transparent) {
        bool passes = by.transparent && ((through >> (k & 31u)) & 1u) != 0u;
        if (passes)
            takes = tint(crossing, t_max, by.shadow);
        bool within = has_scattering && passes && by.there;
        uvec3 depth = min(ray_depth[k] + (meets || within ? takes : uvec3(0u)), uvec3(LR_SHADOW_OPAQUE));
        ray_depth[k] = depth;
        blocked = depth == uvec3(LR_SHADOW_OPAQUE);
    }
    met |= meets ? 1u << (k & 31u) : 0u;
    dark |= blocked ? 1u << (k & 31u) : 0u;
    if (explains) {
        if (meets)
            note_obstacle(noted[k], by.object, crossing, takes);
        blocked = false; // all of them are noted
    }
    ray_limit[k] = blocked ? -1.0 : t_max;
}

void test_sphere(uint i, bool valid)
{
    gpu_sphere s = joint_sphere(i);
    obstacle by = joint_obstacle(valid, s.object, s.flags);
    EACH_RAY
    {
        vec2 crossing = intersect_sphere(ray_o[k], ray_d[k], ray_inv_a[k], s);
        if (has_cutouts)
            crossing = projected_crossings(crossing, s.object, ray_o[k], ray_d[k]);
        dim(k, by, crossing);
    }
}

void test_flat(uint i, bool valid)
{
    gpu_flat f = joint_flat(i);
    obstacle by = joint_obstacle(valid, f.object, f.flags);
    EACH_RAY
    {
        vec2 crossing = intersect_flat(ray_o[k], ray_d[k], f);
        if (has_cutouts)
            crossing = flat_crossing(crossing, f, ray_o[k], ray_d[k]);
        dim(k, by, crossing);
    }
}

void test_solid(uint i, bool valid)
{
    gpu_solid s = joint_solid(i);
    obstacle by = joint_obstacle(valid, s.object, s.flags);
    bool box = has_boxes && is_in(frame.boxes, i);
    EACH_RAY
    {
        vec2 crossing = intersect_solid(ray_o[k], ray_d[k], s, i);
        if (has_cutouts)
            crossing = solid_crossings(crossing, s, box, ray_o[k], ray_d[k]);
        dim(k, by, crossing);
    }
}

void test_plane(uint i, bool valid)
{
    gpu_plane p = load_plane(i);
    obstacle by = joint_obstacle(valid, p.object, p.flags);
    EACH_RAY
    {
        vec2 crossing = intersect_plane(ray_o[k], ray_d[k], p.normal, p.offset);
        if (has_cutouts)
            crossing = projected_crossings(crossing, p.object, ray_o[k], ray_d[k]);
        dim(k, by, crossing);
    }
}

void test_triangle(uint i, bool valid, gpu_instance place)
{
    gpu_triangle f = joint_triangle(i);
    obstacle by = joint_obstacle(valid, f.object + place.object, f.flags | place.flags);
    uint material = 0u;
    if (has_cutouts)
        material = load_object_ids(f.object + place.object).x;
    EACH_RAY
    {
        triangle_hit met = meet_triangle(k, f);
        bool hole = false;
        if (has_cutouts)
            hole = cut_out(material, mesh_uv(i, f.flags, met.weight));
        dim(k, by, vec2(mix(met.t, -1.0, hole), -1.0));
    }
}

// ray_depth[i], by selects: an index that is known only at run time would keep the whole array in
// memory.
uvec3 depth_of(uint i)
{
    uvec3 depth = uvec3(0u);
    EACH_RAY depth = mix(depth, ray_depth[k], bvec3(k == i));
    return depth;
}

// Number of shadow ray k in the queue.
uint shadow_index(uint k)
{
    uint first = work.light * work.shadow_room;
    uint i = min(packet_index(k), max(work.count, 1u) - 1u);
    if (!explains) // which has its notes there
        if (hidden(work.sorted) != 0u)
            i = shadow_order[first + i];
    return first + i;
}

void main()
{
    load_uniforms();
    EACH_RAY
    {
        gpu_shadow_ray job = load_shadow_ray(shadow_index(k));
        vec4 ray;
        if (has_paths) {
            gpu_shadow_way way = load_shadow_way(shadow_index(k));
            ray = vec4(way.direction, way.t_max);
            if (has_transparent)
                through &= (job.light & LR_SHADOW_THROUGH) != 0u ? ~0u : ~(1u << (k & 31u));
        } else {
            ray = shadow_ray(load_light(job.light), job.origin);
        }
        ray_o[k] = job.origin;
        ray_d[k] = ray.xyz;
        ray_limit[k] = packet_index(k) < work.count ? ray.w : -1.0;
        ray_inv_a[k] = ex_rcp(ex_dot(ray.xyz, ray.xyz));
        ray_depth[k] = uvec3(0u);
        if (explains)
            noted[k] = job.pixel;
        if (has_world_tree)
            slab_ready(k, frame.reach);
    }
    visit_scene();
    uint done = 0u, blocked = 0u;
    for (uint k = 0u;;) {
        bool wanted = packet_index(k) < work.count;
        gpu_shadow_ray job = load_shadow_ray(shadow_index(k));
        vec3 value = job.value;
        if (has_transparent)
            value = value * light_left(depth_of(k));
        bool lit = wanted && ((dark >> (k & 31u)) & 1u) == 0u;
        film_sum sum = film_zero();
        film_accumulate(sum, value);
        uint pixel = job.pixel;
        if (explains) {
            vec3 left = vec3(lit ? 1.0 : 0.0);
            if (has_transparent)
                left = light_left(depth_of(k));
            if (wanted)
                note_arrival(job.pixel, left, job.value * left);
            pixel = 0u;
        }
        if (lit)
            film_add(pixel, sum);
        done += uint(wanted);
        blocked += uint(wanted) & (met >> (k & 31u)) & 1u;
        k++;
        if (k >= uint(RAYS))
            break;
    }
    if (joint) {
        add_count(LR_COUNTER_SHADOW, done);
        add_count(LR_COUNTER_SHADOW_HITS, blocked);
        write_counts();
    } else {
        atomicAdd(counters[LR_COUNTER_SHADOW], done);
        atomicAdd(counters[LR_COUNTER_SHADOW_HITS], blocked);
    }
    if (!finished)
        atomicAdd(counters[LR_COUNTER_UNFINISHED], 1u);
}
