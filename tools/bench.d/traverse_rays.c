#include "traverse.h"

#include <math.h>

#define PIXELS 512 /* along a side */
#define FAR_AWAY 1e9

typedef struct hit {
    const mesh *m;
    const lr_bvh_ray *along;
    uint32_t triangle;
    bool found;
} hit;

static bool test(void *context, uint32_t triangle, double *t_max)
{
    hit *h = context;
    double t;
    lr_bvh_ray nearer = *h->along;
    nearer.t_max = *t_max;
    if (mesh_hit(h->m, triangle, &nearer, &t)) {
        *t_max = t;
        h->triangle = triangle;
        h->found = true;
    }
    return true;
}

static void normalize(double v[3])
{
    double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3; k++)
        v[k] /= length;
}

/* The unit normal that looks up. */
static void normal_of(const mesh *m, uint32_t triangle, double n[3])
{
    const float *a = m->vertices[m->triangles[triangle][0]];
    const float *b = m->vertices[m->triangles[triangle][1]];
    const float *c = m->vertices[m->triangles[triangle][2]];
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        n[k] = ((double)b[i] - a[i]) * ((double)c[j] - a[j]) -
               ((double)b[j] - a[j]) * ((double)c[i] - a[i]);
    }
    normalize(n);
    double side = n[1] < 0 ? -1 : 1;
    for (int k = 0; k < 3; k++)
        n[k] *= side;
}

static void add_ray(ray_set *set, int kind, const double origin[3], const double direction[3],
                    double t_max)
{
    ray *r = &set->rays[kind][set->count[kind]++];
    for (int k = 0; k < 3; k++) {
        r->origin[k] = (float)origin[k];
        r->direction[k] = (float)direction[k];
    }
    r->t_max = (float)t_max;
}

/* The shadow ray and a cosine-weighted bounce from p. */
static void leave(ray_set *set, const double p[3], const double n[3], uint32_t *seed)
{
    double origin[3], to_light[3], bounce[3], length2;
    for (int k = 0; k < 3; k++)
        origin[k] = p[k] + 1e-4 * n[k];
    for (int k = 0; k < 3; k++)
        to_light[k] = set->light[k] - origin[k];
    double distance =
        sqrt(to_light[0] * to_light[0] + to_light[1] * to_light[1] + to_light[2] * to_light[2]);
    normalize(to_light);
    add_ray(set, SHADOW, origin, to_light, distance);
    do { /* a point in the ball around the tip of the normal, brought to its surface */
        length2 = 0;
        for (int k = 0; k < 3; k++) {
            bounce[k] = 2 * (double)mesh_random(seed) - 1;
            length2 += bounce[k] * bounce[k];
        }
    } while (length2 > 1 || length2 < 1e-6);
    for (int k = 0; k < 3; k++)
        bounce[k] = bounce[k] / sqrt(length2) * 0.999 + n[k];
    normalize(bounce);
    add_ray(set, BOUNCE, origin, bounce, FAR_AWAY);
}

static uint32_t every_second_bit(uint32_t x)
{
    return (x & 1) | (x >> 1 & 2) | (x >> 2 & 4);
}

static void direction_of(uint32_t index, double d[3])
{
    static const double right[3] = {1, 0, 0}, up[3] = {0, 0.832, 0.555},
                        forward[3] = {0, -0.555, 0.832};
    uint32_t square = index / 64, inside = index % 64;
    uint32_t x = square % (PIXELS / 8) * 8 + every_second_bit(inside);
    uint32_t y = square / (PIXELS / 8) * 8 + every_second_bit(inside >> 1);
    double s = (x + 0.5) / PIXELS - 0.5, t = 0.5 - (y + 0.5) / PIXELS;
    for (int k = 0; k < 3; k++)
        d[k] = forward[k] + 0.9 * (s * right[k] + t * up[k]);
    normalize(d);
}

ray_set make_rays(const mesh *m)
{
    ray_set set = {.light = {-1, 2, 0.2f}};
    uint32_t seed = 1;
    lr_bvh *bvh;
    lr_error error;
    for (int kind = 0; kind < RAY_KINDS; kind++)
        set.rays[kind] = malloc(PIXELS * PIXELS * sizeof(ray));
    if (!set.rays[PRIMARY] || !set.rays[SHADOW] || !set.rays[BOUNCE] ||
        lr_bvh_create(m->boxes, m->count, NULL, &bvh, &error) != LR_OK)
        abort();
    for (uint32_t i = 0; i < PIXELS * PIXELS; i++) {
        lr_bvh_ray r = {.origin = {0.5, 1.1, -0.6}, .t_max = FAR_AWAY};
        direction_of(i, r.direction);
        add_ray(&set, PRIMARY, r.origin, r.direction, FAR_AWAY);
        hit h = {.m = m, .along = &r};
        lr_bvh_trace(bvh, &r, test, &h);
        if (!h.found)
            continue;
        double t, p[3], n[3];
        mesh_hit(m, h.triangle, &r, &t);
        for (int k = 0; k < 3; k++)
            p[k] = r.origin[k] + t * r.direction[k];
        normal_of(m, h.triangle, n);
        leave(&set, p, n, &seed);
    }
    lr_bvh_destroy(bvh);
    return set;
}

void free_rays(ray_set *set)
{
    for (int kind = 0; kind < RAY_KINDS; kind++)
        free(set->rays[kind]);
}
