/* The picture does not depend on how rays go through trees: in packets or by themselves, with
 * leaves of any size, through texel or storage buffers, in any cut of the work, on any driver. */
#include "gpu_tests.h"

#include "mesh_tests.h"

#define MANY 5000

typedef enum kind { SPHERES, ELLIPSOIDS, BOXES, CONES, FLATS, KINDS } object_kind;

static void add_vector(text *t, uint32_t *seed, const char *key, double reach)
{
    add(t, "%s: [%.6g, %.6g, %.6g], ", key, (double)random_between(seed, -reach, reach),
        (double)random_between(seed, -reach, reach), (double)random_between(seed, -reach, reach));
}

static void add_object(text *t, uint32_t *seed, object_kind kind)
{
    static const char *const materials[16] = {"glass", "mirror", "thin", "checked", "sided"};
    double size = (double)random_between(seed, 0.02, 0.25);
    uint32_t choice = random_bits(seed) % 3;
    switch (kind) {
    case SPHERES:
    case KINDS:
        add(t, "  - sphere: {radius: %.6g, ", size);
        break;
    case ELLIPSOIDS:
        add(t, "  - sphere: {radius: %.6g, scale: [1, 2, 0.4], ", size);
        break;
    case BOXES:
        add(t, "  - box: {min: [0, 0, 0], max: [%.6g, %.6g, %.6g], ", size, size / 2, size * 2);
        break;
    case CONES:
        add(t, "  - %s: {from: [0, 0, 0], to: [0, %.6g, %.6g], radius: %.6g, ",
            choice ? "cone" : "cylinder", size, size, size / 2);
        if (choice == 2)
            add(t, "open: true, ");
        break;
    case FLATS:
        if (choice == 0)
            add(t, "  - rectangle: {corner: [0, 0, 0], u: [%.6g, 0, 0], v: [0, %.6g, %.6g], ", size,
                size, size);
        else if (choice == 1)
            add(t, "  - disk: {center: [0, 0, 0], normal: [1, 0.5, 2], radius: %.6g, ", size);
        else
            add(t, "  - triangle: {a: [0, 0, 0], b: [%.6g, 0, 0], c: [0, %.6g, 0.1], ", 2 * size,
                2 * size);
        break;
    }
    add_vector(t, seed, "rotate", 180);
    add_vector(t, seed, "translate", 3);
    const char *material = materials[random_bits(seed) % 16];
    add(t, "material: %s}\n", material ? material : random_bits(seed) & 1 ? "red" : "grey");
}

static void add_beginning(text *t, uint32_t lights)
{
    add(t, "camera: {from: [0, 1, 8], to: [0, 0, 0], fov: 50}\n"
           "image: {width: 45, height: 37, depth: 4, seed: 3}\n"
           "materials:\n"
           "  glass: {diffuse: 0, transmit: 0.9, ior: 1.5, fresnel: true, absorption: [1, 0, 2]}\n"
           "  thin: {color: orange, diffuse: 0.5, transmit: [0.5, 0.2, 0.1]}\n"
           "  mirror: {diffuse: 0.1, reflect: 0.8}\n"
           "  checked: {color: {checker: [white, blue], size: 0.1}, specular: 0.5}\n"
           "  sided: {color: green, one_sided: true}\n"
           "  red: {color: red}\n"
           "  grey: {color: 0.8}\n"
           "lights:\n"
           "  - directional: {direction: [0.2, -1, -0.4], intensity: 0.3}\n");
    for (uint32_t i = 1; i < lights; i++)
        add(t, "  - point: {position: [%u, %u, %g], intensity: 12}\n", 2 * i, 6 - i / 2,
            6 - 1.5 * i);
    add(t, "objects:\n  - plane: {offset: -3, material: checked}\n");
}

/* A picture's hash and what was counted on the way, which is to be the same as well. */
typedef struct result {
    char hash[65];
    uint64_t counts[11];
} result;

static result result_of(lr_device *device, const lr_scene *scene, const lr_render_options *options)
{
    picture p = render_scene(device, scene, options);
    const lr_render_stats *s = &p.stats;
    result r = {.counts = {s->primary.hit, s->reflected.traced, s->reflected.hit,
                           s->refracted.traced, s->refracted.hit, s->shadow.traced, s->passed,
                           s->dropped_depth, s->dropped_nesting, s->non_finite, s->saturated}};
    memcpy(r.hash, s->hash, sizeof r.hash);
    free_picture(&p);
    return r;
}

static void expect_same(const char *what, uint32_t variant, const result *r, const result *expected)
{
    for (int i = 0; i < 11; i++)
        if (r->counts[i] != expected->counts[i])
            fail_msg("%s, variant %u: count %d is %llu, expected %llu", what, variant, i,
                     (unsigned long long)r->counts[i], (unsigned long long)expected->counts[i]);
    if (strcmp(r->hash, expected->hash) != 0)
        fail_msg("%s, variant %u: another picture", what, variant);
}

/* The scene on the second driver, if its manifest is known. */
static void check_second_driver(const char *what, const lr_scene *scene, const result *expected)
{
    const char *manifest = getenv("LAVARAY_SWIFTSHADER_ICD");
    if (!manifest)
        return;
    char *names[] = {"VK_ICD_FILENAMES", "VK_DRIVER_FILES"}, *values[2] = {NULL};
    for (int i = 0; i < 2; i++)
        values[i] = getenv(names[i]) ? strdup(getenv(names[i])) : NULL;
    unsetenv(names[1]);
    setenv(names[0], manifest, 1);
    lr_device *device;
    MUST(lr_device_open(&(lr_device_desc){0}, &device, error));
    result r = result_of(device, scene, NULL);
    lr_device_close(device);
    for (int i = 0; i < 2; i++) {
        unsetenv(names[i]);
        if (values[i])
            setenv(names[i], values[i], 1);
        free(values[i]);
    }
    expect_same(what, 1000, &r, expected);
}

/* Renders the text's scene in every way. `few`: only in those that differ most. */
static void check_variants(lr_device *device, const char *what, text *t, bool few)
{
    static const lr_render_options variants[] = {
        {.single_rays = true},
        {.leaf_size = 8},
        {.single_rays = true, .storage_loads = true, .leaf_size = 1, .tile_size = 33},
        {.leaf_size = 1, .threads = 1},
        {.leaf_size = 2, .threads = 2},
        {.leaf_size = 4, .threads = 8},
        {.leaf_size = 8, .single_rays = true},
        {.storage_loads = true},
        {.tile_size = 8, .chunk_rays = 64},
        {.tile_size = 16, .chunk_rays = 1000, .single_rays = true},
        {.chunk_rays = 1u << 17},
    };
    uint32_t count = few ? 3 : sizeof variants / sizeof *variants;
    lr_scene *scene = parse_in_folder(t);
    result expected = result_of(device, scene, NULL);
    for (uint32_t i = 0; i < count; i++) {
        result r = result_of(device, scene, &variants[i]);
        expect_same(what, i, &r, &expected);
    }
    check_second_driver(what, scene, &expected);
    lr_scene_destroy(scene);
}

static void test_each_kind(void **state)
{
    static const char *const names[KINDS] = {"spheres", "ellipsoids", "boxes", "cones", "flats"};
    for (object_kind kind = SPHERES; kind < KINDS; kind++) {
        text t = {0};
        uint32_t seed = 11 + kind;
        add_beginning(&t, 3);
        for (int i = 0; i < MANY; i++)
            add_object(&t, &seed, kind);
        check_variants(*state, names[kind], &t, kind != SPHERES);
    }
}

/* Some kinds with trees, some in lists, and more lights than segments of the queue. */
static void test_mixture(void **state)
{
    static const int counts[2][KINDS] = {{MANY, MANY, MANY, MANY, MANY}, {3, 40, 5, 6, 7}};
    for (int mix = 0; mix < 2; mix++) {
        text t = {0};
        uint32_t seed = 5;
        add_beginning(&t, 9);
        for (object_kind kind = SPHERES; kind < KINDS; kind++)
            for (int i = 0; i < counts[mix][kind]; i++)
                add_object(&t, &seed, kind);
        check_variants(*state, mix ? "lists and trees" : "all kinds", &t, mix == 0);
    }
}

static void add_mesh_object(text *t, uint32_t *seed, const char *file, double size, bool mirrored)
{
    static const char *const materials[8] = {"glass", "mirror", "thin", "checked", "sided"};
    const char *material = materials[random_bits(seed) % 8];
    add(t, "  - mesh: {file: %s, scale: [%.6g, %.6g, %.6g], ", file, mirrored ? -size : size,
        size * (double)random_between(seed, 0.5, 2), size);
    add_vector(t, seed, "rotate", 180);
    add_vector(t, seed, "translate", 2.5);
    add(t, "material: %s}\n", material ? material : "grey");
}

static void test_meshes(void **state)
{
    const uint32_t times_shown[] = {1, 3, 40};
    test_mesh ball = sphere_mesh(4), rough = sphere_mesh(4), torus = torus_mesh(60, 400, 0.4);
    add_sphere_normals(&ball);
    add_colors(&ball, 1);
    roughen(&rough, 0.2, 2);
    write_mesh(&ball, "ball.ply");
    write_mesh(&rough, "rough.ply");
    write_mesh(&torus, "torus.ply");
    free_mesh(&ball);
    free_mesh(&rough);
    free_mesh(&torus);
    for (int shown = 0; shown < 3; shown++) {
        text t = {0};
        uint32_t seed = 77;
        add_beginning(&t, 5);
        double size = shown == 2 ? 0.5 : 1.2;
        for (uint32_t i = 0; i < times_shown[shown]; i++) {
            add_mesh_object(&t, &seed, "ball.ply", size, i % 3 == 1);
            add_mesh_object(&t, &seed, "rough.ply", size, i % 3 == 2);
            add_mesh_object(&t, &seed, "torus.ply", size, shown == 0);
        }
        for (int i = 0; i < 60; i++)
            add_object(&t, &seed, SPHERES);
        check_variants(*state, "meshes", &t, shown == 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_kind),
        cmocka_unit_test(test_mixture),
        cmocka_unit_test(test_meshes),
        cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device_and_folder, teardown);
}
