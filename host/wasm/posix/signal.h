/* No signal ever comes: see posix.h. */
#ifndef TAKT_WASM_SIGNAL_H
#define TAKT_WASM_SIGNAL_H

#include "posix.h"

#include_next <signal.h>

#define SIG_SETMASK 2

struct sigaction {
    void (*sa_handler)(int number);
    sigset_t sa_mask;
};

int sigfillset(sigset_t *set);
int sigemptyset(sigset_t *set);
int sigaction(int number, const struct sigaction *action, struct sigaction *before);

#endif
