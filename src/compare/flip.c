/* FLIP: P. Andersson, J. Nilsson, T. Akenine-Moller, M. Oskarsson, K. Astrom, M. Fairchild, "FLIP:
 * A Difference Evaluator for Alternating Images", HPG 2020; HDR-FLIP is the largest FLIP of a
 * series of exposures (see flip_light.c).
 *
 * Both pictures are filtered by the eye's contrast sensitivity in an opponent colour space and
 * compared in a perceptually uniform one; where edges and points differ too, the error is raised.
 * Every filter is separable, or a sum of two that are. The picture is worked on in bands of rows;
 * each keeps a ring of horizontally filtered rows, so that the vertical filters read from cache. */
#include "compare/flip.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/exact.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "compare/approx.h"

#define PI 3.14159265358979323846

enum { BAND_ROWS = 120 };

/* The planes of a picture after its horizontal filters. */
enum { LIGHTNESS, RED_GREEN, BLUE_YELLOW, BLUE_YELLOW_2, SMOOTH, EDGE, POINT, PLANES };

/* One picture's rows on their way through a band. */
typedef struct flip_rows {
    float *memory;
    float *rgb[3], *opponent[3]; /* padded: what was read last */
    float *ring[PLANES];
    float *lab[3], *edge, *point, *scratch; /* of the row that is made */
    uint32_t next;                          /* row to be read */
} flip_rows;

typedef struct flip_work {
    const compare_pair *pair;
    const flip_filters *filters;
    flip_light light;
    float max_color_error;
    float *map;
    _Atomic bool out_of_memory;
} flip_work;

/* Linear sRGB to XYZ, both relative to D65 white: each row sums to one. */
static const float rgb_to_xyz[3][3] = {{0.43389539f, 0.37624237f, 0.18986224f},
                                       {0.21263682f, 0.71518298f, 0.07218020f},
                                       {0.01775242f, 0.10946563f, 0.87278195f}};
static const float xyz_to_rgb[3][3] = {{3.08034199f, -1.53739897f, -0.54294302f},
                                       {-0.92117840f, 1.87592998f, 0.04524841f},
                                       {0.05288129f, -0.20401121f, 1.15112991f}};

/* exp(-pi^2 x^2 / b) at x degrees, as a standard deviation in pixels. */
static double sigma_of(double b, double ppd)
{
    return ppd * sqrt(b / 2) / PI;
}

static uint32_t radius_of(double sigma)
{
    double r = 3 * sigma;
    uint32_t whole = (uint32_t)r;
    return whole + (whole < r);
}

/* The feature detectors, section 4.2: derivatives of a Gaussian, positive and negative weights each
 * with a sum of one. */
static void create_features(flip_filters *f, double ppd)
{
    double sigma = 0.5 * 0.082 * ppd, positive = 0, negative = 0, slope = 0;
    uint32_t radius = radius_of(sigma);
    double point[FILTER_RADIUS_MAX + 1], edge[FILTER_RADIUS_MAX + 1];
    filter_gaussian(&f->smooth, sigma, radius);
    for (uint32_t k = 0; k <= radius; k++) {
        double g = lr_exp2(-0.72134752044448170 * k * k / (sigma * sigma));
        edge[k] = k * g;
        slope += edge[k];
        point[k] = (k * k / (sigma * sigma) - 1) * g;
        *(point[k] > 0 ? &positive : &negative) += k == 0 ? point[k] : 2 * point[k];
    }
    f->edge = (filter_kernel){.radius = radius, .odd = true};
    f->point = (filter_kernel){.radius = radius};
    for (uint32_t k = 0; k <= radius; k++) {
        f->edge.w[k] = (float)(edge[k] / slope);
        f->point.w[k] = (float)(point[k] / (point[k] > 0 ? positive : -negative));
    }
}

void flip_filters_create(flip_filters *f, double ppd)
{
    /* Table 1; the widest filter's radius is used for all. */
    uint32_t radius = radius_of(sigma_of(0.04, ppd));
    filter_gaussian(&f->lightness, sigma_of(0.0047, ppd), radius);
    filter_gaussian(&f->red_green, sigma_of(0.0053, ppd), radius);
    static const double a[2] = {34.1, 13.5}, b[2] = {0.04, 0.025};
    double share[2];
    for (int i = 0; i < 2; i++) {
        double sum = filter_gaussian(&f->blue_yellow[i], sigma_of(b[i], ppd), radius);
        share[i] = a[i] * sqrt(PI / b[i]) * sum * sum;
    }
    for (int i = 0; i < 2; i++)
        f->blue_yellow_share[i] = (float)(share[i] / (share[0] + share[1]));
    create_features(f, ppd);
    f->radius = radius > f->edge.radius ? radius : f->edge.radius;
}

static bool create_rows(flip_rows *rows, const flip_work *work)
{
    size_t size = filter_row_size(work->pair->width), radius = work->filters->radius;
    size_t ring = 2 * radius + 1;
    *rows = (flip_rows){0};
    rows->memory = lr_alloc((size * (9 + PLANES * ring) + 3 * (size + 2 * radius)), sizeof(float));
    if (!rows->memory)
        return false;
    float *next = rows->memory;
    for (int i = 0; i < 3; i++, next += size)
        rows->rgb[i] = next;
    for (int i = 0; i < 3; i++, next += size)
        rows->lab[i] = next;
    float **single[] = {&rows->edge, &rows->point, &rows->scratch};
    for (int i = 0; i < 3; i++, next += size)
        *single[i] = next;
    for (int i = 0; i < PLANES; i++, next += size * ring)
        rows->ring[i] = next;
    for (int i = 0; i < 3; i++, next += size + 2 * radius)
        rows->opponent[i] = next;
    return true;
}

static float *ring_row(const flip_rows *rows, const flip_work *work, int plane, uint32_t y)
{
    uint32_t slot = y % (2 * work->filters->radius + 1);
    return rows->ring[plane] + (size_t)slot * filter_row_size(work->pair->width);
}

/* Reads row y and filters it horizontally. */
static void read_row(flip_rows *rows, const flip_work *work, const float *picture, uint32_t y)
{
    const compare_pair *pair = work->pair;
    const flip_filters *f = work->filters;
    uint32_t width = pair->width, radius = f->radius;
    flip_light_row(&work->light, pair, picture + (size_t)y * width * pair->stride, rows->rgb);
    const float *r = rows->rgb[0], *g = rows->rgb[1], *b = rows->rgb[2];
    float *opponent[3];
    for (int i = 0; i < 3; i++)
        opponent[i] = rows->opponent[i] + radius;
    /* Y, X - Y and Y - Z are YCxCz but for factors and an offset, which filters leave alone. */
    for (uint32_t x = 0; x < width; x++) {
        float xyz[3];
        for (int i = 0; i < 3; i++)
            xyz[i] = rgb_to_xyz[i][0] * r[x] + rgb_to_xyz[i][1] * g[x] + rgb_to_xyz[i][2] * b[x];
        opponent[0][x] = xyz[1];
        opponent[1][x] = xyz[0] - xyz[1];
        opponent[2][x] = xyz[1] - xyz[2];
    }
    for (int i = 0; i < 3; i++)
        filter_pad(opponent[i], width, radius);

    const struct {
        int source;
        const filter_kernel *kernel;
    } filters[PLANES] = {
        [LIGHTNESS] = {0, &f->lightness},
        [RED_GREEN] = {1, &f->red_green},
        [BLUE_YELLOW] = {2, &f->blue_yellow[0]},
        [BLUE_YELLOW_2] = {2, &f->blue_yellow[1]},
        [SMOOTH] = {0, &f->smooth},
        [EDGE] = {0, &f->edge},
        [POINT] = {0, &f->point},
    };
    for (int i = 0; i < PLANES; i++)
        filter_along(ring_row(rows, work, i, y), opponent[filters[i].source], width,
                     filters[i].kernel);
}

/* Filters a plane vertically into out. */
static void across(const flip_rows *rows, const flip_work *work, int plane, uint32_t y,
                   const filter_kernel *kernel, float *out)
{
    const float *pointers[2 * FILTER_RADIUS_MAX + 1];
    int64_t last = (int64_t)work->pair->height - 1;
    int radius = (int)kernel->radius;
    for (int k = -radius; k <= radius; k++) {
        int64_t row = (int64_t)y + k;
        row = row < 0 ? 0 : row > last ? last : row;
        pointers[k + radius] = ring_row(rows, work, plane, (uint32_t)row);
    }
    filter_across(out, pointers + radius, work->pair->width, kernel);
}

/* The response of two detectors at right angles. */
static void find_features(const flip_rows *rows, const flip_work *work, int plane, uint32_t y,
                          const filter_kernel *kernel, float *out)
{
    across(rows, work, plane, y, &work->filters->smooth, out);
    across(rows, work, SMOOTH, y, kernel, rows->scratch);
    const float *other = rows->scratch;
    for (uint32_t x = 0; x < work->pair->width; x++)
        out[x] = sqrtf(out[x] * out[x] + other[x] * other[x]);
}

/* CIE 1976, for t >= 0. */
static inline float lab_curve(float t)
{
    const float delta = 6.0f / 29;
    float root = approx_cube_root(approx_max(t, 0.008f));
    float line = t * (1 / (3 * delta * delta)) + 4.0f / 29;
    return t > delta * delta * delta ? root : line;
}

/* L*a*b* with the Hunt effect: chroma counts by lightness. */
static inline void hunt_lab(const float rgb[3], float lab[3])
{
    float f[3];
    for (int i = 0; i < 3; i++)
        f[i] = lab_curve(rgb_to_xyz[i][0] * rgb[0] + rgb_to_xyz[i][1] * rgb[1] +
                         rgb_to_xyz[i][2] * rgb[2]);
    lab[0] = 116 * f[1] - 16;
    lab[1] = 0.01f * lab[0] * 500 * (f[0] - f[1]);
    lab[2] = 0.01f * lab[0] * 200 * (f[1] - f[2]);
}

static inline float hyab(const float a[3], const float b[3])
{
    float da = a[1] - b[1], db = a[2] - b[2];
    return fabsf(a[0] - b[0]) + sqrtf(da * da + db * db);
}

/* Everything about row y of one picture that the error needs. */
static void make_row(flip_rows *rows, const flip_work *work, uint32_t y)
{
    const flip_filters *f = work->filters;
    uint32_t width = work->pair->width;
    find_features(rows, work, EDGE, y, &f->edge, rows->edge);
    find_features(rows, work, POINT, y, &f->point, rows->point);
    across(rows, work, LIGHTNESS, y, &f->lightness, rows->lab[0]);
    across(rows, work, RED_GREEN, y, &f->red_green, rows->lab[1]);
    across(rows, work, BLUE_YELLOW, y, &f->blue_yellow[0], rows->lab[2]);
    across(rows, work, BLUE_YELLOW_2, y, &f->blue_yellow[1], rows->scratch);
    float *l = rows->lab[0], *a = rows->lab[1], *b = rows->lab[2];
    const float *second = rows->scratch;
    float share = f->blue_yellow_share[0], share_2 = f->blue_yellow_share[1];
    for (uint32_t x = 0; x < width; x++) {
        float blue_yellow = share * b[x] + share_2 * second[x];
        float xyz[3] = {l[x] + a[x], l[x], l[x] - blue_yellow}, rgb[3], lab[3];
        for (int i = 0; i < 3; i++) {
            float value =
                xyz_to_rgb[i][0] * xyz[0] + xyz_to_rgb[i][1] * xyz[1] + xyz_to_rgb[i][2] * xyz[2];
            rgb[i] = approx_min(approx_max(value, 0), 1);
        }
        hunt_lab(rgb, lab);
        l[x] = lab[0];
        a[x] = lab[1];
        b[x] = lab[2];
    }
}

/* Section 4.1.3: the error's lower 40 % fill 95 % of the scale. */
static inline float spread_error(float hyab_error, float max_error)
{
    const float knee = 0.4f * max_error, at_knee = 0.95f;
    float error = approx_power(hyab_error, 0.7f);
    float low = error * (at_knee / knee);
    float high = at_knee + (error - knee) * ((1 - at_knee) / (max_error - knee));
    return error < knee ? low : approx_min(high, 1);
}

/* The largest of this exposure's error and those before it. */
static void combine_row(const flip_rows *r, const flip_rows *t, const flip_work *work, float *out)
{
    float max_error = work->max_color_error;
    for (uint32_t x = 0; x < work->pair->width; x++) {
        float reference[3] = {r->lab[0][x], r->lab[1][x], r->lab[2][x]};
        float test[3] = {t->lab[0][x], t->lab[1][x], t->lab[2][x]};
        float color = spread_error(hyab(reference, test), max_error);
        float edge = fabsf(r->edge[x] - t->edge[x]), point = fabsf(r->point[x] - t->point[x]);
        float feature = sqrtf(approx_max(edge, point) * 0.70710678f);
        out[x] = approx_max(out[x], approx_power(color, 1 - approx_min(feature, 1)));
    }
}

static bool differs_near(const compare_pair *pair, uint32_t y, uint32_t radius)
{
    uint32_t first = y > radius ? y - radius : 0;
    for (uint32_t i = first; i < pair->height && i <= y + radius; i++)
        if (!compare_same_row(pair, i))
            return true;
    return false;
}

static void advance(flip_rows *rows, const flip_work *work, const float *picture, uint32_t y)
{
    uint32_t radius = work->filters->radius, first = y > radius ? y - radius : 0;
    rows->next = rows->next < first ? first : rows->next;
    for (; rows->next < work->pair->height && rows->next <= y + radius; rows->next++)
        read_row(rows, work, picture, rows->next);
    make_row(rows, work, y);
}

static void band(void *context, uint32_t part)
{
    flip_work *work = context;
    const compare_pair *pair = work->pair;
    uint32_t first = part * BAND_ROWS, end = first + BAND_ROWS;
    flip_rows reference = {0}, test = {0};
    if (!create_rows(&reference, work) || !create_rows(&test, work)) {
        work->out_of_memory = true;
        goto done;
    }
    for (uint32_t y = first; y < pair->height && y < end; y++) {
        if (!differs_near(pair, y, work->filters->radius))
            continue; /* the error is 0 */
        advance(&reference, work, pair->reference, y);
        advance(&test, work, pair->test, y);
        combine_row(&reference, &test, work, work->map + (size_t)y * pair->width);
    }
done:
    free(reference.memory);
    free(test.memory);
}

/* The linear values of all integer samples. */
static float *decode_all(uint32_t maxval)
{
    float *table = lr_alloc((size_t)maxval + 1, sizeof *table);
    for (uint32_t i = 0; table && i <= maxval; i++) {
        double x = (double)i / maxval;
        table[i] = (float)(x <= 0.04045 ? x / 12.92 : lr_exp2(2.4 * lr_log2((x + 0.055) / 1.055)));
    }
    return table;
}

lr_status compare_flip(const compare_pair *pair, double ppd, float *map, lr_error *error)
{
    flip_filters filters;
    flip_filters_create(&filters, ppd);
    flip_work work = {.pair = pair, .filters = &filters, .map = map};
    work.light = (flip_light){.maxval = pair->maxval, .linear = pair->linear, .scale = 1};
    const float green[3] = {0, 1, 0}, blue[3] = {0, 0, 1};
    float green_lab[3], blue_lab[3];
    hunt_lab(green, green_lab);
    hunt_lab(blue, blue_lab);
    work.max_color_error = approx_power(hyab(green_lab, blue_lab), 0.7f);
    memset(map, 0, (size_t)pair->width * pair->height * sizeof *map);

    flip_exposures exposures = {.count = 1};
    float *decoded = NULL;
    lr_status status = LR_OK;
    if (pair->linear)
        status = flip_choose_exposures(pair, &exposures, error);
    else if (pair->maxval && !(work.light.decoded = decoded = decode_all(pair->maxval)))
        work.out_of_memory = true;
    for (uint32_t i = 0; i < exposures.count && status == LR_OK && !work.out_of_memory; i++) {
        if (pair->linear)
            work.light.scale = (float)lr_exp2(exposures.first + i * exposures.step);
        lr_run_parallel((pair->height + BAND_ROWS - 1) / BAND_ROWS, band, &work);
    }
    free(decoded);
    if (status == LR_OK && work.out_of_memory)
        status = lr_fail(error, LR_ERROR_MEMORY, "out of memory for FLIP");
    return status;
}
