#include "base/parallel.h"

#include <pthread.h>
#include <stdatomic.h>
#include <unistd.h>

enum { THREADS_MAX = 16 };

typedef struct queue {
    uint32_t parts;
    _Atomic uint32_t next;
    void (*work)(void *context, uint32_t part);
    void *context;
} queue;

static void *run(void *argument)
{
    queue *q = argument;
    for (;;) {
        uint32_t part = atomic_fetch_add(&q->next, 1);
        if (part >= q->parts)
            return NULL;
        q->work(q->context, part);
    }
}

void lr_run_parallel_on(uint32_t threads, uint32_t parts,
                        void (*work)(void *context, uint32_t part), void *context)
{
    queue q = {.parts = parts, .work = work, .context = context};
    pthread_t others[THREADS_MAX - 1];
    long available = threads ? (long)threads : sysconf(_SC_NPROCESSORS_ONLN);
    int wanted = available > THREADS_MAX ? THREADS_MAX : (int)available, started = 0;
    /* Threads that cannot be had leave their share to the others. */
    while (started < wanted - 1 && (uint32_t)started + 1 < parts &&
           pthread_create(&others[started], NULL, run, &q) == 0)
        started++;
    run(&q);
    while (started > 0)
        pthread_join(others[--started], NULL);
}

void lr_run_parallel(uint32_t parts, void (*work)(void *context, uint32_t part), void *context)
{
    lr_run_parallel_on(0, parts, work, context);
}
