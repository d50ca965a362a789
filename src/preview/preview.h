/* `lavaray view`: a window that shows a scene, follows its file and lets hands move the camera. */
#ifndef LR_PREVIEW_PREVIEW_H
#define LR_PREVIEW_PREVIEW_H

#include <stdio.h>

#include "lavaray.h"

typedef struct lr_preview_options {
    const char *path; /* of the scene */
    lr_load_options load;
    lr_device_desc device;
    /* Size 0: the scene's, made smaller if the screen is. What is given here the scene's file does
     * not change later. */
    lr_render_options render;
    bool has_exposure;
    double exposure;           /* in stops */
    const char *screenshot;    /* name of screenshots; NULL: as the scene is called */
    bool (*interrupted)(void); /* asked some times a second; true closes the window */
    FILE *events;              /* NULL, or where tests read what happens */
    /* Text that is meant for the terminal: the camera's when it is asked for. */
    void (*print)(const char *text);
} lr_preview_options;

/* Opens the display, not yet a window: so a machine without one is told before the scene is read.
 * LR_ERROR_DEVICE names the reason. lr_preview_close undoes it. */
lr_status lr_preview_open(lr_error *error);
void lr_preview_close(void);

/* Shows the scene, which it takes over, until the window is closed. `files` are those that the
 * scene was read from. LR_ERROR_DEVICE when there is no device, or it fails again and again;
 * LR_ERROR_INTERRUPTED. */
lr_status lr_preview_run(lr_scene *scene, const lr_file_list *files,
                         const lr_preview_options *options, lr_error *error);

#endif
