#include "preview/view.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "preview/camera_control.h"
#include "scene/write.h"

#define EXPOSURE_STEP (1.0 / 3)
#define EXPOSURE_MAX 64.0
#define DEPTH_MAX 64
#define FOV_STEP 1.1
#define FOV_GRAIN 1e6 /* of a degree; so a step back is back, and what is saved is short */

static void toggle_help(lr_view *v)
{
    v->help = !v->help;
    v->overlay_changed = true;
}

static void dismiss(lr_view *v)
{
    v->help = false;
    v->message_until = 0;
    v->overlay_changed = true;
    lr_view_forget_explained(v);
    if (lr_window_is_full_screen(&v->window))
        lr_window_toggle_full_screen(&v->window);
}

static void quit(lr_view *v)
{
    lr_window_close(&v->window);
}

static void full_screen(lr_view *v)
{
    lr_window_toggle_full_screen(&v->window);
}

static void reset(lr_view *v)
{
    char *name = v->wish.camera.name;
    v->wish.camera = v->cameras[v->camera];
    v->wish.camera.name = name;
    lr_view_wish_picture(v);
}

static void focus(lr_view *v)
{
    lr_view_explain(v, v->window.x, v->window.y, true);
}

static void explain(lr_view *v)
{
    lr_view_explain(v, v->window.x, v->window.y, false);
}

static void set_fov(lr_view *v, double factor)
{
    double fov = nearbyint(v->wish.camera.fov * factor * FOV_GRAIN) / FOV_GRAIN;
    v->wish.camera = lr_camera_set_fov(v->wish.camera, fov);
    lr_view_say(v, "field of view %.3g degrees", v->wish.camera.fov);
    lr_view_wish_picture(v);
}

static void wider(lr_view *v)
{
    set_fov(v, FOV_STEP);
}

static void narrower(lr_view *v)
{
    set_fov(v, 1 / FOV_STEP);
}

static void expose(lr_view *v, double stops)
{
    v->wish.exposure = fmin(fmax(v->wish.exposure + stops, -EXPOSURE_MAX), EXPOSURE_MAX);
    lr_view_say(v, "exposure %+.2f stops", v->wish.exposure);
    lr_view_wish_look(v);
}

static void brighter(lr_view *v)
{
    expose(v, EXPOSURE_STEP);
}

static void darker(lr_view *v)
{
    expose(v, -EXPOSURE_STEP);
}

static void deepen(lr_view *v, int by)
{
    int depth = (int)v->wish.depth + by;
    v->wish.depth = (uint32_t)(depth < 0 ? 0 : depth > DEPTH_MAX ? DEPTH_MAX : depth);
    lr_view_say(v, "depth %u", v->wish.depth);
    lr_view_wish_picture(v);
}

static void deeper(lr_view *v)
{
    deepen(v, 1);
}

static void shallower(lr_view *v)
{
    deepen(v, -1);
}

static void next_values(lr_view *v)
{
    static const char *const names[] = {
        [LR_INSPECT_LIGHT] = "light",
        [LR_INSPECT_NORMAL] = "normals",
        [LR_INSPECT_DEPTH] = "depth, grey at the focus",
        [LR_INSPECT_OBJECT] = "objects",
        [LR_INSPECT_RAYS] = "rays a sample, black 0 to yellow 64",
    };
    bool lit = v->wish.inspect == LR_INSPECT_LIGHT;
    v->wish.inspect = v->wish.inspect == LR_INSPECT_RAYS ? LR_INSPECT_LIGHT : v->wish.inspect + 1;
    lr_view_say(v, "%s", names[v->wish.inspect]);
    lr_view_wish_picture(v);
    if (lit || v->wish.inspect == LR_INSPECT_LIGHT)
        lr_view_build(v);
}

static void next_integrator(lr_view *v)
{
    bool paths = v->wish.integrator == LR_INTEGRATOR_PATH;
    v->wish.integrator = paths ? LR_INTEGRATOR_WHITTED : LR_INTEGRATOR_PATH;
    lr_view_wish_samples(v);
    lr_view_say(v,
                paths ? "ray trees: mirrors, glass and direct light" : "paths: all ways of light");
    lr_view_wish_picture(v);
    if (v->wish.inspect == LR_INSPECT_LIGHT)
        lr_view_build(v);
}

static void screenshot(lr_view *v)
{
    lr_board_lock(&v->board);
    v->board.screenshot = true;
    pthread_cond_signal(&v->board.wake);
    lr_board_unlock(&v->board);
}

static void print_camera(lr_view *v)
{
    char *text = lr_camera_text(&v->wish.camera);
    if (text) {
        v->options->print(text);
        lr_view_say(v, "%s", text);
    }
    free(text);
}

static void save_camera(lr_view *v)
{
    lr_board_lock(&v->board);
    v->loader.jobs.save = true;
    v->loader.jobs.save_index = v->camera;
    v->loader.jobs.save_camera = v->wish.camera;
    lr_board_unlock(&v->board);
    lr_loader_wake(&v->loader);
}

static void next_device(lr_view *v)
{
    lr_board_lock(&v->board);
    v->loader.jobs.next_device = true;
    lr_board_unlock(&v->board);
    lr_loader_wake(&v->loader);
}

static const struct {
    uint32_t key;
    void (*act)(lr_view *view);
    const char *name, *help; /* NULL: is in another line's */
} keys[] = {
    {'f', focus, "f", "focus on what is under the cursor"},
    {'e', explain, "e", "explain the pixel under the cursor"},
    {'r', reset, "r Home", "back to the scene's camera"},
    {LR_KEY_HOME, reset, NULL, NULL},
    {LR_KEY_PAGE_UP, narrower, "PgUp PgDn", "field of view"},
    {LR_KEY_PAGE_DOWN, wider, NULL, NULL},
    {'p', print_camera, "p", "print the camera, to be pasted into a scene"},
    {'s', save_camera, "s", "save the camera in the scene file"},
    {LR_KEY_UP, brighter, "Up Down", "exposure"},
    {LR_KEY_DOWN, darker, NULL, NULL},
    {LR_KEY_RIGHT, deeper, "Left Right", "depth: bounces of light"},
    {LR_KEY_LEFT, shallower, NULL, NULL},
    {'v', next_values, "v", "light, normals, depth, objects, number of rays"},
    {'i', next_integrator, "i", "integrator: ray trees or paths"},
    {'g', next_device, "g", "next device"},
    {LR_KEY_F12, screenshot, "F12 c", "screenshot"},
    {'c', screenshot, NULL, NULL},
    {LR_KEY_F11, full_screen, "F11", "full screen"},
    {'h', toggle_help, "h F1 ?", "this help"},
    {'?', toggle_help, NULL, NULL},
    {LR_KEY_F1, toggle_help, NULL, NULL},
    {LR_KEY_ESCAPE, dismiss, "Esc", "close what lies over the picture"},
    {'q', quit, "q", "quit"},
};
enum { KEY_COUNT = sizeof keys / sizeof *keys };

static void choose_camera(lr_view *v, uint32_t number)
{
    if (number >= v->camera_count) {
        lr_view_say(v, "the scene has %u camera%s", v->camera_count,
                    v->camera_count > 1 ? "s" : "");
        return;
    }
    v->camera = number;
    reset(v);
    const char *name = v->cameras[number].name;
    lr_view_say(v, "camera %u%s%s", number + 1, name ? ": " : "", name ? name : "");
}

void lr_view_key(lr_view *view, uint32_t key)
{
    if (key >= '1' && key <= '9')
        choose_camera(view, key - '1');
    for (int i = 0; i < KEY_COUNT; i++)
        if (keys[i].key == key)
            keys[i].act(view);
}

char *lr_view_help(void)
{
    static const char hands[] =
        "drag            orbit\n"
        "wheel           nearer, farther\n"
        "middle drag     move sideways (also Shift and drag)\n"
        "right drag      look around, with W A S D Q E fly\n"
        "click           explain that pixel; its rays stay when the camera moves\n"
        "double click    focus on that place\n"
        "1 ... 9         the scene's cameras\n";
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    if (!out)
        return NULL;
    fputs(hands, out);
    for (int i = 0; i < KEY_COUNT; i++)
        if (keys[i].name)
            fprintf(out, "%-15s %s\n", keys[i].name, keys[i].help);
    fclose(out);
    return text;
}
