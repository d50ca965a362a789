/* Meshes as nobody would make them, but programs do: they render, or say why not. */
#include "gpu_tests.h"

#include "mesh_tests.h"
#include "scene/scene.h"

#define BEGINNING                                                                                  \
    "camera: {from: [0, 0, 4], to: [0, 0, 0], fov: 40}\nimage: {width: 32, height: 32}\n"          \
    "ambient: 1\nlights: []\nobjects:\n"

#define COINCIDENT                                                                                 \
    "camera: {from: [0, 0, %g], to: [0, 0, %g], fov: 10}\n"                                        \
    "image: {width: 8, height: 8, depth: 0}\nambient: %d\n"                                        \
    "lights: [%s]\nobjects:\n"                                                                     \
    "  - mesh: {file: first.ply, %s}\n"                                                            \
    "  - mesh: {file: second.ply, material: {color: [0, 0.25, 0]}}\n"                              \
    "  - plane: {normal: [0, 0, 1], offset: -9}\n"

static test_mesh triangle_times(uint32_t count)
{
    test_mesh m = make_mesh(3, count);
    set_vertex(&m, 0, -4, -4, 0);
    set_vertex(&m, 1, 4, -4, 0);
    set_vertex(&m, 2, 0, 6, 0);
    for (uint32_t i = 0; i < count; i++)
        set_triangle(&m, i, 0, 1, 2);
    return m;
}

static void write_and_free(test_mesh m, const char *name)
{
    write_mesh(&m, name);
    free_mesh(&m);
}

/* All pixels are hit, in this colour. */
static void expect_color(const picture *p, double r, double g)
{
    assert_int_equal(p->stats.primary.hit, p->stats.primary.traced);
    for (uint32_t i = 0; i < p->image.width * p->image.height; i++) {
        rgb c = pixel_at(p, i % p->image.width, i / p->image.width);
        assert_near(c.r, r, 1e-6);
        assert_near(c.g, g, 1e-6);
    }
}

/* Of triangles in the same place those that nothing can show of are not looked at. */
static void test_coincident_triangles(void **state)
{
    write_and_free(triangle_times(100000), "heap.ply");
    for (uint32_t times = 1; times <= 2; times++)
        for (uint32_t single = 0; single <= 1; single++) {
            text t = {0};
            add(&t, BEGINNING);
            for (uint32_t i = 0; i < times; i++)
                add(&t,
                    "  - mesh: {file: heap.ply, material: {color: [0.5, 0.25, 0]}, "
                    "translate: [0, 0, -%u]}\n",
                    i);
            picture p = render_in_folder(*state, &t, &(lr_render_options){.single_rays = single});
            expect_color(&p, 0.5, 0.25);
            free_picture(&p);
        }
}

/* Light that goes through triangles in the same place is dimmed by each. */
static void test_coincident_transparent_triangles(void **state)
{
    enum { COUNT = 8000 };
    write_and_free(triangle_times(COUNT), "heap.ply");
    text t = {0};
    add(&t, "camera: {from: [0, 0, -2], to: [0, 0, -4], fov: 20}\n"
            "image: {width: 8, height: 8, depth: 0}\n"
            "lights: [directional: {direction: [0, 0, -1], intensity: 1}]\nobjects:\n"
            "  - plane: {normal: [0, 0, 1], offset: -4, material: {color: 1, ambient: 0}}\n"
            "  - mesh: {file: heap.ply, material: {transmit: 0.9998}}\n");
    picture p = render_in_folder(*state, &t, NULL);
    assert_near(pixel_at(&p, 4, 4).g, pow(0.9998, COUNT), 0.01);
    free_picture(&p);
}

/* A heap of which nothing can be left out is rendered right or, by drivers that end long loops,
 * refused; never in silence without a part of it. */
static void test_endless_heap(void **state)
{
    enum { COUNT = 150000 };
    write_and_free(triangle_times(COUNT), "heap.ply");
    text t = {0};
    add(&t, "camera: {from: [0, 0, 4], to: [0, 0, 0], fov: 20}\n"
            "image: {width: 8, height: 8, depth: 0}\nambient: 1\nlights: []\nobjects:\n"
            "  - mesh: {file: heap.ply, material: {color: 0.5, transmit: 0.5}}\n");
    lr_scene *scene = parse_in_folder(&t);
    for (uint32_t single = 0; single <= 1; single++) {
        picture p = {0};
        lr_error error = {0};
        lr_render_options options = {.single_rays = single};
        lr_status status = lr_render(*state, scene, &options, &p.image, &p.stats, &error);
        bool cut_short = strstr(lr_device_get_info(*state)->driver, "Mesa 22.3") != NULL;
        print_message("%s: %s\n", lr_device_get_info(*state)->driver, status ? "refused" : "done");
        assert_true(status == LR_ERROR_DEVICE || (status == LR_OK && !cut_short));
        free_picture(&p);
    }
    lr_scene_destroy(scene);
}

/* What is behind the first of two objects in the same place shows where that one is not there, and
 * casts the shadow that it does not. */
static void test_coincident_objects(void **state)
{
    write_and_free(triangle_times(4000), "first.ply");
    write_and_free(triangle_times(4000), "second.ply");
    static const struct {
        const char *first;
        double from, red, green, floor;
    } cases[] = {
        {"material: {color: [0.5, 0, 0]}", 4, 0.5, 0, 0},
        {"material: {color: [0.5, 0, 0]}", -4, 0.5, 0, 0},
        {"material: {color: [0.5, 0, 0], one_sided: true}", 4, 0.5, 0, 0},
        {"material: {color: [0.5, 0, 0], one_sided: true}", -4, 0, 0.25, 0},
        {"shadow: false, material: {color: [0.5, 0, 0]}", 4, 0.5, 0, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        text seen = {0}, floor = {0};
        add(&seen, COINCIDENT, cases[i].from, 0.0, 1, "", cases[i].first);
        picture p = render_in_folder(*state, &seen, NULL);
        assert_near(pixel_at(&p, 4, 4).r, cases[i].red, 1e-6);
        assert_near(pixel_at(&p, 4, 4).g, cases[i].green, 1e-6);
        free_picture(&p);
        add(&floor, COINCIDENT, -5.0, -9.0, 0, "directional: {direction: [0, 0, -1]}", cases[i].first);
        p = render_in_folder(*state, &floor, NULL);
        assert_near(pixel_at(&p, 4, 4).g, cases[i].floor, 1e-6);
        free_picture(&p);
    }
}

static void test_triangles_without_area(void **state)
{
    test_mesh m = make_mesh(9, 5);
    set_vertex(&m, 0, -4, -4, 0);
    set_vertex(&m, 1, 4, -4, 0);
    set_vertex(&m, 2, 0, 6, 0);
    set_vertex(&m, 3, 1, 1, 1);
    set_vertex(&m, 4, 2, 2, 2);
    set_vertex(&m, 5, 3, 3, 3);
    set_vertex(&m, 6, 1e-30, 0, 1);
    set_vertex(&m, 7, 0, 1e-30, 1);
    set_vertex(&m, 8, 0, 0, 1);
    set_triangle(&m, 0, 3, 4, 5);
    set_triangle(&m, 1, 3, 3, 4);
    set_triangle(&m, 2, 0, 1, 2);
    set_triangle(&m, 3, 6, 7, 8);
    set_triangle(&m, 4, 5, 5, 5);
    write_and_free(m, "flat.ply");
    for (uint32_t times = 1; times <= 2; times++) {
        text t = {0};
        add(&t, BEGINNING);
        for (uint32_t i = 0; i < times; i++)
            add(&t, "  - mesh: {file: flat.ply, material: {color: [0.5, 0.25, 0]}}\n");
        picture p = render_in_folder(*state, &t, NULL);
        expect_color(&p, 0.5, 0.25);
        free_picture(&p);
    }
}

/* From 1e-14, below which a ray no longer tells the sides of edges, to 1e12 in one mesh. */
static void test_sizes_far_apart(void **state)
{
    test_mesh m = make_mesh(9, 3);
    double sizes[] = {1e-14, 1, 1e12}, z[] = {0, -1, -1e11};
    for (uint32_t i = 0; i < 3; i++) {
        set_vertex(&m, 3 * i, -sizes[i], -sizes[i], z[i]);
        set_vertex(&m, 3 * i + 1, sizes[i], -sizes[i], z[i]);
        set_vertex(&m, 3 * i + 2, 0, sizes[i], z[i]);
        set_triangle(&m, i, 3 * i, 3 * i + 1, 3 * i + 2);
    }
    m.colors = calloc(9, 3);
    assert_non_null(m.colors);
    for (uint32_t i = 0; i < 3; i++)
        for (uint32_t k = 0; k < 3; k++)
            m.colors[9 * i + 3 * k + i] = 255;
    write_and_free(m, "sizes.ply");
    for (uint32_t times = 1; times <= 2; times++)
        for (uint32_t i = 0; i < 3; i++) {
            static const double from[] = {2e-14, 2, 1e10}, widths[] = {60, 30, 100};
            static const double sideways[] = {0, 0.2, 1e11};
            text t = {0};
            add(&t,
                "camera: {from: [%g, %g, %g], to: [%g, %g, %g], fov: %g}\n"
                "image: {width: 9, height: 9}\nambient: 1\nlights: []\nobjects:\n",
                sideways[i], -sideways[i], from[i], sideways[i], -sideways[i], z[i], widths[i] / 9);
            for (uint32_t k = 0; k < times; k++)
                add(&t, "  - mesh: {file: sizes.ply, material: {color: 1}}\n");
            picture p = render_in_folder(*state, &t, NULL);
            rgb c = pixel_at(&p, 4, 4);
            double value[] = {c.r, c.g, c.b};
            for (uint32_t k = 0; k < 3; k++)
                assert_near(value[k], k == i, 1e-6);
            free_picture(&p);
        }
}

static void test_one_triangle(void **state)
{
    write_and_free(triangle_times(1), "one.ply");
    for (uint32_t times = 1; times <= 2; times++) {
        text t = {0};
        add(&t, BEGINNING);
        for (uint32_t i = 0; i < times; i++)
            add(&t, "  - mesh: {file: one.ply, material: {color: [0.5, 0.25, 0]}}\n");
        picture p = render_in_folder(*state, &t, NULL);
        expect_color(&p, 0.5, 0.25);
        free_picture(&p);
    }
}

/* Nothing but what has no area: an error that names the file. */
static void test_empty_mesh(void **state)
{
    (void)state;
    test_mesh m = make_mesh(3, 1);
    write_and_free(m, "empty.ply");
    char path[128];
    snprintf(path, sizeof path, "%s/empty.ply", folder);
    lr_scene *scene = NULL;
    char *report = NULL;
    lr_error error = {0};
    lr_status status = lr_scene_load(path, NULL, &scene, &report, &error);
    if (status) {
        assert_non_null(strstr(error.message, "empty.ply"));
    } else {
        print_message("an empty mesh is loaded\n");
        lr_scene_destroy(scene);
    }
    free(report);
}

/* A mesh pressed flat: seen from the front it is there, from the side it is not. */
static void test_pressed_flat(void **state)
{
    write_and_free(sphere_mesh(3), "ball.ply");
    for (uint32_t times = 1; times <= 2; times++) {
        text t = {0};
        add(&t, BEGINNING);
        for (uint32_t i = 0; i < times; i++)
            add(&t, "  - mesh: {file: ball.ply, scale: [4, 4, 1e-8], material: "
                    "{color: [0.5, 0.25, 0]}}\n");
        picture p = render_in_folder(*state, &t, NULL);
        expect_color(&p, 0.5, 0.25);
        free_picture(&p);
    }
}

/* A wall of 100,000 instances, whose hit points name them by their colour. */
static void test_many_instances(void **state)
{
    enum { COLUMNS = 400, LINES = 250 };
    test_mesh m = make_mesh(4, 2);
    for (uint32_t i = 0; i < 4; i++)
        set_vertex(&m, i, i & 1, i >> 1, 0);
    set_triangle(&m, 0, 0, 1, 2);
    set_triangle(&m, 1, 1, 3, 2);
    write_and_free(m, "tile.ply");
    text t = {0};
    add(&t,
        "camera: {from: [200, 125, 1000], to: [200, 125, 0], fov: %.17g}\n"
        "image: {width: %d, height: %d}\nambient: 1\nlights: []\nobjects:\n",
        2 * atan(0.125) * 57.29577951308232, COLUMNS, LINES);
    for (int i = 0; i < 10; i++)
        add(&t, "  - mesh: {file: tile.ply, material: {color: [%g, 0, 0]}, translate: [1, 1, 0]}\n",
            0.1 * i);
    lr_scene *scene = parse_in_folder(&t);
    lr_object *objects = calloc(COLUMNS * LINES, sizeof *objects);
    assert_non_null(objects);
    for (int i = 0; i < COLUMNS * LINES; i++) {
        int x = i % COLUMNS, y = i / COLUMNS;
        objects[i] = scene->objects[(7 * x + 3 * y) % 10];
        objects[i].to_world.m[0][3] = x;
        objects[i].to_world.m[1][3] = y;
    }
    free(scene->objects);
    scene->objects = objects;
    scene->object_count = COLUMNS * LINES;
    picture p = render_scene(*state, scene, NULL);
    lr_scene_destroy(scene);
    for (int y = 0; y < LINES; y++)
        for (int x = 0; x < COLUMNS; x++) {
            rgb c = pixel_at(&p, (uint32_t)x, (uint32_t)(LINES - 1 - y));
            assert_near(c.r, 0.1 * ((7 * x + 3 * y) % 10), 1e-6);
        }
    free_picture(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_coincident_triangles),
        cmocka_unit_test(test_coincident_transparent_triangles),
        cmocka_unit_test(test_endless_heap),
        cmocka_unit_test(test_coincident_objects),
        cmocka_unit_test(test_triangles_without_area),
        cmocka_unit_test(test_sizes_far_apart),
        cmocka_unit_test(test_one_triangle),
        cmocka_unit_test(test_empty_mesh),
        cmocka_unit_test(test_pressed_flat),
        cmocka_unit_test(test_many_instances),
        cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device_and_folder, teardown);
}
