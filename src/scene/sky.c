#include "scene/sky.h"

#include <math.h>

#include "base/exact.h"

#define PI 3.14159265358979323846
#define LOG2_E 1.4426950408889634

static double exponential(double x)
{
    return x < -600 ? 0 : lr_exp2(x * LOG2_E);
}

/* Perez' distribution, relative to nothing yet; `angle` is that to the sun. */
static double perez(const double c[5], double height, double angle, double cos_angle)
{
    return (1 + c[0] * exponential(c[1] / height)) *
           (1 + c[2] * exponential(c[3] * angle) + c[4] * cos_angle * cos_angle);
}

/* The appendix' polynomial: in the sun's angle a to the zenith and the turbidity t. */
static double zenith_chromaticity(const double c[3][4], double t, double a)
{
    double sum = 0;
    for (int i = 0; i < 3; i++)
        sum = sum * t + ((c[i][0] * a + c[i][1]) * a + c[i][2]) * a + c[i][3];
    return sum;
}

lr_sky lr_sky_make(double turbidity, double sun_height)
{
    static const double slope[3][5] = {
        {0.1787, -0.3554, -0.0227, 0.1206, -0.0670},
        {-0.0193, -0.0665, -0.0004, -0.0641, -0.0033},
        {-0.0167, -0.0950, -0.0079, -0.0441, -0.0109},
    };
    static const double base[3][5] = {
        {-1.4630, 0.4275, 5.3251, -2.5771, 0.3703},
        {-0.2592, 0.0008, 0.2125, -0.8989, 0.0452},
        {-0.2608, 0.0092, 0.2102, -1.6537, 0.0529},
    };
    static const double zenith_x[3][4] = {{0.00166, -0.00375, 0.00209, 0},
                                          {-0.02903, 0.06377, -0.03202, 0.00394},
                                          {0.11693, -0.21196, 0.06052, 0.25886}};
    static const double zenith_y[3][4] = {{0.00275, -0.00610, 0.00317, 0},
                                          {-0.04214, 0.08970, -0.04153, 0.00516},
                                          {0.15346, -0.26756, 0.06670, 0.26688}};
    double t = turbidity, a = lr_acos(sun_height), sine, cosine;
    lr_sky sky = {.turbidity = t, .sun_height = sun_height};
    double chi = (4.0 / 9 - t / 120) * (PI - 2 * a);
    lr_sincos_degrees(chi * 180 / PI, &sine, &cosine);
    sky.zenith[0] = fmax((4.0453 * t - 4.9710) * sine / cosine - 0.2155 * t + 2.4192, 0);
    sky.zenith[1] = zenith_chromaticity(zenith_x, t, a);
    sky.zenith[2] = zenith_chromaticity(zenith_y, t, a);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 5; k++)
            sky.perez[i][k] = slope[i][k] * t + base[i][k];
        sky.overhead[i] = perez(sky.perez[i], 1, a, sun_height);
    }
    return sky;
}

/* Linear sRGB of a colour without its negative parts. */
static lr_color rgb_of(double Y, double x, double y)
{
    double X = x / y * Y, Z = (1 - x - y) / y * Y;
    return (lr_color){fmax(3.2404542 * X - 1.5371385 * Y - 0.4985314 * Z, 0),
                      fmax(-0.9692660 * X + 1.8760108 * Y + 0.0415560 * Z, 0),
                      fmax(0.0556434 * X - 0.2040259 * Y + 1.0572252 * Z, 0)};
}

lr_color lr_sky_radiance(const lr_sky *sky, double height, double cos_sun)
{
    double value[3], angle = lr_acos(fmin(fmax(cos_sun, -1), 1));
    for (int i = 0; i < 3; i++)
        value[i] = sky->zenith[i] * perez(sky->perez[i], fmax(height, 1e-3), angle, cos_sun) /
                   sky->overhead[i];
    return rgb_of(fmax(value[0], 0) / 10, value[1], value[2]);
}

/* The sun's luminance beyond the air, 133.3 klx over its solid angle, white, is dimmed on its way
 * through the air as the appendix says of light of 630, 545 and 460 nanometres: by molecules, haze
 * and ozone. */
lr_color lr_sun_radiance(const lr_sky *sky)
{
    static const double micrometres[3] = {0.630, 0.545, 0.460}, ozone[3] = {0.090, 0.080, 0.006};
    double degrees = lr_acos(sky->sun_height) * 180 / PI, sine, cosine, left[3];
    double mass =
        1 / (sky->sun_height + 0.15 * lr_exp2(-1.253 * lr_log2(fmax(93.885 - degrees, 1e-3))));
    double haze = 0.04608365822050 * sky->turbidity - 0.04586025928522;
    for (int i = 0; i < 3; i++) {
        double bits = lr_log2(micrometres[i]);
        double depth =
            0.008735 * lr_exp2(-4.08 * bits) + haze * lr_exp2(-1.3 * bits) + ozone[i] * 0.35;
        left[i] = exponential(-depth * mass);
    }
    lr_sincos_degrees(LR_SUN_ANGLE / 4, &sine, &cosine);
    double white = 13.33 / (2 * PI * 2 * sine * sine);
    return (lr_color){white * left[0], white * left[1], white * left[2]};
}
