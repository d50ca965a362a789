/* Elementary functions that are the same on every machine, which libm does not promise: built from
 * + - * / and bit operations alone. (Sine and cosine are in vec.h, beside the rotations.) */
#ifndef LR_BASE_EXACT_H
#define LR_BASE_EXACT_H

/* log2(x) within 1e-14, for finite x > 0. */
double lr_log2(double x);

/* 2^x, exact for whole x, with a relative error below 1e-15 for others, |x| <= 1000. */
double lr_exp2(double x);

/* The angle whose cosine is x, in radians, within 1e-15; -1 <= x <= 1. */
double lr_acos(double x);

#endif
