/* Text and lines over the picture, drawn by cairo: light letters on dark, translucent panels, which
 * read well on any picture. */
#ifndef LR_PREVIEW_OVERLAY_H
#define LR_PREVIEW_OVERLAY_H

#include <stdbool.h>
#include <stdint.h>

typedef enum lr_panel_place {
    LR_PANEL_TOP_LEFT,
    LR_PANEL_BOTTOM_LEFT,
    LR_PANEL_CENTER,
} lr_panel_place;

typedef struct lr_panel {
    const char *text; /* UTF-8, lines end in \n; NULL or empty: no panel */
    lr_panel_place place;
    bool error; /* with a red edge */
    bool small; /* letters */
} lr_panel;

/* A piece of a ray, in pixels of the picture. */
typedef struct lr_overlay_line {
    double x0, y0, x1, y1;
    uint32_t color; /* 0xRRGGBB */
    bool arrow;     /* at its end */
} lr_overlay_line;

typedef struct lr_overlay {
    lr_panel panels[4];
    const lr_overlay_line *lines;
    uint32_t line_count;
    double scale; /* pixels a point */
} lr_overlay;

/* width * height pixels for lr_display_set_overlay, which the caller frees; NULL when there is
 * nothing to draw, or no memory. */
uint32_t *lr_overlay_draw(const lr_overlay *overlay, uint32_t width, uint32_t height);

#endif
