#include "preview/board.h"

#include <stdarg.h>
#include <stdlib.h>

lr_status lr_board_init(lr_board *board, lr_error *error)
{
    *board = (lr_board){.start = lr_now()};
    if (pthread_mutex_init(&board->lock, NULL) || pthread_cond_init(&board->wake, NULL))
        return lr_fail(error, LR_ERROR_MEMORY, "out of memory for threads");
    return LR_OK;
}

void lr_board_end_session(lr_board *board, lr_session *session)
{
    char text[sizeof board->validation] = "";
    uint32_t messages = lr_session_destroy(session, text, sizeof text);
    lr_board_note_validation(board, messages, text);
}

void lr_board_note_validation(lr_board *board, uint32_t messages, const char *text)
{
    lr_board_lock(board);
    if (messages > 0 && board->validation_messages == 0)
        snprintf(board->validation, sizeof board->validation, "%s", text);
    board->validation_messages += messages;
    lr_board_unlock(board);
}

void lr_board_log(lr_board *board, const char *format, ...)
{
    char text[256];
    va_list arguments;
    if (!board->events)
        return;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    fprintf(board->events, "%.4f %s\n", lr_now() - board->start, text);
    fflush(board->events);
}

void lr_board_destroy(lr_board *board)
{
    lr_board_end_session(board, board->next);
    lr_edit_free(board->edit);
    free(board->sheet.pixels);
    lr_picture_free(&board->taken);
    pthread_cond_destroy(&board->wake);
    pthread_mutex_destroy(&board->lock);
}
