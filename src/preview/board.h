/* What the three threads of the window tell each other. The window's own thread writes what it
 * wishes to see, the renderer's what it shows, the loader's which scenes there are. Everything is
 * guarded by `lock` but for the two atomics. */
#ifndef LR_PREVIEW_BOARD_H
#define LR_PREVIEW_BOARD_H

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>

#include "preview/session.h"

/* What the window wishes to see. */
typedef struct lr_wish {
    uint32_t width, height; /* as far as the window knows; 0: it is not to be seen */
    lr_camera camera;       /* without name */
    uint32_t samples, depth, seed;
    lr_filter filter; /* that of the options */
    double exposure;
    lr_inspect inspect;
    lr_integrator integrator; /* of what is shown as light */
    uint64_t picture;         /* grows whenever another picture is wished for: camera, depth, ... */
    uint64_t look;            /* ... or the same to be shown in another way */
} lr_wish;

/* Pixels to lay over the picture; see lr_display_set_overlay. */
typedef struct lr_sheet {
    uint32_t *pixels; /* owned; NULL: nothing */
    uint32_t width, height;
} lr_sheet;

/* What is shown. */
typedef struct lr_shown {
    uint32_t width, height;
    uint32_t samples_done, samples;
    double rays, seconds; /* traced for this picture, and in which time */
    char device[256];
    uint64_t picture; /* the wish's that this is */
} lr_shown;

typedef struct lr_board {
    pthread_mutex_t lock;
    pthread_cond_t wake; /* the renderer */
    bool quit;
    lr_wish wish;
    atomic_uint_fast64_t wished; /* wish.picture, to be read without the lock */
    atomic_bool hurry;           /* leave the picture: quit, or another session */
    lr_sheet sheet;
    bool sheet_new;
    bool screenshot; /* wished for */
    lr_session *next;
    lr_edit *edit;    /* that the session may take, and is made anew for if not: */
    bool edit_failed; /* for the loader */
    lr_shown shown;
    lr_picture taken;             /* a screenshot that waits for the loader to write it */
    bool lost;                    /* the renderer has no session any more: the device failed */
    uint32_t failures;            /* so many one after the other, without a whole picture */
    lr_error failure;             /* why */
    FILE *events;                 /* a log for tests, or NULL; see lr_board_log */
    double start;                 /* of its clock */
    uint32_t validation_messages; /* of all devices that were closed, and the first of them */
    char validation[1024];
    void (*notify_loader)(void *loader);
    void *loader;
} lr_board;

lr_status lr_board_init(lr_board *board, lr_error *error);
void lr_board_destroy(lr_board *board);

/* Counts what the validation layer had to say about a device. */
void lr_board_note_validation(lr_board *board, uint32_t messages, const char *text);

/* Destroys a session, which may be NULL, and keeps what the validation layer had to say. */
void lr_board_end_session(lr_board *board, lr_session *session);

/* One line with the seconds since the start in front. Any thread, with or without the lock. */
void lr_board_log(lr_board *board, const char *format, ...) __attribute__((format(printf, 2, 3)));

static inline void lr_board_lock(lr_board *board)
{
    pthread_mutex_lock(&board->lock);
}

static inline void lr_board_unlock(lr_board *board)
{
    pthread_mutex_unlock(&board->lock);
}

#endif
