// The random numbers of paths: Owen-scrambled Sobol points, two dimensions at a time, each pair shuffled
// and scrambled on its own (Burley, "Practical Hash-based Owen Scrambling", JCGT 9-4, 2020). A number
// depends on the pixel, the seed, the sample and the pair alone.
#ifndef SAMPLER_GLSL
#define SAMPLER_GLSL

#include "random.glsl"

// What tells a path from all others.
struct path_key {
    uint pixel; // a hash of its place in the picture and the seed
    uint order; // the sample's number, its bits reversed
};

// Pairs of dimensions. The camera's come first, then those of the first bounce, the second, ...
const uint pair_pixel = 0u;
const uint pair_lens = 1u;
const uint pair_time = 2u;
const uint pair_bounces = 4u;
const uint pairs_a_bounce = 4u;
const uint pair_flights = 4096u; // those of the ways between surfaces, in media that scatter light
const uint pair_light_point = 0u; // within a bounce
const uint pair_choices = 1u;     // which light; which lobe
const uint pair_direction = 2u;
const uint pair_roulette = 3u;    // whether the path goes on; which of a material's parts

path_key key_of(uvec2 pixel, uint seed, uint index)
{
    return path_key(hash(pixel.x + hash(pixel.y + hash(seed + 0x68E31DA4u))), bitfieldReverse(index));
}

// Owen's scramble of a number whose bits are reversed: each bit is flipped or not depending on those
// below it (after Laine and Karras, "Stratified Sampling for Stochastic Transparency", EGSR 2011; the
// constants are Vegdahl's, 2021).
uint scrambled(uint x, uint seed)
{
    x ^= x * 0x3D20ADEAu;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526C56u;
    return x ^ (x * 0x53A22864u);
}

// Sobol's second dimension, bits reversed: its matrix is Pascal's triangle modulo 2, so i as a
// polynomial becomes i(1 + z).
uint second_dimension(uint i)
{
    i ^= i >> 16;
    i ^= (i & 0xFF00FF00u) >> 8;
    i ^= (i & 0xF0F0F0F0u) >> 4;
    i ^= (i & 0xCCCCCCCCu) >> 2;
    return i ^ ((i & 0xAAAAAAAAu) >> 1);
}

// In [0, 1)^2.
vec2 sample_pair(path_key key, uint pair)
{
    uint seed = hash(key.pixel + pair * 0x9E3779B9u);
    uint seed_x = seed * 0x2C1B3C6Du + 0x297A2D39u, seed_y = hash(seed);
    uint index = bitfieldReverse(scrambled(key.order, seed));
    uint x = bitfieldReverse(scrambled(index, seed_x));
    uint y = bitfieldReverse(scrambled(second_dimension(index), seed_y));
    return vec2(unit_float(x), unit_float(y));
}

#endif
