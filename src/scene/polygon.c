#include "scene/polygon.h"

#include <math.h>

#define FLATTENED_AREA 1e-12

/* Newell's area vector: twice the area along the normal. *size is the greatest distance from the
 * first corner. */
static lr_vec3 area_vector(const lr_polygon *p, double *size)
{
    lr_vec3 sum = {0, 0, 0};
    *size = 0;
    for (uint32_t i = 1; i + 1 < p->count; i++) {
        lr_vec3 a = lr_vec3_sub(p->corners[i], p->corners[0]);
        lr_vec3 b = lr_vec3_sub(p->corners[i + 1], p->corners[0]);
        sum = lr_vec3_add(sum, lr_vec3_cross(a, b));
        *size = fmax(*size, fmax(lr_vec3_length(a), lr_vec3_length(b)));
    }
    return sum;
}

/* Leaves out the coordinate in which the normal is longest, keeping the sense of rotation. */
static void project(lr_polygon *p)
{
    lr_vec3 n = p->normal, size = {fabs(n.x), fabs(n.y), fabs(n.z)};
    for (uint32_t i = 0; i < p->count; i++) {
        lr_vec3 q = lr_vec3_sub(p->corners[i], p->corners[0]);
        bool x = size.x >= size.y && size.x >= size.z, y = !x && size.y >= size.z;
        double u = x ? q.y : y ? q.z : q.x, v = x ? q.z : y ? q.x : q.y;
        bool mirrored = (x ? n.x : y ? n.y : n.z) < 0;
        p->plane[i][0] = mirrored ? v : u;
        p->plane[i][1] = mirrored ? u : v;
    }
}

/* Twice the area of the triangle, positive when it runs counter-clockwise. */
static double turn(const lr_polygon *p, uint32_t a, uint32_t b, uint32_t c)
{
    const double *pa = p->plane[a], *pb = p->plane[b], *pc = p->plane[c];
    return (pb[0] - pa[0]) * (pc[1] - pa[1]) - (pb[1] - pa[1]) * (pc[0] - pa[0]);
}

static double turn_at(const lr_polygon *p, uint32_t i)
{
    return turn(p, p->previous[i], i, p->next[i]);
}

static bool same_place(const lr_polygon *p, uint32_t a, uint32_t b)
{
    return p->plane[a][0] == p->plane[b][0] && p->plane[a][1] == p->plane[b][1];
}

/* Whether nothing of the polygon lies in the triangle at a convex corner. Only reflex corners can,
 * and those that share their place with the triangle's own are its neighbours over a slit. */
static bool is_ear(const lr_polygon *p, uint32_t i)
{
    uint32_t a = p->previous[i], c = p->next[i];
    for (uint32_t k = p->next[c]; k != a; k = p->next[k])
        if (p->reflex[k] && !same_place(p, k, a) && !same_place(p, k, i) && !same_place(p, k, c) &&
            turn(p, a, i, k) >= 0 && turn(p, i, c, k) >= 0 && turn(p, c, a, k) >= 0)
            return false;
    return true;
}

static void judge(lr_polygon *p, uint32_t i)
{
    double bend = turn_at(p, i);
    p->reflex[i] = bend <= 0;
    p->ear[i] = bend > 0 && is_ear(p, i);
}

/* Cutting an ear off a polygon that does not cross itself changes only its neighbours. */
static void cut_off(lr_polygon *p, uint32_t i)
{
    uint32_t a = p->previous[i], c = p->next[i];
    p->next[a] = c;
    p->previous[c] = a;
    p->reflex[c] = turn_at(p, c) <= 0;
    judge(p, a);
    judge(p, c);
}

static void judge_all(lr_polygon *p, uint32_t start)
{
    uint32_t i = start;
    do {
        p->reflex[i] = turn_at(p, i) <= 0;
        i = p->next[i];
    } while (i != start);
    do {
        judge(p, i);
        i = p->next[i];
    } while (i != start);
}

typedef enum choice { EAR, STRAIGHT, FORCED, NONE } choice;

/* The first corner from `start` on that can be cut off: one on a straight line, an ear, or, when
 * there is neither, any convex one. */
static choice choose(const lr_polygon *p, uint32_t start, uint32_t *chosen)
{
    uint32_t i = start;
    choice best = NONE;
    do {
        if (p->ear[i] || (p->reflex[i] && turn_at(p, i) == 0)) {
            *chosen = i;
            return p->ear[i] ? EAR : STRAIGHT;
        }
        if (!p->reflex[i] && best == NONE) {
            *chosen = i;
            best = FORCED;
        }
        i = p->next[i];
    } while (i != start);
    return best;
}

lr_polygon_result lr_polygon_triangulate(lr_polygon *p)
{
    double size;
    lr_vec3 area = area_vector(p, &size);
    p->triangle_count = 0;
    /* Written so that NaN counts as flattened. */
    if (!(lr_vec3_length(area) > 2 * FLATTENED_AREA * size * size))
        return LR_POLYGON_FLATTENED;
    p->normal = lr_vec3_normalize(area);
    project(p);
    for (uint32_t i = 0; i < p->count; i++) {
        p->next[i] = i + 1 < p->count ? i + 1 : 0;
        p->previous[i] = i ? i - 1 : p->count - 1;
    }
    judge_all(p, 0);
    lr_polygon_result result = LR_POLYGON_GOOD;
    bool judged_again = false; /* once: rounding may have misjudged some */
    uint32_t first = 0;
    for (uint32_t left = p->count; left >= 3; left--) {
        uint32_t i = 0;
        choice found = choose(p, p->next[first], &i);
        if ((found == FORCED || found == NONE) && !judged_again) {
            judged_again = true;
            judge_all(p, first);
            found = choose(p, p->next[first], &i);
        }
        if (found == FORCED || found == NONE)
            result = LR_POLYGON_CROSSING;
        if (found == NONE)
            break;
        if (found != STRAIGHT) {
            uint32_t *t = p->triangles[p->triangle_count++];
            t[0] = p->previous[i];
            t[1] = i;
            t[2] = p->next[i];
        }
        first = i == first ? p->next[i] : first;
        cut_off(p, i);
    }
    return p->triangle_count ? result : LR_POLYGON_FLATTENED;
}
