/* How functions fail: they return an lr_status and record one message where the cause is known. */
#ifndef LR_BASE_STATUS_H
#define LR_BASE_STATUS_H

#include "lavaray.h"

/* Records status and a formatted message in error (which may be NULL) and returns status, so that a
 * failing function can write: return lr_fail(error, LR_ERROR_FILE, "%s: %s", path, reason); */
lr_status lr_fail(lr_error *error, lr_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
