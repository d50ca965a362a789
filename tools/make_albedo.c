/* make_albedo OUTPUT: the tables of shaders/bsdf_table.glsl as a header. Everything in them is made
 * with + - * / and square roots, so that every machine makes the same. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>

#include "base/exact.h"
#include "base/vec.h"
#include "gpu_layout.h"

#define POINTS 6765 /* of the integrals: the 20th Fibonacci number, */
#define STEP 4181   /* and the one before */

/* A lattice (Zaremba 1966) of heights within 0..1, dense at both ends, where integrands need not
 * fit together, and of angles. */
static double heights[POINTS], weights[POINTS], cosines[POINTS], sines[POINTS];

/* What becomes of light that meets a visible microfacet: its cosine with the microfacet, that of
 * the microfacet's and of the reflected ray's with the surface's normal, and the share that gets
 * out. */
static double facing[POINTS], tilt[POINTS], reflected[POINTS], out[POINTS], terms[POINTS];

static double square(double x)
{
    return x * x;
}

static void place_points(void)
{
    for (int i = 0, turn = 0; i < POINTS; i++, turn = (turn + STEP) % POINTS) {
        double t = (i + 0.5) / POINTS;
        heights[i] = square(t) * t * (10 - 15 * t + 6 * square(t));
        weights[i] = 30 * square(t * (1 - t)) / POINTS;
        lr_sincos_degrees((turn + 0.5) * 360 / POINTS, &sines[i], &cosines[i]);
    }
}

static double sum_of_terms(void)
{
    double sum = 0;
    for (int i = 0; i < POINTS; i++)
        sum += terms[i];
    return sum;
}

/* As bsdf_ggx.glsl has it. */
static double slant(double alpha, double z)
{
    return sqrt(square(alpha) + (1 - square(alpha)) * square(z));
}

/* The share that gets out towards a cosine: ggx_escape in bsdf_ggx.glsl. */
static inline double escape(double alpha, double from, double slant_from, double to)
{
    double z = to > 0 ? to : 0;
    return z * (from + slant_from) / (z * slant_from + from * slant(alpha, z));
}

/* The spherical caps of Dupuy and Benyoub (2023). Returns the sum of `out`. */
static double meet(double cosine, double alpha)
{
    double sine = sqrt(fmax(0, 1 - square(cosine))), x = alpha * sine;
    double length = sqrt(square(x) + square(cosine)), z = cosine / length, shift = x / length;
    double from = slant(alpha, cosine);
    for (int i = 0; i < POINTS; i++) {
        double height = heights[i] * (1 + z) - z, flat = 1 - square(height);
        double width = sqrt(flat > 0 ? flat : 0);
        double hx = alpha * (width * cosines[i] + shift), hy = alpha * width * sines[i];
        double hz = height + z, inv = 1 / sqrt(square(hx) + square(hy) + square(hz));
        double c = (sine * hx + cosine * hz) * inv;
        facing[i] = c < 1 ? c : 1;
        tilt[i] = hz * inv;
        reflected[i] = 2 * facing[i] * tilt[i] - cosine;
        out[i] = weights[i] * escape(alpha, cosine, from, reflected[i]);
    }
    double sum = 0;
    for (int i = 0; i < POINTS; i++)
        sum += out[i];
    return sum;
}

/* The places of bsdf_table.glsl: of a cosine, for facets, */
static double facet_place(double cosine, double alpha, double critical)
{
    (void)critical;
    return sqrt(cosine * (1 + alpha) / (cosine + alpha));
}

/* for Schlick's weight, */
static double schlick_place(double cosine, double alpha, double critical)
{
    return 0.5 * (cosine + facet_place(cosine, alpha, critical));
}

/* and for light on its way out of glass. */
static double critical_place(double cosine, double alpha, double critical)
{
    double away = cosine - critical, width = 1 - critical;
    double step = away / (alpha + fabs(away));
    double first = -critical / (alpha + critical), last = width / (alpha + width);
    return 0.5 * cosine + 0.2 * facet_place(cosine, alpha, critical) +
           0.3 * (step - first) / (last - first);
}

/* The cosine that has a place. */
static double cosine_at(double place, double (*place_of)(double, double, double), double alpha,
                        double critical)
{
    double low = 0, high = 1;
    for (int i = 0; i < 60; i++) {
        double middle = 0.5 * (low + high);
        if (place_of(middle, alpha, critical) < place)
            low = middle;
        else
            high = middle;
    }
    return fmax(0.5 * (low + high), 1e-6);
}

static double alpha_at(double y, double least)
{
    return square(sqrt(least) + (1 - sqrt(least)) * y);
}

static double ggx_at(double x, double y, int layer)
{
    double alpha = alpha_at(y, LR_ALPHA_MIN);
    (void)layer;
    return meet(cosine_at(x, facet_place, alpha, 0), alpha);
}

/* The fifth root of the mean weight: how much more it is than without roughness. */
static double schlick_at(double x, double y, int layer)
{
    double alpha = alpha_at(y, LR_ALPHA_MIN);
    double cosine = cosine_at(x, schlick_place, alpha, 0), all = meet(cosine, alpha);
    (void)layer;
    for (int i = 0; i < POINTS; i++)
        terms[i] = out[i] * square(square(1 - facing[i])) * (1 - facing[i]);
    double mean = sum_of_terms() / all;
    return lr_exp2(lr_log2(fmax(mean, 1e-20)) / 5) - (1 - cosine);
}

/* What glass reflects and lets through, against what mirrors reflect: first the layers into denser
 * matter, then those out of it. */
static double glass_at(double x, double y, int layer)
{
    bool leaves = layer >= LR_GLASS_INTO;
    double at =
        leaves ? (layer - LR_GLASS_INTO) / (LR_GLASS_OUT_OF - 1.0) : layer / (LR_GLASS_INTO - 1.0);
    double tone = square(square(LR_GLASS_FIRST + (LR_GLASS_LAST - LR_GLASS_FIRST) * at));
    double ratio = leaves ? (1 + tone) / (1 - tone) : (1 - tone) / (1 + tone);
    double alpha = alpha_at(y, LR_ALPHA_MIN);
    double critical = leaves ? sqrt(1 - 1 / square(ratio)) : 0;
    double cosine = cosine_at(x, leaves ? critical_place : facet_place, alpha, critical);
    double all = meet(cosine, alpha), from = slant(alpha, cosine);
    for (int i = 0; i < POINTS; i++) {
        double c = facing[i], c2_squared = 1 - square(ratio) * (1 - square(c));
        double c2 = sqrt(c2_squared > 0 ? c2_squared : 0);
        double rs = (ratio * c - c2) / (ratio * c + c2);
        double rp = (ratio * c2 - c) / (ratio * c2 + c);
        double f = c2_squared <= 0 ? 1 : 0.5 * (square(rs) + square(rp));
        double through = (c2 - ratio * c) * tilt[i] + ratio * cosine;
        terms[i] = f * out[i] + (1 - f) * weights[i] * escape(alpha, cosine, from, through);
    }
    return sum_of_terms() / all;
}

/* Light from all around, by the sheen's BRDF (bsdf_sheen.glsl). */
static double sheen_at(double x, double y, int layer)
{
    double cosine = fmax(square(x), 1e-6), sine = sqrt(fmax(0, 1 - square(cosine))), sum = 0;
    (void)layer;
    double power = 1 / alpha_at(y, LR_SHEEN_ALPHA_MIN);
    for (int i = 0; i < POINTS; i++) {
        double z = heights[i], width = sqrt(1 - square(z));
        double hx = sine + width * cosines[i], hy = width * sines[i], hz = cosine + z;
        double across = square(hx) + square(hy);
        double sine2 = fmin(fmax(across / (across + square(hz)), 1e-20), 1);
        double bits = lr_log2(sine2) * 0.5 * power;
        double facets = (2 + power) * (bits > -900 ? lr_exp2(bits) : 0);
        sum += facets * 0.25 / (z + cosine - z * cosine) * z * weights[i];
    }
    return sum;
}

/* The values at the corners of columns x rows cells, in so many layers. */
static void write_table(FILE *file, const char *name, int columns, int rows, int layers,
                        double (*at)(double x, double y, int layer))
{
    fprintf(file, "static const float %s[%d] = {", name, layers * (columns + 1) * (rows + 1));
    for (int l = 0; l < layers; l++)
        for (int j = 0; j <= rows; j++)
            for (int i = 0; i <= columns; i++)
                fprintf(file, "%s%.8ff,", i % 8 ? " " : "\n    ",
                        at((double)i / columns, (double)j / rows, l));
    fprintf(file, "\n};\n");
}

int main(int argc, char **argv)
{
    FILE *file = argc == 2 ? fopen(argv[1], "w") : NULL;
    if (!file) {
        perror(argc == 2 ? argv[1] : "usage: make_albedo OUTPUT");
        return 2;
    }
    place_points();
    write_table(file, "albedo_ggx", LR_ALBEDO_CELLS, LR_ALBEDO_CELLS, 1, ggx_at);
    write_table(file, "albedo_schlick", LR_ALBEDO_CELLS, LR_ALBEDO_CELLS, 1, schlick_at);
    write_table(file, "albedo_sheen", LR_ALBEDO_CELLS, LR_ALBEDO_CELLS, 1, sheen_at);
    write_table(file, "albedo_glass", LR_GLASS_COLUMNS, LR_GLASS_ROWS,
                LR_GLASS_INTO + LR_GLASS_OUT_OF, glass_at);
    if (fclose(file) == 0)
        return 0;
    perror(argv[1]);
    return 1;
}
