// What each ray of a queue meets first, in scenes with trees.
#include "gpu_layout.h"
#include "bindings.glsl"
#include "instance.glsl"
#include "queue.glsl"

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

void nearest_sphere(uint i, bool valid)
{
    gpu_sphere s = joint_sphere(i);
    EACH_RAY keep_crossing(k, valid, intersect_sphere(ray_o[k], ray_d[k], ray_inv_a[k], s), i,
                           s.object);
}

void nearest_flat(uint i, bool valid)
{
    gpu_flat f = joint_flat(i);
    EACH_RAY keep_crossing(k, valid, intersect_flat(ray_o[k], ray_d[k], f), i, f.object);
}

void nearest_solid(uint i, bool valid)
{
    gpu_solid s = joint_solid(i);
    EACH_RAY keep_crossing(k, valid, intersect_solid(ray_o[k], ray_d[k], s, i), i, s.object);
}

void nearest_plane(uint i, bool valid)
{
    gpu_plane p = load_plane(i);
    EACH_RAY keep_crossing(k, valid, intersect_plane(ray_o[k], ray_d[k], p.normal, p.offset), i,
                           p.object);
}

void nearest_triangle(uint i, bool valid, gpu_instance place)
{
    gpu_triangle f = joint_triangle(i);
    EACH_RAY
    {
        triangle_hit hit = intersect_triangle(ray_o[k], mesh_ray[k], f);
        bool there = valid && !(has_one_sided && (f.flags & LR_FLAG_ONE_SIDED) != 0u && !hit.front);
        keep(k, there, hit.t, i, f.object + place.object, f.order);
    }
}

void nearest_instance(uint i, bool valid)
{
    gpu_instance place = joint_instance(i);
    EACH_RAY enter_instance(k, place);
    if (valid)
        VISIT_TREE(place.nodes, nearest_triangle(i, valid, place))
    EACH_RAY leave_instance(k);
}

void main()
{
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
    VISIT_KIND(has_planes, false, frame.planes, nearest_plane(i, valid))
    VISIT_KIND(has_spheres, has_sphere_tree, frame.spheres, nearest_sphere(i, valid))
    VISIT_KIND(has_flats, has_flat_tree, frame.flats, nearest_flat(i, valid))
    VISIT_KIND(has_ellipsoids, has_ellipsoid_tree, frame.ellipsoids, nearest_solid(i, valid))
    VISIT_KIND(has_boxes, has_box_tree, frame.boxes, nearest_solid(i, valid))
    VISIT_KIND(has_cones, has_cone_tree, frame.cones, nearest_solid(i, valid))
    if (has_instances) {
        EACH_RAY keep_world(k);
        VISIT_KIND(true, has_instance_tree, frame.instances, nearest_instance(i, valid))
    } else if (has_meshes) {
        EACH_RAY mesh_ray[k] = shear_ray(ray_d[k]);
        VISIT_TREE(hidden(frame.triangles.nodes), nearest_triangle(i, valid, no_instance))
    }
    uint count = 0u;
    EACH_RAY count += uint(packet_index(k) < work.count);
    if (joint) {
        COUNT(counters.found, count)
    } else if (count != 0u) {
        atomicAdd(counters.found, count);
    }
    if (!finished)
        atomicAdd(counters.unfinished, 1u);
    // Last, because on a CPU an atomic waits for all stores before it.
    EACH_RAY
    {
        uint index = packet_index(k);
        if (index < work.count)
            found_rows[index] = uvec4(index, floatBitsToUint(ray_limit[k]), found_primitive[k],
                                 found_object[k]);
    }
}
