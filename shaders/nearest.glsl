// What each ray of a queue meets first, in scenes with trees.
#include "gpu_layout.h"
#include "bindings.glsl"
#include "queue.glsl"
#include "visit.glsl"

layout(local_size_x = LR_GROUP_SIZE) in;

uint found_primitive[RAYS], found_object[RAYS], found_order[RAYS];

// Keeps a hit if it is in front and nearer; on equal distance the smaller object wins, and in it the
// smaller triangle, so that the order of the trees cannot matter.
void keep(uint k, bool valid, float t, uint primitive, uint object, uint order)
{
    bool before = object < found_object[k] || (object == found_object[k] && order < found_order[k]);
    if (valid && t > 0.0 && (t < ray_limit[k] || (t == ray_limit[k] && before))) {
        ray_limit[k] = t;
        found_primitive[k] = primitive;
        found_object[k] = object;
        found_order[k] = order;
    }
}

void keep_crossing(uint k, bool valid, vec2 crossing, uint primitive, uint object)
{
    keep(k, valid, crossing.x > 0.0 ? crossing.x : crossing.y, primitive, object, 0u);
}

void test_sphere(uint i, bool valid)
{
    gpu_sphere s = joint_sphere(i);
    EACH_RAY keep_crossing(k, valid, intersect_sphere(ray_o[k], ray_d[k], ray_inv_a[k], s), i,
                           s.object);
}

void test_flat(uint i, bool valid)
{
    gpu_flat f = joint_flat(i);
    EACH_RAY keep_crossing(k, valid, intersect_flat(ray_o[k], ray_d[k], f), i, f.object);
}

void test_solid(uint i, bool valid)
{
    gpu_solid s = joint_solid(i);
    EACH_RAY keep_crossing(k, valid, intersect_solid(ray_o[k], ray_d[k], s, i), i, s.object);
}

void test_plane(uint i, bool valid)
{
    gpu_plane p = load_plane(i);
    EACH_RAY keep_crossing(k, valid, intersect_plane(ray_o[k], ray_d[k], p.normal, p.offset), i,
                           p.object);
}

void test_triangle(uint i, bool valid, gpu_instance place)
{
    gpu_triangle f = joint_triangle(i);
    EACH_RAY
    {
        triangle_hit hit = meet_triangle(k, f);
        bool sided = has_one_sided && ((f.flags | place.flags) & LR_FLAG_ONE_SIDED) != 0u;
        bool there = valid && !(sided && !hit.front);
        keep(k, there, hit.t, i, f.object + place.object, f.order);
    }
}

void main()
{
    load_uniforms();
    EACH_RAY
    {
        uint index = packet_index(k);
        gpu_ray ray = load_ray(work.first + min(index, max(work.count, 1u) - 1u));
        ray_o[k] = ray.origin;
        ray_d[k] = ray.direction;
        ray_inv_a[k] = ex_rcp(ex_dot(ray.direction, ray.direction));
        ray_limit[k] = index < work.count ? LR_T_MAX : -1.0;
        found_primitive[k] = LR_PRIMITIVE_NONE;
        found_object[k] = 0xFFFFFFFFu;
        found_order[k] = 0u;
        if (has_world_tree)
            slab_ready(k, frame.reach);
    }
    visit_scene();
    uint done = 0u;
    EACH_RAY done += uint(packet_index(k) < work.count);
    if (joint) {
        add_count(LR_COUNTER_FOUND, done);
        write_counts();
    } else if (done != 0u) {
        atomicAdd(counters[LR_COUNTER_FOUND], done);
    }
    if (!finished)
        atomicAdd(counters[LR_COUNTER_UNFINISHED], 1u);
    // Last, because on a CPU an atomic waits for all stores before it.
    EACH_RAY
    {
        uint index = packet_index(k);
        if (index < work.count)
            found_rows[index] = uvec4(index, floatBitsToUint(ray_limit[k]), found_primitive[k],
                                 found_object[k]);
    }
}
