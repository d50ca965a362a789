/* From samples to the light that reaches the eye: decoding, and for HDR-FLIP exposures and tone
 * mapping. P. Andersson, J. Nilsson, P. Shirley, T. Akenine-Moller, "Visualizing Errors in Rendered
 * High Dynamic Range Images", Eurographics 2021. The tone mapper is Narkowicz' fit of ACES, with an
 * exposure of 0.6 built in. */
#include <stdlib.h>

#include "base/exact.h"
#include "base/memory.h"
#include "compare/approx.h"
#include "compare/flip.h"

/* (A x^2 + B x) / (C x^2 + D x + E) */
#define ACES_A (0.6f * 0.6f * 2.51f)
#define ACES_B (0.6f * 0.03f)
#define ACES_C (0.6f * 0.6f * 2.43f)
#define ACES_D (0.6f * 0.59f)
#define ACES_E 0.14f

#define LIGHT_MAX 1e15f /* its square is still a float */

static float tone_map(float x)
{
    float mapped = (ACES_A * x + ACES_B) * x / ((ACES_C * x + ACES_D) * x + ACES_E);
    return approx_min(mapped, 1);
}

static float decode(float encoded)
{
    float x = approx_min(approx_max(encoded, 0), 1);
    float power = approx_power((x + 0.055f) / 1.055f, 2.4f);
    return x <= 0.04045f ? x / 12.92f : power;
}

/* NaN and negative light are none. */
static float clean(float light)
{
    return approx_min(approx_max(light, 0), LIGHT_MAX);
}

void flip_light_row(const flip_light *light, const compare_pair *pair, const float *samples,
                    float *const rgb[3])
{
    uint32_t stride = pair->stride, width = pair->width;
    for (uint32_t c = 0; c < 3; c++) {
        const float *in = samples + (pair->colors == 3 ? c : 0);
        float *out = rgb[c];
        if (light->decoded)
            for (uint32_t x = 0; x < width; x++) {
                float value = approx_min(approx_max(in[x * stride], 0), 1);
                out[x] = light->decoded[(uint32_t)(value * (float)light->maxval + 0.5f)];
            }
        else if (light->linear)
            for (uint32_t x = 0; x < width; x++)
                out[x] = tone_map(clean(in[x * stride] * light->scale));
        else
            for (uint32_t x = 0; x < width; x++)
                out[x] = decode(in[x * stride]);
    }
}

lr_status flip_choose_exposures(const compare_pair *pair, flip_exposures *exposures,
                                lr_error *error)
{
    size_t count = (size_t)pair->width * pair->height;
    float *luminance = lr_alloc(count, sizeof *luminance);
    if (!luminance)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for FLIP's exposures");
    for (size_t i = 0; i < count; i++) {
        const float *p = pair->reference + i * pair->stride;
        size_t step = pair->colors == 3;
        luminance[i] =
            0.2126f * clean(p[0]) + 0.7152f * clean(p[step]) + 0.0722f * clean(p[2 * step]);
    }
    double brightest = compare_select(luminance, count, count - 1);
    double median = compare_select(luminance, count, count / 2);
    free(luminance);

    /* The exposed value that is mapped to 0.85: the larger root of a quadratic. */
    const double target = 0.85;
    double a = ACES_A - target * ACES_C, b = ACES_B - target * ACES_D, c = -target * ACES_E;
    double half = -0.5 * b / a;
    double white = half + __builtin_sqrt(half * half - c / a);
    const double least = 1.1920929e-7; /* keeps the logarithms finite */
    double last = lr_log2(white / (median > least ? median : least));
    exposures->first = lr_log2(white / (brightest > least ? brightest : least));
    double stops = last - exposures->first;
    uint32_t whole = (uint32_t)stops;
    whole += whole < stops;
    exposures->count = whole < 2 ? 2 : whole;
    exposures->step = stops / (exposures->count - 1);
    return LR_OK;
}
