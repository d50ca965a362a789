/* Materials of the path integrator: what they reflect and let through in all, that their samples
 * come as their density says, and formulas against double precision. */
#include "bsdf_tests.h"

#define LEVELS 16 /* of roughness, from 0 to 1 */

/* ---- The white furnace --------------------------------------------------------------------- */

typedef struct energy {
    double reflected, transmitted;
} energy;

/* Of light that is 1 all around, in the greatest channel. */
static energy energy_of(harness *h, view seen)
{
    enum { COUNT = 64, EACH = 2048 };
    asked.view = seen;
    ask(h, SUM, COUNT, EACH);
    double sums[2][3] = {{0}};
    for (int i = 0; i < COUNT; i++) {
        const vec4 *a[] = {&found[i].a, &found[i].b};
        for (int k = 0; k < 2; k++) {
            sums[k][0] += a[k]->x;
            sums[k][1] += a[k]->y;
            sums[k][2] += a[k]->z;
        }
    }
    double ratio = seen.solid ? seen.ior1 / seen.ior2 : 1, all = COUNT * EACH;
    return (energy){fmax(sums[0][0], fmax(sums[0][1], sums[0][2])) / all,
                    fmax(sums[1][0], fmax(sums[1][1], sums[1][2])) / all / (ratio * ratio)};
}

static const double cosines[] = {1, 0.9, 0.7, 0.5, 0.3, 0.15, 0.05, 0.01};
enum { COSINES = sizeof cosines / sizeof *cosines };

/* Each material at all levels of roughness, seen from all cosines. */
static void furnace(lr_device *device, const char *name, lr_material m, view seen)
{
    lr_material levels[LEVELS];
    for (int i = 0; i < LEVELS; i++) {
        levels[i] = m;
        levels[i].roughness = i / (LEVELS - 1.0);
    }
    harness h;
    open_harness(&h, device, levels, LEVELS);
    double low = 9, high = 0, low_at[2] = {0}, high_at[2] = {0};
    for (uint32_t i = 0; i < LEVELS; i++)
        for (int c = 0; c < COSINES; c++) {
            view now = view_at(i, cosines[c]);
            now.ior1 = seen.ior1;
            now.ior2 = seen.ior2;
            now.solid = seen.solid;
            energy e = energy_of(&h, now);
            double sum = e.reflected + e.transmitted;
            if (!(sum >= low)) {
                low = sum;
                low_at[0] = levels[i].roughness;
                low_at[1] = cosines[c];
            }
            if (!(sum <= high)) {
                high = sum;
                high_at[0] = levels[i].roughness;
                high_at[1] = cosines[c];
            }
        }
    close_harness(&h);
    print_message("%s: %.5f (roughness %.2f, cosine %.2f) to %.5f (roughness %.2f, cosine %.2f)\n",
                  name, low, low_at[0], low_at[1], high, high_at[0], high_at[1]);
    assert_true(low >= 0.99);
    assert_true(high <= 1.001);
}

static void test_furnace(void **state)
{
    view thin = {.ior1 = 1, .ior2 = 1.5f}, into = {.ior1 = 1, .ior2 = 1.5f, .solid = 1},
         out_of = {.ior1 = 1.5f, .ior2 = 1, .solid = 1};
    furnace(*state, "diffuse", material(LR_MODEL_DIFFUSE, 1), thin);
    furnace(*state, "conductor", material(LR_MODEL_CONDUCTOR, 1), thin);
    for (int i = 0; i < 4; i++) {
        float ior = (float[]){1.1f, 1.33f, 1.5f, 2.4f}[i];
        char name[32];
        snprintf(name, sizeof name, "dielectric, into %.2f", ior);
        into.ior2 = ior;
        furnace(*state, name, material(LR_MODEL_DIELECTRIC, 1), into);
        snprintf(name, sizeof name, "dielectric, out of %.2f", ior);
        out_of.ior1 = ior;
        furnace(*state, name, material(LR_MODEL_DIELECTRIC, 1), out_of);
    }
    into.ior2 = 1.5f;
    furnace(*state, "dielectric, thin", material(LR_MODEL_DIELECTRIC, 1), thin);
    furnace(*state, "thin glass", material(LR_MODEL_THIN_GLASS, 1), thin);
    lr_material m = material(LR_MODEL_PBR, 1);
    furnace(*state, "pbr", m, thin);
    m.metallic = 1;
    furnace(*state, "pbr, metal", m, thin);
    m.metallic = 0.5;
    m.clearcoat = 1;
    m.clearcoat_roughness = 0.4;
    furnace(*state, "pbr, half metal, coated", m, thin);
    m.sheen = (lr_color){1, 0.5, 0.25};
    m.sheen_roughness = 0.3;
    furnace(*state, "pbr, half metal, coated, with sheen", m, thin);
    m = material(LR_MODEL_PBR, 1);
    m.transmission = 0.5;
    furnace(*state, "pbr, half glass", m, into);
}

/* ---- Samples against their density --------------------------------------------------------- */

enum { ACROSS = 24, AROUND = 24, CELLS = ACROSS * AROUND };

static uint32_t cell_of(const float wi[3])
{
    double turn = atan2(wi[1], wi[0]) / (2 * PI);
    int across = (int)((wi[2] * 0.5 + 0.5) * ACROSS), around = (int)((turn - floor(turn)) * AROUND);
    across = across < 0 ? 0 : across >= ACROSS ? ACROSS - 1 : across;
    return (uint32_t)(across * AROUND + (around >= AROUND ? 0 : around));
}

/* The density integrated over the cells, by FINE^2 points of each. */
static void integrate(harness *h, double expected[CELLS])
{
    uint32_t count = 0;
    for (int i = 0; i < ACROSS * FINE; i++)
        for (int k = 0; k < AROUND * FINE; k++) {
            double z = 2 * (i + net_place(k)) / (ACROSS * FINE) - 1, width = sqrt(1 - z * z);
            double angle = 2 * PI * (k + net_place(i)) / (AROUND * FINE);
            asked.ways[count++] =
                (way){{(float)(width * cos(angle)), (float)(width * sin(angle)), (float)z}, 0.5f};
        }
    assert_int_equal(count % LR_GROUP_SIZE, 0);
    ask(h, EVALUATE, count, 0);
    memset(expected, 0, CELLS * sizeof *expected);
    count = 0;
    for (int i = 0; i < ACROSS * FINE; i++)
        for (int k = 0; k < AROUND * FINE; k++, count++)
            expected[i / FINE * AROUND + k / FINE] +=
                found[count].a.w * 4 * PI / (CELLS * FINE * FINE);
}

static void check_samples(harness *h, const char *name, view seen)
{
    static double expected[CELLS], counted[CELLS];
    asked.view = seen;
    integrate(h, expected);
    ask(h, SAMPLE, MOST, 0);
    memset(counted, 0, sizeof counted);
    double worst = 0;
    for (uint32_t i = 0; i < MOST; i++)
        if (is_spread(found[i])) {
            float wi[] = {found[i].a.x, found[i].a.y, found[i].a.z};
            counted[cell_of(wi)]++;
            worst = fmax(worst, fabs(sqrt(wi[0] * wi[0] + wi[1] * wi[1] + wi[2] * wi[2]) - 1));
        }
    assert_true(worst < 1e-5);
    check_counts(name, expected, counted, CELLS);
}

static void test_samples(void **state)
{
    enum { DIFFUSE, METAL, ROUGHER, GLASS, PBR, CLASSIC, PHONG, CLOTH, COUNT };
    lr_material m[COUNT];
    m[DIFFUSE] = material(LR_MODEL_DIFFUSE, 0.5);
    m[DIFFUSE].roughness = 0.7;
    m[METAL] = material(LR_MODEL_CONDUCTOR, 0.9);
    m[METAL].eta = (lr_color){0.2, 0.9, 1.1};
    m[METAL].k = (lr_color){3.9, 2.4, 2.1};
    m[METAL].roughness = 0.55;
    m[ROUGHER] = material(LR_MODEL_CONDUCTOR, 0.9);
    m[ROUGHER].roughness = 0.9;
    m[GLASS] = material(LR_MODEL_DIELECTRIC, 1);
    m[GLASS].roughness = 0.6;
    m[PBR] = material(LR_MODEL_PBR, 0.6);
    m[PBR].roughness = 0.7;
    m[PBR].metallic = 0.4;
    m[PBR].clearcoat = 1;
    m[PBR].clearcoat_roughness = 0.5;
    m[CLASSIC] = material(LR_MODEL_CLASSIC, 0.6);
    m[CLASSIC].diffuse = (lr_color){0.5, 0.5, 0.5};
    m[CLASSIC].specular = (lr_color){0.5, 0.5, 0.5};
    m[CLASSIC].shininess = 20;
    m[PHONG] = m[CLASSIC];
    m[PHONG].highlight = LR_HIGHLIGHT_PHONG;
    m[CLOTH] = material(LR_MODEL_PBR, 0.6);
    m[CLOTH].roughness = 0.8;
    m[CLOTH].sheen = (lr_color){1, 1, 1};
    m[CLOTH].sheen_roughness = 0.5;
    static const char *const names[] = {"rough matt",     "metal",     "rougher metal",
                                        "glass",          "pbr",       "classic, Blinn",
                                        "classic, Phong", "pbr, cloth"};
    harness h;
    open_harness(&h, *state, m, COUNT);
    for (uint32_t i = 0; i < COUNT; i++)
        for (int k = 0; k < 3; k++) {
            view seen = view_at(i, (double[]){0.95, 0.6, 0.2}[k]);
            seen.ior2 = 1.5f;
            seen.solid = i == GLASS;
            check_samples(&h, names[i], seen);
            if (i != GLASS)
                continue;
            seen.ior1 = 1.5f;
            seen.ior2 = 1;
            check_samples(&h, "glass, from inside", seen);
            seen.ior1 = 1;
            seen.ior2 = 1.5f;
            seen.solid = 0;
            check_samples(&h, "glass, thin", seen);
        }
    close_harness(&h);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_furnace),
        cmocka_unit_test(test_samples),
        cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device, NULL);
}
