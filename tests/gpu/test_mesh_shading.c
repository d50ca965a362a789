/* Meshes look like what they stand for: a smooth ball like a sphere, a box of triangles like a box,
 * stretched instances like ellipsoids. */
#include "gpu_tests.h"

#include "mesh_tests.h"

#define SIDE 128u

typedef struct difference {
    double greatest, mean;
    uint32_t compared, above; /* pixels; those that differ by more than 1/255 */
} difference;

/* Over the pixels at which `mask`, if there is one, is above 0.5 in its first channel. */
static difference compare_pictures(const picture *a, const picture *b, const picture *mask)
{
    difference d = {0};
    for (uint32_t i = 0; i < a->image.width * a->image.height; i++) {
        if (mask && mask->image.pixels[3 * i] <= 0.5f)
            continue;
        double most = 0;
        for (uint32_t k = 0; k < 3; k++)
            most = fmax(most, fabs((double)a->image.pixels[3 * i + k] -
                                   (double)b->image.pixels[3 * i + k]));
        d.compared++;
        d.above += most > 1 / 255.0;
        d.mean += most;
        d.greatest = fmax(d.greatest, most);
    }
    d.mean /= d.compared;
    return d;
}

/* The scene with this object, and with that one, where they cover a ball of that radius; 0: all
 * over.
 */
static difference compare_objects(lr_device *device, const char *beginning, const char *mesh,
                                  const char *solid, double radius)
{
    text texts[3] = {{0}, {0}, {0}};
    add(&texts[0], "%sobjects:\n%s", beginning, mesh);
    add(&texts[1], "%sobjects:\n%s", beginning, solid);
    add(&texts[2],
        "camera: {from: [0, 0, 40], to: [0, 0, 0], fov: 3.2}\nlights: []\nambient: 1\n"
        "background: 0\nimage: {width: %u, height: %u}\nobjects:\n"
        "  - sphere: {radius: %g, material: {color: 1}}\n",
        SIDE, SIDE, radius > 0 ? radius : 1);
    picture a = render_in_folder(device, &texts[0], NULL);
    picture b = render_in_folder(device, &texts[1], NULL);
    picture mask = render_in_folder(device, &texts[2], NULL);
    difference d = compare_pictures(&a, &b, radius > 0 ? &mask : NULL);
    print_message("%u pixels, mean difference %g, greatest %g, above 1/255: %u\n", d.compared,
                  d.mean, d.greatest, d.above);
    free_picture(&a);
    free_picture(&b);
    free_picture(&mask);
    return d;
}

#define BALL                                                                                       \
    "camera: {from: [0, 0, 40], to: [0, 0, 0], fov: 3.2}\nimage: {width: 128, height: 128}\n"      \
    "background: 0\nambient: 0\nlights:\n"

static void write_ball(void)
{
    test_mesh m = sphere_mesh(5);
    add_sphere_normals(&m);
    write_mesh(&m, "ball.ply");
    free_mesh(&m);
}

/* With 8192 triangles and their normals, seen and lit from everywhere, shown once and as one of two
 * instances: away from the silhouette no pixel differs by more than the angle that a triangle spans
 * makes of the cosine, and the terminator has no dark steps. */
static void test_ball(void **state)
{
    static const char *const lights[] = {"[0, 0, -1]", "[-1, -1, -1]", "[-1, 0, 0]",
                                         "[-1, 0.3, 0.4]"};
    static const char *const meshes[] = {
        "  - mesh: {file: ball.ply, rotate: [3, 4, 5], material: {color: 1}}\n",
        "  - mesh: {file: ball.ply, rotate: [3, 4, 5], material: {color: 1}}\n"
        "  - mesh: {file: ball.ply, translate: [0, 900, 0]}\n"};
    write_ball();
    for (size_t i = 0; i < sizeof lights / sizeof *lights; i++)
        for (int k = 0; k < 2; k++) {
            char beginning[512];
            snprintf(beginning, sizeof beginning,
                     BALL "  - directional: {direction: %s, intensity: 1}\n", lights[i]);
            difference d = compare_objects(*state, beginning, meshes[k],
                                           "  - sphere: {material: {color: 1}}\n", 0.93);
            assert_true(d.compared > SIDE * SIDE / 2);
            assert_true(d.greatest < 0.003 && d.mean < 0.0005);
        }
}

/* Highlights go by the smooth normal too. */
static void test_highlight(void **state)
{
    write_ball();
    difference d = compare_objects(
        *state, BALL "  - directional: {direction: [-1, -1, -1.5], intensity: 1}\n",
        "  - mesh: {file: ball.ply, material: {color: 0, specular: 1, shininess: 50}}\n",
        "  - sphere: {material: {color: 0, specular: 1, shininess: 50}}\n", 0.93);
    assert_true(d.greatest < 0.003 && d.mean < 0.0002);
}

/* Ellipsoids from instances: normals under scale, rotation and mirroring. */
static void test_stretched_instances(void **state)
{
    write_ball();
    static const char *const placements[] = {
        "scale: [0.9, 0.3, 0.6], rotate: [20, 30, 40]",
        "scale: [-0.9, 0.3, 0.6], rotate: [50, 0, 10]",
        "scale: [0.4, -0.9, -0.5], rotate: [0, 80, 10]",
    };
    for (size_t i = 0; i < sizeof placements / sizeof *placements; i++)
        for (int k = 0; k < 2; k++) {
            char mesh[512], solid[256];
            snprintf(mesh, sizeof mesh, "  - mesh: {file: ball.ply, %s, material: {color: 1}}\n%s",
                     placements[i],
                     k ? "  - mesh: {file: ball.ply, translate: [0, 900, 0]}\n" : "");
            snprintf(solid, sizeof solid, "  - sphere: {%s, material: {color: 1}}\n",
                     placements[i]);
            difference d = compare_objects(
                *state, BALL "  - directional: {direction: [-1, -1, -1.5], intensity: 1}\n", mesh,
                solid, 0.25);
            assert_true(d.greatest < 0.001 && d.mean < 0.0002);
        }
}

/* A box of twelve triangles, as glass, as a mirror, casting shadows, is the box. Where light on its
 * way is absorbed only boxes know how long it is inside, so that material casts none. */
static void test_box(void **state)
{
    static const uint32_t faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    test_mesh m = make_mesh(8, 12);
    for (uint32_t i = 0; i < 8; i++)
        set_vertex(&m, i, i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    for (uint32_t i = 0; i < 6; i++) {
        const uint32_t *f = faces[i];
        set_triangle(&m, 2 * i, f[0], f[1], f[2]);
        set_triangle(&m, 2 * i + 1, f[0], f[2], f[3]);
    }
    write_mesh(&m, "box.ply");
    free_mesh(&m);
    static const char *const materials[] = {
        "{color: orange}",
        "{diffuse: 0.1, reflect: 0.8}",
        "{diffuse: 0, transmit: 0.95, ior: 1.5, fresnel: true}",
        "{diffuse: 0, transmit: [0.9, 0.5, 0.7], ior: 1.3, absorption: [0, 0.2, 0.5]}, "
        "shadow: false",
    };
    const char *beginning = "camera: {from: [2, 3, 6], to: [0, 0.3, 0], fov: 40}\n"
                            "image: {width: 128, height: 128, samples: 1, depth: 8}\n"
                            "lights:\n  - point: {position: [4, 6, 3], intensity: 40}\n"
                            "  - directional: {direction: [0.2, -1, -0.4], intensity: 0.3}\n";
    for (size_t i = 0; i < sizeof materials / sizeof *materials; i++)
        for (int k = 0; k < 2; k++) {
            char mesh[1024], solid[512];
            const char *rest =
                "  - plane: {offset: -1.2, material: {color: {checker: [white, blue]}}}\n";
            snprintf(mesh, sizeof mesh,
                     "  - mesh: {file: box.ply, rotate: [10, 25, 5], material: %s}\n%s%s",
                     materials[i], rest,
                     k ? "  - mesh: {file: box.ply, translate: [0, 900, 0]}\n" : "");
            snprintf(solid, sizeof solid,
                     "  - box: {min: [-1, -1, -1], max: [1, 1, 1], rotate: [10, 25, 5], material: "
                     "%s}\n%s",
                     materials[i], rest);
            difference d = compare_objects(*state, beginning, mesh, solid, 0);
            assert_int_equal(d.compared, SIDE * SIDE);
            assert_true(d.above <= SIDE * SIDE / 1000);
        }
}

/* Surfaces with one side are seen from their front only, whether shown once or often, mirrored or
 * not. */
static void test_one_sided(void **state)
{
    test_mesh m = sphere_mesh(3);
    write_mesh(&m, "flat.ply");
    free_mesh(&m);
    static const char *const scales[] = {"1", "[-1, 1, 1]"};
    for (int k = 0; k < 2; k++)
        for (int inside = 0; inside < 2; inside++)
            for (int mirrored = 0; mirrored < 2; mirrored++) {
                text t = {0};
                add(&t,
                    "camera: {from: [0, 0, %d], to: [0, 0, -1], fov: 5}\n"
                    "image: {width: 16, height: 16}\nambient: 1\nlights: []\nbackground: 0\n"
                    "objects:\n  - mesh: {file: flat.ply, scale: %s, material: {color: 0.5, "
                    "one_sided: true}}\n%s",
                    inside ? 0 : 8, scales[mirrored],
                    k ? "  - mesh: {file: flat.ply, translate: [0, 900, 0]}\n" : "");
                picture p = render_in_folder(*state, &t, NULL);
                for (uint32_t i = 0; i < 256; i++)
                    assert_near(pixel_at(&p, i % 16, i / 16).r, inside ? 0 : 0.5, 1e-6);
                free_picture(&p);
            }
}

/* Colours of vertices are interpolated between them, times the material's colour. */
static void test_vertex_colors(void **state)
{
    test_mesh m = make_mesh(3, 1);
    set_vertex(&m, 0, -1, -1, 0);
    set_vertex(&m, 1, 1, -1, 0);
    set_vertex(&m, 2, -1, 1, 0);
    set_triangle(&m, 0, 0, 1, 2);
    m.colors = calloc(9, 1);
    assert_non_null(m.colors);
    m.colors[0] = m.colors[4] = m.colors[8] = 255;
    write_mesh(&m, "colors.ply");
    free_mesh(&m);
    for (int k = 0; k < 2; k++) {
        text t = {0};
        add(&t,
            "camera: {from: [0, 0, 100], to: [0, 0, 0], fov: %.17g}\n"
            "image: {width: 64, height: 64}\nambient: 1\nlights: []\nbackground: 9\nobjects:\n"
            "  - mesh: {file: colors.ply, material: {color: [1, 0.5, 0.25]}}\n%s",
            2 * atan(0.01) * 57.29577951308232,
            k ? "  - mesh: {file: colors.ply, translate: [0, 900, 0]}\n" : "");
        picture p = render_in_folder(*state, &t, NULL);
        uint32_t inside = 0;
        for (uint32_t i = 0; i < 64 * 64; i++) {
            double b = (i % 64 + 0.5) / 64, c = 1 - (i / 64 + 0.5) / 64;
            rgb found = pixel_at(&p, i % 64, i / 64);
            if (b + c > 0.999)
                continue;
            assert_near(found.r, 1 - b - c, 1e-4);
            assert_near(found.g, 0.5 * b, 1e-4);
            assert_near(found.b, 0.25 * c, 1e-4);
            inside++;
        }
        assert_int_equal(inside, 64 * 63 / 2);
        free_picture(&p);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ball),
        cmocka_unit_test(test_highlight),
        cmocka_unit_test(test_stretched_instances),
        cmocka_unit_test(test_box),
        cmocka_unit_test(test_one_sided),
        cmocka_unit_test(test_vertex_colors),
        cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device_and_folder, teardown);
}
