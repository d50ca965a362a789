/* Any floats are boxes of a sound hierarchy or refused. */
#include <stdlib.h>
#include <string.h>

#include "bvh_check.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static bool count_test(void *context, uint32_t primitive, double *t_max)
{
    (void)primitive, (void)t_max;
    ++*(uint32_t *)context;
    return true;
}

/* The first byte chooses the options and whether upside-down boxes are turned over, the second how
 * often the boxes are there. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size < 2)
        return 0;
    lr_bvh_options options = {.leaf_size = 1 + data[0] % LR_BVH_MAX_LEAF, .threads = data[0] / 128};
    uint32_t distinct = (uint32_t)((size - 2) / sizeof(lr_bvh_box)),
             count = distinct * (1 + data[1]);
    lr_bvh_box *boxes = calloc(count + 1, sizeof *boxes);
    if (!boxes)
        return 0;
    bool good = true;
    for (uint32_t i = 0; i < count; i++) {
        memcpy(&boxes[i], data + 2 + i % distinct * sizeof *boxes, sizeof *boxes);
        for (int k = 0; k < 3; k++) {
            float min = boxes[i].min[k], max = boxes[i].max[k];
            if (data[0] & 64 && min > max) {
                boxes[i].min[k] = max;
                boxes[i].max[k] = min;
            }
            good &= isfinite(min) && isfinite(max) && boxes[i].min[k] <= boxes[i].max[k];
        }
    }
    lr_bvh *bvh;
    if ((lr_bvh_create(boxes, count, &options, &bvh, NULL) == LR_OK) != good)
        abort();
    if (bvh) {
        if (bvh_problem(bvh, boxes, count, options.leaf_size))
            abort();
        lr_bvh_ray ray = {{0, 0, 0}, {1, -2, 0}, 0, 1e300};
        uint32_t tests = 0;
        lr_bvh_trace(bvh, &ray, count_test, &tests);
        if (tests > count)
            abort();
        lr_bvh_cost(bvh, 0);
    }
    lr_bvh_destroy(bvh);
    free(boxes);
    return 0;
}
