// The cells that shadow rays are sorted by, so that rays which end near each other go through the trees
// in one packet. They change speed, never the picture.
#ifndef CELL_GLSL
#define CELL_GLSL

#include "bindings.glsl"

// Every third bit of up to 10 (Morton's order).
uint spread_bits(uint x)
{
    x = (x | (x << 16)) & 0x030000FFu;
    x = (x | (x << 8)) & 0x0300F00Fu;
    x = (x | (x << 4)) & 0x030C30C3u;
    return (x | (x << 2)) & 0x09249249u;
}

// The cell of a point; the outer ones hold all that is beyond.
uint cell_of(vec3 p)
{
    const float last = float((1 << LR_CELL_BITS) - 1);
    vec3 at = clamp((p - frame.cells_from) * frame.inv_cell, vec3(0.0), vec3(last));
    uint cell = spread_bits(uint(int(at.x))) | (spread_bits(uint(int(at.y))) << 1) |
                (spread_bits(uint(int(at.z))) << 2);
    return cell & (LR_CELLS - 1u);
}

#endif
