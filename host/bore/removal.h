/*
 * How evenly a cutter removes material on its way out from the hole's centre, from the area that it
 * sweeps.
 */
#ifndef TAKT_BORE_REMOVAL_H
#define TAKT_BORE_REMOVAL_H

#include "bore/track.h"

/* A short piece of the way, a window: this many make a turn of the direction of motion. */
#define BORE_WINDOWS_PER_TURN 72

struct bore_window {
    double turn;        /* at its middle, since the start */
    double area_mm2;    /* that is removed */
    double length_mm;   /* of way */
    double layer_mm;    /* thickness of what is taken off the wall there, square to the way */
    double engaged_rad; /* of the cutter's edge */
};

struct bore_removal {
    struct bore_window *window;
    size_t count, capacity;
};

/*
 * Chip area for each mm of depth, by way: area / length. More than the layer, since the wall is
 * longer than the way.
 */
double bore_window_width(const struct bore_window *w);

struct bore_range {
    double least, most;
};

/* Over windows from one turn to another. */
struct bore_evenness {
    struct bore_range layer_mm, width_mm, engaged_rad;
};

/* bore_removal_free is due. False: memory is short. */
bool bore_removal_make(struct bore_removal *r, const struct bore_track *t, double cutter_radius_mm);

/*
 * Likewise of a helix that goes down_mm a turn and then around: what happens at every moment of a
 * long one, as the mean over the levels that are under way then; as many turns of it as are asked
 * for, each like the other. In *level what happens at one of them, from the moment the cutter comes
 * down to it until it has gone around. Both are to be freed.
 */
bool bore_removal_make_helix(struct bore_removal *r, struct bore_removal *level,
                             const struct bore_track *t, double cutter_radius_mm, double down_mm,
                             unsigned turns);
void bore_removal_free(struct bore_removal *r);

void bore_removal_evenness(const struct bore_removal *r, double first_turn, double last_turn,
                           struct bore_evenness *e);

#endif
