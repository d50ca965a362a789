#include "scene/bounds.h"

#include <math.h>

#include "scene/read.h"

lr_bounds lr_bounds_empty(void)
{
    return (lr_bounds){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
}

void lr_bounds_add_point(lr_bounds *bounds, lr_vec3 p)
{
    lr_vec3 *low = &bounds->min, *high = &bounds->max;
    *low = (lr_vec3){fmin(low->x, p.x), fmin(low->y, p.y), fmin(low->z, p.z)};
    *high = (lr_vec3){fmax(high->x, p.x), fmax(high->y, p.y), fmax(high->z, p.z)};
}

void lr_bounds_add(lr_bounds *bounds, const lr_bounds *by)
{
    lr_bounds_add_point(bounds, by->min);
    lr_bounds_add_point(bounds, by->max);
}

lr_bounds lr_bounds_transform(const lr_bounds *bounds, const lr_transform *transform)
{
    lr_bounds out = lr_bounds_empty();
    for (int i = 0; i < 8; i++) {
        lr_vec3 corner = {i & 1 ? bounds->max.x : bounds->min.x,
                          i & 2 ? bounds->max.y : bounds->min.y,
                          i & 4 ? bounds->max.z : bounds->min.z};
        lr_bounds_add_point(&out, lr_transform_point(transform, corner));
    }
    return out;
}

lr_bounds lr_mesh_bounds(const lr_mesh *mesh)
{
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        const float *p = &mesh->positions[3 * (size_t)i];
        for (int k = 0; k < 3; k++) {
            low[k] = p[k] < low[k] ? p[k] : low[k];
            high[k] = p[k] > high[k] ? p[k] : high[k];
        }
    }
    return (lr_bounds){{(double)low[0], (double)low[1], (double)low[2]},
                       {(double)high[0], (double)high[1], (double)high[2]}};
}

bool lr_bounds_usable(const lr_bounds *bounds)
{
    lr_vec3 low = bounds->min, high = bounds->max;
    return low.x >= -LR_COORDINATE_MAX && low.y >= -LR_COORDINATE_MAX &&
           low.z >= -LR_COORDINATE_MAX && high.x <= LR_COORDINATE_MAX &&
           high.y <= LR_COORDINATE_MAX && high.z <= LR_COORDINATE_MAX;
}

static bool all_within(const lr_transform *t, double limit)
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++)
            if (!(fabs(t->m[i][j]) <= limit))
                return false;
    return true;
}

bool lr_transform_usable(const lr_transform *t)
{
    lr_transform inverse;
    return all_within(t, LR_COORDINATE_MAX) && lr_transform_inverse(t, &inverse) &&
           all_within(&inverse, 1e36);
}
