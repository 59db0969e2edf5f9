/*
 * `takt resonance`: the modes between drive and tool of every linear axis, by moves at random and
 * an accelerometer at the tool.
 */
#ifndef TAKT_HOST_RESONANCE_TEST_H
#define TAKT_HOST_RESONANCE_TEST_H

#include "base/point.h"
#include "cli/options.h"
#include "cli/status.h"
#include "resonance/fit.h"

#include <stdint.h>

struct resonance_test {
    double noise_mm_s2; /* of the accelerometer: standard deviation */
    uint32_t seed;      /* of moves and noise */
    bool is_measured[AXIS_LINEAR_COUNT];
    struct resonance_fit fit[AXIS_LINEAR_COUNT];
};

/*
 * axes: bit i: axis i is to be measured; 0: all linear ones with a drive on CAN. STATUS_DONE; else
 * after messages.
 */
enum command_status resonance_test_run(struct resonance_test *test, unsigned axes,
                                       const struct options *options);

#endif
