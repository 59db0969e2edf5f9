#define _XOPEN_SOURCE 700

#include "cli/interrupt.h"

#include <signal.h>
#include <stddef.h>

#define SIGNALLED 128

static volatile sig_atomic_t interrupt_first; /* its number; 0: none yet */
static volatile sig_atomic_t interrupt_seen;

static void interrupt_remember(int number)
{
    if (interrupt_seen == 0)
        interrupt_first = number;
    interrupt_seen = interrupt_seen + 1;
}

void interrupt_catch(void)
{
    struct sigaction action = {.sa_handler = interrupt_remember};
    struct sigaction ignore = {.sa_handler = SIG_IGN};

    (void)sigfillset(&action.sa_mask);
    (void)sigemptyset(&ignore.sa_mask);
    (void)sigaction(SIGINT, &action, NULL);
    (void)sigaction(SIGTERM, &action, NULL);
    (void)sigaction(SIGHUP, &action, NULL);
    (void)sigaction(SIGPIPE, &ignore, NULL);
    (void)sigaction(SIGXFSZ, &ignore, NULL); /* a file too large is an error of its write */
}

bool interrupt_asked(void)
{
    return interrupt_seen != 0;
}

unsigned interrupt_times(void)
{
    return (unsigned)interrupt_seen;
}

int interrupt_status(void)
{
    return SIGNALLED + interrupt_first;
}
