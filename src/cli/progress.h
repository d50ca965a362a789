/* What a person at the terminal sees while a picture is made, and how they stop it. */
#ifndef LR_CLI_PROGRESS_H
#define LR_CLI_PROGRESS_H

#include <stdbool.h>

typedef struct progress {
    bool shown; /* on a terminal, and not asked to be quiet */
    bool color;
    const char *phase;
    double phase_start; /* seconds_now() */
    double last_drawn;
} progress;

/* Shows nothing unless stderr is a terminal. */
void progress_start(progress *p, bool quiet);

/* The phase that begins now, such as "reading scene"; the text must outlive p. */
void progress_phase(progress *p, const char *phase);

/* For lr_render_options and lr_load_options: user is the progress. Returns false once the user has
 * asked to stop. */
bool progress_update(void *user, double fraction);

/* Removes the bar, so that messages can be printed. p may be NULL. */
void progress_clear(progress *p);

/* From here on the first SIGINT, SIGTERM or SIGHUP only makes interrupted() true; the second one
 * ends the process. Signals that are ignored already, as under nohup, stay so. */
void catch_interrupts(void);
bool interrupted(void);

#endif
