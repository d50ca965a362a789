// What lies on both sides of a surface that a ray meets.
#ifndef BOUNDARY_GLSL
#define BOUNDARY_GLSL

#include "exact.glsl"
#include "media.glsl"
#include "queue.glsl"
#include "scene_data.glsl"
#include "surface.glsl"

struct boundary {
    uvec4 beyond; // the media behind the surface
    bool solid;   // it bounds a medium
    bool hidden;  // the medium is the same on both sides: as if it were not there
    bool placed;  // there was room for the medium behind it
    float ior1, ior2; // on the ray's side, on the other; of a thin sheet its material's
    float gamma;      // ior1 / ior2; 1 for a thin sheet, which bends nothing
};

boundary boundary_at(gpu_ray ray, surface s, uvec3 ids, float ior, bool absent)
{
    uvec4 media = ray_media(ray);
    boundary b = boundary(media, false, absent, true, 1.0, ior, 1.0);
    if (has_media) {
        bool entering = ex_dot(ray.direction, s.normal) < 0.0;
        b.solid = (ids.y & LR_FLAG_SOLID) != 0u && (ids.y & LR_FLAG_TRANSPARENT) != 0u && !absent;
        uint before = media_top(media);
        if (b.solid && entering && !media_contains(media, ids.z))
            b.beyond = media_with(media, ids.z, b.placed);
        if (b.solid && !entering)
            b.beyond = media_without(media, ids.z);
        uint after = media_top(b.beyond);
        b.hidden = absent || (b.solid && before == after);
        b.ior1 = load_medium(before).ior;
        if (b.solid) {
            b.ior2 = load_medium(after).ior;
            b.gamma = ex_div(b.ior1, b.ior2);
        }
    }
    return b;
}

// The same where a mix that fills a solid shows a part that lets no light through.
boundary sides_of_part(boundary b, gpu_material part)
{
    if (has_media) {
        bool opaque = all(equal(part.transmit, vec3(0.0)));
        b.solid = b.solid && !opaque;
        b.ior2 = mix(b.ior2, part.ior, opaque);
        b.gamma = mix(b.gamma, 1.0, opaque);
    }
    return b;
}

#endif
