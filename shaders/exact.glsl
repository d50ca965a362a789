// The project's own division, roots, exponential, logarithm, sine and cosine: only + - *,
// comparisons, selects and bit operations, in a fixed order, so that every device computes the same bits (docs/exact.md).
// Error bounds are for the stated domain and measured in tests/gpu/test_exact.c.
#ifndef EXACT_GLSL
#define EXACT_GLSL

// 1 / x for 2^-100 <= |x| <= 2^100, within 1.5 ulp. Newton's iteration from an integer first guess
// that is within 6 %; the difference keeps the sign. Elsewhere the result is unspecified, and not a number for 0.
float ex_rcp(float x)
{
    float y = uintBitsToFloat(0x7EF311C3u - floatBitsToUint(x));
    y = y + y * (1.0 - x * y);
    y = y + y * (1.0 - x * y);
    y = y + y * (1.0 - x * y);
    return y;
}

// A number with the sign of x, kept away from 0 so that ex_rcp of it is finite.
float away_from_zero(float x)
{
    return abs(x) < 1.0e-20 ? 1.0e-20 : x;
}

// a / b within 2.5 ulp, for b as in ex_rcp.
float ex_div(float a, float b)
{
    return a * ex_rcp(b);
}

// 1 / sqrt(x) for 2^-100 <= x <= 2^100, within 2 ulp. Newton's iteration, first guess by halving
// the exponent.
float ex_rsqrt(float x)
{
    float y = uintBitsToFloat(0x5F375A86u - (floatBitsToUint(x) >> 1));
    float h = 0.5 * x;
    y = y * (1.5 - h * (y * y));
    y = y * (1.5 - h * (y * y));
    y = y * (1.5 - h * (y * y));
    return y;
}

// sqrt(x) for 2^-100 <= x <= 2^100, within 3.5 ulp; 0 for anything below 2^-100, negative or not.
float ex_sqrt(float x)
{
    float r = x * ex_rsqrt(x);
    return x < 7.888609052210118e-31 ? 0.0 : r;
}

float ex_dot(vec3 a, vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

vec3 ex_cross(vec3 a, vec3 b)
{
    return vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

// The length of a vector whose squared length is within 2^-100 .. 2^100, within 4.5 ulp.
float ex_length(vec3 a)
{
    return ex_sqrt(ex_dot(a, a));
}

// A vector of squared length 2^-100 .. 2^100 scaled to unit length, within 3e-7.
vec3 ex_normalize(vec3 a)
{
    return a * ex_rsqrt(ex_dot(a, a));
}

// Linear interpolation, exact at both ends.
vec3 ex_mix(vec3 a, vec3 b, float t)
{
    return a * (1.0 - t) + b * t;
}

vec4 ex_mix(vec4 a, vec4 b, float t)
{
    return a * (1.0 - t) + b * t;
}

// log2(x) for normal x > 0, relative error below 4e-7, also near 1. x = m 2^e with m in
// [sqrt(1/2), sqrt(2)), s = (m - 1) / (m + 1), log2(m) = 2 / ln 2 (s + s^3/3 + s^5/5 + ...).
float ex_log2(float x)
{
    uint bits = floatBitsToUint(x);
    uint shifted = bits - 0x3F3504F3u; // exponent 0 begins at sqrt(1/2)
    int e = int(shifted) >> 23;
    float m = uintBitsToFloat((shifted & 0x007FFFFFu) + 0x3F3504F3u);
    float s = (m - 1.0) * ex_rcp(m + 1.0);
    float z = s * s;
    float p = 0.32059890 * z + 0.41219858;
    p = p * z + 0.57707802;
    p = p * z + 0.96179669;
    return float(e) + (s * 2.88539008 + (s * z) * p);
}

// 2^x for any finite x, relative error below 3e-7; 0 below 2^-100, 2^100 above.
float ex_exp2(float x)
{
    float c = clamp(x, -100.0, 100.0);
    float whole = floor(c + 0.5);
    float f = c - whole; // -0.5 .. 0.5
    float p = 1.5252734e-5 * f + 1.5403530e-4;
    p = p * f + 1.33335581e-3;
    p = p * f + 9.61812911e-3;
    p = p * f + 5.55041087e-2;
    p = p * f + 2.40226507e-1;
    p = p * f + 6.93147181e-1;
    p = p * f + 1.0;
    float r = p * uintBitsToFloat(uint(int(whole) + 127) << 23);
    return x < -100.0 ? 0.0 : r;
}

// x^y for x > 0, or 0 for x <= 2^-100; relative error below 4e-7 (1 + |y log2 x|). x^0 = 1.
float ex_pow(float x, float y)
{
    float r = ex_exp2(y * ex_log2(x));
    return y == 0.0 ? 1.0 : (x < 7.888609052210118e-31 ? 0.0 : r);
}

// The cosine and sine of `turns` turns (of 2 pi), for |turns| <= 2^20, each within 1.2e-7; whole
// quarters are exact. Polynomials on the eighth of a turn to either side of the nearest quarter: the
// distance from it is exact, and so is the choice among the four.
vec2 ex_cos_sin_turns(float turns)
{
    float quarter = floor(4.0 * turns + 0.5);
    float f = turns - 0.25 * quarter; // -1/8 .. 1/8
    float z = f * f;
    float s = 41.4728317 * z - 76.6978683;
    s = s * z + 81.6052017;
    s = s * z - 41.3417015;
    s = (s * z + 6.28318548) * f;
    float c = 26.1192188 * z - 60.2404518;
    c = c * z + 85.4567947;
    c = c * z - 64.9393921;
    c = 1.0 - (c * z + 19.7392082) * z;
    uint q = uint(int(quarter));
    vec2 turned = mix(vec2(c, s), vec2(s, c), bvec2((q & 1u) != 0u));
    return mix(turned, -turned, bvec2(((q + 1u) & 2u) != 0u, (q & 2u) != 0u));
}

// The angle of (x, y) in turns, -1/2..1/2, counter-clockwise from (1, 0), within 6e-8, if the greater
// of |x| and |y| is within 2^-100 .. 2^100; 0 at the origin.
float ex_angle_turns(float y, float x)
{
    float ax = abs(x), ay = abs(y), high = max(ax, ay), low = min(ax, ay);
    float a = low * ex_rcp(max(high, 7.888609052210118e-31)), z = a * a;
    float p = -7.257134420797229e-4 * z + 3.784787142649293e-3;
    p = p * z - 9.363045915961266e-3;
    p = p * z + 1.5706786885857582e-2;
    p = p * z - 2.2286929190158844e-2;
    p = p * z + 3.1778406351804733e-2;
    p = p * z - 5.3049229085445404e-2;
    p = p * z + 0.15915492177009583;
    float turns = a * p; // 0 .. 1/8
    turns = mix(turns, 0.25 - turns, ay > ax);
    turns = mix(turns, 0.5 - turns, x < 0.0);
    return mix(turns, -turns, y < 0.0);
}

// Whether all components are finite.
bool ex_is_finite(vec3 v)
{
    return all(notEqual(floatBitsToUint(v) & 0x7F800000u, uvec3(0x7F800000u)));
}

#endif
