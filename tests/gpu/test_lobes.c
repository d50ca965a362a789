/* The lobes of materials for paths: narrow ones against their density, weights against values, and
 * all at the limits of directions. */
#include "bsdf_tests.h"

/* ---- Narrow lobes -------------------------------------------------------------------------- */

enum { RINGS = 24, SECTORS = 24, CELLS = RINGS * SECTORS };

/* Directions around another: rings grow from `width` by the same factor each. */
typedef struct target {
    double z[3], x[3], y[3], width;
} target;

static target target_at(vec3 d, double width)
{
    target t = {.z = {d.x, d.y, d.z}, .width = width};
    double length = sqrt(t.z[0] * t.z[0] + t.z[2] * t.z[2]);
    t.x[0] = t.z[2] / length;
    t.x[2] = -t.z[0] / length;
    for (int i = 0; i < 3; i++)
        t.y[i] = t.z[(i + 1) % 3] * t.x[(i + 2) % 3] - t.z[(i + 2) % 3] * t.x[(i + 1) % 3];
    return t;
}

static double ring_end(const target *t, int ring)
{
    return ring < 0 ? 0 : t->width * pow(PI / t->width, ring / (RINGS - 1.0));
}

static uint32_t target_cell(const target *t, vec4 d)
{
    double x = d.x * t->x[0] + d.y * t->x[1] + d.z * t->x[2];
    double y = d.x * t->y[0] + d.y * t->y[1] + d.z * t->y[2];
    double z = d.x * t->z[0] + d.y * t->z[1] + d.z * t->z[2];
    double turn = atan2(y, x) / (2 * PI), from = atan2(hypot(x, y), z);
    int ring =
        from <= t->width ? 0 : (int)ceil(log(from / t->width) / log(PI / t->width) * (RINGS - 1));
    int sector = (int)((turn - floor(turn)) * SECTORS);
    return (uint32_t)((ring < RINGS ? ring : RINGS - 1) * SECTORS + sector % SECTORS);
}

/* The density on the side of `t` integrated over the cells. */
static void integrate_target(harness *h, const target *t, double expected[CELLS])
{
    static double part[RINGS * FINE];
    uint32_t count = 0;
    for (int i = 0; i < RINGS * FINE; i++) {
        double begin = ring_end(t, i / FINE - 1), end = ring_end(t, i / FINE);
        double step = (end - begin) / FINE;
        for (int k = 0; k < SECTORS * FINE; k++) {
            double from = begin + step * (i % FINE + net_place(k % FINE));
            double angle = 2 * PI * (k + net_place(i % FINE)) / (SECTORS * FINE), d[3];
            for (int j = 0; j < 3; j++)
                d[j] =
                    cos(from) * t->z[j] + sin(from) * (cos(angle) * t->x[j] + sin(angle) * t->y[j]);
            asked.ways[count++] = (way){{(float)d[0], (float)d[1], (float)d[2]}, 0.5f};
        }
        part[i] = step;
    }
    ask(h, EVALUATE, count, 0);
    memset(expected, 0, CELLS * sizeof *expected);
    count = 0;
    for (int i = 0; i < RINGS * FINE; i++)
        for (int k = 0; k < SECTORS * FINE; k++, count++) {
            double begin = ring_end(t, i / FINE - 1);
            double from = begin + part[i] * (i % FINE + net_place(k % FINE));
            if ((asked.ways[count].wi[2] > 0) == (t->z[2] > 0))
                expected[i / FINE * SECTORS + k / FINE] +=
                    found[count].a.w * sin(from) * part[i] * 2 * PI / (SECTORS * FINE);
        }
}

static void check_narrow(harness *h, const char *name, view seen, vec3 centre, double alpha)
{
    static double expected[CELLS], counted[CELLS];
    target t = target_at(centre, alpha / 4);
    asked.view = seen;
    integrate_target(h, &t, expected);
    ask(h, SAMPLE, MOST, 0);
    memset(counted, 0, sizeof counted);
    for (uint32_t i = 0; i < MOST; i++)
        if (is_spread(found[i]) && (found[i].a.z > 0) == (centre.z > 0))
            counted[target_cell(&t, found[i].a)]++;
    check_counts(name, expected, counted, CELLS);
}

static void test_narrow(void **state)
{
    enum { LEVELS = 4, COUNT = 2 * LEVELS };
    static const double alphas[LEVELS] = {1.05e-3, 4e-3, 0.015, 0.05}, at[] = {0.95, 0.4};
    lr_material m[COUNT];
    for (int i = 0; i < LEVELS; i++) {
        m[i] = rough(LR_MODEL_CONDUCTOR, 1, sqrt(alphas[i]));
        m[LEVELS + i] = rough(LR_MODEL_DIELECTRIC, 1, sqrt(alphas[i]));
    }
    harness h;
    open_harness(&h, *state, m, COUNT);
    for (uint32_t i = 0; i < COUNT; i++)
        for (int c = 0; c < 2; c++)
            for (int from = 0; from < (i < LEVELS ? 1 : 2); from++) {
                double cosine = at[c], alpha = alphas[i % LEVELS];
                vec3 wo = spherical(cosine, 0.7), mirrored = {-wo.x, -wo.y, wo.z};
                view sides = from ? from_glass : from_air;
                view seen = seen_along(wo, i, sides, i >= LEVELS);
                char name[64];
                snprintf(name, sizeof name, "%s, alpha %.4f, cosine %.2f",
                         i < LEVELS ? "metal" : "glass", alpha, cosine);
                check_narrow(&h, name, seen, mirrored, alpha);
                double ratio = sides.ior1 / sides.ior2,
                       c2 = 1 - ratio * ratio * (1 - cosine * cosine);
                if (i < LEVELS || c2 <= 0)
                    continue;
                snprintf(name, sizeof name, "through glass, alpha %.4f, cosine %.2f", alpha,
                         cosine);
                vec3 on = {(float)(-ratio * wo.x), (float)(-ratio * wo.y), (float)-sqrt(c2)};
                check_narrow(&h, name, seen, on, alpha);
            }
    close_harness(&h);
}

/* ---- Weights, and the limits of directions ------------------------------------------------- */

enum { KINDS = 9, ROUGHNESSES = 4 };

/* Every kind of material at each roughness. */
static void all_materials(lr_material m[KINDS * ROUGHNESSES])
{
    for (int r = 0; r < ROUGHNESSES; r++) {
        double roughness = (double[]){0, 0.033, 0.4, 1}[r];
        lr_material *at = &m[r * KINDS];
        at[0] = rough(LR_MODEL_DIFFUSE, 1, roughness);
        at[1] = rough(LR_MODEL_CONDUCTOR, 1, roughness);
        at[2] = at[1];
        at[2].eta = (lr_color){0.2, 0.9, 1.1};
        at[2].k = (lr_color){3.9, 2.4, 2.1};
        at[3] = rough(LR_MODEL_DIELECTRIC, 1, roughness);
        at[4] = rough(LR_MODEL_THIN_GLASS, 1, roughness);
        at[5] = rough(LR_MODEL_PBR, 1, roughness);
        at[6] = at[5];
        at[6].metallic = 0.5;
        at[6].clearcoat = 1;
        at[6].clearcoat_roughness = 1 - roughness;
        at[6].sheen = (lr_color){1, 0.5, 0.25};
        at[6].sheen_roughness = roughness;
        at[7] = classic(r % 2 ? LR_HIGHLIGHT_PHONG : LR_HIGHLIGHT_BLINN);
        at[7].diffuse = (lr_color){0.5, 0.5, 0.5};
        at[7].shininess = (double[]){1, 20, 1000, 0.5}[r];
        at[8] = at[5];
        at[8].transmission = 0.5;
    }
}

static bool is_sound(vec4 a)
{
    const float v[] = {a.x, a.y, a.z, a.w};
    for (int i = 0; i < 4; i++)
        if (!(v[i] >= 0 && v[i] < 1e20f))
            return false;
    return true;
}

static const double limits[] = {1, 0.7, 0.1, 1e-3, 1e-5, 2e-7, 0};

/* Evaluated along, against, mirrored and grazing. Returns how many directions gave light. */
static int check_limits(harness *h, view seen)
{
    enum { COUNT = 64 };
    vec3 wo = {seen.wo[0], seen.wo[1], seen.wo[2]},
         wi[COUNT] = {
             wo,        {-wo.x, -wo.y, -wo.z}, {-wo.x, -wo.y, wo.z}, {wo.x, wo.y, -wo.z}, {0, 0, 1},
             {0, 0, -1}};
    int count = 6, bright = 0;
    for (size_t i = 0; i < sizeof limits / sizeof *limits; i++)
        for (int k = 0; k < 8; k++) {
            vec3 d = spherical(limits[i], k / 2 * PI / 2 + atan2(wo.y, wo.x));
            d.z = k % 2 ? -d.z : d.z;
            wi[count++] = d;
        }
    assert_in_range(count, 1, COUNT);
    evaluate(h, seen, wi, (uint32_t)count);
    bool glass =
        seen.material % KINDS == 3 || seen.material % KINDS == 4 || seen.material % KINDS == 8;
    for (int i = 0; i < count; i++) {
        if (!is_sound(found[i].a))
            fail_msg("material %u seen from cosine %g, lit from (%g %g %g): %g %g %g, density %g",
                     seen.material, seen.wo[2], wi[i].x, wi[i].y, wi[i].z, found[i].a.x,
                     found[i].a.y, found[i].a.z, found[i].a.w);
        bright += found[i].a.x > 0;
        if (wi[i].z <= 0 && !glass) {
            assert_true(found[i].a.x == 0);
            assert_true(found[i].a.w == 0);
        }
    }
    return bright;
}

/* Samples are unit vectors, and bring value over density. */
static void check_weights(harness *h, view seen)
{
    enum { COUNT = 512 };
    static answer samples[COUNT];
    static vec3 wi[COUNT];
    asked.view = seen;
    ask(h, SAMPLE, COUNT, 0);
    memcpy(samples, found, sizeof samples);
    for (int i = 0; i < COUNT; i++) {
        vec4 d = samples[i].a, weight = samples[i].b;
        wi[i] = (vec3){d.x, d.y, d.z};
        uint32_t kind = bits_of(weight.w);
        weight.w = 0;
        assert_true(is_sound(weight));
        if (kind)
            assert_near(dot(wi[i], wi[i]), 1, 1e-5);
        if (!kind)
            assert_true(weight.x == 0 && weight.y == 0 && weight.z == 0);
    }
    if (seen.material % KINDS == 8)
        return; /* of which part it is, its own number says */
    evaluate(h, seen, wi, COUNT);
    for (int i = 0; i < COUNT; i++)
        if (is_spread(samples[i])) {
            assert_true(found[i].a.w == samples[i].a.w);
            assert_near(samples[i].b.x, found[i].a.x / found[i].a.w,
                        1e-5 * (samples[i].b.x + 1e-3));
            assert_near(samples[i].b.z, found[i].a.z / found[i].a.w,
                        1e-5 * (samples[i].b.z + 1e-3));
        }
}

static void test_limits(void **state)
{
    lr_material m[KINDS * ROUGHNESSES];
    all_materials(m);
    harness h;
    open_harness(&h, *state, m, KINDS * ROUGHNESSES);
    for (uint32_t i = 0; i < KINDS * ROUGHNESSES; i++) {
        int bright = 0;
        for (size_t c = 0; c + 1 < sizeof limits / sizeof *limits; c++)
            for (int from = 0; from < 3; from++) {
                view seen = seen_along(spherical(limits[c], 0.7), i,
                                       from == 1 ? from_glass : from_air, from < 2);
                bright += check_limits(&h, seen);
                check_weights(&h, seen);
            }
        bool mirror = i == 1 || i == 2 || i == 3 || i == 4;
        if (!mirror && bright < 20)
            fail_msg("material %u is dark", i);
    }
    close_harness(&h);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_narrow),
        cmocka_unit_test(test_limits),
        cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device, NULL);
}
