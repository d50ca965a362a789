/* An explained pixel as text: a tree of indented blocks, one a ray, with the light that each line
 * brings in columns on the right. */
#include "cli/explain_print.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { TEXT_COLUMNS = 70, NAME_SIZE = 600, LINE_SIZE = 1000, PREFIX_SIZE = 2048 };

typedef struct printer {
    const explained_pixel *pixel;
    const lr_explanation *x;
    char prefix[PREFIX_SIZE]; /* of the lines of the ray at hand */
} printer;

/* ---- Pieces of text ------------------------------------------------------------------------- */

typedef struct short_text {
    char text[120];
} short_text;

/* "(1, 2, 3)", or "1" for a colour or share whose channels are equal. */
static short_text vector_text(const float v[3], bool color)
{
    short_text s;
    if (color && v[0] == v[1] && v[1] == v[2]) {
        snprintf(s.text, sizeof s.text, "%.4g", (double)v[0]);
    } else {
        snprintf(s.text, sizeof s.text, "(%.4g, %.4g, %.4g)", 0.0 + (double)v[0],
                 0.0 + (double)v[1], 0.0 + (double)v[2]); /* -0 is 0 */
    }
    return s;
}

/* "sphere, line 12, material 'glass' (line 4)": as much of it as there is. */
static void object_text(const printer *p, uint32_t index, char text[NAME_SIZE])
{
    lr_object_info object;
    lr_material_info material = {0};
    if (!lr_scene_get_object(p->pixel->scene, index, &object)) {
        snprintf(text, NAME_SIZE, "an object");
        return;
    }
    lr_scene_get_material(p->pixel->scene, object.material, &material);
    char where[32] = "", made[300] = "", line[32] = "";
    if (object.line) {
        snprintf(where, sizeof where, ", line %u", (unsigned)object.line);
    } else {
        snprintf(where, sizeof where, ", object %u", (unsigned)index + 1);
    }
    if (material.name && material.line) {
        snprintf(line, sizeof line, " (line %u)", (unsigned)material.line);
    }
    if (material.name) {
        snprintf(made, sizeof made, ", material '%.200s'%s", material.name, line);
    }
    if (object.mesh) {
        snprintf(text, NAME_SIZE, "mesh '%.200s'%s%s", object.mesh, where, made);
    } else {
        snprintf(text, NAME_SIZE, "%s%s%s", object.kind, where, made);
    }
}

/* The same without the material. */
static void obstacle_text(const printer *p, uint32_t index, char text[NAME_SIZE])
{
    object_text(p, index, text);
    char *material = strstr(text, ", material '");
    if (material) {
        *material = '\0';
    }
}

static bool is_black(const float v[3])
{
    return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

static bool any_light(const uint64_t steps[3])
{
    return steps[0] || steps[1] || steps[2];
}

/* ---- Lines ---------------------------------------------------------------------------------- */

static int columns_of(const char *text)
{
    int columns = 0;
    for (; *text; text++) {
        columns += ((unsigned char)*text & 0xC0) != 0x80; /* UTF-8 */
    }
    return columns;
}

/* One channel in 10 columns. */
static void print_number(double value)
{
    if (value == 0) {
        printf("%10s", "0");
    } else if (value >= 1e-4 && value < 1e3) {
        printf("%10.5f", value);
    } else {
        printf("%10.2e", value);
    }
}

static void print_light(const uint64_t steps[3])
{
    for (int c = 0; c < 3; c++) {
        print_number(explained_light(steps[c]));
    }
}

/* A line behind the prefix, with its light in the columns if steps is not NULL. */
static void print_line(const char *prefix, const char *text, const uint64_t *steps)
{
    printf("%s%s", prefix, text);
    if (steps) {
        int used = columns_of(prefix) + columns_of(text);
        printf("%*s", used < TEXT_COLUMNS ? TEXT_COLUMNS - used : 1, "");
        print_light(steps);
    }
    putchar('\n');
}

__attribute__((format(printf, 3, 4))) static void say(const printer *p, const uint64_t *steps,
                                                      const char *format, ...)
{
    char text[LINE_SIZE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    print_line(p->prefix, text, steps);
}

/* ---- Lights --------------------------------------------------------------------------------- */

/* What stands in the way of a light, objects one by one: those that let nothing through say enough.
 */
static void say_obstacles(const printer *p, const lr_explained_light *light)
{
    const lr_explained_obstacle *all = &p->x->obstacles[light->first_obstacle];
    for (uint32_t i = 0; i < light->obstacle_count; i++) {
        const lr_explained_obstacle *o = &all[i];
        char name[NAME_SIZE];
        obstacle_text(p, o->object, name);
        if (is_black(o->left)) {
            say(p, NULL, "  in the shadow of %s, met at %.4g", name, (double)o->distance);
            return;
        }
        say(p, NULL, "  %s, met at %.4g, lets %s through", name, (double)o->distance,
            vector_text(o->left, true).text);
    }
}

/* "point light, line 12". */
static void light_text(const lr_explained_light *light, const lr_light_info *info, char text[80])
{
    if (info->added) {
        snprintf(text, 80, "light of the camera");
    } else if (info->line) {
        snprintf(text, 80, "%s light, line %u", info->kind, (unsigned)info->line);
    } else {
        snprintf(text, 80, "%s light %u", info->kind, (unsigned)light->light + 1);
    }
}

/* "7/d^2 = 0.1094 with d = 8": what arrives at the surface. */
static void say_strength(const printer *p, const lr_explained_light *light,
                         const lr_light_info *info)
{
    char fading[120], color[80] = "", spot[60] = "", shine[40] = "";
    if (light->distance > 0 && info->falloff > 0) {
        snprintf(fading, sizeof fading, "%.4g/d^%.4g = %.4g with d = %.4g", info->intensity,
                 info->falloff, info->intensity * (double)light->attenuation,
                 (double)light->distance);
    } else {
        snprintf(fading, sizeof fading, "intensity %.4g", info->intensity);
    }
    const double *c = info->color;
    if (c[0] != 1 || c[1] != 1 || c[2] != 1) {
        snprintf(color, sizeof color, ", colour (%.4g, %.4g, %.4g)", c[0], c[1], c[2]);
    }
    if (light->spot == 0) {
        snprintf(spot, sizeof spot, ", outside its cone");
    } else if (light->spot != 1) {
        snprintf(spot, sizeof spot, ", at the edge of its cone: %.4g", (double)light->spot);
    }
    if (light->highlight >= 1e-6F) {
        snprintf(shine, sizeof shine, ", highlight %.4g", (double)light->highlight);
    }
    say(p, NULL, "  %s%s%s%s", fading, color, spot, shine);
}

static void say_light(const printer *p, const lr_explained_light *light)
{
    lr_light_info info = {.kind = "?"};
    lr_scene_get_light(p->pixel->scene, light->light, &info);
    char name[80];
    light_text(light, &info, name);
    bool behind = !(light->cosine > 0);
    say(p, light->steps, "%s: cos θ = %.4g%s", name, (double)light->cosine,
        behind ? ", from behind" : "");
    if (behind) {
        return;
    }
    say_strength(p, light, &info);
    if (!light->tested && light->spot != 0) {
        bool nothing = is_black(light->unshadowed);
        say(p, NULL, "  %s", nothing ? "this material shows nothing of it" : "too little to count");
    }
    say_obstacles(p, light);
}

/* ---- Rays ----------------------------------------------------------------------------------- */

/* What happens between two surfaces. */
static void say_way(const printer *p, const lr_explained_ray *ray)
{
    say(p, NULL, "from %s along %s", vector_text(ray->origin, false).text,
        vector_text(ray->direction, false).text);
    char name[NAME_SIZE];
    if (ray->medium != LR_NO_INDEX) {
        object_text(p, ray->medium, name);
        say(p, NULL, "inside %s", name);
    }
    if (any_light(ray->fog_steps)) {
        say(p, ray->fog_steps, "fog on the way");
    }
    if (memcmp(ray->weight, ray->weight_there, sizeof ray->weight) != 0) {
        say(p, NULL, "%s on the way leaves weight %s",
            ray->medium == LR_NO_INDEX ? "fog" : "absorption",
            vector_text(ray->weight_there, true).text);
    }
}

static void say_hit(const printer *p, const lr_explained_ray *ray)
{
    char name[NAME_SIZE], triangle[40] = "";
    object_text(p, ray->object, name);
    if (ray->triangle != LR_NO_INDEX) {
        snprintf(triangle, sizeof triangle, ", triangle %u", (unsigned)ray->triangle + 1);
    }
    say(p, NULL, "meets %s%s", name, triangle);
    say(p, NULL, "t = %.6g at p = %s, n = %s%s", (double)ray->t,
        vector_text(ray->position, false).text, vector_text(ray->lit_by, false).text,
        ray->entering ? "" : ", from inside or behind");
    if (ray->hidden) {
        say(p, NULL, "the medium around has priority here: the surface is passed");
    } else if (ray->hole) {
        say(p, NULL, "its picture is transparent here: the surface is passed");
    }
    if (ray->lost) {
        say(p, NULL, "more media or hidden surfaces than are kept track of");
    }
}

static short_text share_text(const double v[3])
{
    const float rounded[3] = {(float)v[0], (float)v[1], (float)v[2]};
    return vector_text(rounded, true);
}

/* What the material shows of light, and its own. */
static void say_material(const printer *p, const lr_explained_ray *ray)
{
    lr_object_info object;
    lr_material_info material = {0};
    if (lr_scene_get_object(p->pixel->scene, ray->object, &object)) {
        lr_scene_get_material(p->pixel->scene, object.material, &material);
    }
    const double *s = material.specular;
    char specular[160] = "";
    if (s[0] > 0 || s[1] > 0 || s[2] > 0) {
        snprintf(specular, sizeof specular, ", specular %s", share_text(s).text);
    }
    say(p, NULL, "colour %s, diffuse %s%s", vector_text(ray->color, true).text,
        share_text(material.diffuse).text, specular);
    bool ambient = !is_black(ray->ambient), emission = !is_black(ray->emission);
    if (ambient || emission) {
        say(p, ray->own_steps, "%s",
            ambient && emission ? "ambient × colour, emission"
            : ambient           ? "ambient × colour"
                                : "emission");
    }
}

/* What the surface does with the ray: the sheet's sections 3.3 and 3.4. */
static void say_scatter(const printer *p, const lr_explained_ray *ray)
{
    bool goes_on = !is_black(ray->reflect_weight) || !is_black(ray->transmit_weight);
    if (ray->hidden || ray->hole || !goes_on) {
        return;
    }
    if (ray->bends && ray->total) {
        say(p, NULL, "total internal reflection: γ = %.4g/%.4g, c1 = %.4g, 1 - γ²(1 - c1²) < 0",
            (double)ray->ior, (double)ray->ior_beyond, (double)ray->cosine);
    } else if (ray->bends) {
        say(p, NULL, "γ = γ1/γ2 = %.4g/%.4g, c1 = %.4g, c2 = %.4g", (double)ray->ior,
            (double)ray->ior_beyond, (double)ray->cosine, (double)ray->refracted_cosine);
    }
    if (ray->fresnel && !ray->total) {
        char rest[40] = "";
        if (!is_black(ray->transmit_weight)) {
            snprintf(rest, sizeof rest, ", %.4g goes through", 1 - (double)ray->reflectance);
        }
        say(p, NULL, "Fresnel: %.4g is reflected%s", (double)ray->reflectance, rest);
    }
}

static void say_inside(const printer *p, const lr_explained_ray *ray)
{
    say_way(p, ray);
    if (ray->object == LR_NO_INDEX) {
        say(p, ray->own_steps, "meets nothing: background");
        return;
    }
    say_hit(p, ray);
    if (ray->lit) {
        say_material(p, ray);
    }
    for (uint32_t i = 0; i < ray->light_count; i++) {
        say_light(p, &p->x->lights[ray->first_light + i]);
    }
    say_scatter(p, ray);
}

/* The ray's first line. */
static void say_header(const printer *p, const char *prefix, const lr_explained_ray *ray)
{
    static const char *const kinds[] = {
        [LR_RAY_CAMERA] = "camera ray",
        [LR_RAY_REFLECTED] = "reflected ray",
        [LR_RAY_REFRACTED] = "refracted ray",
        [LR_RAY_ONWARD] = "the same ray goes on",
    };
    char text[LINE_SIZE], cut[80] = "";
    if (ray->cut == LR_CUT_DEPTH) {
        snprintf(cut, sizeof cut, ": not traced, depth %u is used up", (unsigned)p->x->depth);
    } else if (ray->cut == LR_CUT_WEIGHT) {
        snprintf(cut, sizeof cut, ": not traced, below min_weight");
    }
    snprintf(text, sizeof text, "%s, weight %s%s", kinds[ray->kind],
             vector_text(ray->weight, true).text, cut);
    print_line(prefix, text, ray->cut ? NULL : ray->steps);
}

/* The number of rays if there is none. */
static uint32_t next_child(const lr_explanation *x, uint32_t parent, uint32_t from)
{
    while (from < x->ray_count && x->rays[from].parent > parent) {
        from++; /* through what comes from the child before */
    }
    return from < x->ray_count && x->rays[from].parent == parent ? from : x->ray_count;
}

/* The ray and all that comes from it. `first` and `rest` stand before its first line and the
 * others. */
static void say_ray(printer *p, uint32_t index, const char *first, const char *rest)
{
    const lr_explained_ray *ray = &p->x->rays[index];
    say_header(p, first, ray);
    if (ray->cut) {
        return;
    }
    uint32_t child = next_child(p->x, index, index + 1);
    bool has_child = child < p->x->ray_count;
    snprintf(p->prefix, sizeof p->prefix, "%s%s", rest, has_child ? "│ " : "  ");
    say_inside(p, ray);
    while (child < p->x->ray_count) {
        uint32_t next = next_child(p->x, index, child + 1);
        bool last = next >= p->x->ray_count;
        char child_first[PREFIX_SIZE], child_rest[PREFIX_SIZE];
        snprintf(child_first, sizeof child_first, "%s%s", rest, last ? "└─" : "├─");
        snprintf(child_rest, sizeof child_rest, "%s%s", rest, last ? "  " : "│ ");
        say_ray(p, child, child_first, child_rest);
        child = next;
    }
}

void print_explanation(const explained_pixel *pixel)
{
    const lr_explanation *x = pixel->explanation;
    printer p = {.pixel = pixel, .x = x};
    printf("%s: pixel %u,%u of %u×%u, sample %u of %u, depth %u, seed %u\n\n", pixel->path,
           (unsigned)x->x, (unsigned)x->y, (unsigned)x->width, (unsigned)x->height,
           (unsigned)x->sample, (unsigned)x->samples, (unsigned)x->depth, (unsigned)x->seed);
    printf("%*s%10s%10s%10s\n", TEXT_COLUMNS, "", "red", "green", "blue");
    say_ray(&p, 0, "", "");
    if (x->light_count > 0) {
        printf("\nA light brings weight × colour × diffuse × cos θ × its colour × "
               "intensity/d^falloff, "
               "and\nspecular × highlight in place of colour × diffuse × cos θ.\n");
    }
    printf("\nThis sample in steps of 2^-36, the sum of all above: %" PRIu64 ", %" PRIu64
           ", %" PRIu64 "\n",
           x->sample_steps[0], x->sample_steps[1], x->sample_steps[2]);
    char text[LINE_SIZE];
    snprintf(text, sizeof text, "The pixel, mean of %u sample%s%s", (unsigned)x->samples,
             x->samples == 1 ? "" : "s", x->saturated ? ", brighter than the film holds" : "");
    printf("%s%*s", text, TEXT_COLUMNS - columns_of(text), "");
    for (int c = 0; c < 3; c++) {
        print_number((double)x->pixel[c]);
    }
    putchar('\n');
}
