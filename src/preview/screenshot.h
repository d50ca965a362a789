/* Pictures of the window's film in files that do not replace others. */
#ifndef LR_PREVIEW_SCREENSHOT_H
#define LR_PREVIEW_SCREENSHOT_H

#include "lavaray.h"

#define LR_SCREENSHOT_NAME 4096

typedef struct lr_screenshot {
    const char *name; /* as asked for, with the ending of a format; or NULL: as the scene's file, */
    const char *scene_path;   /* but .png, and where the program runs */
    const char *scene_sha256; /* of the scene's text */
    double exposure;          /* stops */
} lr_screenshot;

/* Writes the picture to NAME.png or, if there is such a file, NAME-1.png, NAME-2.png, ...; which
 * one is left in name[]. LR_ERROR_FILE leaves no file behind. */
lr_status lr_screenshot_write(const lr_screenshot *shot, const lr_picture *picture,
                              char name[LR_SCREENSHOT_NAME], lr_error *error);

#endif
