/* The window's own thread: what hands do becomes wishes, and news become a title and an overlay. */
#ifndef LR_PREVIEW_VIEW_H
#define LR_PREVIEW_VIEW_H

#include "preview/loader.h"
#include "preview/preview.h"
#include "preview/renderer.h"
#include "preview/window.h"

typedef struct lr_view {
    const lr_preview_options *options;
    lr_window window;
    lr_board board;
    lr_renderer renderer;
    lr_loader loader;
    lr_wish wish;                  /* a copy of the board's */
    bool wish_changed;             /* ... that is ahead of it */
    lr_camera *cameras;            /* the scene's */
    uint32_t camera_count, camera; /* and which of them this began with */
    double scene_size;             /* the diagonal of its bounds, 0: unknown */
    struct {
        uint32_t samples, depth, seed; /* samples 0: nothing */
        lr_integrator integrator;
        double exposure;
    } file; /* what the scene file says */
    uint64_t seen_scene, seen_saved, seen_focus, seen_report, seen_message;
    char *errors;
    lr_explained_pixel *explained; /* NULL: none is shown */
    uint64_t explained_picture;    /* wish.picture that it is a pixel of */
    char message[1200];
    double message_until, last_time;
    bool help, busy, overlay_changed;
    char title[512];
} lr_view;

/* Says something for a few seconds. */
void lr_view_say(lr_view *view, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* After a change of wish: another picture, or the same to be shown otherwise. */
void lr_view_wish_picture(lr_view *view);
void lr_view_wish_look(lr_view *view);

/* Has other kernels made for what is wished. */
void lr_view_build(lr_view *view);

/* Samples a pixel as options and scene say, or as suits the integrator. */
void lr_view_wish_samples(lr_view *view);

/* Has the pixel there explained, or the camera focus on what is seen there. */
void lr_view_explain(lr_view *view, double x, double y, bool focus);
void lr_view_forget_explained(lr_view *view);

/* keys.c: what a key does, and the help that names them all; the caller frees it. */
void lr_view_key(lr_view *view, uint32_t key);
char *lr_view_help(void);

#endif
