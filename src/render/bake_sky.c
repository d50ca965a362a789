/* The sky as a picture of all directions. */
#include "render/pack_internal.h"

#include <stdlib.h>

#include "base/memory.h"
#include "scene/sky.h"

#define PI 3.14159265358979323846

enum { WIDTH = 512, HEIGHT = 256 };

static void put_texel(float *texels, int x, int y, lr_color color)
{
    float *at = &texels[3 * ((size_t)y * WIDTH + (size_t)x)];
    at[0] = (float)color.x;
    at[1] = (float)color.y;
    at[2] = (float)color.z;
}

/* The half above the horizon; returns the light that falls on the ground from there. */
static lr_color bake_air(const lr_scene *scene, const lr_sky *sky, const lr_vec3 axes[3],
                         float *texels)
{
    lr_vec3 sun = lr_vec3_normalize(scene->background.sun);
    lr_color falls = {0, 0, 0};
    for (int y = 0; y < HEIGHT / 2; y++) {
        double sine, cosine, sine_across, cosine_across;
        lr_sincos_degrees(180 * (y + 0.5) / HEIGHT, &sine, &cosine);
        for (int x = 0; x < WIDTH; x++) {
            lr_sincos_degrees(360 * (x + 0.5) / WIDTH - 180, &sine_across, &cosine_across);
            lr_vec3 d = lr_vec3_scale(axes[1], cosine);
            d = lr_vec3_add(d, lr_vec3_scale(axes[0], sine * sine_across));
            d = lr_vec3_add(d, lr_vec3_scale(axes[2], sine * cosine_across));
            lr_color color = lr_sky_radiance(sky, cosine, lr_vec3_dot(d, sun));
            put_texel(texels, x, y, color);
            falls = lr_vec3_add(
                falls, lr_vec3_scale(color, cosine * sine * (2 * PI / WIDTH) * (PI / HEIGHT)));
        }
    }
    return falls;
}

bool lr_bake_sky(const lr_scene *scene, const lr_vec3 axes[3], lr_texture *picture, lr_color *sun,
                 double *solid_angle)
{
    const lr_background *b = &scene->background;
    double height = lr_vec3_dot(lr_vec3_normalize(b->sun), scene->background_up), sine, cosine;
    lr_sky sky = lr_sky_make(b->turbidity, height < 1 ? height : 1);
    lr_sincos_degrees(LR_SUN_ANGLE / 4, &sine, &cosine);
    *sun = lr_sun_radiance(&sky);
    *solid_angle = 4 * PI * sine * sine;
    *picture = (lr_texture){.width = WIDTH,
                            .height = HEIGHT,
                            .wrap_v = LR_WRAP_CLAMP,
                            .floats = lr_alloc_large((size_t)WIDTH * HEIGHT, 3 * sizeof(float))};
    if (!picture->floats)
        return false;
    lr_color falls = bake_air(scene, &sky, axes, picture->floats);
    falls = lr_vec3_add(falls, lr_vec3_scale(*sun, *solid_angle * height));
    lr_color g = lr_vec3_scale(b->ground, 1 / PI);
    lr_color ground = {g.x * falls.x, g.y * falls.y, g.z * falls.z};
    for (int y = HEIGHT / 2; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            put_texel(picture->floats, x, y, ground);
    return true;
}
