/* Pictures of all directions: how they lie in the scene, and how likely a path goes towards each of
 * their texels. */
#include "render/pack_internal.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "render/choice.h"
#include "scene/color.h"

#define PI 3.14159265358979323846

static lr_status no_memory(lr_error *error)
{
    return lr_fail(error, LR_ERROR_MEMORY, "out of memory for the background");
}

/* v turned by the shortest way that brings y to `up`. */
static lr_vec3 turn(lr_vec3 v, lr_vec3 up)
{
    lr_vec3 axis = {up.z, 0, -up.x}; /* y x up */
    double below = 1 + up.y;
    if (below < 1e-9)
        return (lr_vec3){v.x, -v.y, -v.z};
    lr_vec3 turned = lr_vec3_add(lr_vec3_scale(v, up.y), lr_vec3_cross(axis, v));
    return lr_vec3_add(turned, lr_vec3_scale(axis, lr_vec3_dot(axis, v) / below));
}

/* Right, up and forward of the picture. */
static void find_axes(const lr_scene *scene, lr_vec3 axes[3])
{
    lr_vec3 up = scene->background_up;
    lr_transform t = lr_transform_rotate(up, scene->background.rotate);
    axes[0] = lr_transform_vector(&t, turn((lr_vec3){1, 0, 0}, up));
    axes[1] = up;
    axes[2] = lr_transform_vector(&t, turn((lr_vec3){0, 0, -1}, up));
}

/* ---- The tables ---- */

typedef struct table {
    const lr_texture *texture;
    const double *shades; /* of bytes */
    struct gpu_sky_row *rows;
    double *weights; /* of the picture's rows: light per solid angle, times that */
    double *texels;  /* of one row, */
    uint32_t *steps; /* and their probabilities */
} table;

static double brightness(const table *t, uint32_t x, uint32_t y)
{
    size_t i = (size_t)y * t->texture->width + x;
    double sum = 0;
    for (size_t k = 0; k < 3; k++)
        sum += t->texture->floats ? (double)t->texture->floats[3 * i + k]
                                  : t->shades[t->texture->bytes[4 * i + k]];
    return sum / 3;
}

/* The weights of a row's texels: the mean of what the filter blends there, which is 6/8 the texel's
 * own and 1/8 each neighbour's, along and down. Returns their sum. */
static double weigh_texels(const table *t, uint32_t y)
{
    uint32_t width = t->texture->width, height = t->texture->height;
    uint32_t above = y > 0 ? y - 1 : 0, below = y + 1 < height ? y + 1 : y;
    double sum = 0;
    for (uint32_t x = 0; x < width; x++) {
        uint32_t columns[3] = {(x + width - 1) % width, x, (x + 1) % width};
        double weight = 0;
        for (int k = 0; k < 3; k++) {
            double down = (brightness(t, columns[k], above) + 6 * brightness(t, columns[k], y) +
                           brightness(t, columns[k], below)) /
                          8;
            weight += (k == 1 ? 6 : 1) * down / 8;
        }
        t->texels[x] = weight;
        sum += weight;
    }
    return sum;
}

/* sin(theta / 2)^2 of the upper edge of row y, from the upper pole. */
static double height_of(uint32_t y, uint32_t rows)
{
    double sine, cosine;
    lr_sincos_degrees(90.0 * y / rows, &sine, &cosine);
    return sine * sine;
}

/* The part of a row's table that has the texels' steps before each, four in a row. */
static bool pack_texels(const table *t, double sum, lr_packed_scene *packed)
{
    uint32_t width = t->texture->width, before = 0;
    memset(t->steps, 0, width * sizeof *t->steps);
    if (sum > 0)
        lr_choice_steps(t->texels, width, t->steps);
    for (uint32_t x = 0; x < width; x += 4) {
        uint32_t row[4] = {0};
        for (uint32_t k = 0; k < 4 && x + k < width; k++) {
            row[k] = before;
            before += t->steps[x + k];
        }
        if (lr_pack_rows(packed, row, 1) == UINT32_MAX)
            return false;
    }
    return true;
}

/* Packs both tables; *light becomes the picture's mean radiance times 4 pi. */
static bool pack_rows(const table *t, lr_packed_scene *packed, double *light)
{
    uint32_t height = t->texture->height, before = 0, first = packed->row_count;
    bool fits = lr_pack_rows(packed, t->rows, height) != UINT32_MAX;
    *light = 0;
    for (uint32_t y = 0; y < height && fits; y++) {
        bool lower = y >= (height + 1) / 2;
        double near = height_of(lower ? height - 1 - y : y, height);
        double extent = height_of(lower ? height - y : y + 1, height) - near;
        double sum = weigh_texels(t, y);
        t->rows[y] = (struct gpu_sky_row){.near = (float)near, .extent = (float)extent};
        t->weights[y] = sum * extent;
        *light += sum * extent * 4 * PI / t->texture->width;
        fits = pack_texels(t, sum, packed);
    }
    uint32_t *steps = lr_alloc(height, sizeof *steps);
    if (!fits || !steps) {
        free(steps);
        return false;
    }
    lr_choice_steps(t->weights, height, steps);
    for (uint32_t y = 0; y < height; y++) {
        t->rows[y].begin = before;
        t->rows[y].steps = steps[y];
        before += steps[y];
    }
    memcpy(&packed->rows[first], t->rows, height * sizeof *t->rows);
    free(steps);
    return true;
}

static lr_status pack_tables(const lr_texture *texture, lr_packed_scene *packed, double *light,
                             lr_error *error)
{
    double shades[256];
    for (unsigned i = 0; i < 256; i++)
        shades[i] = lr_srgb_to_linear(i);
    table t = {
        .texture = texture,
        .shades = shades,
        .rows = lr_alloc(texture->height, sizeof *t.rows),
        .weights = lr_alloc(texture->height, sizeof *t.weights),
        .texels = lr_alloc(texture->width, sizeof *t.texels),
        .steps = lr_alloc(texture->width, sizeof *t.steps),
    };
    bool fits = t.rows && t.weights && t.texels && t.steps && pack_rows(&t, packed, light);
    free(t.rows);
    free(t.weights);
    free(t.texels);
    free(t.steps);
    return fits ? LR_OK : no_memory(error);
}

/* Bakes the sky, whose record is behind those of the scene's textures. */
static bool pack_sky(const lr_scene *scene, const lr_vec3 axes[3], lr_packed_scene *packed,
                     struct gpu_environment *e)
{
    lr_color sun;
    double solid_angle, intensity = scene->background.intensity;
    if (!lr_bake_sky(scene, axes, &packed->sky, &sun, &solid_angle))
        return false;
    sun = lr_vec3_scale(sun, intensity);
    e->texture = scene->texture_count;
    e->sun = lr_pack_vec3(lr_vec3_normalize(scene->background.sun));
    e->sun_spread = (float)(solid_angle / (2 * PI));
    e->sun_radiance = lr_pack_vec3(sun);
    packed->sun_light = (sun.x + sun.y + sun.z) / 3 * solid_angle;
    packed->constants[LR_SPEC_SUN] = 1;
    return true;
}

lr_status lr_pack_environment(const lr_scene *scene, lr_packed_scene *packed, lr_error *error)
{
    const lr_background *background = &scene->background;
    if (background->kind == LR_BACKGROUND_GRADIENT)
        return LR_OK;
    bool sky = background->kind == LR_BACKGROUND_SKY;
    lr_vec3 axes[3];
    find_axes(scene, axes);
    struct gpu_environment e = {
        .right = lr_pack_vec3(axes[0]),
        .up = lr_pack_vec3(axes[1]),
        .forward = lr_pack_vec3(axes[2]),
        .texture = background->texture,
        .intensity = (float)background->intensity,
        .rows = packed->row_count,
    };
    if (sky && !pack_sky(scene, axes, packed, &e))
        return no_memory(error);
    const lr_texture *texture = sky ? &packed->sky : &scene->textures[background->texture];
    e.width = texture->width;
    e.height = texture->height;
    double light = 0;
    lr_status status = LR_OK;
    if (packed->constants[LR_SPEC_PATH])
        status = pack_tables(texture, packed, &light, error);
    packed->environment_light = light * background->intensity;
    packed->constants[LR_SPEC_ENVIRONMENT] = 1;
    packed->frame.environment = packed->row_count;
    if (!status && lr_pack_rows(packed, &e, sizeof e / 16) == UINT32_MAX)
        status = no_memory(error);
    return status;
}

void lr_pack_environment_choice(lr_packed_scene *packed, double picture, double sun)
{
    struct gpu_environment e;
    vec4 *at = &packed->rows[packed->frame.environment];
    memcpy(&e, at, sizeof e);
    e.pdf = (float)(picture * e.width / (4 * PI));
    if (e.sun_spread > 0)
        e.sun_pdf = (float)(sun / (2 * PI * e.sun_spread));
    memcpy(at, &e, sizeof e);
}
