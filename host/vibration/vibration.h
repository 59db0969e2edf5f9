/*
 * A machine that is not stiff: between motor and tool of an axis lie springs. Each mode is a damped
 * oscillator whose foot the drive moves; what the tool is off the drive's place is the sum of what
 * its modes are.
 */
#ifndef TAKT_VIBRATION_VIBRATION_H
#define TAKT_VIBRATION_VIBRATION_H

#include "base/point.h"

#include <stdbool.h>
#include <stdint.h>

#define VIBRATION_MODES 2 /* of an axis */

/* What a mode is told by, in the order of the machine file. */
enum vibration_number {
    VIBRATION_HZ,      /* of the undamped oscillator; 0: there is no such mode */
    VIBRATION_DAMPING, /* ratio, 0 ... below 1 */
    /*
     * how much of it the tool sees; those of an axis whose foot is all that moves it have the sum 1
     */
    VIBRATION_PART,
    VIBRATION_NUMBERS
};

#define VIBRATION_PLACES 5 /* of a table: evenly from its first place to its last */

/*
 * How the frequencies of an axis' modes change along an axis: with the overhang of a ram, say. All
 * zero: they do not.
 */
struct vibration_table {
    uint32_t along;      /* enum axis, linear */
    double places_mm[2]; /* of the drive of that axis, first and last; the same: no table */
    /* Frequency there over that of the mode; straight between places, beyond them as at the end. */
    double ratio[VIBRATION_MODES][VIBRATION_PLACES];
};

struct vibration_config {
    double mode[AXIS_LINEAR_COUNT][VIBRATION_MODES * VIBRATION_NUMBERS];
    /*
     * By so much the frequencies may be others than told: for planning ahead; what swings does not
     * know of it.
     */
    double uncertain_percent[AXIS_LINEAR_COUNT];
    struct vibration_table table[AXIS_LINEAR_COUNT]; /* of the modes of this axis */
    /*
     * Along which other axes the tool goes when this one swings: parts of how far it does. Its own
     * is 0.
     */
    double across[AXIS_LINEAR_COUNT][AXIS_LINEAR_COUNT];
};

/* An oscillator, seen from its foot. */
struct vibration_mode {
    double part;
    double w_per_s, damping; /* of the mode as it is told; 0: there is none */
    double ratio;            /* of the frequency that advance is for */
    double advance[2][2];    /* of away_mm and rate_mm_s, by a cycle */
    double away_mm, rate_mm_s;
};

struct vibration_axis {
    struct vibration_mode mode[VIBRATION_MODES];
    double foot_mm, foot_mm_s;
};

struct vibration {
    bool any; /* there is a mode at all */
    bool has_foot;
    double cycle_s;
    struct vibration_axis axis[AXIS_LINEAR_COUNT];
    struct vibration_table table[AXIS_LINEAR_COUNT];
    double across[AXIS_LINEAR_COUNT][AXIS_LINEAR_COUNT];
};

/* NULL: good; else what is wrong with the modes of *axis. */
const char *vibration_check(const struct vibration_config *config, unsigned *axis);

/* Is the frequency of any mode? */
bool vibration_is_uncertain(const struct vibration_config *config);

/* Makes the frequencies higher by this part of what they are uncertain by. */
void vibration_shift(struct vibration_config *config, double part);

/* config has passed the check. Everything rests where the drives are first. */
void vibration_init(struct vibration *v, const struct vibration_config *config, double cycle_s);

/* A cycle later the drives have come to *at, X Y Z mm: it becomes where the tool's side is. */
void vibration_follow(struct vibration *v, struct point *at);

#endif
