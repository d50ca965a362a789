/* The formulas of the problem sheet, and the integers around them, against double precision. */
#include "gpu_tests.h"

#include "render/pack.h"
#include "sheet.spv.h"

#define COUNT 131072u

typedef struct item {
    vec4 a, b, c;
} item;

typedef struct words {
    uint32_t x, y, z, w;
} words;

enum { REFLECT, REFRACT, SPHERE, PLANE, FRESNEL };

static item given[COUNT];
static union {
    vec4 floats[COUNT];
    words words[COUNT];
} found;

static void run(void **state, uint32_t which)
{
    run_kernel(*state, &(kernel){.words = sheet_spv,
                                 .word_count = sizeof sheet_spv / 4,
                                 .in = given,
                                 .in_size = sizeof given,
                                 .out = &found,
                                 .out_size = sizeof found,
                                 .which = which,
                                 .groups = COUNT / LR_GROUP_SIZE});
}

/* ---- Vectors ------------------------------------------------------------------------------- */

static lr_vec3 wide(vec4 v)
{
    return (lr_vec3){v.x, v.y, v.z};
}

static vec4 narrow(lr_vec3 v, double w)
{
    return (vec4){(float)v.x, (float)v.y, (float)v.z, (float)w};
}

/* A point in the cube of this half size. */
static lr_vec3 random_point(uint32_t *seed, double size)
{
    return (lr_vec3){random_between(seed, -size, size), random_between(seed, -size, size),
                     random_between(seed, -size, size)};
}

static lr_vec3 random_unit(uint32_t *seed)
{
    lr_vec3 v = random_point(seed, 1);
    while (lr_vec3_length(v) < 0.1)
        v = random_point(seed, 1);
    return lr_vec3_normalize(v);
}

/* A unit vector that arrives at a surface with the normal n. */
static lr_vec3 random_incident(uint32_t *seed, lr_vec3 n)
{
    lr_vec3 x = random_unit(seed);
    return lr_vec3_dot(x, n) > 0 ? lr_vec3_scale(x, -1) : x;
}

static double distance(lr_vec3 a, lr_vec3 b)
{
    return lr_vec3_length(lr_vec3_sub(a, b));
}

/* ---- 3.1 to 3.4 ---------------------------------------------------------------------------- */

static void test_reflection(void **state)
{
    uint32_t seed = 1;
    for (uint32_t i = 0; i < COUNT; i++) {
        lr_vec3 n = random_unit(&seed);
        given[i] = (item){.a = narrow(random_incident(&seed, n), 0), .b = narrow(n, 0)};
    }
    run(state, REFLECT);
    for (uint32_t i = 0; i < COUNT; i++) {
        lr_vec3 x = wide(given[i].a), n = wide(given[i].b), r = wide(found.floats[i]);
        double along = lr_vec3_dot(x, n);
        assert_near(found.floats[i].w, along, 2e-7);
        assert_true(distance(r, lr_vec3_sub(x, lr_vec3_scale(n, 2 * along))) < 6e-7);
        assert_near(lr_vec3_dot(r, n), -along, 6e-7); /* away again at the same angle */
        assert_near(lr_vec3_length(r), 1, 6e-7);
    }
}

/* The sheet's r = gamma x + (gamma c1 - c2) n, for c1 = -x . n. */
static lr_vec3 refract(lr_vec3 x, lr_vec3 n, double gamma, double c2)
{
    double c1 = -lr_vec3_dot(x, n);
    return lr_vec3_add(lr_vec3_scale(x, gamma), lr_vec3_scale(n, gamma * c1 - c2));
}

static void test_refraction(void **state)
{
    uint32_t seed = 2, total = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        lr_vec3 n = random_unit(&seed);
        given[i] = (item){.a = narrow(random_incident(&seed, n), random_between(&seed, 0.4, 2.5)),
                          .b = narrow(n, 0)};
    }
    run(state, REFRACT);
    for (uint32_t i = 0; i < COUNT; i++) {
        lr_vec3 x = wide(given[i].a), n = wide(given[i].b), r = wide(found.floats[i]);
        double gamma = given[i].a.w, c1 = lr_vec3_dot(x, n);
        double squared = 1 - gamma * gamma * (1 - c1 * c1);
        assert_near(found.floats[i].w, squared, 2e-6);
        if (found.floats[i].w <= 0) {
            total++;
            continue;
        }
        /* From the computed cosine, whose error grows without bound near the critical angle. */
        assert_true(distance(r, refract(x, n, gamma, sqrt(found.floats[i].w))) < 2e-6);
        if (squared > 0.01) {
            double sine = lr_vec3_length(lr_vec3_cross(x, n));
            assert_near(lr_vec3_length(lr_vec3_cross(r, n)), gamma * sine, 2e-6); /* Snell */
            assert_near(lr_vec3_length(r), 1, 1e-5);
        }
    }
    assert_true(total > COUNT / 20); /* total reflection came up */
}

/* Into glass, and out of it with the indices swapped and the normal turned: the same direction. */
static void test_refraction_there_and_back(void **state)
{
    static vec4 before[COUNT];
    uint32_t seed = 3;
    for (uint32_t i = 0; i < COUNT; i++) {
        lr_vec3 n = random_unit(&seed);
        before[i] = narrow(random_incident(&seed, n), 1 / 1.5);
        given[i] = (item){.a = before[i], .b = narrow(n, 0)};
    }
    run(state, REFRACT);
    for (uint32_t i = 0; i < COUNT; i++) {
        given[i].a = found.floats[i];
        given[i].a.w = 1.5f;
    }
    run(state, REFRACT);
    for (uint32_t i = 0; i < COUNT; i++) {
        double c1 = fabs(lr_vec3_dot(wide(before[i]), wide(given[i].b)));
        if (c1 > 0.05)
            assert_true(distance(wide(found.floats[i]), wide(before[i])) < 2e-6 / c1);
    }
    /* Inside glass the critical angle is 41.8 degrees. */
    for (uint32_t i = 0; i < COUNT; i++) {
        double angle = (i + 0.5) / COUNT * 1.5707963;
        given[i] = (item){.a = {(float)sin(angle), 0, (float)-cos(angle), 1.5f}, .b = {0, 0, 1, 0}};
    }
    run(state, REFRACT);
    for (uint32_t i = 0; i < COUNT; i++) {
        double angle = (i + 0.5) / COUNT * 90;
        if (fabs(angle - 41.8103149) > 1e-4)
            assert_int_equal(found.floats[i].w <= 0, angle > 41.8103149);
    }
}

static void test_equal_indices_go_straight(void **state)
{
    uint32_t seed = 4;
    for (uint32_t i = 0; i < COUNT; i++) {
        lr_vec3 n = random_unit(&seed);
        given[i] = (item){.a = narrow(random_incident(&seed, n), 1), .b = narrow(n, 0)};
    }
    run(state, REFRACT);
    for (uint32_t i = 0; i < COUNT; i++) {
        double c1 = fabs(lr_vec3_dot(wide(given[i].a), wide(given[i].b)));
        if (c1 > 1e-3)
            assert_true(distance(wide(found.floats[i]), wide(given[i].a)) < 3e-7 / c1);
    }
}

static void test_fresnel(void **state)
{
    uint32_t seed = 5;
    for (uint32_t i = 0; i < COUNT; i++) {
        double ior1 = random_between(&seed, 1, 3), ior2 = random_between(&seed, 1, 3);
        double c1 = random_between(&seed, 0, 1), gamma = ior1 / ior2;
        double squared = fmax(1 - gamma * gamma * (1 - c1 * c1), 0);
        given[i].a = (vec4){(float)c1, (float)sqrt(squared), (float)ior1, (float)ior2};
    }
    given[0].a = (vec4){1, 1, 1, 1.5f};
    given[1].a = (vec4){1, 1, 1.5f, 1};
    given[2].a = (vec4){1, 1, 1, 1.33f};
    given[3].a = (vec4){0, 0.74536f, 1, 1.5f};
    given[4].a = (vec4){0.5f, 0.5f, 1.5f, 1.5f};
    given[5].a = (vec4){0, 0, 1, 1}; /* 0 / 0 */
    run(state, FRESNEL);
    assert_near(found.floats[0].x, 0.04, 1e-7);
    assert_near(found.floats[1].x, 0.04, 1e-7);
    assert_near(found.floats[2].x, 0.0200593, 1e-6);
    assert_near(found.floats[3].x, 1, 1e-6);
    assert_near(found.floats[4].x, 0, 1e-12);
    assert_in_range(found.words[5].x, 0, bits_of(1));
    for (uint32_t i = 6; i < COUNT; i++) {
        double c1 = given[i].a.x, c2 = given[i].a.y, ior1 = given[i].a.z, ior2 = given[i].a.w;
        double s = (ior1 * c1 - ior2 * c2) / (ior1 * c1 + ior2 * c2);
        double p = (ior1 * c2 - ior2 * c1) / (ior1 * c2 + ior2 * c1);
        assert_near(found.floats[i].x, (s * s + p * p) / 2, 1e-6);
    }
}

/* ---- 3.5 ----------------------------------------------------------------------------------- */

static void put_sphere(uint32_t i, lr_vec3 o, lr_vec3 d, lr_vec3 center, double radius)
{
    given[i] =
        (item){.a = narrow(o, 1 / (float)radius), .b = narrow(d, 0), .c = narrow(center, radius)};
}

/* The sheet's quadratic in double. False without a real root. */
static bool sphere_roots(const item *at, double roots[2], double *half_chord)
{
    lr_vec3 d = wide(at->b), from = lr_vec3_sub(wide(at->a), wide(at->c));
    double a = lr_vec3_dot(d, d), b = 2 * lr_vec3_dot(d, from);
    double c = lr_vec3_dot(from, from) - (double)at->c.w * at->c.w;
    double disc = b * b - 4 * a * c;
    *half_chord = sqrt(fabs(disc) / (4 * a)) / at->c.w; /* in radii */
    roots[0] = (-b - sqrt(disc)) / (2 * a);
    roots[1] = (-b + sqrt(disc)) / (2 * a);
    return disc >= 0;
}

/* Compares with the roots in double. Errors grow with the distance in radii, `reach`, and near a
 * tangent with the inverse of the half chord. */
static void check_sphere(uint32_t i, double reach)
{
    double roots[2], half_chord, error = 1e-6 * (1 + reach);
    bool hit = sphere_roots(&given[i], roots, &half_chord);
    if (half_chord * half_chord < error)
        return; /* a tangent: may come out either way */
    vec4 t = found.floats[i];
    double unit = given[i].c.w / lr_vec3_length(wide(given[i].b));
    double tolerance = unit * error * (1 + 1 / half_chord);
    if (!hit) {
        assert_true(t.x < 0 && t.x == t.y);
        return;
    }
    assert_near(t.x, roots[0], tolerance);
    assert_near(t.y, roots[1], tolerance);
}

static void test_sphere(void **state)
{
    uint32_t seed = 6, hits = 0, inside = 0, behind = 0;
    static double reach[COUNT];
    for (uint32_t i = 0; i < COUNT; i++) {
        double radius = random_magnitude(&seed, -12, 12);
        lr_vec3 center = random_point(&seed, 3 * radius), o = random_point(&seed, 6 * radius);
        lr_vec3 target = lr_vec3_add(center, random_point(&seed, 1.2 * radius));
        lr_vec3 d = lr_vec3_normalize(lr_vec3_sub(target, o));
        d = lr_vec3_scale(d, random_magnitude(&seed, -8, 8) * random_sign(&seed));
        put_sphere(i, o, d, center, radius);
        reach[i] = (lr_vec3_length(o) + lr_vec3_length(center)) / radius;
    }
    run(state, SPHERE);
    for (uint32_t i = 0; i < COUNT; i++) {
        double roots[2], half_chord;
        check_sphere(i, reach[i]);
        if (!sphere_roots(&given[i], roots, &half_chord))
            continue;
        hits++;
        inside += roots[0] < 0 && roots[1] > 0;
        behind += roots[1] < 0;
    }
    assert_true(hits > COUNT / 2 && inside > 100 && behind > COUNT / 8);
}

static void test_sphere_cases(void **state)
{
    lr_vec3 zero = {0, 0, 0}, forward = {0, 0, -1};
    put_sphere(0, (lr_vec3){0, 0, 5}, forward, zero, 1);             /* in front */
    put_sphere(1, (lr_vec3){0, 0, 5}, (lr_vec3){0, 0, -2}, zero, 1); /* not a unit vector */
    put_sphere(2, zero, forward, zero, 1);                           /* from its centre */
    put_sphere(3, (lr_vec3){0, 0, -5}, forward, zero, 1);            /* behind */
    put_sphere(4, (lr_vec3){1, 0, 5}, forward, zero, 1);             /* tangent */
    put_sphere(5, (lr_vec3){1.001, 0, 5}, forward, zero, 1);         /* past it */
    put_sphere(6, (lr_vec3){0, 0, 3e-20}, forward, zero, 1e-20);     /* tiny */
    put_sphere(7, (lr_vec3){0, 0, 3e12}, forward, zero, 1e12);       /* huge */
    run(state, SPHERE);
    const double expected[8][2] = {{4, 6}, {2, 3},   {-1, 1},        {-6, -4},
                                   {5, 5}, {-1, -1}, {2e-20, 4e-20}, {2e12, 4e12}};
    for (uint32_t i = 0; i < 8; i++) {
        assert_near(found.floats[i].x, expected[i][0], 1e-6 * fabs(expected[i][0]));
        assert_near(found.floats[i].y, expected[i][1], 1e-6 * fabs(expected[i][1]));
    }
}

/* Seen from 1,000 radii, rays aimed just inside and just outside of the rim. */
static void test_sphere_far_away(void **state)
{
    uint32_t seed = 7, textbook_wrong = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        lr_vec3 o = lr_vec3_scale(random_unit(&seed), 1000), u, v;
        lr_vec3_frame(lr_vec3_normalize(o), &u, &v);
        double angle = random_between(&seed, 0, 6.28), at = i % 2 ? 1.003 : 0.997;
        lr_vec3 rim =
            lr_vec3_add(lr_vec3_scale(u, at * cos(angle)), lr_vec3_scale(v, at * sin(angle)));
        put_sphere(i, o, lr_vec3_normalize(lr_vec3_sub(rim, o)), (lr_vec3){0, 0, 0}, 1);
    }
    run(state, SPHERE);
    for (uint32_t i = 0; i < COUNT; i++) {
        double roots[2], half_chord;
        bool hit = sphere_roots(&given[i], roots, &half_chord);
        assert_int_equal(found.floats[i].x > 0, hit);
        if (hit)
            assert_near(found.floats[i].x, roots[0], 2e-3);
        textbook_wrong += (found.floats[i].z > 0) != hit;
    }
    print_message("the sheet's formula in floats: %.0f %% wrong\n", 100.0 * textbook_wrong / COUNT);
    assert_true(textbook_wrong > COUNT / 10);
}

/* ---- 3.6 ----------------------------------------------------------------------------------- */

static void test_plane(void **state)
{
    uint32_t seed = 8, front = 0, behind = 0;
    for (uint32_t i = 0; i < COUNT; i++)
        given[i] = (item){
            .a = narrow(random_point(&seed, 100), 0),
            .b = narrow(lr_vec3_scale(random_unit(&seed), random_magnitude(&seed, -4, 4)), 0),
            .c = narrow(random_unit(&seed), random_between(&seed, -100, 100))};
    run(state, PLANE);
    for (uint32_t i = 0; i < COUNT; i++) {
        lr_vec3 o = wide(given[i].a), d = wide(given[i].b), n = wide(given[i].c);
        double c = -given[i].c.w, along = lr_vec3_dot(n, d);
        double t = -(c + lr_vec3_dot(n, o)) / along; /* the sheet's n . p + c = 0 */
        double length = lr_vec3_length(d), tolerance = 1e-4 / fabs(along);
        if (fabs(along) < 1e-2 * length)
            continue;
        /* From above it is entered at t, from below left at t. */
        assert_near(along < 0 ? found.floats[i].x : found.floats[i].y, t,
                    tolerance + 1e-5 * fabs(t));
        assert_true(along < 0 ? found.floats[i].y > LR_T_MAX : found.floats[i].x < 0);
        front += t > 0;
        behind += t < 0;
    }
    assert_true(front > COUNT / 3 && behind > COUNT / 3);
}

static bool in_view(float t)
{
    return t > 0 && t < LR_T_MAX;
}

static void test_plane_parallel(void **state)
{
    uint32_t seed = 9;
    for (uint32_t i = 0; i < COUNT; i++)
        given[i] = (item){.a = {0, random_sign(&seed) * random_magnitude(&seed, -10, 10), 0, 0},
                          .b = {random_between(&seed, -1, 1), i % 2 ? 0.0f : -0.0f, 1, 0},
                          .c = {0, 1, 0, 0}};
    run(state, PLANE);
    for (uint32_t i = 0; i < COUNT; i++)
        assert_false(in_view(found.floats[i].x) || in_view(found.floats[i].y));
}

/* A normal of any length is made a unit vector where the scene is packed. */
static void test_plane_is_packed_with_a_unit_normal(void **state)
{
    (void)state;
    const char *text = "camera: {}\nobjects:\n  - plane: {normal: [0, 3, 4], offset: 10}\n";
    lr_scene *scene = NULL;
    char *report = NULL;
    lr_packed_scene packed;
    lr_settings settings = {.width = 1, .height = 1, .samples = 1};
    MUST(lr_scene_parse(text, strlen(text), "test.yaml", &scene, &report, error));
    settings.camera = &scene->cameras[0];
    MUST(lr_pack_scene(scene, &settings, &packed, error));
    assert_int_equal(packed.frame.planes.end - packed.frame.planes.begin, 1);
    struct gpu_plane plane;
    memcpy(&plane, &packed.rows[packed.frame.planes.base + 2 * packed.frame.planes.begin],
           sizeof plane);
    assert_near(plane.normal.x, 0, 0);
    assert_near(plane.normal.y, 0.6, 1e-7);
    assert_near(plane.normal.z, 0.8, 1e-7);
    assert_near(plane.offset, 2, 1e-6);
    lr_packed_scene_free(&packed);
    lr_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_reflection),
        cmocka_unit_test(test_refraction),
        cmocka_unit_test(test_refraction_there_and_back),
        cmocka_unit_test(test_equal_indices_go_straight),
        cmocka_unit_test(test_fresnel),
        cmocka_unit_test(test_sphere),
        cmocka_unit_test(test_sphere_cases),
        cmocka_unit_test(test_sphere_far_away),
        cmocka_unit_test(test_plane),
        cmocka_unit_test(test_plane_parallel),
        cmocka_unit_test(test_plane_is_packed_with_a_unit_normal),
        cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device, NULL);
}
