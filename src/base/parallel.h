/* Work cut into parts that any number of threads may share. */
#ifndef LR_BASE_PARALLEL_H
#define LR_BASE_PARALLEL_H

#include <stdint.h>

/* Calls work(context, part) once for each part below `parts`, on as many threads as there are
 * processors (at most 16), the caller's among them, in no particular order; returns when all are
 * done. A result must not depend on the order: parts write to places of their own. */
void lr_run_parallel(uint32_t parts, void (*work)(void *context, uint32_t part), void *context);

/* The same on `threads` threads (at most 16), also where there are fewer processors; 0: as many as
 * these. */
void lr_run_parallel_on(uint32_t threads, uint32_t parts,
                        void (*work)(void *context, uint32_t part), void *context);

#endif
