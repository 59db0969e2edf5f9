/*
 * The lead-in of a thread: from rest to synchronism by an electronic cam, a position for every
 * angle.
 *
 *   x |                      /
 *     |                    /   x = pitch (angle - zero): the thread, whatever the spindle's speed was
 *     |                  /
 *     |              _.-'
 *     |_________---'__/________  angle
 *          start    zero    start + way
 *
 * It begins half its way before the zero angle, and half its way in pitches behind the start of the
 * move it is on the thread.
 */
#ifndef TAKT_SYNC_LEAD_IN_H
#define TAKT_SYNC_LEAD_IN_H

#include "sync/brake.h"

#include <stdbool.h>

/* For a spindle that goes faster than when the cam was made. */
#define LEAD_IN_ROOM 1.05

struct lead_in {
    double pitch_mm;
    double zero_rev;
    double way_rev; /* > 0 */
};

/* Position and its derivatives by the angle: mm, mm/rev, ... */
struct lead_in_place {
    double x;
    double first, second, third;
};

/*
 * The way that a spindle of speed_rev_s > 0 needs: the axes then keep their acceleration and jerk.
 */
double takt_lead_in_way(double pitch_mm, double speed_rev_s, const struct brake_limits *limits,
                        double cycle_s);

/* For an angle up to the end of the cam, and on the thread behind it. */
struct lead_in_place takt_lead_in_at(const struct lead_in *l, double rev);

/* Is the thread itself reached? */
bool takt_lead_in_is_over(const struct lead_in *l, double rev);

#endif
