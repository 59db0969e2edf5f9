/*
 * What the tests of the service share that verifier its setpoints: cycles, and the largest
 * differences over them beside the limits of the built-in mill's X, Y and Z.
 */
#ifndef TAKT_TESTS_SERVICE_VERIFIER_H
#define TAKT_TESTS_SERVICE_VERIFIER_H

#include "base/maths.h"
#include "service_bench.h"

#define TAU_S       0.001
#define JUDGED_AXES 3U

/* Setpoints of the last cycles, newest first, and the largest differences between them. */
static double verified[JUDGED_AXES][4];
static double most_velocity, most_acceleration, most_jerk;

/* The axes stand, wherever they have been before. */
static void verifier_from_rest(void)
{
    for (unsigned i = 0; i < JUDGED_AXES; i++)
        for (unsigned k = 0; k < 4; k++)
            verified[i][k] = service.controller.record.set.at[i];
}

static void begin_judging(void)
{
    verifier_from_rest();
    most_velocity = most_acceleration = most_jerk = 0;
}

static void verifier_axis(double *p, double at)
{
    memmove(p + 1, p, 3 * sizeof p[0]);
    p[0] = at;
    most_velocity = maths_max(most_velocity, maths_abs(p[0] - p[1]) / TAU_S);
    most_acceleration =
        maths_max(most_acceleration, maths_abs(p[0] - 2 * p[1] + p[2]) / (TAU_S * TAU_S));
    most_jerk = maths_max(most_jerk,
                          maths_abs(p[0] - 3 * p[1] + 3 * p[2] - p[3]) / (TAU_S * TAU_S * TAU_S));
}

static void verified_cycle(void)
{
    cycle();
    for (unsigned i = 0; i < JUDGED_AXES; i++)
        verifier_axis(verified[i], service.controller.record.set.at[i]);
}

static inline void verified_cycles(unsigned count)
{
    for (unsigned i = 0; i < count; i++)
        verified_cycle();
}

static inline void verified_wait_for(enum panel_state state)
{
    for (unsigned i = 0; i < BENCH_CYCLES_MAX && takt_service_get_state(&service) != state; i++)
        verified_cycle();
    TEST_ASSERT_EQUAL_INT(state, takt_service_get_state(&service));
}

/* And the axes have moved. */
static inline void expect_limits_kept(void)
{
    TEST_ASSERT_TRUE(most_velocity <= 100.0 * 1.0001);
    TEST_ASSERT_TRUE(most_acceleration <= 1000.0 * 1.0001);
    TEST_ASSERT_TRUE(most_jerk <= 50000.0 * 1.001);
    TEST_ASSERT_GREATER_THAN(10, most_velocity);
}

#endif
