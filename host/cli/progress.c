#define _POSIX_C_SOURCE 200809L

#include "cli/progress.h"

#include "cli/stopwatch.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define PROGRESS_FIRST_NS UINT64_C(1000000000)
#define PROGRESS_EVERY_NS UINT64_C(100000000)
#define PROGRESS_WIDTH    40
#define PROGRESS_FIGURES  48 /* characters behind the bar */

void progress_start(struct progress *p, bool wanted)
{
    p->wanted = wanted && isatty(STDERR_FILENO) != 0;
    p->shown = false;
    p->start_ns = stopwatch_now_ns();
    p->next_ns = p->start_ns + PROGRESS_FIRST_NS;
}

/* What is left takes as long as what is done, for its part. */
static void show_left(double done, double passed_s)
{
    const unsigned left_s = done > 0 ? (unsigned)(passed_s * (1 - done) / done + 0.5) : 0;

    if (done > 0 && done < 1)
        (void)fprintf(stderr, " %u:%02u:%02u left ", left_s / 3600, left_s / 60 % 60, left_s % 60);
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
    show_left(done, 1e-9 * (double)(now_ns - p->start_ns));
    (void)fflush(stderr);
    p->shown = true;
    p->next_ns = now_ns + PROGRESS_EVERY_NS;
}

void progress_end(struct progress *p)
{
    if (p->shown)
        (void)fprintf(stderr, "\r%*s\r", PROGRESS_WIDTH + PROGRESS_FIGURES, "");
    p->shown = false;
}
