// Colours by position. Pictures: texture.glsl.
#ifndef PATTERN_GLSL
#define PATTERN_GLSL

#include "exact.glsl"
#include "scene_data.glsl"

// The number of the cell that coordinate c (in cells) lies in. A surface that coincides with a
// cell's boundary would speckle, so a coordinate within LR_CHECKER_SNAP of a boundary belongs to
// the cell on the side that the surface's normal (component n) points away from.
int cell_index(float c, float n)
{
    float snap = n > 1.0e-6 ? -LR_CHECKER_SNAP : (n < -1.0e-6 ? LR_CHECKER_SNAP : 0.0);
    return int(clamp(floor(c + snap), -1.0e9, 1.0e9));
}

vec3 pattern_color(gpu_material m, uint object, vec3 position, vec3 normal)
{
    vec3 p = position, n = normal;
    uint kind = m.pattern & LR_GPU_PATTERN_KIND;
    if ((m.pattern & LR_GPU_OBJECT_SPACE) != 0u) {
        vec4 row0, row1, row2;
        load_object_space(object, row0, row1, row2);
        p = vec3(ex_dot(row0.xyz, position) + row0.w, ex_dot(row1.xyz, position) + row1.w,
                 ex_dot(row2.xyz, position) + row2.w);
        n = vec3(ex_dot(row0.xyz, normal), ex_dot(row1.xyz, normal), ex_dot(row2.xyz, normal));
    }
    vec3 from_origin = p - m.pattern_origin;
    float along = ex_dot(from_origin, m.pattern_direction);
    vec3 across = from_origin - m.pattern_direction * along;

    vec3 c = p * m.inv_size;
    int checker = cell_index(c.x, n.x) + cell_index(c.y, n.y) + cell_index(c.z, n.z);
    int stripe = cell_index(along * m.inv_size, ex_dot(n, m.pattern_direction));
    int ring = cell_index(ex_length(across) * m.inv_size, 0.0);
    int cell = kind == LR_GPU_PATTERN_CHECKER ? checker
                                              : (kind == LR_GPU_PATTERN_STRIPES ? stripe : ring);
    float share = float(cell & 1);
    share = kind == LR_GPU_PATTERN_GRADIENT ? clamp(along * m.inv_length2, 0.0, 1.0) : share;
    share = kind == LR_GPU_PATTERN_NONE || kind == LR_GPU_PATTERN_IMAGE ? 0.0 : share;
    return ex_mix(m.color0, m.color1, share);
}

#endif
