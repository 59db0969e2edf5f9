/*
 * The ramp law: by which curve the feed goes from one value to another. See laws.md.
 *
 * The lead point (firmware/motion) moves with constant acceleration; the setpoint's path position is its average over
 * a window of cycles. One box average makes the seven-segment profile of limited jerk; a second and a third, half as
 * long, make jerk and its derivative continuous.
 */
#ifndef TAKT_PLAN_LAW_H
#define TAKT_PLAN_LAW_H

#include <stdint.h>

enum law {
    LAW_JERK,   /* time-optimal for limited acceleration and jerk */
    LAW_SMOOTH, /* jerk continuous */
    LAW_GENTLE  /* jerk continuous and its derivative too */
};

#define LAW_BOXES_MAX 3

/* Cycles of a box at most. */
#define LAW_CYCLES_MAX 256

/* Cycles that the first box of a law may have: the averages' sums stay within 64 bits. */
uint32_t takt_law_cycles_max(enum law law);

/* Boxes of a law, 1 ... LAW_BOXES_MAX. */
unsigned takt_law_boxes(enum law law);

/* Cycles of box i < takt_law_boxes when the first one has so many: the others half of it, rounded up. */
uint32_t takt_law_box_cycles(unsigned i, uint32_t cycles);

/* Cycles that the averages together reach over: a setpoint depends on so many positions of the lead point. */
uint32_t takt_law_window_cycles(enum law law, uint32_t cycles);

#endif
