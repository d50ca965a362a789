#include "preview/explained.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/memory.h"

#define ROWS_MAX 24 /* rays that are told in words */
#define NAME_COLUMNS 46

#define COLOR_CAMERA 0xFFFFFF
#define COLOR_REFLECTED 0x5AB4FF
#define COLOR_REFRACTED 0x6FDC8C
#define COLOR_LIGHT 0xFFD866
#define COLOR_SHADOW 0xFF5C57

static const char *const kind_names[] = {
    [LR_RAY_CAMERA] = "camera",
    [LR_RAY_REFLECTED] = "reflected",
    [LR_RAY_REFRACTED] = "refracted",
    [LR_RAY_ONWARD] = "onward",
};

static double light_of(uint64_t steps)
{
    return ldexp((double)steps, -36);
}

static void put_object(FILE *out, const lr_scene *scene, uint32_t index)
{
    lr_object_info object;
    lr_material_info material = {0};
    if (!lr_scene_get_object(scene, index, &object))
        return;
    lr_scene_get_material(scene, object.material, &material);
    fprintf(out, "%s", object.kind);
    if (object.line)
        fprintf(out, ", line %u", (unsigned)object.line);
    if (material.name)
        fprintf(out, ", %.40s", material.name);
}

static void put_meeting(FILE *out, const lr_scene *scene, const lr_explained_ray *ray)
{
    if (ray->object == LR_NO_INDEX)
        fputs("background", out);
    else
        put_object(out, scene, ray->object);
    if (ray->total)
        fputs(" (total)", out);
}

static uint32_t depth_of(const lr_explanation *x, uint32_t ray)
{
    uint32_t depth = 0;
    for (; x->rays[ray].parent != LR_NO_INDEX; ray = x->rays[ray].parent)
        depth++;
    return depth;
}

/* One ray a line: indented, what it is, what it meets, what it and all behind it bring. */
static void put_row(FILE *out, const lr_scene *scene, const lr_explanation *x, uint32_t index)
{
    const lr_explained_ray *ray = &x->rays[index];
    char *name = NULL;
    size_t size;
    FILE *row = open_memstream(&name, &size);
    if (!row)
        return;
    fprintf(row, "%*s%s: ", (int)(2 * depth_of(x, index)), "", kind_names[ray->kind]);
    put_meeting(row, scene, ray);
    fclose(row);
    fprintf(out, "%-*.*s %8.4f %8.4f %8.4f\n", NAME_COLUMNS, NAME_COLUMNS, name,
            light_of(ray->steps[0]), light_of(ray->steps[1]), light_of(ray->steps[2]));
    free(name);
}

static char *tell(const lr_scene *scene, const lr_explanation *x)
{
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    if (!out)
        return NULL;
    fprintf(out, "pixel %u,%u, sample %u of %u\n", (unsigned)x->x, (unsigned)x->y,
            (unsigned)x->sample + 1, (unsigned)x->samples);
    fprintf(out, "%-*s %8s %8s %8s\n", NAME_COLUMNS, "", "red", "green", "blue");
    uint32_t rows = 0, left = 0;
    for (uint32_t i = 0; i < x->ray_count; i++) {
        bool told = x->rays[i].cut == LR_CUT_NONE;
        if (told && rows < ROWS_MAX)
            put_row(out, scene, x, i);
        rows += told;
        left += !told;
    }
    if (rows > ROWS_MAX)
        fprintf(out, "... and %u rays more\n", (unsigned)(rows - ROWS_MAX));
    if (left > 0)
        fprintf(out, "%u too weak or too deep to be traced\n", (unsigned)left);
    fprintf(out, "%-*s %8.4f %8.4f %8.4f\n", NAME_COLUMNS, "the pixel, mean of all samples",
            (double)x->pixel[0], (double)x->pixel[1], (double)x->pixel[2]);
    fprintf(out, "lights and weights: lavaray explain --pixel %u,%u", (unsigned)x->x,
            (unsigned)x->y);
    fclose(out);
    return text;
}

static lr_vec3 vec3(const float v[3])
{
    return (lr_vec3){(double)v[0], (double)v[1], (double)v[2]};
}

static lr_vec3 along(const float from[3], const float direction[3], double distance)
{
    return lr_vec3_add(vec3(from), lr_vec3_scale(vec3(direction), distance));
}

static void add_line(lr_explained_pixel *p, lr_vec3 from, lr_vec3 to, uint32_t color, bool arrow)
{
    p->lines[p->line_count++] = (lr_ray_line){from, to, color, arrow};
}

static void add_light(lr_explained_pixel *p, const lr_explanation *x,
                      const lr_explained_light *light, double far)
{
    if (!light->tested)
        return;
    bool arrives = light->left[0] > 0 || light->left[1] > 0 || light->left[2] > 0;
    double distance = light->distance > 0 ? (double)light->distance : far;
    if (!arrives && light->obstacle_count > 0)
        distance = (double)x->obstacles[light->first_obstacle].distance;
    add_line(p, vec3(light->origin), along(light->origin, light->wi, distance),
             arrives ? COLOR_LIGHT : COLOR_SHADOW, false);
}

static void add_ray(lr_explained_pixel *p, const lr_explanation *x, uint32_t index, double far)
{
    static const uint32_t colors[] = {
        [LR_RAY_CAMERA] = COLOR_CAMERA,
        [LR_RAY_REFLECTED] = COLOR_REFLECTED,
        [LR_RAY_REFRACTED] = COLOR_REFRACTED,
    };
    const lr_explained_ray *ray = &x->rays[index];
    uint32_t source = index; /* of the same kind, before it passed what was not there */
    while (x->rays[source].kind == LR_RAY_ONWARD && x->rays[source].parent != LR_NO_INDEX)
        source = x->rays[source].parent;
    if (ray->cut != LR_CUT_NONE)
        return;
    bool meets = ray->object != LR_NO_INDEX;
    add_line(p, vec3(ray->origin), along(ray->origin, ray->direction, meets ? (double)ray->t : far),
             colors[x->rays[source].kind], meets);
    for (uint32_t i = 0; i < ray->light_count; i++)
        add_light(p, x, &x->lights[ray->first_light + i], far);
}

lr_explained_pixel *lr_explained_pixel_create(const lr_scene *scene, const lr_explanation *pixel,
                                              double far)
{
    lr_explained_pixel *p = lr_alloc(1, sizeof *p);
    if (!p)
        return NULL;
    p->text = tell(scene, pixel);
    p->lines = lr_alloc((size_t)pixel->ray_count + pixel->light_count + 1, sizeof *p->lines);
    if (!p->text || !p->lines) {
        lr_explained_pixel_free(p);
        return NULL;
    }
    /* Surfaces that are not there for the ray are passed. */
    for (uint32_t i = 0; i < pixel->ray_count && !p->meets; i++) {
        const lr_explained_ray *ray = &pixel->rays[i];
        bool first = ray->kind == LR_RAY_CAMERA || ray->kind == LR_RAY_ONWARD;
        p->meets = first && ray->object != LR_NO_INDEX && !ray->hidden && !ray->hole;
        p->met = vec3(ray->position);
        if (!first)
            break;
    }
    for (uint32_t i = 0; i < pixel->ray_count; i++)
        add_ray(p, pixel, i, far);
    return p;
}

void lr_explained_pixel_free(lr_explained_pixel *pixel)
{
    if (!pixel)
        return;
    free(pixel->text);
    free(pixel->lines);
    free(pixel);
}
