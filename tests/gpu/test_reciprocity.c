/* The lobes of materials for paths with light and viewer exchanged, and against textbook formulas
 * in double precision. */
#include <complex.h>

#include "bsdf_tests.h"

/* A black mirror under a clear coat, which is one GGX lobe that nothing is added to. */
static lr_material coat(double roughness)
{
    lr_material m = material(LR_MODEL_PBR, 0);
    m.metallic = 1;
    m.clearcoat = 1;
    m.clearcoat_roughness = roughness;
    return m;
}

/* ---- Light and viewer exchanged ------------------------------------------------------------ */

enum { WAYS = 24 };

/* f |cos wi| from each of these directions to each. Where `glass`, every other one is below. */
static double values[WAYS][WAYS];
static vec3 ways[WAYS];

static void exchange(harness *h, uint32_t material, double least, bool glass)
{
    for (int i = 0; i < WAYS; i++) {
        double along = (i + 0.5) / WAYS;
        ways[i] = spherical(least + (1 - least) * along * along, 2.4 * i);
        if (glass && i % 2)
            ways[i].z = -ways[i].z;
    }
    for (int i = 0; i < WAYS; i++) {
        vec3 seen[WAYS], wo = ways[i];
        bool below = wo.z < 0;
        for (int k = 0; k < WAYS; k++) {
            seen[k] = ways[k];
            seen[k].z = below ? -seen[k].z : seen[k].z;
        }
        wo.z = fabsf(wo.z);
        evaluate(h, seen_along(wo, material, below ? from_glass : from_air, glass), seen, WAYS);
        for (int k = 0; k < WAYS; k++)
            values[i][k] = found[k].a.x;
    }
}

/* Largest and smallest of f(i, k) / f(k, i), where light comes through by the square of the
 * indices. */
static void check_reciprocal(const char *name, bool times_cosine, double tolerance)
{
    double worst = 0;
    int pairs = 0;
    for (int i = 0; i < WAYS; i++)
        for (int k = 0; k < i; k++) {
            double a = values[i][k], b = values[k][i];
            if (!times_cosine) {
                a /= fabs(ways[k].z);
                b /= fabs(ways[i].z);
            }
            double ior_i = ways[i].z < 0 ? 1.5 : 1, ior_k = ways[k].z < 0 ? 1.5 : 1;
            a /= ior_i * ior_i;
            b /= ior_k * ior_k;
            if (fmax(a, b) < 1e-5)
                continue;
            pairs++;
            worst = fmax(worst, fabs(a - b) / fmax(a, b));
        }
    print_message("%s: %d pairs, differ by at most %.1e\n", name, pairs, worst);
    assert_true(pairs > 20);
    assert_true(worst <= tolerance);
}

/* Kolmogorov's criterion: around three directions both ways. It holds where what breaks reciprocity
 * is a factor of the viewer's direction alone. */
static void check_cycles(const char *name, double tolerance)
{
    double worst = 0;
    int cycles = 0;
    for (int i = 0; i < WAYS; i++)
        for (int k = 0; k < i; k++)
            for (int l = 0; l < k; l++) {
                double a = values[i][k] * values[k][l] * values[l][i];
                double b = values[i][l] * values[l][k] * values[k][i];
                if (fmax(a, b) < 1e-12)
                    continue;
                cycles++;
                worst = fmax(worst, fabs(a - b) / fmax(a, b));
            }
    print_message("%s: %d cycles, differ by at most %.1e\n", name, cycles, worst);
    assert_true(cycles > 100);
    assert_true(worst <= tolerance);
}

static void test_reciprocity(void **state)
{
    enum { LAMBERT, EON, COAT, NARROW, CLOTH, METAL, WHITE, CLEAR, FROSTED, BLINN, PHONG, COUNT };
    lr_material m[COUNT] = {
        [LAMBERT] = material(LR_MODEL_DIFFUSE, 0.5),
        [EON] = rough(LR_MODEL_DIFFUSE, 0.7, 0.8),
        [COAT] = coat(0.6),
        [NARROW] = coat(0.25),
        [CLOTH] = coat(0),
        [METAL] = rough(LR_MODEL_CONDUCTOR, 1, 0.6),
        [WHITE] = rough(LR_MODEL_CONDUCTOR, 1, 0.8),
        [CLEAR] = rough(LR_MODEL_DIELECTRIC, 1, 0.2),
        [FROSTED] = rough(LR_MODEL_DIELECTRIC, 1, 0.7),
        [BLINN] = classic(LR_HIGHLIGHT_BLINN),
        [PHONG] = classic(LR_HIGHLIGHT_PHONG),
    };
    m[CLOTH].clearcoat = 0;
    m[CLOTH].sheen = (lr_color){0.2, 0.2, 0.2};
    m[CLOTH].sheen_roughness = 0.6;
    m[METAL].eta = (lr_color){0.2, 0.9, 1.1};
    m[METAL].k = (lr_color){3.9, 2.4, 2.1};
    harness h;
    open_harness(&h, *state, m, COUNT);
    static const char *const names[] = {
        "Lambert",       "EON",   "clear coat",  "narrow clear coat",
        "sheen",         "metal", "white metal", "clear, steep",
        "frosted glass", "Blinn", "Phong"};
    for (uint32_t i = LAMBERT; i <= CLOTH; i++) {
        exchange(&h, i, 0.02, false);
        check_reciprocal(names[i], false, 2e-4);
    }
    /* What microfacets pass on to each other is made up for by the viewer's direction. */
    for (uint32_t i = METAL; i <= WHITE; i++) {
        exchange(&h, i, 0.02, false);
        check_cycles(names[i], 2e-4);
    }
    exchange(&h, FROSTED, 0.02, true);
    check_cycles(names[FROSTED], 2e-3);
    /* There is next to nothing to make up for. */
    exchange(&h, CLEAR, 0.6, true);
    check_reciprocal(names[CLEAR], false, 0.01);
    /* Highlights have the lamp's cosine in them. */
    for (uint32_t i = BLINN; i <= PHONG; i++) {
        exchange(&h, i, 0.02, false);
        check_reciprocal(names[i], true, 2e-4);
    }
    close_harness(&h);
}

/* ---- Formulas ------------------------------------------------------------------------------ */

/* Walter et al. (2007), equation 33, and Smith's Lambda. */
static double facets(double alpha, double cosine)
{
    double tan2 = 1 / (cosine * cosine) - 1, wide = alpha * alpha + tan2;
    return alpha * alpha / (PI * pow(cosine, 4) * wide * wide);
}

static double lambda(double alpha, double cosine)
{
    return (sqrt(1 + alpha * alpha * (1 / (cosine * cosine) - 1)) - 1) / 2;
}

static double fresnel(double c1, double n1, double n2)
{
    double s2 = n1 / n2 * sqrt(1 - c1 * c1);
    if (s2 >= 1)
        return 1;
    double c2 = sqrt(1 - s2 * s2), rs = (n1 * c1 - n2 * c2) / (n1 * c1 + n2 * c2);
    double rp = (n1 * c2 - n2 * c1) / (n1 * c2 + n2 * c1);
    return (rs * rs + rp * rp) / 2;
}

/* f |cos wi| of rough glass that nothing is made up for; equations 20 and 21. */
static double glass_value(vec3 wo, vec3 wi, double alpha, double no, double ni)
{
    bool back = wi.z > 0;
    double so = back ? 1 : no, si = back ? 1 : ni;
    double h[3] = {so * wo.x + si * wi.x, so * wo.y + si * wi.y, so * wo.z + si * wi.z};
    double length = copysign(sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]), h[2]);
    for (int i = 0; i < 3; i++)
        h[i] /= length;
    double o = wo.x * h[0] + wo.y * h[1] + wo.z * h[2], i = wi.x * h[0] + wi.y * h[1] + wi.z * h[2];
    if (o <= 0 || (!back && i >= 0))
        return 0;
    double f = fresnel(o, no, ni), d = facets(alpha, h[2]);
    double lo = lambda(alpha, wo.z), li = lambda(alpha, fabs(wi.z)), g = 1 / (1 + lo + li);
    if (back)
        return f * d * g / (4 * wo.z);
    double bent = no * o + ni * i;
    /* Radiance is what comes, so it is no^2 where the equation has ni^2. */
    return fabs(o * i / wo.z) * no * no * (1 - f) * g * d / (bent * bent);
}

/* Values against `glass_value` up to a factor that depends on wo alone. */
static void check_glass(harness *h, uint32_t material, double alpha, view sides, double cosine)
{
    enum { COUNT = 2048 };
    static vec3 wi[COUNT];
    for (int i = 0; i < COUNT; i++)
        wi[i] = spherical(2 * (i + 0.5) / COUNT - 1, 2.399963 * i);
    vec3 wo = spherical(cosine, 1);
    evaluate(h, seen_along(wo, material, sides, true), wi, COUNT);
    double ours = 0, theirs = 0, worst = 0;
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < COUNT; i++) {
            double expected = glass_value(wo, wi[i], alpha, sides.ior1, sides.ior2);
            if (pass == 0) {
                ours += found[i].a.x;
                theirs += expected;
            } else {
                worst = fmax(worst, fabs(found[i].a.x * theirs / ours - expected) /
                                        fmax(expected, 1e-3 * theirs / COUNT));
            }
        }
    print_message("glass %.2f, cosine %.2f: %.4f of the formula, differs by at most %.1e\n",
                  sides.ior1, cosine, ours / theirs, worst);
    assert_true(ours / theirs >= 0.999);
    assert_true(worst < 5e-3); /* single precision near the critical angle */
}

static void test_formulas(void **state)
{
    enum { COUNT = 1024 };
    static vec3 wi[COUNT];
    const double roughness = 0.6, alpha = roughness * roughness;
    lr_material m[] = {coat(roughness), rough(LR_MODEL_DIELECTRIC, 1, roughness)};
    harness h;
    open_harness(&h, *state, m, 2);
    for (int c = 0; c < 3; c++) {
        double cosine = (double[]){0.9, 0.5, 0.1}[c];
        vec3 wo = spherical(cosine, 1);
        for (int i = 0; i < COUNT; i++)
            wi[i] = spherical((i + 0.5) / COUNT, 2.399963 * i);
        evaluate(&h, seen_along(wo, 0, from_air, false), wi, COUNT);
        double worst = 0;
        for (int i = 0; i < COUNT; i++) {
            vec3 sum = {wo.x + wi[i].x, wo.y + wi[i].y, wo.z + wi[i].z};
            double length = sqrt(dot(sum, sum)), facing = dot(wo, sum) / length;
            double f = 0.04 + 0.96 * pow(1 - facing, 5);
            double g = 1 / (1 + lambda(alpha, wo.z) + lambda(alpha, wi[i].z));
            double expected = f * g * facets(alpha, sum.z / length) / (4 * wo.z);
            worst = fmax(worst, fabs(found[i].a.x / expected - 1));
        }
        print_message("clear coat, cosine %.2f: differs by at most %.1e\n", cosine, worst);
        assert_true(worst < 1e-4);
        check_glass(&h, 1, alpha, from_air, cosine);
        check_glass(&h, 1, alpha, from_glass, cosine);
    }
    close_harness(&h);
}

/* Fresnel's equations for a refractive index of n + i k, in complex numbers. */
static double metal_value(double cosine, double complex index)
{
    double complex c2 = csqrt(1 - (1 - cosine * cosine) / (index * index));
    double rs = cabs((cosine - index * c2) / (cosine + index * c2));
    double rp = cabs((index * cosine - c2) / (index * cosine + c2));
    return (rs * rs + rp * rp) / 2;
}

static void test_metals(void **state)
{
    lr_material m = material(LR_MODEL_CONDUCTOR, 1);
    m.eta = (lr_color){0.2, 0.9, 2.9};
    m.k = (lr_color){3.9, 2.4, 3.1};
    harness h;
    open_harness(&h, *state, &m, 1);
    for (int i = 0; i < 12; i++) {
        double cosine = (i / 2 + 0.5) / 6, ior = i % 2 ? 1.33 : 1;
        asked.view =
            seen_along(spherical(cosine, 1), 0, (view){.ior1 = (float)ior, .ior2 = 1}, false);
        ask(&h, SAMPLE, LR_GROUP_SIZE, 0);
        assert_near(found[0].b.x, metal_value(cosine, (0.2 + 3.9 * I) / ior), 1e-5);
        assert_near(found[0].b.y, metal_value(cosine, (0.9 + 2.4 * I) / ior), 1e-5);
        assert_near(found[0].b.z, metal_value(cosine, (2.9 + 3.1 * I) / ior), 1e-5);
    }
    close_harness(&h);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_reciprocity),
        cmocka_unit_test(test_formulas),
        cmocka_unit_test(test_metals),
        cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device, NULL);
}
