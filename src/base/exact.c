#include "base/exact.h"

#include <math.h>
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
