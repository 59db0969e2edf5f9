/*
 * With a the leading axis and b any other, all increments positive by renaming,
 *
 *     F = a_end b - b_end a
 *
 * is 0 on the line and F / a_end the distance of the lattice point from it along b. Improved: a
 * steps at every tick, b with it when F <= 0, so that -b_end < F <= a_end - b_end. Plain: any axis
 * with F < 0 steps, else a. Source: seed 002, part A.
 */
#include "step/evaluate_line.h"

#include "base/assert.h"
#include "base/maths.h"

#include <string.h>

void takt_evaluate_line_begin(struct evaluate_line *l, enum evaluate_form form,
                              const int64_t delta[AXIS_COUNT])
{
    int64_t sum = 0;

    memset(l, 0, sizeof(*l));
    l->form = form;
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        l->size[i] = evaluate_size(delta[i]);
        l->direction |= (uint8_t)(delta[i] < 0 ? 1U << i : 0U);
        sum += l->size[i];
        if (l->size[i] > l->size[l->leading]) {
            l->leading = i;
        }
    }
    l->left = form == EVALUATE_PLAIN ? sum : l->size[l->leading];
}

static unsigned step_improved(struct evaluate_line *l)
{
    const int64_t a_end = l->size[l->leading];
    unsigned axes = 1U << l->leading;

    TAKT_ASSERT(l->leading < AXIS_COUNT && l->size[l->leading] > 0);
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (i == l->leading || l->size[i] == 0) {
            continue;
        }
        if (l->function[i] <= 0) {
            axes |= 1U << i;
            l->function[i] += a_end;
        }
        l->function[i] -= l->size[i];
    }
    return axes;
}

static unsigned step_plain(struct evaluate_line *l)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (l->function[i] < 0) {
            l->function[i] += l->size[l->leading];
            return 1U << i;
        }
    }
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (i != l->leading) {
            l->function[i] -= l->size[i];
        }
    }
    return 1U << l->leading;
}

bool takt_evaluate_line_next(struct evaluate_line *l, struct evaluate_tick *tick)
{
    TAKT_ASSERT(l->left >= 0);
    *tick = (struct evaluate_tick){0};
    if (l->left == 0) {
        return false;
    }
    l->left--;
    tick->axes = (uint8_t)(l->form == EVALUATE_PLAIN ? step_plain(l) : step_improved(l));
    tick->direction = l->direction & tick->axes;
    return true;
}

/* f = (V / h) |a| / sqrt(sum d^2), of the plain form (V / h) sum |d| / sqrt(sum d^2) */
double takt_evaluate_line_rate(const struct evaluate_line *l)
{
    double squares = 0.0;
    double sum = 0.0;

    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        sum += (double)l->size[i];
        squares += (double)l->size[i] * (double)l->size[i];
    }
    if (squares == 0.0) {
        return 0.0;
    }
    return (l->form == EVALUATE_PLAIN ? sum : (double)l->size[l->leading]) / maths_sqrt(squares);
}
