#define _DEFAULT_SOURCE

#include "simulation/pace.h"

#include "cli/stopwatch.h"

#include <errno.h>
#include <sched.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>

/* Above the kernel's own threads of low priority, below its watchdogs. */
#define PRIORITY 80

#define SECOND_NS 1000000000u

void pace_start(struct pace *pace, uint64_t cycle_ns)
{
    memset(pace, 0, sizeof *pace);
    pace->cycle_ns = cycle_ns;
    pace->next_ns = stopwatch_now_ns();
}

/*
 * A beat that was missed stays missed: two at once would be worse for the drives than one that is
 * late.
 */
uint64_t pace_end_work(struct pace *pace)
{
    uint64_t now_ns = stopwatch_now_ns();

    pace->next_ns += pace->cycle_ns;
    if (now_ns > pace->next_ns) {
        pace->overruns++;
        pace->next_ns += (now_ns - pace->next_ns) / pace->cycle_ns * pace->cycle_ns;
    }
    return pace->next_ns;
}

void pace_sleep(const struct pace *pace)
{
    struct timespec until = {.tv_sec = (time_t)(pace->next_ns / SECOND_NS),
                             .tv_nsec = (long)(pace->next_ns % SECOND_NS)};

    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, NULL) == EINTR) {
    }
}

void pace_begin_cycle(struct pace *pace)
{
    uint64_t now_ns = stopwatch_now_ns();
    uint64_t late_ns = now_ns > pace->next_ns ? now_ns - pace->next_ns : 0;
    uint64_t step = late_ns / PACE_STEP_NS;

    pace->cycles++;
    pace->sum_ns += late_ns;
    if (late_ns > pace->max_ns)
        pace->max_ns = late_ns;
    pace->steps[step < PACE_STEPS ? step : PACE_STEPS]++;
}

static double find_p99_ns(const struct pace *pace)
{
    uint64_t wanted = pace->cycles - pace->cycles / 100;
    uint64_t seen = 0;

    for (unsigned i = 0; i < PACE_STEPS; i++) {
        seen += pace->steps[i];
        if (seen >= wanted)
            return (double)(i + 1) * PACE_STEP_NS;
    }
    return (double)pace->max_ns;
}

void pace_get_figures(const struct pace *pace, struct pace_figures *figures)
{
    *figures = (struct pace_figures){
        .cycles = pace->cycles,
        .overruns = pace->overruns,
        .lateness_max_ns = pace->max_ns,
    };
    if (pace->cycles == 0)
        return;
    figures->lateness_mean_ns = (double)pace->sum_ns / (double)pace->cycles;
    figures->lateness_p99_ns = find_p99_ns(pace);
}

struct pace_permission pace_ask_permission(void)
{
    struct sched_param priority = {.sched_priority = PRIORITY};

    return (struct pace_permission){
        .has_priority = sched_setscheduler(0, SCHED_FIFO, &priority) == 0,
        .has_memory = mlockall(MCL_CURRENT | MCL_FUTURE) == 0,
    };
}
