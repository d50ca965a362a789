/* Elementary functions in float for loops over pixels: no branches, so that compilers vectorise
 * them, and no libm, so that they are the same on every machine. */
#ifndef LR_COMPARE_APPROX_H
#define LR_COMPARE_APPROX_H

#include <stdint.h>
#include <string.h>

static inline int32_t approx_bits(float x)
{
    int32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static inline float approx_float(int32_t bits)
{
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static inline float approx_min(float a, float b)
{
    return a < b ? a : b;
}

static inline float approx_max(float a, float b)
{
    return a > b ? a : b;
}

/* The cube root of a normal x > 0, relative error below 3e-7: a third of the exponent, then two of
 * Halley's steps. */
static inline float approx_cube_root(float x)
{
    float y = approx_float(approx_bits(x) / 3 + 0x2a5137a0);
    for (int i = 0; i < 2; i++) {
        float cube = y * y * y;
        y *= (cube + 2 * x) / (2 * cube + x);
    }
    return y;
}

/* log2 of a normal x > 0, absolute error below 1e-6 near 1 and 1e-7 of the value elsewhere:
 * x = m 2^e with m in sqrt(1/2)..sqrt(2), ln m = 2 artanh((m - 1) / (m + 1)). */
static inline float approx_log2(float x)
{
    int32_t bits = approx_bits(x);
    int32_t e = (bits - 0x3f3504f3) >> 23;
    float m = approx_float(bits - e * (1 << 23));
    float s = (m - 1) / (m + 1), z = s * s;
    float sum = 0.11111111f;
    sum = sum * z + 0.14285714f;
    sum = sum * z + 0.2f;
    sum = sum * z + 0.33333333f;
    sum = sum * z + 1;
    return (float)e + 2.8853901f * s * sum;
}

/* 2^x for -126 <= x <= 127, relative error below 3e-7; clamped outside. */
static inline float approx_exp2(float x)
{
    x = approx_min(approx_max(x, -126), 127);
    float whole = (x + 12582912.0f) - 12582912.0f; /* rounds to an integer */
    float t = (x - whole) * 0.69314718f;
    float sum = 1.0f / 720;
    sum = sum * t + 1.0f / 120;
    sum = sum * t + 1.0f / 24;
    sum = sum * t + 1.0f / 6;
    sum = sum * t + 0.5f;
    sum = sum * t + 1;
    sum = sum * t + 1;
    return approx_float(((int32_t)whole + 127) * (1 << 23)) * sum;
}

/* x^p for x >= 0 and p > 0; 0 for x below 1e-37. */
static inline float approx_power(float x, float p)
{
    float power = approx_exp2(p * approx_log2(approx_max(x, 1e-37f)));
    return x > 1e-37f ? power : 0;
}

#endif
