#define _POSIX_C_SOURCE 200809L

#include "takt/progress.h"

#include "takt/stopwatch.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define PROGRESS_FIRST_NS UINT64_C(1000000000)
#define PROGRESS_EVERY_NS UINT64_C(100000000)
#define PROGRESS_WIDTH    40

void progress_start(struct progress *p, bool wanted)
{
    p->wanted = wanted && isatty(STDERR_FILENO) != 0;
    p->shown = false;
    p->start_ns = stopwatch_now_ns();
    p->next_ns = p->start_ns + PROGRESS_FIRST_NS;
}

void progress_show(struct progress *p, double done, double program_time_s)
{
    char bar[PROGRESS_WIDTH + 1];
    uint64_t now_ns;
    int filled = (int)(done * PROGRESS_WIDTH);

    if (!p->wanted)
        return;
    now_ns = stopwatch_now_ns();
    if (now_ns < p->next_ns)
        return;
    memset(bar, '.', PROGRESS_WIDTH);
    memset(bar, '#', (size_t)(filled < 0 ? 0 : filled > PROGRESS_WIDTH ? PROGRESS_WIDTH : filled));
    bar[PROGRESS_WIDTH] = '\0';
    (void)fprintf(stderr, "\r[%s] %3.0f %%  %.0f x real time ", bar, 100 * done,
                  program_time_s * 1e9 / (double)(now_ns - p->start_ns));
    (void)fflush(stderr);
    p->shown = true;
    p->next_ns = now_ns + PROGRESS_EVERY_NS;
}

void progress_end(struct progress *p)
{
    if (p->shown)
        (void)fprintf(stderr, "\r%*s\r", PROGRESS_WIDTH + 32, "");
    p->shown = false;
}
