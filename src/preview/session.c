#include "preview/session.h"

#include <stdlib.h>

#include "base/memory.h"
#include "gpu/commands.h"

lr_shared_scene *lr_shared_scene_create(lr_scene *scene)
{
    lr_shared_scene *shared = lr_alloc(1, sizeof *shared);
    if (!shared) {
        lr_scene_destroy(scene);
        return NULL;
    }
    shared->scene = scene;
    atomic_init(&shared->uses, 1);
    return shared;
}

lr_shared_scene *lr_shared_scene_take(lr_shared_scene *shared)
{
    atomic_fetch_add(&shared->uses, 1);
    return shared;
}

void lr_shared_scene_give_back(lr_shared_scene *shared)
{
    if (!shared || atomic_fetch_sub(&shared->uses, 1) > 1)
        return;
    lr_scene_destroy(shared->scene);
    free(shared);
}

lr_status lr_session_create(lr_shared_scene *shared, const lr_device_desc *desc,
                            const lr_window_system *window, const lr_settings *settings,
                            lr_session **session, lr_error *error)
{
    lr_session *s = *session = lr_alloc(1, sizeof *s);
    if (!s)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory");
    s->shared = lr_shared_scene_take(shared);
    lr_status status = lr_device_open_window(desc, window, &s->device, error);
    if (!status)
        status = lr_progressive_create(s->device, shared->scene, settings, &s->progressive, error);
    if (!status)
        status = lr_display_create(s->device, &s->display, error);
    if (status) {
        lr_session_destroy(s, NULL, 0);
        *session = NULL;
    }
    return status;
}

void lr_edit_free(lr_edit *edit)
{
    if (!edit)
        return;
    lr_shared_scene_give_back(edit->shared);
    lr_packed_scene_free(&edit->packed);
    free(edit);
}

lr_status lr_session_edit(lr_session *session, lr_edit *edit, bool *taken, lr_error *error)
{
    lr_status status = lr_progressive_replace(session->progressive, edit->shared->scene,
                                              &edit->packed, taken, error);
    if (!*taken)
        return status;
    lr_shared_scene_give_back(session->shared);
    session->shared = edit->shared;
    edit->shared = NULL;
    return status;
}

void lr_session_leave_window(lr_session *session)
{
    lr_swapchain_destroy(session->device, &session->swapchain);
}

uint32_t lr_session_destroy(lr_session *session, char *text, size_t size)
{
    uint32_t messages = 0;
    if (!session)
        return 0;
    if (session->device)
        lr_session_leave_window(session);
    lr_display_destroy(&session->display);
    lr_progressive_destroy(session->progressive);
    if (session->device) {
        lr_device_end(session->device);
        messages = lr_device_validation_messages(session->device, text, size);
    }
    lr_device_close(session->device);
    lr_shared_scene_give_back(session->shared);
    free(session);
    return messages;
}

lr_status lr_session_show(lr_session *session, const lr_look *look, bool *shown, lr_error *error)
{
    lr_session *s = session;
    lr_device *device = s->device;
    lr_look how = *look;
    uint32_t image;
    *shown = false;
    if (!s->swapchain.handle || s->swapchain.stale)
        return LR_OK;
    lr_status status = lr_swapchain_acquire(device, &s->swapchain, &image, error);
    if (status || image == UINT32_MAX)
        return status;
    how.blue_first = s->swapchain.blue_first;
    lr_progressive_look(s->progressive, &how);
    status = lr_commands_begin(device, error);
    if (status)
        return status;
    lr_display_record(&s->display, &s->progressive->wavefront.film, &how);
    lr_swapchain_copy(device, &s->swapchain, &s->display.canvas, image);
    status = lr_commands_finish(device, error);
    if (!status)
        status = lr_swapchain_present(device, &s->swapchain, image, shown, error);
    return status;
}
