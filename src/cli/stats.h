/* What there is to tell about a finished render. */
#ifndef LR_CLI_STATS_H
#define LR_CLI_STATS_H

#include "lavaray.h"

typedef struct render_record {
    const char *scene; /* paths as given */
    const char *output;
    const char *camera;     /* NULL: the scene's first */
    const char *scene_hash; /* SHA-256 of its text */
    uint32_t width, height; /* of what was written: the crop's, if there is one */
    double exposure;
    const char *tone;
    double white;            /* kelvin; 0: off */
    const lr_layers *layers; /* beside the picture; NULL, or none: only that */
    const char *denoiser;    /* NULL: not denoised */
    char denoised_hash[65];  /* of the picture then */
    double denoise_seconds;
    lr_device_info device;
    bool exact;
    lr_render_stats stats;
    double parse_seconds, device_seconds, write_seconds, total_seconds;
} render_record;

/* One line on stderr: what was written, where it was traced, and how fast. */
void print_record_line(const render_record *record);

/* Several lines on stderr. */
void print_record(const render_record *record);

/* What makes the picture less than it should be, on stderr. */
void print_record_warnings(const render_record *record);

/* The record as JSON to path, "-" for standard output. Returns an exit_code, having printed what
 * failed. */
int write_record(const render_record *record, const char *path);

#endif
