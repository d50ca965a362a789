/* Tails of distributions, the same on every machine. */
#ifndef LR_COMPARE_PROBABILITY_H
#define LR_COMPARE_PROBABILITY_H

/* P(|Z| >= z) of a standard normal variable, z >= 0; relative error below 1e-9. */
double probability_normal(double z);

/* The z >= 0 with P(|Z| >= z) = p, 0 < p <= 1, within 5e-4. */
double probability_normal_inverse(double p);

/* P(|T| >= t) of Student's t with two degrees of freedom, t >= 0. */
double probability_student_2(double t);

/* P(at least one of count independent events), each with probability p (Sidak's correction). */
double probability_any(double p, double count);

#endif
