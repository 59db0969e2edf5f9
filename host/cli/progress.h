/*
 * A bar on stderr for work that lasts: only on a terminal, only after a second.
 */
#ifndef TAKT_HOST_PROGRESS_H
#define TAKT_HOST_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

struct progress {
    bool wanted;
    bool shown;
    uint64_t start_ns;
    uint64_t next_ns; /* when to draw again */
};

/* wanted: false for --quiet. */
void progress_start(struct progress *p, bool wanted);
/*
 * done: 0 ... 1, and from it the time left. program_time_s: shown as a multiple of the time that
 * has passed. Cheap: call it every some hundred cycles.
 */
void progress_show(struct progress *p, double done, double program_time_s);
/* Wipes the bar out. */
void progress_end(struct progress *p);

#endif
