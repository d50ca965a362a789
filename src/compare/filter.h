/* Separable filters on rows of floats. */
#ifndef LR_COMPARE_FILTER_H
#define LR_COMPARE_FILTER_H

#include <stdbool.h>
#include <stdint.h>

enum {
    FILTER_RADIUS_MAX = 160,
    FILTER_LANES = 16, /* rows are worked on in blocks of so many floats */
};

/* A kernel of 2 radius + 1 taps, w(-k) = w(k), or -w(k) when it is odd. */
typedef struct filter_kernel {
    uint32_t radius;
    bool odd;
    float w[FILTER_RADIUS_MAX + 1];
} filter_kernel;

/* The Gaussian exp(-x^2 / (2 sigma^2)) within the radius, with sum 1; cut where it is below 1e-6 of
 * its peak. Returns the sum before that. */
double filter_gaussian(filter_kernel *kernel, double sigma, uint32_t radius);

/* The width rounded up to whole blocks: what a row must have room for. */
uint32_t filter_row_size(uint32_t width);

/* Repeats the ends of the row at center over `radius` floats on the left and as many on the right
 * behind the last block: room for filter_row_size(width) + 2 radius floats begins at center -
 * radius. */
void filter_pad(float *center, uint32_t width, uint32_t radius);

/* Along a row that filter_pad made with this radius or a larger one; center points at its first
 * pixel. */
void filter_along(float *out, const float *center, uint32_t width, const filter_kernel *kernel);

/* Across rows: rows[radius] is the row in the middle. */
void filter_across(float *out, const float *const *middle, uint32_t width,
                   const filter_kernel *kernel);

/* A whole plane: rows of width floats without gaps into rows of filter_row_size(width), the edges
 * repeated. False when memory is out. */
bool filter_plane(float *out, const float *in, uint32_t width, uint32_t height,
                  const filter_kernel *kernel);

#endif
