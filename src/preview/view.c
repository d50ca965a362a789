#include "preview/view.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "preview/camera_control.h"
#include "preview/overlay.h"
#include "render/settings.h"
#include "scene/camera.h"

#define MESSAGE_SECONDS 4.0
#define IDLE_SECONDS 0.25      /* between looks at Ctrl-C */
#define FLIGHT_SECONDS 0.016   /* between pictures while a camera flies */
#define FLIGHT_STEP_MAX 0.1    /* seconds: a hand that was late does not jump */
#define DEGREES_A_POINT 0.3    /* that a drag turns */
#define ZOOM_A_STEP 0.9        /* of the distance, a notch of the wheel */
#define SIZE_MAX_PIXELS 16384u /* of windows */

void lr_view_say(lr_view *view, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(view->message, sizeof view->message, format, arguments);
    va_end(arguments);
    view->message_until = lr_now() + MESSAGE_SECONDS;
    view->overlay_changed = true;
}

void lr_view_wish_picture(lr_view *view)
{
    view->wish.picture++;
    view->wish_changed = true;
    /* Rays over the picture move with the camera. */
    view->overlay_changed = view->overlay_changed || view->explained;
}

void lr_view_wish_look(lr_view *view)
{
    view->wish.look++;
    view->wish_changed = true;
}

void lr_view_build(lr_view *view)
{
    lr_board_lock(&view->board);
    view->board.wish = view->wish;
    view->loader.jobs.build = true;
    lr_board_unlock(&view->board);
    lr_loader_wake(&view->loader);
}

void lr_view_explain(lr_view *view, double x, double y, bool focus)
{
    lr_jobs *jobs = &view->loader.jobs;
    if (x < 0 || y < 0 || x >= view->wish.width || y >= view->wish.height)
        return;
    lr_board_lock(&view->board);
    jobs->explain = !focus;
    jobs->focus = focus;
    jobs->explain_x = (uint32_t)x;
    jobs->explain_y = (uint32_t)y;
    lr_board_unlock(&view->board);
    lr_loader_wake(&view->loader);
}

void lr_view_forget_explained(lr_view *view)
{
    lr_board_lock(&view->board);
    view->loader.jobs.explain = false;
    lr_board_unlock(&view->board);
    lr_explained_pixel_free(view->explained);
    view->explained = NULL;
    view->overlay_changed = true;
}

/* ---- What hands do ------------------------------------------------------------------------ */

static lr_screen screen_of(const lr_view *v)
{
    lr_screen none = {1, 1}, screen = {v->wish.width, v->wish.height};
    return screen.width && screen.height ? screen : none;
}

static void on_key(void *user, uint32_t key)
{
    lr_view_key(user, key);
}

static void on_drag(void *user, lr_button button, bool shift, double dx, double dy)
{
    lr_view *v = user;
    double degrees = DEGREES_A_POINT / v->window.scale;
    lr_camera camera = v->wish.camera;
    if (button == LR_BUTTON_RIGHT)
        v->wish.camera = lr_camera_look(camera, dx * degrees, -dy * degrees);
    else if (button == LR_BUTTON_MIDDLE || shift)
        v->wish.camera = lr_camera_pan(camera, screen_of(v), dx, dy);
    else
        v->wish.camera = lr_camera_orbit(camera, -dx * degrees, dy * degrees);
    lr_view_wish_picture(v);
}

static void on_click(void *user, double x, double y, bool twice)
{
    lr_view *v = user;
    if (twice) {
        lr_view_forget_explained(v);
        lr_view_explain(v, x, y, true);
    } else {
        lr_view_explain(v, x, y, false);
    }
}

static void on_wheel(void *user, double x, double y, double steps)
{
    lr_view *v = user;
    lr_vec3 about = lr_camera_point(&v->wish.camera, screen_of(v), x, y);
    v->wish.camera = lr_camera_zoom(v->wish.camera, pow(ZOOM_A_STEP, steps), about);
    lr_view_wish_picture(v);
}

static void on_change(void *user)
{
    lr_view *v = user;
    uint32_t width = v->window.width, height = v->window.height;
    v->wish.width = width < SIZE_MAX_PIXELS ? width : SIZE_MAX_PIXELS;
    v->wish.height = height < SIZE_MAX_PIXELS ? height : SIZE_MAX_PIXELS;
    v->overlay_changed = true;
    lr_view_wish_look(v);
}

/* Moves a camera whose keys are held; whether there are any. */
static bool fly(lr_view *v, double seconds)
{
    double direction[3];
    lr_window_flight(&v->window, direction);
    if (direction[0] == 0 && direction[1] == 0 && direction[2] == 0)
        return false;
    double way = lr_camera_fly_speed(&v->wish.camera, v->scene_size) * seconds;
    v->wish.camera =
        lr_camera_fly(v->wish.camera, direction[0] * way, direction[1] * way, direction[2] * way);
    lr_view_wish_picture(v);
    return true;
}

/* ---- What the other threads tell ---------------------------------------------------------- */

static void free_cameras(lr_view *v)
{
    for (uint32_t i = 0; i < v->camera_count; i++)
        free(v->cameras[i].name);
    free(v->cameras);
    v->cameras = NULL;
    v->camera_count = 0;
}

void lr_view_wish_samples(lr_view *view)
{
    uint32_t given = view->options->render.samples;
    given = given ? given : view->file.samples;
    view->wish.samples = given ? given : lr_default_samples(view->wish.integrator);
}

/* Follows what the file says where it says something else than before, and else keeps what hands
 * have made of it. */
static void adopt_settings(lr_view *v, const lr_news *news)
{
    const lr_render_options *given = &v->options->render;
    bool samples = news->samples != v->file.samples;
    bool integrator = news->integrator != v->file.integrator;
    if (!given->has_depth && news->depth != v->file.depth)
        v->wish.depth = news->depth;
    if (!given->has_seed && news->seed != v->file.seed)
        v->wish.seed = news->seed;
    if (!v->options->has_exposure && news->exposure != v->file.exposure)
        v->wish.exposure = news->exposure;
    v->file.samples = news->samples;
    v->file.integrator = news->integrator;
    if (!given->integrator && integrator) {
        v->wish.integrator = news->integrator;
        lr_view_build(v);
    }
    if (samples || integrator)
        lr_view_wish_samples(v);
    v->file.depth = news->depth;
    v->file.seed = news->seed;
    v->file.exposure = news->exposure;
}

/* Takes the news' cameras over. */
static void adopt_cameras(lr_view *v, lr_news *news)
{
    lr_camera before = v->cameras ? v->cameras[v->camera] : v->wish.camera;
    if (v->camera >= news->camera_count)
        v->camera = 0;
    const lr_camera *now = &news->cameras[v->camera];
    if (!lr_camera_same(&before, now)) {
        v->wish.camera = *now;
        v->wish.camera.name = NULL;
    }
    free_cameras(v);
    v->cameras = news->cameras;
    v->camera_count = news->camera_count;
    news->cameras = NULL;
    news->camera_count = 0;
}

static void take_news(lr_view *v)
{
    lr_news *news = &v->loader.news;
    lr_board_lock(&v->board);
    if (news->scene != v->seen_scene) {
        v->seen_scene = news->scene;
        adopt_settings(v, news);
        adopt_cameras(v, news);
        v->scene_size = news->size;
        lr_view_wish_picture(v);
    }
    if (news->saved != v->seen_saved && news->saved_index < v->camera_count) {
        v->seen_saved = news->saved;
        char *name = v->cameras[news->saved_index].name;
        v->cameras[news->saved_index] = news->saved_camera;
        v->cameras[news->saved_index].name = name;
    }
    if (news->focus != v->seen_focus) {
        v->seen_focus = news->focus;
        v->wish.camera = lr_camera_focus(v->wish.camera, news->focus_point);
        lr_board_log(&v->board, "focused");
        lr_view_wish_picture(v);
    }
    if (news->explained) {
        lr_explained_pixel_free(v->explained);
        v->overlay_changed = true;
        v->explained = news->explained;
        v->explained_picture = v->wish.picture;
        news->explained = NULL;
    }
    if (news->report != v->seen_report) {
        v->seen_report = news->report;
        free(v->errors);
        v->errors = news->errors ? lr_string_copy(news->errors, strlen(news->errors)) : NULL;
        v->overlay_changed = true;
    }
    if (news->message != v->seen_message) {
        v->seen_message = news->message;
        lr_view_say(v, "%s", news->text);
    }
    if (news->busy != v->busy) {
        v->busy = news->busy;
        v->overlay_changed = true;
    }
    lr_board_unlock(&v->board);
}

static bool has_failed(lr_view *v, lr_error *error)
{
    lr_board_lock(&v->board);
    bool fatal = v->loader.news.fatal;
    if (fatal && error)
        *error = v->loader.news.failure;
    lr_board_unlock(&v->board);
    return fatal;
}

/* ---- What is shown beside the picture ------------------------------------------------------ */

static void update_title(lr_view *v)
{
    char title[sizeof v->title];
    const char *slash = strrchr(v->options->path, '/');
    const char *name = slash ? slash + 1 : v->options->path;
    lr_board_lock(&v->board);
    lr_shown s = v->board.shown;
    lr_board_unlock(&v->board);
    if (s.picture == 0)
        snprintf(title, sizeof title, "%s - lavaray", name);
    else
        snprintf(title, sizeof title, "%s - %ux%u, %u of %u sample%s, %.3g Mray/s, %s - lavaray",
                 name, s.width, s.height, s.samples_done, s.samples, s.samples == 1 ? "" : "s",
                 s.seconds > 0 ? s.rays / s.seconds * 1e-6 : 0, s.device);
    if (!strcmp(title, v->title))
        return;
    memcpy(v->title, title, sizeof title);
    lr_window_set_title(&v->window, title);
}

/* The rays of the explained pixel as they are seen from where the camera is now. */
static lr_overlay_line *project_rays(const lr_view *v, uint32_t *count)
{
    *count = 0;
    if (!v->explained)
        return NULL;
    lr_overlay_line *lines = lr_alloc(v->explained->line_count + 1ull, sizeof *lines);
    for (uint32_t i = 0; lines && i < v->explained->line_count; i++) {
        const lr_ray_line *ray = &v->explained->lines[i];
        double e[4];
        if (lr_camera_project(&v->wish.camera, screen_of(v), ray->from, ray->to, e))
            lines[(*count)++] = (lr_overlay_line){e[0], e[1], e[2], e[3], ray->color, ray->arrow};
    }
    return lines;
}

static void draw_overlay(lr_view *v)
{
    uint32_t line_count;
    lr_overlay_line *lines = project_rays(v, &line_count);
    char *help = v->help ? lr_view_help() : NULL;
    const char *message = v->message_until > 0 ? v->message
                          : v->busy            ? "making the picture ready ..."
                                               : NULL;
    /* In words only for the picture that it is about. */
    bool told = v->explained && v->explained_picture == v->wish.picture && !v->errors;
    const char *explained = told ? v->explained->text : NULL;
    lr_overlay overlay = {
        .panels = {{.text = message, .place = LR_PANEL_TOP_LEFT},
                   {.text = v->errors, .place = LR_PANEL_BOTTOM_LEFT, .error = true},
                   {.text = explained, .place = LR_PANEL_BOTTOM_LEFT, .small = true},
                   {.text = help, .place = LR_PANEL_CENTER}},
        .lines = lines,
        .line_count = line_count,
        .scale = v->window.scale,
    };
    lr_sheet sheet = {.width = v->wish.width, .height = v->wish.height};
    sheet.pixels = lr_overlay_draw(&overlay, sheet.width, sheet.height);
    free(help);
    free(lines);
    lr_board_lock(&v->board);
    free(v->board.sheet.pixels);
    v->board.sheet = sheet;
    v->board.sheet_new = true;
    pthread_cond_signal(&v->board.wake);
    lr_board_unlock(&v->board);
    v->overlay_changed = false;
}

static void publish_wish(lr_view *v)
{
    lr_board_lock(&v->board);
    v->board.wish = v->wish;
    if (atomic_exchange(&v->board.wished, v->wish.picture) != v->wish.picture)
        lr_board_log(&v->board, "wish %llu", (unsigned long long)v->wish.picture);
    pthread_cond_signal(&v->board.wake);
    lr_board_unlock(&v->board);
    v->wish_changed = false;
}

static void round_of_events(lr_view *v)
{
    double now = lr_now();
    double seconds = fmin(now - v->last_time, FLIGHT_STEP_MAX);
    v->last_time = now;
    bool flies = fly(v, seconds);
    take_news(v);
    if (v->message_until > 0 && now >= v->message_until) {
        v->message_until = 0;
        v->overlay_changed = true;
    }
    if (v->wish_changed)
        publish_wish(v);
    if (v->overlay_changed)
        draw_overlay(v);
    update_title(v);
    lr_window_wait(&v->window, flies ? FLIGHT_SECONDS : IDLE_SECONDS);
}

static lr_status main_loop(lr_view *v, lr_error *error)
{
    v->last_time = lr_now();
    while (!lr_window_closed(&v->window)) {
        round_of_events(v);
        if (has_failed(v, error))
            return error ? error->status : LR_ERROR_DEVICE;
        if (v->options->interrupted && v->options->interrupted())
            return lr_fail(error, LR_ERROR_INTERRUPTED, "interrupted");
    }
    return LR_OK;
}

/* ---- From beginning to end ---------------------------------------------------------------- */

/* What the window shows first: the scene's picture, as the options change it. */
static lr_status first_wish(lr_view *v, const lr_scene *scene, lr_error *error)
{
    lr_settings settings;
    lr_status status = lr_settle(scene, &v->options->render, &settings, error);
    if (status)
        return status;
    v->wish = (lr_wish){
        .width = settings.width,
        .height = settings.height,
        .camera = *settings.camera,
        .samples = settings.samples,
        .depth = settings.depth,
        .seed = settings.seed,
        .integrator = settings.integrator,
        .filter = settings.filter,
        .exposure = v->options->has_exposure ? v->options->exposure : scene->image.exposure,
        .picture = 1,
    };
    v->wish.camera.name = NULL;
    v->camera = (uint32_t)(settings.camera - scene->cameras);
    v->file.samples = scene->image.samples;
    v->file.depth = scene->image.depth;
    v->file.integrator = (lr_integrator)(scene->image.integrator + 1);
    v->file.seed = scene->image.seed;
    v->file.exposure = scene->image.exposure;
    return LR_OK;
}

static lr_status run_threads(lr_view *v, lr_scene *scene, const lr_file_list *files,
                             lr_error *error)
{
    lr_status status = lr_loader_start(&v->loader, scene, files, error);
    if (status)
        return status;
    status = lr_renderer_start(&v->renderer, &v->board, error);
    if (!status) {
        status = main_loop(v, error);
        lr_renderer_stop(&v->renderer);
    }
    lr_loader_stop(&v->loader);
    return status;
}

lr_status lr_preview_open(lr_error *error)
{
    return lr_window_system_open(error);
}

void lr_preview_close(void)
{
    lr_window_system_close();
}

lr_status lr_preview_run(lr_scene *scene, const lr_file_list *files,
                         const lr_preview_options *options, lr_error *error)
{
    lr_view *v = lr_alloc(1, sizeof *v);
    if (!v) {
        lr_scene_destroy(scene);
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory");
    }
    v->options = options;
    v->window.handler = (lr_window_handler){
        .user = v,
        .key = on_key,
        .drag = on_drag,
        .click = on_click,
        .wheel = on_wheel,
        .changed = on_change,
    };
    lr_status status = first_wish(v, scene, error);
    if (!status)
        status = lr_board_init(&v->board, error);
    if (status) {
        lr_scene_destroy(scene);
        free(v);
        return status;
    }
    status = lr_window_create(&v->window, options->path, v->wish.width, v->wish.height, error);
    if (!status) {
        v->board.events = options->events;
        v->loader.board = &v->board;
        v->loader.window = &v->window.system;
        v->loader.path = options->path;
        v->loader.screenshot = options->screenshot;
        v->loader.load = options->load;
        v->loader.device = options->device;
        on_change(v);
        publish_wish(v);
        status = run_threads(v, scene, files, error);
    } else {
        lr_scene_destroy(scene);
    }
    lr_board_destroy(&v->board);
    if (!status && v->board.validation_messages > 0)
        status = lr_fail(error, LR_ERROR_DEVICE, "validation: %s", v->board.validation);
    lr_window_destroy(&v->window);
    free_cameras(v);
    free(v->errors);
    lr_explained_pixel_free(v->explained);
    free(v);
    return status;
}
