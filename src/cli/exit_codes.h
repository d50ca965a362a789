/* What the program says when it ends. */
#ifndef LR_CLI_EXIT_CODES_H
#define LR_CLI_EXIT_CODES_H

typedef enum exit_code {
    EXIT_FINE = 0,
    EXIT_DIFFERENT = 1,    /* pictures, or a self-test's hash, are not as expected */
    EXIT_USAGE = 2,        /* the command line is wrong */
    EXIT_SCENE = 3,        /* the scene is invalid */
    EXIT_DEVICE = 4,       /* no usable device, the device was lost, memory ran out */
    EXIT_FILE = 5,         /* a file could not be read or written */
    EXIT_INTERRUPTED = 130 /* by Ctrl-C or a termination signal */
} exit_code;

#endif
