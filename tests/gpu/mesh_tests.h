/* Shared by the tests of trees and meshes: texts that grow, closed meshes and files of them.
 * Include it behind gpu_tests.h. */
#ifndef LR_MESH_TESTS_H
#define LR_MESH_TESTS_H

#include "base/vec.h"
#include "unit/temporary_folder.h"

/* A group's setup: the device is *state. Its teardown is `teardown`. */
static inline int setup_device_and_folder(void **state)
{
    return setup(state) ? -1 : setup_device(state);
}

/* ---- Texts --------------------------------------------------------------------------------- */

typedef struct text {
    char *bytes;
    size_t used, room;
} text;

__attribute__((format(printf, 2, 3))) static inline void add(text *t, const char *format, ...)
{
    va_list arguments;
    if (t->room - t->used < 2048) {
        t->room = 2 * t->room + 65536;
        t->bytes = realloc(t->bytes, t->room);
        assert_non_null(t->bytes);
    }
    va_start(arguments, format);
    int length = vsnprintf(t->bytes + t->used, t->room - t->used, format, arguments);
    va_end(arguments);
    assert_in_range(length, 0, t->room - t->used - 1);
    t->used += (size_t)length;
}

/* Parses a scene that may name files of `folder`, and frees its text. */
static inline lr_scene *parse_in_folder(text *t)
{
    char name[128];
    lr_scene *scene = NULL;
    char *report = NULL;
    lr_error error = {0};
    snprintf(name, sizeof name, "%s/test.yaml", folder);
    if (lr_scene_parse(t->bytes, t->used, name, &scene, &report, &error))
        fail_msg("%s\n%s\n%.2000s", error.message, report ? report : "", t->bytes);
    free(t->bytes);
    *t = (text){0};
    return scene;
}

static inline picture render_scene(lr_device *device, const lr_scene *scene,
                                   const lr_render_options *options)
{
    picture result;
    lr_error error = {0};
    if (lr_render(device, scene, options, &result.image, &result.stats, &error))
        fail_msg("%s", error.message);
    return result;
}

static inline picture render_in_folder(lr_device *device, text *t, const lr_render_options *options)
{
    lr_scene *scene = parse_in_folder(t);
    picture result = render_scene(device, scene, options);
    lr_scene_destroy(scene);
    return result;
}

/* ---- Meshes -------------------------------------------------------------------------------- */

typedef struct test_mesh {
    float *positions; /* 3 a vertex */
    float *normals;   /* 3 a vertex, or NULL */
    uint8_t *colors;  /* 3 a vertex, or NULL */
    uint32_t *triangles;
    uint32_t vertex_count, triangle_count;
} test_mesh;

static inline test_mesh make_mesh(uint32_t vertices, uint32_t triangles)
{
    test_mesh m = {.vertex_count = vertices, .triangle_count = triangles};
    m.positions = calloc(3 * (size_t)vertices + 1, sizeof *m.positions);
    m.triangles = calloc(3 * (size_t)triangles + 1, sizeof *m.triangles);
    assert_true(m.positions && m.triangles);
    return m;
}

static inline void free_mesh(test_mesh *m)
{
    free(m->positions);
    free(m->normals);
    free(m->colors);
    free(m->triangles);
    *m = (test_mesh){0};
}

static inline void set_vertex(test_mesh *m, uint32_t i, double x, double y, double z)
{
    float *p = &m->positions[3 * (size_t)i];
    p[0] = (float)x;
    p[1] = (float)y;
    p[2] = (float)z;
}

static inline void set_triangle(test_mesh *m, uint32_t i, uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t *t = &m->triangles[3 * (size_t)i];
    t[0] = a;
    t[1] = b;
    t[2] = c;
}

/* A vertex on the unit sphere for the sum of two vertices, the same one for the same two: the
 * vertices of one generation are found by a search, as there are few. */
static inline uint32_t middle_of(test_mesh *m, uint32_t a, uint32_t b, uint32_t first)
{
    const float *p = &m->positions[3 * (size_t)a], *q = &m->positions[3 * (size_t)b];
    lr_vec3 sum = {(double)p[0] + (double)q[0], (double)p[1] + (double)q[1],
                   (double)p[2] + (double)q[2]};
    lr_vec3 v = lr_vec3_normalize(sum);
    for (uint32_t i = first; i < m->vertex_count; i++) {
        const float *r = &m->positions[3 * (size_t)i];
        if (fabs((double)r[0] - v.x) + fabs((double)r[1] - v.y) + fabs((double)r[2] - v.z) < 1e-6)
            return i;
    }
    set_vertex(m, m->vertex_count, v.x, v.y, v.z);
    return m->vertex_count++;
}

/* The unit sphere as an octahedron whose triangles are cut in four that many times: 8 * 4^times of
 * them, counter-clockwise as seen from outside. */
static inline test_mesh sphere_mesh(uint32_t times)
{
    uint32_t triangles = 8u << 2 * times;
    test_mesh m = make_mesh(triangles / 2 + 2, triangles);
    static const int axes[6][3] = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                   {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
    for (uint32_t i = 0; i < 6; i++)
        set_vertex(&m, i, axes[i][0], axes[i][1], axes[i][2]);
    for (uint32_t i = 0; i < 8; i++) {
        uint32_t x = i & 1, y = 2 + (i >> 1 & 1), z = 4 + (i >> 2);
        bool turned = ((i ^ i >> 1 ^ i >> 2) & 1) != 0;
        set_triangle(&m, i, x, turned ? z : y, turned ? y : z);
    }
    m.vertex_count = 6;
    for (uint32_t count = 8; count < triangles; count *= 4) {
        uint32_t next = m.vertex_count;
        for (uint32_t i = 0; i < count; i++) {
            uint32_t *t = &m.triangles[3 * (size_t)i], a = t[0], b = t[1], c = t[2];
            uint32_t ab = middle_of(&m, a, b, next), bc = middle_of(&m, b, c, next);
            uint32_t ca = middle_of(&m, c, a, next);
            set_triangle(&m, i, ab, bc, ca);
            set_triangle(&m, count + 3 * i, a, ab, ca);
            set_triangle(&m, count + 3 * i + 1, b, bc, ab);
            set_triangle(&m, count + 3 * i + 2, c, ca, bc);
        }
    }
    return m;
}

/* A closed surface of around x along coordinates, wrapped in both directions. */
static inline test_mesh torus_mesh(uint32_t around, uint32_t along, double thickness)
{
    test_mesh m = make_mesh(around * along, 2 * around * along);
    for (uint32_t i = 0; i < around; i++)
        for (uint32_t j = 0; j < along; j++) {
            double a = 6.283185307179586 * i / around, b = 6.283185307179586 * j / along;
            double r = 1 + thickness * cos(b);
            uint32_t at = i * along + j, right = (i + 1) % around * along + j;
            uint32_t up = i * along + (j + 1) % along;
            uint32_t both = (i + 1) % around * along + (j + 1) % along;
            set_vertex(&m, at, r * cos(a), thickness * sin(b), r * sin(a));
            set_triangle(&m, 2 * at, at, up, right);
            set_triangle(&m, 2 * at + 1, right, up, both);
        }
    return m;
}

/* Moves every vertex along its own direction by up to that part of its length. */
static inline void roughen(test_mesh *m, double by, uint32_t seed)
{
    for (uint32_t i = 0; i < m->vertex_count; i++) {
        float *p = &m->positions[3 * (size_t)i], factor = random_between(&seed, 1 - by, 1 + by);
        for (int k = 0; k < 3; k++)
            p[k] *= factor;
    }
}

/* Normals of the unit sphere. */
static inline void add_sphere_normals(test_mesh *m)
{
    m->normals = malloc(3 * sizeof(float) * m->vertex_count);
    assert_non_null(m->normals);
    memcpy(m->normals, m->positions, 3 * sizeof(float) * m->vertex_count);
}

static inline void add_colors(test_mesh *m, uint32_t seed)
{
    m->colors = malloc(3 * (size_t)m->vertex_count);
    assert_non_null(m->colors);
    for (uint32_t i = 0; i < 3 * m->vertex_count; i++)
        m->colors[i] = (uint8_t)random_bits(&seed);
}

/* Writes the mesh as a file of `folder`. */
static inline void write_mesh(const test_mesh *m, const char *name)
{
    char path[128];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fprintf(file, "ply\nformat binary_little_endian 1.0\nelement vertex %u\n", m->vertex_count);
    fprintf(file, "property float x\nproperty float y\nproperty float z\n");
    if (m->normals)
        fprintf(file, "property float nx\nproperty float ny\nproperty float nz\n");
    if (m->colors)
        fprintf(file, "property uchar red\nproperty uchar green\nproperty uchar blue\n");
    fprintf(file, "element face %u\nproperty list uchar uint vertex_indices\nend_header\n",
            m->triangle_count);
    for (size_t i = 0; i < m->vertex_count; i++) {
        fwrite(&m->positions[3 * i], sizeof(float), 3, file);
        if (m->normals)
            fwrite(&m->normals[3 * i], sizeof(float), 3, file);
        if (m->colors)
            fwrite(&m->colors[3 * i], 1, 3, file);
    }
    for (size_t i = 0; i < m->triangle_count; i++) {
        fputc(3, file);
        fwrite(&m->triangles[3 * i], sizeof(uint32_t), 3, file);
    }
    assert_int_equal(fclose(file), 0);
}

#endif
