#include "preview/board.h"

#include <stdlib.h>

lr_status lr_board_init(lr_board *board, lr_error *error)
{
    *board = (lr_board){0};
    if (pthread_mutex_init(&board->lock, NULL) || pthread_cond_init(&board->wake, NULL))
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for threads");
    return LR_OK;
}

void lr_board_destroy(lr_board *board)
{
    lr_session_destroy(board->next);
    free(board->sheet.pixels);
    lr_picture_free(&board->taken);
    pthread_cond_destroy(&board->wake);
    pthread_mutex_destroy(&board->lock);
}
