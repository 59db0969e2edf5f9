/* No priorities: see posix.h. */
#ifndef TAKT_WASM_SCHED_H
#define TAKT_WASM_SCHED_H

#include "posix.h"

#include_next <sched.h>

#define SCHED_FIFO  1
#define MCL_CURRENT 1
#define MCL_FUTURE  2

struct sched_param {
    int sched_priority;
};

/* Both refused. */
int sched_setscheduler(pid_t process, int policy, const struct sched_param *parameters);
int mlockall(int flags);

#endif
