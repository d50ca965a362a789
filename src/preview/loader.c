#include "preview/loader.h"

#include <poll.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "base/memory.h"
#include "preview/screenshot.h"
#include "preview/window.h"
#include "render/explain.h"
#include "scene/save_camera.h"

/* A device that fails so often without a whole picture in between is given up. */
#define FAILURES_MAX 3

void lr_loader_wake(lr_loader *loader)
{
    uint64_t one = 1;
    ssize_t written = write(loader->wake, &one, sizeof one);
    (void)written; /* it fails only when the thread is going to wake anyway */
}

static void wake_from_board(void *loader)
{
    lr_loader_wake(loader);
}

static void say(lr_loader *l, const char *format, ...) __attribute__((format(printf, 2, 3)));

static void say(lr_loader *l, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    lr_board_lock(l->board);
    vsnprintf(l->news.text, sizeof l->news.text, format, arguments);
    l->news.message++;
    lr_board_unlock(l->board);
    va_end(arguments);
    lr_window_wake();
}

static void set_busy(lr_loader *l, bool busy)
{
    lr_board_lock(l->board);
    l->news.busy = busy;
    lr_board_unlock(l->board);
    lr_window_wake();
}

/* Takes the report over. */
static void set_errors(lr_loader *l, char *report)
{
    lr_board_lock(l->board);
    bool changed = report || l->news.errors;
    free(l->news.errors);
    l->news.errors = report;
    l->news.report += changed;
    lr_board_unlock(l->board);
    lr_window_wake();
}

static void free_cameras(lr_news *news)
{
    for (uint32_t i = 0; i < news->camera_count; i++)
        free(news->cameras[i].name);
    free(news->cameras);
    news->cameras = NULL;
    news->camera_count = 0;
}

/* Tells the window about a scene. */
static lr_status announce(lr_loader *l, const lr_scene *scene, lr_error *error)
{
    lr_scene_facts facts;
    lr_scene_get_facts(scene, &facts);
    lr_camera *cameras = lr_alloc(scene->camera_count, sizeof *cameras);
    for (uint32_t i = 0; cameras && i < scene->camera_count; i++) {
        cameras[i] = scene->cameras[i];
        const char *name = scene->cameras[i].name;
        cameras[i].name = name ? lr_string_copy(name, strlen(name)) : NULL;
    }
    if (!cameras)
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory");
    lr_vec3 extent = {0, 0, 0};
    if (facts.bounded)
        extent = (lr_vec3){facts.max[0] - facts.min[0], facts.max[1] - facts.min[1],
                           facts.max[2] - facts.min[2]};
    lr_board_lock(l->board);
    free_cameras(&l->news);
    l->news.cameras = cameras;
    l->news.camera_count = scene->camera_count;
    l->news.samples = scene->image.samples;
    l->news.depth = scene->image.depth;
    l->news.integrator = (lr_integrator)(scene->image.integrator + 1);
    l->news.seed = scene->image.seed;
    l->news.exposure = scene->image.exposure;
    l->news.size = lr_vec3_length(extent);
    l->news.scene++;
    lr_board_unlock(l->board);
    memcpy(l->sha256, scene->sha256, sizeof l->sha256);
    lr_window_wake();
    return LR_OK;
}

static bool quitting(lr_loader *l)
{
    lr_board_lock(l->board);
    bool quit = l->jobs.quit;
    lr_board_unlock(l->board);
    return quit;
}

static void close_explainer(lr_loader *l)
{
    char text[sizeof l->board->validation] = "";
    if (!l->explainer)
        return;
    lr_device_end(l->explainer);
    uint32_t messages = lr_device_validation_messages(l->explainer, text, sizeof text);
    lr_device_close(l->explainer);
    l->explainer = NULL;
    lr_board_note_validation(l->board, messages, text);
}

static bool keep_loading(void *user, const char *what, double fraction)
{
    (void)what, (void)fraction;
    return !quitting(user);
}

/* The settings of the picture that is wished for, but for its camera, which is copied to *camera.
 * Under the board's lock. */
static lr_settings wished_settings(lr_loader *l, lr_camera *camera)
{
    const lr_wish *wish = &l->board->wish;
    *camera = wish->camera;
    return (lr_settings){
        .width = wish->width ? wish->width : 1,
        .height = wish->height ? wish->height : 1,
        .samples = wish->samples,
        .depth = wish->depth,
        .seed = wish->seed,
        .filter = wish->filter,
        .camera = camera,
        .inspect = wish->inspect,
        .integrator = wish->inspect == LR_INSPECT_LIGHT ? wish->integrator : LR_INTEGRATOR_WHITTED,
        .trees = &l->trees,
    };
}

/* Makes a session of the scene and hands it to the renderer. */
static void build(lr_loader *l)
{
    lr_board *b = l->board;
    lr_session *session;
    lr_error error = {0};
    lr_board_lock(b);
    lr_camera camera;
    lr_settings settings = wished_settings(l, &camera);
    lr_device_desc device = l->device;
    lr_board_unlock(b);
    set_busy(l, true);
    lr_status status = lr_session_create(l->scene, &device, l->window, &settings, &session, &error);
    lr_session *unseen = NULL;
    lr_edit *overtaken = NULL;
    lr_board_lock(b);
    bool first = b->shown.picture == 0;
    if (!status) {
        unseen = b->next;
        b->next = session;
        overtaken = b->edit;
        b->edit = NULL;
        b->lost = false;
        atomic_store(&b->hurry, true);
        pthread_cond_signal(&b->wake);
    } else if (first || b->lost) {
        l->news.fatal = true;
        l->news.failure = error;
    }
    l->news.busy = false;
    lr_board_unlock(b);
    lr_board_log(b, "session %s", status ? "failed" : "ready");
    lr_board_end_session(b, unseen);
    lr_edit_free(overtaken);
    if (status)
        say(l, "%s", error.message);
    lr_window_wake();
}

/* Offers a scene that was read again to the session that is shown; whether it could be. */
static bool offer_edit(lr_loader *l)
{
    lr_board *b = l->board;
    lr_camera camera;
    lr_board_lock(b);
    lr_settings settings = wished_settings(l, &camera);
    bool shown = b->shown.picture > 0 && !b->lost && !b->next;
    lr_board_unlock(b);
    lr_edit *edit = shown ? lr_alloc(1, sizeof *edit) : NULL;
    if (!edit)
        return false;
    edit->shared = lr_shared_scene_take(l->scene);
    if (lr_pack_scene(l->scene->scene, &settings, &edit->packed, NULL)) {
        lr_edit_free(edit);
        return false;
    }
    lr_board_lock(b);
    lr_edit *overtaken = b->edit;
    b->edit = edit;
    atomic_store(&b->hurry, true);
    pthread_cond_signal(&b->wake);
    lr_board_unlock(b);
    lr_edit_free(overtaken);
    return true;
}

/* Reads the scene again. A broken file is told of and changes nothing else. */
static void load(lr_loader *l)
{
    lr_scene *scene;
    char *report = NULL;
    lr_error error = {0};
    lr_file_list files = {0};
    lr_load_options options = l->load;
    options.files = &files;
    options.previous = l->scene->scene;
    options.progress = keep_loading;
    options.user = l;
    lr_status status = lr_scene_load(l->path, &options, &scene, &report, &error);
    if (!status) {
        lr_shared_scene *shared = lr_shared_scene_create(scene);
        if (shared) {
            lr_shared_scene_give_back(l->scene);
            l->scene = shared;
            status = announce(l, scene, &error);
        } else {
            status = lr_fail(&error, LR_ERROR_MEMORY, "out of memory");
        }
    }
    if (status && !report)
        report = lr_string_copy(error.message, strlen(error.message));
    lr_board_log(l->board, "scene %s", status ? "broken" : "read");
    if (status != LR_ERROR_INTERRUPTED)
        set_errors(l, report);
    else
        free(report);
    if (files.count > 0 && !lr_follow_files(l->follow, &files))
        say(l, "out of memory to follow the scene's files");
    lr_file_list_free(&files);
    if (!status && !offer_edit(l)) {
        lr_board_lock(l->board);
        l->jobs.build = true;
        lr_board_unlock(l->board);
    }
}

/* The renderer's device has failed: a new one may work, unless it fails all the time. */
static void replace_lost(lr_loader *l)
{
    lr_board *b = l->board;
    lr_board_lock(b);
    lr_error failure = b->failure;
    bool again = b->failures < FAILURES_MAX;
    if (!again) {
        l->news.fatal = true;
        l->news.failure = failure;
    }
    lr_board_unlock(b);
    if (again)
        build(l);
    lr_window_wake();
}

static void write_screenshot(lr_loader *l, const lr_picture *picture, double exposure)
{
    char name[LR_SCREENSHOT_NAME];
    lr_error error = {0};
    const lr_screenshot shot = {l->screenshot, l->path, l->sha256, exposure};
    if (lr_screenshot_write(&shot, picture, name, &error))
        say(l, "%s", error.message);
    else
        say(l, "wrote %s", name);
}

static void save_camera(lr_loader *l, uint32_t index, const lr_camera *camera)
{
    lr_error error = {0};
    if (lr_scene_save_camera(l->path, index, camera, l->sha256, &error)) {
        say(l, "%s", error.message);
        return;
    }
    lr_follow_forget_own_write(l->follow, l->path);
    lr_board_lock(l->board);
    l->news.saved++;
    l->news.saved_index = index;
    l->news.saved_camera = *camera;
    lr_board_unlock(l->board);
    say(l, "saved the camera in %s", l->path);
}

/* Explains a pixel of the picture that is shown, on a device of its own: the renderer goes on. */
static lr_explained_pixel *explain(lr_loader *l, uint32_t x, uint32_t y)
{
    lr_board *b = l->board;
    lr_camera camera;
    lr_explanation explanation = {0};
    lr_error error = {0};
    static const lr_render_options options;
    lr_board_lock(b);
    lr_settings settings = wished_settings(l, &camera);
    double far = l->news.size > 0 ? l->news.size : 1;
    lr_board_unlock(b);
    settings.inspect = LR_INSPECT_LIGHT;
    settings.integrator = LR_INTEGRATOR_WHITTED;
    lr_status status = LR_OK;
    if (!l->explainer)
        status = lr_device_open(&l->device, &l->explainer, &error);
    if (!status)
        status = lr_explain_picture(l->explainer, l->scene->scene, &settings, &options, x, y, 0,
                                    &explanation, &error);
    lr_explained_pixel *explained = NULL;
    if (!status)
        explained = lr_explained_pixel_create(l->scene->scene, &explanation, far);
    lr_explanation_free(&explanation);
    lr_board_log(b, "explained %u,%u %s", x, y, explained ? "well" : "not");
    if (!explained) {
        close_explainer(l);
        say(l, "%s", status ? error.message : "out of memory");
    }
    return explained;
}

static void tell_explained(lr_loader *l, lr_explained_pixel *explained, bool focus)
{
    lr_board_lock(l->board);
    bool meets = explained->meets;
    if (focus && meets) {
        l->news.focus++;
        l->news.focus_point = explained->met;
    } else if (!focus && !l->jobs.focus) { /* a click that was not the first of two */
        lr_explained_pixel *before = l->news.explained;
        l->news.explained = explained;
        explained = before;
    }
    lr_board_unlock(l->board);
    lr_explained_pixel_free(explained);
    if (focus && !meets)
        say(l, "there is nothing to focus on");
    lr_window_wake();
}

/* Chooses the next usable device in the order of the list, after the one in use. */
static void next_device(lr_loader *l)
{
    lr_device_info *devices;
    uint32_t count, current = 0, usable = 0;
    lr_error error = {0};
    if (lr_device_list(&devices, &count, &error)) {
        say(l, "%s", error.message);
        return;
    }
    lr_board_lock(l->board);
    for (uint32_t i = 0; i < count; i++) {
        current = strcmp(devices[i].name, l->board->shown.device) ? current : i;
        usable += devices[i].usable;
    }
    uint32_t next = current;
    for (uint32_t i = 1; i < count && next == current; i++)
        if (devices[(current + i) % count].usable)
            next = (current + i) % count;
    if (usable > 1) {
        snprintf(l->device_name, sizeof l->device_name, "%u", (unsigned)next);
        l->device.select = l->device_name;
        l->jobs.build = true;
    }
    lr_board_unlock(l->board);
    if (usable > 1)
        close_explainer(l);
    if (usable > 1)
        say(l, "device %s", devices[next].name);
    else
        say(l, "there is no other device than %s", devices[current].name);
    free(devices);
}

/* Does what there is to do, one thing after the other. */
static bool work(lr_loader *l)
{
    lr_board *b = l->board;
    lr_board_lock(b);
    lr_jobs jobs = l->jobs;
    bool quit = jobs.quit;
    l->jobs = (lr_jobs){.quit = quit};
    lr_picture taken = b->taken;
    double exposure = b->wish.exposure;
    bool lost = b->lost;
    jobs.build |= b->edit_failed;
    b->edit_failed = false;
    b->taken = (lr_picture){0};
    pthread_cond_signal(&b->wake); /* there may be another to take */
    lr_board_unlock(b);
    if (taken.pixels)
        write_screenshot(l, &taken, exposure);
    lr_picture_free(&taken);
    if (quit)
        return false;
    if (jobs.save)
        save_camera(l, jobs.save_index, &jobs.save_camera);
    if (jobs.next_device)
        next_device(l);
    if (jobs.load)
        load(l);
    if (jobs.explain || jobs.focus) {
        lr_explained_pixel *explained = explain(l, jobs.explain_x, jobs.explain_y);
        if (explained)
            tell_explained(l, explained, jobs.focus);
    }
    lr_board_lock(b);
    bool wants_build = jobs.build || l->jobs.build;
    l->jobs.build = false;
    lr_board_unlock(b);
    if (lost && !wants_build)
        replace_lost(l);
    else if (wants_build)
        build(l);
    return true;
}

static int milliseconds(double seconds)
{
    return seconds < 0 ? -1 : seconds > 60 ? 60000 : (int)(1000 * seconds) + 1;
}

static void wait_for_work(lr_loader *l)
{
    struct pollfd files[2] = {{.fd = l->wake, .events = POLLIN},
                              {.fd = lr_follow_descriptor(l->follow), .events = POLLIN}};
    const lr_jobs *jobs = &l->jobs;
    lr_board_lock(l->board);
    bool waiting = jobs->quit || jobs->load || jobs->build || jobs->save || jobs->next_device ||
                   jobs->explain || jobs->focus;
    lr_board_unlock(l->board);
    if (!waiting)
        poll(files, 2, milliseconds(lr_follow_wait(l->follow, lr_now())));
    uint64_t count;
    if (files[0].revents && read(l->wake, &count, sizeof count) < 0)
        return;
    if (!lr_follow_changed(l->follow, lr_now()))
        return;
    lr_board_lock(l->board);
    l->jobs.load = true;
    lr_board_unlock(l->board);
}

static void *run(void *user)
{
    lr_loader *l = user;
    while (work(l))
        wait_for_work(l);
    return NULL;
}

static void release(lr_loader *l)
{
    lr_follow_destroy(l->follow);
    lr_shared_scene_give_back(l->scene);
    lr_trees_free(&l->trees);
    close_explainer(l);
    lr_explained_pixel_free(l->news.explained);
    free_cameras(&l->news);
    free(l->news.errors);
    if (l->wake >= 0)
        close(l->wake);
}

lr_status lr_loader_start(lr_loader *loader, lr_scene *scene, const lr_file_list *files,
                          lr_error *error)
{
    lr_loader *l = loader;
    l->scene = lr_shared_scene_create(scene);
    l->follow = lr_follow_create();
    l->wake = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    lr_status status = LR_OK;
    if (!l->scene || !l->follow || l->wake < 0 || !lr_follow_files(l->follow, files))
        status = lr_fail(error, LR_ERROR_MEMORY, "out of memory to follow the scene's files");
    if (!status)
        status = announce(l, scene, error);
    l->jobs.build = true;
    l->board->loader = l;
    l->board->notify_loader = wake_from_board;
    if (!status && pthread_create(&l->thread, NULL, run, l))
        status = lr_fail(error, LR_ERROR_MEMORY, "no thread for the loader");
    if (status)
        release(l);
    return status;
}

void lr_loader_stop(lr_loader *loader)
{
    lr_board_lock(loader->board);
    loader->jobs.quit = true;
    lr_board_unlock(loader->board);
    lr_loader_wake(loader);
    pthread_join(loader->thread, NULL);
    release(loader);
}
