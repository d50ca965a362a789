/* What paths are lit by: the irradiance that samples add up to against closed forms, how samples
 * are spread, and that their pdf is the one that is reckoned where a ray meets the light by chance.
 */
#include "packed_tests.h"

#include "emitter.spv.h"
#include "scene/sky.h"
#include "unit/temporary_folder.h"

#define COUNT 1048576u
#define PI 3.14159265358979323846

typedef struct question {
    float position[3], choice, u[2], t;
    uint32_t object;
    float normal[3], unused;
} question;

typedef struct answer {
    float wi[3], t_max, value[3], pdf, found_pdf;
    float seen[3], seen_pdf; /* of the background along question.normal */
} answer;

static question asked[COUNT];
static answer found[COUNT];

static void ask(lr_device *device, const lr_packed_scene *packed)
{
    lr_program_desc desc = {emitter_spv, sizeof emitter_spv / 4, packed->constants, LR_SPEC_COUNT};
    struct gpu_work work = {0};
    packed_kernel k;
    open_packed(&k, device, packed, &desc, sizeof asked, sizeof found);
    ask_packed(&k, &work, COUNT / LR_GROUP_SIZE, asked, sizeof asked, found, sizeof found);
    close_packed(&k);
}

/* ---- Scenes -------------------------------------------------------------------------------- */

/* The scene packed for paths; the text is that of `lights` and `objects`. */
static lr_packed_scene pack(const char *text)
{
    char all[4096], name[128];
    lr_scene *scene;
    char *report;
    snprintf(name, sizeof name, "%s/test.yaml", folder);
    int length = snprintf(all, sizeof all, "camera: {}\n%s%s",
                          strstr(text, "background") ? "" : "background: 0\n", text);
    if (lr_scene_parse(all, (size_t)length, name, &scene, &report, NULL))
        fail_msg("%s", report);
    lr_settings settings = {.width = 1,
                            .height = 1,
                            .samples = 1,
                            .camera = &scene->cameras[0],
                            .integrator = LR_INTEGRATOR_PATH};
    lr_packed_scene packed;
    MUST(lr_pack_scene(scene, &settings, &packed, error));
    lr_scene_destroy(scene);
    return packed;
}

static float random_unit(uint32_t *seed)
{
    return (float)(random_bits(seed) >> 8) * 0x1p-24f;
}

static void ask_at(lr_device *device, const lr_packed_scene *packed, const double position[3])
{
    uint32_t seed = 3;
    for (uint32_t i = 0; i < COUNT; i++) {
        asked[i] =
            (question){.choice = random_unit(&seed), .u = {random_unit(&seed), random_unit(&seed)}};
        for (int k = 0; k < 3; k++)
            asked[i].position[k] = (float)position[k];
    }
    ask(device, packed);
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2];
    double z = a[0] * b[1] - a[1] * b[0];
    out[0] = x, out[1] = y, out[2] = z;
}

/* Irradiance on a surface with normal +y at the position: the mean of the samples, which must be
 * the expected one to within five standard errors, and these within `noise` of it. */
static void check_irradiance(lr_device *device, const char *text, const double position[3],
                             double expected, double noise)
{
    lr_packed_scene packed = pack(text);
    ask_at(device, &packed, position);
    double sum = 0, squares = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        double each = found[i].value[1] * fmax(found[i].wi[1], 0);
        sum += each;
        squares += each * each;
    }
    double mean = sum / COUNT;
    double error = sqrt(fmax(squares / COUNT - mean * mean, 0) / COUNT);
    if (!(fabs(mean - expected) <= 5 * error + 1e-5 * expected) || !(error <= noise * expected))
        fail_msg("irradiance %.9g +- %.3g, expected %.9g\n%s", mean, error, expected, text);
    lr_packed_scene_free(&packed);
}

/* Lambert's formula (1760): the irradiance by a polygon of radiance 1 above the horizon. */
static double polygon_irradiance(const double at[3], const double corners[][3], int count)
{
    double sum[3] = {0};
    for (int i = 0; i < count; i++) {
        double a[3], b[3], n[3];
        for (int k = 0; k < 3; k++) {
            a[k] = corners[i][k] - at[k];
            b[k] = corners[(i + 1) % count][k] - at[k];
        }
        double cosine = dot(a, b) / sqrt(dot(a, a) * dot(b, b));
        cross(a, b, n);
        double scale = acos(cosine) / sqrt(dot(n, n)) / 2;
        for (int k = 0; k < 3; k++)
            sum[k] += n[k] * scale;
    }
    return fabs(sum[1]);
}

/* ---- Irradiance ---------------------------------------------------------------------------- */

#define LIT                                                                                        \
    "lights: []\nmaterials: {lamp: {emission: [7, 2, 1]}, front: {emission: 2, emits: front}}\n"

/* Linear values of a picture that is brighter to the right and below, blended between four texels.
 */
static double picture_at(double u, double v)
{
    static const double texels[2][2] = {{0, 1}, {2, 3}};
    double x = fmin(fmax(2 * u - 0.5, 0), 1), y = fmin(fmax(2 * v - 0.5, 0), 1);
    double upper = texels[0][0] * (1 - x) + texels[0][1] * x;
    double lower = texels[1][0] * (1 - x) + texels[1][1] * x;
    return upper * (1 - y) + lower * y;
}

/* A surface that shines as a picture says: corner + a u + b v, with a to the right in the picture
 * and b up; aimed at alone, whole or cut into the triangles of a mesh. */
static void test_picture_of_light(void **state)
{
    static const double at[3] = {0.3, 0, -0.2}, corner[3] = {-1, 1.6, -0.5};
    static const double a[3] = {1.5, 0.2, 0}, b[3] = {0.1, 0.3, 1.2};
    static const float texels[12] = {0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3};
    char path[128];
    snprintf(path, sizeof path, "%s/light.pfm", folder);
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    fputs("PF\n2 2\n-1\n", f); /* the lowest row first */
    fwrite(texels + 6, 4, 6, f);
    fwrite(texels, 4, 6, f);
    fclose(f);
    snprintf(path, sizeof path, "%s/light.obj", folder);
    f = fopen(path, "wb");
    assert_non_null(f);
    fputs("v -1 1.6 -0.5\nv 0.5 1.8 -0.5\nv 0.6 2.1 0.7\nv -0.9 1.9 0.7\n"
          "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n",
          f);
    fclose(f);

    double n[3], expected = 0;
    cross(a, b, n);
    enum { STEPS = 600 };
    for (int i = 0; i < STEPS * STEPS; i++) {
        double u = (i % STEPS + 0.5) / STEPS, v = (i / STEPS + 0.5) / STEPS, to[3];
        for (int k = 0; k < 3; k++)
            to[k] = corner[k] + a[k] * u + b[k] * v - at[k];
        double r2 = dot(to, to);
        expected += 4 * picture_at(u, 1 - v) * to[1] * fabs(dot(to, n)) / (r2 * r2) / STEPS / STEPS;
    }
    static const char *const shapes[] = {
        "rectangle: {corner: [-1, 1.6, -0.5], u: [1.5, 0.2, 0], v: [0.1, 0.3, 1.2], material: m}",
        "mesh: {file: light.obj, material: m}",
    };
    for (int i = 0; i < 2; i++) {
        char text[1024];
        snprintf(text, sizeof text,
                 "lights: []\nmaterials: {m: {emission: 4, emission_map: {image: light.pfm, wrap: "
                 "clamp}}}\nobjects:\n  - %s\n",
                 shapes[i]);
        check_irradiance(*state, text, at, expected, 0.001);
    }
}

static void test_flat(void **state)
{
    static const double origin[3] = {0.3, 0, -0.2};
    static const double rectangle[][3] = {
        {-1, 2, 0}, {0, 2.5, 0.5}, {0.5, 2.2, 2}, {-0.5, 1.7, 1.5}};
    double expected = 2 * polygon_irradiance(origin, rectangle, 4);
    check_irradiance(*state,
                     LIT "objects: [rectangle: {corner: [-1, 2, 0], u: [1, 0.5, 0.5], v: [0.5, "
                         "-0.3, 1.5], material: lamp}]\n",
                     origin, expected, 1e-3);
    static const double triangle[][3] = {{-1, 2, 0}, {2, 1, 0.5}, {0.5, 3, 2}};
    expected = 2 * polygon_irradiance(origin, triangle, 3);
    check_irradiance(*state,
                     LIT "objects: [triangle: {a: [-1, 2, 0], b: [2, 1, 0.5], c: [0.5, 3, 2], "
                         "material: lamp}]\n",
                     origin, expected, 1e-3);
    /* On the axis of a disk, and of one that a transform has made. */
    static const double below[3] = {1, 0, 1};
    expected = 2 * PI * 4 / (4 + 2.25);
    check_irradiance(*state,
                     LIT "objects: [disk: {center: [1, 1.5, 1], radius: 2, material: lamp}]\n",
                     below, expected, 1e-3);
    check_irradiance(*state,
                     LIT "objects: [disk: {center: [0.5, 0, 0.5], material: lamp, scale: 2, "
                         "translate: [0, 1.5, 0]}]\n",
                     below, expected, 1e-3);
}

static void test_sphere(void **state)
{
    static const double origin[3] = {0, 0, 0};
    double cosine = 2 / 3.0, distance2 = 9;
    check_irradiance(*state,
                     LIT "objects: [sphere: {center: [2, 2, 1], radius: 0.5, material: lamp}]\n",
                     origin, 2 * PI * 0.25 / distance2 * cosine, 1e-3);
    /* Just above the surface, and all around. */
    check_irradiance(*state,
                     LIT "objects: [sphere: {center: [0, 1.001, 0], radius: 1, material: lamp}]\n",
                     origin, 2 * PI / (1.001 * 1.001), 1e-3);
    check_irradiance(*state, LIT "objects: [sphere: {radius: 5, material: lamp}]\n", origin, 2 * PI,
                     2e-3);
    check_irradiance(
        *state, LIT "objects: [sphere: {center: [2e9, 2e9, 1e9], radius: 5, material: lamp}]\n",
        origin, 2 * PI * 25 / 9e18 * cosine, 1e-3);
}

/* A box is seen from below as its lower face alone; a mesh as its triangles. */
static void test_box_and_mesh(void **state)
{
    static const double origin[3] = {0.2, 0, 0.1};
    static const double face[][3] = {{-1, 1, -1}, {1, 1, -1}, {1, 1, 2}, {-1, 1, 2}};
    check_irradiance(*state,
                     LIT "objects: [box: {min: [-1, 1, -1], max: [1, 3, 2], material: front}]\n",
                     origin, 2 * polygon_irradiance(origin, face, 4), 4e-3);
    /* A box is lit from inside by all of its faces. */
    static const double inside[3] = {0, 2, 0};
    check_irradiance(*state,
                     LIT "objects: [box: {min: [-1, 1, -1], max: [1, 3, 2], material: lamp}]\n",
                     inside, 2 * PI, 2e-3);
    check_irradiance(*state,
                     LIT "objects: [box: {min: [-1, 1, -1], max: [1, 3, 2], material: front}]\n",
                     inside, 0, 1);
    /* Unit cube meshes twice, one of them mirrored, as instances. */
    static const double faces[2][4][3] = {{{2, 1, -1}, {4, 1, -1}, {4, 1, 1}, {2, 1, 1}},
                                          {{-4, 1, -1}, {-2, 1, -1}, {-2, 1, 1}, {-4, 1, 1}}};
    static const double sides[2][4][3] = {{{2, 1, -1}, {2, 1, 1}, {2, 3, 1}, {2, 3, -1}},
                                          {{-2, 1, -1}, {-2, 1, 1}, {-2, 3, 1}, {-2, 3, -1}}};
    double expected = 0;
    for (int i = 0; i < 2; i++)
        expected +=
            2 * (polygon_irradiance(origin, faces[i], 4) + polygon_irradiance(origin, sides[i], 4));
    check_irradiance(*state,
                     LIT "objects:\n- mesh: {file: cube.obj, translate: [3, 2, 0], material: "
                         "front}\n- mesh: {file: cube.obj, scale: [-1, 1, 1], translate: [-3, 2, "
                         "0], material: front}\n",
                     origin, expected, 3e-3);
}

static int set_up(void **state)
{
    static const char cube[] = "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\n"
                               "v -1 1 1\nv 1 1 1\nf 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\n"
                               "f 1 5 7 3\nf 2 4 8 6\n";
    if (setup(state))
        return -1;
    char path[128];
    snprintf(path, sizeof path, "%s/cube.obj", folder);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(cube, 1, sizeof cube - 1, file), sizeof cube - 1);
    assert_int_equal(fclose(file), 0);
    return setup_device(state);
}

static void test_sides(void **state)
{
    static const double origin[3] = {0, 0, 0};
    static const double square[][3] = {{-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}};
    double lit = 2 * polygon_irradiance(origin, square, 4);
    /* u x v points down, then up. */
    const char *down = "objects: [rectangle: {corner: [-1, 1, -1], u: [2, 0, 0], v: [0, 0, 2], "
                       "material: %s}]\n";
    const char *up = "objects: [rectangle: {corner: [-1, 1, -1], u: [0, 0, 2], v: [2, 0, 0], "
                     "material: %s}]\n";
    for (int i = 0; i < 6; i++) {
        const char *materials[] = {"lamp", "front", "{emission: 2, one_sided: true}"};
        char text[1024] = LIT;
        snprintf(text + strlen(text), sizeof text - strlen(text), i < 3 ? down : up,
                 materials[i % 3]);
        check_irradiance(*state, text, origin, i < 4 ? lit : 0, 2e-3);
    }
}

static void test_lights(void **state)
{
    static const double origin[3] = {0, 0, 0};
    /* As the ray tracer's: pi times color, intensity, cosine and fading. */
    struct {
        const char *light;
        double expected;
    } cases[] = {
        {"point: {position: [2, 2, 1], intensity: 3}", 3 * PI / 9 * 2 / 3},
        {"point: {position: [2, 2, 1], intensity: 3, falloff: 1}", 3 * PI / 3 * 2 / 3},
        {"point: {position: [2, 2, 1], intensity: 3, radius: 1.5}", 3 * PI / 9 * 2 / 3},
        {"point: {position: [2, 2, 1], intensity: 3, falloff: 0, radius: 1}", 3 * PI * 2 / 3},
        {"point: {position: [0, 1, 0], intensity: 3, radius: 2}", 3 * PI / 4},
        {"directional: {direction: [-2, -2, -1], intensity: 5}", 5 * PI * 2 / 3},
        {"directional: {direction: [-2, -2, -1], intensity: 5, angle: 40}", 5 * PI * 2 / 3},
        {"directional: {direction: [0, -1, 0], intensity: 5, angle: 180}", 5 * PI},
        {"spot: {position: [2, 2, 1], to: [0, 0, 0], angle: 20}", PI / 9 * 2 / 3},
        {"spot: {position: [2, 2, 1], to: [0, 0, 0], angle: 20, radius: 0.2}", PI / 9 * 2 / 3},
        {"spot: {position: [2, 2, 1], to: [0, 9, 0], angle: 20, radius: 0.2}", 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[1024];
        snprintf(text, sizeof text, "lights: [%s]\nobjects: [plane: {}]\n", cases[i].light);
        check_irradiance(*state, text, origin, cases[i].expected, 2e-3);
    }
}

/* One of several very different sources is chosen: their sum. */
static void test_choice(void **state)
{
    static const double origin[3] = {0, 0, 0};
    static const double square[][3] = {{-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}};
    double expected = 2 * polygon_irradiance(origin, square, 4) + 3 * PI / 9 * 2 / 3 + PI +
                      2 * PI * 0.25 / 9 * 2 / 3 + 100 * 2 * PI * 1e-4 / 9 * 2 / 3;
    check_irradiance(
        *state,
        "lights: [point: {position: [2, 2, 1], intensity: 3}, directional: "
        "{direction: [0, -1, 0]}]\n"
        "materials: {lamp: {emission: 2}, bulb: {emission: 200}}\nobjects:\n"
        "- rectangle: {corner: [-1, 1, -1], u: [2, 0, 0], v: [0, 0, 2], material: lamp}\n"
        "- sphere: {center: [-2, 2, 1], radius: 0.5, material: lamp}\n"
        "- sphere: {center: [-2, 2, -1], radius: 0.01, material: bulb}\n"
        "- sphere: {center: [0, 9, 0]}\n",
        origin, expected, 5e-3);
}

/* ---- Samples and their pdf ------------------------------------------------------------------ */

/* Samples of the only object seen from `position`: `meets` tells where and with which normal a
 * direction meets it. */
static void check_pdf(lr_device *device, const char *text, const double position[3],
                      double (*meets)(const double from[3], const double wi[3], double n[3]))
{
    lr_packed_scene packed = pack(text);
    ask_at(device, &packed, position);
    for (uint32_t i = 0; i < COUNT; i++) {
        double wi[3] = {found[i].wi[0], found[i].wi[1], found[i].wi[2]}, n[3];
        double t = meets(position, wi, n);
        if (!(t > found[i].t_max && fabs(found[i].t_max / t - 1) < 2e-3))
            fail_msg("the shadow ray ends at %.9g, the light is at %.9g", (double)found[i].t_max,
                     t);
        asked[i].t = (float)t;
        for (int k = 0; k < 3; k++)
            asked[i].normal[k] = (float)n[k];
    }
    ask(device, &packed);
    for (uint32_t i = 0; i < COUNT; i++) {
        double pdf = found[i].pdf;
        assert_near(found[i].found_pdf, pdf, pdf * 2e-3);
        assert_near(found[i].value[0] * pdf, 7, 1e-4);
    }
    lr_packed_scene_free(&packed);
}

static double meets_tilted(const double from[3], const double wi[3], double n[3])
{
    /* (-1, 2, 0), u (1, 0.5, 0.5), v (0.5, -0.3, 1.5) */
    static const double u[3] = {1, 0.5, 0.5}, v[3] = {0.5, -0.3, 1.5};
    double to[3] = {-1 - from[0], 2 - from[1], -from[2]};
    cross(u, v, n);
    double scale = 1 / sqrt(dot(n, n));
    for (int k = 0; k < 3; k++)
        n[k] *= scale;
    return dot(to, n) / dot(wi, n);
}

static double meets_ball(const double from[3], const double wi[3], double n[3])
{
    double center[3] = {2, 2, 1}, radius = 0.5, away[3];
    for (int k = 0; k < 3; k++)
        away[k] = center[k] - from[k];
    double along = dot(away, wi);
    double rest = fmax(radius * radius - dot(away, away) + along * along, 0);
    bool inside = dot(away, away) < radius * radius;
    double t = inside ? along + sqrt(rest) : along - sqrt(rest);
    for (int k = 0; k < 3; k++)
        n[k] = (wi[k] * t - away[k]) / radius;
    return t;
}

static void test_pdf(void **state)
{
    static const double below[3] = {0.3, 0, -0.2}, within[3] = {2.1, 2.2, 1.1};
    check_pdf(*state,
              LIT
              "objects: [rectangle: {corner: [-1, 2, 0], u: [1, 0.5, 0.5], v: [0.5, -0.3, 1.5], "
              "material: lamp}]\n",
              below, meets_tilted);
    const char *ball = LIT "objects: [sphere: {center: [2, 2, 1], radius: 0.5, material: lamp}]\n";
    check_pdf(*state, ball, below, meets_ball);
    check_pdf(*state, ball, within, meets_ball);
}

/* The chi-square test: counts of equally likely cells, at a chance of 1e-6 to fail by bad luck
 * (Wilson and Hilferty's approximation). */
#define CELLS 32
static void check_spread(const uint32_t counts[CELLS][CELLS])
{
    double expected = (double)COUNT / (CELLS * CELLS), chi2 = 0, k = CELLS * CELLS - 1;
    for (int i = 0; i < CELLS * CELLS; i++)
        chi2 += pow(counts[i / CELLS][i % CELLS] - expected, 2) / expected;
    double normal = (cbrt(chi2 / k) - (1 - 2 / (9 * k))) / sqrt(2 / (9 * k));
    if (!(fabs(normal) < 4.9))
        fail_msg("chi square %.6g of %g cells", chi2, k + 1);
}

static uint32_t cell_of(double x)
{
    return (uint32_t)fmin(fmax(x * CELLS, 0), CELLS - 1);
}

/* Where the samples of something in the plane y = 2 are, seen from the origin. */
static void point_of(const answer *a, double *x, double *z)
{
    *x = 2.0 * a->wi[0] / a->wi[1];
    *z = 2.0 * a->wi[2] / a->wi[1];
}

static void test_spread(void **state)
{
    static const double origin[3] = {0, 0, 0};
    static uint32_t counts[4][CELLS][CELLS];
    static const char *texts[] = {
        LIT
        "objects: [rectangle: {corner: [1, 2, 0], u: [2, 0, 0], v: [0, 0, 1], material: lamp}]\n",
        LIT "objects: [triangle: {a: [1, 2, 0], b: [3, 2, 0], c: [1, 2, 1], material: lamp}]\n",
        LIT "objects: [disk: {center: [1, 2, 0], radius: 0.5, material: lamp}]\n",
        LIT "objects: [sphere: {center: [0, 3, 0], radius: 2, material: lamp}]\n",
    };
    memset(counts, 0, sizeof counts);
    for (int kind = 0; kind < 4; kind++) {
        lr_packed_scene packed = pack(texts[kind]);
        ask_at(*state, &packed, origin);
        for (uint32_t i = 0; i < COUNT; i++) {
            double x, z, a, b;
            point_of(&found[i], &x, &z);
            a = (x - 1) / 2, b = z;
            if (kind == 1) { /* by what lies beyond x, and how far across there */
                double rest = 1 - a;
                b = b / rest;
                a = rest * rest;
            } else if (kind == 2) {
                a = ((x - 1) * (x - 1) + z * z) / 0.25;
                b = atan2(z, x - 1) / (2 * PI) + 0.5;
            } else if (kind == 3) {
                a = (1 - found[i].wi[1]) / (1 - sqrt(5) / 3);
                b = atan2(found[i].wi[2], found[i].wi[0]) / (2 * PI) + 0.5;
            }
            counts[kind][cell_of(a)][cell_of(b)]++;
        }
        check_spread((const uint32_t(*)[CELLS])counts[kind]);
        lr_packed_scene_free(&packed);
    }
}

/* ---- The background ------------------------------------------------------------------------- */

enum { WIDTH = 18, HEIGHT = 9 };
static float texels[HEIGHT][WIDTH][3];

/* Dark, bright and black texels in random places; bright ones at the poles and where left and right
 * meet. */
static void write_picture(uint32_t seed)
{
    char path[128];
    snprintf(path, sizeof path, "%s/all.pfm", folder);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fprintf(file, "PF\n%d %d\n-1\n", WIDTH, HEIGHT);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            uint32_t kind = random_bits(&seed) % 8;
            float scale = kind == 0 ? 100.0f : kind < 3 ? 0.0f : 1.0f;
            for (int k = 0; k < 3; k++)
                texels[y][x][k] = scale * random_between(&seed, 0.1, 1);
        }
    for (int y = HEIGHT - 1; y >= 0; y--)
        assert_int_equal(fwrite(texels[y], sizeof texels[y], 1, file), 1);
    assert_int_equal(fclose(file), 0);
}

/* What is seen along d, in green, where x, y, z point right, up and forward. */
static double expect_seen(double x, double y, double z)
{
    double u = (0.5 + atan2(x, z) / (2 * PI)) * WIDTH - 0.5;
    double v = acos(fmax(-1, fmin(y, 1))) / PI * HEIGHT - 0.5, sum = 0;
    for (int i = 0; i < 4; i++) {
        int column = (int)floor(u) + (i & 1), row = (int)floor(v) + (i >> 1);
        double share =
            (i & 1 ? u - floor(u) : 1 - u + floor(u)) * (i >> 1 ? v - floor(v) : 1 - v + floor(v));
        row = row < 0 ? 0 : row >= HEIGHT ? HEIGHT - 1 : row;
        sum += share * (double)texels[row][(column + WIDTH) % WIDTH][1];
    }
    return sum;
}

/* Asks for the background in directions that are spread evenly. */
static void ask_around(lr_device *device, const lr_packed_scene *packed)
{
    uint32_t seed = 7;
    for (uint32_t i = 0; i < COUNT; i++) {
        double y = (i + 0.5) / COUNT * 2 - 1, r = sqrt(1 - y * y);
        double turn = 2 * PI * random_unit(&seed);
        asked[i] = (question){
            .choice = random_unit(&seed),
            .u = {random_unit(&seed), random_unit(&seed)},
            .normal = {(float)(r * cos(turn)), (float)y, (float)(r * sin(turn))},
        };
    }
    ask(device, packed);
}

/* Samples fall into the cells of azimuth and height as their pdf, at the evenly spread directions,
 * says. */
static void check_pdf_of_cells(void)
{
    enum { ACROSS = 24, DOWN = 12 };
    static double counts[DOWN][ACROSS], expected[DOWN][ACROSS], total;
    memset(counts, 0, sizeof counts);
    memset(expected, 0, sizeof expected);
    total = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        const float *ways[2] = {found[i].wi, asked[i].normal};
        for (int k = 0; k < 2; k++) {
            int x = (int)((atan2(ways[k][2], ways[k][0]) / (2 * PI) + 0.5) * ACROSS) % ACROSS;
            int y = (int)((ways[k][1] + 1) / 2 * DOWN) % DOWN;
            if (k == 0)
                counts[y][x]++;
            else
                expected[y][x] += found[i].seen_pdf * 4 * PI;
        }
        total += found[i].seen_pdf * 4 * PI / COUNT;
    }
    assert_near(total, 1, 5e-3);
    for (int i = 0; i < ACROSS * DOWN; i++) {
        double count = counts[i / ACROSS][i % ACROSS], mean = expected[i / ACROSS][i % ACROSS];
        /* The mean is itself one of about 3600 directions, so within a few percent. */
        if (!(fabs(count - mean) <= 6 * sqrt(mean) + 0.1 * mean + 1))
            fail_msg("%g samples in cell %d, expected %g", count, i, mean);
    }
}

static void test_picture(void **state)
{
    for (uint32_t turned = 0; turned < 4; turned++) {
        char text[512];
        write_picture(turned);
        /* Up is y, or z with y ahead; and a quarter turn more. */
        snprintf(text, sizeof text,
                 "background: {image: all.pfm, intensity: 3, rotate: %d}\nup: %s\n"
                 "objects: [sphere: {}]\n",
                 turned & 1 ? 90 : 0, turned & 2 ? "[0, 0, 1]" : "[0, 1, 0]");
        lr_packed_scene packed = pack(text);
        assert_int_equal(packed.constants[LR_SPEC_ENVIRONMENT], 1);
        assert_int_equal(packed.constants[LR_SPEC_DELTA_LIGHTS], 0);
        ask_around(*state, &packed);
        double by_samples = 0, evenly = 0;
        for (uint32_t i = 0; i < COUNT; i++) {
            const float *n = asked[i].normal;
            double x = n[0], y = turned & 2 ? n[2] : n[1], z = turned & 2 ? n[1] : -n[2];
            if (turned & 1) { /* what was ahead is on the left */
                double swapped = x;
                x = z;
                z = -swapped;
            }
            double seen = 3 * expect_seen(x, y, z);
            assert_near(found[i].seen[1], seen, 1e-3 + 1e-4 * seen);
            evenly += 4 * PI * found[i].seen[1] * fmax(n[1], 0) / COUNT;
            by_samples += found[i].value[1] * fmax(found[i].wi[1], 0) / COUNT;
            assert_near(found[i].t_max, LR_T_MAX, 1e9);
        }
        assert_near(by_samples, evenly, 0.01 * evenly);
        check_pdf_of_cells();
        lr_packed_scene_free(&packed);
    }
}

/* On the ground falls what the sky's and the sun's radiance come to, and the sun's samples are
 * where it is to be seen. */
static void test_sky(void **state)
{
    double height = 0.6, across = 0.8, expected = 0;
    lr_sky sky = lr_sky_make(4, height);
    for (int i = 0; i < 400; i++)
        for (int k = 0; k < 400; k++) {
            double h = (i + 0.5) / 400, azimuth = 2 * PI * (k + 0.5) / 400;
            double cosine = h * height + sqrt(1 - h * h) * across * cos(azimuth);
            expected += lr_sky_radiance(&sky, h, cosine).y * h * 2 * PI / 160000;
        }
    double sun = lr_sun_radiance(&sky).y, half = LR_SUN_ANGLE / 2 * PI / 180;
    double by_sun = sun * 2 * PI * (1 - cos(half)) * height;
    lr_packed_scene packed = pack(
        "background: {sky: [0.8, 0.6, 0], turbidity: 4, intensity: 2}\nobjects: [sphere: {}]\n");
    assert_int_equal(packed.constants[LR_SPEC_SUN], 1);
    ask_around(*state, &packed);
    double air = 0, all = 0, suns = 0;
    for (uint32_t i = 0; i < COUNT; i++) {
        const float *wi = found[i].wi;
        double each = found[i].value[1] * fmax(wi[1], 0) / COUNT;
        bool in_sun = wi[0] * 0.8 + wi[1] * 0.6 > cos(half) - 1e-7;
        all += each;
        air += in_sun ? 0 : each;
        suns += in_sun;
    }
    assert_near(air, 2 * expected, 0.01 * 2 * expected);
    assert_near(all - air, 2 * by_sun, 0.003 * 2 * by_sun);
    assert_in_range((uint64_t)suns, COUNT / 4, COUNT);
    lr_packed_scene_free(&packed);
}

/* ---- In pictures ---------------------------------------------------------------------------- */

/* A matt floor below a lamp, where half of what arrives is also found by chance. */
static void test_floor(void **state)
{
    static const double origin[3] = {0, 0, 0};
    static const double square[][3] = {{-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}};
    double expected = 0.5 / PI * 3 * polygon_irradiance(origin, square, 4);
    rgb seen =
        render_pixel(*state, NULL,
                     "camera: {from: [3, 1, 0], to: [0, 0, 0], fov: 0.01}\nbackground: 0\n"
                     "image: {samples: 16384, depth: 1, integrator: path}\nlights: []\nobjects:\n"
                     "- plane: {material: {color: 0.5}}\n"
                     "- rectangle: {corner: [-1, 1, -1], u: [2, 0, 0], v: [0, 0, 2], "
                     "material: {color: 0, emission: 3}}\n");
    assert_near(seen.g, expected, 0.005 * expected);
    /* The whole of a ball from inside: L (1 + albedo + albedo^2 ...) with depth 1. */
    rgb furnace = render_pixel(*state, NULL,
                               "camera: {from: [0, 0, 1]}\nbackground: 0\nlights: []\n"
                               "image: {samples: 4096, depth: 1, integrator: path}\nobjects:\n"
                               "- sphere: {radius: 3, material: {color: 0.5, emission: 1}}\n");
    assert_near(furnace.g, 1.75, 0.01);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_flat),
        cmocka_unit_test(test_picture_of_light),
        cmocka_unit_test(test_sphere),
        cmocka_unit_test(test_box_and_mesh),
        cmocka_unit_test(test_sides),
        cmocka_unit_test(test_lights),
        cmocka_unit_test(test_choice),
        cmocka_unit_test(test_pdf),
        cmocka_unit_test(test_spread),
        cmocka_unit_test(test_picture),
        cmocka_unit_test(test_sky),
        cmocka_unit_test(test_floor),
        cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, set_up, teardown);
}
