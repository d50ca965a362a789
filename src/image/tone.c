/* Tone maps: any light to what a screen can show, 0 to 1, still linear. */
#include "image/tone.h"

#include <stdlib.h>

#include "base/exact.h"
#include "base/memory.h"

#define LIGHT_MAX 1e30
/* Steps of AgX's tables along a length of 1, as in the tables that come with it. Between them they
 * are within 1e-7 of their functions. */
#define STEPS 4096
#define POWER_MAX 2 /* the base; AgX's are below 1.26 */

#define MATRIX(...)                                                                                \
    {                                                                                              \
        {                                                                                          \
            __VA_ARGS__                                                                            \
        }                                                                                          \
    }
#define ROW(a, b, c)                                                                               \
    {                                                                                              \
        (a), (b), (c), 0                                                                           \
    }

static const char *const names[] = {"none", "reinhard", "aces", "agx"};

const char *lr_tone_name(lr_tone tone)
{
    return (size_t)tone < sizeof names / sizeof *names ? names[tone] : NULL;
}

/* ---- Reinhard ------------------------------------------------------------------------------ */

/* Reinhard et al., "Photographic Tone Reproduction for Digital Images" (2002), equation 4, for each
 * channel by itself, so that nothing but light above the white point is clipped. */
static double reinhard(double x)
{
    const double white = 4;
    return x * (1 + x / (white * white)) / (1 + x);
}

/* ---- ACES ---------------------------------------------------------------------------------- */

/* Stephen Hill's fit of the reference rendering and sRGB output transforms of ACES 1.0, in the
 * primaries that it was made for: BakingLab, 2016. */
static double aces_curve(double x)
{
    return (x * (x + 0.0245786) - 0.000090537) / (x * (0.983729 * x + 0.4329510) + 0.238081);
}

static lr_vec3 aces(lr_vec3 light)
{
    static const lr_transform in =
        MATRIX(ROW(0.59719, 0.35458, 0.04823), ROW(0.07600, 0.90834, 0.01566),
               ROW(0.02840, 0.13383, 0.83777));
    static const lr_transform out =
        MATRIX(ROW(1.60475, -0.53108, -0.07367), ROW(-0.10208, 1.10813, -0.00605),
               ROW(-0.00327, -0.07276, 1.07602));
    lr_vec3 v = lr_transform_vector(&in, light);
    return lr_transform_vector(&out, (lr_vec3){aces_curve(v.x), aces_curve(v.y), aces_curve(v.z)});
}

/* ---- AgX ----------------------------------------------------------------------------------- */

/* Troy Sobotka's AgX with the primaries of Blender 4 (Eary Chow's AgX_LUT_Gen), as in Filament and
 * three.js: light in Rec. 2020 is drawn towards grey, 16.5 stops of it go through a sigmoid, and
 * the result is drawn back. */
static const lr_transform agx_inset =
    MATRIX(ROW(0.856627153315983, 0.0951212405381588, 0.0482516061458583),
           ROW(0.137318972929847, 0.761241990602591, 0.101439036467562),
           ROW(0.11189821299995, 0.0767994186031903, 0.811302368396859));
static const lr_transform agx_outset =
    MATRIX(ROW(1.1271005818144368, -0.11060664309660323, -0.016493938717834573),
           ROW(-0.1413297634984383, 1.157823702216272, -0.016493938717834257),
           ROW(-0.14132976349843826, -0.11060664309660294, 1.2519364065950405));
/* From sRGB primaries: ITU-R BT.2087. */
static const lr_transform to_rec2020 =
    MATRIX(ROW(0.6274, 0.3293, 0.0433), ROW(0.0691, 0.9195, 0.0114), ROW(0.0164, 0.0880, 0.8956));

#define STOPS_BELOW 10.0 /* middle grey, 0.18 */
#define STOPS_ABOVE 6.5
#define LOG2_GREY -2.4739311883324123

static double power(double base, double exponent)
{
    return base > 0 ? lr_exp2(exponent * lr_log2(base)) : 0;
}

/* Sobotka's and Jed Smith's sigmoid through (0, 0), (1, 1) and the grey in the middle, where it is
 * 1/2 and has slope 2; the powers are those of AgX's toe and shoulder. */
static double agx_sigmoid(double x)
{
    const double grey = STOPS_BELOW / (STOPS_BELOW + STOPS_ABOVE);
    bool toe = x < grey;
    double side = toe ? grey : 1 - grey, exponent = toe ? 3 : 3.25;
    double rise = 2 * (toe ? grey - x : x - grey);
    double bend = power(rise, exponent) * (power(2, exponent) - power(2 * side, -exponent));
    double value = rise * power(1 + bend, -1 / exponent);
    return 0.5 + (toe ? -value : value);
}

static double look_up(const double *table, double x)
{
    int step = (int)(x * STEPS);
    double part = x * STEPS - step;
    return table[step] + part * (table[step + 1] - table[step]);
}

static double agx_shade(const image_tone *tone, double light)
{
    if (!(light > 1e-10))
        return 0;
    double x = (lr_log2(light) - LOG2_GREY + STOPS_BELOW) / (STOPS_BELOW + STOPS_ABOVE);
    return look_up(tone->sigmoid, x < 0 ? 0 : x > 1 ? 1 : x);
}

/* The sigmoid's values are for a screen of gamma 2.2. */
static double agx_light(const image_tone *tone, double shade)
{
    return look_up(tone->power, shade < 0 ? 0 : shade);
}

static lr_vec3 agx(const image_tone *tone, lr_vec3 light)
{
    lr_vec3 v = lr_transform_vector(&tone->in, light);
    v = (lr_vec3){agx_shade(tone, v.x), agx_shade(tone, v.y), agx_shade(tone, v.z)};
    v = lr_transform_vector(&agx_outset, v);
    v = (lr_vec3){agx_light(tone, v.x), agx_light(tone, v.y), agx_light(tone, v.z)};
    return lr_transform_vector(&tone->out, v);
}

static bool create_agx(image_tone *tone)
{
    tone->in = lr_transform_multiply(agx_inset, to_rec2020);
    lr_transform_inverse(&to_rec2020, &tone->out);
    tone->sigmoid = lr_alloc(STEPS + 2, sizeof(double));
    tone->power = lr_alloc(POWER_MAX * STEPS + 2, sizeof(double));
    if (!tone->sigmoid || !tone->power)
        return false;
    for (int i = 0; i <= STEPS + 1; i++)
        tone->sigmoid[i] = agx_sigmoid(i < STEPS ? (double)i / STEPS : 1);
    for (int i = 0; i <= POWER_MAX * STEPS + 1; i++)
        tone->power[i] = power((double)i / STEPS, 2.2);
    return true;
}

/* -------------------------------------------------------------------------------------------- */

lr_status image_tone_create(image_tone *tone, lr_tone kind, lr_error *error)
{
    *tone = (image_tone){.kind = kind};
    if (!lr_tone_name(kind))
        return lr_fail(error, LR_ERROR_ARGUMENT, "unknown tone map %d", (int)kind);
    if (kind == LR_TONE_AGX && !create_agx(tone)) {
        image_tone_free(tone);
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for a tone map");
    }
    return LR_OK;
}

void image_tone_free(image_tone *tone)
{
    free(tone->sigmoid);
    free(tone->power);
    *tone = (image_tone){0};
}

static double clamp_light(double x)
{
    return !(x > 0) ? 0 : x < LIGHT_MAX ? x : LIGHT_MAX;
}

lr_vec3 image_tone_apply(const image_tone *tone, lr_vec3 light)
{
    lr_vec3 v = {clamp_light(light.x), clamp_light(light.y), clamp_light(light.z)};
    switch (tone->kind) {
    case LR_TONE_REINHARD:
        return (lr_vec3){reinhard(v.x), reinhard(v.y), reinhard(v.z)};
    case LR_TONE_ACES:
        return aces(v);
    case LR_TONE_AGX:
        return agx(tone, v);
    default:
        return light;
    }
}
