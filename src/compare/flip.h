/* The parts of FLIP: see flip.c. */
#ifndef LR_COMPARE_FLIP_H
#define LR_COMPARE_FLIP_H

#include "compare/compare_internal.h"
#include "compare/filter.h"

/* The filters for one viewing distance. */
typedef struct flip_filters {
    filter_kernel lightness, red_green, blue_yellow[2]; /* contrast sensitivity */
    float blue_yellow_share[2];
    filter_kernel smooth, edge, point; /* feature detectors */
    uint32_t radius;                   /* the largest of all */
} flip_filters;

void flip_filters_create(flip_filters *filters, double ppd);

/* How samples become linear RGB within 0..1, one of three ways. */
typedef struct flip_light {
    const float *decoded; /* the linear value of each integer sample; NULL: ... */
    uint32_t maxval;
    bool linear; /* ... floats, tone-mapped after multiplication with scale, or sRGB-encoded */
    float scale;
} flip_light;

/* rgb[i] is a row of width floats. */
void flip_light_row(const flip_light *light, const compare_pair *pair, const float *samples,
                    float *const rgb[3]);

/* HDR-FLIP's exposures, in stops: count of them from first, step apart. */
typedef struct flip_exposures {
    double first, step;
    uint32_t count;
} flip_exposures;

lr_status flip_choose_exposures(const compare_pair *pair, flip_exposures *exposures,
                                lr_error *error);

#endif
