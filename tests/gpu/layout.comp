#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
// Writes every record as the kernels load it, field by field, as words into the film.
// test_layout.c compares them with what it uploaded, and the offsets in this module with C's.
#include "gpu_layout.h"
#include "bindings.glsl"
#include "mesh.glsl"
#include "queue.glsl"
#include "scene_data.glsl"

layout(local_size_x = 1) in;

// Only for the offsets: the kernels declare no block with these.
layout(std430, set = 0, binding = LR_BIND_COUNT) readonly buffer RecordBlock
{
    gpu_sphere some_sphere[2];
    gpu_plane some_plane[2];
    gpu_flat some_flat[2];
    gpu_solid some_solid[2];
    gpu_object some_object[2];
    gpu_medium some_medium[2];
    gpu_material some_material[2];
    gpu_maps some_maps[2];
    gpu_bsdf some_bsdf[2];
    gpu_mix some_mix[2];
    gpu_texture some_texture[2];
    gpu_light some_light[2];
    gpu_emitter some_emitter[2];
    gpu_counters some_counters[2];
    gpu_emitter_map some_emitter_map[2];
    gpu_environment some_environment[2];
    gpu_sky_row some_sky_row[2];
    gpu_choice some_choice[2];
    gpu_object_emitter some_object_emitter[2];
    gpu_ray some_ray[2];
    gpu_hit some_hit[2];
    gpu_shadow_ray some_shadow_ray[2];
    gpu_triangle some_triangle[2];
    gpu_corners some_corners[2];
    gpu_vertex some_vertex[2];
    gpu_instance some_instance[2];
    gpu_node some_node[2];
    gpu_self_test_in some_self_test_in[2];
    gpu_self_test_out some_self_test_out[2];
};

uint at = 0u;

void put(uint word)
{
    film[at] = word;
    at += 1u;
}

void put_vec3(vec3 v)
{
    put(floatBitsToUint(v.x));
    put(floatBitsToUint(v.y));
    put(floatBitsToUint(v.z));
}

void put_vec4(vec4 v)
{
    put_vec3(v.xyz);
    put(floatBitsToUint(v.w));
}

void put_list(gpu_list x)
{
    put(x.base);
    put(x.begin);
    put(x.end);
    put(x.nodes);
}

void put_sphere(gpu_sphere x)
{
    put_vec3(x.center); put(floatBitsToUint(x.inv_radius)); put(floatBitsToUint(x.radius));
    put(x.object); put(x.flags); put(x.unused);
}

void put_plane(gpu_plane x)
{
    put_vec3(x.normal); put(floatBitsToUint(x.offset)); put(x.object); put(x.flags);
    put(x.unused0); put(x.unused1);
}

void put_flat(gpu_flat x)
{
    put_vec3(x.normal); put(floatBitsToUint(x.offset)); put_vec3(x.u);
    put(floatBitsToUint(x.u_offset)); put_vec3(x.v); put(floatBitsToUint(x.v_offset));
    put(x.object); put(x.flags); put(x.unused0); put(x.unused1);
}

void put_solid(gpu_solid x)
{
    put_vec4(x.row0); put_vec4(x.row1); put_vec4(x.row2); put(floatBitsToUint(x.scale));
    put(floatBitsToUint(x.inv_scale)); put(x.object); put(x.flags);
    put(floatBitsToUint(x.radius_from)); put(floatBitsToUint(x.radius_slope)); put(x.unused0);
    put(x.unused1);
}

void put_medium(gpu_medium x)
{
    put_vec3(x.absorption); put(floatBitsToUint(x.ior)); put_vec3(x.scattering);
    put(floatBitsToUint(x.anisotropy));
}

void put_material(gpu_material x)
{
    put_vec3(x.color0); put(x.pattern); put_vec3(x.color1); put(floatBitsToUint(x.inv_size));
    put_vec3(x.pattern_origin); put(floatBitsToUint(x.inv_length2)); put_vec3(x.pattern_direction);
    put(x.flags); put_vec3(x.ambient); put(floatBitsToUint(x.shininess)); put_vec3(x.diffuse);
    put(floatBitsToUint(x.ior)); put_vec3(x.specular);
    put(floatBitsToUint(x.emission_red)); put_vec3(x.reflect);
    put(floatBitsToUint(x.emission_green)); put_vec3(x.transmit);
    put(floatBitsToUint(x.emission_blue));
}

void put_texture(gpu_texture x)
{
    put(x.texels); put(x.size); put(x.curve); put(x.flags);
}

void put_light(gpu_light x)
{
    put_vec3(x.position); put(floatBitsToUint(x.half_falloff)); put_vec3(x.color); put(x.flags);
    put_vec3(x.direction); put(floatBitsToUint(x.cos_angle)); put(floatBitsToUint(x.cos_scale));
    put(floatBitsToUint(x.radius)); put(floatBitsToUint(x.spread)); put(x.unused);
}

void put_ray(gpu_ray x)
{
    put_vec3(x.origin); put(x.pixel); put_vec3(x.direction); put(x.state); put_vec3(x.weight);
    put(x.note); put(x.media0); put(x.media1); put(x.media2); put(x.media3);
}

void put_hit(gpu_hit x)
{
    put(x.ray); put(floatBitsToUint(x.t)); put(x.primitive); put(x.object);
}

void put_object(uint index)
{
    vec4 row0, row1, row2;
    load_object_space(index, row0, row1, row2);
    put_vec4(row0);
    put_vec4(row1);
    put_vec4(row2);
    uvec3 ids = load_object_ids(index);
    uvec4 shadow = load_object_shadow(index);
    put(ids.x);
    put(ids.y);
    put(ids.z);
    put(scene_row(frame.objects + 5u * index + 3u).w);
    put(shadow.x);
    put(shadow.y);
    put(shadow.z);
    put(shadow.w);
}

void put_triangle(gpu_triangle x)
{
    put_vec3(x.a); put(x.object); put_vec3(x.b); put(x.order); put_vec3(x.c); put(x.flags);
}

void put_instance(gpu_instance x)
{
    put_vec4(x.row0); put_vec4(x.row1); put_vec4(x.row2); put(x.nodes); put(x.object);
    put(floatBitsToUint(x.reach)); put(x.flags);
}

void main()
{
    load_uniforms();
    uint i = work.first;
    put_texture(load_texture(i)); // the first rows
    put_sphere(load_sphere(i));
    put_solid(load_solid(i));
    put_plane(load_plane(i));
    put_flat(load_flat(i));
    put_object(i);
    put_material(load_material(i));
    put_medium(load_medium(i));
    put_light(load_light(i));
    put_triangle(load_triangle(i));
    put_instance(load_instance(i));
    put_ray(load_ray(i));
    put_hit(load_hit(i));
    put_vec3(frame.origin); put(floatBitsToUint(frame.half_width)); put_vec3(frame.forward);
    put(floatBitsToUint(frame.half_height)); put_vec3(frame.pixel_right);
    put(floatBitsToUint(frame.inv_samples)); put_vec3(frame.pixel_down); put(frame.samples);
    put_vec3(frame.background_low); put(frame.seed); put_vec3(frame.background_high);
    put(frame.depth); put_vec3(frame.background_up); put(floatBitsToUint(frame.min_weight));
    put_vec3(frame.fog_color); put(floatBitsToUint(frame.fog_density)); put_list(frame.spheres);
    put_list(frame.flats); put_list(frame.solids); put_list(frame.ellipsoids);
    put_list(frame.boxes); put_list(frame.cones); put_list(frame.planes); put(frame.objects); put(frame.materials);
    put(frame.media); put(frame.lights); put(frame.inside0); put(frame.inside1);
    put(frame.inside2); put(frame.inside3); put(frame.balls); put(frame.bounded);
    put(floatBitsToUint(frame.reach)); put(frame.corners); put_list(frame.instances);
    put_list(frame.triangles); put_vec3(frame.cells_from); put(frame.inspect);
    put_vec3(frame.inv_cell); put(floatBitsToUint(frame.inspect_scale));
    put(frame.choices); put(frame.object_emitters); put(frame.choice_shift);
    put(frame.environment);
    put_vec3(frame.lens.right); put(floatBitsToUint(frame.lens.inv_focus)); put_vec3(frame.lens.up);
    put(frame.lens.kind); put_vec3(frame.lens.origin_step);
    put(floatBitsToUint(frame.lens.blade_turns)); put_vec3(frame.lens.forward_step);
    put(floatBitsToUint(frame.lens.inv_blades)); put_vec3(frame.lens.right_step);
    put(floatBitsToUint(frame.lens.turns_across)); put_vec3(frame.lens.down_step);
    put(floatBitsToUint(frame.lens.turns_down));
    put(frame.bsdfs); put(frame.albedo); put(frame.glass_albedo); put(frame.maps);
    put(frame.mixes); put(frame.unused_frame0); put(frame.unused_frame1); put(frame.unused_frame2);
    put(work.tile_x); put(work.tile_y); put(work.tile_width); put(work.tile_height);
    put(work.first_sample); put(work.count); put(work.first); put(work.light);
    put(work.light_count); put(work.first_lights); put(work.shadow_room);
    for (uint k = 0u; k < 4u; k++)
        put(work.shadow_first[k]);
    put(work.sorted);
    put(work.step);
    put(work.film_first);
    put(work.film_pitch); put(work.samples); put(work.rounds); put(work.resumed);
    put(work.plane_rows); put(work.sphere_rows); put(work.flat_rows); put(work.solid_rows);
    for (uint k = 0u; k < 28u; k++)
        put(counters[k]);
}
