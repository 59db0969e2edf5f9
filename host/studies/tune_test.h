/*
 * `takt tune`: what an axis' drive moves, by a relay test of its torque; gains for that; a step and
 * a small move before and after.
 */
#ifndef TAKT_HOST_TUNE_TEST_H
#define TAKT_HOST_TUNE_TEST_H

#include "base/point.h"
#include "cli/options.h"
#include "cli/status.h"
#include "tuning/gains.h"
#include "tuning/record.h"

#include <stdbool.h>

/* With some gains: a step of the target without feed-forward, and a move there and back with it. */
struct tune_answer {
    struct tuning_gains gains;
    struct tuning_margins margins; /* of the model */
    struct tuning_record step, move;
    bool is_steady;   /* it comes to rest behind both, and does not fault */
    double overshoot; /* beyond the step, part of it */
    double error_max; /* following error of the move, mm or rad */
    double error_rms;
};

struct tune_axis {
    bool is_measured;
    unsigned bus, node;
    double torque_nm;     /* of the relay */
    double low, high;     /* between which the relay test moved it */
    double step;          /* of the target in the step test */
    double position_step; /* what 6064 can tell apart */
    struct tuning_record relay;
    struct tuning_plant plant;
    struct tune_answer before, after;
    bool is_kept; /* the gains it had are as good: nothing is to be written */
};

struct tune_test {
    struct tune_axis axis[AXIS_COUNT];
};

/*
 * axes: bit i: axis i is to be tuned; 0: all that can be. STATUS_DONE; else after messages. Free it
 * in either case.
 */
enum command_status tune_test_run(struct tune_test *test, unsigned axes,
                                  const struct options *options);
void tune_test_free(struct tune_test *test);

#endif
