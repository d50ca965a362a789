/* The sky by day: Preetham, Shirley and Smits, "A Practical Analytic Model for Daylight", SIGGRAPH
 * 1999. Radiances are linear sRGB in units of 10,000 cd/m^2, so that a clear sky and a white wall
 * in the sun are about 1; the same on every machine. */
#ifndef LR_SCENE_SKY_H
#define LR_SCENE_SKY_H

#include "scene/scene.h"

/* How wide the sun is, degrees. */
#define LR_SUN_ANGLE 0.53

typedef struct lr_sky {
    double turbidity;
    double sun_height;  /* cosine of the sun's angle to the zenith, > 0 */
    double zenith[3];   /* Y, x, y there */
    double perez[3][5]; /* of Y, x, y: their distributions */
    double overhead[3]; /* what these are at the zenith */
} lr_sky;

lr_sky lr_sky_make(double turbidity, double sun_height);

/* Above the horizon, by the height of a direction (its part along up, 0..1) and the cosine of its
 * angle to the sun. */
lr_color lr_sky_radiance(const lr_sky *sky, double height, double cos_sun);

/* Of the sun's disk, without the sky before it. */
lr_color lr_sun_radiance(const lr_sky *sky);

#endif
