/* Values with keys, frame by frame. */
#include "scene_tests.h"

#include "scene/camera.h"
#include "scene/load.h"
#include "scene/save_camera.h"

static lr_scene *parse_at(const char *text, double frame)
{
    lr_scene *scene = NULL;
    char *report = NULL;
    lr_error error = {0};
    const lr_load_options options = {.frame = frame};
    if (lr_scene_parse_with(text, strlen(text), "s.yaml", &options, &scene, &report, &error))
        fail_msg("%s\n%s", error.message, report ? report : "");
    return scene;
}

static void assert_vector(lr_vec3 found, double x, double y, double z)
{
    assert_near(found.x, x, 1e-12);
    assert_near(found.y, y, 1e-12);
    assert_near(found.z, z, 1e-12);
}

static const char everything[] =
    "camera: {from: {keys: {0: [0, 1, 5], 10: [10, 1, 5]}}, fov: {keys: {0: 30, 10: 50}},\n"
    "         aperture: 0.1, focus: {keys: {10: 2, 20: 4}}}\n"
    "image: {exposure: {keys: {0: -1, 10: 1}}}\n"
    "background: {keys: {0: 0, 10: white}}\n"
    "ambient: {keys: {0: [0, 0, 0], 4: [1, 2, 3], 10: 0}}\n"
    "materials:\n"
    "  m: {color: {keys: {0: [1, 0, 0], 10: [0, 0, 1]}}, emission: {keys: {0: 0, 10: 5}}}\n"
    "  n: {color: {checker: [{keys: {0: 0, 10: 1}}, white]}}\n"
    "lights:\n"
    "  - point: {position: [0, {keys: {0: 2, 10: 4}}, 0], intensity: {keys: {5: 0, 6: 9}}}\n"
    "objects:\n"
    "  - group:\n"
    "      translate: {keys: {0: [0, 0, 0], 10: [0, 0, 10]}}\n"
    "      objects:\n"
    "        - sphere: {radius: {keys: {0: 1, 10: 3}}, material: m}\n"
    "        - sphere: {rotate: {keys: {0: [0, 0, 0], 10: [0, 360, 0]}}, translate: [1, 0, 0]}\n"
    "        - sphere: {rotate: {axis: [0, 0, 1], angle: {keys: {0: 0, 10: 180}}}, material: n}\n"
    "        - sphere: {scale: {keys: {0: 1, 10: [1, 2, 3]}}}\n";

static void test_values(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        double frame = i * 5, share = i * 0.5;
        lr_scene *s = parse_at(everything, frame);
        assert_true(s->moves);
        assert_vector(s->cameras[0].from, 10 * share, 1, 5);
        assert_near(s->cameras[0].fov, 30 + 20 * share, 1e-12);
        assert_near(s->cameras[0].focus, 2, 0); /* before the first key */
        assert_near(s->image.exposure, -1 + 2 * share, 1e-12);
        assert_vector(s->background.colors[1], share, share, share);
        assert_vector(s->materials[0].color.colors[0], 1 - share, 0, share);
        assert_vector(s->materials[0].color.colors[1], 1 - share, 0, share);
        assert_near(s->materials[0].emission.x, 5 * share, 1e-12);
        assert_near(s->materials[1].color.colors[0].x, share, 1e-12);
        assert_near(s->lights[0].position.y, 2 + 2 * share, 1e-12);
        assert_near(s->lights[0].intensity, i == 2 ? 9 : 0, 1e-12); /* ... and after the last */
        assert_near(s->objects[0].sphere.radius, 1 + 2 * share, 1e-12);
        assert_near(s->objects[0].to_world.m[2][3], 10 * share, 1e-12);
        /* Angles as they are written: half a turn after half of the way, and a whole one. */
        assert_near(s->objects[1].to_world.m[0][0], i == 1 ? -1 : 1, 1e-12);
        lr_vec3 turned = lr_transform_vector(&s->objects[2].to_world, (lr_vec3){1, 0, 0});
        assert_vector(turned, i == 0 ? 1 : i == 1 ? 0 : -1, i == 1 ? 1 : 0, 0);
        assert_near(s->objects[3].to_world.m[1][1], 1 + share, 1e-12);
        assert_near(s->objects[3].to_world.m[2][2], 1 + 2 * share, 1e-12);
        lr_scene_destroy(s);
    }
    lr_scene *s = parse_at(everything, 4);
    assert_vector(s->ambient, 1, 2, 3); /* on a key, and between unequal ones */
    lr_scene_destroy(s);
    s = parse_at(everything, 7);
    assert_vector(s->ambient, 0.5, 1, 1.5);
    lr_scene_destroy(s);
    s = parse_at(everything, 999);
    assert_near(s->cameras[0].focus, 4, 0);
    lr_scene_destroy(s);
    s = parse_good("camera: {}\nobjects: [{sphere: {radius: {keys: {3: 2}}}}]\n");
    assert_false(s->moves);
    assert_near(s->objects[0].sphere.radius, 2, 0);
    lr_scene_destroy(s);
}

/* The camera also as it is when its shutter closes. */
static void test_shutter(void **state)
{
    (void)state;
    static const char text[] =
        "cameras:\n"
        "  a: {from: {keys: {0: [0, 0, 5], 4: [4, 0, 5]}}, fov: {keys: {0: 10, 2: 20}},\n"
        "      shutter: 0.5}\n"
        "  b: {from: {keys: {0: [0, 0, 5], 4: [4, 0, 5]}}}\n"
        "  c: {shutter: 1}\n"
        "objects: [{sphere: {}}]\n";
    lr_scene *s = parse_at(text, 1);
    lr_camera closing = lr_camera_closing(&s->cameras[0]);
    assert_true(s->cameras[0].moves);
    assert_vector(s->cameras[0].from, 1, 0, 5);
    assert_vector(closing.from, 1.5, 0, 5);
    assert_vector(closing.to, 0, 0, 0);
    assert_near(s->cameras[0].fov, 15, 1e-12);
    assert_near(closing.fov, 17.5, 1e-12);
    assert_false(lr_camera_is_pinhole(&s->cameras[0]));
    for (int i = 1; i < 3; i++) {
        assert_false(s->cameras[i].moves);
        closing = lr_camera_closing(&s->cameras[i]);
        assert_true(lr_camera_same(&closing, &s->cameras[i]));
        assert_true(lr_camera_is_pinhole(&s->cameras[i]));
    }
    lr_scene_destroy(s);
    s = parse_at(text, 4); /* where it has come to rest */
    assert_false(s->cameras[0].moves);
    lr_scene_destroy(s);
}

#define OBJECTS "\nobjects: [{sphere: {}}]\n"

static void test_errors(void **state)
{
    (void)state;
    static const char *const wrong[][2] = {
        {"camera: {fov: {keys: {}}}" OBJECTS, "1:22: keys of fov is a mapping, expected frames"},
        {"camera: {fov: {keys: [1, 2]}}" OBJECTS, "keys of fov is a list of 2, expected frames"},
        {"camera: {fov: {keys: {a: 2}}}" OBJECTS, "1:23: a frame of fov is a, expected a number"},
        {"camera: {fov: {keys: {0: 2, 0.0: 3}}}" OBJECTS,
         "1:29: a frame of fov is 0, expected more"},
        {"camera: {fov: {keys: {5: 2, 3: 3}}}" OBJECTS, "1:29: a frame of fov is 3, expected more"},
        {"camera: {fov: {keys: {0: 2, 9: 200}}}" OBJECTS, "1:32: fov is 200, expected a number"},
        {"camera: {from: {keys: {0: 2}}}" OBJECTS, "1:27: from is 2, expected three numbers"},
        {"camera: {fov: {keys: {0: 2}, ease: in}}" OBJECTS, "1:15: fov is a mapping, expected"},
        {"camera: {}\nimage: {width: {keys: {0: 2}}}" OBJECTS, "2:16: width is a mapping"},
        {"camera: {from: {keys: {0: [0, 0, 1], 1: [0, 0, 0]}}, shutter: 1}" OBJECTS,
         "1:16: the camera's from and to are the same point"},
        {"camera: {up: {keys: {0: [0, 1, 0], 1: [0, 0, 0]}}}" OBJECTS, NULL},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        if (wrong[i][1])
            assert_true(reports(wrong[i][0], wrong[i][1]));
        else
            lr_scene_destroy(parse_good(wrong[i][0]));
    /* A direction that is none on the way is one of the frame in which it is. */
    lr_scene *scene;
    char *report;
    const char *text = wrong[10][0];
    assert_int_equal(lr_scene_parse_with(text, strlen(text), "s.yaml",
                                         &(lr_load_options){.frame = 1}, &scene, &report, NULL),
                     LR_ERROR_SCENE);
    assert_non_null(strstr(report, "up is [0, 0, 0], expected a direction"));
    free(report);
}

/* A pose does not replace a way; what has no keys is saved beside it. */
static void test_saving(void **state)
{
    (void)state;
    static const char text[] = "camera: {from: {keys: {0: [0, 1, 5], 9: [3, 1, 5]}}, to: [0, "
                               "{keys: {0: 0, 9: 1}}, 0], fov: 30}" OBJECTS;
    lr_scene *scene = parse_good(text);
    lr_camera camera = scene->cameras[0];
    char *edited;
    size_t length;
    lr_error error = {0};
    camera.from.x = 7;
    assert_int_equal(
        lr_camera_edit(text, strlen(text), "s.yaml", 0, &camera, &edited, &length, &error),
        LR_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "s.yaml:1: the camera's from has keys"));
    assert_null(edited);
    camera.from.x = 0;
    camera.to.x = 1;
    assert_int_equal(
        lr_camera_edit(text, strlen(text), "s.yaml", 0, &camera, &edited, &length, &error),
        LR_ERROR_ARGUMENT);
    assert_non_null(strstr(error.message, "the camera's to has keys"));
    camera.to.x = 0;
    camera.fov = 31;
    assert_int_equal(
        lr_camera_edit(text, strlen(text), "s.yaml", 0, &camera, &edited, &length, &error), LR_OK);
    assert_non_null(strstr(edited, "0], fov: 31}"));
    assert_non_null(strstr(edited, "9: [3, 1, 5]"));
    free(edited);
    lr_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_values),
        cmocka_unit_test(test_shutter),
        cmocka_unit_test(test_errors),
        cmocka_unit_test(test_saving),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
