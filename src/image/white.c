/* White balance: light of a colour temperature becomes the white of sRGB, D65. */
#include "image/tone.h"

/* IEC 61966-2-1, from linear sRGB to XYZ. */
static const lr_transform srgb_to_xyz = {
    {{0.4124, 0.3576, 0.1805, 0}, {0.2126, 0.7152, 0.0722, 0}, {0.0193, 0.1192, 0.9505, 0}}};

/* The cone responses of the Bradford transform (Lam, 1985). */
static const lr_transform bradford = {
    {{0.8951, 0.2664, -0.1614, 0}, {-0.7502, 1.7135, 0.0367, 0}, {0.0389, -0.0685, 1.0296, 0}}};

/* Black bodies from 1667 to 4000 K: Kim et al., US patent 7024034 (2006). */
static void black_body(double kelvin, double *x, double *y)
{
    double t = 1000 / kelvin;
    *x = ((-0.2661239 * t - 0.2343589) * t + 0.8776956) * t + 0.179910;
    *y = kelvin < 2222 ? ((-1.1063814 * *x - 1.34811020) * *x + 2.18555832) * *x - 0.20219683
                       : ((-0.9549476 * *x - 1.37418593) * *x + 2.09137015) * *x - 0.16748867;
}

/* Daylight from 4000 to 25000 K: CIE 15, D illuminants. */
static void daylight(double kelvin, double *x, double *y)
{
    double t = 1000 / kelvin;
    *x = kelvin <= 7000 ? ((-4.6070 * t + 2.9678) * t + 0.09911) * t + 0.244063
                        : ((-2.0064 * t + 1.9018) * t + 0.24748) * t + 0.237040;
    *y = (-3.000 * *x + 2.870) * *x - 0.275;
}

lr_transform image_white_balance(double kelvin)
{
    double x, y;
    if (kelvin < 4000)
        black_body(kelvin, &x, &y);
    else
        daylight(kelvin, &x, &y);
    lr_transform to_cones = lr_transform_multiply(bradford, srgb_to_xyz), from_cones;
    lr_transform_inverse(&to_cones, &from_cones);
    lr_vec3 source = lr_transform_vector(&bradford, (lr_vec3){x / y, 1, (1 - x - y) / y});
    lr_vec3 white = lr_transform_vector(&to_cones, (lr_vec3){1, 1, 1});
    lr_vec3 gain = {white.x / source.x, white.y / source.y, white.z / source.z};
    return lr_transform_multiply(from_cones,
                                 lr_transform_multiply(lr_transform_scale(gain), to_cones));
}
