/*
 * Named interpolators: how the path length of a cycle becomes a position of every axis. They come
 * after the feed, which is the planner's in all of them.
 *
 *     exact      the curve's own formula at the arc length; the default, and nothing is done here
 *     integrate  lines by digital integration in machine units
 *     rotate     circles and helices by rotating the radius vector
 *
 * Whatever a named one is not for stays exact. Every block begins at its exact start and, where it
 * lands, ends there.
 */
#ifndef TAKT_CLASSIC_INTERPOLATOR_H
#define TAKT_CLASSIC_INTERPOLATOR_H

#include "classic/integrate.h"
#include "classic/rotate.h"
#include "geometry/curve.h"

#include <stdbool.h>
#include <stdint.h>

enum interpolator_kind { INTERPOLATOR_EXACT, INTERPOLATOR_INTEGRATE, INTERPOLATOR_ROTATE };

struct interpolator_config {
    enum interpolator_kind kind;
    uint8_t end_shift;  /* integrate: the last 2^k cycles of a block share what is left */
    uint8_t angle_bits; /* rotate: of an angle's word; 0: any angle */
    double unit_mm;     /* integrate: the last bit of a position, > 0 */
    double way_max_mm;  /* rotate: the farthest way in a cycle, V_max dt; > 0 */
};

/*
 * Bits of a signed word for every position, and its default: with 1 m in steps of 1 um there are 32
 * bits behind it. A ramp of 60,000 cycles then loses less than that (N^2 units, up and down).
 */
#define INTERPOLATOR_WORD_BITS_MIN 8
#define INTERPOLATOR_WORD_BITS_MAX 62
#define INTERPOLATOR_WORD_BITS     53

#define INTERPOLATOR_END_SHIFT_MAX  8
#define INTERPOLATOR_ANGLE_BITS_MAX 24

/*
 * What the last bit of a signed word of word_bits bits is worth, when it counts a range: the
 * increment times a power of two, the least with which the range fits. All > 0.
 */
double takt_interpolator_unit_mm(double increment_mm, double range_mm, unsigned word_bits);

/* Largest deviations from the exact setpoints, and what was to be expected; mm. */
struct interpolator_errors {
    double along_mm, along_bound_mm;     /* integrate: of the position */
    double contour_mm, contour_bound_mm; /* distance from the curve */
    double landing_mm;                   /* how far a landed end had to be set right */
    double loss_ulp;  /* integrate: most units that truncation can have taken from a position */
    double angle_rad; /* rotate: of a step */
};

struct interpolator {
#ifdef CLASSIC_IS_ABSENT
    bool is_absent; /* C has no empty struct */
#else
    struct interpolator_config config;
    struct interpolator_errors errors;
    bool active;    /* this block is not left exact */
    uint32_t block; /* 0: none yet */
    struct curve curve;
    double part;      /* of the curve done, 0 ... 1 */
    double way_mm;    /* in the last cycle */
    bool aimed;       /* the end rule has acted */
    double along_rad; /* rotate: sums of angles by powers, for the bounds */
    double growth;
    struct integrate integrate;
    struct rotate rotate;
#endif
};

void takt_interpolator_init(struct interpolator *i, const struct interpolator_config *config);

/* Another program, whose motions are counted from 1 again: what comes next is a new motion. */
void takt_interpolator_restart(struct interpolator *i);

/* Does it leave all setpoints as they are? */
static inline bool interpolator_is_exact(const struct interpolator *i)
{
#ifdef CLASSIC_IS_ABSENT
    return i->is_absent;
#else
    return i->config.kind == INTERPOLATOR_EXACT;
#endif
}

/*
 * One cycle of a motion. cmd: in the exact setpoint, on the curve; out what this interpolator makes
 * of it. block tells one motion from the next; landed: cmd is the motion's end.
 */
void takt_interpolator_cycle(struct interpolator *i, const struct curve *curve, uint32_t block,
                             bool landed, struct point *cmd);

const struct interpolator_errors *takt_interpolator_get_errors(const struct interpolator *i);

#endif
