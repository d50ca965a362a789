/* Vectors and affine transforms on the host, in double precision.
 *
 * Everything here is built from + - * / and sqrt, which IEEE 754 rounds correctly, and the host is
 * compiled with -ffp-contract=off, so the results are the same on every machine. */
#ifndef LR_BASE_VEC_H
#define LR_BASE_VEC_H

#include <stdbool.h>

typedef struct lr_vec3 {
    double x, y, z;
} lr_vec3;

/* An affine map p -> rows * (p, 1). */
typedef struct lr_transform {
    double m[3][4];
} lr_transform;

lr_vec3 lr_vec3_add(lr_vec3 a, lr_vec3 b);
lr_vec3 lr_vec3_sub(lr_vec3 a, lr_vec3 b);
lr_vec3 lr_vec3_scale(lr_vec3 a, double s);
double lr_vec3_dot(lr_vec3 a, lr_vec3 b);
lr_vec3 lr_vec3_cross(lr_vec3 a, lr_vec3 b);
double lr_vec3_length(lr_vec3 a);

/* The unit vector along a, also for lengths whose square overflows or underflows; a zero vector
 * stays zero. */
lr_vec3 lr_vec3_normalize(lr_vec3 a);

/* Two unit vectors that with the unit vector n make a right-handed frame: cross(*u, *v) = n. */
void lr_vec3_frame(lr_vec3 n, lr_vec3 *u, lr_vec3 *v);

/* Sine and cosine of an angle in degrees, exact at multiples of 90, within 1e-15 elsewhere, and the
 * same on every machine, which libm does not promise. */
void lr_sincos_degrees(double degrees, double *sine, double *cosine);

lr_transform lr_transform_identity(void);
lr_transform lr_transform_translate(lr_vec3 offset);
lr_transform lr_transform_scale(lr_vec3 factors);

/* Right-handed rotation by degrees about an axis through the origin (Rodrigues' formula). */
lr_transform lr_transform_rotate(lr_vec3 axis, double degrees);

/* The map that applies b first, then a. */
lr_transform lr_transform_multiply(lr_transform a, lr_transform b);
lr_vec3 lr_transform_point(const lr_transform *t, lr_vec3 p);
lr_vec3 lr_transform_vector(const lr_transform *t, lr_vec3 v);

/* A plane's or surface's normal under t, given t's inverse; not of unit length. */
lr_vec3 lr_transform_normal(const lr_transform *inverse, lr_vec3 n);

/* False when t is singular; *inverse is then left alone. */
bool lr_transform_inverse(const lr_transform *t, lr_transform *inverse);

#endif
