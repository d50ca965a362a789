/* make_albedo OUTPUT: the tables of shaders/bsdf_table.glsl as a header. Everything in them is made
 * with + - * / and square roots, so that every machine makes the same. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>

#include "base/exact.h"
#include "base/vec.h"
#include "gpu_layout.h"

#define AROUND 32 /* steps of the integrals, by angle */
#define ALONG 192 /* ... and by height */

static double cosines[AROUND], sines[AROUND];

static double square(double x)
{
    return x * x;
}

/* As bsdf_ggx.glsl has it. */
static double slant(double alpha, double z)
{
    return sqrt(square(alpha) + (1 - square(alpha)) * square(z));
}

/* What becomes of light that meets a visible microfacet: its cosine with the microfacet, and that
 * of the reflected ray with the surface's normal. */
typedef struct bounce {
    double weight; /* the microfacet's share of all visible ones */
    double facing, tilt, reflected;
} bounce;

/* The midpoints of the spherical caps of Dupuy and Benyoub (2023), finer towards the microfacets
 * that stand so steep that light does not get out. */
static bounce bounce_at(double cosine, double alpha, int i, int k)
{
    double sine = sqrt(fmax(0, 1 - square(cosine))), x = alpha * sine;
    double length = sqrt(square(x) + square(cosine)), z = cosine / length;
    double from_rim = square((i + 0.5) / ALONG), step = 2 * (i + 0.5) / ALONG;
    double height = from_rim * (1 + z) - z, width = sqrt(fmax(0, 1 - square(height)));
    double hx = alpha * (width * cosines[k] + x / length), hy = alpha * width * sines[k];
    double hz = height + z, inv = 1 / sqrt(square(hx) + square(hy) + square(hz));
    double facing = fmin((sine * hx + cosine * hz) * inv, 1);
    return (bounce){step / (ALONG * AROUND), facing, hz * inv, 2 * facing * hz * inv - cosine};
}

/* The share that gets out towards a cosine: ggx_escape in bsdf_ggx.glsl. */
static double escape(double alpha, double from, double to)
{
    double slant_from = slant(alpha, from);
    return to <= 0 ? 0 : to * (from + slant_from) / (to * slant_from + from * slant(alpha, to));
}

/* facet_place in bsdf_table.glsl, the other way round. */
static double cosine_at(double x, double alpha)
{
    return fmax(alpha * square(x) / (1 + alpha - square(x)), 1e-6);
}

static double alpha_at(double y)
{
    return fmax(square(y), LR_ALPHA_MIN);
}

static double ggx_at(double x, double y, double unused)
{
    double alpha = alpha_at(y), cosine = cosine_at(x, alpha), sum = unused;
    for (int i = 0; i < ALONG; i++)
        for (int k = 0; k < AROUND; k++) {
            bounce b = bounce_at(cosine, alpha, i, k);
            sum += b.weight * escape(alpha, cosine, b.reflected);
        }
    return sum;
}

static double schlick_at(double x, double y, double unused)
{
    double alpha = alpha_at(y), cosine = fmax(square(x), 1e-6), all = unused, sum = 0;
    for (int i = 0; i < ALONG; i++)
        for (int k = 0; k < AROUND; k++) {
            bounce b = bounce_at(cosine, alpha, i, k);
            double out = b.weight * escape(alpha, cosine, b.reflected), a = 1 - b.facing;
            all += out;
            sum += out * square(square(a)) * a;
        }
    return lr_exp2(lr_log2(fmax(sum / all, 1e-20)) / 5);
}

static double glass_at(double x, double y, double z)
{
    double alpha = alpha_at(y), cosine = cosine_at(x, alpha), sum = 0;
    double ratio = (1.5 - z) / (0.5 + z);
    for (int i = 0; i < ALONG; i++)
        for (int k = 0; k < AROUND; k++) {
            bounce b = bounce_at(cosine, alpha, i, k);
            double c2_squared = 1 - square(ratio) * (1 - square(b.facing));
            double c2 = sqrt(fmax(c2_squared, 0));
            double rs = (ratio * b.facing - c2) / (ratio * b.facing + c2);
            double rp = (ratio * c2 - b.facing) / (ratio * c2 + b.facing);
            double f = c2_squared <= 0 ? 1 : 0.5 * (square(rs) + square(rp));
            double through = (c2 - ratio * b.facing) * b.tilt + ratio * cosine;
            sum += b.weight * (f * escape(alpha, cosine, b.reflected) +
                               (1 - f) * escape(alpha, cosine, through));
        }
    return sum;
}

/* Light from all around, by the sheen's BRDF (bsdf_sheen.glsl). */
static double sheen_at(double x, double y, double unused)
{
    double cosine = fmax(x, 1e-6), sine = sqrt(fmax(0, 1 - square(cosine))), sum = unused;
    double power = 1 / fmax(square(y), LR_SHEEN_ALPHA_MIN);
    for (int i = 0; i < ALONG; i++) {
        double z = square((i + 0.5) / ALONG), width = sqrt(1 - square(z));
        double step = 2 * (i + 0.5) / ALONG / ALONG; /* of z */
        for (int k = 0; k < AROUND; k++) {
            double hx = sine + width * cosines[k], hy = width * sines[k], hz = cosine + z;
            double across = square(hx) + square(hy);
            double sine2 = fmin(fmax(across / (across + square(hz)), 1e-20), 1);
            double bits = lr_log2(sine2) * 0.5 * power;
            double facets = (2 + power) / 6.283185307179586 * (bits > -900 ? lr_exp2(bits) : 0);
            double v = 0.25 / (z + cosine - z * cosine);
            sum += facets * v * z * step * 6.283185307179586 / AROUND;
        }
    }
    return sum;
}

/* `layers` squares of the values at the corners of `cells` cells a side. */
static void write_table(FILE *file, const char *name, int cells, int layers,
                        double (*at)(double x, double y, double z))
{
    fprintf(file, "static const float %s[%d] = {", name, layers * (cells + 1) * (cells + 1));
    for (int l = 0; l < layers; l++)
        for (int j = 0; j <= cells; j++)
            for (int i = 0; i <= cells; i++)
                fprintf(
                    file, "%s%.8ff,", i % 8 ? " " : "\n    ",
                    at((double)i / cells, (double)j / cells, layers > 1 ? l / (layers - 1.0) : 0));
    fprintf(file, "\n};\n");
}

int main(int argc, char **argv)
{
    FILE *file = argc == 2 ? fopen(argv[1], "w") : NULL;
    if (!file) {
        perror(argc == 2 ? argv[1] : "usage: make_albedo OUTPUT");
        return 2;
    }
    for (int k = 0; k < AROUND; k++)
        lr_sincos_degrees((k + 0.5) * 180 / AROUND, &sines[k], &cosines[k]);
    write_table(file, "albedo_ggx", LR_ALBEDO_CELLS, 1, ggx_at);
    write_table(file, "albedo_schlick", LR_ALBEDO_CELLS, 1, schlick_at);
    write_table(file, "albedo_sheen", LR_ALBEDO_CELLS, 1, sheen_at);
    write_table(file, "albedo_glass", LR_GLASS_CELLS, LR_GLASS_LAYERS, glass_at);
    if (fclose(file) == 0)
        return 0;
    perror(argv[1]);
    return 1;
}
