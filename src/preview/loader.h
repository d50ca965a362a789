/* The loader's thread: follows the scene's files, reads them again when they change, makes sessions
 * of scenes and devices, and does what else would keep the window waiting: saving the camera and
 * writing screenshots. */
#ifndef LR_PREVIEW_LOADER_H
#define LR_PREVIEW_LOADER_H

#include "preview/board.h"
#include "preview/explained.h"
#include "preview/follow.h"

/* What the loader is asked for; under the board's lock. */
typedef struct lr_jobs {
    bool quit, load, build, next_device, save;
    uint32_t save_index; /* of the scene's cameras */
    lr_camera save_camera;
    bool explain, focus; /* tell what is at the pixel, or look where it is */
    uint32_t explain_x, explain_y;
} lr_jobs;

/* What the loader has to tell; under the board's lock. */
typedef struct lr_news {
    uint64_t scene;     /* grows with every scene that was read */
    lr_camera *cameras; /* the scene's; names are owned too */
    uint32_t camera_count;
    uint32_t samples, depth, seed;
    lr_integrator integrator;
    double exposure;
    double size;    /* of the scene: the diagonal of its bounds, 0 where there are none */
    uint64_t saved; /* grows with every camera that was saved: number saved_index is now */
    uint32_t saved_index;
    lr_camera saved_camera;
    uint64_t focus; /* grows with every point to focus on */
    lr_vec3 focus_point;
    lr_explained_pixel *explained; /* to be taken by the window; NULL: nothing new */
    uint64_t report;               /* grows with every change of */
    char *errors;                  /* what is wrong with the file; NULL: nothing */
    uint64_t message;              /* grows with every new */
    char text[1200];
    bool busy;  /* another scene or device is being made ready */
    bool fatal; /* there is no way to go on: `failure` tells why */
    lr_error failure;
} lr_news;

typedef struct lr_loader {
    lr_board *board;
    const lr_window_system *window;
    const char *path, *screenshot; /* the latter: a name for them, or NULL */
    lr_load_options load;
    lr_device_desc device;
    char device_name[16]; /* that device.select may point at */
    pthread_t thread;
    int wake; /* an eventfd */
    lr_jobs jobs;
    lr_news news;
    lr_shared_scene *scene; /* the latest that is valid */
    char sha256[65];        /* of the text that it was read from, or saved to */
    lr_follow *follow;
    lr_device *explainer; /* the device that pixels are explained on, once one was */
    lr_trees trees;       /* of the scene's geometry */
} lr_loader;

/* Begins with a scene that is loaded already, and takes it over; `files` are its. Also reads it
 * again when they change. */
lr_status lr_loader_start(lr_loader *loader, lr_scene *scene, const lr_file_list *files,
                          lr_error *error);
void lr_loader_stop(lr_loader *loader);

/* After a change of the jobs. */
void lr_loader_wake(lr_loader *loader);

#endif
