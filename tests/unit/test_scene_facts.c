/* The boxes around objects, against values derived by hand, and what is counted. */
#include "scene_tests.h"

#define ONE "camera: {}\nobjects:\n"

static void check_bounds(const char *object, const double expected[6])
{
    char text[1024];
    snprintf(text, sizeof text, ONE "- %s\n", object);
    lr_scene *scene = parse_good(text);
    lr_scene_facts facts;
    lr_scene_get_facts(scene, &facts);
    assert_true(facts.bounded);
    for (int i = 0; i < 3; i++) {
        if (!(fabs(facts.min[i] - expected[i]) <= 1e-14 * (1 + fabs(expected[i]))) ||
            !(fabs(facts.max[i] - expected[3 + i]) <= 1e-14 * (1 + fabs(expected[3 + i]))))
            fail_msg("%s: axis %d is %.17g to %.17g, expected %.17g to %.17g", object, i,
                     facts.min[i], facts.max[i], expected[i], expected[3 + i]);
    }
    lr_scene_destroy(scene);
}

static void test_bounds(void **state)
{
    (void)state;
    const double h = 0.70710678118654752; /* 1 / sqrt(2) */
    const double e =
        1.58113883008418967; /* sqrt(2.5): an ellipse of 2 and 1, turned by 45 degrees */
    const double k = 0.81649658092772603; /* sqrt(2 / 3): a unit disk across (1, 1, 1) */
    const struct {
        const char *object;
        double bounds[6];
    } rows[] = {
        {"sphere: {center: [1, 2, 3], radius: 0.5}", {0.5, 1.5, 2.5, 1.5, 2.5, 3.5}},
        {"sphere: {scale: [2, 1, 3], rotate: [0, 0, 45]}", {-e, -e, -3, e, e, 3}},
        {"box: {min: [0, 0, 0], max: [1, 1, 2], rotate: [0, 0, 45]}", {-h, 0, 0, h, 2 * h, 2}},
        {"disk: {normal: [1, 1, 1]}", {-k, -k, -k, k, k, k}},
        {"disk: {normal: [0, 2, 0], radius: 3, translate: [1, 0, 0]}", {-2, 0, -3, 4, 0, 3}},
        {"rectangle: {corner: [1, 1, 1], u: [-2, 0, 0], v: [0, 1, 5]}", {-1, 1, 1, 1, 2, 6}},
        {"cylinder: {from: [0, 0, 0], to: [5, 0, 0], radius: 2}", {0, -2, -2, 5, 2, 2}},
        {"cone: {from: [0, 0, 0], to: [0, 0, -3], radius: 2, top_radius: 1, scale: 2}",
         {-4, -4, -6, 4, 4, 0}},
        {"triangle: {a: [0, 0, 0], b: [1, 0, 2], c: [0, -1, 1]}", {0, -1, 0, 1, 0, 2}},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        check_bounds(rows[i].object, rows[i].bounds);
}

static void test_counts(void **state)
{
    (void)state;
    lr_scene *scene = parse_good("cameras: {a: {}, b: {}}\nlights:\n- point: {position: [0, 1, "
                                 "0]}\n- spot: {position: [0, 1, "
                                 "0], to: [0, 0, 0]}\n- spot: {position: [0, 2, 0], to: [0, 0, "
                                 "0]}\nobjects:\n- plane: {}\n");
    lr_scene_facts facts;
    lr_scene_get_facts(scene, &facts);
    assert_false(facts.bounded);
    assert_int_equal(facts.point_lights, 1);
    assert_int_equal(facts.directional_lights, 0);
    assert_int_equal(facts.spot_lights, 2);
    for (int i = 0; i < LR_OBJECT_KINDS; i++)
        assert_int_equal(facts.objects[i].count, strcmp(facts.objects[i].name, "plane") == 0);
    assert_string_equal(lr_scene_camera_name(scene, 1), "b");
    assert_int_equal(facts.bytes, 2 * sizeof(lr_camera) + 3 * sizeof(lr_light) +
                                      sizeof(lr_material) + sizeof(lr_object));
    lr_scene_destroy(scene);
}

/* Any number that changes changes the hash; names and lines do not. */
static void test_hash(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "camera: {}\nobjects: [{sphere: {}}]\n",
        "camera: {fov_to_centers: true}\nobjects: [{sphere: {}}]\n",
        "camera: {projection: panorama}\nobjects: [{sphere: {}}]\n",
        "camera: {height: 3}\nobjects: [{sphere: {}}]\n",
        "camera: {aperture: 3}\nobjects: [{sphere: {}}]\n",
        "camera: {focus: 3}\nobjects: [{sphere: {}}]\n",
        "camera: {blades: 3}\nobjects: [{sphere: {}}]\n",
        "camera: {blade_rotation: 3}\nobjects: [{sphere: {}}]\n",
        "camera: {}\nimage: {filter: tent}\nobjects: [{sphere: {}}]\n",
        "camera: {}\nimage: {seed: 1}\nobjects: [{sphere: {}}]\n",
        "camera: {}\nimage: {tone: agx}\nobjects: [{sphere: {}}]\n",
        "camera: {}\nimage: {white: 3200}\nobjects: [{sphere: {}}]\n",
        "camera: {}\nlights: []\nobjects: [{sphere: {}}]\n",
        "camera: {}\nobjects: [{sphere: {radius: 1.0000000000000002}}]\n",
        "camera: {}\nobjects: [{sphere: {shadow: false}}]\n",
        "camera: {}\nobjects: [{sphere: {translate: [0, 0, 1]}}]\n",
        "camera: {}\nobjects: [{sphere: {material: {priority: 1}}}]\n",
        "camera: {}\nobjects: [{sphere: {material: {priority: -1}}}]\n",
        "camera: {}\nobjects: [{disk: {}}]\n",
        "camera: {}\nfog: {density: 0.1}\nobjects: [{sphere: {}}]\n",
        "camera: {}\nfog: {density: 0.1, color: 0.2}\nobjects: [{sphere: {}}]\n",
    };
    char hashes[32][65];
    int count = sizeof texts / sizeof *texts;
    lr_scene_facts facts;
    for (int i = 0; i < count; i++) {
        lr_scene *scene = parse_good(texts[i]);
        lr_scene_get_facts(scene, &facts);
        strcpy(hashes[i], facts.sha256);
        for (int k = 0; k < i; k++)
            if (strcmp(hashes[k], hashes[i]) == 0)
                fail_msg("%s and %s have one hash", texts[k], texts[i]);
        lr_scene_destroy(scene);
    }
    lr_scene *scene = parse_good("# a comment\ncameras: {only: {}}\nmaterials: {grey: {}}\n"
                                 "objects:\n\n- sphere: {material: grey, center: [-0, 0, 0]}\n");
    lr_scene_get_facts(scene, &facts);
    assert_string_equal(facts.sha256, hashes[0]);
    lr_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bounds),
        cmocka_unit_test(test_counts),
        cmocka_unit_test(test_hash),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
