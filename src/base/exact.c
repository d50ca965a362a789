#include "base/exact.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

/* x = m 2^e, s = (m - 1) / (m + 1), ln m = 2 (s + s^3/3 + s^5/5 + ...). frexp only moves bits. */
double lr_log2(double x)
{
    int e;
    double m = frexp(x, &e);
    if (m < 0.70710678118654752) {
        m *= 2;
        e--;
    }
    double s = (m - 1) / (m + 1), z = s * s, sum = 0;
    for (int k = 21; k >= 1; k -= 2)
        sum = sum * z + 1.0 / k;
    return e + 2.8853900817779268 * s * sum;
}

double lr_exp2(double x)
{
    int whole = (int)x;
    whole -= whole > x;
    double part = x - whole; /* 0 <= part < 1 */
    if (part >= 0.5) {
        whole++;
        part -= 1;
    }
    part *= 0.69314718055994530942;
    /* The exponential series for |part| <= 0.35; the next term is below 1e-18. */
    double sum = 1;
    for (int i = 13; i >= 1; i--)
        sum = 1 + sum * part / i;
    uint64_t bits = (uint64_t)(1023 + whole) << 52;
    double power;
    memcpy(&power, &bits, sizeof power);
    return power * sum;
}

/* 2 atan(sqrt((1 - x) / (1 + x))), the arctangent's argument brought below tan(pi / 16) by halving
 * the angle twice, where its series is cut behind a term of 1e-17. */
double lr_acos(double x)
{
    bool obtuse = x < 0;
    x = fabs(x);
    double t = sqrt((1 - x) / (1 + x)), sum = 0;
    for (int i = 0; i < 2; i++)
        t = t / (1 + sqrt(1 + t * t));
    for (int k = 23; k >= 1; k -= 2)
        sum = 1.0 / k - sum * t * t;
    double angle = 8 * t * sum;
    return obtuse ? 3.14159265358979323846 - angle : angle;
}
