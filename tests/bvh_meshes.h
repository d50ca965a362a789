/* Triangles for the tests and the benchmark of the hierarchy: the same on every machine. */
#ifndef LR_TESTS_BVH_MESHES_H
#define LR_TESTS_BVH_MESHES_H

#include <stdlib.h>

#include "bvh/bvh.h"

typedef struct mesh {
    uint32_t vertex_count, count; /* count: of the triangles */
    float (*vertices)[3];
    uint32_t (*triangles)[3];
    lr_bvh_box *boxes; /* of the triangles */
} mesh;

static inline uint32_t mesh_hash(uint32_t x)
{
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

/* In [0, 1), the next of a sequence. */
static inline float mesh_random(uint32_t *state)
{
    return (float)(mesh_hash((*state)++) >> 8) * 0x1p-24f;
}

/* Smooth noise with grid points at whole numbers. */
static inline float mesh_noise(float x, float y)
{
    int i = (int)x, j = (int)y;
    float u = x - (float)i, v = y - (float)j, corner[2][2];
    for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++)
            corner[a][b] = (float)(mesh_hash((uint32_t)((i + a) * 7919 + j + b)) >> 8) * 0x1p-24f;
    u = u * u * (3 - 2 * u);
    v = v * v * (3 - 2 * v);
    return (corner[0][0] * (1 - u) + corner[1][0] * u) * (1 - v) +
           (corner[0][1] * (1 - u) + corner[1][1] * u) * v;
}

static inline lr_bvh_box triangle_box(const float *a, const float *b, const float *c)
{
    lr_bvh_box box;
    for (int k = 0; k < 3; k++) {
        float low = a[k] < b[k] ? a[k] : b[k], high = a[k] < b[k] ? b[k] : a[k];
        box.min[k] = low < c[k] ? low : c[k];
        box.max[k] = high > c[k] ? high : c[k];
    }
    return box;
}

static inline mesh mesh_allocate(uint32_t vertex_count, uint32_t count)
{
    mesh m = {vertex_count, count, NULL, NULL, NULL};
    m.vertices = malloc((size_t)vertex_count * sizeof *m.vertices);
    m.triangles = malloc((size_t)count * sizeof *m.triangles);
    m.boxes = malloc((size_t)count * sizeof *m.boxes);
    if (!m.vertices || !m.triangles || !m.boxes)
        abort();
    return m;
}

static inline void mesh_set(mesh *m, uint32_t triangle, uint32_t a, uint32_t b, uint32_t c)
{
    m->triangles[triangle][0] = a;
    m->triangles[triangle][1] = b;
    m->triangles[triangle][2] = c;
    m->boxes[triangle] = triangle_box(m->vertices[a], m->vertices[b], m->vertices[c]);
}

static inline void mesh_free(mesh *m)
{
    free(m->vertices);
    free(m->triangles);
    free(m->boxes);
}

/* Hills over the unit square, 2 * side^2 triangles: side 187 for 70,000, 708 for a million. */
static inline mesh mesh_terrain(uint32_t side)
{
    mesh m = mesh_allocate((side + 1) * (side + 1), 2 * side * side);
    for (uint32_t i = 0; i < m.vertex_count; i++) {
        float x = (float)(i % (side + 1)) / (float)side, y = (float)(i / (side + 1)) / (float)side;
        float height = 0, strength = 0.25f;
        for (float step = 4; step < 200; step *= 2, strength *= 0.5f)
            height += strength * mesh_noise(x * step, y * step);
        m.vertices[i][0] = x;
        m.vertices[i][1] = height;
        m.vertices[i][2] = y;
    }
    for (uint32_t i = 0; i < side * side; i++) {
        uint32_t at = i / side * (side + 1) + i % side;
        mesh_set(&m, 2 * i, at, at + 1, at + side + 1);
        mesh_set(&m, 2 * i + 1, at + 1, at + side + 2, at + side + 1);
    }
    return m;
}

/* Triangles of at most `size` strewn over the unit cube. */
static inline mesh mesh_soup(uint32_t count, float size, uint32_t seed)
{
    mesh m = mesh_allocate(3 * count, count);
    for (uint32_t i = 0; i < count; i++) {
        float corner[3];
        for (int k = 0; k < 3; k++)
            corner[k] = mesh_random(&seed);
        for (int k = 0; k < 9; k++)
            m.vertices[3 * i + k / 3][k % 3] = corner[k % 3] + size * mesh_random(&seed);
        mesh_set(&m, i, 3 * i, 3 * i + 1, 3 * i + 2);
    }
    return m;
}

/* Cubes on the axes that touch the origin, on each with centres at 17^-1, 17^-2 and so on, the
 * others at the least distance: between bins there are only planes that part the farthest cube of
 * an axis from all the others. */
static inline void fill_deep_boxes(lr_bvh_box *boxes, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        float size = 1;
        for (uint32_t k = 0; k <= i / 3 && k < 24; k++)
            size /= 17;
        for (uint32_t k = 0; k < 3; k++) {
            float center = i < 72 && k == i % 3 ? size : 0;
            boxes[i].min[k] = center - size;
            boxes[i].max[k] = center + size;
        }
    }
}

/* Where the ray meets the triangle within its range, by Moeller and Trumbore in double. */
static inline bool mesh_hit(const mesh *m, uint32_t triangle, const lr_bvh_ray *ray, double *t)
{
    double e1[3], e2[3], p[3], q[3], s[3];
    const float *a = m->vertices[m->triangles[triangle][0]];
    const float *b = m->vertices[m->triangles[triangle][1]];
    const float *c = m->vertices[m->triangles[triangle][2]];
    const double *d = ray->direction;
    for (int k = 0; k < 3; k++) {
        e1[k] = (double)b[k] - (double)a[k];
        e2[k] = (double)c[k] - (double)a[k];
        s[k] = ray->origin[k] - (double)a[k];
    }
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        p[k] = d[i] * e2[j] - d[j] * e2[i];
        q[k] = s[i] * e1[j] - s[j] * e1[i];
    }
    double determinant = e1[0] * p[0] + e1[1] * p[1] + e1[2] * p[2];
    double u = (s[0] * p[0] + s[1] * p[1] + s[2] * p[2]) / determinant;
    double v = (d[0] * q[0] + d[1] * q[1] + d[2] * q[2]) / determinant;
    *t = (e2[0] * q[0] + e2[1] * q[1] + e2[2] * q[2]) / determinant;
    return determinant != 0 && u >= 0 && v >= 0 && u + v <= 1 && *t >= ray->t_min &&
           *t <= ray->t_max;
}

#endif
