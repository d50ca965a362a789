/* Comparison of two pictures: how much they differ by any set of metrics, each with its own limit,
 * where, and why. Needs no device, keeps no state, and gives the same result on every machine.
 *
 * What is compared. Integer pictures are taken to be sRGB-encoded and float pictures to be linear.
 * All metrics but FLIP and the noise test work on the samples as they are stored, integers divided
 * by their maxval; so pictures of 8 and 16 bits compare. Of an integer and a float picture, the
 * float one is first encoded (clamped to 0..1, sRGB curve), not rounded. A grey picture compares
 * with an RGB one as three equal channels. A missing alpha channel is opaque, and alpha is compared
 * like a colour unless both are opaque everywhere; FLIP and SSIM look at the colours alone.
 * Samples that are not finite are equal to themselves and infinitely far from anything else.
 *
 * The metrics' names are at once the flags of `lavaray compare` and the keys of test cases. */
#ifndef LR_COMPARE_COMPARE_H
#define LR_COMPARE_COMPARE_H

#include "base/status.h"
#include "image/read.h"

/* The metrics that have a limit: id, name, what stands for the limit in help, help of at most 56
 * columns a line. A metric passes when its value is at most the limit; PSNR, SSIM and NOISE when it
 * is at least the limit. */
#define LR_LIMITS(X)                                                                               \
    X(ABS, "abs", "E",                                                                             \
      "no sample may differ by more than E; white is 1, and\n"                                     \
      "E may be a quotient such as 2/255")                                                         \
    X(REL, "rel", "E", "... by more than E times the larger of the two")                           \
    X(MAX_ABS, "max-abs", "E", "the same as --abs, whatever --abs-percent")                        \
    X(MAX_REL, "max-rel", "E", "the same as --rel, whatever --rel-percent")                        \
    X(MSE, "mse", "E", "mean squared error, at most E")                                            \
    X(RMSE, "rmse", "E", "its root")                                                               \
    X(RELMSE, "relmse", "E", "mean of squared error / (reference^2 + 0.01)")                       \
    X(PSNR, "psnr", "DB", "peak signal to noise ratio, at least DB decibels")                      \
    X(SSIM, "ssim", "S", "structural similarity of the luma, at least S")                          \
    X(FLIP_MEAN, "flip-mean", "E", "mean FLIP error, 0 to 1; HDR-FLIP of floats")                  \
    X(FLIP_P99, "flip-p99", "E", "the FLIP error that 99 % of the pixels stay within")             \
    X(FLIP_MAX, "flip-max", "E", "the largest FLIP error")                                         \
    X(NOISE, "noise", "P",                                                                         \
      "the difference must be explained by the pictures'\n"                                        \
      "noise; P is how often a false alarm is accepted, such\n"                                    \
      "as 0.01. Needs variances or halves")

#define LR_METRICS(X) X(EXACT, "exact", NULL, "no pixel may differ; the default") LR_LIMITS(X)

typedef enum lr_metric {
#define X(id, name, value, help) LR_METRIC_##id,
    LR_METRICS(X)
#undef X
        LR_METRIC_COUNT
} lr_metric;

/* "flip-mean" for LR_METRIC_FLIP_MEAN. */
const char *lr_metric_name(lr_metric metric);

/* Whether the value must be at least the limit, not at most. */
bool lr_metric_at_least(lr_metric metric);

typedef struct lr_rectangle {
    uint32_t x, y, width, height; /* pixels from the top left corner; may reach over the edges */
} lr_rectangle;

enum { LR_IGNORED_MAX = 64, LR_PPD_MAX = 1000 };

/* Zero means the default; nothing pointed to is copied or freed. */
typedef struct lr_compare_options {
    bool wanted[LR_METRIC_COUNT]; /* none: EXACT */
    double limits[LR_METRIC_COUNT];
    double abs_percent, rel_percent; /* of the compared pixels that may break ABS and REL, 0..100 */
    double ppd;                      /* pixels per degree of the viewer's eye, for FLIP; 0: 67 */
    const lr_image *mask; /* of the pictures' size: compare where its grey or RGB is half of white
                             or more; alpha is not looked at */
    lr_rectangle ignored[LR_IGNORED_MAX];
    uint32_t ignored_count;
    /* For NOISE: the variance of each pixel's mean (not of one sample), linear, for either or both
     * pictures; a picture without one is taken to be free of noise... */
    const lr_image *reference_variance, *test_variance;
    /* ... or an independent second picture of as many samples of each, which NOISE averages with
     * the first; both are needed. */
    const lr_image *reference_half, *test_half;
    bool map;     /* keep the map for lr_compare_heat_map */
    bool explain; /* find the cause and the regions when there are differences */
} lr_compare_options;

/* Sets a metric's limit, or "abs-percent", "rel-percent", "ppd", from text, as flags and test cases
 * give it. "exact" takes NULL, "true" or "false". LR_ERROR_ARGUMENT says what was expected, without
 * the name of a flag or file in front; an unknown name is one too. */
lr_status lr_compare_set(lr_compare_options *options, const char *name, const char *value,
                         lr_error *error);

typedef struct lr_metric_result {
    bool measured; /* false for all that were not wanted, and when the sizes differ */
    bool pass;
    double value, limit;
    /* EXACT, ABS, REL: the value is the percentage of compared pixels beyond the limit (EXACT:
     * differing at all), and it passes when it is within `allowed`; 0 for the other metrics. */
    double allowed;
    uint64_t pixels; /* EXACT, ABS, REL: how many that are */
} lr_metric_result;

/* Why the pictures differ. Found by experiment on the pictures; `confidence` is the share of the
 * squared difference that the cause explains. */
typedef enum lr_cause {
    LR_CAUSE_NONE,     /* no difference */
    LR_CAUSE_UNKNOWN,  /* differences that no other cause explains */
    LR_CAUSE_ALPHA,    /* the colours are the same */
    LR_CAUSE_SHIFT,    /* the whole picture moved by dx, dy */
    LR_CAUSE_MIRROR,   /* mirrored left to right, top to bottom, or both (half a turn) */
    LR_CAUSE_CHANNELS, /* red, green and blue changed places */
    LR_CAUSE_COLOR,    /* gain, offset or gamma per channel: exposure, tint, contrast, curve */
    LR_CAUSE_ROUNDING, /* everywhere, by a step or so of the coarser picture's integers */
    LR_CAUSE_NOISE,    /* uncorrelated differences all over */
    LR_CAUSE_BLUR,     /* blurred */
    LR_CAUSE_SHARPEN,
    LR_CAUSE_BLOCKS, /* jumps at every 8th pixel: JPEG or another block codec */
    LR_CAUSE_EDGES,  /* along the reference's edges alone: antialiasing, subpixel movement */
    LR_CAUSE_LOCAL,  /* in a few places, the rest is the same */
    LR_CAUSE_COUNT
} lr_cause;

/* "shift" for LR_CAUSE_SHIFT, as in the JSON. */
const char *lr_cause_name(lr_cause cause);

/* A set of differing pixels that touch, also by their corners. */
typedef struct lr_region {
    lr_rectangle box;
    uint64_t pixels;
    double center_x, center_y; /* the mean of its pixels' positions */
    uint32_t worst_x, worst_y; /* the pixel with the largest error */
    double worst, total;       /* that error, and the sum of the region's errors */
} lr_region;

enum { LR_REGIONS_MAX = 16 };

typedef struct lr_compare_result {
    bool pass;
    bool same_size; /* false: nothing was measured, and `pass` is false */
    uint32_t width, height, test_width, test_height;
    uint32_t channels;   /* compared: 1 grey, 2 grey + alpha, 3 RGB, 4 RGBA */
    bool converted;      /* an integer picture met a float one; the float one was encoded */
    uint64_t compared;   /* pixels, neither masked nor ignored */
    uint64_t non_finite; /* compared pixels with a NaN or infinity in either picture */
    lr_metric_result metrics[LR_METRIC_COUNT];

    /* The first differing pixel in reading order, when there is one: values as the files hold
     * them, integers of pictures whose maxval is not 0. */
    bool different;
    uint64_t different_pixels; /* whatever the metrics */
    uint32_t first_x, first_y;
    double first_reference[4], first_test[4];
    double max_difference; /* of all samples, and where */
    uint32_t max_x, max_y, max_channel;

    /* With explain. Regions are of the pixels that break a limit of single pixels (ABS, REL,
     * FLIP_P99, FLIP_MAX), without such limits of all that differ, and with NOISE of none; those
     * with the largest total first. */
    uint64_t region_count;
    uint32_t regions_kept;
    lr_region regions[LR_REGIONS_MAX];
    lr_cause cause;
    double confidence;                /* 0..1 */
    int32_t dx, dy;                   /* SHIFT: pixels, right and down; MIRROR: 1 for mirrored */
    double gain[3], offset[3], gamma; /* COLOR: test = gain * reference^gamma + offset */
    uint8_t order[3];                 /* CHANNELS: the test's channels are these of the reference */

    /* NOISE: the block (a pixel; 4, 16 or 64 pixels along its side; the picture) that the noise
     * explains the least, and by how many standard deviations its mean differs. */
    lr_rectangle noise_box;
    double noise_z;

    /* With map: width * height errors, -1 for pixels that are not compared. */
    float *map;
    const char *map_name; /* what they are: "FLIP", "difference", "|z|" */
} lr_compare_result;

/* Compares. LR_OK whatever the outcome, also when the sizes differ; LR_ERROR_ARGUMENT for a mask,
 * variance or half of another size than the pictures, for NOISE without them, when no pixel is left
 * to compare, and for options out of range; LR_ERROR_MEMORY. The caller frees the result. */
lr_status lr_compare(const lr_image *reference, const lr_image *test,
                     const lr_compare_options *options, lr_compare_result *result, lr_error *error);
void lr_compare_result_free(lr_compare_result *result);

/* One or two plain English sentences on what differs, without a newline, such as "The whole picture
 * moved by 1 pixel to the right." Empty when nothing does. */
void lr_compare_describe(const lr_compare_result *result, char *text, size_t size);

/* A picture of result->map: the reference, dimmed to grey, under the errors in colours, and below
 * it a scale with numbers when the picture is wide enough. Its sRGB-encoded form is meant to be
 * looked at; write it with lr_picture_write. The caller frees it. */
lr_status lr_compare_heat_map(const lr_image *reference, const lr_compare_result *result,
                              lr_picture *picture, lr_error *error);

/* The map itself as a picture, each error in all three channels. The caller frees it. */
lr_status lr_compare_error_map(const lr_compare_result *result, lr_picture *picture,
                               lr_error *error);

#endif
