// The way of a packet of rays through the whole scene. The kernel says what its rays do with each
// primitive that they may meet: number i, if `valid`.
#ifndef VISIT_GLSL
#define VISIT_GLSL

#include "instance.glsl"

void test_sphere(uint i, bool valid);
void test_flat(uint i, bool valid);
void test_solid(uint i, bool valid);
void test_plane(uint i, bool valid);
void test_triangle(uint i, bool valid, gpu_instance place);

void visit_instance(uint i, bool valid)
{
    gpu_instance place = joint_instance(i);
    EACH_RAY enter_instance(k, place);
    if (valid)
        VISIT_TREE(place.nodes, test_triangle(i, valid, place))
    EACH_RAY leave_instance(k);
}

void visit_scene()
{
    VISIT_KIND(has_planes, false, frame.planes, test_plane(i, valid))
    VISIT_KIND(has_spheres, has_sphere_tree, frame.spheres, test_sphere(i, valid))
    VISIT_KIND(has_flats, has_flat_tree, frame.flats, test_flat(i, valid))
    VISIT_KIND(has_ellipsoids, has_ellipsoid_tree, frame.ellipsoids, test_solid(i, valid))
    VISIT_KIND(has_boxes, has_box_tree, frame.boxes, test_solid(i, valid))
    VISIT_KIND(has_cones, has_cone_tree, frame.cones, test_solid(i, valid))
    if (has_instances) {
        EACH_RAY keep_world(k);
        VISIT_KIND(true, has_instance_tree, frame.instances, visit_instance(i, valid))
    } else if (has_meshes) {
        EACH_RAY mesh_ray[k] = shear_ray(ray_d[k]);
        VISIT_TREE(hidden(frame.triangles.nodes), test_triangle(i, valid, no_instance))
    }
}

#endif
