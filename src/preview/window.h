/* The window and what hands do to it, by GLFW. All of it on the main thread, but for what
 * lr_window_system's functions do and lr_window_wake. */
#ifndef LR_PREVIEW_WINDOW_H
#define LR_PREVIEW_WINDOW_H

#include "gpu/device.h"

typedef struct GLFWwindow GLFWwindow;

typedef enum lr_button {
    LR_BUTTON_NONE,
    LR_BUTTON_LEFT,
    LR_BUTTON_MIDDLE,
    LR_BUTTON_RIGHT
} lr_button;

/* Keys that write nothing. Those that do are their characters. */
enum {
    LR_KEY_FIRST = 0x110000, /* beyond Unicode */
    LR_KEY_ESCAPE = LR_KEY_FIRST,
    LR_KEY_LEFT,
    LR_KEY_RIGHT,
    LR_KEY_UP,
    LR_KEY_DOWN,
    LR_KEY_PAGE_UP,
    LR_KEY_PAGE_DOWN,
    LR_KEY_HOME,
    LR_KEY_F1,
    LR_KEY_F11,
    LR_KEY_F12,
};

/* What happened; called from lr_window_wait. Positions are in pixels of the picture. */
typedef struct lr_window_handler {
    void *user;
    void (*key)(void *user, uint32_t key);
    void (*drag)(void *user, lr_button button, bool shift, double dx, double dy);
    void (*click)(void *user, double x, double y, bool twice); /* of the left button */
    void (*wheel)(void *user, double x, double y, double steps);
    void (*changed)(void *user); /* its size or scale, or it is to be shown anew */
} lr_window_handler;

typedef struct lr_window {
    GLFWwindow *handle;
    lr_window_system system;
    lr_window_handler handler;
    uint32_t width, height; /* of the picture, in pixels; 0 while it is minimised */
    double scale;           /* pixels a point: 2 on a high-density display */
    double x, y;            /* of the cursor */
    lr_button button;       /* that is down */
    double pressed_x, pressed_y, click_time;
    bool dragged;
    int saved[4]; /* place and size before it was full screen */
} lr_window;

/* First of all, and last. LR_ERROR_DEVICE where there is no display, with the reason. */
lr_status lr_window_system_open(lr_error *error);
void lr_window_system_close(void);

/* Only one window at a time. */
lr_status lr_window_create(lr_window *window, const char *title, uint32_t width, uint32_t height,
                           lr_error *error);
void lr_window_destroy(lr_window *window);

/* Waits for events, at most so many seconds, and hands them out. */
void lr_window_wait(lr_window *window, double seconds);

/* Ends a wait, from any thread. */
void lr_window_wake(void);

bool lr_window_closed(const lr_window *window);
void lr_window_close(lr_window *window);
void lr_window_set_title(lr_window *window, const char *title);
void lr_window_toggle_full_screen(lr_window *window);
bool lr_window_is_full_screen(const lr_window *window);

/* Which of the keys W A S D Q E are down, with the right button: -1, 0 or 1 to the right, up and
 * forward. */
void lr_window_flight(const lr_window *window, double direction[3]);

#endif
