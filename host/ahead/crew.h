/*
 * Does numbered pieces of work on several cores. Which core does which piece decides nothing but
 * the time.
 */
#ifndef TAKT_HOST_AHEAD_CREW_H
#define TAKT_HOST_AHEAD_CREW_H

#include <stdbool.h>
#include <stddef.h>

#define CREW_MAX 16

/*
 * Calls work(context, worker, piece) for every piece below count, on so many workers, of which
 * worker 0 is the caller. work returns false to end it all. True: every piece was done.
 */
bool crew_run(unsigned workers, size_t count,
              bool (*work)(void *context, unsigned worker, size_t piece), void *context);

/* The machine's cores, 1 ... CREW_MAX. */
unsigned crew_cores(void);

#endif
