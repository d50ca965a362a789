#include "preview/overlay.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <cairo/cairo.h>

#include "base/memory.h"

/* In points. */
#define FONT_SIZE 13.0
#define FONT_SIZE_SMALL 10.0
#define FONT_SIZE_MIN 8.0
#define PADDING 10.0
#define MARGIN 12.0
#define CORNER 6.0

#define PANELS (sizeof((lr_overlay *)0)->panels / sizeof(lr_panel))
#define LINE_MAX_BYTES 1024

/* Copies the line that *text begins with and moves *text behind it; false at the end. */
static bool next_line(const char **text, char line[LINE_MAX_BYTES])
{
    if (!**text)
        return false;
    size_t length = strcspn(*text, "\n"), kept = length;
    if (kept >= LINE_MAX_BYTES) {
        kept = LINE_MAX_BYTES - 1;
        while (kept > 0 && ((*text)[kept] & 0xC0) == 0x80) /* not within a character */
            kept--;
    }
    memcpy(line, *text, kept);
    line[kept] = '\0';
    *text += length + ((*text)[length] == '\n');
    return true;
}

typedef struct extent {
    double width, height;
} extent;

static extent measure(cairo_t *cairo, const char *text, const cairo_font_extents_t *font)
{
    char line[LINE_MAX_BYTES];
    extent e = {0};
    while (next_line(&text, line)) {
        cairo_text_extents_t extents;
        cairo_text_extents(cairo, line, &extents);
        e.width = fmax(e.width, extents.x_advance);
        e.height += font->height;
    }
    return e;
}

static void rounded(cairo_t *cairo, double x, double y, double width, double height, double radius)
{
    cairo_new_sub_path(cairo);
    cairo_arc(cairo, x + width - radius, y + radius, radius, -M_PI / 2, 0);
    cairo_arc(cairo, x + width - radius, y + height - radius, radius, 0, M_PI / 2);
    cairo_arc(cairo, x + radius, y + height - radius, radius, M_PI / 2, M_PI);
    cairo_arc(cairo, x + radius, y + radius, radius, M_PI, 3 * M_PI / 2);
    cairo_close_path(cairo);
}

/* Letters of a size at which the text fits the picture's width, unless they would be too small. */
static void draw_panel(cairo_t *cairo, const lr_panel *panel, double scale, double width,
                       double height)
{
    double size = (panel->small ? FONT_SIZE_SMALL : FONT_SIZE) * scale,
           edge = (PADDING + MARGIN) * scale;
    cairo_font_extents_t font;
    extent text;
    for (;; size -= 1) {
        cairo_set_font_size(cairo, size);
        cairo_font_extents(cairo, &font);
        text = measure(cairo, panel->text, &font);
        bool fits = text.width + 2 * edge <= width && text.height + 2 * edge <= height;
        if (fits || size - 1 < FONT_SIZE_MIN * scale)
            break;
    }
    double wide = fmin(text.width + 2 * PADDING * scale, width - 2 * MARGIN * scale);
    double high = fmin(text.height + 2 * PADDING * scale, height - 2 * MARGIN * scale);
    if (wide <= 0 || high <= 0)
        return;
    double x = MARGIN * scale, y = MARGIN * scale;
    if (panel->place == LR_PANEL_CENTER) {
        x = floor((width - wide) / 2);
        y = floor((height - high) / 2);
    } else if (panel->place == LR_PANEL_BOTTOM_LEFT) {
        y = floor(height - high - MARGIN * scale);
    }
    rounded(cairo, x, y, wide, high, CORNER * scale);
    cairo_set_source_rgba(cairo, 0.05, 0.055, 0.07, 0.86);
    cairo_fill_preserve(cairo);
    if (panel->error)
        cairo_set_source_rgba(cairo, 0.95, 0.30, 0.25, 1);
    else
        cairo_set_source_rgba(cairo, 1, 1, 1, 0.25);
    cairo_set_line_width(cairo, (panel->error ? 1.5 : 1) * scale);
    cairo_stroke(cairo);

    cairo_save(cairo);
    cairo_rectangle(cairo, x, y, wide, high);
    cairo_clip(cairo);
    cairo_set_source_rgb(cairo, 0.96, 0.96, 0.96);
    char line[LINE_MAX_BYTES];
    const char *rest = panel->text;
    double baseline = y + PADDING * scale + font.ascent;
    while (next_line(&rest, line)) {
        cairo_move_to(cairo, x + PADDING * scale, floor(baseline));
        cairo_show_text(cairo, line);
        baseline += font.height;
    }
    cairo_restore(cairo);
}

static void trace_line(cairo_t *cairo, const lr_overlay_line *line, double scale)
{
    cairo_move_to(cairo, line->x0, line->y0);
    cairo_line_to(cairo, line->x1, line->y1);
    double length = hypot(line->x1 - line->x0, line->y1 - line->y0);
    if (!line->arrow || length < 4 * scale)
        return;
    double x = (line->x1 - line->x0) / length * 7 * scale;
    double y = (line->y1 - line->y0) / length * 7 * scale;
    cairo_move_to(cairo, line->x1 - x - 0.5 * y, line->y1 - y + 0.5 * x);
    cairo_line_to(cairo, line->x1, line->y1);
    cairo_line_to(cairo, line->x1 - x + 0.5 * y, line->y1 - y - 0.5 * x);
}

/* Each with a dark seam, to be seen on anything. */
static void draw_line(cairo_t *cairo, const lr_overlay_line *line, double scale)
{
    cairo_set_line_cap(cairo, CAIRO_LINE_CAP_ROUND);
    trace_line(cairo, line, scale);
    cairo_set_source_rgba(cairo, 0, 0, 0, 0.7);
    cairo_set_line_width(cairo, 4 * scale);
    cairo_stroke(cairo);
    trace_line(cairo, line, scale);
    cairo_set_source_rgb(cairo, (line->color >> 16 & 255) / 255.0, (line->color >> 8 & 255) / 255.0,
                         (line->color & 255) / 255.0);
    cairo_set_line_width(cairo, 1.8 * scale);
    cairo_stroke(cairo);
}

static bool has_panels(const lr_overlay *overlay)
{
    for (size_t i = 0; i < PANELS; i++)
        if (overlay->panels[i].text && overlay->panels[i].text[0])
            return true;
    return false;
}

uint32_t *lr_overlay_draw(const lr_overlay *overlay, uint32_t width, uint32_t height)
{
    if ((!has_panels(overlay) && overlay->line_count == 0) || width == 0 || height == 0 ||
        width > 32767 || height > 32767)
        return NULL;
    /* A pixel of cairo's is a 32-bit word on every machine, rows of them are not padded. */
    uint32_t *pixels = lr_alloc((size_t)width * height, sizeof *pixels);
    if (!pixels)
        return NULL;
    cairo_surface_t *surface = cairo_image_surface_create_for_data(
        (unsigned char *)pixels, CAIRO_FORMAT_ARGB32, (int)width, (int)height, (int)(4 * width));
    cairo_t *cairo = cairo_create(surface);
    cairo_select_font_face(cairo, "monospace", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    for (uint32_t i = 0; i < overlay->line_count; i++)
        draw_line(cairo, &overlay->lines[i], overlay->scale);
    for (size_t i = 0; i < PANELS; i++)
        if (overlay->panels[i].text && overlay->panels[i].text[0])
            draw_panel(cairo, &overlay->panels[i], overlay->scale, width, height);
    cairo_destroy(cairo);
    cairo_surface_flush(surface);
    cairo_surface_destroy(surface);
    return pixels;
}
