/* Closed meshes have no holes: no ray from inside to a vertex or to a point of an edge, which are
 * rounded to floats, gets out between the triangles there, nor does any ray of a picture. */
#include "gpu_tests.h"

#include "mesh_tests.h"

#include "watertight.spv.h"

#define RING 32
#define ROUNDS 64 /* rays of an invocation */

typedef struct edge {
    float from[3], count, to[3], reach, center[3], extent, corners[3 * RING][4];
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

static void inside_of_flattened(const float *point, double offset, float center[3], float *reach)
{
    inside_of_sphere(point, offset, center, reach);
    *reach = 0.45f;
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
        for (uint32_t k = 0; k < 3; k++) {
            float *corner = e->corners[3 * count + k];
            memcpy(corner, &m->positions[3 * (size_t)t[k]], 3 * sizeof *corner);
            for (uint32_t axis = 0; axis < 3; axis++)
                e->extent = fmaxf(e->extent, fabsf(corner[axis]));
        }
        count++;
    }
    e->count = (float)count;
}

/* With edges of triangles from `first` on. Returns how many rays there were; *fused is how many of
 * them a fused test would lose. */
static uint64_t check_edges(lr_device *device, const test_mesh *m, uint32_t first, const char *name,
                            start inside, double offset, uint64_t *fused)
{
    edge *edges = calloc(EDGES, sizeof *edges);
    assert_non_null(edges);
    uint32_t(*out)[4] = calloc(EDGES * LR_GROUP_SIZE, sizeof *out), seed = 3;
    uint64_t lost = 0, lost_fused = 0, rays = 0;
    assert_non_null(out);
    for (uint32_t i = 0; i < EDGES; i++) {
        uint32_t triangle = first + random_bits(&seed) % (m->triangle_count - first);
        const uint32_t *t = &m->triangles[3 * (size_t)triangle];
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

/* Six parts of the unit sphere made flat, across the axes, so that the boxes of triangles there
 * have no depth. */
static void flatten(test_mesh *m)
{
    for (uint32_t i = 0; i < 3 * m->vertex_count; i++)
        m->positions[i] = fminf(fmaxf(m->positions[i], -0.8f), 0.8f);
}

/* The mesh with a vertex beside the first edge of each triangle, 1e-5 of the way to the corner
 * across: a sliver lies between the two triangles there and the whole edge of the neighbour. The
 * slivers are its last third. */
static test_mesh with_slivers(const test_mesh *m)
{
    test_mesh cut = make_mesh(m->vertex_count + m->triangle_count, 3 * m->triangle_count);
    memcpy(cut.positions, m->positions, 3 * sizeof *m->positions * m->vertex_count);
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        const uint32_t *t = &m->triangles[3 * (size_t)i], middle = m->vertex_count + i;
        for (size_t axis = 0; axis < 3; axis++) {
            double a = (double)m->positions[3 * (size_t)t[0] + axis];
            double b = (double)m->positions[3 * (size_t)t[1] + axis];
            double c = (double)m->positions[3 * (size_t)t[2] + axis];
            cut.positions[3 * (size_t)middle + axis] = (float)(0.6 * a + 0.39999 * b + 0.00001 * c);
        }
        set_triangle(&cut, 2 * i, t[0], middle, t[2]);
        set_triangle(&cut, 2 * i + 1, middle, t[1], t[2]);
        set_triangle(&cut, 2 * m->triangle_count + i, t[0], t[1], middle);
    }
    return cut;
}

static void test_edges(void **state)
{
    uint64_t rays = 0, fused = 0;
    for (double offset = 0; offset <= 1000; offset += 1000) {
        test_mesh ball = sphere_mesh(4), rough = sphere_mesh(4), torus = torus_mesh(12, 900, 0.4);
        test_mesh flattened = sphere_mesh(4);
        roughen(&rough, 0.03, 4);
        flatten(&flattened);
        move(&ball, offset);
        move(&rough, offset);
        move(&torus, offset);
        move(&flattened, offset);
        test_mesh slivers = with_slivers(&flattened);
        rays += check_edges(*state, &ball, 0, "sphere", inside_of_sphere, offset, &fused);
        rays += check_edges(*state, &rough, 0, "rough sphere", inside_of_sphere, offset, &fused);
        rays += check_edges(*state, &torus, 0, "torus of needles", inside_of_torus, offset, &fused);
        rays += check_edges(*state, &slivers, 2 * flattened.triangle_count, "slivers",
                            inside_of_flattened, offset, &fused);
        free_mesh(&ball);
        free_mesh(&rough);
        free_mesh(&torus);
        free_mesh(&flattened);
        free_mesh(&slivers);
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
