// Meshes: loads of their parts, and the way in and out of the space that a mesh is described in.
#ifndef MESH_GLSL
#define MESH_GLSL

#include "exact.glsl"
#include "scene_data.glsl"

const gpu_instance no_instance =
    gpu_instance(vec4(0.0), vec4(0.0), vec4(0.0), 0u, 0u, 0.0, 0u);

gpu_instance instance_of(uvec4 a, uvec4 b, uvec4 c, uvec4 d)
{
    return gpu_instance(uintBitsToFloat(a), uintBitsToFloat(b), uintBitsToFloat(c), d.x, d.y,
                        uintBitsToFloat(d.z), d.w);
}

gpu_instance load_instance(uint i)
{
    uint at = frame.instances.base + 4u * i;
    return instance_of(scene_row(at), scene_row(at + 1u), scene_row(at + 2u), scene_row(at + 3u));
}

gpu_triangle triangle_of(uvec4 a, uvec4 b, uvec4 c)
{
    return gpu_triangle(uintBitsToFloat(a.xyz), a.w, uintBitsToFloat(b.xyz), b.w,
                        uintBitsToFloat(c.xyz), c.w);
}

gpu_triangle load_triangle(uint i)
{
    uint at = frame.triangles.base + 3u * i;
    return triangle_of(scene_row(at), scene_row(at + 1u), scene_row(at + 2u));
}

gpu_vertex load_vertex(uint row)
{
    uvec4 a = scene_row(row);
    return gpu_vertex(a.x, uintBitsToFloat(a.y), uintBitsToFloat(a.z), a.w);
}

vec2 uv_between(gpu_vertex a, gpu_vertex b, gpu_vertex c, vec3 weight)
{
    return vec2(a.u, a.v) * weight.x + vec2(b.u, b.v) * weight.y + vec2(c.u, c.v) * weight.z;
}

// The texture coordinates of triangle i where its corners have these weights; 0 if its mesh has none.
vec2 mesh_uv(uint i, uint flags, vec3 weight)
{
    vec2 uv = vec2(0.0);
    if (has_corners && (flags & LR_FLAG_UV) != 0u) {
        uvec4 corners = scene_row(frame.corners + i - frame.triangles.begin);
        gpu_vertex a = load_vertex(corners.x), b = load_vertex(corners.y), c = load_vertex(corners.z);
        uv = uv_between(a, b, c, weight);
    }
    return uv;
}

// Where no mesh is shown several times all stand in world space, and these change nothing.
vec3 instance_point(gpu_instance s, vec3 p)
{
    vec3 q = p;
    if (has_instances)
        q = vec3(ex_dot(s.row0.xyz, p) + s.row0.w, ex_dot(s.row1.xyz, p) + s.row1.w,
                 ex_dot(s.row2.xyz, p) + s.row2.w);
    return q;
}

vec3 instance_vector(gpu_instance s, vec3 v)
{
    vec3 q = v;
    if (has_instances)
        q = vec3(ex_dot(s.row0.xyz, v), ex_dot(s.row1.xyz, v), ex_dot(s.row2.xyz, v));
    return q;
}

// A normal of the mesh in the world, not of unit length.
vec3 instance_normal(gpu_instance s, vec3 n)
{
    vec3 q = n;
    if (has_instances)
        q = s.row0.xyz * n.x + s.row1.xyz * n.y + s.row2.xyz * n.z;
    return q;
}

// A vector of the mesh in the world, by Cramer's rule.
vec3 vector_of_instance(gpu_instance s, vec3 v)
{
    vec3 q = v;
    if (has_instances) {
        vec3 x = ex_cross(s.row1.xyz, s.row2.xyz), y = ex_cross(s.row2.xyz, s.row0.xyz);
        vec3 z = ex_cross(s.row0.xyz, s.row1.xyz);
        q = (x * v.x + y * v.y + z * v.z) * ex_rcp(away_from_zero(ex_dot(s.row0.xyz, x)));
    }
    return q;
}

// The power of two that brings the greatest component of a to 1..2; none is below 0.
float ex_power_for(vec3 a)
{
    uint exponent = floatBitsToUint(max(a.x, max(a.y, a.z))) >> 23;
    return uintBitsToFloat(clamp(254u - exponent, 1u, 253u) << 23);
}

// v times the power of two that brings its greatest component to 1..2.
vec3 ex_scale_up(vec3 v)
{
    return v * ex_power_for(abs(v));
}

// A normal from its place in the octahedron's square, not of unit length (Cigolle et al., "A Survey of
// Efficient Representations for Independent Unit Vectors", JCGT 2014).
vec3 unpack_normal(uint bits)
{
    float x = float(int(bits & 0xFFFFu) - 32767) * 3.05185094e-5;
    float y = float(int(bits >> 16) - 32767) * 3.05185094e-5;
    float z = 1.0 - abs(x) - abs(y);
    float fold = max(-z, 0.0);
    return vec3(x + (x >= 0.0 ? -fold : fold), y + (y >= 0.0 ? -fold : fold), z);
}

vec3 unpack_color(uint bits)
{
    uvec3 fields = uvec3(bits, bits >> 10, bits >> 20) & 1023u;
    vec3 root = vec3(ivec3(fields)) * 9.77517106e-4;
    return root * root;
}

#endif
