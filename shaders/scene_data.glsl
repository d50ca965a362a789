// Loads of the scene's records. scene_row is the one place that chooses between texel and storage
// buffer: lavapipe's texel fetch is twice as fast as its storage load, and other devices differ.
// The texel format is an integer one because a float fetch may flush subnormals, and so damage
// packed integers.
#ifndef SCENE_DATA_GLSL
#define SCENE_DATA_GLSL

#include "bindings.glsl"
#include "held.glsl"

uvec4 scene_row(uint row)
{
    uvec4 value;
    if (texel_loads)
        value = texelFetch(scene_texels, int(row));
    else
        value = scene_rows[row];
    return value;
}

vec4 scene_row_float(uint row)
{
    return uintBitsToFloat(scene_row(row));
}

// The primitive number i; gpu_list tells how the numbers are given. Packets load the same rows in their
// own way (packet.glsl).
gpu_sphere sphere_of(uvec4 a, uvec4 b)
{
    return gpu_sphere(uintBitsToFloat(a.xyz), uintBitsToFloat(a.w), uintBitsToFloat(b.x), b.y, b.z,
                      b.w);
}

gpu_sphere load_sphere(uint i)
{
    gpu_sphere record;
    if (has_few) {
        record = held_spheres[0];
#define CHOOSE_SPHERE(k)                                                                            \
    if (i == frame.spheres.begin + k)                                                                \
        record = held_spheres[k];
        EACH_HELD_SPHERE(CHOOSE_SPHERE)
    } else {
        uint at = frame.spheres.base + 2u * i;
        record = sphere_of(scene_row(at), scene_row(at + 1u));
    }
    return record;
}

gpu_plane plane_of(uvec4 a, uvec4 b)
{
    return gpu_plane(uintBitsToFloat(a.xyz), uintBitsToFloat(a.w), b.x, b.y, b.z, b.w);
}

gpu_plane load_plane(uint i)
{
    gpu_plane record;
    if (has_few) {
        record = held_planes[0];
#define CHOOSE_PLANE(k)                                                                            \
    if (i == frame.planes.begin + k)                                                                \
        record = held_planes[k];
        EACH_HELD_PLANE(CHOOSE_PLANE)
    } else {
        uint at = frame.planes.base + 2u * i;
        record = plane_of(scene_row(at), scene_row(at + 1u));
    }
    return record;
}

gpu_flat flat_of(uvec4 a, uvec4 b, uvec4 c, uvec4 d)
{
    return gpu_flat(uintBitsToFloat(a.xyz), uintBitsToFloat(a.w), uintBitsToFloat(b.xyz),
                    uintBitsToFloat(b.w), uintBitsToFloat(c.xyz), uintBitsToFloat(c.w), d.x, d.y,
                    d.z, d.w);
}

gpu_flat load_flat(uint i)
{
    gpu_flat record;
    if (has_few) {
        record = held_flats[0];
#define CHOOSE_FLAT(k)                                                                            \
    if (i == frame.flats.begin + k)                                                                \
        record = held_flats[k];
        EACH_HELD_FLAT(CHOOSE_FLAT)
    } else {
        uint at = frame.flats.base + 4u * i;
        record = flat_of(scene_row(at), scene_row(at + 1u), scene_row(at + 2u), scene_row(at + 3u));
    }
    return record;
}

gpu_solid solid_of(uvec4 a, uvec4 b, uvec4 c, uvec4 d, uvec4 e)
{
    return gpu_solid(uintBitsToFloat(a), uintBitsToFloat(b), uintBitsToFloat(c),
                     uintBitsToFloat(d.x), uintBitsToFloat(d.y), d.z, d.w, uintBitsToFloat(e.x),
                     uintBitsToFloat(e.y), e.z, e.w);
}

gpu_solid load_solid(uint i)
{
    gpu_solid record;
    if (has_few) {
        record = held_solids[0];
#define CHOOSE_SOLID(k)                                                                            \
    if (i == frame.solids.begin + k)                                                                \
        record = held_solids[k];
        EACH_HELD_SOLID(CHOOSE_SOLID)
    } else {
        uint at = frame.solids.base + 5u * i;
        uvec4 e = uvec4(0u);
        if (has_cones)
            e = scene_row(at + 4u);
        record = solid_of(scene_row(at), scene_row(at + 1u), scene_row(at + 2u), scene_row(at + 3u), e);
    }
    return record;
}

// World to object space, in rows.
void load_object_space(uint index, out vec4 row0, out vec4 row1, out vec4 row2)
{
    uint at = frame.objects + 5u * index;
    row0 = scene_row_float(at);
    row1 = scene_row_float(at + 1u);
    row2 = scene_row_float(at + 2u);
}

// Material, flags and rank of an object.
uvec3 load_object_ids(uint index)
{
    return scene_row(frame.objects + 5u * index + 3u).xyz;
}

// What an object takes from light in shadows, and its rank as a medium there.
uvec4 load_object_shadow(uint index)
{
    return scene_row(frame.objects + 5u * index + 4u);
}

gpu_medium load_medium(uint rank)
{
    uint at = frame.media + 2u * rank;
    vec4 a = scene_row_float(at), b = scene_row_float(at + 1u);
    return gpu_medium(a.xyz, a.w, b.xyz, b.w);
}

gpu_material load_material(uint index)
{
    uint at = frame.materials + LR_MATERIAL_ROWS * index;
    vec4 r0 = scene_row_float(at), r1 = scene_row_float(at + 1u), r2 = scene_row_float(at + 2u);
    vec4 r3 = scene_row_float(at + 3u), r4 = scene_row_float(at + 4u);
    vec4 r5 = scene_row_float(at + 5u);
    vec4 r6 = scene_row_float(at + 6u), r7 = scene_row_float(at + 7u), r8 = scene_row_float(at + 8u);
    return gpu_material(r0.xyz, floatBitsToUint(r0.w), r1.xyz, r1.w, r2.xyz, r2.w, r3.xyz,
                        floatBitsToUint(r3.w), r4.xyz, r4.w, r5.xyz, r5.w, r6.xyz,
                        r6.w, r7.xyz, r7.w, r8.xyz, r8.w);
}

gpu_maps load_maps(uint material)
{
    uint at = frame.maps + LR_MAP_ROWS * material;
    uvec4 a = scene_row(at), b = scene_row(at + 1u);
    return gpu_maps(a.x, uintBitsToFloat(a.y), a.z, uintBitsToFloat(a.w), b.x, b.y, b.z, b.w);
}

gpu_texture load_texture(uint row)
{
    uvec4 a = scene_row(row);
    return gpu_texture(a.x, a.y, a.z, a.w);
}

gpu_light load_light(uint index)
{
    uint at = frame.lights + 4u * index;
    vec4 a = scene_row_float(at), b = scene_row_float(at + 1u), c = scene_row_float(at + 2u);
    uvec4 d = scene_row(at + 3u);
    return gpu_light(a.xyz, a.w, b.xyz, floatBitsToUint(b.w), c.xyz, c.w, uintBitsToFloat(d.x),
                     uintBitsToFloat(d.y), uintBitsToFloat(d.z), d.w);
}

#endif
