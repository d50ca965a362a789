// What the kernels of trees found for the rays of a pass.
#ifndef FOUND_GLSL
#define FOUND_GLSL

#include "bindings.glsl"
#include "trace.glsl"

nearest_hit load_found(uint i)
{
    uvec4 a;
    if (texel_queues)
        a = texelFetch(found_texels, int(i));
    else
        a = found_rows[i];
    return nearest_hit(uintBitsToFloat(a.y), a.z, a.w);
}

#endif
