/* Pictures of normals, heights, roughness, metal and light, on surfaces whose shading is then
 * known. */
#include "gpu_tests.h"

#include "unit/temporary_folder.h"

/* ---- Pictures and scenes ------------------------------------------------------------------- */

/* Writes a PPM file of width x height texels, whose colours `texel` says. */
static void put_picture(const char *name, uint32_t width, uint32_t height,
                        void (*texel)(uint32_t x, uint32_t y, uint8_t out[3]))
{
    char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    fprintf(f, "P6\n%u %u\n255\n", (unsigned)width, (unsigned)height);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++) {
            uint8_t out[3];
            texel(x, y, out);
            fwrite(out, 1, 3, f);
        }
    fclose(f);
}

static void put_text(const char *name, const char *text)
{
    char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    fputs(text, f);
    fclose(f);
}

/* Renders a scene that stands in the folder. */
static picture render_here(lr_device *device, const char *text, const lr_render_options *options)
{
    char name[128];
    picture result;
    lr_scene *scene = NULL;
    char *report = NULL;
    lr_error error = {0};
    snprintf(name, sizeof name, "%s/test.yaml", folder);
    if (lr_scene_parse(text, strlen(text), name, &scene, &report, &error))
        fail_msg("%s\n%s\n%s", error.message, report ? report : "", text);
    if (lr_render(device, scene, options, &result.image, &result.stats, &error))
        fail_msg("%s\n%s", error.message, text);
    lr_scene_destroy(scene);
    return result;
}

/* ---- Normals ------------------------------------------------------------------------------- */

static uint8_t constant[3];

static void constant_texel(uint32_t x, uint32_t y, uint8_t out[3])
{
    (void)x, (void)y;
    memcpy(out, constant, 3);
}

static const char smooth_quad[] = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
                                  "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0.6 0 0.8\n"
                                  "f 1/1/1 2/2/1 3/3/1 4/4/1\n";
static const char quads[] = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"
                            "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";

/* Shapes, a point of their surface, and what is right, up and ahead in the picture there. */
static const struct {
    const char *shape;
    double at[3], right[3], up[3], out[3];
} shapes[] = {
    {"rectangle: {corner: [-1, -1, 0], u: [2, 0, 0], v: [0, 2, 0], material: m}",
     {0, 0, 0},
     {1, 0, 0},
     {0, 1, 0},
     {0, 0, 1}},
    {"rectangle: {corner: [-1, -1, 0], u: [2, 0, 0], v: [0, 2, 0], scale: [1e-3, 2e-3, 1], "
     "material: m}",
     {0, 0, 0},
     {1, 0, 0},
     {0, 1, 0},
     {0, 0, 1}},
    {"rectangle: {corner: [-1, -1, 0], u: [2, 0, 0], v: [0, 2, 0], scale: [-1, 1, 1], "
     "material: m}",
     {0.1, 0.2, 0},
     {-1, 0, 0},
     {0, 1, 0},
     {0, 0, -1}},
    {"triangle: {a: [-1, -1, 0], b: [3, -1, 0], c: [-1, 3, 0], material: m}",
     {0, 0, 0},
     {1, 0, 0},
     {0, 1, 0},
     {0, 0, 1}},
    {"box: {min: [-1, -1, -1], max: [1, 1, 1], material: m}",
     {0, 0, 1},
     {1, 0, 0},
     {0, 1, 0},
     {0, 0, 1}},
    {"box: {min: [-1, -1, -1], max: [1, 1, 1], material: m}",
     {1, 0, 0},
     {0, 0, -1},
     {0, 1, 0},
     {1, 0, 0}},
    {"box: {min: [-1, -1, -1], max: [1, 1, 1], material: m}",
     {0.5, 1, 0},
     {1, 0, 0},
     {0, 0, -1},
     {0, 1, 0}},
    {"box: {min: [-1, -1, -1], max: [1, 1, 1], material: m}",
     {0.5, -1, 0},
     {1, 0, 0},
     {0, 0, 1},
     {0, -1, 0}},
    {"box: {min: [-1, -1, -1], max: [1, 1, 1], rotate: [0, 0, 90], material: m}",
     {0, 0, 1},
     {0, 1, 0},
     {-1, 0, 0},
     {0, 0, 1}},
    {"plane: {material: m}", {7, 0, 3}, {1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
    {"sphere: {material: m}", {0, 1, 0}, {1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
    {"sphere: {material: m, scale: [1, 0.5, 1]}", {0, 0.5, 0}, {1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
    {"cylinder: {from: [0, 0, 0], to: [0, 1, 0], radius: 1, material: m}",
     {0.2, 1, 0.1},
     {1, 0, 0},
     {0, 0, -1},
     {0, 1, 0}},
    {"mesh: {file: quad.obj, material: m}", {0.3, 0.2, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
    {"mesh: {file: quad.obj, scale: [-1, 1, 1], material: m}",
     {0.3, 0.2, 0},
     {-1, 0, 0},
     {0, 1, 0},
     {0, 0, 1}},
    {"mesh: {file: quad.obj, scale: [1e-4, 3e-4, 1], material: m}\n"
     "  - mesh: {file: quad.obj, translate: [9, 0, 0], material: m}",
     {0, 0, 0},
     {1, 0, 0},
     {0, 1, 0},
     {0, 0, 1}},
    {"mesh: {file: quad.obj, rotate: [0, 0, 90], material: m}\n"
     "  - mesh: {file: quad.obj, translate: [9, 0, 0], material: m}",
     {0.3, 0.2, 0},
     {0, 1, 0},
     {-1, 0, 0},
     {0, 0, 1}},
    /* Tangents stand at right angles to smooth normals. */
    {"mesh: {file: smooth.obj, material: m}",
     {0.3, 0.2, 0},
     {0.8, 0, -0.6},
     {0, 1, 0},
     {0.6, 0, 0.8}},
};
enum { SHAPES = sizeof shapes / sizeof *shapes };

/* Lights from (right + out), (up + out), (-right + 2 out) in turn; each tells a cosine. */
static const double from[][2] = {{1, 0}, {0, 1}, {-0.5, 0.3}};

/* The cosine of light number `light` against the normal (x, y, 1) or so, in the frame of the shape.
 */
static double expected_cosine(int light, double x, double y, double z)
{
    double a = from[light][0], b = from[light][1];
    double cosine = (a * x + b * y + z) / sqrt((a * a + b * b + 1) * (x * x + y * y + z * z));
    return fmax(cosine, 0);
}

/* What the lights show of a surface: all three, each in a colour of its own, or with `only` >= 0
 * that one in white. */
static void shade(lr_device *device, int shape, const char *map, int only, lr_integrator integrator,
                  double cosines[3])
{
    char text[2048], lights[512] = "";
    double eye[3];
    for (int k = 0; k < 3; k++)
        eye[k] = shapes[shape].at[k] + 3 * shapes[shape].out[k];
    for (int i = 0; i < 3; i++) {
        double way[3];
        for (int k = 0; k < 3; k++)
            way[k] = -shapes[shape].out[k] - from[i][0] * shapes[shape].right[k] -
                     from[i][1] * shapes[shape].up[k];
        size_t used = strlen(lights);
        if (only < 0 || only == i)
            snprintf(lights + used, sizeof lights - used,
                     "  - directional: {direction: [%.9g, %.9g, %.9g], color: [%d, %d, %d]}\n",
                     way[0], way[1], way[2], i == 0, i == 1, i == 2);
    }
    snprintf(text, sizeof text,
             "camera: {from: [%g, %g, %g], to: [%g, %g, %g], up: [%g, %g, %g], fov: 0.001}\n"
             "image: {width: 1, height: 1, depth: 0, samples: 1}\nambient: 0\nbackground: 0\n"
             "materials: {m: {color: 1, %s}}\nlights:\n%sobjects:\n  - %s\n",
             eye[0], eye[1], eye[2], shapes[shape].at[0], shapes[shape].at[1], shapes[shape].at[2],
             shapes[shape].up[0], shapes[shape].up[1], shapes[shape].up[2], map, lights,
             shapes[shape].shape);
    picture p = render_here(device, text, &(lr_render_options){.integrator = integrator});
    for (int i = 0; i < 3; i++)
        cosines[i] = p.image.pixels[i];
    assert_int_equal(p.stats.non_finite, 0);
    free_picture(&p);
}

/* Paths ask one light at a time, so they get one. */
static void check_normal(lr_device *device, int shape, const char *map, double x, double y,
                         double z)
{
    for (int only = -1; only < 1; only++) {
        lr_integrator by = only < 0 ? LR_INTEGRATOR_WHITTED : LR_INTEGRATOR_PATH;
        int light = only < 0 ? -1 : shape % 3;
        double found[3];
        shade(device, shape, map, light, by, found);
        for (int i = 0; i < 3; i++) {
            double expected = light < 0 || light == i ? expected_cosine(i, x, y, z) : 0;
            if (!(fabs(found[i] - expected) <= 2e-5)) /* the eye sees a spot */
                fail_msg("%s, %s, light %d, integrator %d: %.9g, expected %.9g",
                         shapes[shape].shape, map, i, (int)by, found[i], expected);
        }
    }
}

static void test_normals(void **state)
{
    static const uint8_t tilts[][3] = {
        {128, 128, 255}, {192, 128, 238}, {90, 170, 240}, {255, 128, 128}, {0, 100, 200}};
    put_text("quad.obj", quads);
    put_text("smooth.obj", smooth_quad);
    for (size_t i = 0; i < sizeof tilts / sizeof *tilts; i++) {
        memcpy(constant, tilts[i], 3);
        put_picture("n.ppm", 2, 2, constant_texel);
        double x = fmax((constant[0] - 128) / 127.0, -1), y = (constant[1] - 128) / 127.0;
        double z = (constant[2] - 128) / 127.0;
        for (int shape = 0; shape < SHAPES; shape++) {
            if (z > 0)
                check_normal(*state, shape, "normal_map: n.ppm", x, y, z);
            if (i == 1)
                check_normal(*state, shape, "normal_map: {image: n.ppm, scale: -0.5}", -x / 2,
                             -y / 2, z);
        }
        /* In the plane of the surface: as far as a normal can lean and still face the eye. */
        double cosines[3];
        if (z == 0) {
            shade(*state, 0, "normal_map: n.ppm", 0, LR_INTEGRATOR_PATH, cosines);
            assert_near(cosines[0], sqrt(0.5), 0.01);
        }
    }
}

static const char still_life[] =
    "camera: {from: [1, 3, 5], to: [0, 0.4, 0], fov: 30}\n"
    "image: {width: 48, height: 32, samples: 2, depth: 2}\n"
    "materials: {m: {color: 0.7, specular: 0.3, reflect: 0.2%s}, n: {model: pbr, roughness: "
    "0.3%s}}\n"
    "lights: [point: {position: [3, 4, 4], intensity: 20}]\n"
    "objects:\n"
    "  - rectangle: {corner: [-3, 0, 3], u: [6, 0, 0], v: [0, 0, -6], material: m}\n"
    "  - box: {min: [-1, 0, -1], max: [0, 1, 0], material: n}\n"
    "%s";

/* A map that is level changes no bit. */
static void test_level(void **state)
{
    static const char *const maps[] = {"normal_map: n.ppm",
                                       "normal_map: {image: tilt.ppm, scale: 0}",
                                       "bump_map: tilt.ppm", "bump_map: {image: r.ppm, height: 0}"};
    memcpy(constant, (uint8_t[]){128, 128, 255}, 3);
    put_picture("n.ppm", 3, 2, constant_texel);
    memcpy(constant, (uint8_t[]){200, 90, 220}, 3);
    put_picture("tilt.ppm", 3, 2, constant_texel);
    put_picture("r.ppm", 3, 2, constant_texel);
    put_text("quad.obj", quads);
    const char *mesh = "  - mesh: {file: quad.obj, translate: [1.2, 1, 0], material: m}\n";
    for (int i = 0; i < 16; i++) {
        lr_render_options options = {.integrator =
                                         i & 1 ? LR_INTEGRATOR_PATH : LR_INTEGRATOR_WHITTED};
        char plain[2048], mapped[2048], with[128];
        snprintf(with, sizeof with, ", %s", maps[i / 4]);
        snprintf(plain, sizeof plain, still_life, "", "", i & 2 ? mesh : "");
        snprintf(mapped, sizeof mapped, still_life, with, with, i & 2 ? mesh : "");
        picture a = render_here(*state, plain, &options), b = render_here(*state, mapped, &options);
        if (!same_pictures(&a, &b))
            fail_msg("%s changes the picture of %d", maps[i / 4], i);
        free_picture(&a);
        free_picture(&b);
    }
}

/* ---- Heights ------------------------------------------------------------------------------- */

static void ramp_texel(uint32_t x, uint32_t y, uint8_t out[3])
{
    out[0] = (uint8_t)(20 + 9 * x + 4 * y);
    out[1] = out[2] = 77;
}

/* A plane that rises by 9 / 255 of the height a texel to the right, and falls by 4 / 255 upwards.
 */
static void test_ramp(void **state)
{
    static const double widths[][2] = {{2, 2}, {0.002, 0.004}, {2, 2}, {4, 4}, {2, 2}, {2, 2}};
    put_picture("ramp.ppm", 16, 16, ramp_texel);
    put_text("quad.obj", quads);
    for (int i = 0; i < 6; i++) {
        double u = 9 / 255.0 * 16 / widths[i][0], v = 4 / 255.0 * 16 / widths[i][1];
        char map[64];
        double height = 0.6 * widths[i][1];
        snprintf(map, sizeof map, "bump_map: {image: ramp.ppm, height: %.9g}", height);
        check_normal(*state, i, map, -u * height, v * height, 1);
    }
    check_normal(*state, 13, "bump_map: {image: ramp.ppm, height: -0.5}", 9 / 255.0 * 4,
                 -4 / 255.0 * 4, 1);
}

/* ---- Roughness and metal ------------------------------------------------------------------- */

static const char room[] =
    "camera: {from: [0, 2, 5], to: [0, 0.5, 0], fov: 30}\n"
    "image: {width: 24, height: 16, samples: 4, depth: 3, integrator: path}\n"
    "lights: [point: {position: [3, 4, 4], intensity: 20}]\n"
    "objects:\n"
    "  - plane: {}\n"
    "  - sphere: {center: [0, 0.6, 0], radius: 0.6, material: {%s}}\n"
    "  - box: {min: [0.8, 0, 0], max: [1.3, 1, 0.5], material: {%s}}\n";

/* A picture of one value is that number. */
static void test_gloss(void **state)
{
    static const char *const cases[][2] = {
        {"model: pbr, color: gold, metallic: 1, roughness: 0.8, roughness_map: g.ppm",
         "model: pbr, color: gold, metallic: 1, roughness: 0.40156862745098"},
        {"model: pbr, color: gold, metallic: 0.9, roughness: 0.5, metallic_map: g.ppm",
         "model: pbr, color: gold, metallic: 0.225882352941176, roughness: 0.5"},
        {"model: pbr, color: gold, metallic: 0.9, roughness: 1,\n"
         " metallic_map: {image: g.ppm, channel: red}, roughness_map: {image: g.ppm, channel: "
         "blue}",
         "model: pbr, color: gold, metallic: 0.7058823529411765, roughness: 0.25098039215686274"},
        {"model: dielectric, roughness: 0.6, roughness_map: g.ppm",
         "model: dielectric, roughness: 0.30117647058823527"},
        {"model: conductor, metal: copper, roughness: 1, roughness_map: black.ppm",
         "model: conductor, metal: copper, roughness: 0"},
        {"model: diffuse, roughness: 1, roughness_map: {image: g.ppm, channel: red}",
         "model: diffuse, roughness: 0.7843137254901961"},
    };
    memcpy(constant, (uint8_t[]){200, 128, 64}, 3);
    put_picture("g.ppm", 2, 1, constant_texel);
    memset(constant, 0, 3);
    put_picture("black.ppm", 2, 1, constant_texel);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        picture found[2];
        for (int k = 0; k < 2; k++) {
            char text[2048];
            snprintf(text, sizeof text, room, cases[i][k], cases[i][k]);
            found[k] = render_here(*state, text, NULL);
        }
        for (size_t k = 0; k < 3 * 24 * 16; k++) {
            double a = found[0].image.pixels[k], b = found[1].image.pixels[k];
            if (!(fabs(a - b) <= 2e-4 * (fabs(b) + 0.01)))
                fail_msg("%s: %.9g, expected %.9g", cases[i][0], a, b);
        }
        free_picture(&found[0]);
        free_picture(&found[1]);
    }
}

/* ---- Light --------------------------------------------------------------------------------- */

static void sign_texel(uint32_t x, uint32_t y, uint8_t out[3])
{
    out[0] = x < 8 ? 255 : 0;
    out[1] = y < 4 ? 200 : 10;
    out[2] = x > 11 && y > 11 ? 255 : 0;
}

/* Shapes that shine as the picture says, above a floor. `alpha_cutoff` makes them found by chance
 * alone: what may have holes is not aimed at. */
static void test_light(void **state)
{
    static const char *const lamps[] = {
        "rectangle: {corner: [-1, 1.5, -1], u: [2, 0, 0], v: [0, 0.3, 2], material: lamp}",
        "disk: {center: [0.2, 1.5, 0], normal: [0.2, -1, 0.1], radius: 1, material: lamp}",
        "triangle: {a: [-1, 1.2, -1], b: [2, 1.5, -1], c: [-1, 2, 2], material: lamp}",
        "box: {min: [-0.6, 0.6, -0.4], max: [0.5, 1.5, 0.3], material: lamp}",
        "sphere: {center: [0.3, 1.2, 0.4], radius: 0.7, material: lamp}",
        "mesh: {file: quad.obj, rotate: [70, 0, 10], translate: [0, 1.5, 0], material: lamp}",
        "mesh: {file: quad.obj, scale: [-1, 1, 1], rotate: [70, 0, 10], translate: [0, 1.5, 0], "
        "material: lamp}",
    };
    put_picture("sign.ppm", 16, 16, sign_texel);
    put_text("quad.obj", quads);
    memset(constant, 255, 3);
    put_picture("white.ppm", 1, 1, constant_texel);
    for (size_t i = 0; i < sizeof lamps / sizeof *lamps; i++) {
        double means[2][3];
        for (int k = 0; k < 2; k++) {
            char text[2048];
            snprintf(text, sizeof text,
                     "camera: {from: [0, 0.4, 3], to: [0, 0, 0], fov: 50}\n"
                     "image: {width: 32, height: 32, samples: %d, depth: 1, integrator: path}\n"
                     "background: 0\nlights: []\n"
                     "materials: {lamp: {color: {image: white.ppm}, diffuse: 0, alpha_cutoff: %g, "
                     "emission: [2, 3, 4], emission_map: {image: sign.ppm, wrap: %s}}}\n"
                     "objects:\n  - rectangle: {corner: [-3, 0, 3], u: [6, 0, 0], v: [0, 0, -6]}\n"
                     "  - %s\n",
                     k ? 2048 : 512, k ? 0.1 : 0.0, i == 4 ? "mirror" : "clamp", lamps[i]);
            picture p = render_here(*state, text, NULL);
            for (int c = 0; c < 3; c++)
                means[k][c] = mean_of(&p, c);
            free_picture(&p);
        }
        for (int c = 0; c < 3; c++)
            if (!(fabs(means[0][c] - means[1][c]) <= 0.02 * means[1][c] + 2e-4))
                fail_msg("%s, channel %d: %.6g when aimed at, %.6g when found by chance", lamps[i],
                         c, means[0][c], means[1][c]);
    }
}

/* Nothing chooses what is black all over, and what is left of a mesh is chosen more often. */
static void test_black(void **state)
{
    memset(constant, 0, 3);
    put_picture("black.ppm", 1, 1, constant_texel);
    picture p =
        render_here(*state,
                    "camera: {from: [0, 0.4, 3], to: [0, 0, 0]}\n"
                    "image: {width: 4, height: 4, depth: 1, integrator: path}\n"
                    "background: 0\nlights: []\nobjects:\n  - plane: {}\n"
                    "  - sphere: {center: [0, 2, 0], material: {emission_map: black.ppm}}\n",
                    NULL);
    for (int c = 0; c < 3; c++)
        assert_near(mean_of(&p, c), 0, 0);
    free_picture(&p);
}

static int open_all(void **state)
{
    return setup(state) ? -1 : setup_device(state);
}

static int remove_folder(void **state)
{
    return teardown(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_normals),
        cmocka_unit_test(test_level),
        cmocka_unit_test(test_ramp),
        cmocka_unit_test(test_gloss),
        cmocka_unit_test(test_light),
        cmocka_unit_test(test_black),
        cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, open_all, remove_folder);
}
