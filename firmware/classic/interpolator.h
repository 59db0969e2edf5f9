/*
 * Named interpolators: how the path length of a cycle becomes a position of every axis. They come after the feed, which
 * is the planner's in all of them.
 *
 *     exact      the curve's own formula at the arc length; the default, and nothing is done here
 *     integrate  lines by digital integration in machine units
 *     rotate     circles and helices by rotating the radius vector
 *
 * Whatever a named one is not for stays exact. Every block begins at its exact start and, where it lands, ends there.
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
    double increment_mm; /* > 0: position increment of the controller */
    unsigned bits;       /* integrate: of a word behind the increment */
};

/* The default of bits: a ramp of 60,000 cycles loses less than an increment (N^2 units, up and down). */
#define INTERPOLATOR_BITS 32

/* Largest deviations from the exact setpoints, and what was to be expected; mm. */
struct interpolator_errors {
    double along_mm, along_bound_mm;     /* integrate: of the position */
    double contour_mm, contour_bound_mm; /* distance from the curve */
    double landing_mm;                   /* how far a landed end had to be set right */
    double loss_ulp;  /* integrate: most units that truncation can have taken from a position */
    double angle_rad; /* rotate: of a step */
};

struct interpolator {
    struct interpolator_config config;
    struct interpolator_errors errors;
#ifndef CLASSIC_IS_ABSENT
    bool active; /* this block is not left exact */
    uint32_t block;
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

void interpolator_init(struct interpolator *i, const struct interpolator_config *config);

/* Does it leave all setpoints as they are? */
static inline bool interpolator_is_exact(const struct interpolator *i)
{
    return i->config.kind == INTERPOLATOR_EXACT;
}

/*
 * One cycle of a motion. cmd: in the exact setpoint, on the curve; out what this interpolator makes of it. block tells one
 * motion from the next; landed: cmd is the motion's end.
 */
void interpolator_cycle(struct interpolator *i, const struct curve *curve, uint32_t block,
                        bool landed, struct point *cmd);

const struct interpolator_errors *interpolator_get_errors(const struct interpolator *i);

#endif
