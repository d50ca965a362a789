/* What good scenes mean: defaults, every key, numbers, colours, transforms. */
#include "scene_tests.h"

#include "scene/color.h"

#include <locale.h>
#include <math.h>

#define assert_vec(v, a, b, c)                                                                     \
    do {                                                                                           \
        assert_near((v).x, a, 1e-12);                                                              \
        assert_near((v).y, b, 1e-12);                                                              \
        assert_near((v).z, c, 1e-12);                                                              \
    } while (0)

#define ONE "camera: {}\nobjects:\n"

static void test_defaults(void **state)
{
    (void)state;
    lr_scene *s = parse_good(ONE "- sphere: {}\n");
    assert_string_equal(s->source, "s.yaml");
    assert_int_equal(s->camera_count, 1);
    assert_null(s->cameras[0].name);
    assert_int_equal(s->cameras[0].line, 1);
    assert_vec(s->cameras[0].from, 0, 1, 5);
    assert_vec(s->cameras[0].to, 0, 0, 0);
    assert_vec(s->cameras[0].up, 0, 1, 0);
    assert_near(s->cameras[0].fov, 40, 0);
    assert_int_equal(s->image.width, 640);
    assert_int_equal(s->image.height, 480);
    assert_int_equal(s->image.samples, 0); /* the integrator's */
    assert_int_equal(s->image.depth, 6);
    assert_int_equal(s->image.seed, 0);
    assert_near(s->image.min_weight, 0, 0);
    assert_near(s->image.exposure, 0, 0);
    assert_int_equal(s->image.tone, LR_TONE_NONE);
    assert_near(s->image.white, 0, 0);
    assert_vec(s->ambient, 0.1, 0.1, 0.1);
    assert_vec(s->background.colors[0], 1, 1, 1);
    assert_vec(s->background.colors[1], 0.4, 0.6, 1);
    assert_vec(s->background_up, 0, 1, 0);
    assert_near(s->fog_density, 0, 0);
    assert_true(s->default_light);
    assert_int_equal(s->light_count, 0);
    assert_int_equal(s->material_count, 1);
    const lr_material *m = &s->materials[0];
    assert_null(m->name);
    assert_int_equal(m->color.kind, LR_PATTERN_NONE);
    assert_vec(m->color.colors[0], 0.8, 0.8, 0.8);
    assert_vec(m->diffuse, 1, 1, 1);
    assert_vec(m->ambient, 1, 1, 1);
    assert_vec(m->specular, 0, 0, 0);
    assert_vec(m->reflect, 0, 0, 0);
    assert_vec(m->transmit, 0, 0, 0);
    assert_vec(m->absorption, 0, 0, 0);
    assert_near(m->shininess, 32, 0);
    assert_near(m->ior, 1.5, 0);
    assert_int_equal(m->highlight, LR_HIGHLIGHT_BLINN);
    assert_false(m->fresnel);
    assert_int_equal(m->priority, 0);
    const lr_object *o = &s->objects[0];
    assert_int_equal(o->kind, LR_SPHERE);
    assert_int_equal(o->line, 3);
    assert_vec(o->sphere.center, 0, 0, 0);
    assert_near(o->sphere.radius, 1, 0);
    assert_true(o->shadow);
    assert_false(o->open);
    assert_false(o->transformed);
    lr_scene_destroy(s);
}

static void test_top_level(void **state)
{
    (void)state;
    lr_scene *s = parse_good(
        "lavaray: 1\nup: [0, 0, 2]\nambient: [0.1, 0.2, 0.3]\nbackground: black\n"
        "fog: {color: [1, 0, 0], density: 0.25}\nlights: []\n"
        "image: {width: 3, height: 4, samples: 5, depth: 0, seed: 4294967295, min_weight: 0.5, "
        "exposure: -1.5}\n"
        "cameras:\n  a: {from: [1, 2, 3], to: [4, 5, 6], fov: 90}\n  b: {up: [1, 0, 0]}\n"
        "objects: [{sphere: {}}]\n");
    assert_int_equal(s->camera_count, 2);
    assert_string_equal(s->cameras[0].name, "a");
    assert_vec(s->cameras[0].from, 1, 2, 3);
    assert_vec(s->cameras[0].up, 0, 0, 2);
    assert_near(s->cameras[0].fov, 90, 0);
    assert_string_equal(s->cameras[1].name, "b");
    assert_vec(s->cameras[1].up, 1, 0, 0);
    assert_int_equal(s->cameras[1].line, 10);
    assert_vec(s->background_up, 0, 0, 1);
    assert_vec(s->background.colors[0], 0, 0, 0);
    assert_vec(s->background.colors[1], 0, 0, 0);
    assert_vec(s->ambient, 0.1, 0.2, 0.3);
    assert_vec(s->fog_color, 1, 0, 0);
    assert_near(s->fog_density, 0.25, 0);
    assert_false(s->default_light);
    assert_int_equal(s->image.width, 3);
    assert_int_equal(s->image.height, 4);
    assert_int_equal(s->image.samples, 5);
    assert_int_equal(s->image.depth, 0);
    assert_true(s->image.seed == 4294967295u);
    assert_near(s->image.min_weight, 0.5, 0);
    assert_near(s->image.exposure, -1.5, 0);
    lr_scene_destroy(s);
}

static void test_materials(void **state)
{
    (void)state;
    lr_scene *s = parse_good(
        "camera: {}\nmaterials:\n"
        "  a: {color: [1, 2, 3], ambient: 0.5, diffuse: 0.25, specular: [1, 0, 0], shininess: 7,\n"
        "      highlight: phong, reflect: [0.1, 0.2, 0.3], transmit: 0.4, ior: 1.33,\n"
        "      fresnel: true, absorption: [0, 1, 2], priority: -3}\n"
        "  b: {reflect: [0.1, 0.5, 0.2], transmit: 0.25}\n"
        "  c: {reflect: 1, transmit: 1}\n"
        "  d: {color: {checker: [0, 1], size: 2, space: object}}\n"
        "  e: {color: {stripes: [0, 1], direction: [0, 0, 3]}}\n"
        "  f: {color: {gradient: [0, 1], from: [1, 1, 1], to: [1, 3, 1]}}\n"
        "  g: {color: {rings: [0, 1], size: 3, center: [1, 2, 3], axis: [1, 0, 0]}}\n"
        "objects:\n- sphere: {material: b}\n- sphere: {material: {color: 0.5}}\n");
    assert_int_equal(s->material_count, 8);
    const lr_material *a = &s->materials[0];
    assert_string_equal(a->name, "a");
    assert_int_equal(a->line, 3);
    assert_vec(a->color.colors[0], 1, 2, 3);
    assert_vec(a->ambient, 0.5, 0.5, 0.5);
    assert_vec(a->diffuse, 0.25, 0.25, 0.25);
    assert_vec(a->specular, 1, 0, 0);
    assert_near(a->shininess, 7, 0);
    assert_int_equal(a->highlight, LR_HIGHLIGHT_PHONG);
    assert_vec(a->reflect, 0.1, 0.2, 0.3);
    assert_vec(a->transmit, 0.4, 0.4, 0.4);
    assert_near(a->ior, 1.33, 0);
    assert_true(a->fresnel);
    assert_vec(a->absorption, 0, 1, 2);
    assert_int_equal(a->priority, -3);
    assert_vec(s->materials[1].diffuse, 0.25, 0.25, 0.25);
    assert_vec(s->materials[1].ambient, 0.25, 0.25, 0.25);
    assert_vec(s->materials[2].diffuse, 0, 0, 0);
    const lr_pattern *d = &s->materials[3].color, *e = &s->materials[4].color;
    const lr_pattern *f = &s->materials[5].color, *g = &s->materials[6].color;
    assert_int_equal(d->kind, LR_PATTERN_CHECKER);
    assert_true(d->object_space);
    assert_near(d->size, 2, 0);
    assert_vec(d->colors[0], 0, 0, 0);
    assert_vec(d->colors[1], 1, 1, 1);
    assert_int_equal(e->kind, LR_PATTERN_STRIPES);
    assert_false(e->object_space);
    assert_vec(e->direction, 0, 0, 3);
    assert_near(e->size, 1, 0);
    assert_int_equal(f->kind, LR_PATTERN_GRADIENT);
    assert_vec(f->origin, 1, 1, 1);
    assert_vec(f->direction, 0, 2, 0);
    assert_int_equal(g->kind, LR_PATTERN_RINGS);
    assert_vec(g->origin, 1, 2, 3);
    assert_vec(g->direction, 1, 0, 0);
    assert_near(g->size, 3, 0);
    assert_int_equal(s->objects[0].material, 1);
    assert_int_equal(s->objects[1].material, 7);
    assert_null(s->materials[7].name);
    assert_vec(s->materials[7].color.colors[0], 0.5, 0.5, 0.5);
    lr_scene_destroy(s);
}

static void test_lights(void **state)
{
    (void)state;
    lr_scene *s =
        parse_good("camera: {}\nlights:\n- point: {position: [1, 2, 3]}\n"
                   "- point: {position: [1, 2, 3], color: [1, 2, 3], intensity: 60, falloff: 1.5, "
                   "shadows: false}\n"
                   "- directional: {direction: [0, -2, 0], intensity: 3, angle: 0.53}\n"
                   "- spot: {position: [1, 2, 3], to: [1, 0, 3], angle: 20, radius: 0.25}\n"
                   "- spot: {position: [1, 2, 3], direction: [1, 0, 0], inner: 5}\n"
                   "objects: [{sphere: {}}]\n");
    assert_int_equal(s->light_count, 5);
    const lr_light *l = s->lights;
    assert_int_equal(l[0].kind, LR_LIGHT_POINT);
    assert_int_equal(l[0].line, 3);
    assert_vec(l[0].position, 1, 2, 3);
    assert_vec(l[0].color, 1, 1, 1);
    assert_near(l[0].intensity, 1, 0);
    assert_near(l[0].falloff, 2, 0);
    assert_true(l[0].shadows);
    assert_vec(l[1].color, 1, 2, 3);
    assert_near(l[1].intensity, 60, 0);
    assert_near(l[1].falloff, 1.5, 0);
    assert_false(l[1].shadows);
    assert_int_equal(l[2].kind, LR_LIGHT_DIRECTIONAL);
    assert_vec(l[2].direction, 0, -2, 0);
    assert_near(l[2].falloff, 0, 0);
    assert_near(l[2].angle, 0.53, 0);
    assert_near(l[0].radius, 0, 0);
    assert_near(l[3].radius, 0.25, 0);
    assert_int_equal(l[3].kind, LR_LIGHT_SPOT);
    assert_vec(l[3].direction, 0, -2, 0);
    assert_near(l[3].angle, 20, 0);
    assert_near(l[3].inner, 16, 1e-12);
    assert_vec(l[4].direction, 1, 0, 0);
    assert_near(l[4].angle, 30, 0);
    assert_near(l[4].inner, 5, 0);
    lr_scene_destroy(s);
}

static void test_objects(void **state)
{
    (void)state;
    lr_scene *s =
        parse_good(ONE "- sphere: {center: [1, 2, 3], radius: 4, shadow: false}\n"
                       "- plane: {normal: [0, 0, 2], offset: -1}\n"
                       "- box: {min: [0, 1, 2], max: [3, 4, 5]}\n"
                       "- disk: {center: [1, 0, 0], normal: [1, 0, 0], radius: 2}\n"
                       "- rectangle: {corner: [1, 1, 1], u: [1, 0, 0], v: [0, 2, 0]}\n"
                       "- cylinder: {from: [0, 0, 0], to: [0, 3, 0], radius: 0.5, open: true}\n"
                       "- cone: {from: [0, 0, 0], to: [0, 3, 0], radius: 2, top_radius: 0.5}\n"
                       "- cone: {from: [0, 0, 0], to: [0, 3, 0]}\n"
                       "- triangle: {a: [0, 0, 0], b: [1, 0, 0], c: [0, 1, 0]}\n");
    const lr_object *o = s->objects;
    assert_int_equal(s->object_count, 9);
    for (int i = 0; i < 7; i++)
        assert_int_equal(o[i].kind, i);
    assert_int_equal(o[8].kind, LR_TRIANGLE);
    assert_vec(o[0].sphere.center, 1, 2, 3);
    assert_near(o[0].sphere.radius, 4, 0);
    assert_false(o[0].shadow);
    assert_vec(o[1].plane.normal, 0, 0, 2);
    assert_near(o[1].plane.offset, -1, 0);
    assert_vec(o[2].box.min, 0, 1, 2);
    assert_vec(o[2].box.max, 3, 4, 5);
    assert_vec(o[3].disk.center, 1, 0, 0);
    assert_vec(o[3].disk.normal, 1, 0, 0);
    assert_near(o[3].disk.radius, 2, 0);
    assert_vec(o[4].rectangle.corner, 1, 1, 1);
    assert_vec(o[4].rectangle.u, 1, 0, 0);
    assert_vec(o[4].rectangle.v, 0, 2, 0);
    assert_vec(o[5].cone.to, 0, 3, 0);
    assert_near(o[5].cone.radius_from, 0.5, 0);
    assert_near(o[5].cone.radius_to, 0.5, 0);
    assert_true(o[5].open);
    assert_near(o[6].cone.radius_from, 2, 0);
    assert_near(o[6].cone.radius_to, 0.5, 0);
    assert_false(o[6].open);
    assert_near(o[7].cone.radius_from, 1, 0);
    assert_near(o[7].cone.radius_to, 0, 0);
    assert_vec(o[8].triangle.b, 1, 0, 0);
    assert_vec(o[8].triangle.c, 0, 1, 0);
    lr_scene_destroy(s);
}

/* Where the object's transform takes a point. */
#define assert_maps(object, px, py, pz, a, b, c)                                                   \
    do {                                                                                           \
        lr_vec3 p = lr_transform_point(&(object)->to_world, (lr_vec3){px, py, pz});                \
        assert_vec(p, a, b, c);                                                                    \
    } while (0)

static void test_transforms(void **state)
{
    (void)state;
    lr_scene *s = parse_good(
        ONE "- sphere: {translate: [1, 2, 3]}\n"
            "- sphere: {scale: 2, translate: [1, 0, 0]}\n"
            "- sphere: {scale: [1, 2, 3], rotate: [0, 0, 90], translate: [10, 0, 0]}\n"
            "- sphere: {rotate: [90, 0, 90]}\n"
            "- sphere: {rotate: {axis: [0, 2, 0], angle: 90}}\n"
            "- group:\n    translate: [0, 5, 0]\n    rotate: [0, 0, 90]\n    material: {ior: 2}\n"
            "    objects:\n    - sphere: {translate: [1, 0, 0]}\n"
            "    - group: {scale: 2, objects: [{sphere: {translate: [1, 0, 0]}},\n"
            "        {sphere: {material: {ior: 3}}}]}\n"
            "- sphere: {}\n"
            "- sphere: {matrix: [[1, 2, 3, 4], [0, 1, 0, -1], [0, 0, 1, 0.5]]}\n"
            "- group: {translate: [0, 5, 0], objects: [{sphere: {matrix: [[0, 1, 0, 0], "
            "[1, 0, 0, 0], [0, 0, 1, 7]]}}]}\n");
    const lr_object *o = s->objects;
    assert_int_equal(s->object_count, 11);
    assert_true(o[0].transformed);
    assert_maps(&o[0], 0, 0, 0, 1, 2, 3);
    assert_maps(&o[1], 1, 1, 1, 3, 2, 2);
    /* scaled to (0, 2, 0), turned to (-2, 0, 0), moved */
    assert_maps(&o[2], 0, 1, 0, 8, 0, 0);
    /* y goes to z about x and stays there about z; x stays, then goes to y */
    assert_maps(&o[3], 0, 1, 0, 0, 0, 1);
    assert_maps(&o[3], 1, 0, 0, 0, 1, 0);
    assert_maps(&o[4], 0, 0, 1, 1, 0, 0);
    assert_maps(&o[5], 0, 0, 0, 0, 6, 0);
    assert_maps(&o[6], 0, 0, 0, 0, 7, 0);
    assert_near(s->materials[o[5].material].ior, 2, 0);
    assert_int_equal(o[5].material, o[6].material);
    assert_near(s->materials[o[7].material].ior, 3, 0);
    assert_true(o[7].transformed);
    assert_near(s->materials[o[8].material].ior, 1.5, 0);
    assert_false(o[8].transformed);
    assert_true(o[9].transformed);
    assert_maps(&o[9], 1, 10, 100, 325, 9, 100.5);
    assert_maps(&o[10], 1, 2, 3, 2, 6, 10);
    lr_scene_destroy(s);
}

static double radius_of(const char *number)
{
    char text[200];
    snprintf(text, sizeof text, ONE "- sphere: {radius: %s}\n", number);
    lr_scene *s = parse_good(text);
    double radius = s->objects[0].sphere.radius;
    lr_scene_destroy(s);
    return radius;
}

static void test_numbers(void **state)
{
    (void)state;
    /* The decimal point does not follow the locale. */
    setlocale(LC_ALL, "de_DE.UTF-8");
    static const struct {
        const char *text;
        double value;
    } rows[] = {{"1", 1},       {"1.5", 1.5},    {".5", 0.5},     {"3.", 3},   {"1e3", 1000},
                {"1E-3", 1e-3}, {"1.5e+2", 150}, {"+4", 4},       {"010", 10}, {"0x1F", 31},
                {"0o17", 15},   {"0.1", 0.1},    {"1e-20", 1e-20}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        assert_near(radius_of(rows[i].text), rows[i].value, 0);
    setlocale(LC_ALL, "C");
}

static void test_colors(void **state)
{
    (void)state;
    for (unsigned i = 0; i < 256; i++) {
        double c = i / 255.0;
        double expected = c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
        assert_near(lr_srgb_to_linear(i), expected, 1e-15);
    }
    assert_true(lr_srgb_to_linear(255) == 1);
    static const struct {
        const char *text;
        unsigned r, g, b;
    } rows[] = {{"#ff8000", 255, 128, 0},      {"#F80", 255, 136, 0},
                {"white", 255, 255, 255},      {"AliceBlue", 240, 248, 255},
                {"yellowgreen", 154, 205, 50}, {"rebeccapurple", 102, 51, 153},
                {"grey", 128, 128, 128},       {"gray", 128, 128, 128}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        lr_color c;
        assert_true(lr_color_from_text(rows[i].text, strlen(rows[i].text), &c));
        assert_vec(c, lr_srgb_to_linear(rows[i].r), lr_srgb_to_linear(rows[i].g),
                   lr_srgb_to_linear(rows[i].b));
    }
    lr_color c;
    assert_false(lr_color_from_text("#12", 3, &c));
    assert_false(lr_color_from_text("#12345g", 7, &c));
    assert_false(lr_color_from_text("", 0, &c));
    assert_false(lr_color_from_text("reddish", 7, &c));
}

static void test_forms(void **state)
{
    (void)state;
    static const char *const forms[] = {
        "{\"camera\": {\"from\": [0, 1, 5]},\n\t\"objects\": [\n\t\t{\"sphere\": {}}\n\t]\n}\n",
        "\xEF\xBB\xBF"
        "camera: {}\r\nobjects:\r\n- sphere: {}\r\n",
        "%YAML 1.2\n---\ncamera: {}\nobjects: [sphere: {}]\n...\n",
        "camera: {}\nmaterials: {m: &m {color: red}, n: *m}\nobjects:\n- sphere: {material: *m}\n",
        "camera: {}\nmaterials: {1: {}, a b: {}, \"\": {}}\nobjects:\n- sphere: {material: 1}\n"
        "- sphere: {material: a b}\n- sphere: {material: \"\"}\n",
        "camera: {}\nobjects: [\n{sphere: {}},\n]\n",
    };
    for (size_t i = 0; i < sizeof forms / sizeof forms[0]; i++)
        lr_scene_destroy(parse_good(forms[i]));
    lr_scene_destroy(NULL);
}

static void test_load(void **state)
{
    (void)state;
    lr_scene *scene;
    char *report;
    lr_error error = {0};
    lr_status status = lr_scene_load("/nonexistent/s.yaml", NULL, &scene, &report, &error);
    assert_int_equal(status, LR_ERROR_FILE);
    assert_null(scene);
    assert_null(report);
    status = lr_scene_load(SOURCE_DIR "/tests/fuzz/corpus/scene/readme.yaml", NULL, &scene, &report,
                           &error);
    assert_int_equal(status, LR_OK);
    assert_int_equal(scene->object_count, 2);
    lr_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_defaults),  cmocka_unit_test(test_top_level),
        cmocka_unit_test(test_materials), cmocka_unit_test(test_lights),
        cmocka_unit_test(test_objects),   cmocka_unit_test(test_transforms),
        cmocka_unit_test(test_numbers),   cmocka_unit_test(test_colors),
        cmocka_unit_test(test_forms),     cmocka_unit_test(test_load),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
