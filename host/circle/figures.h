/*
 * What ISO 230-4:2005 asks of a circular test, and what is left where an axis turns round.
 */
#ifndef TAKT_HOST_CIRCLE_FIGURES_H
#define TAKT_HOST_CIRCLE_FIGURES_H

#include "circle/turn.h"

#include <cJSON.h>

enum circle_way { CIRCLE_CCW, CIRCLE_CW, CIRCLE_WAYS };

/*
 * From +first over +second, in the order of the angle: there the first axis, the second, the first,
 * ... turns round.
 */
#define CIRCLE_QUADRANTS 4

/*
 * Where an axis turns round, with the deviation just before and after it straight on: the step from
 * the one to the other, outwards in the order of the angle; and the farthest that the deviation
 * between is off half-way between both.
 */
struct circle_reversal {
    double step_mm, spike_mm;
};

struct circle_figures {
    double centre_mm[2];      /* of the circle of least squares, from the programmed one's */
    double radius_out_mm;     /* its radius is larger by this */
    double deviation_mm;      /* G: between the two circles about its centre that hold the way */
    double most_mm, least_mm; /* F max, F min: from the programmed circle, outwards */
    struct circle_reversal reversal[CIRCLE_QUADRANTS];
};

/*
 * Figures of turns together: G (b) of both ways. Reversals are those of the first. No place: all 0.
 */
void circle_figures_of(const struct circle_turn *const turn[], unsigned turns,
                       struct circle_figures *figures);

/* To be freed by the caller; NULL: out of memory. */
cJSON *circle_figures_json(const struct circle_figures *figures);

#endif
