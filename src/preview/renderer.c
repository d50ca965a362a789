#include "preview/renderer.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "preview/window.h"

#define STEP_SECONDS 0.02

/* A picture that only becomes finer is shown so often, or more seldom where showing takes more than
 * a tenth of the time; and the window is told so often. */
#define SHOW_SECONDS 0.1
#define SHOW_SHARE 0.1
#define TELL_SECONDS 0.25

/* Until a window that has no image free, or no area, is asked again. */
#define RETRY_NANOSECONDS 4000000

/* Another wish stops a picture only after something of it can be seen: a hand that moves the camera
 * faster than pictures are made would otherwise see none. */
static bool go_on(void *user, double fraction)
{
    (void)fraction;
    lr_renderer *r = user;
    bool wanted = atomic_load(&r->board->wished) == r->started;
    return !atomic_load(&r->board->hurry) && (wanted || !r->session->progressive->shown);
}

static void wait_a_little(void)
{
    nanosleep(&(struct timespec){.tv_nsec = RETRY_NANOSECONDS}, NULL);
}

static bool visible(const lr_renderer *r)
{
    return r->session && r->wish.width > 0 && r->wish.height > 0;
}

/* Whether there is nothing to do until the board changes. */
static bool idle(const lr_renderer *r)
{
    const lr_board *b = r->board;
    bool edit = b->edit && r->session;
    if (b->quit || b->next || edit || b->sheet_new || b->wish.picture != r->wish.picture ||
        b->wish.look != r->wish.look)
        return false;
    bool take = b->screenshot && !b->taken.pixels;
    return !visible(r) || (!take && r->session->progressive->finished && !r->show);
}

/* Takes what is new on the board; false when it says to quit. A session that is replaced is left
 * for the caller to destroy. */
static bool take_news(lr_renderer *r, lr_session **old, lr_edit **edit)
{
    lr_board *b = r->board;
    lr_board_lock(b);
    while (idle(r))
        pthread_cond_wait(&b->wake, &b->lock);
    *old = NULL;
    *edit = NULL;
    if (b->quit) {
        lr_board_unlock(b);
        return false;
    }
    if (b->next) {
        *old = r->session;
        r->session = b->next;
        r->proven = false;
        r->started = 0;
        r->sheet_laid = false;
        b->next = NULL;
    }
    if (r->session) {
        *edit = b->edit;
        b->edit = NULL;
    }
    r->show = r->show || b->wish.look != r->wish.look || b->sheet_new;
    r->wish = b->wish;
    if (b->sheet_new) {
        free(r->sheet.pixels);
        r->sheet = b->sheet;
        r->sheet_laid = false;
        b->sheet = (lr_sheet){0};
        b->sheet_new = false;
    }
    atomic_store(&b->hurry, false);
    lr_board_unlock(b);
    return true;
}

/* Lays the sheet over the picture if it was drawn for its size. */
static lr_status lay_sheet(lr_renderer *r, lr_error *error)
{
    lr_display *d = &r->session->display;
    r->sheet_laid = true;
    bool fits = r->sheet.pixels && r->sheet.width == d->width && r->sheet.height == d->height;
    return lr_display_set_overlay(d, fits ? r->sheet.pixels : NULL, error);
}

/* Kernels for light show nothing else, and others no light: until those that are wished for come,
 * what was shown stays. */
static lr_inspect inspect_now(const lr_renderer *r)
{
    const lr_progressive *p = r->session->progressive;
    bool inspects = p->packed.constants[LR_SPEC_INSPECT];
    if (inspects == (r->wish.inspect != LR_INSPECT_LIGHT))
        return r->wish.inspect;
    return p->settings.inspect;
}

/* Fits the swapchain to the window and starts the picture that is wished for. */
static lr_status prepare(lr_renderer *r, lr_error *error)
{
    lr_session *s = r->session;
    lr_status status =
        lr_swapchain_fit(s->device, &s->swapchain, r->wish.width, r->wish.height, error);
    if (status || !s->swapchain.handle)
        return status;
    uint32_t width = s->swapchain.width, height = s->swapchain.height;
    bool resized = width != s->display.width || height != s->display.height;
    if (resized)
        status = lr_display_resize(&s->display, width, height, error);
    if (!status && (resized || !r->sheet_laid))
        status = lay_sheet(r, error);
    const lr_settings *now = &s->progressive->settings;
    if (status || (!resized && r->started == r->wish.picture && now->width == width))
        return status;
    lr_settings settings = {
        .width = width,
        .height = height,
        .samples = r->wish.samples,
        .depth = r->wish.depth,
        .seed = r->wish.seed,
        .filter = r->wish.filter,
        .camera = &r->wish.camera,
        .inspect = inspect_now(r),
    };
    r->started = r->wish.picture;
    r->told_done = false;
    return lr_progressive_start(s->progressive, &settings, error);
}

static void tell(lr_renderer *r)
{
    lr_board *b = r->board;
    lr_progressive *p = r->session->progressive;
    const lr_render_stats *s = &p->stats;
    double now = lr_now();
    bool done = p->finished && !r->show;
    if (done ? r->told_done : now - r->told < TELL_SECONDS)
        return;
    r->told_done = done;
    r->told = now;
    lr_board_lock(b);
    b->shown = (lr_shown){
        .width = p->settings.width,
        .height = p->settings.height,
        .samples_done = p->finished ? p->settings.samples : p->sweep.first_sample,
        .samples = p->settings.samples,
        .rays = (double)(s->primary.traced + s->reflected.traced + s->refracted.traced +
                         s->bounced.traced + s->shadow.traced),
        .seconds = s->trace_seconds,
        .picture = r->started,
    };
    snprintf(b->shown.device, sizeof b->shown.device, "%s", r->session->device->info.name);
    lr_board_unlock(b);
    lr_window_wake();
}

/* Shows the picture if there is something new in it, not too often. */
static lr_status show(lr_renderer *r, lr_error *error)
{
    lr_session *s = r->session;
    double now = lr_now();
    lr_look look = {.exposure = r->wish.exposure};
    bool shown = false;
    if (!r->show || !s->progressive->shown)
        return LR_OK;
    lr_status status = lr_session_show(s, &look, &shown, error);
    if (shown) {
        const lr_progressive *p = s->progressive;
        lr_board_log(r->board, "shown %llu step %u done %.4f size %ux%u%s",
                     (unsigned long long)r->started, p->sweep.step, lr_progressive_done(p),
                     p->settings.width, p->settings.height, p->finished ? " finished" : "");
        r->show = false;
        r->proven = r->proven || p->finished;
        r->last_shown = lr_now();
        r->show_seconds = r->last_shown - now;
    } else if (s->progressive->finished) {
        wait_a_little();
    }
    return status;
}

static lr_status take_screenshot(lr_renderer *r, lr_error *error)
{
    lr_board *b = r->board;
    lr_picture picture;
    lr_board_lock(b);
    bool wanted = b->screenshot && !b->taken.pixels;
    b->screenshot = b->screenshot && !wanted;
    lr_board_unlock(b);
    if (!wanted)
        return LR_OK;
    lr_status status = lr_progressive_picture(r->session->progressive, &picture, error);
    if (status)
        return status;
    lr_board_lock(b);
    b->taken = picture;
    lr_board_unlock(b);
    b->notify_loader(b->loader);
    return LR_OK;
}

/* One round: a step of the picture, and what there is of it on the screen. */
static lr_status serve(lr_renderer *r, lr_error *error)
{
    lr_progressive *p = r->session->progressive;
    lr_status status = prepare(r, error);
    if (!status && !r->session->swapchain.handle)
        wait_a_little();
    if (status || !r->session->swapchain.handle)
        return status;
    bool had_picture = p->shown;
    if (!p->finished) {
        do {
            status = lr_progressive_step(p, STEP_SECONDS, go_on, r, error);
        } while (!status && !p->shown);
        if (status == LR_ERROR_INTERRUPTED) {
            r->started = 0;
            return LR_OK;
        }
        bool first = p->shown && !had_picture;
        double due = r->last_shown + fmax(SHOW_SECONDS, r->show_seconds / SHOW_SHARE);
        r->show = r->show || first || p->finished || lr_now() > due;
    }
    if (!status)
        status = show(r, error);
    if (!status && p->shown)
        status = take_screenshot(r, error);
    if (!status)
        tell(r);
    return status;
}

/* Shows the edited scene, or has a session made for it. */
static lr_status edit_scene(lr_renderer *r, lr_edit *edit, lr_error *error)
{
    bool taken;
    lr_status status = lr_session_edit(r->session, edit, &taken, error);
    lr_edit_free(edit);
    if (taken)
        r->started = 0;
    lr_board_log(r->board, "edit %s", taken ? "taken" : "needs a session");
    if (taken || status)
        return status;
    lr_board_lock(r->board);
    r->board->edit_failed = true;
    lr_board_unlock(r->board);
    r->board->notify_loader(r->board->loader);
    return LR_OK;
}

/* Without a session there is nothing to do until the loader brings another. */
static void give_up_session(lr_renderer *r, const lr_error *error)
{
    lr_board_end_session(r->board, r->session);
    r->session = NULL;
    lr_board_lock(r->board);
    r->board->lost = true;
    r->board->failures = r->proven ? 1 : r->board->failures + 1;
    r->board->failure = *error;
    lr_board_unlock(r->board);
    r->board->notify_loader(r->board->loader);
}

static void *run(void *user)
{
    lr_renderer *r = user;
    lr_session *old;
    lr_edit *edit;
    while (take_news(r, &old, &edit)) {
        if (old)
            lr_session_leave_window(old);
        lr_board_end_session(r->board, old);
        lr_error error = {0};
        lr_status status = edit ? edit_scene(r, edit, &error) : LR_OK;
        if (!status && visible(r))
            status = serve(r, &error);
        if (status)
            give_up_session(r, &error);
    }
    lr_board_end_session(r->board, r->session);
    free(r->sheet.pixels);
    return NULL;
}

lr_status lr_renderer_start(lr_renderer *renderer, lr_board *board, lr_error *error)
{
    *renderer = (lr_renderer){.board = board};
    int failed = pthread_create(&renderer->thread, NULL, run, renderer);
    if (failed)
        return lr_fail(error, LR_ERROR_MEMORY, "no thread for the renderer (error %d)", failed);
    return LR_OK;
}

void lr_renderer_stop(lr_renderer *renderer)
{
    lr_board *b = renderer->board;
    lr_board_lock(b);
    b->quit = true;
    atomic_store(&b->hurry, true);
    pthread_cond_signal(&b->wake);
    lr_board_unlock(b);
    pthread_join(renderer->thread, NULL);
}
