/* Closed meshes have no holes: no ray from inside to a vertex or to a point of an edge, which are
 * rounded to floats, gets out between the triangles there, nor does any ray of a picture. */
#include "gpu_tests.h"

#include "mesh_tests.h"

#include "watertight.spv.h"

#define RING 14
#define ROUNDS 64 /* rays of an invocation */

typedef struct edge {
    float from[3], count, to[3], reach, center[4], corners[3 * RING][4];
} edge;

/* ROUNDS * LR_GROUP_SIZE rays to each edge of so many. */
#define EDGES 900u

/* Where rays to a point may start from: somewhere from which they meet its triangles from inside.
 */
typedef void (*start)(const float *point, double offset, float center[3], float *reach);

static void inside_of_sphere(const float *point, double offset, float center[3], float *reach)
{
    (void)point;
    for (int k = 0; k < 3; k++)
        center[k] = (float)offset;
    *reach = 0.2f;
}

static void inside_of_torus(const float *point, double offset, float center[3], float *reach)
{
    double x = (double)point[0] - offset, z = (double)point[2] - offset, r = sqrt(x * x + z * z);
    center[0] = (float)(offset + x / r);
    center[1] = (float)offset;
    center[2] = (float)(offset + z / r);
    *reach = 0.05f;
}

static bool has_corner(const uint32_t *triangle, uint32_t vertex)
{
    return triangle[0] == vertex || triangle[1] == vertex || triangle[2] == vertex;
}

static void describe_edge(const test_mesh *m, uint32_t from, uint32_t to, edge *e)
{
    uint32_t count = 0;
    memcpy(e->from, &m->positions[3 * (size_t)from], sizeof e->from);
    memcpy(e->to, &m->positions[3 * (size_t)to], sizeof e->to);
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        const uint32_t *t = &m->triangles[3 * (size_t)i];
        if (!has_corner(t, from) && !has_corner(t, to))
            continue;
        assert_in_range(count, 0, RING - 1);
        for (uint32_t k = 0; k < 3; k++)
            memcpy(e->corners[3 * count + k], &m->positions[3 * (size_t)t[k]], 3 * sizeof(float));
        count++;
    }
    e->count = (float)count;
}

/* Returns how many rays there were; *fused is how many of them a fused test would lose. */
static uint64_t check_edges(lr_device *device, const test_mesh *m, const char *name, start inside,
                            double offset, uint64_t *fused)
{
    edge *edges = calloc(EDGES, sizeof *edges);
    assert_non_null(edges);
    uint32_t(*out)[4] = calloc(EDGES * LR_GROUP_SIZE, sizeof *out), seed = 3;
    uint64_t lost = 0, lost_fused = 0, rays = 0;
    assert_non_null(out);
    for (uint32_t i = 0; i < EDGES; i++) {
        const uint32_t *t = &m->triangles[3 * (size_t)(random_bits(&seed) % m->triangle_count)];
        uint32_t k = random_bits(&seed) % 3;
        describe_edge(m, t[k], t[(k + 1) % 3], &edges[i]);
        inside(edges[i].from, offset, edges[i].center, &edges[i].reach);
    }
    run_kernel(device, &(kernel){.words = watertight_spv,
                                 .word_count = sizeof watertight_spv / 4,
                                 .in = edges,
                                 .in_size = EDGES * sizeof *edges,
                                 .out = out,
                                 .out_size = EDGES * LR_GROUP_SIZE * sizeof *out,
                                 .groups = EDGES});
    for (uint32_t i = 0; i < EDGES * LR_GROUP_SIZE; i++) {
        lost += out[i][0];
        lost_fused += out[i][1];
        rays += out[i][2];
    }
    print_message("%s, %g off: %llu of %llu rays get out; fused, %llu\n", name, offset,
                  (unsigned long long)lost, (unsigned long long)rays,
                  (unsigned long long)lost_fused);
    assert_int_equal(rays, EDGES * ROUNDS * LR_GROUP_SIZE);
    assert_int_equal(lost, 0);
    *fused += lost_fused;
    free(out);
    free(edges);
    return rays;
}

static void move(test_mesh *m, double by)
{
    for (uint32_t i = 0; i < 3 * m->vertex_count; i++)
        m->positions[i] += (float)by;
}

static void test_edges(void **state)
{
    uint64_t rays = 0, fused = 0;
    for (double offset = 0; offset <= 1000; offset += 1000) {
        test_mesh ball = sphere_mesh(4), rough = sphere_mesh(4), torus = torus_mesh(12, 900, 0.4);
        roughen(&rough, 0.03, 4);
        move(&ball, offset);
        move(&rough, offset);
        move(&torus, offset);
        rays += check_edges(*state, &ball, "sphere", inside_of_sphere, offset, &fused);
        rays += check_edges(*state, &rough, "rough sphere", inside_of_sphere, offset, &fused);
        rays += check_edges(*state, &torus, "torus of needles", inside_of_torus, offset, &fused);
        free_mesh(&ball);
        free_mesh(&rough);
        free_mesh(&torus);
    }
    assert_true(rays >= 10000000);
    assert_true(fused > 100); /* or the rays do not aim where it matters */
}

/* With trees: all that a camera inside a mesh sees is the mesh, shown once or as an instance. */
static void test_pictures_from_inside(void **state)
{
    test_mesh rough = sphere_mesh(6);
    roughen(&rough, 0.05, 4);
    write_mesh(&rough, "rough.ply");
    free_mesh(&rough);
    for (uint32_t times = 1; times <= 2; times++)
        for (uint32_t single = 0; single <= 1; single++)
            for (uint32_t offset = 0; offset <= 1000; offset += 1000) {
                text t = {0};
                add(&t,
                    "camera: {from: [%u, %u, %u], to: [%u.5, %u.3, %u.1], fov: 120}\n"
                    "image: {width: 512, height: 512, samples: 2, depth: 0}\n"
                    "lights: []\nambient: 1\nobjects:\n",
                    offset, offset, offset, offset, offset, offset);
                for (uint32_t i = 0; i < times; i++)
                    add(&t,
                        "  - mesh: {file: rough.ply, rotate: [10, 20, 30], "
                        "translate: [%u, %u, %u]}\n",
                        offset + 10 * i, offset, offset);
                lr_render_options options = {.single_rays = single};
                picture p = render_in_folder(*state, &t, &options);
                assert_int_equal(p.stats.primary.traced, 2 * 512 * 512);
                assert_int_equal(p.stats.primary.hit, p.stats.primary.traced);
                free_picture(&p);
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_edges),
        cmocka_unit_test(test_pictures_from_inside),
        cmocka_unit_test(test_validation_is_silent),
    };
    return cmocka_run_group_tests(tests, setup_device_and_folder, teardown);
}
