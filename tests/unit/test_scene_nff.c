/* The reader of NFF: what each element becomes, and what is said about wrong ones. */
#include "scene_tests.h"

#include "scene/nff.h"

#define VIEW "v\nfrom 1 2 3\nat 0 0 0\nup 0 0 1\nangle 45\nhither 0.01\nresolution 320 200\n"
#define FILL "f 1 0.5 0.25 0.7 0.3 20 0 0\n"

static lr_status read_nff(const char *text, size_t length, lr_scene **scene, char **report)
{
    lr_error error = {0};
    return lr_nff_read(text, length, "s.nff", scene, report, &error);
}

static lr_scene *good(const char *text)
{
    lr_scene *scene;
    char *report;
    lr_status status = read_nff(text, strlen(text), &scene, &report);
    if (report)
        print_error("%s\n", report);
    free(report);
    assert_int_equal(status, LR_OK);
    return scene;
}

static void assert_vec3(lr_vec3 v, double x, double y, double z)
{
    if (v.x != x || v.y != y || v.z != z)
        fail_msg("%.17g %.17g %.17g, expected %.17g %.17g %.17g", v.x, v.y, v.z, x, y, z);
}

static void test_surroundings(void **state)
{
    (void)state;
    lr_scene *scene = good("# a comment\nb 0.1 0.2 0.3 # and another\n" VIEW
                           "l 4 3 2\nl 1 -4 4\n\nl -3 1 5 1 0.5 0\n" FILL "s 0 0 0 1\n");
    assert_vec3(scene->background.colors[0], 0.1, 0.2, 0.3);
    assert_vec3(scene->background.colors[1], 0.1, 0.2, 0.3);
    assert_int_equal(scene->camera_count, 1);
    const lr_camera *camera = &scene->cameras[0];
    assert_vec3(camera->from, 1, 2, 3);
    assert_vec3(camera->to, 0, 0, 0);
    assert_vec3(camera->up, 0, 0, 1);
    assert_near(camera->fov, 45, 0);
    assert_true(camera->fov_to_centers);
    assert_int_equal(camera->line, 3);
    assert_int_equal(scene->image.width, 320);
    assert_int_equal(scene->image.height, 200);
    assert_int_equal(scene->image.samples, 1);
    assert_int_equal(scene->image.depth, 4);
    assert_vec3(scene->ambient, 0, 0, 0);
    assert_int_equal(scene->light_count, 3);
    assert_false(scene->default_light);
    for (int i = 0; i < 3; i++) {
        const lr_light *light = &scene->lights[i];
        assert_int_equal(light->kind, LR_LIGHT_POINT);
        assert_near(light->falloff, 0, 0);
        assert_near(light->intensity, i < 2 ? 0.57735026918962576 : 1, 1e-16);
        assert_true(light->shadows);
    }
    assert_vec3(scene->lights[1].position, 1, -4, 4);
    assert_vec3(scene->lights[1].color, 1, 1, 1);
    assert_vec3(scene->lights[2].color, 1, 0.5, 0);
    assert_int_equal(scene->note_count, 0);
    lr_scene_destroy(scene);

    scene = good(VIEW FILL "s 0 0 0 1");
    assert_vec3(scene->background.colors[0], 0, 0, 0);
    assert_true(scene->default_light);
    assert_int_equal(scene->note_count, 1);
    assert_string_equal(scene->notes[0], "s.nff: no lights, one that suits the camera added");
    lr_scene_destroy(scene);
}

static void test_materials(void **state)
{
    (void)state;
    lr_scene *scene = good(VIEW FILL "s 0 0 0 1\nf 1 1 1 0.1 0.1 101.148 0.9 1.5\ns 1 0 0 1\n" FILL
                                     "s 2 0 0 1\nf 1 0.5 0.25 0.7 0.3 20 0 1.7\ns 3 0 0 1\n");
    assert_int_equal(scene->material_count, 2);
    const lr_material *m = &scene->materials[0];
    assert_int_equal(m->color.kind, LR_PATTERN_NONE);
    assert_vec3(m->color.colors[0], 1, 0.5, 0.25);
    assert_vec3(m->diffuse, 0.7, 0.7, 0.7);
    assert_vec3(m->specular, 0.3, 0.3, 0.3);
    assert_vec3(m->reflect, 0.3, 0.3, 0.3);
    assert_vec3(m->transmit, 0, 0, 0);
    assert_vec3(m->ambient, 0, 0, 0);
    assert_near(m->shininess, 20, 0);
    assert_near(m->ior, 1, 0);
    assert_int_equal(m->highlight, LR_HIGHLIGHT_PHONG);
    assert_false(m->one_sided);
    assert_vec3(m[1].transmit, 0.9, 0.9, 0.9);
    assert_near(m[1].ior, 1.5, 0);
    assert_near(m[1].shininess, 101.148, 0);
    assert_false(m[1].one_sided);
    static const uint32_t used[] = {0, 1, 0, 0}; /* T is 0: the last ior means nothing */
    for (int i = 0; i < 4; i++)
        assert_int_equal(scene->objects[i].material, used[i]);
    lr_scene_destroy(scene);
}

static void test_round_objects(void **state)
{
    (void)state;
    lr_scene *scene = good(VIEW FILL "s 1 2 3 0.5\ns 1 2 3 -0.5\nc 0 0 0 1 0 0 2 1\n"
                                     "c 0 0 0 2\n0 0 3 1\nc 0 0 0 -1 0 0 2 -1\nc 0 0 0 0 0 0 2 -1\n"
                                     "f 1 1 1 0 0 1 1 1.5\ns 0 0 0 -1\n"
                                     "s 0 0 0 0\nc 1 1 1 1 1 1 1 2\nc 0 0 0 0 0 0 1 0\n");
    static const struct {
        lr_object_kind kind;
        bool inward;
        double from, to;
    } rows[] = {
        {LR_SPHERE, false, 0.5, 0}, {LR_SPHERE, true, 0.5, 0}, {LR_CYLINDER, false, 1, 1},
        {LR_CONE, false, 2, 1},     {LR_CYLINDER, true, 1, 1}, {LR_CONE, true, 0, 1},
        {LR_SPHERE, false, 1, 0},
    };
    assert_int_equal(scene->object_count, 7);
    for (int i = 0; i < 7; i++) {
        const lr_object *object = &scene->objects[i];
        assert_int_equal(object->kind, rows[i].kind);
        assert_int_equal(object->inward, rows[i].inward);
        assert_int_equal(object->open, object->kind != LR_SPHERE);
        assert_true(object->shadow);
        assert_false(object->transformed);
        if (object->kind == LR_SPHERE) {
            assert_near(object->sphere.radius, rows[i].from, 0);
            continue;
        }
        assert_near(object->cone.radius_from, rows[i].from, 0);
        assert_near(object->cone.radius_to, rows[i].to, 0);
    }
    assert_vec3(scene->objects[0].sphere.center, 1, 2, 3);
    assert_vec3(scene->objects[3].cone.to, 0, 0, 3);
    assert_int_equal(scene->objects[3].line, 12);
    assert_string_equal(scene->notes[0],
                        "s.nff:18: spheres and cones without a size, left out: 3 from here on");
    assert_int_equal(scene->note_count, 2); /* and the light that is added */
    lr_scene_destroy(scene);
}

static double mesh_area(const lr_mesh *mesh)
{
    double sum = 0;
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        lr_vec3 v[3];
        for (int k = 0; k < 3; k++) {
            assert_true(mesh->triangles[3 * i + k] < mesh->vertex_count);
            const float *p = mesh->positions + 3 * mesh->triangles[3 * i + k];
            v[k] = (lr_vec3){p[0], p[1], p[2]};
        }
        sum +=
            0.5 * lr_vec3_length(lr_vec3_cross(lr_vec3_sub(v[1], v[0]), lr_vec3_sub(v[2], v[0])));
    }
    return sum;
}

static void test_polygons(void **state)
{
    (void)state;
    /* Two squares that share an edge, a concave arrow of area 6, a triangle of another material, a
     * patch of the first one, and what is left out. */
    lr_scene *scene = good(VIEW FILL "p 4 0 0 0 1 0 0 1 1 0 0 1 0\np 4 1 0 -0 2 0 0 2 1 0 1 1 0\n"
                                     "p 4 5 1 0 9 -2 0 5 4 0 1 -2 0\n"
                                     "f 1 1 1 0 0 1 0.5 1.5\np 3 0 0 5 1 0 5 0 1 5\n" FILL
                                     "pp 3\n0 0 2 0 0 2\n1 0 2 0 3 4\n0 1 2 0 0 0\n"
                                     "pp 3\n1 0 2 0 3 4\n1 1 2 1 0 0\n0 1 2 0 0 1\n"
                                     "p 3 0 0 0 1 1 1 2 2 2\n"
                                     "p 3 1e6 0 0 1000000.001 0 0 1e6 0.001 0\n");
    assert_int_equal(scene->mesh_count, 3);
    assert_int_equal(scene->object_count, 3);
    const lr_mesh *flat = &scene->meshes[0], *patch = &scene->meshes[1], *glass = &scene->meshes[2];
    assert_string_equal(flat->name, "s.nff: polygons with the material of line 8");
    assert_string_equal(patch->name, "s.nff: patches with the material of line 8");
    assert_int_equal(flat->vertex_count, 10);
    assert_int_equal(flat->triangle_count, 6);
    assert_near(mesh_area(flat), 2 + 12, 1e-5);
    assert_null(flat->normals);
    assert_false(flat->closed);
    assert_true(glass->closed);
    assert_int_equal(glass->triangle_count, 1);
    static const uint32_t corners[] = {0, 1, 2};
    assert_memory_equal(glass->triangles, corners, sizeof corners);
    /* Two of the corners are shared: the third normal became the patch's own, which is z. */
    assert_int_equal(patch->vertex_count, 4);
    assert_int_equal(patch->triangle_count, 2);
    static const float normals[] = {0, 0, 1, 0, 0.6f, 0.8f, 0, 0, 1, 1, 0, 0};
    static const float positions[] = {0, 0, 2, 1, 0, 2, 0, 1, 2, 1, 1, 2};
    for (int i = 0; i < 12; i++) {
        assert_near(patch->normals[i], normals[i], 1e-7);
        assert_near(patch->positions[i], positions[i], 0);
    }
    for (uint32_t i = 0; i < 3; i++) {
        assert_int_equal(scene->objects[i].kind, LR_MESH);
        assert_int_equal(scene->objects[i].mesh, i);
        assert_int_equal(scene->objects[i].material, i / 2);
    }
    assert_int_equal(scene->note_count, 4); /* one of them tells that there are no lights */
    assert_string_equal(scene->notes[0],
                        "s.nff:23: polygons without an area, left out: 1 from here on");
    assert_string_equal(scene->notes[1],
                        "s.nff:24: triangles too small for single precision, left out: 1 from "
                        "here on");
    assert_string_equal(scene->notes[2],
                        "s.nff:15: normals of length 0, replaced by their polygon's: 1 from here "
                        "on");
    lr_scene_destroy(scene);
}

/* Numbers are correctly rounded: strtod is the judge. */
static void test_numbers(void **state)
{
    (void)state;
    static const char *const numbers[] = {
        "0.1",
        "-2.1",
        "+3",
        "1e-05",
        "1.7976931348623157e11",
        ".5",
        "5.",
        "1E3",
        "0.30000000000000004",
        "9007199254740993",
        "123456789012345678901",
        "1e-320",
        "-0.000",
        "8.5e-23",
        "4503599627370497.5",
        "1e-9999",
        "000000000000000000000000000000000000000000000000000000000000000000000000000000000000001.5",
        "3.14159265358979323846264338327950288419716939937510582097494459230781640628620899862803",
    };
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        char text[1024];
        double expected = strtod(numbers[i], NULL) + 0.0, scale = fabs(expected) > 1e12 ? 0 : 1;
        snprintf(text, sizeof text, VIEW FILL "s %s 0 0 1\n", numbers[i]);
        if (scale == 0)
            continue;
        lr_scene *scene = good(text);
        double value = scene->objects[0].sphere.center.x;
        assert_memory_equal(&value, &expected, sizeof value);
        lr_scene_destroy(scene);
    }
    uint32_t seed = 7;
    for (int i = 0; i < 20000; i++) {
        char text[256], number[64];
        uint64_t digits = 0;
        for (int k = 0; k < 3; k++) {
            seed = seed * 1664525u + 1013904223u;
            digits = digits << 24 ^ seed >> 8;
        }
        snprintf(number, sizeof number, "%llue-%d", (unsigned long long)(digits >> i % 60),
                 8 + i % 40);
        double expected = strtod(number, NULL);
        if (expected > 1e12)
            continue;
        snprintf(text, sizeof text, VIEW FILL "s %s 0 0 1\n", number);
        lr_scene *scene = good(text);
        assert_memory_equal(&scene->objects[0].sphere.center.x, &expected, sizeof expected);
        lr_scene_destroy(scene);
    }
}

static void test_errors(void **state)
{
    (void)state;
    static const struct {
        const char *text, *expected;
    } rows[] = {
        {"", "s.nff:1:1: the file has no viewpoint, expected a line \"v\""},
        {VIEW FILL, "the file has no object, expected s, c, p or pp"},
        {VIEW "s 0 0 0 1", "s.nff:8:1: an object before the first fill colour, expected a line"},
        {VIEW FILL "s 0 0 0 1\nq 1", "s.nff:10:1: q, expected one of v, b, l, f, s, c, p, pp"},
        {VIEW FILL "s 0 0 0 1 2", "s.nff:9:11: 2, expected one of v, b, l, f, s, c, p, pp"},
        {VIEW FILL "s 0 0 0", "s.nff:9:8: the file ends before the radius of the sphere"},
        {VIEW FILL "s 0 0 x 1", "s.nff:9:7: x stands where the z of the centre of the sphere "
                                "should be, expected a number"},
        {VIEW FILL "s 0 0 nan 1", "nan stands where the z of the centre"},
        {VIEW FILL "s 0 0 -inf 1", "-inf stands where the z of the centre"},
        {VIEW FILL "s 0 0 0x10 1", "0x10 stands where the z of the centre"},
        {VIEW FILL "s 0 0 1e 1", "1e stands where the z of the centre"},
        {VIEW FILL "s 0 0 1e999 1",
         "the z of the centre of the sphere is 1e999, expected a number from -1e12 to 1e12"},
        {VIEW FILL "s 0 0 0 1e13", "the radius of the sphere is 1e13"},
        {VIEW FILL "c 0 0 0 1 0 0 1 -1", "s.nff:9:1: one of the cone's radii is positive and one"},
        {VIEW FILL "p 2 0 0 0 1 1 1", "s.nff:9:3: the number of vertices of the polygon is 2, "
                                      "expected a number from 3 to 10000"},
        {VIEW FILL "p 99999999999 0 0 0", "the number of vertices of the polygon is 99999999999"},
        {VIEW FILL "p 3.5 0 0 0", "s.nff:9:3: the number of vertices is no whole number"},
        {VIEW FILL "p 4\n0 0 0\n1 0 0\n1 1 0\ns 0 0 0 1",
         "s.nff:13:1: s stands where the x of a vertex of the polygon should be"},
        {VIEW FILL "pp 3 0 0 0 0 0", "the file ends before the z of a normal of the polygon"},
        {VIEW "f 1 1 1 1 1.5 1 0 0", "the specular component of the fill colour is 1.5, expected a "
                                     "number from 0 to 1"},
        {VIEW "f 1 1 1 1 1 1 0.5 0", "the index of refraction of the fill colour is 0, expected a "
                                     "number from 0.01 to 100"},
        {VIEW "f -1 1 1 1 1 1 0 0", "the red of the fill colour is -1"},
        {VIEW VIEW FILL "s 0 0 0 1", "s.nff:8:1: a second viewpoint, expected one in a file"},
        {"v\nfrom 1 2 3\nup 0 0 1", "s.nff:3:1: up, expected \"at\" in the viewpoint"},
        {"v\nfrom 1 2 3", "the file ends, expected \"at\" in the viewpoint"},
        {"v\nfrom 1 2 3\nat 1 2 3\nup 0 0 1\nangle 4\nhither 0\nresolution 2 2",
         "s.nff:1:1: from and at are the same point, expected two"},
        {"v\nfrom 1 0 0\nat 0 0 0\nup 1 0 0\nangle 4\nhither 0\nresolution 2 2",
         "up is zero or lies along the view, expected another direction"},
        {"v\nfrom 1 0 0\nat 0 0 0\nup 0 0 1\nangle 180\nhither 0\nresolution 2 2",
         "the angle of the viewpoint is 180"},
        {"v\nfrom 1 0 0\nat 0 0 0\nup 0 0 1\nangle 18\nhither 0\nresolution 2.5 2",
         "the resolution is no whole number of pixels"},
        {"v\nfrom 1 0 0\nat 0 0 0\nup 0 0 1\nangle 18\nhither 0\nresolution 0 2",
         "the width of the viewpoint is 0, expected a number from 1 to 32768"},
        {VIEW FILL "s 0 0 0 0\np 3 0 0 0 0 0 0 0 0 0", "all objects of the file have no size"},
        {VIEW FILL "l 1 2\ns 0 0 \xFF\x1B 1", "\\xFF\\x1B stands where the z"},
        {VIEW "l 1 2 3 1 1\n" FILL "s 0 0 0 1",
         "s.nff:9:1: f stands where the blue of the light should be"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        /* An exact copy, so that a sanitizer sees reads past the end. */
        size_t length = strlen(rows[i].text);
        char *copy = malloc(length ? length : 1), *report;
        memcpy(copy, rows[i].text, length);
        lr_scene *scene;
        lr_status status = read_nff(copy, length, &scene, &report);
        if (status != LR_ERROR_SCENE || !strstr(report, rows[i].expected))
            fail_msg("for:\n%s\nexpected: %s\ngot:\n%s", rows[i].text, rows[i].expected,
                     report ? report : "no report");
        assert_null(scene);
        free(report);
        free(copy);
    }
}

/* All errors are told, each once, and reading goes on behind them. */
static void test_many_errors(void **state)
{
    (void)state;
    const char *text = "v\nfrom x\n" FILL "s 0 0 1\nc 1 2 y\np 3 1 1\nq q q\ns 1 1 1 1 1\n";
    lr_scene *scene;
    char *report;
    assert_int_equal(read_nff(text, strlen(text), &scene, &report), LR_ERROR_SCENE);
    static const char *const starts[] = {
        "s.nff:2:6:", "s.nff:5:1:", "s.nff:5:7:", "s.nff:7:1:", "s.nff:8:11:"};
    const char *at = report;
    for (int i = 0; i < 5; i++)
        if (!(at = strstr(at, starts[i])))
            fail_msg("no %s in:\n%s", starts[i], report);
    free(report);
}

static void test_line_ends(void **state)
{
    (void)state;
    static const char *const ends[] = {"\n", "\r\n", "\r"};
    for (int i = 0; i < 3; i++) {
        char text[1024] = "\xEF\xBB\xBF", *report;
        for (const char *c = VIEW "l 1 2 3 # 1 1 1\n" FILL "s 0 0 0 1\nq"; *c; c++)
            snprintf(text + strlen(text), sizeof text - strlen(text), "%.*s", *c == '\n' ? 2 : 1,
                     *c == '\n' ? ends[i] : c);
        lr_scene *scene;
        assert_int_equal(read_nff(text, strlen(text), &scene, &report), LR_ERROR_SCENE);
        assert_non_null(strstr(report, "s.nff:11:1: q, expected"));
        free(report);
        text[strlen(text) - 1] = '\0';
        scene = good(text);
        assert_int_equal(scene->objects[0].line, 10);
        lr_scene_destroy(scene);
    }
}

/* The files of the Standard Procedural Databases, where they are at hand: the counts are of words
 * at the start of lines (grep), of triangles the sum of vertices - 2. */
static void test_databases(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        uint32_t lights, materials, spheres, meshes, triangles;
    } rows[] = {
        {"balls", 3, 2, 7381, 1, 2}, {"gears", 5, 63, 0, 63, 9217 * 2 + 128 * 142},
        {"mount", 1, 2, 4, 1, 8192}, {"teapot", 2, 3, 0, 3, 36 * 2 + 2256},
        {"tetra", 1, 1, 0, 1, 4096},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char path[1024], *report;
        snprintf(path, sizeof path, SOURCE_DIR "/../shared/data/spd/%s.nff", rows[i].name);
        FILE *file = fopen(path, "r");
        if (!file) {
            print_message("%s is not there\n", path);
            skip();
        }
        fclose(file);
        lr_scene *scene;
        lr_error error = {0};
        lr_status status = lr_scene_load(path, NULL, &scene, &report, &error);
        if (status != LR_OK)
            fail_msg("%s: %s", error.message, report ? report : "");
        assert_int_equal(scene->light_count, rows[i].lights);
        assert_int_equal(scene->material_count, rows[i].materials);
        assert_int_equal(scene->mesh_count, rows[i].meshes);
        assert_int_equal(scene->object_count, rows[i].spheres + rows[i].meshes);
        uint32_t triangles = 0;
        for (uint32_t k = 0; k < scene->mesh_count; k++)
            triangles += scene->meshes[k].triangle_count;
        assert_int_equal(triangles, rows[i].triangles);
        if (scene->note_count)
            fail_msg("%s", scene->notes[0]);
        lr_scene_destroy(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_surroundings),  cmocka_unit_test(test_materials),
        cmocka_unit_test(test_round_objects), cmocka_unit_test(test_polygons),
        cmocka_unit_test(test_numbers),       cmocka_unit_test(test_errors),
        cmocka_unit_test(test_many_errors),   cmocka_unit_test(test_line_ends),
        cmocka_unit_test(test_databases),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
