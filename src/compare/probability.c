#include "compare/probability.h"

#include <math.h>

#include "base/exact.h"

#define LN2 0.69314718055994530942
#define LOG2_E 1.4426950408889634074
#define SQRT_2_PI 2.5066282746310005024

static double ln(double x)
{
    return lr_log2(x) * LN2;
}

static double exponential(double x)
{
    return x < -690 ? 0 : lr_exp2(x * LOG2_E);
}

double probability_normal(double z)
{
    double density = exponential(-z * z / 2) / SQRT_2_PI;
    if (z < 2) {
        double term = z, sum = z;
        for (int k = 1; k < 60; k++) {
            term *= z * z / (2 * k + 1);
            sum += term;
        }
        return 1 - 2 * density * sum;
    }
    double fraction = z; /* Laplace's continued fraction */
    for (int k = 120; k >= 1; k--)
        fraction = z + k / fraction;
    return 2 * density / fraction;
}

/* M. Abramowitz, I. Stegun, "Handbook of Mathematical Functions", 26.2.23. */
double probability_normal_inverse(double p)
{
    double t = sqrt(-2 * ln(p / 2));
    double numerator = 2.515517 + t * (0.802853 + t * 0.010328);
    double denominator = 1 + t * (1.432788 + t * (0.189269 + t * 0.001308));
    return fmax(t - numerator / denominator, 0);
}

/* 1 - t / sqrt(2 + t^2), without its cancellation. */
double probability_student_2(double t)
{
    double square = 2 + t * t;
    return 2 / (square + t * sqrt(square));
}

double probability_any(double p, double count)
{
    if (p >= 1)
        return 1;
    double none = count * (p < 1e-5 ? -p - p * p / 2 : ln(1 - p)); /* ln P(none) */
    return none > -1e-5 ? -none - none * none / 2 : 1 - exponential(none);
}
