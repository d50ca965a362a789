// The media around a point: up to LR_MEDIA_MAX ranks, two a word, in no particular order. The host
// ranks the media by priority and then by their place in the scene, so the greatest rank present is
// the medium that fills the space, whichever way a ray came there (after Schmidt and Budge, "Simple
// Nested Dielectrics in Ray Traced Images", 2002).
#ifndef MEDIA_GLSL
#define MEDIA_GLSL

#include "gpu_layout.h"

uint media_top(uvec4 media)
{
    uvec4 high = media >> 16, low = media & 0xFFFFu;
    uvec4 both = max(high, low);
    return max(max(both.x, both.y), max(both.z, both.w));
}

bool media_contains(uvec4 media, uint rank)
{
    uvec4 wanted = uvec4(rank);
    return any(equal(media >> 16, wanted)) || any(equal(media & 0xFFFFu, wanted));
}

uint media_word_without(uint word, uint rank)
{
    uint high = word >> 16, low = word & 0xFFFFu;
    return ((high == rank ? 0u : high) << 16) | (low == rank ? 0u : low);
}

uvec4 media_without(uvec4 media, uint rank)
{
    return uvec4(media_word_without(media.x, rank), media_word_without(media.y, rank),
                 media_word_without(media.z, rank), media_word_without(media.w, rank));
}

uint media_word_with(uint word, uint rank, inout bool placed)
{
    bool low_free = (word & 0xFFFFu) == 0u, high_free = (word >> 16) == 0u;
    uint added = low_free ? rank : (high_free ? rank << 16 : 0u);
    uint result = placed ? word : word | added;
    placed = placed || low_free || high_free;
    return result;
}

// Adds a rank that is not there yet; placed is false when there is no room.
uvec4 media_with(uvec4 media, uint rank, out bool placed)
{
    placed = false;
    uvec4 result;
    result.x = media_word_with(media.x, rank, placed);
    result.y = media_word_with(media.y, rank, placed);
    result.z = media_word_with(media.z, rank, placed);
    result.w = media_word_with(media.w, rank, placed);
    return result;
}

#endif
