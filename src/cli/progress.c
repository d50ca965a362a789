#include "cli/progress.h"

#include "cli/cli.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

static volatile sig_atomic_t interrupt_flag;

static void on_signal(int number)
{
    (void)number;
    interrupt_flag = 1;
}

void catch_interrupts(void)
{
    static const int signals[] = {SIGINT, SIGTERM, SIGHUP};
    for (size_t i = 0; i < sizeof signals / sizeof *signals; i++) {
        struct sigaction old, action = {.sa_handler = on_signal, .sa_flags = (int)SA_RESETHAND};
        sigemptyset(&action.sa_mask);
        if (sigaction(signals[i], NULL, &old) == 0 && old.sa_handler != SIG_IGN) {
            sigaction(signals[i], &action, NULL);
        }
    }
}

bool interrupted(void)
{
    return interrupt_flag != 0;
}

static int terminal_columns(void)
{
    struct winsize size;
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) {
        return size.ws_col;
    }
    const char *columns = getenv("COLUMNS");
    int count = columns ? atoi(columns) : 0;
    return count > 0 ? count : 80;
}

static void format_time(char *text, size_t size, double seconds)
{
    unsigned s = seconds < 359999 ? (unsigned)(seconds + 0.5) : 359999;
    if (s < 60) {
        snprintf(text, size, "%u s left", s);
    } else if (s < 3600) {
        snprintf(text, size, "%u:%02u min left", s / 60, s % 60);
    } else {
        snprintf(text, size, "%u:%02u h left", s / 3600, s / 60 % 60);
    }
}

/* "tracing [#####.....]  52 %  3 s left", or as much of it as the width has room for. The last
 * column stays free: a character there would make some terminals start a new line. */
static void draw(progress *p, double fraction)
{
    enum { LINE_MAX_LENGTH = 100, BAR_MAX_LENGTH = 40, BAR_MIN_LENGTH = 8 };
    int room = terminal_columns() - 1;
    room = room < LINE_MAX_LENGTH ? room : LINE_MAX_LENGTH;
    char left[40] = "", percent[16] = "";
    if (fraction >= 0) {
        double elapsed = seconds_now() - p->phase_start;
        snprintf(percent, sizeof percent, "%3d %%", (int)(100 * fraction));
        if (fraction > 0.01 && elapsed > 0.5) {
            format_time(left, sizeof left, elapsed / fraction * (1 - fraction));
        }
    }
    char line[LINE_MAX_LENGTH + 1];
    /* The time left has a fixed share of the width, so that the bar does not jump. */
    int bar = room - (int)strlen(p->phase) - (int)strlen(percent) - 4 - 16;
    bar = bar < BAR_MAX_LENGTH ? bar : BAR_MAX_LENGTH;
    if (fraction < 0) {
        snprintf(line, sizeof line, "%s ...", p->phase);
    } else if (bar >= BAR_MIN_LENGTH) {
        char cells[BAR_MAX_LENGTH + 1];
        int full = (int)(fraction * bar);
        for (int i = 0; i < bar; i++) {
            cells[i] = i < full ? '#' : '.';
        }
        cells[bar] = '\0';
        snprintf(line, sizeof line, "%s [%s] %s  %s", p->phase, cells, percent, left);
    } else {
        const char *phase = room >= (int)strlen(p->phase) + 7 ? p->phase : "";
        snprintf(line, sizeof line, "%s%s%s", phase, *phase ? " " : "", percent);
    }
    line[room > 0 ? room : 0] = '\0';
    fprintf(stderr, "\r%s%s%s\033[K", p->color ? "\033[36m" : "", line, p->color ? "\033[0m" : "");
    fflush(stderr);
}

void progress_start(progress *p, bool quiet)
{
    *p = (progress){.shown = !quiet && terminal_present(), .color = terminal_has_color()};
}

void progress_phase(progress *p, const char *phase)
{
    p->phase = phase;
    p->phase_start = seconds_now();
    p->last_drawn = 0;
    if (p->shown) {
        draw(p, -1);
    }
}

bool progress_update(void *user, double fraction)
{
    progress *p = user;
    if (!p->shown) {
        return !interrupted();
    }
    /* The first dispatches include the driver's own compilation, so tracing begins with the first
     * progress, not with the first call. */
    if (fraction > 0 && strcmp(p->phase, "building and compiling") == 0) {
        progress_phase(p, "tracing");
    }
    double now = seconds_now();
    if (fraction > 0 && now - p->last_drawn >= 0.1) {
        p->last_drawn = now;
        draw(p, fraction < 1 ? fraction : 1);
    }
    return !interrupted();
}

void progress_clear(progress *p)
{
    if (p && p->shown) {
        fputs("\r\033[K", stderr);
        fflush(stderr);
    }
}
