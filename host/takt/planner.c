#include "takt/planner.h"

#include "plan/window.h"
#include "takt/interrupt.h"
#include "takt/message.h"

#include <stdlib.h>

struct planner {
    struct session_reading reading;
    struct window window;
    bool ended;
};

static void start_planner(struct planner *p, const struct session *s)
{
    struct program_config config;
    struct plan_limits limits;
    struct source source;

    session_begin_reading(s, &p->reading, &config, &source);
    program_open(&p->reading.program, &config, &source);
    offset_open(&p->reading.offset, &config);
    controller_plan_limits(&s->setup.machine, &limits);
    window_init(&p->window, &limits, s->setup.machine.look_ahead_blocks, &config.start);
}

static void fill_window(struct planner *p)
{
    struct diagnostic diagnostic;
    struct move move;

    while (!p->ended && window_has_room(&p->window)) {
        if (offset_next(&p->reading.offset, &p->reading.program, &move, &diagnostic) ==
            PROGRAM_MOVE) {
            window_push(&p->window, &move);
        } else {
            p->ended = true;
            window_finish(&p->window);
        }
    }
}

static void count_segment(struct planner_totals *totals, const struct segment *segment)
{
    totals->cycles += segment->cycles;
    if (!move_is_motion(&segment->move))
        return;
    totals->motions++;
    totals->stops += segment->end == JOINT_STOP ? 1 : 0;
    if (!curve_is_rotary(&segment->curve))
        totals->length_mm += segment->curve.length_mm;
}

enum command_status planner_walk(const struct session *s,
                                 void (*take)(void *context, const struct segment *segment),
                                 void *context, struct planner_totals *totals)
{
    struct planner *p = calloc(1, sizeof *p);
    struct segment segment;

    *totals = (struct planner_totals){0};
    if (p == NULL) {
        message_command_error("out of memory");
        return STATUS_ENVIRONMENT;
    }
    start_planner(p, s);
    for (;;) {
        fill_window(p);
        if (window_is_empty(&p->window) || interrupt_asked())
            break;
        window_take(&p->window, &segment);
        count_segment(totals, &segment);
        take(context, &segment);
    }
    free(p);
    return interrupt_asked() ? STATUS_INTERRUPTED : STATUS_DONE;
}
