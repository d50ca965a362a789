/* CPU and wall seconds of repeated work, for the programs of `tools/bench`. */
#ifndef BENCH_TIMING_H
#define BENCH_TIMING_H

#include <stdlib.h>
#include <sys/resource.h>
#include <time.h>

#include <jansson.h>

enum { RUNS_MAX = 1000 };

typedef struct timing {
    double cpu[RUNS_MAX], wall[RUNS_MAX];
    int count;
} timing;

static inline double cpu_seconds(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
           1e-6 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

static inline double wall_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* A run is what lies between all starts and stops before timing_next. */
static inline void timing_start(timing *t)
{
    t->cpu[t->count] -= cpu_seconds();
    t->wall[t->count] -= wall_seconds();
}

static inline void timing_stop(timing *t)
{
    t->cpu[t->count] += cpu_seconds();
    t->wall[t->count] += wall_seconds();
}

static inline void timing_next(timing *t)
{
    t->count++;
    if (t->count < RUNS_MAX)
        t->cpu[t->count] = t->wall[t->count] = 0;
}

static inline int ascending(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return *x < *y ? -1 : *x > *y;
}

static inline double median(double *values, int count)
{
    qsort(values, (size_t)count, sizeof *values, ascending);
    return values[count / 2];
}

static inline json_t *summary(timing *t)
{
    return json_pack("{s:f, s:f, s:i}", "cpu_seconds", median(t->cpu, t->count), "wall_seconds",
                     median(t->wall, t->count), "runs", t->count);
}

/* As read from a command line: 1 to RUNS_MAX - 1. */
static inline int runs_from(const char *text)
{
    int runs = atoi(text);
    return runs < 1 ? 1 : runs >= RUNS_MAX ? RUNS_MAX - 1 : runs;
}

#endif
