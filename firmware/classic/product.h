/*
 * The feed as the source writes it, a product of factors, in the place of the planner's:
 *
 *     F = F_diagram kl %Fz K                                             (5), (12)
 *
 * F_diagram kl is diagram.h; %Fz follows the override %F by an S-curve, and stands still while a
 * block brakes; K is limiter.h, of the cycle before. For comparison: a product passes limits, and
 * the verifier says by how much. Chosen by landing=scale or limiter=threshold|smooth in the machine
 * file.
 *
 * struct motion serves what happens at rest, and hands over the blocks (motion/handover.h). End
 * feeds are found when a block begins, backwards over all blocks that are known: more work in one
 * cycle than a target has time for.
 */
#ifndef TAKT_CLASSIC_PRODUCT_H
#define TAKT_CLASSIC_PRODUCT_H

#include "classic/diagram.h"
#include "classic/limiter.h"
#include "motion/motion.h"

#include <stdbool.h>
#include <stdint.h>

struct product_config {
    enum limiter_form limiter; /* LIMITER_CEILING: K keeps every block's own ceiling, at once */
    double cycle_s;
    uint8_t band_percent[AXIS_COUNT]; /* of LIMITER_SMOOTH */
};

/* The effective override, on its way to what the operator wants. */
struct product_override {
    double now, from, to;
    double time_s, total_s, round; /* of the way; total 0: there */
};

struct product {
#ifdef CLASSIC_IS_ABSENT
    bool is_absent; /* C has no empty struct */
#else
    struct product_config config;
    bool moves;  /* a diagram is being executed */
    bool landed; /* and the last cycle has ended its block */
    struct diagram diagram;
    double time_s; /* in it */
    double way_mm; /* in the block */
    struct product_override override;
    double limiter; /* K of this cycle */
#endif
};

void takt_product_init(struct product *p, const struct product_config *config);

/*
 * One cycle instead of takt_motion_cycle, when that says MOTION_HANDED_OVER. Fills everything of
 * the record but set and act.
 */
void takt_product_cycle(struct product *p, struct motion *m, const struct motion_operator *wanted,
                        struct cycle_record *record);

#endif
