#include "base/vec.h"

#include <math.h>

lr_vec3 lr_vec3_add(lr_vec3 a, lr_vec3 b)
{
    return (lr_vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}

lr_vec3 lr_vec3_sub(lr_vec3 a, lr_vec3 b)
{
    return (lr_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

lr_vec3 lr_vec3_scale(lr_vec3 a, double s)
{
    return (lr_vec3){a.x * s, a.y * s, a.z * s};
}

double lr_vec3_dot(lr_vec3 a, lr_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

lr_vec3 lr_vec3_cross(lr_vec3 a, lr_vec3 b)
{
    return (lr_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

double lr_vec3_length(lr_vec3 a)
{
    double largest = fmax(fabs(a.x), fmax(fabs(a.y), fabs(a.z)));
    if (!(largest > 0))
        return 0;
    lr_vec3 s = {a.x / largest, a.y / largest, a.z / largest};
    return largest * sqrt(lr_vec3_dot(s, s));
}

lr_vec3 lr_vec3_normalize(lr_vec3 a)
{
    double largest = fmax(fabs(a.x), fmax(fabs(a.y), fabs(a.z)));
    if (!(largest > 0))
        return a;
    lr_vec3 s = {a.x / largest, a.y / largest, a.z / largest};
    double length = sqrt(lr_vec3_dot(s, s));
    return (lr_vec3){s.x / length, s.y / length, s.z / length};
}

void lr_vec3_frame(lr_vec3 n, lr_vec3 *u, lr_vec3 *v)
{
    lr_vec3 helper = fabs(n.y) < 0.9 ? (lr_vec3){0, 1, 0} : (lr_vec3){1, 0, 0};
    *u = lr_vec3_normalize(lr_vec3_cross(helper, n));
    *v = lr_vec3_cross(n, *u);
}

/* Taylor polynomials of sine and cosine for |x| <= pi/4; the next term is below 1e-17. */
static double sine_polynomial(double x)
{
    double z = x * x;
    double sum = -1.0 / 1307674368000.0;
    sum = sum * z + 1.0 / 6227020800.0;
    sum = sum * z - 1.0 / 39916800.0;
    sum = sum * z + 1.0 / 362880.0;
    sum = sum * z - 1.0 / 5040.0;
    sum = sum * z + 1.0 / 120.0;
    sum = sum * z - 1.0 / 6.0;
    return x + x * (sum * z);
}

static double cosine_polynomial(double x)
{
    double z = x * x;
    double sum = 1.0 / 20922789888000.0;
    sum = sum * z - 1.0 / 87178291200.0;
    sum = sum * z + 1.0 / 479001600.0;
    sum = sum * z - 1.0 / 3628800.0;
    sum = sum * z + 1.0 / 40320.0;
    sum = sum * z - 1.0 / 720.0;
    sum = sum * z + 1.0 / 24.0;
    sum = sum * z - 0.5;
    return 1.0 + sum * z;
}

void lr_sincos_degrees(double degrees, double *sine, double *cosine)
{
    double turns = floor(degrees / 360.0);
    degrees -= turns * 360.0;
    int quadrant = (int)floor(degrees / 90.0 + 0.5);
    double x = (degrees - quadrant * 90.0) * 0.017453292519943295;
    double s = sine_polynomial(x), c = cosine_polynomial(x);
    switch (quadrant & 3) {
    case 0:
        *sine = s, *cosine = c;
        break;
    case 1:
        *sine = c, *cosine = -s;
        break;
    case 2:
        *sine = -s, *cosine = -c;
        break;
    default:
        *sine = -c, *cosine = s;
    }
}

lr_transform lr_transform_identity(void)
{
    return (lr_transform){{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
}

lr_transform lr_transform_translate(lr_vec3 offset)
{
    return (lr_transform){{{1, 0, 0, offset.x}, {0, 1, 0, offset.y}, {0, 0, 1, offset.z}}};
}

lr_transform lr_transform_scale(lr_vec3 factors)
{
    return (lr_transform){{{factors.x, 0, 0, 0}, {0, factors.y, 0, 0}, {0, 0, factors.z, 0}}};
}

lr_transform lr_transform_rotate(lr_vec3 axis, double degrees)
{
    lr_vec3 a = lr_vec3_normalize(axis);
    double s, c;
    lr_sincos_degrees(degrees, &s, &c);
    double k = 1 - c;
    return (lr_transform){{
        {c + k * a.x * a.x, k * a.x * a.y - s * a.z, k * a.x * a.z + s * a.y, 0},
        {k * a.y * a.x + s * a.z, c + k * a.y * a.y, k * a.y * a.z - s * a.x, 0},
        {k * a.z * a.x - s * a.y, k * a.z * a.y + s * a.x, c + k * a.z * a.z, 0},
    }};
}

lr_transform lr_transform_multiply(lr_transform a, lr_transform b)
{
    lr_transform product;
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++)
            product.m[row][column] = a.m[row][0] * b.m[0][column] + a.m[row][1] * b.m[1][column] +
                                     a.m[row][2] * b.m[2][column] + (column == 3 ? a.m[row][3] : 0);
    return product;
}

lr_vec3 lr_transform_vector(const lr_transform *t, lr_vec3 v)
{
    return (lr_vec3){t->m[0][0] * v.x + t->m[0][1] * v.y + t->m[0][2] * v.z,
                     t->m[1][0] * v.x + t->m[1][1] * v.y + t->m[1][2] * v.z,
                     t->m[2][0] * v.x + t->m[2][1] * v.y + t->m[2][2] * v.z};
}

lr_vec3 lr_transform_point(const lr_transform *t, lr_vec3 p)
{
    lr_vec3 v = lr_transform_vector(t, p);
    return (lr_vec3){v.x + t->m[0][3], v.y + t->m[1][3], v.z + t->m[2][3]};
}

lr_vec3 lr_transform_normal(const lr_transform *inverse, lr_vec3 n)
{
    return (lr_vec3){inverse->m[0][0] * n.x + inverse->m[1][0] * n.y + inverse->m[2][0] * n.z,
                     inverse->m[0][1] * n.x + inverse->m[1][1] * n.y + inverse->m[2][1] * n.z,
                     inverse->m[0][2] * n.x + inverse->m[1][2] * n.y + inverse->m[2][2] * n.z};
}

bool lr_transform_inverse(const lr_transform *t, lr_transform *inverse)
{
    lr_vec3 r0 = {t->m[0][0], t->m[0][1], t->m[0][2]};
    lr_vec3 r1 = {t->m[1][0], t->m[1][1], t->m[1][2]};
    lr_vec3 r2 = {t->m[2][0], t->m[2][1], t->m[2][2]};
    lr_vec3 c0 = lr_vec3_cross(r1, r2), c1 = lr_vec3_cross(r2, r0), c2 = lr_vec3_cross(r0, r1);
    double determinant = lr_vec3_dot(r0, c0);
    if (!isfinite(determinant) || fabs(determinant) < 1e-300)
        return false;
    double k = 1 / determinant;
    lr_transform out = {{{c0.x * k, c1.x * k, c2.x * k, 0},
                         {c0.y * k, c1.y * k, c2.y * k, 0},
                         {c0.z * k, c1.z * k, c2.z * k, 0}}};
    lr_vec3 moved = lr_transform_vector(&out, (lr_vec3){t->m[0][3], t->m[1][3], t->m[2][3]});
    out.m[0][3] = -moved.x;
    out.m[1][3] = -moved.y;
    out.m[2][3] = -moved.z;
    *inverse = out;
    return true;
}
