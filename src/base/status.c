#include "base/status.h"

#include <stdarg.h>
#include <stdio.h>

lr_status lr_fail(lr_error *error, lr_status status, const char *format, ...)
{
    if (error) {
        va_list arguments;
        va_start(arguments, format);
        error->status = status;
        vsnprintf(error->message, sizeof error->message, format, arguments);
        va_end(arguments);
    }
    return status;
}
