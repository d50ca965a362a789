/* The renderer's thread: it owns the session that is shown, and traces and shows as the board says.
 * It looks at the board between steps of some 20 ms, and within a step stops between passes when
 * another picture is wished for, but not before something of this one was shown; when all is done
 * it sleeps. */
#ifndef LR_PREVIEW_RENDERER_H
#define LR_PREVIEW_RENDERER_H

#include "preview/board.h"

typedef struct lr_renderer {
    lr_board *board;
    pthread_t thread;
    lr_session *session;
    lr_wish wish;            /* that is being served */
    bool sheet_laid;         /* over the session's picture */
    lr_sheet sheet;          /* waiting until the picture has its size */
    uint64_t started;        /* wish.picture that the session works on; 0: none */
    double last_shown, told; /* when, in seconds */
    double show_seconds;     /* that showing it takes */
    bool told_done;          /* the window knows that the picture is finished */
    bool show;               /* there is something new to show */
    bool proven;             /* the session has shown a whole picture */
} lr_renderer;

lr_status lr_renderer_start(lr_renderer *renderer, lr_board *board, lr_error *error);

/* Ends the thread and destroys the session. */
void lr_renderer_stop(lr_renderer *renderer);

#endif
