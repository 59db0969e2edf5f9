/*
 * A line of unit steps in any number of axes. The error never reaches one step on any axis, and the
 * end is exact.
 */
#ifndef TAKT_STEP_EVALUATE_LINE_H
#define TAKT_STEP_EVALUATE_LINE_H

#include "step/evaluate.h"

#include <stdbool.h>

struct evaluate_line {
    enum evaluate_form form;
    unsigned leading; /* axis with the largest increment */
    uint8_t direction;
    int64_t left;                 /* ticks still to come */
    int64_t size[AXIS_COUNT];     /* of the increments */
    int64_t function[AXIS_COUNT]; /* F of every other axis */
};

/* delta: increments in steps, below EVALUATE_STEPS_MAX. */
void takt_evaluate_line_begin(struct evaluate_line *l, enum evaluate_form form,
                              const int64_t delta[AXIS_COUNT]);

/* The next tick. False: the end has been reached, *tick is empty. */
bool takt_evaluate_line_next(struct evaluate_line *l, struct evaluate_tick *tick);

/*
 * Ticks a second for a path speed of one step a second: improved |a| / sqrt(sum d^2), plain sum
 * |d| / sqrt(sum d^2).
 */
double takt_evaluate_line_rate(const struct evaluate_line *l);

#endif
