#include "image/image.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

static uint32_t float_bits(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static float bits_float(uint32_t bits)
{
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* x^(1/5) for 0.05 <= x <= 1. The start is the tangent at 1, which lies above the root, and from
 * there Newton's steps fall towards it; eight of them reach the last bit. */
static double fifth_root(double x)
{
    double root = (4 + x) / 5;
    for (int i = 0; i < 8; i++) {
        double square = root * root;
        root -= (root - x / (square * square)) / 5;
    }
    return root;
}

/* The linear value of an encoded one, 0..1 (IEC 61966-2-1). */
static double srgb_inverse(double encoded)
{
    if (encoded <= 0.04045)
        return encoded / 12.92;
    double base = (encoded + 0.055) / 1.055;
    double root = fifth_root(base);
    return base * base * (root * root); /* base^2.4 */
}

/* The smallest positive float that is not below x. */
static float round_up(double x)
{
    float rounded = (float)x;
    return (double)rounded < x ? bits_float(float_bits(rounded) + 1) : rounded;
}

/* The smallest float whose product with maxval rounds to i + 1 or more. The products are exact: a
 * float has 24 bits, and 2 maxval has 17. */
static float linear_threshold(uint32_t i, uint32_t maxval)
{
    double wanted = 2.0 * i + 1, scale = 2.0 * maxval;
    float nearest = (float)(wanted / scale);
    return nearest * scale < wanted ? bits_float(float_bits(nearest) + 1) : nearest;
}

lr_status lr_curve_create(lr_curve *curve, lr_transfer transfer, uint32_t maxval, lr_error *error)
{
    *curve = (lr_curve){0};
    if (maxval < 1 || maxval > 65535)
        return lr_fail(error, LR_ERROR_ARGUMENT, "maxval is %u; expected 1 to 65535", maxval);
    if (transfer != LR_TRANSFER_SRGB && transfer != LR_TRANSFER_LINEAR)
        return lr_fail(error, LR_ERROR_ARGUMENT, "unknown transfer curve %d", (int)transfer);
    curve->maxval = maxval;
    curve->thresholds = lr_alloc(maxval, sizeof *curve->thresholds);
    if (!curve->thresholds)
        goto out_of_memory;
    for (uint32_t i = 0; i < maxval; i++)
        curve->thresholds[i] = transfer == LR_TRANSFER_LINEAR
                                   ? linear_threshold(i, maxval)
                                   : round_up(srgb_inverse((i + 0.5) / maxval));

    /* Buckets are 2^-8 of an octave wide, or 2^-12 where thresholds are dense, so that few steps
     * are left to do. */
    curve->shift = maxval < 256 ? 15 : 11;
    curve->first = float_bits(curve->thresholds[0]) >> curve->shift;
    uint32_t last = float_bits(curve->thresholds[maxval - 1]) >> curve->shift;
    curve->starts = lr_alloc(last - curve->first + 1, sizeof *curve->starts);
    if (!curve->starts)
        goto out_of_memory;
    uint32_t value = 0;
    for (uint32_t bucket = curve->first; bucket <= last; bucket++) {
        float lowest = bits_float(bucket << curve->shift);
        while (value < maxval && lowest >= curve->thresholds[value])
            value++;
        curve->starts[bucket - curve->first] = (uint16_t)value;
    }
    return LR_OK;

out_of_memory:
    lr_curve_free(curve);
    return lr_fail(error, LR_ERROR_MEMORY, "out of memory for a transfer curve");
}

void lr_curve_free(lr_curve *curve)
{
    if (!curve)
        return;
    free(curve->thresholds);
    free(curve->starts);
    *curve = (lr_curve){0};
}

uint32_t lr_curve_encode(const lr_curve *curve, float linear)
{
    if (!(linear >= curve->thresholds[0])) /* also NaN */
        return 0;
    if (linear >= curve->thresholds[curve->maxval - 1])
        return curve->maxval;
    uint32_t value = curve->starts[(float_bits(linear) >> curve->shift) - curve->first];
    while (linear >= curve->thresholds[value])
        value++;
    return value;
}
