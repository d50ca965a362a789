#include "preview/window.h"

#include <math.h>
#include <stdlib.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#define CLICK_RADIUS 3.0 /* points that a hand may move while it clicks */
#define CLICK_TWICE 0.35 /* seconds */
#define SIZE_MIN 64

static VkResult create_surface(void *window, VkInstance instance, VkSurfaceKHR *surface)
{
    return glfwCreateWindowSurface(instance, window, NULL, surface);
}

static bool can_present(VkInstance instance, VkPhysicalDevice physical, uint32_t queue_family)
{
    return glfwGetPhysicalDevicePresentationSupport(instance, physical, queue_family);
}

/* Pixels of the picture a unit of the window's coordinates. */
static double pixels_per_unit(GLFWwindow *handle)
{
    int window_width, window_height, width, height;
    glfwGetWindowSize(handle, &window_width, &window_height);
    glfwGetFramebufferSize(handle, &width, &height);
    return window_width > 0 && width > 0 ? (double)width / window_width : 1;
}

static void measure(lr_window *w)
{
    int width, height;
    float x, y;
    glfwGetFramebufferSize(w->handle, &width, &height);
    glfwGetWindowContentScale(w->handle, &x, &y);
    bool shown = width > 0 && height > 0 && !glfwGetWindowAttrib(w->handle, GLFW_ICONIFIED);
    w->width = shown ? (uint32_t)width : 0;
    w->height = shown ? (uint32_t)height : 0;
    w->scale = isfinite(x) && x >= 0.5f && x <= 8 ? (double)x : 1;
}

static void on_size(GLFWwindow *handle, int width, int height)
{
    (void)width, (void)height;
    lr_window *w = glfwGetWindowUserPointer(handle);
    measure(w);
    w->handler.changed(w->handler.user);
}

static void on_refresh(GLFWwindow *handle)
{
    on_size(handle, 0, 0);
}

static void on_scale(GLFWwindow *handle, float x, float y)
{
    (void)x, (void)y;
    on_size(handle, 0, 0);
}

static void on_iconify(GLFWwindow *handle, int iconified)
{
    on_size(handle, iconified, 0);
}

static void on_character(GLFWwindow *handle, unsigned character)
{
    lr_window *w = glfwGetWindowUserPointer(handle);
    /* While the right button is down, letters fly. */
    if (w->button != LR_BUTTON_RIGHT)
        w->handler.key(w->handler.user, character);
}

static void on_key(GLFWwindow *handle, int key, int scancode, int action, int mods)
{
    static const struct {
        int glfw;
        uint32_t key;
    } keys[] = {
        {GLFW_KEY_ESCAPE, LR_KEY_ESCAPE},
        {GLFW_KEY_LEFT, LR_KEY_LEFT},
        {GLFW_KEY_RIGHT, LR_KEY_RIGHT},
        {GLFW_KEY_UP, LR_KEY_UP},
        {GLFW_KEY_DOWN, LR_KEY_DOWN},
        {GLFW_KEY_PAGE_UP, LR_KEY_PAGE_UP},
        {GLFW_KEY_PAGE_DOWN, LR_KEY_PAGE_DOWN},
        {GLFW_KEY_HOME, LR_KEY_HOME},
        {GLFW_KEY_F1, LR_KEY_F1},
        {GLFW_KEY_F11, LR_KEY_F11},
        {GLFW_KEY_F12, LR_KEY_F12},
    };
    (void)scancode, (void)mods;
    lr_window *w = glfwGetWindowUserPointer(handle);
    if (action == GLFW_RELEASE)
        return;
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        if (keys[i].glfw == key)
            w->handler.key(w->handler.user, keys[i].key);
}

static void on_move(GLFWwindow *handle, double x, double y)
{
    lr_window *w = glfwGetWindowUserPointer(handle);
    double pixels = pixels_per_unit(handle);
    double dx = x * pixels - w->x, dy = y * pixels - w->y;
    w->x += dx;
    w->y += dy;
    if (w->button == LR_BUTTON_NONE)
        return;
    double far = hypot(w->x - w->pressed_x, w->y - w->pressed_y);
    if (!w->dragged && far <= CLICK_RADIUS * w->scale)
        return;
    if (!w->dragged) { /* what was held back counts too */
        dx = w->x - w->pressed_x;
        dy = w->y - w->pressed_y;
    }
    w->dragged = true;
    bool shift = glfwGetKey(handle, GLFW_KEY_LEFT_SHIFT) == GLFW_PRESS ||
                 glfwGetKey(handle, GLFW_KEY_RIGHT_SHIFT) == GLFW_PRESS;
    w->handler.drag(w->handler.user, w->button, shift, dx, dy);
}

static void release(lr_window *w)
{
    bool click = w->button == LR_BUTTON_LEFT && !w->dragged;
    w->button = LR_BUTTON_NONE;
    if (!click)
        return;
    double now = lr_now();
    bool twice = now - w->click_time < CLICK_TWICE;
    w->click_time = twice ? 0 : now;
    w->handler.click(w->handler.user, w->pressed_x, w->pressed_y, twice);
}

static void on_button(GLFWwindow *handle, int button, int action, int mods)
{
    (void)mods;
    lr_window *w = glfwGetWindowUserPointer(handle);
    lr_button which = button == GLFW_MOUSE_BUTTON_LEFT     ? LR_BUTTON_LEFT
                      : button == GLFW_MOUSE_BUTTON_MIDDLE ? LR_BUTTON_MIDDLE
                      : button == GLFW_MOUSE_BUTTON_RIGHT  ? LR_BUTTON_RIGHT
                                                           : LR_BUTTON_NONE;
    if (action == GLFW_PRESS && w->button == LR_BUTTON_NONE) {
        w->button = which;
        w->pressed_x = w->x;
        w->pressed_y = w->y;
        w->dragged = false;
    } else if (action == GLFW_RELEASE && which == w->button && which != LR_BUTTON_NONE) {
        release(w);
    }
}

static void on_wheel(GLFWwindow *handle, double x, double y)
{
    (void)x;
    lr_window *w = glfwGetWindowUserPointer(handle);
    w->handler.wheel(w->handler.user, w->x, w->y, y);
}

lr_status lr_window_system_open(lr_error *error)
{
    const char *why = NULL;
    glfwInitHint(GLFW_JOYSTICK_HAT_BUTTONS, GLFW_FALSE);
    if (glfwInit())
        return LR_OK;
    glfwGetError(&why);
    return lr_fail(
        error, LR_ERROR_DEVICE,
        "no display to open a window on (%s); lavaray render SCENE -o FILE.png needs none",
        why ? why : "GLFW does not say why");
}

void lr_window_system_close(void)
{
    glfwTerminate();
}

/* The largest size of these proportions that the screen has room for. */
static void fit_screen(uint32_t *width, uint32_t *height)
{
    int x, y, wide, high;
    GLFWmonitor *monitor = glfwGetPrimaryMonitor();
    if (!monitor)
        return;
    glfwGetMonitorWorkarea(monitor, &x, &y, &wide, &high);
    double factor = 1;
    if (wide > 0 && *width > (uint32_t)wide)
        factor = (double)wide / *width;
    if (high > 0 && *height * factor > high)
        factor = (double)high / *height;
    *width = (uint32_t)fmax(floor(*width * factor), SIZE_MIN);
    *height = (uint32_t)fmax(floor(*height * factor), SIZE_MIN);
}

lr_status lr_window_create(lr_window *window, const char *title, uint32_t width, uint32_t height,
                           lr_error *error)
{
    lr_window *w = window;
    lr_window_handler handler = w->handler;
    *w = (lr_window){.handler = handler, .scale = 1};
    w->system.extensions = glfwGetRequiredInstanceExtensions(&w->system.extension_count);
    if (!w->system.extensions)
        return lr_fail(error, LR_ERROR_DEVICE,
                       "no Vulkan driver can show pictures on this display; install the package "
                       "mesa-vulkan-drivers, or use lavaray render SCENE -o FILE.png");
    fit_screen(&width, &height);
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHintString(GLFW_X11_CLASS_NAME, "lavaray");
    glfwWindowHintString(GLFW_X11_INSTANCE_NAME, "lavaray");
    w->handle = glfwCreateWindow((int)width, (int)height, title, NULL, NULL);
    if (!w->handle) {
        const char *why = NULL;
        glfwGetError(&why);
        return lr_fail(error, LR_ERROR_DEVICE, "the window cannot be opened (%s)",
                       why ? why : "GLFW does not say why");
    }
    w->system.can_present = can_present;
    w->system.create_surface = create_surface;
    w->system.window = w->handle;
    glfwSetWindowUserPointer(w->handle, w);
    glfwSetFramebufferSizeCallback(w->handle, on_size);
    glfwSetWindowRefreshCallback(w->handle, on_refresh);
    glfwSetWindowContentScaleCallback(w->handle, on_scale);
    glfwSetWindowIconifyCallback(w->handle, on_iconify);
    glfwSetCharCallback(w->handle, on_character);
    glfwSetKeyCallback(w->handle, on_key);
    glfwSetCursorPosCallback(w->handle, on_move);
    glfwSetMouseButtonCallback(w->handle, on_button);
    glfwSetScrollCallback(w->handle, on_wheel);
    measure(w);
    return LR_OK;
}

void lr_window_destroy(lr_window *window)
{
    if (!window->handle)
        return;
    glfwDestroyWindow(window->handle);
    window->handle = NULL;
}

void lr_window_wait(lr_window *window, double seconds)
{
    (void)window;
    if (seconds > 0)
        glfwWaitEventsTimeout(seconds);
    else
        glfwPollEvents();
}

void lr_window_wake(void)
{
    glfwPostEmptyEvent();
}

bool lr_window_closed(const lr_window *window)
{
    return glfwWindowShouldClose(window->handle);
}

void lr_window_close(lr_window *window)
{
    glfwSetWindowShouldClose(window->handle, GLFW_TRUE);
}

void lr_window_set_title(lr_window *window, const char *title)
{
    glfwSetWindowTitle(window->handle, title);
}

bool lr_window_is_full_screen(const lr_window *window)
{
    return glfwGetWindowMonitor(window->handle) != NULL;
}

void lr_window_toggle_full_screen(lr_window *window)
{
    int *saved = window->saved;
    if (lr_window_is_full_screen(window)) {
        glfwSetWindowMonitor(window->handle, NULL, saved[0], saved[1], saved[2], saved[3],
                             GLFW_DONT_CARE);
        return;
    }
    GLFWmonitor *monitor = glfwGetPrimaryMonitor();
    const GLFWvidmode *mode = monitor ? glfwGetVideoMode(monitor) : NULL;
    if (!mode)
        return;
    glfwGetWindowPos(window->handle, &saved[0], &saved[1]);
    glfwGetWindowSize(window->handle, &saved[2], &saved[3]);
    glfwSetWindowMonitor(window->handle, monitor, 0, 0, mode->width, mode->height,
                         mode->refreshRate);
}

void lr_window_flight(const lr_window *window, double direction[3])
{
    static const int keys[3][2] = {
        {GLFW_KEY_A, GLFW_KEY_D}, {GLFW_KEY_Q, GLFW_KEY_E}, {GLFW_KEY_S, GLFW_KEY_W}};
    for (int i = 0; i < 3; i++) {
        direction[i] = 0;
        if (window->button != LR_BUTTON_RIGHT)
            continue;
        direction[i] += glfwGetKey(window->handle, keys[i][1]) == GLFW_PRESS;
        direction[i] -= glfwGetKey(window->handle, keys[i][0]) == GLFW_PRESS;
    }
}
