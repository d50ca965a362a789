/* A change of colour that is the same everywhere: test = gain * reference^gamma + offset, with gain
 * and offset of each channel's own, clipped to 0..1 in integer pictures. */
#include <math.h>
#include <stdlib.h>

#include "base/exact.h"
#include "base/memory.h"
#include "compare/cause.h"

#define ENOUGH 0.9 /* the share of the squared difference that must be explained */

enum { BINS = 4096 };

/* The pixels whose reference sample has about the same value. */
typedef struct bin {
    double count, reference, test, test_square;
    double open, open_test; /* of those whose test sample is not at the end of the range */
} bin;

typedef struct fit {
    double gamma, gain, offset, rest;
} fit;

/* Integer samples by value; light by its logarithm, from 2^-32 up, 64 bins to the doubling. */
static uint32_t bin_of(const compare_pair *pair, double value)
{
    if (!pair->linear)
        return (uint32_t)((value < 0 ? 0 : value > 1 ? 1 : value) * (BINS - 1) + 0.5);
    double place = value > 0 ? (lr_log2(value) + 32) * 64 : 0;
    return (uint32_t)fmin(fmax(place, 0), BINS - 1);
}

static void fill(const compare_pair *pair, uint32_t channel, bin *bins)
{
    size_t count = (size_t)pair->width * pair->height;
    for (size_t i = 0; i < count; i++) {
        double r = (double)pair->reference[i * pair->stride + channel];
        double t = (double)pair->test[i * pair->stride + channel];
        if (!compare_is_used(pair, i) || !(fabs(r) < 1e18 && fabs(t) < 1e18))
            continue;
        bin *b = &bins[bin_of(pair, r)];
        b->count++;
        b->reference += r;
        b->test += t;
        b->test_square += t * t;
        if (pair->linear || (t > 0.002 && t < 0.998)) {
            b->open++;
            b->open_test += t;
        }
    }
}

static double power(double x, double p)
{
    return x > 0 ? p == 1 ? x : lr_exp2(fmax(p * lr_log2(x), -900)) : 0;
}

/* The squared difference that a fit leaves. */
static double rest_of(const compare_pair *pair, const bin *bins, const fit *f)
{
    double rest = 0;
    for (uint32_t i = 0; i < BINS; i++) {
        if (bins[i].count == 0)
            continue;
        double value = f->gain * power(bins[i].reference / bins[i].count, f->gamma) + f->offset;
        if (!pair->linear)
            value = fmin(fmax(value, 0), 1);
        rest += bins[i].test_square - 2 * value * bins[i].test + bins[i].count * value * value;
    }
    return fmax(rest, 0);
}

/* Linear least squares for one gamma; with_offset false keeps the offset 0. */
static fit fit_line(const compare_pair *pair, const bin *bins, double gamma, bool with_offset)
{
    double n = 0, x = 0, xx = 0, y = 0, xy = 0;
    for (uint32_t i = 0; i < BINS; i++) {
        if (bins[i].open == 0)
            continue;
        double v = power(bins[i].reference / bins[i].count, gamma);
        n += bins[i].open;
        x += bins[i].open * v;
        xx += bins[i].open * v * v;
        y += bins[i].open_test;
        xy += bins[i].open_test * v;
    }
    fit f = {.gamma = gamma, .gain = 1};
    double determinant = n * xx - x * x;
    if (with_offset && determinant > 1e-9 * n * xx) {
        f.gain = (n * xy - x * y) / determinant;
        f.offset = (y - f.gain * x) / n;
    } else if (xx > 0) {
        f.gain = xy / xx;
    }
    f.rest = rest_of(pair, bins, &f);
    return f;
}

typedef struct fits {
    fit channel[3];
    double rest;
} fits;

static fits fit_all(const compare_pair *pair, const bin *bins, double gamma, bool with_offset)
{
    fits all = {0};
    for (uint32_t c = 0; c < pair->colors; c++) {
        all.channel[c] = fit_line(pair, bins + (size_t)c * BINS, gamma, with_offset);
        all.rest += all.channel[c].rest;
    }
    return all;
}

/* The best gamma from 1/4 to 4: on a coarse grid, then between its neighbours. */
static fits fit_gamma(const compare_pair *pair, const bin *bins, bool with_offset)
{
    double center = 0, step = 0.25;
    fits best = fit_all(pair, bins, 1, with_offset);
    for (int i = -8; i <= 8; i++) {
        fits here = fit_all(pair, bins, lr_exp2(i * step), with_offset);
        if (here.rest < best.rest) {
            best = here;
            center = i * step;
        }
    }
    for (step /= 2; step > 0.002; step /= 2)
        for (int side = -1; side <= 1; side += 2) {
            fits here = fit_all(pair, bins, lr_exp2(center + side * step), with_offset);
            if (here.rest < best.rest) {
                best = here;
                center += side * step;
                break;
            }
        }
    return best;
}

bool cause_is_color(const cause_view *view, lr_compare_result *result, bool *out_of_memory)
{
    const compare_pair *pair = view->pair;
    bin *bins = lr_alloc((size_t)BINS * 3, sizeof *bins);
    if (!bins) {
        *out_of_memory = true;
        return false;
    }
    double energy = 0;
    for (uint32_t c = 0; c < pair->colors; c++) {
        fill(pair, c, bins + (size_t)c * BINS);
        fit same = {.gamma = 1, .gain = 1};
        energy += rest_of(pair, bins + (size_t)c * BINS, &same);
    }
    /* The simplest that does: gain; gain and offset; gain and gamma; all three. */
    fits best = fit_all(pair, bins, 1, false);
    for (int i = 1; i < 4; i++) {
        fits here = i == 1 ? fit_all(pair, bins, 1, true) : fit_gamma(pair, bins, i == 3);
        if (here.rest < 0.5 * best.rest && best.rest > 0.01 * energy)
            best = here;
    }
    free(bins);
    double share = energy > 0 ? 1 - best.rest / energy : 0;
    if (!(share >= ENOUGH))
        return false;
    for (uint32_t c = 0; c < 3; c++) {
        const fit *f = &best.channel[c < pair->colors ? c : 0];
        result->gain[c] = f->gain;
        result->offset[c] = f->offset;
        result->gamma = f->gamma;
    }
    return cause_found(result, LR_CAUSE_COLOR, share);
}
