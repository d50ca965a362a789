/* What trees find is what there is: the same as without trees for every kind of primitive, what a
 * search on the CPU in double finds for meshes, and of coincident faces the first. */
#include "gpu_tests.h"

#include "mesh_tests.h"

#include "bvh/bvh.h"
#include "scene/color.h"

/* ---- Against the loop over all primitives --------------------------------------------------- */

#define FEW 30 /* objects of the small scene, which go without trees */

/* The same objects, seen and mirrored, with light and shadows. `more`: with spheres that no ray can
 * reach, as they stand behind all else and nothing sends rays there, but that make the scene one
 * with trees. They come last, so all objects keep their numbers, and ties their winners. */
static picture render_few(lr_device *device, const char *shapes[3], uint32_t seed, bool more,
                          const lr_render_options *options)
{
    text t = {0};
    add(&t, "camera: {from: [0, 0, 9], to: [0, 0, 0], fov: 40}\n"
            "image: {width: 96, height: 96, depth: 3}\n"
            "materials:\n"
            "  glass: {diffuse: 0.1, transmit: 0.8, ior: 1.4}\n"
            "  mirror: {diffuse: 0.3, reflect: 0.6}\n"
            "lights:\n"
            "  - point: {position: [3, 8, 9], intensity: 100}\n"
            "  - directional: {direction: [-1, -1, -0.5], intensity: 0.5}\n"
            "objects:\n");
    for (int i = 0; i < FEW; i++) {
        static const char *const materials[] = {"glass", "mirror", "{color: orange}",
                                                "{color: [0.2, 0.4, 0.9], one_sided: true}"};
        double size = (double)random_between(&seed, 0.2, 1.2);
        add(&t,
            "  - %s, scale: %.6g, rotate: [%.6g, %.6g, 0], translate: [%.6g, %.6g, %.6g], "
            "material: %s}\n",
            shapes[i % 3], size, (double)random_between(&seed, 0, 360),
            (double)random_between(&seed, 0, 360), (double)random_between(&seed, -2, 2),
            (double)random_between(&seed, -2, 2), (double)random_between(&seed, -2, 2),
            materials[random_bits(&seed) % 4]);
    }
    for (int i = 0; more && i < 10 * FEW; i++)
        add(&t, "  - sphere: {center: [%.3f, 0.5, 9.5], radius: 1e-7, shadow: false}\n", 0.01 * i);
    return render_in_folder(device, &t, options);
}

static void test_trees_find_what_loops_find(void **state)
{
    static const char *shapes[][3] = {
        {"sphere: {radius: 0.7", "sphere: {radius: 0.3", "sphere: {radius: 1.1"},
        {"rectangle: {corner: [-1, -0.5, 0], u: [2, 0, 0], v: [0, 1, 0.3]",
         "disk: {center: [0.2, 0, 0], normal: [1, 2, 3], radius: 0.8",
         "triangle: {a: [-1, 0, 0.2], b: [1, 0.3, 0], c: [0, 1, 0]"},
        {"group: {objects: [sphere: {scale: [1, 0.3, 0.7]}]",
         "group: {objects: [sphere: {scale: [0.2, 2, 0.7]}]",
         "group: {objects: [sphere: {scale: [1, 1, 0.01]}]"},
        {"box: {min: [-0.5, -0.2, -1], max: [0.5, 0.2, 1]", "box: {min: [0, 0, 0], max: [1, 1, 1]",
         "box: {min: [-1, -0.01, -1], max: [1, 0, 1]"},
        {"cone: {from: [0, -1, 0], to: [0, 1, 0], radius: 0.6",
         "cylinder: {from: [0, -1, 0], to: [0, 1, 1], radius: 0.3",
         "cone: {from: [0, 0, 0], to: [0, 1, 0], radius: 1, open: true"},
    };
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++)
        for (uint32_t seed = 1; seed <= 3; seed++) {
            lr_render_options single = {.single_rays = true};
            picture few = render_few(*state, shapes[i], seed, false, NULL);
            picture packets = render_few(*state, shapes[i], seed, true, NULL);
            picture rays = render_few(*state, shapes[i], seed, true, &single);
            assert_true(few.stats.reflected.hit + few.stats.refracted.hit > 20);
            assert_int_equal(few.stats.primary.hit, packets.stats.primary.hit);
            assert_int_equal(few.stats.reflected.hit, packets.stats.reflected.hit);
            assert_int_equal(few.stats.refracted.hit, packets.stats.refracted.hit);
            assert_int_equal(few.stats.shadow.hit, packets.stats.shadow.hit);
            assert_string_equal(few.stats.hash, packets.stats.hash);
            assert_string_equal(few.stats.hash, rays.stats.hash);
            free_picture(&few);
            free_picture(&packets);
            free_picture(&rays);
        }
}

/* ---- Against a search in double ------------------------------------------------------------- */

#define SIDE 1024u /* of the picture, so a million rays */

typedef struct search {
    const test_mesh *mesh;
    const lr_bvh_ray *ray;
    uint32_t best;
    double t, margin; /* of the best: how far inside the triangle it is, the least weight */
} search;

/* Moeller and Trumbore, 1997, in double. False when the ray misses by more than the margin -0.001,
 * for which the weights are then made 0. */
static bool test_triangle(void *context, uint32_t triangle, double *t_max)
{
    search *s = context;
    const uint32_t *v = &s->mesh->triangles[3 * (size_t)triangle];
    lr_vec3 p[3], d = {s->ray->direction[0], s->ray->direction[1], s->ray->direction[2]};
    for (int i = 0; i < 3; i++) {
        const float *q = &s->mesh->positions[3 * (size_t)v[i]];
        p[i] = (lr_vec3){(double)q[0], (double)q[1], (double)q[2]};
    }
    lr_vec3 o = {s->ray->origin[0], s->ray->origin[1], s->ray->origin[2]};
    lr_vec3 e1 = lr_vec3_sub(p[1], p[0]), e2 = lr_vec3_sub(p[2], p[0]), r = lr_vec3_sub(o, p[0]);
    lr_vec3 h = lr_vec3_cross(d, e2), k = lr_vec3_cross(r, e1);
    double inverse = 1 / lr_vec3_dot(e1, h), u = lr_vec3_dot(r, h) * inverse;
    double w = lr_vec3_dot(d, k) * inverse, t = lr_vec3_dot(e2, k) * inverse;
    double margin = fmin(fmin(u, w), 1 - u - w);
    if (margin >= 0 && t > 0 && t < *t_max) {
        *t_max = t;
        s->t = t;
        s->best = triangle;
        s->margin = margin;
    }
    return true;
}

static lr_bvh *build_boxes(const test_mesh *m)
{
    lr_bvh_box *boxes = malloc(sizeof *boxes * m->triangle_count);
    lr_bvh *bvh = NULL;
    assert_non_null(boxes);
    for (uint32_t i = 0; i < m->triangle_count; i++)
        for (int k = 0; k < 3; k++) {
            const uint32_t *v = &m->triangles[3 * (size_t)i];
            float a = m->positions[3 * v[0] + (uint32_t)k];
            float b = m->positions[3 * v[1] + (uint32_t)k];
            float c = m->positions[3 * v[2] + (uint32_t)k];
            boxes[i].min[k] = fminf(a, fminf(b, c));
            boxes[i].max[k] = fmaxf(a, fmaxf(b, c));
        }
    MUST(lr_bvh_create(boxes, m->triangle_count, NULL, &bvh, error));
    free(boxes);
    return bvh;
}

/* Paints every triangle in a colour of its own, so that a picture without light tells which was
 * hit. Vertices are no longer shared; 10 bits of each colour's square root and 8 of a file's give
 * some 5 bits a channel to spare: 32 levels each. */
static test_mesh painted(const test_mesh *m)
{
    test_mesh p = make_mesh(3 * m->triangle_count, m->triangle_count);
    p.colors = malloc(9 * (size_t)m->triangle_count);
    assert_non_null(p.colors);
    for (uint32_t i = 0; i < 3 * m->triangle_count; i++) {
        uint32_t id = i / 3;
        memcpy(&p.positions[3 * (size_t)i], &m->positions[3 * (size_t)m->triangles[i]], 12);
        for (int k = 0; k < 3; k++)
            p.colors[3 * (size_t)i + (size_t)k] = (uint8_t)(4 + 8 * (id >> 5 * k & 31));
        p.triangles[i] = i;
    }
    return p;
}

/* sRGB as of IEC 61966-2-1. */
static uint32_t level_of(double linear)
{
    double byte =
        255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055);
    return (uint32_t)(byte / 8);
}

/* The ray through the middle of a pixel, of the camera at z = `from` that looks along -z. */
static lr_bvh_ray ray_of(uint32_t x, uint32_t y, double from, double fov)
{
    double pixel = 2 * tan(fov / 2 * 0.017453292519943295) / SIDE;
    return (lr_bvh_ray){
        .origin = {0, 0, from},
        .direction = {(x + 0.5 - SIDE / 2.0) * pixel, -(y + 0.5 - SIDE / 2.0) * pixel, -1},
        .t_max = 1e9};
}

static void check_search(lr_device *device, test_mesh *m, const char *name, uint32_t times)
{
    const double from = 4, fov = 40;
    test_mesh p = painted(m);
    lr_bvh *bvh = build_boxes(m);
    write_mesh(&p, "painted.ply");
    text t = {0};
    add(&t,
        "camera: {from: [0, 0, %g], to: [0, 0, 0], fov: %g}\n"
        "image: {width: %u, height: %u, depth: 0}\n"
        "ambient: 1\nlights: []\nbackground: 2\nobjects:\n",
        from, fov, SIDE, SIDE);
    for (uint32_t i = 0; i < times; i++) /* the others are far behind the camera */
        add(&t, "  - mesh: {file: painted.ply, material: {color: 1}, translate: [0, 0, %u]}\n",
            i * 100);
    picture seen = render_in_folder(device, &t, NULL);
    uint32_t wrong = 0, excused = 0, hits = 0;
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        lr_bvh_ray ray = ray_of(i % SIDE, i / SIDE, from, fov);
        search s = {.mesh = m, .ray = &ray, .best = UINT32_MAX};
        lr_bvh_trace(bvh, &ray, test_triangle, &s);
        rgb color = pixel_at(&seen, i % SIDE, i / SIDE);
        uint32_t id = color.r > 1.5
                          ? UINT32_MAX
                          : level_of(color.r) | level_of(color.g) << 5 | level_of(color.b) << 10;
        hits += s.best != UINT32_MAX;
        if (id == s.best)
            continue;
        /* Another triangle is right within a ten-thousandth of an edge of the one that is. */
        double margin = s.margin;
        if (id != UINT32_MAX && id < m->triangle_count) {
            search other = {.mesh = m, .ray = &ray, .best = UINT32_MAX};
            double t_max = 1e9;
            test_triangle(&other, id, &t_max);
            margin = other.best == id ? fmin(s.margin, other.margin) : s.margin;
        }
        if (s.best == UINT32_MAX || margin < 1e-4)
            excused++;
        else if (wrong++ < 5)
            print_message("%s: pixel %u %u meets %d, expected %d (margin %g)\n", name, i % SIDE,
                          i / SIDE, (int)id, (int)s.best, s.margin);
    }
    print_message("%s, shown %u times: %u hits, %u wrong, %u at edges\n", name, times, hits, wrong,
                  excused);
    assert_int_equal(wrong, 0);
    assert_true(hits > SIDE * SIDE / 10 && excused < hits / 1000);
    free_picture(&seen);
    free_mesh(&p);
    lr_bvh_destroy(bvh);
}

static void test_meshes_against_double(void **state)
{
    test_mesh rough = sphere_mesh(5), torus = torus_mesh(100, 150, 0.4);
    roughen(&rough, 0.1, 9);
    for (uint32_t i = 0; i < torus.vertex_count; i++) { /* turned, so that faces overlap */
        float *p = &torus.positions[3 * (size_t)i], y = p[1];
        p[1] = 0.8f * y - 0.6f * p[2];
        p[2] = 0.6f * y + 0.8f * p[2];
    }
    for (uint32_t times = 1; times <= 2; times++) {
        check_search(*state, &rough, "rough sphere", times);
        check_search(*state, &torus, "torus", times);
    }
    free_mesh(&rough);
    free_mesh(&torus);
}

/* ---- Coincident faces ----------------------------------------------------------------------- */

/* Of faces in the same place the first object's shows, whether its mesh is shown once or several
 * times. */
static void test_first_object_wins(void **state)
{
    test_mesh square = make_mesh(4, 2);
    for (uint32_t i = 0; i < 4; i++)
        set_vertex(&square, i, i & 1 ? 1 : -1, i & 2 ? 1 : -1, 0);
    set_triangle(&square, 0, 0, 1, 2);
    set_triangle(&square, 1, 1, 3, 2);
    write_mesh(&square, "square.ply");
    write_mesh(&square, "square2.ply");
    write_mesh(&square, "square3.ply");
    free_mesh(&square);
    static const char *const faces[] = {
        "mesh: {file: square.ply",
        "mesh: {file: square2.ply",
        "mesh: {file: square2.ply",
        "mesh: {file: square3.ply",
    };
    static const char *const colors[] = {"[1, 0, 0]", "[0, 1, 0]", "[0, 0, 1]", "[1, 1, 1]"};
    for (int first = 0; first < 4; first++)
        for (int step = 1; step < 4; step += 2)
            for (int single = 0; single < 2; single++) {
                text t = {0};
                add(&t, "camera: {from: [0, 0, 4], to: [0, 0, 0], fov: 20}\n"
                        "image: {width: 32, height: 32}\nambient: 1\nlights: []\nobjects:\n");
                for (int i = 0; i < 4; i++) {
                    int face = (first + i * step) % 4;
                    add(&t, "  - %s, material: {color: %s}}\n", faces[face], colors[face]);
                }
                picture p =
                    render_in_folder(*state, &t, &(lr_render_options){.single_rays = single});
                for (uint32_t i = 0; i < 32 * 32; i++) {
                    rgb c = pixel_at(&p, i % 32, i / 32);
                    assert_near(c.r, first == 0 || first == 3, 1e-6);
                    assert_near(c.g, first == 1 || first == 3, 1e-6);
                    assert_near(c.b, first == 2 || first == 3, 1e-6);
                }
                free_picture(&p);
            }
}

/* ... and of one mesh's, the first triangle's. */
static void test_first_triangle_wins(void **state)
{
    for (uint32_t order = 0; order < 2; order++)
        for (uint32_t times = 1; times <= 2; times++) {
            test_mesh pile = make_mesh(3 * 64, 64);
            pile.colors = calloc(3 * 3, 64);
            assert_non_null(pile.colors);
            for (uint32_t i = 0; i < 64; i++) {
                set_vertex(&pile, 3 * i, -4, -4, 0);
                set_vertex(&pile, 3 * i + 1, 4, -4, 0);
                set_vertex(&pile, 3 * i + 2, 0, 6, 0);
                set_triangle(&pile, order ? 63 - i : i, 3 * i, 3 * i + 1, 3 * i + 2);
                memset(&pile.colors[9 * i], (int)(4 * i), 9);
            }
            write_mesh(&pile, "pile.ply");
            free_mesh(&pile);
            text t = {0};
            add(&t, "camera: {from: [0, 0, 4], to: [0, 0, 0], fov: 20}\n"
                    "image: {width: 32, height: 32}\nambient: 1\nlights: []\nobjects:\n");
            for (uint32_t i = 0; i < times; i++)
                add(&t, "  - mesh: {file: pile.ply, material: {color: 1}, translate: [0, 0, %u]}\n",
                    100 * i);
            picture p = render_in_folder(*state, &t, NULL);
            double expected = order ? lr_srgb_to_linear(252) : 0;
            for (uint32_t i = 0; i < 32 * 32; i++)
                assert_near(pixel_at(&p, i % 32, i / 32).r, expected, 2e-3);
            free_picture(&p);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_trees_find_what_loops_find),
        cmocka_unit_test(test_meshes_against_double),
        cmocka_unit_test(test_first_object_wins),
        cmocka_unit_test(test_first_triangle_wins),
        cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device_and_folder, teardown);
}
