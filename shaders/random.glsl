// Random numbers as integer hashes keyed by what they are for, never drawn from a stream, so that
// no order of work can change them.
#ifndef RANDOM_GLSL
#define RANDOM_GLSL

// PCG's output permutation as a hash (Jarzynski and Olano, "Hash Functions for GPU Rendering",
// JCGT 9-3, 2020).
uint hash(uint value)
{
    uint state = value * 747796405u + 2891336453u;
    uint shift = (state >> 28) + 4u;
    uint word = ((state >> (shift & 31u)) ^ state) * 277803737u;
    return (word >> 22) ^ word;
}

uint hash_pixel(uvec2 pixel, uint seed, uint dimension)
{
    return hash(pixel.x + hash(pixel.y + hash(seed + hash(dimension))));
}

// The 24 high bits as a float in [0, 1).
float unit_float(uint bits)
{
    return float(bits >> 8) * 5.9604644775390625e-8;
}

#endif
