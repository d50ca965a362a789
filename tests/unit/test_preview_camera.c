/* The camera in a hand, against what geometry says: full turns, similar triangles, a projection of
 * the test's own. */
#include "scene_tests.h"

#include "preview/camera_control.h"
#include "scene/camera.h"

static const lr_screen screen = {640, 480};

static const lr_camera usual = {.from = {0, 1.5, 6}, .to = {0, 1, 0}, .up = {0, 1, 0}, .fov = 40};
/* Z is up, the view goes down at an angle, the numbers are not round. */
static const lr_camera slanted = {
    .from = {-31.25, 17.5, 44.7}, .to = {2.5, 3.1, -1.9}, .up = {0.1, 0.2, 3}, .fov = 73.5};

static double distance(lr_vec3 a, lr_vec3 b)
{
    return sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y) + (a.z - b.z) * (a.z - b.z));
}

#define assert_same_point(a, b, tolerance) assert_near(distance(a, b), 0, tolerance)

static lr_vec3 view_of(const lr_camera *camera)
{
    return lr_vec3_normalize(lr_vec3_sub(camera->to, camera->from));
}

/* Where a pinhole sees the point: x over depth by the tangent of half of the field of view. */
static void project(const lr_camera *camera, lr_vec3 point, double *x, double *y)
{
    lr_vec3 forward = view_of(camera), d = lr_vec3_sub(point, camera->from);
    lr_vec3 right = lr_vec3_normalize(lr_vec3_cross(forward, camera->up));
    lr_vec3 up = lr_vec3_cross(right, forward);
    double rows = screen.height - (camera->fov_to_centers ? 1 : 0);
    double per_tangent = rows / 2 / tan(camera->fov * 3.14159265358979323846 / 360);
    double depth = lr_vec3_dot(d, forward);
    *x = screen.width / 2.0 + per_tangent * lr_vec3_dot(d, right) / depth;
    *y = screen.height / 2.0 - per_tangent * lr_vec3_dot(d, up) / depth;
}

static void assert_seen_at(const lr_camera *camera, lr_vec3 point, double x, double y)
{
    double seen_x, seen_y;
    project(camera, point, &seen_x, &seen_y);
    assert_near(seen_x, x, 1e-7);
    assert_near(seen_y, y, 1e-7);
}

static void assert_same_camera(const lr_camera *a, const lr_camera *b, double tolerance)
{
    assert_same_point(a->from, b->from, tolerance);
    assert_same_point(a->to, b->to, tolerance);
    assert_same_point(a->up, b->up, 0);
    assert_near(a->fov, b->fov, 0);
    assert_int_equal(a->fov_to_centers, b->fov_to_centers);
}

static void test_points(void **state)
{
    (void)state;
    /* The middle of the upper edge is half of the field of view above the focus. */
    lr_camera camera = {.from = {0, 0, 10}, .up = {0, 1, 0}, .fov = 90};
    lr_vec3 above = lr_camera_point(&camera, screen, 320, 0);
    assert_same_point(above, ((lr_vec3){0, 10, 0}), 1e-12);
    lr_vec3 corner = lr_camera_point(&camera, screen, 640, 480);
    assert_same_point(corner, ((lr_vec3){10 * 640.0 / 480, -10, 0}), 1e-12);
    camera.fov_to_centers = true;
    above = lr_camera_point(&camera, screen, 320, 0.5);
    assert_same_point(above, ((lr_vec3){0, 10, 0}), 1e-12);
    for (int i = 0; i < 2; i++) {
        camera = i ? slanted : usual;
        assert_seen_at(&camera, lr_camera_point(&camera, screen, 17.5, 401), 17.5, 401);
    }
}

static void test_lines(void **state)
{
    (void)state;
    const lr_vec3 a = {-0.7, 1.9, 0.4}, b = {1.2, 0.3, -3};
    double ends[4], x, y;
    for (int i = 0; i < 2; i++) {
        const lr_camera *camera = i ? &slanted : &usual;
        assert_true(lr_camera_project(camera, screen, a, b, ends));
        project(camera, a, &x, &y);
        assert_near(ends[0], x, 1e-7);
        assert_near(ends[1], y, 1e-7);
        project(camera, b, &x, &y);
        assert_near(ends[2], x, 1e-7);
        assert_near(ends[3], y, 1e-7);
        /* From the point to one behind the eye: it ends on the way there, a thousandth ahead. */
        lr_vec3 eye = camera->from, view = lr_vec3_sub(camera->to, eye);
        lr_vec3 behind = lr_vec3_sub(lr_vec3_sub(eye, view), lr_vec3_scale(camera->up, 1e-4));
        assert_true(lr_camera_project(camera, screen, b, behind, ends));
        lr_vec3 forward = view_of(camera);
        double from = lr_vec3_dot(lr_vec3_sub(b, eye), forward);
        double to = lr_vec3_dot(lr_vec3_sub(behind, eye), forward);
        double share = (from - 1e-3 * lr_vec3_length(view)) / (from - to);
        lr_vec3 cut = lr_vec3_add(b, lr_vec3_scale(lr_vec3_sub(behind, b), share));
        project(camera, cut, &x, &y);
        assert_near(ends[2], x, 1e-5 * (1 + fabs(x)));
        assert_near(ends[3], y, 1e-5 * (1 + fabs(y)));
        assert_false(lr_camera_project(camera, screen, behind, lr_vec3_sub(behind, view), ends));
    }
}

static void test_orbit(void **state)
{
    (void)state;
    /* A quarter to the right of one who looks along -z is +x. */
    lr_camera level = {.from = {0, 0, 4}, .up = {0, 1, 0}, .fov = 40};
    lr_camera moved = lr_camera_orbit(level, 90, 0);
    assert_same_point(moved.from, ((lr_vec3){4, 0, 0}), 1e-12);
    moved = lr_camera_orbit(level, 0, 30);
    assert_same_point(moved.from, ((lr_vec3){0, 2, 4 * sqrt(0.75)}), 1e-12);

    lr_camera round = slanted;
    for (int i = 0; i < 720; i++)
        round = lr_camera_orbit(round, 0.5, 0);
    assert_same_camera(&round, &slanted, 1e-10);
    moved = lr_camera_orbit(lr_camera_orbit(slanted, 33, -21), -33, 21);
    assert_same_camera(&moved, &slanted, 1e-10);
    moved = lr_camera_orbit(slanted, 123, 11);
    assert_near(distance(moved.from, moved.to), distance(slanted.from, slanted.to), 1e-12);
    assert_same_point(moved.to, slanted.to, 0);
}

static void test_poles(void **state)
{
    (void)state;
    for (int sign = -1; sign <= 1; sign += 2) {
        lr_camera camera = slanted;
        for (int i = 0; i < 100; i++)
            camera = lr_camera_orbit(camera, 7, sign * 10);
        assert_true(lr_camera_usable(&camera));
        double sine = -lr_vec3_dot(view_of(&camera), lr_vec3_normalize(camera.up));
        assert_near(asin(sine) * 57.29577951308232, sign * 89.9, 1e-6);
        /* No flip: a step back is a step down the same side. */
        lr_camera back = lr_camera_orbit(camera, 0, sign * -80);
        lr_vec3 a = lr_vec3_cross(view_of(&camera), camera.up);
        lr_vec3 b = lr_vec3_cross(view_of(&back), back.up);
        assert_true(lr_vec3_dot(a, b) > 0);
        camera = slanted;
        for (int i = 0; i < 100; i++)
            camera = lr_camera_look(camera, 7, sign * 10);
        sine = lr_vec3_dot(view_of(&camera), lr_vec3_normalize(camera.up));
        assert_near(asin(sine) * 57.29577951308232, sign * 89.9, 1e-6);
    }
    /* A scene may look closer along up than a hand gets; it is not thrown back. */
    lr_camera steep = {.from = {0, 1, 0.0001}, .up = {0, 1, 0}, .fov = 40};
    lr_camera moved = lr_camera_orbit(steep, 0, 1);
    assert_same_camera(&moved, &steep, 1e-12);
    moved = lr_camera_orbit(steep, 90, 0);
    assert_same_point(moved.from, ((lr_vec3){0.0001, 1, 0}), 1e-12);
    moved = lr_camera_orbit(steep, 0, -89.99427042206779);
    assert_near(moved.from.y, 0, 1e-6);
}

static void test_pan(void **state)
{
    (void)state;
    const lr_camera cameras[] = {usual, slanted};
    for (int i = 0; i < 4; i++) {
        lr_camera camera = cameras[i / 2];
        camera.fov_to_centers = i % 2;
        lr_vec3 picked = lr_camera_point(&camera, screen, 100, 50);
        lr_camera moved = lr_camera_pan(camera, screen, 30, -12.25);
        assert_seen_at(&moved, picked, 130, 37.75);
        assert_seen_at(&moved, camera.to, 350, 227.75);
        assert_same_point(view_of(&moved), view_of(&camera), 1e-12);
        moved = lr_camera_pan(moved, screen, -30, 12.25);
        assert_same_camera(&moved, &camera, 1e-10);
    }
}

static void test_zoom(void **state)
{
    (void)state;
    lr_vec3 picked = lr_camera_point(&slanted, screen, 600, 33);
    lr_camera moved = lr_camera_zoom(slanted, 0.25, picked);
    assert_seen_at(&moved, picked, 600, 33);
    assert_same_point(view_of(&moved), view_of(&slanted), 1e-12);
    assert_near(distance(moved.from, moved.to), distance(slanted.from, slanted.to) / 4, 1e-12);
    moved = lr_camera_zoom(moved, 4, picked);
    assert_same_camera(&moved, &slanted, 1e-10);
    moved = lr_camera_zoom(usual, 0.5, usual.to);
    assert_same_point(moved.from, ((lr_vec3){0, 1.25, 3}), 1e-12);
    assert_same_point(moved.to, usual.to, 1e-12);

    /* However long the wheel turns, the camera can be had, and the way back is open. */
    for (int i = 0; i < 2000; i++)
        moved = lr_camera_zoom(moved, 0.9, moved.to);
    assert_true(lr_camera_usable(&moved));
    assert_true(distance(moved.from, moved.to) > 0);
    assert_same_point(view_of(&moved), view_of(&usual), 1e-5);
    for (int i = 0; i < 2000; i++)
        moved = lr_camera_zoom(moved, 1.1, moved.to);
    assert_true(lr_camera_usable(&moved));
    assert_true(distance(moved.from, moved.to) > 1e11);
    const double wrong[] = {0, -1, NAN, INFINITY};
    for (int i = 0; i < 4; i++) {
        moved = lr_camera_zoom(usual, wrong[i], usual.to);
        assert_same_camera(&moved, &usual, 0);
    }
}

static void test_flight(void **state)
{
    (void)state;
    lr_camera camera = {.from = {0, 0, 4}, .up = {0, 2, 0}, .fov = 40};
    lr_camera moved = lr_camera_fly(camera, 1, 2, 3);
    assert_same_point(moved.from, ((lr_vec3){1, 2, 1}), 1e-12);
    assert_same_point(moved.to, ((lr_vec3){1, 2, -3}), 1e-12);
    moved = lr_camera_look(camera, 90, 0);
    assert_same_point(moved.from, camera.from, 0);
    assert_same_point(moved.to, ((lr_vec3){4, 0, 4}), 1e-12);
    moved = lr_camera_look(camera, 0, 30);
    assert_same_point(moved.to, ((lr_vec3){0, 2, 4 - 4 * sqrt(0.75)}), 1e-12);
    assert_near(lr_camera_fly_speed(&camera, 0), 2, 1e-12);
    assert_near(lr_camera_fly_speed(&camera, 10), 2, 1e-12);
    assert_near(lr_camera_fly_speed(&camera, 1), 0.5, 1e-12);
    assert_near(lr_camera_fly_speed(&camera, 1000), 10, 1e-12);
}

static void test_focus(void **state)
{
    (void)state;
    lr_vec3 point = {5, -7.5, 3};
    lr_camera moved = lr_camera_focus(slanted, point);
    assert_same_point(moved.to, point, 0);
    assert_same_point(view_of(&moved), view_of(&slanted), 1e-12);
    assert_seen_at(&moved, point, 320, 240);
    /* Sideways alone. */
    lr_vec3 way = lr_vec3_sub(moved.from, slanted.from);
    assert_near(lr_vec3_dot(way, view_of(&slanted)), 0, 1e-12);
    lr_vec3 behind = lr_vec3_sub(slanted.from, view_of(&slanted));
    moved = lr_camera_focus(slanted, behind);
    assert_same_camera(&moved, &slanted, 0);
}

static void test_fov(void **state)
{
    (void)state;
    const double given[] = {55, 0, 400, -3}, expected[] = {55, 1, 170, 1};
    for (int i = 0; i < 4; i++)
        assert_near(lr_camera_set_fov(usual, given[i]).fov, expected[i], 0);
    assert_near(lr_camera_set_fov(usual, NAN).fov, 40, 0);
}

/* What a scene cannot have is not reached from any side. */
static void test_limits(void **state)
{
    (void)state;
    lr_camera far = {.from = {0.9e12, 0, 0}, .to = {0.8e12, 0, 0}, .up = {0, 1, 0}, .fov = 90};
    lr_camera moved = lr_camera_pan(far, screen, -4800, 0);
    assert_true(lr_camera_usable(&moved));
    moved = lr_camera_fly(far, 0, 0, -2e11);
    assert_same_camera(&moved, &far, 0);
    moved = lr_camera_fly(far, NAN, 0, 0);
    assert_same_camera(&moved, &far, 0);
    moved = lr_camera_focus(far, (lr_vec3){0, INFINITY, 0});
    assert_same_camera(&moved, &far, 0);
    lr_camera bad[] = {usual, usual, usual, usual};
    bad[0].to = bad[0].from;
    bad[1].up = view_of(&usual);
    bad[2].from.x = NAN;
    bad[3].to.z = 2e12;
    for (int i = 0; i < 4; i++)
        assert_false(lr_camera_usable(&bad[i]));
    assert_true(lr_camera_usable(&usual));
}

/* An orthographic picture of 640 x 480 that shows 8 m of height. */
static void test_orthographic(void **state)
{
    (void)state;
    const lr_camera camera = {.from = {0, 0, 10},
                              .up = {0, 1, 0},
                              .fov = 40,
                              .projection = LR_ORTHOGRAPHIC,
                              .height = 8,
                              .focus = 3};
    assert_same_point(lr_camera_point(&camera, screen, 320, 0), ((lr_vec3){0, 4, 0}), 1e-12);
    double ends[4];
    /* Whatever the distance, 60 pixels are a metre. */
    assert_true(lr_camera_project(&camera, screen, (lr_vec3){1, 2, 5}, (lr_vec3){1, 2, -90}, ends));
    for (int i = 0; i < 4; i++)
        assert_near(ends[i], i % 2 ? 240 - 120 : 320 + 60, 1e-9);
    lr_vec3 about = lr_camera_point(&camera, screen, 100, 50);
    lr_camera moved = lr_camera_zoom(camera, 0.5, about);
    assert_near(moved.height, 4, 0);
    assert_near(moved.focus, 1.5, 0);
    assert_same_point(lr_camera_point(&moved, screen, 100, 50), about, 1e-12);
    moved = lr_camera_pan(camera, screen, 60, 0);
    assert_same_point(moved.from, ((lr_vec3){-1, 0, 10}), 1e-12);
    lr_camera panorama = camera;
    panorama.projection = LR_PANORAMA;
    assert_false(
        lr_camera_project(&panorama, screen, (lr_vec3){0, 0, 0}, (lr_vec3){1, 0, 0}, ends));
}

/* The plane in focus goes through the point that is looked at, unless told otherwise. */
static void test_lens(void **state)
{
    (void)state;
    lr_camera camera = usual;
    camera.aperture = 0.1;
    assert_near(lr_camera_focus_distance(&camera), distance(usual.from, usual.to), 1e-12);
    camera.focus = 2.5;
    assert_near(lr_camera_focus_distance(&camera), 2.5, 0);
    lr_vec3 point = {0.3, 1.2, 2};
    lr_camera moved = lr_camera_focus(camera, point);
    assert_near(lr_camera_focus_distance(&moved), distance(moved.from, moved.to), 1e-12);
    lr_camera bad[] = {camera, camera, camera, camera};
    bad[0].projection = LR_ORTHOGRAPHIC;
    bad[1].aperture = 2501;
    bad[2].aperture = 1e-21;
    bad[3].blades = 2;
    for (int i = 0; i < 4; i++)
        assert_false(lr_camera_usable(&bad[i]));
    assert_true(lr_camera_usable(&camera));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_points),       cmocka_unit_test(test_lines),
        cmocka_unit_test(test_orbit),        cmocka_unit_test(test_poles),
        cmocka_unit_test(test_pan),          cmocka_unit_test(test_zoom),
        cmocka_unit_test(test_flight),       cmocka_unit_test(test_focus),
        cmocka_unit_test(test_fov),          cmocka_unit_test(test_limits),
        cmocka_unit_test(test_orthographic), cmocka_unit_test(test_lens),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
