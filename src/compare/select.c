#include <string.h>

#include "compare/compare_internal.h"

static uint32_t bits_of(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

/* Floats that are not negative are in the order of their bits: one histogram finds the upper half
 * of the answer's bits, a second one the lower. */
float compare_select(const float *values, size_t count, size_t rank)
{
    enum { BINS = 1 << 16 };
    uint64_t histogram[BINS]; /* half a megabyte of stack */
    uint32_t answer = 0;
    for (int half = 0; half < 2; half++) {
        memset(histogram, 0, sizeof histogram);
        for (size_t i = 0; i < count; i++) {
            uint32_t bits = bits_of(values[i]);
            if (half == 0)
                histogram[bits >> 16]++;
            else if (bits >> 16 == answer)
                histogram[bits & 0xffff]++;
        }
        uint32_t bin = 0;
        while (bin < BINS - 1 && rank >= histogram[bin])
            rank -= histogram[bin++];
        answer = half == 0 ? bin : answer << 16 | bin;
    }
    float value;
    memcpy(&value, &answer, sizeof value);
    return value;
}
