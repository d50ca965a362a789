/* Colours as text: CSS names and hexadecimal sRGB, as linear RGB. */
#ifndef LR_SCENE_COLOR_H
#define LR_SCENE_COLOR_H

#include "scene/names.h"
#include "scene/scene.h"

bool lr_color_is_black(lr_color color);
bool lr_colors_equal(lr_color a, lr_color b);

/* Rec. 709, of linear light; of a grey its own value, to the last bit. */
double lr_color_luminance(lr_color color);

/* The linear value of an sRGB component 0..255, the same on every C library. */
double lr_srgb_to_linear(unsigned value);

/* Reads "#rgb", "#rrggbb" or a CSS name in any case; false when it is none of them. */
bool lr_color_from_text(const char *text, size_t length, lr_color *color);

/* Offers the CSS names to the search. */
void lr_color_offer_names(lr_nearest *nearest);

#endif
