// The meshes of the scene: each stands in a tree of its own, and each place where it is shown maps rays
// into its space. Distances along a ray are the same in both.
#ifndef INSTANCE_GLSL
#define INSTANCE_GLSL

#include "tree.glsl"
#include "triangle.glsl"

gpu_instance joint_instance(uint i)
{
    uint at = frame.instances.base + 4u * i;
    uvec4 held = hold_rows(at, 4u);
    return instance_of(held_row(held, at, 0u), held_row(held, at, 1u), held_row(held, at, 2u),
                       held_row(held, at, 3u));
}

vec3 world_o[RAYS], world_d[RAYS];
sheared_ray mesh_ray[RAYS];

void keep_world(uint k)
{
    world_o[k] = ray_o[k];
    world_d[k] = ray_d[k];
}

// With half the slack of boxes, so that all boxes around the triangle's own are met where that is.
triangle_hit meet_triangle(uint k, gpu_triangle f)
{
    triangle_hit hit = intersect_triangle(ray_o[k], mesh_ray[k], f);
    hit.t = t_in_box(hit.t, ray_o[k], slab_inverse[k], slab_slack[k], f);
    return hit;
}

// Ray k in the space of an instance.
void enter_instance(uint k, gpu_instance place)
{
    ray_o[k] = instance_point(place, world_o[k]);
    ray_d[k] = instance_vector(place, world_d[k]);
    mesh_ray[k] = shear_ray(ray_d[k]);
    slab_ready(k, place.reach);
}

// Back in the world.
void leave_instance(uint k)
{
    ray_o[k] = world_o[k];
    ray_d[k] = world_d[k];
    if (has_instance_tree)
        slab_ready(k, frame.reach);
}

#endif
