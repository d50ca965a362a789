#include "base/exact.h"

#include <math.h>

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
