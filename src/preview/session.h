/* A scene on a device, ready to be shown in the window. Another scene or device means another
 * session, which is made while the old one is still being shown. One thread at a time. */
#ifndef LR_PREVIEW_SESSION_H
#define LR_PREVIEW_SESSION_H

#include <stdatomic.h>

#include "gpu/swapchain.h"
#include "render/progressive.h"
#include "render/settings.h"

/* A scene that several sessions show. */
typedef struct lr_shared_scene {
    lr_scene *scene;
    atomic_uint uses;
} lr_shared_scene;

/* Takes the scene over, with one use of it; NULL, the scene destroyed, when memory is out. */
lr_shared_scene *lr_shared_scene_create(lr_scene *scene);
lr_shared_scene *lr_shared_scene_take(lr_shared_scene *shared);
void lr_shared_scene_give_back(lr_shared_scene *shared);

typedef struct lr_session {
    lr_shared_scene *shared;
    lr_device *device;
    lr_progressive *progressive;
    lr_display display;
    lr_swapchain swapchain;
} lr_session;

/* Opens a device and makes all ready but for the swapchain: the window has one at a time, and it
 * belongs to the session that is shown. Takes its own use of the scene. */
lr_status lr_session_create(lr_shared_scene *shared, const lr_device_desc *desc,
                            const lr_window_system *window, const lr_settings *settings,
                            lr_session **session, lr_error *error);

/* Returns how many messages the validation layer had, and the first of them; see
 * lr_device_validation_messages. */
uint32_t lr_session_destroy(lr_session *session, char *text, size_t size);

/* A scene ready to take another's place in a session; all of it is owned. */
typedef struct lr_edit {
    lr_shared_scene *shared;
    lr_packed_scene packed;
} lr_edit;

void lr_edit_free(lr_edit *edit); /* NULL is accepted */

/* Takes the edit's scene if the session's kernels do for it, as they do when only numbers have
 * changed. *taken tells; the edit is left empty then. */
lr_status lr_session_edit(lr_session *session, lr_edit *edit, bool *taken, lr_error *error);

/* Gives up the window to another session. */
void lr_session_leave_window(lr_session *session);

/* Shows the picture as far as it is. *shown is false when the window had no image free, or none at
 * all, or needs a new swapchain: try again. */
lr_status lr_session_show(lr_session *session, const lr_look *look, bool *shown, lr_error *error);

#endif
