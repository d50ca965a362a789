/* Triangles of polygons: their areas sum up to the polygon's, none lies outside. */
#include "scene_tests.h"

#include "scene/polygon.h"

static lr_polygon p;

static uint32_t next_random(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

static double random_number(uint32_t *state)
{
    return next_random(state) * 0x1p-24;
}

/* Of the area vector, by the shoelace formula about the origin: not the way the code goes. */
static lr_vec3 polygon_area(void)
{
    lr_vec3 sum = {0, 0, 0};
    for (uint32_t i = 0; i < p.count; i++)
        sum = lr_vec3_add(sum, lr_vec3_cross(p.corners[i], p.corners[(i + 1) % p.count]));
    return lr_vec3_scale(sum, 0.5);
}

static double triangle_area(uint32_t i)
{
    const uint32_t *t = p.triangles[i];
    lr_vec3 ab = lr_vec3_sub(p.corners[t[1]], p.corners[t[0]]);
    lr_vec3 ac = lr_vec3_sub(p.corners[t[2]], p.corners[t[0]]);
    return 0.5 * lr_vec3_dot(lr_vec3_cross(ab, ac), p.normal);
}

/* Whether q lies inside the polygon in the xy plane, by the number of edges to its right. */
static bool inside_xy(double x, double y)
{
    bool inside = false;
    for (uint32_t i = 0; i < p.count; i++) {
        lr_vec3 a = p.corners[i], b = p.corners[(i + 1) % p.count];
        if ((a.y > y) != (b.y > y) && x < a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x))
            inside = !inside;
    }
    return inside;
}

/* As the triangles do not overlap and none is turned over, equal areas mean that they cover the
 * polygon. */
static void check_cover(void)
{
    double sum = 0, whole = lr_vec3_length(polygon_area());
    for (uint32_t i = 0; i < p.triangle_count; i++) {
        double area = triangle_area(i);
        if (!(area >= -1e-12 * whole))
            fail_msg("triangle %u has the area %g", (unsigned)i, area);
        sum += area;
    }
    assert_near(sum / whole, 1, 1e-12);
}

static void check_inside(uint32_t *state)
{
    for (uint32_t i = 0; i < p.triangle_count; i++) {
        const uint32_t *t = p.triangles[i];
        if (triangle_area(i) < 1e-9)
            continue;
        for (int k = 0; k < 4; k++) {
            double u = 0.05 + 0.9 * random_number(state), v = (0.95 - u) * random_number(state);
            lr_vec3 a = p.corners[t[0]], b = p.corners[t[1]], c = p.corners[t[2]];
            double w = 1 - u - v;
            if (!inside_xy(u * a.x + v * b.x + w * c.x, u * a.y + v * b.y + w * c.y))
                fail_msg("a point of triangle %u lies outside", (unsigned)i);
        }
    }
}

static void put(const double (*corners)[2], uint32_t count)
{
    p.count = count;
    for (uint32_t i = 0; i < count; i++)
        p.corners[i] = (lr_vec3){corners[i][0], corners[i][1], 0};
}

#define PUT(...)                                                                                   \
    do {                                                                                           \
        static const double corners_[][2] = {__VA_ARGS__};                                         \
        put(corners_, sizeof corners_ / sizeof *corners_);                                         \
    } while (0)

static void test_fan(void **state)
{
    (void)state;
    PUT({0, 0}, {2, 0}, {3, 1}, {2, 2}, {0, 2});
    assert_int_equal(lr_polygon_triangulate(&p), LR_POLYGON_GOOD);
    static const uint32_t expected[][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
    assert_int_equal(p.triangle_count, 3);
    assert_memory_equal(p.triangles, expected, sizeof expected);
    assert_near(p.normal.z, 1, 0);
}

static void test_shapes(void **state)
{
    (void)state;
    uint32_t seed = 1;
    for (int shape = 0; shape < 6; shape++) {
        switch (shape) {
        case 0: /* an arrow head, its notch first, second, ... */
            PUT({1, 1}, {0, 3}, {-4, 0}, {0, -3});
            break;
        case 1:
            PUT({0, -3}, {1, 1}, {0, 3}, {-4, 0});
            break;
        case 2: /* an L with corners on its straight edges */
            PUT({0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {1, 3}, {0, 3}, {0, 1.5});
            break;
        case 3: /* a spiral */
            PUT({0, 0}, {6, 0}, {6, 6}, {1, 6}, {1, 2}, {4, 2}, {4, 4}, {3, 4}, {3, 3}, {2, 3},
                {2, 5}, {5, 5}, {5, 1}, {0, 1});
            break;
        case 4: /* a square with a square hole, joined by a slit */
            PUT({0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 0}, {2, 2}, {2, 4}, {4, 4}, {4, 2}, {2, 2});
            break;
        default: /* two holes */
            PUT({0, 0}, {9, 0}, {9, 5}, {8, 4}, {8, 1}, {6, 1}, {6, 4}, {8, 4}, {9, 5}, {0, 5},
                {1, 4}, {3, 4}, {3, 1}, {1, 1}, {1, 4}, {0, 5});
        }
        assert_int_equal(lr_polygon_triangulate(&p), LR_POLYGON_GOOD);
        assert_true(p.triangle_count <= p.count - 2);
        check_cover();
        check_inside(&seed);
    }
}

/* A star-shaped polygon about the origin never crosses itself. */
static void put_star(uint32_t count, uint32_t *seed)
{
    p.count = count;
    for (uint32_t i = 0; i < count; i++) {
        double angle = 6.283185307179586 * (i + 0.9 * random_number(seed)) / count;
        double radius = 0.1 + random_number(seed);
        p.corners[i] = (lr_vec3){radius * cos(angle), radius * sin(angle), 0};
    }
}

static void test_stars(void **state)
{
    (void)state;
    uint32_t seed = 2;
    for (uint32_t round = 0; round < 400; round++) {
        put_star(4 + round % 60, &seed);
        if (lr_polygon_triangulate(&p) != LR_POLYGON_GOOD)
            fail_msg("star %u", (unsigned)round);
        assert_int_equal(p.triangle_count, p.count - 2);
        check_cover();
        check_inside(&seed);
        /* The same, turned and moved in space, twelve digits of each coordinate as in a file. */
        lr_transform t = lr_transform_multiply(
            lr_transform_translate((lr_vec3){100 * random_number(&seed), -50, 7}),
            lr_transform_rotate((lr_vec3){random_number(&seed) - 0.5, 1, random_number(&seed)},
                                360 * random_number(&seed)));
        for (uint32_t i = 0; i < p.count; i++)
            p.corners[i] = lr_transform_point(&t, p.corners[i]);
        assert_int_equal(lr_polygon_triangulate(&p), LR_POLYGON_GOOD);
        assert_int_equal(p.triangle_count, p.count - 2);
        double sum = 0;
        for (uint32_t i = 0; i < p.triangle_count; i++) {
            assert_true(triangle_area(i) > -1e-12);
            sum += triangle_area(i);
        }
        lr_vec3 first = p.corners[0], whole = {0, 0, 0};
        for (uint32_t i = 0; i < p.count; i++)
            p.corners[i] = lr_vec3_sub(p.corners[i], first);
        whole = polygon_area();
        assert_near(sum, lr_vec3_length(whole), 1e-12);
        assert_near(lr_vec3_dot(lr_vec3_normalize(whole), p.normal), 1, 1e-12);
    }
}

static void test_worst(void **state)
{
    (void)state;
    PUT({0, 0}, {1, 1}, {2, 2}, {3, 3});
    assert_int_equal(lr_polygon_triangulate(&p), LR_POLYGON_FLATTENED);
    PUT({5, 5}, {5, 5}, {5, 5});
    assert_int_equal(lr_polygon_triangulate(&p), LR_POLYGON_FLATTENED);
    PUT({0, 0}, {1, 0}, {0, 1e-13});
    assert_int_equal(lr_polygon_triangulate(&p), LR_POLYGON_FLATTENED);
    PUT({0, 0}, {1, 0}, {0, 1e-11});
    assert_int_equal(lr_polygon_triangulate(&p), LR_POLYGON_GOOD);
    PUT({0, 0}, {1e12, 1e12}, {-1e12, 1e12});
    assert_int_equal(lr_polygon_triangulate(&p), LR_POLYGON_GOOD);
    /* An uneven bow: told, and no more triangles than there may be. */
    PUT({0, 0}, {4, 4}, {4, 0}, {0, 3});
    assert_int_equal(lr_polygon_triangulate(&p), LR_POLYGON_CROSSING);
    assert_true(p.triangle_count <= 2);
    /* As large as may be, as concave, and crossing itself all over: in little time. */
    uint32_t seed = 3;
    put_star(LR_POLYGON_CORNERS_MAX, &seed);
    assert_int_equal(lr_polygon_triangulate(&p), LR_POLYGON_GOOD);
    check_cover();
    for (uint32_t i = 0; i < LR_POLYGON_CORNERS_MAX; i++)
        p.corners[i] = (lr_vec3){random_number(&seed), random_number(&seed), 0};
    assert_int_equal(lr_polygon_triangulate(&p), LR_POLYGON_CROSSING);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fan),
        cmocka_unit_test(test_shapes),
        cmocka_unit_test(test_stars),
        cmocka_unit_test(test_worst),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
